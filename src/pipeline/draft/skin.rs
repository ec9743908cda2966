//! A closed surface that is split along lines, so that they run along its edges.

use std::collections::BTreeSet;

use crate::contact::nearest_on_surface;
use crate::flatten::line::{SurfacePoint, Web, plane_section, straightened};
use crate::flatten::{Solid, shortest_path};
use crate::geometry::{TriMesh, Vec3, sorted_pair};

/// A plane section between two points that is this much longer than the straightest way has gone round another side.
const ASTRAY: f64 = 1.5;

/// A line on the skin.
#[derive(Clone, Debug)]
pub(super) struct SkinLine {
    pub(super) name: String,
    /// Vertices; a closed line ends in its first.
    pub(super) chain: Vec<u32>,
}

/// The surface, and the lines on it so far.
#[derive(Clone, Debug)]
pub(super) struct LinedSkin {
    pub(super) mesh: TriMesh,
    pub(super) lines: Vec<SkinLine>,
}

impl LinedSkin {
    pub(super) fn at(&self, v: u32) -> Vec3 {
        self.mesh.vertices[v as usize]
    }

    /// Where a ray leaves the surface first.
    pub(super) fn ray(&self, from: Vec3, way: Vec3) -> Option<Vec3> {
        let mut best: Option<f64> = None;
        for t in 0..self.mesh.triangles.len() {
            let [a, b, c] = self.mesh.corners(t);
            let (u, v) = (b - a, c - a);
            let p = way.cross(&v);
            let det = u.dot(&p);
            if det.abs() < f64::MIN_POSITIVE {
                continue;
            }
            let s = from - a;
            let (x, q) = (s.dot(&p) / det, s.cross(&u));
            let (y, far) = (way.dot(&q) / det, v.dot(&q) / det);
            /// Rays between two triangles meet one of them in spite of rounding.
            const EDGE: f64 = -1e-12;
            if x >= EDGE && y >= EDGE && x + y <= 1.0 - EDGE && far > 0.0 && best.is_none_or(|least| far < least) {
                best = Some(far);
            }
        }
        best.map(|far| from + way * far)
    }

    /// The vertex at the point of the surface nearest to `p`, a new one where there is none.
    pub(super) fn vertex_at(&mut self, p: Vec3) -> u32 {
        let (t, weights, _) = nearest_on_surface(&self.mesh, p);
        let spot = Web::new(&self.mesh).on_side(&self.mesh, t as u32, weights);
        self.split(&[spot])[0]
    }

    /// The straight line between two vertices.
    pub(super) fn between(&mut self, from: u32, to: u32) -> Option<Vec<u32>> {
        let web = Web::new(&self.mesh);
        let chain = shortest_path(&self.mesh, &Solid::new(), from, to)?;
        let straight = straightened(&self.mesh, &web, &chain);
        let way = self.at(to) - self.at(from);
        let upright = self.normal(from) + self.normal(to);
        let normal = way.cross(&upright);
        let length = |line: &[SurfacePoint]| crate::flatten::line::length(&self.mesh, line);
        let section = (normal.norm() > 0.0)
            .then(|| plane_section(&self.mesh, &web, normal, from, way, Some(to)))
            .flatten()
            .filter(|section| length(section) < ASTRAY * length(&straight));
        let spots = section.unwrap_or(straight);
        Some(self.split(&spots))
    }

    /// The closed section by a plane through a vertex, which leaves it in the direction `toward`.
    pub(super) fn round(&mut self, from: u32, normal: Vec3, toward: Vec3) -> Option<Vec<u32>> {
        let web = Web::new(&self.mesh);
        let spots = plane_section(&self.mesh, &web, normal, from, toward, Some(from))?;
        Some(self.split(&spots))
    }

    fn normal(&self, v: u32) -> Vec3 {
        let own = (0..self.mesh.triangles.len()).filter(|&t| self.mesh.triangles[t].contains(&v));
        own.map(|t| self.mesh.double_normal(t)).sum::<Vec3>()
    }

    /// Splits the triangles at spots that follow each other, and gives the vertices there.
    fn split(&mut self, spots: &[SurfacePoint]) -> Vec<u32> {
        let before = self.mesh.clone();
        let mut at_edge = std::collections::BTreeMap::new();
        let mut chain = Vec::with_capacity(spots.len());
        for spot in spots {
            let vertex = match *spot {
                SurfacePoint::Vertex(v) => v,
                SurfacePoint::Edge { ends, .. } => {
                    let key = sorted_pair(ends);
                    *at_edge.entry(key).or_insert_with(|| self.split_edge(ends, spot.place(&before)))
                }
                SurfacePoint::Face { triangle, .. } => self.split_face(triangle as usize, spot.place(&before)),
            };
            chain.push(vertex);
        }
        chain
    }

    fn add(&mut self, p: Vec3) -> u32 {
        self.mesh.vertices.push(p);
        self.mesh.vertices.len() as u32 - 1
    }

    fn split_edge(&mut self, [a, b]: [u32; 2], p: Vec3) -> u32 {
        let new = self.add(p);
        for t in 0..self.mesh.triangles.len() {
            let corners = self.mesh.triangles[t];
            if corners.contains(&a) && corners.contains(&b) {
                let with = |old: u32| corners.map(|v| if v == old { new } else { v });
                self.mesh.triangles[t] = with(a);
                self.mesh.triangles.push(with(b));
            }
        }
        for line in &mut self.lines {
            while let Some(k) = line.chain.windows(2).position(|w| sorted_pair([w[0], w[1]]) == sorted_pair([a, b])) {
                line.chain.insert(k + 1, new);
            }
        }
        new
    }

    fn split_face(&mut self, t: usize, p: Vec3) -> u32 {
        let new = self.add(p);
        let [a, b, c] = self.mesh.triangles[t];
        self.mesh.triangles[t] = [a, b, new];
        self.mesh.triangles.extend([[b, c, new], [c, a, new]]);
        new
    }

    /// All edges on lines, the smaller end first.
    pub(super) fn edges(&self) -> BTreeSet<[u32; 2]> {
        let chains = self.lines.iter().flat_map(|line| line.chain.windows(2));
        chains.map(|w| sorted_pair([w[0], w[1]])).collect()
    }
}
