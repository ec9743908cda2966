//! The garment that the report is measured on.

use super::bands::Bands;
use super::schema::Stage;
use crate::geometry::{Vec2, Vec3};
use crate::mannequin::Mannequin;
use crate::mesh::{ClothMesh, UncrossedStraps};
use crate::pattern::Garment;

/// A garment and where its particles were. All slices have one entry per particle of `mesh`. Positions are metres.
#[derive(Clone, Debug)]
pub struct Measured<'a> {
    /// The checked garment.
    pub garment: &'a Garment,
    /// Its mesh.
    pub mesh: &'a ClothMesh,
    /// One label per particle, the same for particles that seams join.
    pub weld: &'a [u32],
    /// The garment with its straps uncrossed, if they cross.
    pub uncrossed: Option<&'a UncrossedStraps>,
    /// The body.
    pub body: &'a Mannequin,
    /// The fabric's name.
    pub fabric: &'a str,
    /// For every seam of the mesh the gap of each of its pairs, metres, when the seams had been closed but partners
    /// not yet put in one place. `None` takes the distances in `sewn`.
    pub gaps: Option<&'a [Vec<f64>]>,
    /// Before sewing, as the pieces were put on.
    pub placed: Option<&'a [Vec3]>,
    /// After sewing.
    pub sewn: Option<&'a [Vec3]>,
    /// After draping.
    pub draped: Option<&'a [Vec3]>,
    /// After flattening, in the plane.
    pub flattened: Option<&'a [Vec2]>,
    /// Number of crossings of each piece's rim with itself in the plane.
    pub overlaps: Option<&'a [usize]>,
    /// Normal force of the body on the particles of every label of `weld` at the end of draping, N.
    pub pressed: Option<&'a [Vec3]>,
    /// For every piece the extension along warp and weft that its fabric gives under full load, fractions.
    pub gives: &'a [[f64; 2]],
    /// Limits of the bands of pressure.
    pub bands: Bands,
    /// Reports of the stages.
    pub stages: &'a [Stage],
}
