//! Shapes in columns: what a shape takes of each column of the cloth, no less.

use crate::geometry::{Vec2, box_or_origin};

/// Rounding of positions, metres: intervals that miss each other by less touch.
pub(super) const ROUNDING: f64 = 1e-9;

/// A shape in columns of equal width from its left side on. Lengths are metres, y down.
#[derive(Clone, Debug)]
pub(super) struct ShapeColumns {
    /// For every column the stretches that cover the shape there, from the top down, apart from each other.
    pub(super) taken: Vec<Vec<[f64; 2]>>,
    /// Width and height of the shape itself.
    pub(super) size: Vec2,
}

impl ShapeColumns {
    /// The shape within a closed outline, moved to the origin. Each column has the hulls of the parts of the shape
    /// between neighbouring corners of the outline.
    pub(super) fn new(outline: &[Vec2], column: f64) -> Self {
        let [low, high] = box_or_origin(outline.iter().copied());
        let size = high - low;
        let corners: Vec<Vec2> = outline.iter().map(|p| p - low).collect();
        let count = ((size.x / column - ROUNDING).ceil() as usize).max(1);
        let mut events: Vec<f64> = corners.iter().map(|p| p.x).collect();
        events.extend((0..=count).map(|k| k as f64 * column).filter(|x| *x < size.x));
        events.push(size.x);
        events.sort_by(f64::total_cmp);
        events.dedup_by(|b, a| *b - *a < ROUNDING);
        let mut taken = vec![Vec::new(); count];
        for pair in events.windows(2) {
            let k = ((0.5 * (pair[0] + pair[1]) / column) as usize).min(count - 1);
            taken[k].extend(slices(&corners, [pair[0], pair[1]]));
        }
        taken.iter_mut().for_each(|stretches| *stretches = merged(std::mem::take(stretches)));
        Self { taken, size }
    }
}

/// Stretches of the shape between two x, between which the outline has no corner.
fn slices(corners: &[Vec2], [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let middle = 0.5 * (from + to);
    let mut sides: Vec<[f64; 3]> = Vec::new();
    for (p, q) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        if (p.x > middle) != (q.x > middle) {
            let y = |x: f64| p.y + (q.y - p.y) * (x - p.x) / (q.x - p.x);
            sides.push([y(middle), y(from), y(to)]);
        }
    }
    sides.sort_by(|a, b| a[0].total_cmp(&b[0]));
    sides.chunks_exact(2).map(|pair| [pair[0][1].min(pair[0][2]), pair[1][1].max(pair[1][2])]).collect()
}

/// Stretches that overlap or touch joined, from the top down.
pub(super) fn merged(mut stretches: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    stretches.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut out: Vec<[f64; 2]> = Vec::with_capacity(stretches.len());
    for [low, high] in stretches {
        match out.last_mut() {
            Some(last) if low <= last[1] + ROUNDING => last[1] = last[1].max(high),
            _ => out.push([low, high]),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_cover_a_shape_and_leave_its_bays_open() {
        // A U: 30 wide, 20 high, with a bay of 10 by 15 from above.
        let u = [[0., 0.], [10., 0.], [10., 15.], [20., 15.], [20., 0.], [30., 0.], [30., 20.], [0., 20.]];
        let columns = ShapeColumns::new(&u.map(Vec2::from), 5.0);
        let expected = [[0.0, 20.0], [0.0, 20.0], [15.0, 20.0], [15.0, 20.0], [0.0, 20.0], [0.0, 20.0]];
        assert_eq!(columns.taken, expected.map(|stretch| [stretch]));
        let triangle = [[0., 0.], [40., 0.], [0., 40.]].map(Vec2::from);
        let columns = ShapeColumns::new(&triangle, 10.0);
        assert_eq!(columns.taken, [[[0., 40.]], [[0., 30.]], [[0., 20.]], [[0., 10.]]]);
    }
}
