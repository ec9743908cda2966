//! Properties of a rim in the flat cloth: its drawn length, and whether it is a hole or the end of a tube.

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};

use crate::geometry::{Vec2, sorted_pair};
use crate::mesh::ClothMesh;
use crate::verify::Welded;

/// The flat cloth round the vertices and edges of the welded surface.
pub(super) struct FlatCloth {
    /// Flat length of every edge, metres, and how many triangles have it.
    edges: HashMap<[u32; 2], (f64, usize)>,
    /// Sum of the flat angles round every vertex, radians.
    angles: Vec<f64>,
    /// Edges of the rim at every vertex.
    rim_edges: Vec<usize>,
}

/// A rim in the flat cloth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FlatRing {
    /// Length as drawn, metres, without the steps over closures.
    pub(super) length: f64,
    /// By how much it turns towards the cloth, radians: 0 at the end of a tube, −2π round a hole of a flat sheet, 2π
    /// round the sheet itself.
    pub(super) turning: f64,
    /// The area that it encloses when laid out in the plane, over that of a circle of its length: 1 for a round hole, 0
    /// for a slit.
    pub(super) roundness: f64,
    /// Whether cloth is sewn to cloth all along it, as round a bag.
    pub(super) is_sewn: bool,
}

impl FlatCloth {
    pub(super) fn new(mesh: &ClothMesh, welded: &Welded) -> Self {
        let mut edges: HashMap<[u32; 2], (f64, usize)> = HashMap::new();
        let mut angles = vec![0.0; welded.surface.vertices.len()];
        for (particles, vertices) in welded.corners.iter().zip(&welded.surface.triangles) {
            let at = particles.map(|p| mesh.flat[p as usize]);
            for k in 0..3 {
                let (p, q, r) = (at[k], at[(k + 1) % 3], at[(k + 2) % 3]);
                let edge = edges.entry(sorted_pair([vertices[k], vertices[(k + 1) % 3]])).or_default();
                *edge = (edge.0.max((q - p).norm()), edge.1 + 1);
                angles[vertices[k] as usize] += (q - p).angle(&(r - p));
            }
        }
        let mut rim_edges = vec![0; angles.len()];
        for (ends, _) in edges.iter().filter(|(_, (_, triangles))| *triangles == 1) {
            ends.iter().for_each(|&v| rim_edges[v as usize] += 1);
        }
        Self { edges, angles, rim_edges }
    }

    /// Flat length between two neighbouring vertices, metres. Nothing between others.
    pub(super) fn length(&self, v: u32, w: u32) -> f64 {
        self.edges.get(&sorted_pair([v, w])).map_or(0.0, |edge| edge.0)
    }

    /// Number of triangles at the edge between two neighbouring vertices. `None` for others.
    fn layers(&self, ends: [u32; 2]) -> Option<usize> {
        self.edges.get(&sorted_pair(ends)).map(|edge| edge.1)
    }

    /// Turn of a closed chain of vertices at its corner `k`, radians. A step that is no edge of the cloth goes over a
    /// closure, square to the rim.
    pub(super) fn turn(&self, ring: &[u32], k: usize) -> f64 {
        let n = ring.len();
        let layers = |k: usize| self.layers([ring[k % n], ring[(k + 1) % n]]);
        match (layers(k + n - 1), layers(k)) {
            (Some(one), Some(other)) => PI - self.angle(ring[k], one.max(other)),
            _ => -FRAC_PI_2,
        }
    }

    /// The rim along a closed chain of vertices.
    pub(super) fn ring(&self, ring: &[u32]) -> FlatRing {
        let (mut at, mut way, mut double_area) = (Vec2::zeros(), 0.0f64, 0.0);
        let is_seam = |k: usize| self.layers([ring[k], ring[(k + 1) % ring.len()]]).is_some_and(|layers| layers > 1);
        let mut out = FlatRing { is_sewn: (0..ring.len()).all(is_seam), ..FlatRing::default() };
        for k in 0..ring.len() {
            let turn = self.turn(ring, k);
            let length = self.length(ring[k], ring[(k + 1) % ring.len()]);
            way += turn;
            let next = at + Vec2::new(way.cos(), way.sin()) * length;
            double_area += at.perp(&next);
            at = next;
            out.length += length;
            out.turning += turn;
        }
        out.roundness = 2.0 * PI * double_area.abs() / out.length.powi(2).max(f64::MIN_POSITIVE);
        out
    }

    /// The angle of one layer of cloth at a vertex of a rim of so many layers.
    fn angle(&self, vertex: u32, layers: usize) -> f64 {
        let passes = (self.rim_edges[vertex as usize] / 2).max(1);
        self.angles[vertex as usize] / (layers * passes) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Vec3, rim_loops};
    use crate::mesh::PieceMesh;

    /// A grid of `n` × `m` cells of 10 mm without the cells in `hole`. Rolled up to a tube where `tube` says so.
    fn cloth(n: u32, m: u32, hole: &[[u32; 2]], tube: bool) -> (ClothMesh, Welded) {
        let at = |i: u32, j: u32| i * (m + 1) + j;
        let mut mesh = ClothMesh { spacing: 0.01, ..ClothMesh::default() };
        mesh.flat = (0..=n).flat_map(|i| (0..=m).map(move |j| 0.01 * Vec2::new(f64::from(i), f64::from(j)))).collect();
        for [i, j] in (0..n).flat_map(|i| (0..m).map(move |j| [i, j])).filter(|cell| !hole.contains(cell)) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        mesh.pieces = vec![PieceMesh {
            name: "sheet".into(),
            particles: 0..mesh.flat.len(),
            triangles: 0..mesh.triangles.len(),
            edges: vec![],
            lines: vec![],
            smallest_angle: 0.0,
            warp: Vec2::y(),
            narrow: None,
        }];
        let weld: Vec<u32> =
            (0..mesh.flat.len() as u32).map(|p| if tube && p >= at(n, 0) { p - at(n, 0) } else { p }).collect();
        let welded = Welded::new(&mesh, &weld, &vec![Vec3::zeros(); mesh.flat.len()]);
        (mesh, welded)
    }

    fn rings((mesh, welded): &(ClothMesh, Welded)) -> Vec<FlatRing> {
        let flat = FlatCloth::new(mesh, welded);
        rim_loops(&welded.surface.triangles).iter().map(|ring| flat.ring(ring)).collect()
    }

    #[test]
    fn a_hole_turns_away_from_its_cloth_and_the_end_of_a_tube_does_not_turn() {
        let square: Vec<[u32; 2]> = (3..7).flat_map(|i| (3..7).map(move |j| [i, j])).collect();
        let [outline, hole] = rings(&cloth(10, 10, &square, false))[..] else { panic!("two rims") };
        approx::assert_relative_eq!(outline.turning, 2.0 * PI, epsilon = 1e-9);
        approx::assert_relative_eq!(hole.turning, -2.0 * PI, epsilon = 1e-9);
        approx::assert_relative_eq!(hole.length, 0.16, epsilon = 1e-9);
        approx::assert_relative_eq!(hole.roundness, PI / 4.0, epsilon = 1e-9);
        let slit: Vec<[u32; 2]> = (1..9).map(|j| [5, j]).collect();
        assert!(rings(&cloth(10, 10, &slit, false))[1].roundness < 0.32);
        for end in rings(&cloth(10, 4, &[], true)) {
            approx::assert_relative_eq!(end.turning, 0.0, epsilon = 1e-9);
        }
    }
}
