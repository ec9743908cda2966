//! Cloth with pieces laid on it, one after the other, each as far up as it goes.

use super::columns::{ROUNDING, ShapeColumns, merged};
use crate::geometry::Vec2;

/// A piece that is to be laid.
#[derive(Clone, Debug)]
pub(super) struct Item {
    /// The ways in which it may lie.
    pub(super) ways: Vec<ShapeColumns>,
    /// Whether its left side must lie at the left side of the cloth, which is the fold.
    pub(super) at_fold: bool,
}

/// Where a piece lies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct StripSpot {
    /// Number of the way in which it lies.
    pub(super) way: usize,
    /// Upper left corner of its box, metres.
    pub(super) corner: Vec2,
}

/// Cloth of a width, of which some is taken.
pub(super) struct Strip {
    column: f64,
    width: f64,
    /// As [`ShapeColumns::taken`], over the whole width.
    taken: Vec<Vec<[f64; 2]>>,
    /// Length that is taken, metres.
    pub(super) length: f64,
}

impl Strip {
    pub(super) fn new(width: f64, column: f64) -> Self {
        let count = (width / column + ROUNDING).floor() as usize + 1;
        Self { column, width, taken: vec![Vec::new(); count], length: 0.0 }
    }

    /// Lays a piece where its lower end is highest on the drawing, and then as far to the left as it goes. `None` where
    /// it is wider than the cloth in every way.
    pub(super) fn lay(&mut self, item: &Item) -> Option<StripSpot> {
        let mut best: Option<(f64, usize, usize, f64)> = None;
        for (way, shape) in item.ways.iter().enumerate() {
            let room = self.width - shape.size.x;
            if room < -ROUNDING {
                continue;
            }
            let last = if item.at_fold { 0 } else { (room / self.column + ROUNDING).floor() as usize };
            for at in 0..=last {
                let most = best.map_or(f64::INFINITY, |b| b.0) - shape.size.y - ROUNDING;
                let Some(y) = self.lowest(shape, at, most) else { continue };
                best = Some((y + shape.size.y, way, at, y));
            }
        }
        let (_, way, at, y) = best?;
        self.take(&item.ways[way], at, y);
        Some(StripSpot { way, corner: Vec2::new(at as f64 * self.column, y) })
    }

    /// The least y at which a shape lies free at a column. `None` where that is `most` or more.
    fn lowest(&self, shape: &ShapeColumns, at: usize, most: f64) -> Option<f64> {
        let mut barred: Vec<[f64; 2]> = Vec::new();
        for (own, taken) in shape.taken.iter().zip(&self.taken[at..]) {
            for [low, high] in taken {
                barred.extend(own.iter().map(|[a, b]| [low - b, high - a]).filter(|bar| bar[1] > ROUNDING));
            }
        }
        barred.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let mut y = 0.0;
        for [low, high] in barred {
            if low >= y - ROUNDING {
                break;
            }
            if high > y {
                y = high;
            }
            if y >= most {
                return None;
            }
        }
        (y < most).then_some(y)
    }

    fn take(&mut self, shape: &ShapeColumns, at: usize, y: f64) {
        for (own, taken) in shape.taken.iter().zip(&mut self.taken[at..]) {
            taken.extend(own.iter().map(|[a, b]| [a + y, b + y]));
            *taken = merged(std::mem::take(taken));
        }
        self.length = self.length.max(y + shape.size.y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn item(corners: &[[f64; 2]]) -> Item {
        let outline: Vec<Vec2> = corners.iter().map(|p| Vec2::from(*p)).collect();
        Item { ways: vec![ShapeColumns::new(&outline, 0.01)], at_fold: false }
    }

    #[test]
    fn small_pieces_fill_the_bays_of_large_ones() {
        let u = item(&[[0., 0.], [0.1, 0.], [0.1, 0.3], [0.2, 0.3], [0.2, 0.], [0.3, 0.], [0.3, 0.4], [0., 0.4]]);
        let small = item(&[[0., 0.], [0.07, 0.], [0.07, 0.25], [0., 0.25]]);
        let mut strip = Strip::new(0.3, 0.01);
        assert_eq!(strip.lay(&u), Some(StripSpot::default()));
        let spot = strip.lay(&small).expect("room");
        assert!(spot.corner.y == 0.0 && (0.1..0.13).contains(&spot.corner.x), "{spot:?}");
        // The next one goes below, and one that is too wide nowhere.
        assert!((strip.lay(&small).expect("room").corner.y - 0.4).abs() < 1e-9);
        assert_eq!(strip.lay(&item(&[[0., 0.], [0.31, 0.], [0., 0.1]])), None);
        assert!((strip.length - 0.65).abs() < 1e-9);
    }
}
