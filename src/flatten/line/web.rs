//! Which triangles lie beside each other and round each vertex.

use std::f64::consts::PI;

use super::{SNAP, SNAP_SHARE, SurfacePoint};
use crate::geometry::{Topology, TriMesh, Vec3, sorted_pair};

/// No triangle.
pub(super) const NONE: u32 = u32::MAX;

/// The neighbourhood of every triangle and vertex of an oriented surface.
#[derive(Clone, Debug)]
pub struct Web {
    /// The corners of every triangle.
    triangles: Vec<[u32; 3]>,
    /// Beyond side k, from corner k to the next, of every triangle; [`NONE`] at the rim.
    across: Vec<[u32; 3]>,
    /// Where the triangles of every vertex begin in `round`.
    starts: Vec<u32>,
    round: Vec<u32>,
    rim: Vec<bool>,
    /// How near to every vertex a line passes through it, metres.
    near: Vec<f64>,
    /// Sum of the triangles' angles at every vertex.
    angles: Vec<f64>,
}

impl Web {
    /// Of a surface.
    pub fn new(surface: &TriMesh) -> Self {
        let (triangles, count) = (surface.triangles.clone(), surface.vertices.len());
        let topology = Topology::new(&triangles);
        let mut across = vec![[NONE; 3]; triangles.len()];
        let mut rim = vec![false; count];
        let mut shortest = vec![f64::INFINITY; count];
        for edge in &topology.edges {
            let length = (surface.vertices[edge.ends[1] as usize] - surface.vertices[edge.ends[0] as usize]).norm();
            edge.ends.iter().for_each(|&v| shortest[v as usize] = shortest[v as usize].min(length));
            match edge.triangles {
                [Some(s), Some(t)] => [(s, t), (t, s)].into_iter().for_each(|(own, other)| {
                    if let Some(k) = side_of(triangles[own as usize], edge.ends) {
                        across[own as usize][k] = other;
                    }
                }),
                _ => edge.ends.iter().for_each(|&v| rim[v as usize] = true),
            }
        }
        let near = shortest.iter().map(|side| SNAP.min(SNAP_SHARE * side)).collect();
        let (starts, round) = rounds(&triangles, count);
        let angles = angle_sums(surface);
        Self { triangles, across, starts, round, rim, near, angles }
    }

    /// The triangles at a vertex.
    pub(super) fn round(&self, v: u32) -> &[u32] {
        &self.round[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }

    pub(super) fn corners(&self, t: u32) -> [u32; 3] {
        self.triangles[t as usize]
    }

    /// The triangle beyond the edge of a triangle with these ends, if there is one.
    pub(super) fn beyond(&self, t: u32, ends: [u32; 2]) -> Option<u32> {
        let k = side_of(self.corners(t), ends)?;
        Some(self.across[t as usize][k]).filter(|&t| t != NONE)
    }

    pub(super) fn is_rim(&self, v: u32) -> bool {
        self.rim[v as usize]
    }

    pub(super) fn near(&self, v: u32) -> f64 {
        self.near[v as usize]
    }

    pub(super) fn angle(&self, v: u32) -> f64 {
        self.angles[v as usize]
    }

    /// A vector upright on the surface at a spot, as long as twice the area of the triangles there.
    pub(super) fn normal(&self, surface: &TriMesh, spot: &SurfacePoint) -> Vec3 {
        let of = |ts: &[u32]| ts.iter().map(|&t| surface.double_normal(t as usize)).sum::<Vec3>();
        match *spot {
            SurfacePoint::Vertex(v) => of(self.round(v)),
            SurfacePoint::Face { triangle, .. } => of(&[triangle]),
            SurfacePoint::Edge { ends, .. } => of(&self.beside(ends)),
        }
    }

    /// The triangles beside an edge.
    pub(super) fn beside(&self, ends: [u32; 2]) -> Vec<u32> {
        self.round(ends[0]).iter().copied().filter(|&t| self.corners(t).contains(&ends[1])).collect()
    }

    /// The triangles of which a spot is a point.
    fn holding(&self, spot: SurfacePoint) -> Vec<u32> {
        match spot {
            SurfacePoint::Vertex(v) => self.round(v).to_vec(),
            SurfacePoint::Edge { ends, .. } => self.beside(ends),
            SurfacePoint::Face { triangle, .. } => vec![triangle],
        }
    }

    /// The point at a share of the way from a spot to the next of a line.
    pub(super) fn between(&self, surface: &TriMesh, from: SurfacePoint, to: SurfacePoint, share: f64) -> SurfacePoint {
        /// Shares nearer to an end than this are that end: a point beside it would leave needles.
        const END: f64 = 0.1;
        if share < END {
            return from;
        }
        if share > 1.0 - END {
            return to;
        }
        if let (SurfacePoint::Vertex(a), SurfacePoint::Vertex(b)) = (from, to) {
            return SurfacePoint::Edge { ends: [a, b], at: share };
        }
        let other = self.holding(to);
        let Some(triangle) = self.holding(from).into_iter().find(|t| other.contains(t)) else { return to };
        let corners = self.corners(triangle);
        let (a, b) = (weights(corners, from), weights(corners, to));
        let weights = [0, 1, 2].map(|k| a[k] * (1.0 - share) + b[k] * share);
        self.on_side(surface, triangle, weights)
    }

    /// A point of an edge, which is an end where it is near to one.
    pub fn on_edge(&self, surface: &TriMesh, ends: [u32; 2], at: f64) -> SurfacePoint {
        let [a, b] = ends.map(|v| surface.vertices[v as usize]);
        let length = (b - a).norm();
        if at * length <= self.near(ends[0]) {
            SurfacePoint::Vertex(ends[0])
        } else if (1.0 - at) * length <= self.near(ends[1]) {
            SurfacePoint::Vertex(ends[1])
        } else {
            SurfacePoint::Edge { ends, at }
        }
    }

    /// A point of a triangle, which is a point of an edge or a vertex where it is near to one.
    pub fn on_side(&self, surface: &TriMesh, triangle: u32, weights: [f64; 3]) -> SurfacePoint {
        let corners = self.corners(triangle);
        let spot = SurfacePoint::Face { triangle, weights };
        let p = spot.place(surface);
        let at = |v: u32| surface.vertices[v as usize];
        if let Some(v) = corners.into_iter().find(|&v| (at(v) - p).norm() <= self.near(v)) {
            return SurfacePoint::Vertex(v);
        }
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            let along = (at(b) - at(a)).normalize();
            let off = (p - at(a)) - along * along.dot(&(p - at(a)));
            if off.norm() <= self.near(a).min(self.near(b)) {
                let share = along.dot(&(p - at(a))) / (at(b) - at(a)).norm();
                return SurfacePoint::Edge { ends: [a, b], at: share.clamp(0.0, 1.0) };
            }
        }
        spot
    }
}

/// The weights of a triangle's corners at a spot of it.
fn weights(corners: [u32; 3], spot: SurfacePoint) -> [f64; 3] {
    let of = |v: u32, weight: f64| corners.map(|c| if c == v { weight } else { 0.0 });
    match spot {
        SurfacePoint::Vertex(v) => of(v, 1.0),
        SurfacePoint::Edge { ends: [a, b], at } => {
            let (first, second) = (of(a, 1.0 - at), of(b, at));
            [0, 1, 2].map(|k| first[k] + second[k])
        }
        SurfacePoint::Face { weights, .. } => weights,
    }
}

/// The side of a triangle with these ends.
fn side_of(corners: [u32; 3], ends: [u32; 2]) -> Option<usize> {
    (0..3).find(|&k| sorted_pair([corners[k], corners[(k + 1) % 3]]) == sorted_pair(ends))
}

/// The triangles of every vertex, one vertex after the other, and where each begins.
fn rounds(triangles: &[[u32; 3]], count: usize) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32; count + 1];
    triangles.iter().flatten().for_each(|&v| starts[v as usize + 1] += 1);
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    let (mut at, mut round) = (starts.clone(), vec![0; 3 * triangles.len()]);
    for (t, corners) in (0..).zip(triangles) {
        for &v in corners {
            round[at[v as usize] as usize] = t;
            at[v as usize] += 1;
        }
    }
    (starts, round)
}

/// The angles of the triangles at every vertex, summed.
fn angle_sums(surface: &TriMesh) -> Vec<f64> {
    let mut sums = vec![0.0; surface.vertices.len()];
    for (t, corners) in surface.triangles.iter().enumerate() {
        let p = surface.corners(t);
        for (k, &v) in corners.iter().enumerate() {
            let (u, w) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
            sums[v as usize] += u.cross(&w).norm().atan2(u.dot(&w)).min(PI);
        }
    }
    sums
}
