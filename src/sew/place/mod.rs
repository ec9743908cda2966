//! Pieces before anything is sewn: folded and pleated flat, laid on one another, and at positions that a file gives.
//!
//! ```text
//! fold · pleat ─▶ lay
//!  folded flat     facings and linings on the cloth that they line
//! ```
//!
//! The start of all other pieces comes from the topology of the garment ([`super::start`]).

pub(super) mod fold;
pub(super) mod folded;
pub(super) mod lay;
mod pleat;
mod sides;

use crate::geometry::Vec3;
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, Place};
pub use sides::{SameSide, same_sides};

/// Why a piece has no start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlaceError {
    /// No part of the body passes through an opening of the piece and what it is sewn to.
    #[error(
        "piece '{piece}' finds no place: no part of mannequin '{mannequin}' passes through an opening of it and of \
         what it is sewn to (lengths: {openings}), so that nothing holds it; look at its size and units, sew it to \
         what is worn, or give it a place: {{at: [x, y, z]}}"
    )]
    Unworn {
        /// The piece.
        piece: String,
        /// The mannequin.
        mannequin: String,
        /// The lengths of the openings, in words.
        openings: String,
    },
    /// The body has no parts, as an object has none.
    #[error(
        "piece '{piece}' finds no place: mannequin '{mannequin}' has no trunk or limbs that it could go round; give it \
         a place: {{at: [x, y, z]}} (x to the wearer's left, y up, z forward)"
    )]
    NoParts {
        /// The piece.
        piece: String,
        /// The mannequin.
        mannequin: String,
    },
}

/// Start positions of all particles of a garment whose pieces have positions of their own, or lie on such pieces.
/// `None` for any other garment.
pub fn positioned(garment: &Garment, mesh: &ClothMesh) -> Option<Vec<Vec3>> {
    let rest: Vec<usize> = (0..garment.pieces.len()).filter(|&piece| !garment.pieces[piece].has_position()).collect();
    if rest.len() == garment.pieces.len() {
        return None;
    }
    let mut x = vec![Vec3::zeros(); mesh.flat.len()];
    for (piece, part) in garment.pieces.iter().zip(&mesh.pieces) {
        let Some(Place::At { at, turn }) = &piece.place else { continue };
        let [rx, ry, rz] = [turn.x, turn.y, turn.z].map(f64::to_radians);
        let rotation = nalgebra::Rotation3::from_euler_angles(rx, ry, rz);
        for p in part.particles.clone() {
            // The flat piece's y runs down, space's y up.
            x[p] = at + rotation * Vec3::new(mesh.flat[p].x, -mesh.flat[p].y, 0.0);
        }
    }
    let sheet = fold::pressed(garment, mesh);
    let laid = lay::laid_on_rest(garment, mesh, &sheet, &rest);
    if rest.iter().any(|&piece| laid[piece].is_none()) {
        return None;
    }
    lay::lay(garment, mesh, &sheet, &laid, &mut x);
    Some(x)
}
