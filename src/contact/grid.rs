//! A static uniform grid over small primitives (the body's vertices, edges and triangles).

use crate::geometry::{Vec3, box_of};

/// Primitives sorted into cubic cells. Built once, queried by box.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    origin: Vec3,
    cell: f64,
    size: [usize; 3],
    /// `starts[c]..starts[c + 1]` in `items` are the primitives whose box touches cell `c`. Cells in a row along x
    /// follow one another.
    starts: Vec<u32>,
    items: Vec<CellItem>,
}

/// A primitive in one of its cells.
#[derive(Clone, Copy, Debug, Default)]
struct CellItem {
    number: u32,
    /// Axes along which the cell is the first of the primitive's box: bit k for axis k.
    first: u8,
    extent: Extent,
}

/// A box in single precision, widened by rounding. It separates most primitives that share a cell.
#[derive(Clone, Copy, Debug, Default)]
struct Extent {
    low: [f32; 3],
    high: [f32; 3],
}

impl Extent {
    fn new(low: Vec3, high: Vec3) -> Self {
        let (down, up) = (|x: f64| (x as f32).next_down(), |x: f64| (x as f32).next_up());
        Self { low: [down(low.x), down(low.y), down(low.z)], high: [up(high.x), up(high.y), up(high.z)] }
    }

    fn touches(&self, other: &Self) -> bool {
        (0..3).all(|k| self.low[k] <= other.high[k] && other.low[k] <= self.high[k])
    }
}

/// The cells that a box touches: the first and the last, by axes.
type Cells = ([usize; 3], [usize; 3]);

/// Largest number of cells. Beyond it the cells grow.
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
            grid.for_cells(b, |c, _| counts[c + 1] += 1);
        }
        for c in 0..cells {
            counts[c + 1] += counts[c];
        }
        let mut items = vec![CellItem::default(); counts[cells] as usize];
        let mut fill = counts.clone();
        for (i, b) in boxes.iter().enumerate() {
            let extent = Extent::new(b.0, b.1);
            grid.for_cells(b, |c, first| {
                items[fill[c] as usize] = CellItem { number: i as u32, first, extent };
                fill[c] += 1;
            });
        }
        (grid.starts, grid.items) = (counts, items);
        grid
    }

    /// The cells that the box `low..high` touches, if any.
    fn cells(&self, low: Vec3, high: Vec3) -> Option<Cells> {
        if self.size[0] == 0 {
            return None;
        }
        let index = |x: f64, k: usize| ((x - self.origin[k]) / self.cell).floor();
        let (mut from, mut to) = ([0; 3], [0; 3]);
        for k in 0..3 {
            let (a, b) = (index(low[k], k), index(high[k], k));
            if b < 0.0 || a >= self.size[k] as f64 {
                return None;
            }
            from[k] = a.max(0.0) as usize;
            to[k] = b.min((self.size[k] - 1) as f64) as usize;
        }
        Some((from, to))
    }

    /// Visits the rows of cells along x that are in a box of cells: the number of the cell at x = 0, and of which other
    /// axes, as in [`CellItem::first`], the row is not the first of the box.
    fn for_rows(&self, (from, to): Cells, mut visit: impl FnMut(usize, u8)) {
        for z in from[2]..=to[2] {
            for y in from[1]..=to[1] {
                let later = (u8::from(y > from[1]) << 1) | (u8::from(z > from[2]) << 2);
                visit((z * self.size[1] + y) * self.size[0], later);
            }
        }
    }

    /// Visits the cells that a box touches: number, and [`CellItem::first`] in it.
    fn for_cells(&self, &(low, high): &(Vec3, Vec3), mut visit: impl FnMut(usize, u8)) {
        let Some(cells @ (from, to)) = self.cells(low, high) else { return };
        self.for_rows(cells, |row, later| {
            for x in from[0]..=to[0] {
                visit(row + x, !(later | u8::from(x > from[0])));
            }
        });
    }

    /// Visits every primitive whose box touches the box `low..high` (or misses it by rounding), once.
    pub(super) fn query(&self, low: Vec3, high: Vec3, mut visit: impl FnMut(u32)) {
        let Some(cells @ (from, to)) = self.cells(low, high) else { return };
        let extent = Extent::new(low, high);
        self.for_rows(cells, |row, later| {
            let [start, second, end] = [from[0], from[0] + 1, to[0] + 1].map(|x| self.starts[row + x] as usize);
            for (items, later) in [(start..second, later), (second..end, later | 1)] {
                for item in &self.items[items] {
                    // Of the cells that a primitive shares with the box, the first reports it: along each axis the
                    // first of its own or of the box.
                    if item.first & later == later && item.extent.touches(&extent) {
                        visit(item.number);
                    }
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_query_finds_all_that_touch_its_box_once() {
        let boxes: Vec<(Vec3, Vec3)> = (0..1000)
            .map(|i| {
                let low = Vec3::new(f64::from(i % 10), f64::from(i / 10 % 10), f64::from(i / 100));
                // From points to boxes of three cells.
                (low, low + Vec3::new(f64::from(i % 4), f64::from(i % 3), f64::from(i % 5)) * 0.9)
            })
            .collect();
        let grid = Grid::new(&boxes, 1.7);
        for k in 0..50 {
            let low = Vec3::new(f64::from(k % 7), f64::from(k % 5), f64::from(k % 3)) * 1.83 - Vec3::repeat(0.55);
            let high = low + Vec3::new(f64::from(k % 2), f64::from(k % 3), f64::from(k % 4)) * 1.31;
            let touches = |b: &(Vec3, Vec3)| (0..3).all(|k| b.0[k] <= high[k] && b.1[k] >= low[k]);
            let expected: Vec<u32> = (0..1000).filter(|&i| touches(&boxes[i as usize])).collect();
            let mut found = Vec::new();
            grid.query(low, high, |i| found.push(i));
            found.sort_unstable();
            assert_eq!(found, expected, "{low:?} {high:?}");
        }
        grid.query(Vec3::repeat(-9.0), Vec3::repeat(-8.0), |_| panic!("nothing there"));
    }

    #[test]
    fn nothing_has_no_cells() {
        Grid::new(&[], 1.0).query(Vec3::zeros(), Vec3::repeat(1.0), |_| panic!("nothing there"));
    }
}
