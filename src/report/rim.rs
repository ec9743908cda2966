//! The rims of the pieces, the edges that a seam joins, and those that elastic gathers.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use crate::geometry::{Topology, Vec3, distance_to_segment, sorted_pair};
use crate::mesh::{ClothMesh, DrawnIn, PieceMesh};

/// Sides of a seam further apart than this (one over the other, less one) are eased, gathered or stretched: the cloth
/// beside the seam cannot keep its drawn size.
pub(super) const UNEVEN: f64 = 0.05;

/// A mesh edge on the rim of a piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct RimEdge {
    /// Particles at its ends.
    pub(super) ends: [u32; 2],
    /// The triangle beside it, an index into the whole mesh.
    pub(super) triangle: u32,
    /// Drawn length, m.
    pub(super) flat: f64,
    /// Shortest and longest drawn length of the edges sewn together here, its own among them, metres. Elastic lowers
    /// the shortest to the length that it draws in to.
    pub(super) drawn: [f64; 2],
}

impl RimEdge {
    /// Length at these positions.
    pub(super) fn length(&self, at: &[Vec3]) -> f64 {
        (at[self.ends[1] as usize] - at[self.ends[0] as usize]).norm()
    }

    /// Ratio of the longest to the shortest partner: 1 on a free edge.
    pub(super) fn ratio(&self) -> f64 {
        if self.drawn[0] > 0.0 { self.drawn[1] / self.drawn[0] } else { 1.0 }
    }

    /// Whether its seam eases, gathers or stretches here.
    pub(super) fn uneven(&self) -> bool {
        self.ratio() > 1.0 + UNEVEN
    }
}

/// Distance of two positions of a rim: the largest distance of an end of an edge in one from the nearest edge in the
/// other, and vice versa (Hausdorff distance, for curves of short edges).
pub(super) fn outline_distance(rim: &[RimEdge], before: &[Vec3], after: &[Vec3]) -> f64 {
    let mut corners: Vec<u32> = rim.iter().flat_map(|e| e.ends).collect();
    corners.sort_unstable();
    corners.dedup();
    let furthest = |from: &[Vec3], to: &[Vec3]| {
        let distance = |p: Vec3, e: &RimEdge| distance_to_segment(p, e.ends.map(|v| to[v as usize]));
        let nearest = |p: Vec3| rim.iter().map(|e| distance(p, e)).fold(f64::INFINITY, f64::min);
        corners.iter().map(|&v| nearest(from[v as usize])).fold(0.0, f64::max)
    };
    furthest(before, after).max(furthest(after, before))
}

/// The rim edges of every piece, in the pieces' order. `weld` has one label per particle, the same for stitched ones.
pub(super) fn rims(mesh: &ClothMesh, weld: &[u32]) -> Vec<Vec<RimEdge>> {
    let drawn_in = mesh.drawn_in();
    let mut rims: Vec<Vec<RimEdge>> =
        mesh.pieces.iter().map(|p| rim_of(mesh, p.triangles.clone(), &drawn_in)).collect();
    let key = |e: &RimEdge| sorted_pair(e.ends.map(|v| weld[v as usize]));
    let mut drawn: HashMap<[u32; 2], [f64; 2]> = HashMap::new();
    for edge in rims.iter().flatten() {
        let range = drawn.entry(key(edge)).or_insert(edge.drawn);
        *range = [range[0].min(edge.drawn[0]), range[1].max(edge.drawn[1])];
    }
    for edge in rims.iter_mut().flatten() {
        edge.drawn = drawn[&key(edge)];
    }
    rims
}

fn rim_of(mesh: &ClothMesh, triangles: Range<usize>, drawn_in: &HashMap<[u32; 2], DrawnIn>) -> Vec<RimEdge> {
    let topology = Topology::new(&mesh.triangles[triangles.clone()]);
    let edge = |e: &crate::geometry::MeshEdge| {
        let flat = (mesh.flat[e.ends[1] as usize] - mesh.flat[e.ends[0] as usize]).norm();
        let triangle = e.triangles[0]? + triangles.start as u32;
        let share = drawn_in.get(&sorted_pair(e.ends)).map_or(1.0, |elastic| elastic.ratio);
        Some(RimEdge { ends: e.ends, triangle, flat, drawn: [flat * share, flat] })
    };
    topology.rim_edges().filter_map(edge).collect()
}

/// Triangles of a piece (indices into the whole mesh) with a corner on an elastic line, which are particles `elastic`:
/// like those on the rim of a gathered seam they cannot keep their drawn size.
pub(super) fn beside_elastic(mesh: &ClothMesh, piece: &PieceMesh, elastic: &HashSet<u32>) -> Vec<u32> {
    let is_beside = |t: &usize| mesh.triangles[*t].iter().any(|c| elastic.contains(c));
    piece.triangles.clone().filter(is_beside).map(|t| t as u32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_corner_of_a_rim_that_moves_is_seen() {
        // A unit square whose edges name the smaller corner first.
        let edges = [[0, 1], [1, 2], [2, 3], [0, 3]];
        let rim = edges.map(|ends| RimEdge { ends, triangle: 0, flat: 1.0, drawn: [1.0; 2] });
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
        for corner in 0..4 {
            let mut moved = square;
            let out = (square[corner] - Vec3::new(0.5, 0.5, 0.0)) * 0.2;
            moved[corner] += out;
            assert!((outline_distance(&rim, &square, &moved) - out.norm()).abs() < 1e-12, "corner {corner}");
        }
    }
}
