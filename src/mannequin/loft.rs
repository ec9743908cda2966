//! Curves through measured rows, and the sections they are made of.

use std::f64::consts::TAU;

/// `K` values that follow monotone cubics (Fritsch–Carlson) through rows: no overshoot between two rows, so a hip is
/// nowhere wider than measured.
#[derive(Clone, Debug)]
pub(super) struct RowProfile<const K: usize> {
    at: Vec<f64>,
    values: Vec<[f64; K]>,
    slopes: Vec<[f64; K]>,
}

impl<const K: usize> RowProfile<K> {
    /// Through `rows` (two or more, positions rising).
    pub(super) fn new(rows: &[(f64, [f64; K])]) -> Self {
        let at: Vec<f64> = rows.iter().map(|r| r.0).collect();
        let values: Vec<[f64; K]> = rows.iter().map(|r| r.1).collect();
        let mut slopes = vec![[0.0; K]; rows.len()];
        for k in 0..K {
            let column: Vec<f64> = values.iter().map(|v| v[k]).collect();
            for (slope, m) in slopes.iter_mut().zip(monotone_slopes(&at, &column)) {
                slope[k] = m;
            }
        }
        Self { at, values, slopes }
    }

    /// First position.
    pub(super) fn start(&self) -> f64 {
        self.at[0]
    }

    /// Last position.
    pub(super) fn end(&self) -> f64 {
        self.at[self.at.len() - 1]
    }

    /// Values at `t`, held constant beyond both ends.
    pub(super) fn eval(&self, t: f64) -> [f64; K] {
        let last = self.at.len() - 1;
        if t <= self.at[0] {
            return self.values[0];
        }
        if t >= self.at[last] {
            return self.values[last];
        }
        let i = self.at[1..last].partition_point(|&a| a <= t);
        let h = self.at[i + 1] - self.at[i];
        let u = (t - self.at[i]) / h;
        let w = 1.0 - u;
        let (a, b) = (w * w * (1.0 + 2.0 * u), u * u * (1.0 + 2.0 * w));
        let (c, d) = (h * u * w * w, h * u * u * w);
        std::array::from_fn(|k| {
            a * self.values[i][k] + b * self.values[i + 1][k] + c * self.slopes[i][k] - d * self.slopes[i + 1][k]
        })
    }
}

/// Slopes at the rows: zero at local extremes, otherwise the harmonic mean of the chords beside (weighted by their
/// lengths), which keeps every cubic monotone.
fn monotone_slopes(at: &[f64], y: &[f64]) -> Vec<f64> {
    let n = at.len();
    let chord = |i: usize| (y[i + 1] - y[i]) / (at[i + 1] - at[i]);
    let mut slopes = vec![0.0; n];
    slopes[0] = chord(0);
    slopes[n - 1] = chord(n - 2);
    for i in 1..n - 1 {
        let (a, b) = (chord(i - 1), chord(i));
        if a * b > 0.0 {
            let (h, g) = (at[i] - at[i - 1], at[i + 1] - at[i]);
            let (p, q) = (2.0 * g + h, g + 2.0 * h);
            slopes[i] = (p + q) / (p / a + q / b);
        }
    }
    // The one-sided end slopes may not exceed three chords either.
    for (end, next) in [(0, 1), (n - 1, n - 2)] {
        let limit = 3.0 * slopes[next].abs();
        if slopes[next] != 0.0 && slopes[end].abs() > limit {
            slopes[end] = limit.copysign(slopes[end]);
        }
    }
    slopes
}

/// Number of chords over which the perimeter of a section is summed. With 720 it is short by less than 4 parts in a
/// million.
const PERIMETER_CHORDS: usize = 720;

/// Perimeter of |x/a|ⁿ + |z/b|ⁿ = 1. For n ≥ 1 the section is convex, so this is the girth that a tape reads.
pub(super) fn perimeter(a: f64, b: f64, n: f64) -> f64 {
    let power = 2.0 / n;
    let point = |i: usize| {
        let (s, c) = (TAU * i as f64 / PERIMETER_CHORDS as f64).sin_cos();
        (a * c.abs().powf(power).copysign(c), b * s.abs().powf(power).copysign(s))
    };
    let mut sum = 0.0;
    let mut last = point(0);
    for i in 1..=PERIMETER_CHORDS / 4 {
        let next = point(i);
        sum += (next.0 - last.0).hypot(next.1 - last.1);
        last = next;
    }
    4.0 * sum
}

/// Half axes (width, depth) of the ellipse with that girth and ratio of width to depth.
pub(super) fn ellipse(girth: f64, ratio: f64) -> [f64; 2] {
    let depth = girth / perimeter(ratio, 1.0, 2.0);
    [ratio * depth, depth]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_profile_meets_its_rows_and_does_not_overshoot() {
        let profile = RowProfile::new(&[(0.0, [1.0]), (1.0, [2.0]), (1.5, [2.0]), (4.0, [0.5])]);
        assert_eq!(profile.eval(1.0), [2.0]);
        assert_eq!(profile.eval(-1.0), [1.0]);
        for i in 0..=400 {
            let v = profile.eval(f64::from(i) * 0.01)[0];
            assert!((0.5..=2.0).contains(&v));
        }
        assert_relative_eq!(profile.eval(1.25)[0], 2.0);
    }

    #[test]
    fn perimeters_of_known_sections() {
        assert_relative_eq!(perimeter(1.0, 1.0, 2.0), TAU, max_relative = 1e-5);
        assert_relative_eq!(perimeter(1.0, 1.0, 1.0), 4.0 * 2.0_f64.sqrt(), max_relative = 1e-9);
        let [a, b] = ellipse(0.5, 0.8);
        assert_relative_eq!(perimeter(a, b, 2.0), 0.5, max_relative = 1e-12);
        assert_relative_eq!(a / b, 0.8);
    }
}
