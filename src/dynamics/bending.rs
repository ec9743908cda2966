//! Bending as one constant quadratic form (L9 for a cloth that is flat at rest).
//!
//! E = ½ Σ w |Σ c (x_b − x_a)|². Every stencil is a curvature, written as a sum of differences along edges of the mesh
//! (see `curvature`). The matrix is scalar and constant, and the same for x, y and z.

use crate::geometry::Vec3;
use crate::parallel::{self, MEDIUM};

/// A curvature and the weight of its square.
#[derive(Clone, Debug)]
pub(super) struct Stencil {
    /// (a, b, c): c times the difference from node a to node b, which share an edge. The sum is in 1/m².
    pub(super) flows: Vec<(u32, u32, f64)>,
    /// N·m³: rigidity times area.
    pub(super) weight: f64,
}

/// The constant matrix Q of E = ½ Σ xᵀ Q x (the same for x, y and z), stored by rows.
#[derive(Clone, Debug, Default)]
pub struct Bending {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
    /// Per edge (smaller node first, sorted): a weight w so that Σ w |xᵢ − xⱼ|² ≥ xᵀ Q x.
    bound: Vec<([u32; 2], f64)>,
}

impl Bending {
    /// Builds Q over `nodes` nodes.
    pub(super) fn new(nodes: usize, stencils: &[Stencil]) -> Self {
        let mut entries: Vec<(u32, u32, f64)> = Vec::new();
        let mut bound: Vec<([u32; 2], f64)> = Vec::new();
        for Stencil { flows, weight } in stencils {
            // Differences along one edge add up. An edge whose ends are sewn together has none.
            let edges = flows.iter().filter(|f| f.0 != f.1);
            let mut edges: Vec<_> = edges.map(|&(a, b, c)| if a < b { ([a, b], c) } else { ([b, a], -c) }).collect();
            edges.sort_by_key(|e| e.0);
            let edges: Vec<_> =
                edges.chunk_by(|a, b| a.0 == b.0).map(|g| (g[0].0, g.iter().map(|e| e.1).sum::<f64>())).collect();
            // (Σ c d)² ≤ Σ|c| · Σ |c| d².
            let total: f64 = edges.iter().map(|e| e.1.abs()).sum();
            bound.extend(edges.iter().map(|(e, c)| (*e, weight * total * c.abs())));
            let mut row: Vec<_> = edges.iter().flat_map(|&([a, b], c)| [(a, -c), (b, c)]).collect();
            let row = summed(&mut row);
            for &(i, a) in &row {
                entries.extend(row.iter().map(|&(j, b)| (i, j, a * b * weight)));
            }
        }
        let mut out = Self::from_entries(nodes, entries);
        bound.sort_by_key(|e| e.0);
        out.bound = bound.chunk_by(|a, b| a.0 == b.0).map(|g| (g[0].0, g.iter().map(|e| e.1).sum())).collect();
        out
    }

    /// Weight of the edge between nodes a < b in an edge-wise bound of Q: Σ w |x_a − x_b|² ≥ xᵀ Q x. On a square grid
    /// it is 8 B / h², where the bound is sharp.
    pub fn bound(&self, ends: [u32; 2]) -> f64 {
        self.bound.binary_search_by(|e| e.0.cmp(&ends)).map_or(0.0, |i| self.bound[i].1)
    }

    fn from_entries(nodes: usize, mut entries: Vec<(u32, u32, f64)>) -> Self {
        entries.sort_by_key(|e| (e.0, e.1));
        let mut out = Self { starts: vec![0; nodes + 1], ..Self::default() };
        for group in entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            out.starts[group[0].0 as usize + 1] += 1;
            out.columns.push(group[0].1);
            out.values.push(group.iter().map(|e| e.2).sum());
        }
        for i in 0..nodes {
            out.starts[i + 1] += out.starts[i];
        }
        out
    }

    /// The matrix without entries between two held nodes. The gradient at free nodes stays the same.
    pub(super) fn around(&self, is_held: &[bool]) -> Self {
        let mut out = Self { starts: vec![0], bound: self.bound.clone(), ..Self::default() };
        for (i, held) in is_held.iter().enumerate() {
            for (j, value) in self.row(i).filter(|(j, _)| !held || !is_held[*j]) {
                out.columns.push(j as u32);
                out.values.push(value);
            }
            out.starts.push(out.columns.len() as u32);
        }
        out
    }

    /// The entries of row `i`: (column, value).
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.columns[range.clone()].iter().zip(&self.values[range]).map(|(&c, &v)| (c as usize, v))
    }

    /// (Q x)ᵢ: the gradient of the energy at node `i`, N.
    pub fn gradient(&self, x: &[Vec3], i: usize) -> Vec3 {
        self.row(i).fold(Vec3::zeros(), |sum, (j, q)| sum + x[j] * q)
    }

    /// The energy, J.
    pub fn energy(&self, x: &[Vec3]) -> f64 {
        0.5 * parallel::sum(x.len(), MEDIUM, |i| x[i].dot(&self.gradient(x, i)))
    }
}

fn summed(row: &mut [(u32, f64)]) -> Vec<(u32, f64)> {
    row.sort_by_key(|e| e.0);
    row.chunk_by(|a, b| a.0 == b.0).map(|g| (g[0].0, g.iter().map(|e| e.1).sum())).collect()
}
