//! Bending as one constant quadratic form (L9 for a cloth that is flat at rest).
//!
//! E = ½ Σ w |Σ c (x_b − x_a)|². Every stencil is a curvature, written as a sum of differences along edges of the mesh
//! (see `curvature`). The matrix is scalar and constant, and the same for x, y and z.

use super::energy::{Bound, Elastic, Energy, Exerted, Stiffness};
use crate::geometry::{Mat3, Vec3};
use crate::linear::BlockColumn;
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
    bound: EdgeBound,
}

/// A bound of Q edge by edge: Σ w |xᵢ − xⱼ|² ≥ xᵀ Q x.
#[derive(Clone, Debug, Default)]
struct EdgeBound {
    /// Edges, smaller node first, sorted, and their weights w, N/m.
    edges: Vec<([u32; 2], f64)>,
    /// Start of every node's edges to later nodes, and their total.
    starts: Vec<u32>,
    /// Sum of the weights of the edges at every node, N/m.
    at_nodes: Vec<f64>,
}

impl EdgeBound {
    /// Weights of edges between so many `nodes`. Those of one edge add up.
    fn new(nodes: usize, mut weights: Vec<([u32; 2], f64)>) -> Self {
        weights.sort_by_key(|e| e.0);
        let edges: Vec<([u32; 2], f64)> =
            weights.chunk_by(|a, b| a.0 == b.0).map(|g| (g[0].0, g.iter().map(|e| e.1).sum())).collect();
        let (mut starts, mut at_nodes) = (vec![0; nodes + 1], vec![0.0; nodes]);
        for ([a, b], weight) in &edges {
            at_nodes[*a as usize] += weight;
            at_nodes[*b as usize] += weight;
            starts[*a as usize + 1] += 1;
        }
        (0..nodes).for_each(|i| starts[i + 1] += starts[i]);
        Self { edges, starts, at_nodes }
    }
}

impl Bound for EdgeBound {
    fn isotropic(&self, node: usize) -> f64 {
        self.at_nodes[node]
    }

    fn gather(&self, node: usize, column: &mut BlockColumn<f32>) {
        for ([_, other], weight) in &self.edges[self.starts[node] as usize..self.starts[node + 1] as usize] {
            column.add_below(*other, &(Mat3::identity() * -weight));
        }
    }
}

/// Q times positions or displacements.
struct BendingProduct<'a> {
    bending: &'a Bending,
    x: &'a [Vec3],
    /// 1, or −1 for forces.
    sign: f64,
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
        out.bound = EdgeBound::new(nodes, bound);
        out
    }

    /// Weight of the edge between nodes a < b in an edge-wise bound of Q: Σ w |x_a − x_b|² ≥ xᵀ Q x. On a square grid
    /// it is 8 B / h², where the bound is sharp.
    pub fn edge_bound(&self, ends: [u32; 2]) -> f64 {
        let edges = &self.bound.edges;
        edges.binary_search_by(|e| e.0.cmp(&ends)).map_or(0.0, |i| edges[i].1)
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

impl Exerted for BendingProduct<'_> {
    fn gather(&self, node: usize, sum: Vec3) -> Vec3 {
        sum + self.bending.gradient(self.x, node) * self.sign
    }
}

impl Stiffness for Bending {
    fn times<'a>(&'a self, p: &'a [Vec3]) -> impl Exerted + 'a {
        BendingProduct { bending: self, x: p, sign: 1.0 }
    }
}

impl Energy for Bending {
    fn energy(&self, x: &[Vec3]) -> f64 {
        self.energy(x)
    }

    fn forces<'a>(&'a self, x: &'a [Vec3]) -> impl Exerted + 'a {
        BendingProduct { bending: self, x, sign: -1.0 }
    }

    fn stiffness<'a>(&'a self, _x: &'a [Vec3]) -> impl Stiffness + 'a {
        self
    }

    fn bound<'a>(&'a self, _x: &'a [Vec3]) -> impl Bound + 'a {
        &self.bound
    }

    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        self.bound.edges.iter().map(|e| e.0)
    }
}

impl Elastic for Bending {
    type Loads = ();

    /// The bound stays as it is: blocks of held nodes are not in the pattern of the matrix.
    fn around(&self, is_held: &[bool]) -> Self {
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
}

fn summed(row: &mut [(u32, f64)]) -> Vec<(u32, f64)> {
    row.sort_by_key(|e| e.0);
    row.chunk_by(|a, b| a.0 == b.0).map(|g| (g[0].0, g.iter().map(|e| e.1).sum())).collect()
}
