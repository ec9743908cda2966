//! The members of the sums (4)–(6), each with its weight.

use super::bend::Bend;
use super::hinge::{Apex, Hinge};
use super::{GeometricError, PUBLISHED_CELL, Weighting};
use crate::geometry::{MeshEdge, Topology, Vec2};

/// Scale of the area-weighted E_L: a square cell with a diagonal stretched along one side then has the plain sum
/// (ε² h² (1 + ½) = s ε² h² (⅓ + ½·⅙)).
const STRETCH_SCALE: f64 = 3.6;
/// Scale of the area-weighted E_A over the squared cell: a square mesh rolled along one side then has the plain sum
/// (κ² h⁴/4 = s h² · 3 κ² h²), all of it in the edges across.
const BEND_SCALE: f64 = 1.0 / 12.0;
/// Share of the area of each adjacent triangle that belongs to an edge.
const EDGE_SHARE: f64 = 1.0 / 3.0;
/// Double area of a triangle, as a share of its longest side squared, below which it is degenerate: its heights are
/// rounding.
const FLATTEST: f64 = 1e-9;

/// One member of E_L.
#[derive(Clone, Copy, Debug)]
pub(super) struct LengthStencil {
    pub(super) ends: [u32; 2],
    /// L_M, metres.
    pub(super) rest: f64,
    pub(super) weight: f64,
}

/// All members.
#[derive(Clone, Debug)]
pub(super) struct Stencils {
    /// Weight of every vertex in E_P, where E_P counts every vertex.
    pub(super) points: Vec<f64>,
    /// N, the area of the initial mesh in published cells: the weight of every control point in E_P.
    pub(super) cells: f64,
    pub(super) edges: Vec<LengthStencil>,
    pub(super) hinges: Vec<Bend>,
}

impl Stencils {
    /// The entries of half the second derivative of ω E_A, the same for x, y and z: row, column, value. Of two entries
    /// that mirror each other, one is named.
    pub(super) fn bend_entries(&self, weight: f64) -> impl Iterator<Item = (u32, u32, f64)> + '_ {
        self.hinges.iter().flat_map(move |h| {
            let value = move |i: usize, j: usize| weight * h.weight * h.coefficients[i] * h.coefficients[j];
            (0..4).flat_map(move |i| (i..4).map(move |j| (h.nodes[i], h.nodes[j], value(i, j))))
        })
    }
}

/// The initial mesh while it is read.
struct InitialMesh<'a> {
    triangles: &'a [[u32; 3]],
    corners: &'a [[Vec2; 3]],
    weighting: Weighting,
}

impl Stencils {
    pub(super) fn new(
        vertices: usize,
        triangles: &[[u32; 3]],
        corners: &[[Vec2; 3]],
        weighting: Weighting,
    ) -> Result<Self, GeometricError> {
        let rest = InitialMesh { triangles, corners, weighting };
        rest.check(vertices)?;
        let topology = Topology::new(triangles);
        if let Some(&edge) = topology.non_manifold.first() {
            return Err(GeometricError::NonManifold(edge));
        }
        Ok(Self {
            points: rest.points(vertices),
            cells: (0..triangles.len()).map(|t| rest.area(t)).sum::<f64>() / (PUBLISHED_CELL * PUBLISHED_CELL),
            edges: topology.edges.iter().map(|e| rest.length(e)).collect(),
            hinges: topology.edges.iter().filter_map(|e| rest.bend(e)).collect(),
        })
    }
}

impl InitialMesh<'_> {
    fn check(&self, vertices: usize) -> Result<(), GeometricError> {
        for (t, nodes) in self.triangles.iter().enumerate() {
            if nodes.iter().any(|&v| v as usize >= vertices) {
                return Err(GeometricError::Index { triangle: t, vertices });
            }
            let [a, b, c] = self.corners[t];
            let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
            let area = 2.0 * self.area(t);
            if !(area.is_finite() && area > FLATTEST * longest) {
                return Err(GeometricError::Degenerate(t));
            }
        }
        Ok(())
    }

    fn area(&self, t: usize) -> f64 {
        let [a, b, c] = self.corners[t];
        0.5 * (b - a).perp(&(c - a)).abs()
    }

    fn points(&self, vertices: usize) -> Vec<f64> {
        if self.weighting == Weighting::Plain {
            return vec![1.0; vertices];
        }
        let mut out = vec![0.0; vertices];
        for (t, nodes) in self.triangles.iter().enumerate() {
            for &v in nodes {
                out[v as usize] += self.area(t) / (3.0 * PUBLISHED_CELL * PUBLISHED_CELL);
            }
        }
        out
    }

    fn length(&self, edge: &MeshEdge) -> LengthStencil {
        let beside: Vec<usize> = edge.triangles.iter().flatten().map(|&t| t as usize).collect();
        let lengths = beside.iter().map(|&t| self.ends(t, edge.ends)).map(|[a, b]| (b - a).norm());
        let rest = lengths.sum::<f64>() / beside.len() as f64;
        let weight = match self.weighting {
            Weighting::Plain => 1.0,
            Weighting::PerArea => {
                STRETCH_SCALE * EDGE_SHARE * beside.iter().map(|&t| self.area(t)).sum::<f64>() / (rest * rest)
            }
        };
        LengthStencil { ends: edge.ends, rest, weight }
    }

    fn bend(&self, edge: &MeshEdge) -> Option<Bend> {
        let [Some(s), Some(t)] = edge.triangles.map(|t| t.map(|t| t as usize)) else { return None };
        let (k, l) = (self.apex(s, edge.ends)?, self.apex(t, edge.ends)?);
        // Two triangles on the same three vertices lie on each other. There is nothing to bend.
        if k.0 == l.0 {
            return None;
        }
        let [i, j] = self.ends(s, edge.ends);
        let length = (j - i).norm();
        let hinge = Hinge::new(length, k.1, l.1);
        let weight = match self.weighting {
            Weighting::Plain => 1.0,
            Weighting::PerArea => {
                let shell = 3.0 * length * length / hinge.area;
                BEND_SCALE * PUBLISHED_CELL * PUBLISHED_CELL * shell * hinge.angle_per_length
            }
        };
        Some(Bend {
            nodes: [edge.ends[0], edge.ends[1], k.0, l.0],
            coefficients: hinge.coefficients,
            weight,
            rest: 0.0,
        })
    }

    /// Flat positions of two vertices of triangle `t`.
    fn ends(&self, t: usize, ends: [u32; 2]) -> [Vec2; 2] {
        ends.map(|v| {
            let corner = self.triangles[t].iter().position(|&n| n == v).unwrap_or(0);
            self.corners[t][corner]
        })
    }

    /// The vertex of triangle `t` that is not on the edge, and its place over it. A triangle that names a vertex twice
    /// has none.
    fn apex(&self, t: usize, ends: [u32; 2]) -> Option<(u32, Apex)> {
        let corner = self.triangles[t].iter().position(|n| !ends.contains(n))?;
        let [i, j] = self.ends(t, ends);
        Some((self.triangles[t][corner], Apex::new(i, j, self.corners[t][corner])))
    }
}
