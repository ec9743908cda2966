//! What a surface must be to serve as a body.

use super::crossing::crossings;
use crate::geometry::{DisjointSets, Topology, TriMesh, Vec3};

/// Why a surface is no body; places are in metres in the body's own frame (feet at y = 0).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyFault {
    /// Holes.
    #[error(
        "the surface is open: {edges} rim edges, one near {}; close its holes (in Blender: Mesh, Clean Up, Fill Holes)",
        millimetres(place)
    )]
    Open {
        /// Edges with one triangle.
        edges: usize,
        /// On one of them.
        place: Vec3,
    },
    /// Edges with more than two triangles.
    #[error("{edges} edges have more than two triangles, one near {}; remove inner faces", millimetres(place))]
    NonManifold {
        /// How many.
        edges: usize,
        /// On one of them.
        place: Vec3,
    },
    /// Neighbouring triangles that face opposite ways.
    #[error(
        "{pairs} neighbouring triangles face opposite ways, near {}; recalculate the normals outside",
        millimetres(place)
    )]
    Misoriented {
        /// How many pairs.
        pairs: usize,
        /// On one of them.
        place: Vec3,
    },
    /// A surface folded onto itself.
    #[error("the surface is flat: it encloses no volume; a body is a solid, so give a surface with an inside")]
    Flat,
    /// All triangles face inward.
    #[error("the surface is inside out (its volume is {litres:.1} l); flip its normals")]
    InsideOut {
        /// Negative.
        litres: f64,
    },
}

/// A surface that encloses less than this share of what a cube of its area would is flat. (A body encloses hundreds of
/// times as much, a sheet of card a metre wide and a millimetre thick thirty times.)
const FLAT: f64 = 1e-5;

/// What can be said of a surface that is fit to be a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyCheck {
    /// Pieces of surface that do not touch.
    pub parts: usize,
    /// Pairs of triangles that cross, and a point of the first. Scans and average bodies often have some between the
    /// thighs and in the armpits; they do no harm where no cloth goes.
    pub crossings: Option<(usize, Vec3)>,
}

fn millimetres(p: &Vec3) -> String {
    format!("({:.0}, {:.0}, {:.0}) mm", 1e3 * p.x, 1e3 * p.y, 1e3 * p.z)
}

/// Checks that `mesh` is closed, manifold, oriented and outward, in this order, and looks for crossings.
///
/// # Errors
/// The first [`BodyFault`].
pub fn check_body(mesh: &TriMesh) -> Result<BodyCheck, BodyFault> {
    let topology = Topology::new(&mesh.triangles);
    let at = |v: u32| mesh.vertices[v as usize];
    let edges = topology.rim_edges().count();
    if let Some(rim) = topology.rim_edges().next() {
        return Err(BodyFault::Open { edges, place: at(rim.ends[0]) });
    }
    if let Some(edge) = topology.non_manifold.first() {
        return Err(BodyFault::NonManifold { edges: topology.non_manifold.len(), place: at(edge[0]) });
    }
    if let Some(pair) = topology.misoriented.first() {
        let place = mesh.corners(pair[0] as usize)[0];
        return Err(BodyFault::Misoriented { pairs: topology.misoriented.len(), place });
    }
    let volume = mesh.signed_volume();
    if volume.abs() <= FLAT * mesh.area().powf(1.5) {
        return Err(BodyFault::Flat);
    }
    if volume <= 0.0 {
        return Err(BodyFault::InsideOut { litres: 1e3 * volume });
    }
    Ok(BodyCheck { parts: parts(mesh, &topology), crossings: crossings(mesh) })
}

/// Number of connected pieces of surface.
fn parts(mesh: &TriMesh, topology: &Topology) -> usize {
    let mut sets = DisjointSets::new(mesh.triangles.len());
    let mut count = sets.len();
    for edge in &topology.edges {
        if let [Some(s), Some(t)] = edge.triangles {
            count -= usize::from(sets.join(s, t));
        }
    }
    count
}
