//! Functions on a mesh that are given on its rim and harmonic inside.

use std::sync::Arc;

use super::FlattenError;
use crate::geometry::{Topology, TriMesh};
use crate::linear::{Cholesky, SymmetricMatrix, SymmetricPattern};

/// Weights of the graph whose mean-value property defines "harmonic".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GraphWeights {
    /// Half the cotangents of the angles opposite (Pinkall & Polthier 1993): the finite element Laplacian.
    Cotangent,
    /// All one: positive, so that a convex rim gives a map without flips (Tutte 1963, Floater 1997).
    Uniform,
}

/// The Laplacian A (positive, A·1 = 0) of a mesh, with a factor of the part inside the rim.
pub(super) struct Laplacian {
    /// Edge ends with their weight.
    edges: Vec<([u32; 2], f64)>,
    /// Number of an inner vertex among the inner ones; `None` on the rim.
    inner: Vec<Option<u32>>,
    inner_count: usize,
    factor: Cholesky<f64>,
}

impl Laplacian {
    pub(super) fn new(
        surface: &TriMesh,
        topology: &Topology,
        on_rim: &[bool],
        weights: GraphWeights,
    ) -> Result<Self, FlattenError> {
        let mut inner_count = 0;
        let inner: Vec<Option<u32>> = on_rim
            .iter()
            .map(|&rim| {
                inner_count += usize::from(!rim);
                (!rim).then(|| inner_count as u32 - 1)
            })
            .collect();
        let edges: Vec<([u32; 2], f64)> =
            topology.edges.iter().map(|e| (e.ends, edge_weight(surface, e.ends, &e.triangles, weights))).collect();
        let factor = factor(&edges, &inner, inner_count)?;
        Ok(Self { edges, inner, inner_count, factor })
    }

    /// A·u for every vertex.
    pub(super) fn apply(&self, u: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; u.len()];
        for &([a, b], w) in &self.edges {
            let (a, b) = (a as usize, b as usize);
            out[a] += w * (u[a] - u[b]);
            out[b] += w * (u[b] - u[a]);
        }
        out
    }

    /// For each of several functions the u with A·u = `source` inside and `u` as given on the rim
    /// (inner values of `u` are overwritten).
    pub(super) fn solve<const N: usize>(&self, source: &[f64], functions: [&mut [f64]; N]) {
        let inside = || self.inner.iter().enumerate().filter_map(|(v, inner)| Some((v, (*inner)? as usize)));
        let mut rhs = vec![0.0; N * self.inner_count];
        let mut functions = functions;
        for (u, rhs) in functions.iter_mut().zip(rhs.chunks_mut(self.inner_count.max(1))) {
            inside().for_each(|(v, _)| u[v] = 0.0);
            let lifted = self.apply(u);
            inside().for_each(|(v, k)| rhs[k] = source[v] - lifted[v]);
        }
        self.factor.solve(&mut rhs);
        for (u, rhs) in functions.iter_mut().zip(rhs.chunks(self.inner_count.max(1))) {
            inside().for_each(|(v, k)| u[v] = rhs[k]);
        }
    }
}

fn edge_weight(surface: &TriMesh, ends: [u32; 2], triangles: &[Option<u32>; 2], weights: GraphWeights) -> f64 {
    if weights == GraphWeights::Uniform {
        return 1.0;
    }
    let cotangent = |t: u32| {
        let corners = surface.triangles[t as usize];
        corners.iter().find(|v| !ends.contains(v)).map_or(0.0, |&apex| {
            let [p, a, b] = [apex, ends[0], ends[1]].map(|v| surface.vertices[v as usize]);
            (a - p).dot(&(b - p)) / (a - p).cross(&(b - p)).norm()
        })
    };
    0.5 * triangles.iter().flatten().map(|&t| cotangent(t)).sum::<f64>()
}

/// Factors the part inside the rim; `points` are the inner vertices.
fn factor(edges: &[([u32; 2], f64)], inner: &[Option<u32>], inner_count: usize) -> Result<Cholesky<f64>, FlattenError> {
    let breakdown = |_| FlattenError::Breakdown;
    let coupled = |ends: [u32; 2]| Some((inner[ends[0] as usize]? as usize, inner[ends[1] as usize]? as usize));
    let pattern = SymmetricPattern::scalar(inner_count, edges.iter().filter_map(|&(ends, _)| coupled(ends)));
    let pattern = Arc::new(pattern.map_err(|_| FlattenError::Breakdown)?);
    let mut matrix = SymmetricMatrix::<f64>::zeros(pattern.clone());
    for &(ends, weight) in edges {
        for end in ends {
            if let Some(slot) = inner[end as usize].and_then(|k| pattern.slot(k as usize, k as usize)) {
                matrix.add(slot, weight);
            }
        }
        if let Some(slot) = coupled(ends).and_then(|(i, j)| pattern.slot(i, j)) {
            matrix.add(slot, -weight);
        }
    }
    let mut factor = Cholesky::new(pattern).map_err(|_| FlattenError::Breakdown)?;
    factor.factor(&matrix).map_err(breakdown)?;
    Ok(factor)
}
