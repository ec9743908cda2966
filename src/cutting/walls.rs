//! Lines on a piece, sorted by where they lie: of the thousands there may be, few are near any place.

use crate::geometry::{Vec2, box_of};

/// Distances are exact to this share.
const EXACT: f64 = 1e-9;

/// Line segments in square cells.
pub(super) struct Walls {
    low: Vec2,
    /// Side of a cell.
    side: f64,
    /// Columns and rows.
    size: [usize; 2],
    /// Walls in each cell, row by row.
    cells: Vec<Vec<[Vec2; 2]>>,
}

impl Walls {
    /// Sorts `walls` into cells, about as many as they are, over a box in which they lie and all places that are asked
    /// for.
    pub(super) fn new(walls: &[[Vec2; 2]], corners: [Vec2; 2]) -> Self {
        let [low, high] = box_of(walls.iter().flatten().copied().chain(corners));
        let extent = (high - low).map(|x| x.max(f64::MIN_POSITIVE));
        let side = (extent.x * extent.y / walls.len().max(1) as f64).sqrt().max(extent.amax() / 1e3);
        let size = [extent.x, extent.y].map(|x| (x / side) as usize + 1);
        let mut sorted = Self { low, side, size, cells: vec![Vec::new(); size[0] * size[1]] };
        walls.iter().for_each(|wall| sorted.add(*wall));
        sorted
    }

    fn add(&mut self, wall: [Vec2; 2]) {
        let [a, b] = wall.map(|p| (p - self.low) / self.side);
        let [from, to] = if a.x <= b.x { [a, b] } else { [b, a] };
        let slope = if to.x > from.x { (to.y - from.y) / (to.x - from.x) } else { 0.0 };
        for column in self.index(from.x - EXACT, 0)..=self.index(to.x + EXACT, 0) {
            // Where it is in this column. Upright, all of it is.
            let level = |x: f64| from.y + (x.clamp(from.x, to.x) - from.x) * slope;
            let ends = if to.x > from.x { [level(column as f64), level(column as f64 + 1.0)] } else { [from.y, to.y] };
            let (low, high) = (ends[0].min(ends[1]) - EXACT, ends[0].max(ends[1]) + EXACT);
            for row in self.index(low, 1)..=self.index(high, 1) {
                self.cells[row * self.size[0] + column].push(wall);
            }
        }
    }

    /// The column or row of a coordinate in cells.
    fn index(&self, x: f64, axis: usize) -> usize {
        (x.max(0.0) as usize).min(self.size[axis] - 1)
    }

    /// The least `distance` from `p` to a wall, where `distance` is at least the greater of the distances along x and
    /// y. A result of at most `enough` need not be the least.
    pub(super) fn clear(&self, p: Vec2, enough: f64, distance: impl Fn([Vec2; 2]) -> f64) -> f64 {
        let own = (p - self.low) / self.side;
        let at = [self.index(own.x, 0), self.index(own.y, 1)];
        let mut least = f64::INFINITY;
        for ring in 0..self.size[0].max(self.size[1]) {
            let range = |axis: usize| at[axis].saturating_sub(ring)..=(at[axis] + ring).min(self.size[axis] - 1);
            for row in range(1) {
                let whole = row.abs_diff(at[1]) == ring;
                for column in range(0).filter(|c| whole || c.abs_diff(at[0]) == ring) {
                    least =
                        self.cells[row * self.size[0] + column].iter().copied().map(&distance).fold(least, f64::min);
                }
            }
            // What was not looked at is beyond these cells.
            let beyond = (0..2).map(|k| (own[k] - at[k] as f64).min(at[k] as f64 + 1.0 - own[k])).fold(1.0, f64::min);
            if least <= enough || least <= (ring as f64 + beyond) * self.side * (1.0 - EXACT) {
                break;
            }
        }
        least
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::distance_to_segment;

    #[test]
    fn the_nearest_wall_is_found_wherever_it_is() {
        let at = |seed: u32| f64::from(seed.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24);
        for count in [0, 1, 7, 300] {
            let point = |k: u32| Vec2::new(5.0 * at(2 * k + 1), at(2 * k + 2));
            let short = |k: u32| [point(k), point(k) + 0.1 * (point(k + 1000) - point(k))];
            let walls: Vec<[Vec2; 2]> =
                (0..count).map(|k| if k % 9 == 0 { [point(k), point(k + 7)] } else { short(k) }).collect();
            let sorted = Walls::new(&walls, [Vec2::zeros(), Vec2::new(5.0, 1.0)]);
            for k in 5000..5200 {
                let p = point(k);
                let distance = |wall: [Vec2; 2]| distance_to_segment(p, wall);
                let least = walls.iter().copied().map(distance).fold(f64::INFINITY, f64::min);
                assert_eq!(sorted.clear(p, 0.0, distance), least, "{p} {count}");
                assert!(least <= 0.1 || sorted.clear(p, 0.1, distance) > 0.1, "{p} {count}");
            }
        }
    }
}
