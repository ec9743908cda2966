//! The ring that a row is bent into, measured by its arc.

use std::f64::consts::TAU;
use std::sync::LazyLock;

/// Points on the table that measures an ellipse's arc.
const ARC: usize = 240;

/// A half depth is found in so many halvings, to a hundredth of a millimetre.
const HALVINGS: usize = 16;

/// An ellipse measured by its arc from the front (b axis) towards the wearer's left (a axis).
pub(super) struct Ellipse {
    pub(super) half_width: f64,
    pub(super) half_depth: f64,
    /// Arc length up to each of [`ARC`] equal steps of the parameter.
    table: Vec<f64>,
    pub(super) perimeter: f64,
}

/// Sine and cosine of every step of the parameter: worked out for every ellipse they were 13 % of the time of `check`.
static STEPS: LazyLock<Vec<[f64; 2]>> = LazyLock::new(|| {
    let step = |k: usize| TAU * k as f64 / ARC as f64;
    (0..=ARC).map(|k| [step(k).sin(), step(k).cos()]).collect()
});

impl Ellipse {
    pub(super) fn new(half_width: f64, half_depth: f64) -> Self {
        let steps = &*STEPS;
        let at = |k: usize| (half_width * steps[k][0], half_depth * steps[k][1]);
        let mut table = vec![0.0];
        for k in 0..ARC {
            let (p, q) = (at(k), at(k + 1));
            table.push(table[k] + (q.0 - p.0).hypot(q.1 - p.1));
        }
        let perimeter = table[ARC];
        Self { half_width, half_depth, table, perimeter }
    }

    /// The ellipse of this half width that is as long as `perimeter`, but no deeper than a flat loop of that length.
    pub(super) fn deep(half_width: f64, perimeter: f64) -> Self {
        let (mut low, mut high) = (0.0, 0.25 * perimeter);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let short = Self::new(half_width, middle).perimeter < perimeter;
            if short { low = middle } else { high = middle }
        }
        Self::new(half_width, high)
    }

    /// (sideways, forward) at a share of the perimeter, and the unit outward normal.
    pub(super) fn at(&self, share: f64) -> ([f64; 2], [f64; 2]) {
        let arc = share.rem_euclid(1.0) * self.perimeter;
        let k = self.table.partition_point(|&t| t <= arc).clamp(1, ARC) - 1;
        let f = (arc - self.table[k]) / (self.table[k + 1] - self.table[k]).max(1e-12);
        let t = TAU * (k as f64 + f) / ARC as f64;
        let n = [t.sin() / self.half_width, t.cos() / self.half_depth];
        let length = n[0].hypot(n[1]);
        ([self.half_width * t.sin(), self.half_depth * t.cos()], [n[0] / length, n[1] / length])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_circle_is_as_long_as_it_should_be() {
        let circle = Ellipse::new(0.2, 0.2);
        assert!((circle.perimeter / (0.4 * std::f64::consts::PI) - 1.0).abs() < 1e-4);
        // Ramanujan's second formula, good to a billionth for this one.
        let (a, b) = (0.2f64, 0.12f64);
        let h = ((a - b) / (a + b)).powi(2);
        let length = std::f64::consts::PI * (a + b) * (1.0 + 3.0 * h / (10.0 + (4.0 - 3.0 * h).sqrt()));
        assert!((Ellipse::new(a, b).perimeter / length - 1.0).abs() < 1e-4);
    }

    #[test]
    fn a_narrow_one_is_as_much_deeper() {
        let wide = Ellipse::new(0.3, 0.2);
        let deep = Ellipse::deep(0.15, wide.perimeter);
        assert!((deep.perimeter - wide.perimeter).abs() < 1e-4 && deep.half_depth > 0.3);
    }

    #[test]
    fn it_begins_at_the_front_and_goes_round_by_the_left_in_equal_arcs() {
        let ring = Ellipse::new(0.2, 0.12);
        let quarters =
            [(0.0, [0.0, 0.12]), (0.25, [0.2, 0.0]), (0.5, [0.0, -0.12]), (0.75, [-0.2, 0.0]), (1.0, [0.0, 0.12])];
        for (share, expected) in quarters {
            let (at, out) = ring.at(share);
            assert!((at[0] - expected[0]).hypot(at[1] - expected[1]) < 1e-9, "{at:?} at {share}");
            assert!((out[0] * at[0] + out[1] * at[1] - at[0].hypot(at[1])).abs() < 1e-9, "{out:?} is not outward");
        }
        let n = 500;
        for k in 0..n {
            let ((p, out), (q, _)) = (ring.at(f64::from(k) / f64::from(n)), ring.at(f64::from(k + 1) / f64::from(n)));
            assert!(((p[0] / 0.2).hypot(p[1] / 0.12) - 1.0).abs() < 1e-12);
            assert!((out[0].hypot(out[1]) - 1.0).abs() < 1e-12);
            let arc = (q[0] - p[0]).hypot(q[1] - p[1]);
            assert!((arc * f64::from(n) / ring.perimeter - 1.0).abs() < 0.01, "{arc}");
        }
    }
}
