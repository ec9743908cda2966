//! Finds the triangle of a flat mesh in which a point lies.

use super::{Vec2, box_of, distance_to_segment};

/// Triangles of a piece by the square cells of the plane that they are near to.
pub(crate) struct Locator<'a> {
    flat: &'a [Vec2],
    triangles: &'a [[u32; 3]],
    low: Vec2,
    cell: f64,
    columns: usize,
    cells: Vec<Vec<u32>>,
}

impl<'a> Locator<'a> {
    /// `cell`: about the length of the triangles' sides.
    pub(crate) fn new(flat: &'a [Vec2], triangles: &'a [[u32; 3]], cell: f64) -> Self {
        let [low, high] = box_of(triangles.iter().flatten().map(|&n| flat[n as usize]));
        let (low, high) = (low.add_scalar(-cell), high.add_scalar(cell));
        let along = |k: usize| ((high[k] - low[k]) / cell).ceil().max(1.0) as usize;
        let columns = along(0);
        let mut out = Self { flat, triangles, low, cell, columns, cells: vec![Vec::new(); columns * along(1)] };
        for (t, corners) in triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|n| flat[n as usize]);
            // A margin of one cell, which is more than a coarse rim cuts off.
            let [left, top] = out.cell_of(a.inf(&b).inf(&c).add_scalar(-cell));
            let [right, bottom] = out.cell_of(a.sup(&b).sup(&c).add_scalar(cell));
            for row in top..=bottom {
                for column in left..=right {
                    out.cells[row * columns + column].push(t as u32);
                }
            }
        }
        out
    }

    /// Column and row of the cell of `p`, or of the one nearest to it.
    fn cell_of(&self, p: Vec2) -> [usize; 2] {
        let index = |k: usize, count: usize| (((p[k] - self.low[k]) / self.cell).max(0.0) as usize).min(count - 1);
        [index(0, self.columns), index(1, self.cells.len() / self.columns)]
    }

    /// The triangle that holds `p` or comes nearest to it, and the barycentric coordinates of `p` there.
    pub(crate) fn place(&self, p: Vec2) -> ([u32; 3], [f64; 3]) {
        let [column, row] = self.cell_of(p);
        let near = &self.cells[row * self.columns + column];
        let all = 0..self.triangles.len() as u32;
        let best = if near.is_empty() { self.nearest(p, all) } else { self.nearest(p, near.iter().copied()) };
        let corners = self.triangles[best as usize];
        (corners, barycentric(p, corners.map(|n| self.flat[n as usize])))
    }

    fn nearest(&self, p: Vec2, among: impl Iterator<Item = u32>) -> u32 {
        let mut best = (f64::INFINITY, 0);
        for t in among {
            let distance = distance_to_triangle(p, self.triangles[t as usize].map(|n| self.flat[n as usize]));
            if distance < best.0 {
                best = (distance, t);
            }
        }
        best.1
    }
}

fn barycentric(p: Vec2, [a, b, c]: [Vec2; 3]) -> [f64; 3] {
    let double_area = (b - a).perp(&(c - a));
    let (v, w) = ((p - a).perp(&(c - a)) / double_area, (b - a).perp(&(p - a)) / double_area);
    [1.0 - v - w, v, w]
}

/// Distance of `p` from a triangle, 0 inside.
fn distance_to_triangle(p: Vec2, corners: [Vec2; 3]) -> f64 {
    if barycentric(p, corners).iter().all(|w| *w >= 0.0) {
        return 0.0;
    }
    let to_side = |k: usize| distance_to_segment(p, [corners[k], corners[(k + 1) % 3]]);
    (0..3).map(to_side).fold(f64::INFINITY, f64::min)
}
