//! The line in which a plane cuts a surface, walked from triangle to triangle.
//!
//! Only the sides of the plane on which vertices lie decide where the walk goes, and a vertex near the plane lies on
//! it, so that the walk never depends on rounding.

use std::cmp::Ordering;

use super::web::Web;
use super::{CuttingPlane, SurfacePoint};
use crate::geometry::{TriMesh, Vec3};

/// From a vertex of the plane in the direction `toward` to the vertex `to`, or to the rim where there is none.
pub(super) fn section(
    surface: &TriMesh,
    web: &Web,
    plane: CuttingPlane,
    from: u32,
    toward: Vec3,
    to: Option<u32>,
) -> Option<Vec<SurfacePoint>> {
    let walk = Walk { surface, web, plane, ends: [Some(from), to] };
    let mut line = vec![SurfacePoint::Vertex(from)];
    let (mut spot, mut triangle) = walk.leave(from, toward)?;
    for _ in 0..=2 * surface.triangles.len() {
        let before = *line.last()?;
        line.push(spot);
        let next = match spot {
            SurfacePoint::Vertex(v) if Some(v) == to => return Some(line),
            SurfacePoint::Vertex(v) => {
                let direction = spot.place(surface) - before.place(surface);
                walk.leave(v, direction)
            }
            SurfacePoint::Edge { ends, .. } => walk.cross(triangle, ends),
            SurfacePoint::Face { .. } => None,
        };
        match next {
            Some((next, beyond)) => (spot, triangle) = (next, beyond),
            None => return if to.is_none() { Some(line) } else { None },
        }
    }
    None
}

/// A walk along a section.
struct Walk<'a> {
    surface: &'a TriMesh,
    web: &'a Web,
    plane: CuttingPlane,
    /// Vertices that lie in the plane, whatever rounding says.
    ends: [Option<u32>; 2],
}

impl Walk<'_> {
    /// On which side of the plane a vertex lies, and how far.
    fn height(&self, v: u32) -> f64 {
        let height = (self.surface.vertices[v as usize] - self.plane.through).dot(&self.plane.normal);
        if self.ends.contains(&Some(v)) || height.abs() <= self.web.near(v) { 0.0 } else { height }
    }

    /// Where an edge crosses the plane, if its ends lie on different sides.
    fn crossing(&self, a: u32, b: u32) -> Option<SurfacePoint> {
        let (p, q) = (self.height(a), self.height(b));
        (p * q < 0.0).then(|| SurfacePoint::Edge { ends: [a, b], at: p / (p - q) })
    }

    /// Where the line leaves a vertex most nearly in a direction, and the triangle it crosses.
    fn leave(&self, v: u32, toward: Vec3) -> Option<(SurfacePoint, u32)> {
        let here = self.surface.vertices[v as usize];
        let mut best: Option<(f64, SurfacePoint, u32)> = None;
        for &t in self.web.round(v) {
            let corners = self.web.corners(t);
            let k = corners.iter().position(|&w| w == v)?;
            let (b, c) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            let on_plane = [b, c].into_iter().filter(|&w| self.height(w) == 0.0).map(SurfacePoint::Vertex);
            for spot in on_plane.chain(self.crossing(b, c)) {
                let way = spot.place(self.surface) - here;
                let along = way.dot(&toward) / (way.norm() * toward.norm());
                if best.as_ref().is_none_or(|best| along.total_cmp(&best.0) == Ordering::Greater) {
                    best = Some((along, spot, t));
                }
            }
        }
        best.filter(|best| best.0 > 0.0).map(|(_, spot, t)| (spot, t))
    }

    /// Where the line goes on beyond an edge.
    fn cross(&self, triangle: u32, ends: [u32; 2]) -> Option<(SurfacePoint, u32)> {
        let beyond = self.web.beyond(triangle, ends)?;
        let apex = self.web.corners(beyond).into_iter().find(|v| !ends.contains(v))?;
        if self.height(apex) == 0.0 {
            return Some((SurfacePoint::Vertex(apex), beyond));
        }
        let spot = self.crossing(ends[0], apex).or_else(|| self.crossing(ends[1], apex))?;
        Some((spot, beyond))
    }
}
