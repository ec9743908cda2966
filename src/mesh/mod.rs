//! Pieces as regular spring-mass grids (F1).

mod assemble;
mod blame;
mod breaks;
mod build;
mod check;
mod chords;
mod coons;
mod course;
mod crossings;
mod earlier;
mod elastic;
mod error;
mod fill;
mod frame;
mod grid;
mod improve;
mod lattice;
mod layout;
mod limits;
mod lines;
mod links;
mod patch;
mod sampling;
mod shape;
mod spans;
mod springs;
mod strip;
mod transfer;

use std::ops::Range;

pub use build::{build, build_with};
pub use check::{CheckError, check};
pub use earlier::{EarlierMesh, EarlierPiece, Edges, interpolated};
pub use elastic::DrawnIn;
pub use error::{MeshError, SeamFault};
pub use springs::SpringClass;
pub use transfer::Transfer;

use crate::geometry::Vec2;
use crate::pattern::{Closure, EdgeId, LineKind};

/// How pieces are meshed inside.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MeshMethod {
    /// Long narrow four-sided pieces (bands) in straight columns from rim to rim, all others as a grid.
    #[default]
    Auto,
    /// Every piece as a grid along the grain.
    Grid,
    /// Every four-sided piece by transfinite (Coons) interpolation between its sides, where they can be given equal
    /// numbers of particles. All others as a grid.
    Coons,
}

/// Options of the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshOptions {
    /// Length of the springs along warp and weft, metres.
    pub spacing: f64,
    /// How pieces are meshed inside.
    pub method: MeshMethod,
}

/// All pieces of a garment, meshed. Particles of different pieces are different particles, also along seams.
#[derive(Clone, Debug, Default)]
pub struct ClothMesh {
    /// Target spacing, metres.
    pub spacing: f64,
    /// Flat position of every particle, metres, y down (as drawn).
    pub flat: Vec<Vec2>,
    /// Triangles. Clockwise on screen in the flat: in space (c − a) × (b − a) points out of the cloth's right side.
    pub triangles: Vec<[u32; 3]>,
    /// One per piece of the garment, same order.
    pub pieces: Vec<PieceMesh>,
    /// One per seam of the garment, same order.
    pub seams: Vec<Stitches>,
}

/// The part of a [`ClothMesh`] that is one piece.
#[derive(Clone, Debug)]
pub struct PieceMesh {
    /// As in the garment.
    pub name: String,
    /// Its particles.
    pub particles: Range<usize>,
    /// Its triangles.
    pub triangles: Range<usize>,
    /// Particles along every edge, both ends included, in the edge's direction.
    pub edges: Vec<EdgeParticles>,
    /// Particles along every line that bends or gathers the cloth, in the line's direction.
    pub lines: Vec<LineParticles>,
    /// Smallest triangle angle, radians.
    pub smallest_angle: f64,
    /// Warp direction in the flat piece (unit).
    pub warp: Vec2,
    /// Measures of a piece that is narrower than the spacing. `None` for other pieces.
    pub narrow: Option<Narrow>,
}

/// Measures of a piece that is narrower than the spacing. It has one row of cells across.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Narrow {
    /// Width of the rectangle with the piece's area and perimeter, metres.
    pub width: f64,
    /// Length of its springs along, metres.
    pub along: f64,
}

impl ClothMesh {
    /// The piece that a particle is of. `None` for one that is not the mesh's.
    pub fn piece_of(&self, particle: u32) -> Option<usize> {
        self.pieces.iter().position(|piece| piece.particles.contains(&(particle as usize)))
    }

    /// The particle of a piece that is nearest to a place of its flat shape.
    pub fn nearest(&self, piece: usize, at: Vec2) -> Option<usize> {
        let far = |p: &usize| (self.flat[*p] - at).norm_squared();
        self.pieces.get(piece)?.particles.clone().min_by(|p, q| far(p).total_cmp(&far(q)))
    }
}

/// A garment whose straps cross as it is once they are uncrossed: its rims are those of any other garment.
#[derive(Clone, Debug)]
pub struct UncrossedStraps {
    /// One label per particle, the same for particles that seams join.
    pub weld: Vec<u32>,
    /// The closures.
    pub closures: Vec<Closure>,
}

/// Particles of an edge.
#[derive(Clone, Debug)]
pub struct EdgeParticles {
    /// The edge.
    pub edge: EdgeId,
    /// Its name.
    pub name: String,
    /// Global particle indices.
    pub particles: Vec<u32>,
}

/// Particles of an internal line, or of one of the parts that darts, holes and edges cut it into.
#[derive(Clone, Debug)]
pub struct LineParticles {
    /// The line's name. That of a part is numbered, `casing.1`, `casing.2`.
    pub name: String,
    /// Its kind.
    pub kind: LineKind,
    /// Global particle indices.
    pub particles: Vec<u32>,
}

/// The particle pairs of a seam.
#[derive(Clone, Debug)]
pub struct Stitches {
    /// The seam's name.
    pub name: String,
    /// Sewing order: all seams of a stage close before the next stage starts.
    pub stage: i32,
    /// Pairs (a, b) from the seam's start to its end, both ends included. A pair may hold the same particle twice (the
    /// tip of a dart).
    pub pairs: Vec<[u32; 2]>,
}
