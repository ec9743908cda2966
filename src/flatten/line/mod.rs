//! Lines on a surface that run across its triangles: plane sections and straightest ways.
//!
//! A line is a chain of spots, each of which shares a triangle with the next. Spots are vertices, points of edges or,
//! at the ends of a line, points inside a triangle; the surface is split at them afterwards, so that lines become
//! edges.

mod geodesic;
mod section;
mod web;

pub use web::Web;

use crate::geometry::{TriMesh, Vec3, distance_to_segment};

/// A line passes through a vertex that is nearer to it than this, metres: a quarter of a millimetre, which is half of
/// what a person draws straight.
const SNAP: f64 = 2.5e-4;
/// It does so within this share of the vertex's shortest edge at most, so that it bends by a few degrees only.
const SNAP_SHARE: f64 = 0.05;
/// A plane section that is nowhere further than this from the straightest way, metres, is as straight as a person can
/// draw, and smoother: it does not feel the corners of the mesh.
const AS_STRAIGHT: f64 = 5e-4;

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfacePoint {
    /// One of its vertices.
    Vertex(u32),
    /// A point of an edge.
    Edge {
        /// The edge's ends.
        ends: [u32; 2],
        /// The share of the way from the first to the second, between 0 and 1.
        at: f64,
    },
    /// A point inside a triangle.
    Face {
        /// The triangle.
        triangle: u32,
        /// The weights of its corners, which sum to one.
        weights: [f64; 3],
    },
}

impl SurfacePoint {
    /// Where it lies in space.
    pub fn place(&self, surface: &TriMesh) -> Vec3 {
        let at = |v: u32| surface.vertices[v as usize];
        match *self {
            Self::Vertex(v) => at(v),
            Self::Edge { ends: [a, b], at: share } => at(a).lerp(&at(b), share),
            Self::Face { triangle, weights } => {
                let corners = surface.corners(triangle as usize);
                corners.iter().zip(weights).map(|(p, w)| p * w).sum()
            }
        }
    }
}

/// The length of a line.
pub fn length(surface: &TriMesh, line: &[SurfacePoint]) -> f64 {
    line.windows(2).map(|w| (w[1].place(surface) - w[0].place(surface)).norm()).sum()
}

/// The straight line along a chain of neighbouring vertices: from its first to its last, on the same side of every
/// hole. Where the section by the plane through both, upright on the surface, is as straight, it is that section.
pub fn straightened(surface: &TriMesh, web: &Web, chain: &[u32]) -> Vec<SurfacePoint> {
    let straightest = geodesic::straightest(surface, web, chain);
    let (Some(&from), Some(&to)) = (chain.first(), chain.last()) else { return straightest };
    let way = surface.vertices[to as usize] - surface.vertices[from as usize];
    if from == to || straightest.len() < 3 || passes_rim(web, &straightest) {
        return straightest;
    }
    let upright = straightest.iter().map(|spot| web.normal(surface, spot)).sum::<Vec3>();
    let normal = way.cross(&upright);
    if normal.norm() <= f64::EPSILON * way.norm() * upright.norm() {
        return straightest;
    }
    let plane = CuttingPlane { through: surface.vertices[from as usize], normal: normal.normalize() };
    match section::section(surface, web, plane, from, way, Some(to)) {
        Some(section) if lies_along(surface, &section, &straightest) => section,
        _ => straightest,
    }
}

/// The line in which a plane through the vertex `from` cuts the surface, from there in the direction `toward` to the
/// rim or, where it is given, to the vertex `to`. `None` where it ends elsewhere or nowhere.
pub fn plane_section(
    surface: &TriMesh,
    web: &Web,
    normal: Vec3,
    from: u32,
    toward: Vec3,
    to: Option<u32>,
) -> Option<Vec<SurfacePoint>> {
    let plane = CuttingPlane { through: surface.vertices[from as usize], normal: normal.normalize() };
    section::section(surface, web, plane, from, toward, to)
}

/// A plane in space.
#[derive(Clone, Copy, Debug)]
struct CuttingPlane {
    through: Vec3,
    /// A unit vector.
    normal: Vec3,
}

/// Whether a line meets the rim between its ends.
fn passes_rim(web: &Web, line: &[SurfacePoint]) -> bool {
    line[1..line.len() - 1].iter().any(|spot| matches!(spot, SurfacePoint::Vertex(v) if web.is_rim(*v)))
}

/// Whether a line is nowhere further from another than what counts as straight.
fn lies_along(surface: &TriMesh, line: &[SurfacePoint], other: &[SurfacePoint]) -> bool {
    let along: Vec<Vec3> = other.iter().map(|spot| spot.place(surface)).collect();
    line.iter().all(|spot| {
        let p = spot.place(surface);
        along.windows(2).any(|w| distance_to_segment(p, [w[0], w[1]]) <= AS_STRAIGHT)
    })
}

/// The part of a line from its beginning to `length` along it, whose end is a point between two of its spots; all of it
/// where it is not that long.
pub fn begun(surface: &TriMesh, web: &Web, line: &[SurfacePoint], length: f64) -> Vec<SurfacePoint> {
    let mut left = length;
    let mut out = Vec::new();
    for w in line.windows(2) {
        out.push(w[0]);
        let step = (w[1].place(surface) - w[0].place(surface)).norm();
        if left <= step {
            out.push(web.between(surface, w[0], w[1], left / step));
            out.dedup();
            return out;
        }
        left -= step;
    }
    out.extend(line.last());
    out
}
