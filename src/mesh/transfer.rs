//! From one mesh of a garment to another, coarser or finer.

use super::ClothMesh;
use crate::geometry::{Vec2, Vec3};

/// Where the particles of one mesh lie in another of the same garment: each in the triangle of its piece that holds its
/// flat position, or continued beyond the one that comes nearest (a coarser rim cuts off its curves). Those of an edge
/// lie on that edge, as far along it, so that what is sewn together stays together.
#[derive(Clone, Debug)]
pub struct Transfer {
    /// Per particle the corners of the triangle and their weights, which sum to 1.
    places: Vec<([u32; 3], [f64; 3])>,
}

impl Transfer {
    /// Finds the particles of `to` in `from`.
    ///
    /// # Panics
    /// When the two are not meshes of one garment.
    pub fn new(from: &ClothMesh, to: &ClothMesh) -> Self {
        assert_eq!(from.pieces.len(), to.pieces.len(), "meshes of different garments");
        let mut places = Vec::with_capacity(to.flat.len());
        for (source, target) in from.pieces.iter().zip(&to.pieces) {
            let locator = Locator::new(&from.flat, &from.triangles[source.triangles.clone()], from.spacing);
            places.extend(to.flat[target.particles.clone()].iter().map(|&p| locator.place(p)));
            for (edge, finer) in source.edges.iter().zip(&target.edges) {
                let along = (shares(&from.flat, &edge.particles), shares(&to.flat, &finer.particles));
                for (&n, &share) in finer.particles.iter().zip(&along.1) {
                    places[n as usize] = between(&edge.particles, &along.0, share);
                }
            }
        }
        Self { places }
    }

    /// Positions of the particles of the one mesh from those of the other.
    pub fn apply(&self, x: &[Vec3]) -> Vec<Vec3> {
        let place = |(corners, weights): &([u32; 3], [f64; 3])| {
            corners.iter().zip(weights).map(|(&n, &w)| x[n as usize] * w).sum()
        };
        self.places.iter().map(place).collect()
    }
}

/// How far along a chain each of its particles is, 0 … 1.
fn shares(flat: &[Vec2], chain: &[u32]) -> Vec<f64> {
    let mut out = vec![0.0; chain.len()];
    for (k, pair) in chain.windows(2).enumerate() {
        out[k + 1] = out[k] + (flat[pair[1] as usize] - flat[pair[0] as usize]).norm();
    }
    let whole = out.last().copied().unwrap_or(0.0).max(f64::MIN_POSITIVE);
    out.iter().map(|s| s / whole).collect()
}

/// The place `share` of the way along a chain whose particles are at `shares` of it.
fn between(chain: &[u32], shares: &[f64], share: f64) -> ([u32; 3], [f64; 3]) {
    let k = shares.partition_point(|s| *s <= share).clamp(1, chain.len() - 1);
    let t = (share - shares[k - 1]) / (shares[k] - shares[k - 1]).max(f64::MIN_POSITIVE);
    ([chain[k - 1], chain[k], chain[k]], [1.0 - t, t, 0.0])
}

/// Triangles of a piece by the square cells of the plane that they are near to.
struct Locator<'a> {
    flat: &'a [Vec2],
    triangles: &'a [[u32; 3]],
    low: Vec2,
    cell: f64,
    columns: usize,
    cells: Vec<Vec<u32>>,
}

impl<'a> Locator<'a> {
    fn new(flat: &'a [Vec2], triangles: &'a [[u32; 3]], cell: f64) -> Self {
        let corners = || triangles.iter().flatten().map(|&n| flat[n as usize]);
        let low = corners().fold(Vec2::repeat(f64::INFINITY), |a, p| a.inf(&p)).add_scalar(-cell);
        let high = corners().fold(Vec2::repeat(f64::NEG_INFINITY), |a, p| a.sup(&p)).add_scalar(cell);
        let along = |k: usize| ((high[k] - low[k]) / cell).ceil().max(1.0) as usize;
        let columns = along(0);
        let mut out = Self { flat, triangles, low, cell, columns, cells: vec![Vec::new(); columns * along(1)] };
        for (t, corners) in triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|n| flat[n as usize]);
            // A cell's width around: what a coarse rim cuts off is less.
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
    fn place(&self, p: Vec2) -> ([u32; 3], [f64; 3]) {
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

/// 0 inside.
fn distance_to_triangle(p: Vec2, corners: [Vec2; 3]) -> f64 {
    if barycentric(p, corners).iter().all(|w| *w >= 0.0) {
        return 0.0;
    }
    let to_side = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let along = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        (p - a - (b - a) * along).norm()
    };
    (0..3).map(to_side).fold(f64::INFINITY, f64::min)
}
