//! A static uniform grid over small primitives (the body's vertices and edges).

use crate::geometry::{Vec3, box_of};

/// Primitives sorted into cubic cells; built once, queried by box.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    origin: Vec3,
    cell: f64,
    size: [usize; 3],
    /// `starts[c]..starts[c + 1]` in `items` are the primitives whose box touches cell `c`.
    starts: Vec<u32>,
    items: Vec<Item>,
}

/// A primitive in one of its cells.
#[derive(Clone, Copy, Debug, Default)]
struct Item {
    number: u32,
    /// The first cell of its box, by axes.
    first: [u32; 3],
}

/// More cells than this are never made: the cells grow instead.
const MAX_CELLS: f64 = 4e6;

impl Grid {
    /// Sorts boxes (low corner, high corner) into cells of about `cell` metres.
    pub(super) fn new(boxes: &[(Vec3, Vec3)], cell: f64) -> Self {
        let [low, high] = box_of(boxes.iter().flat_map(|b| [b.0, b.1]));
        if boxes.is_empty() {
            return Self { origin: Vec3::zeros(), cell, size: [0; 3], starts: vec![0], items: Vec::new() };
        }
        let extent = high - low;
        let volume = extent.add_scalar(cell).product() / cell.powi(3);
        let cell = if volume > MAX_CELLS { cell * (volume / MAX_CELLS).cbrt() } else { cell };
        let size = [extent.x, extent.y, extent.z].map(|e| (e / cell) as usize + 1);
        let mut grid = Self { origin: low, cell, size, starts: Vec::new(), items: Vec::new() };
        let cells = size.iter().product::<usize>();
        let mut counts = vec![0u32; cells + 1];
        for b in boxes {
            grid.for_cells(b.0, b.1, |c, _, _| counts[c + 1] += 1);
        }
        for c in 0..cells {
            counts[c + 1] += counts[c];
        }
        let mut items = vec![Item::default(); counts[cells] as usize];
        let mut fill = counts.clone();
        for (i, b) in boxes.iter().enumerate() {
            grid.for_cells(b.0, b.1, |c, _, first| {
                items[fill[c] as usize] = Item { number: i as u32, first };
                fill[c] += 1;
            });
        }
        (grid.starts, grid.items) = (counts, items);
        grid
    }

    /// Visits the cells that a box touches: number, place, and the place of the first of them.
    fn for_cells(&self, low: Vec3, high: Vec3, mut visit: impl FnMut(usize, [u32; 3], [u32; 3])) {
        if self.size[0] == 0 {
            return;
        }
        let index = |x: f64, k: usize| ((x - self.origin[k]) / self.cell).floor();
        let (mut from, mut to) = ([0u32; 3], [0u32; 3]);
        for k in 0..3 {
            let (a, b) = (index(low[k], k), index(high[k], k));
            if b < 0.0 || a >= self.size[k] as f64 {
                return;
            }
            from[k] = a.max(0.0) as u32;
            to[k] = b.min((self.size[k] - 1) as f64) as u32;
        }
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                for x in from[0]..=to[0] {
                    visit((z as usize * self.size[1] + y as usize) * self.size[0] + x as usize, [x, y, z], from);
                }
            }
        }
    }

    /// Visits every primitive whose cells touch the box `low..high`, once.
    pub(super) fn query(&self, low: Vec3, high: Vec3, mut visit: impl FnMut(u32)) {
        self.for_cells(low, high, |c, cell, from| {
            for item in &self.items[self.starts[c] as usize..self.starts[c + 1] as usize] {
                // Of the cells that a primitive shares with the box, the first reports it.
                if (0..3).all(|k| cell[k] == item.first[k].max(from[k])) {
                    visit(item.number);
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_query_finds_all_that_touch_its_box() {
        let points: Vec<Vec3> =
            (0..1000).map(|i| Vec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100))).collect();
        let boxes: Vec<_> = points.iter().map(|&p| (p, p)).collect();
        let grid = Grid::new(&boxes, 1.7);
        let (low, high) = (Vec3::new(2.5, 3.5, 0.0), Vec3::new(4.5, 6.0, 2.2));
        let mut found = Vec::new();
        grid.query(low, high, |i| found.push(i));
        for (i, p) in points.iter().enumerate() {
            let inside = (0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]);
            assert!(!inside || found.contains(&(i as u32)));
        }
        grid.query(Vec3::repeat(-9.0), Vec3::repeat(-8.0), |_| panic!("nothing there"));
    }
}
