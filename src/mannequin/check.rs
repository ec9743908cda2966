//! Requirements of a surface that serves as a body.

use std::fmt;

use super::crossing::crossings;
use crate::geometry::{DisjointSets, Topology, TriMesh, Vec3};
use crate::input::LengthUnit;

/// A place on a surface, in the coordinates and the unit of its own file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilePlace {
    /// Coordinates.
    pub at: Vec3,
    /// Their unit.
    pub unit: LengthUnit,
}

impl FilePlace {
    /// A point in metres, told in millimetres.
    pub fn millimetres(p: Vec3) -> Self {
        let unit = LengthUnit::Millimetre;
        Self { at: p / unit.metres(), unit }
    }
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (p, digits) = (self.at, self.unit.decimals());
        write!(f, "({:.digits$}, {:.digits$}, {:.digits$}) {}", p.x, p.y, p.z, self.unit.symbol())
    }
}

/// Why a surface is no body.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BodyFault {
    /// Holes.
    #[error(
        "the surface is open: {edges} rim edges, one near {place}; close its holes (in Blender: Mesh, Clean Up, Fill \
         Holes)"
    )]
    Open {
        /// Edges with one triangle.
        edges: usize,
        /// On one of them.
        place: FilePlace,
    },
    /// Edges with more than two triangles.
    #[error("{edges} edges have more than two triangles, one near {place}; remove inner faces")]
    NonManifold {
        /// Number of rim edges.
        edges: usize,
        /// On one of them.
        place: FilePlace,
    },
    /// Neighbouring triangles that face opposite ways.
    #[error("{pairs} neighbouring triangles face opposite ways, near {place}; recalculate the normals outside")]
    Misoriented {
        /// Number of crossing pairs.
        pairs: usize,
        /// On one of them.
        place: FilePlace,
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

/// Least enclosed volume of a body, as a share of the volume of a cube with the same area. Less counts as flat. A body
/// encloses hundreds of times as much, a sheet of card a metre wide and a millimetre thick thirty times.
const FLAT: f64 = 1e-5;

/// Findings about a surface that is fit to be a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyCheck {
    /// Pieces of surface that do not touch.
    pub parts: usize,
    /// Pairs of triangles that cross, and a point of the first, metres. Scans and average bodies often have some in
    /// the armpits and between the thighs. They do no harm where no cloth goes.
    pub crossings: Option<(usize, Vec3)>,
}

/// Checks that `mesh` (metres) is closed, manifold, oriented and outward, in this order, and looks for crossings.
/// `told` gives the place to tell of a point.
///
/// # Errors
/// The first [`BodyFault`].
pub fn check_body(mesh: &TriMesh, told: impl Fn(Vec3) -> FilePlace) -> Result<BodyCheck, BodyFault> {
    let topology = Topology::new(&mesh.triangles);
    let at = |v: u32| told(mesh.vertices[v as usize]);
    let edges = topology.rim_edges().count();
    if let Some(rim) = topology.rim_edges().next() {
        return Err(BodyFault::Open { edges, place: at(rim.ends[0]) });
    }
    if let Some(edge) = topology.non_manifold.first() {
        return Err(BodyFault::NonManifold { edges: topology.non_manifold.len(), place: at(edge[0]) });
    }
    if let Some(pair) = topology.misoriented.first() {
        let place = told(mesh.corners(pair[0] as usize)[0]);
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
