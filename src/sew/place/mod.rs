//! Where the pieces start (F10): bent round the body part each one is made for.
//!
//! ```text
//! fold · pleat · flare · band ─▶ assign ─▶ rows ─▶ levels ─▶ wrap · ring · shoulders · arms ─▶ lay
//!  folded, laid, unrolled,       which      pieces side by     how they      rings round the part,   facings and
//!  turned level                  part       side, rows one     pack at       seams nearly meeting;   linings on what
//!                                           over another       every height  tops leaning over       they line
//!                                                                            the body
//! ```
//!
//! A garment is laid out as it would hang on a lampshade: pieces that share an upright seam stand side by side in a
//! *row*; rows that share a level seam (skirt and waistband, sleeve and cuff) stand one over the other; every row is
//! bent round its body part on an ellipse wide enough for the body and for the cloth. Nothing here is exact, and
//! nothing has to be: the springs undo the small distortions as soon as the sewing begins. What counts is that every
//! seam starts on the right side of the body with its partner near, and that no piece starts in another or in the body.

mod arms;
mod assign;
mod band;
mod ellipse;
mod flare;
mod flute;
pub(super) mod fold;
mod insert;
mod lap;
pub(super) mod lay;
mod levels;
mod pleat;
pub(super) mod ring;
mod rows;
mod shoulders;
mod sides;
mod stations;
mod wrap;

use crate::contact::Collider;
use crate::geometry::Vec3;
use crate::mannequin::Mannequin;
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::{Garment, Place, place_words};
pub(super) use assign::goes_between_legs;

/// A piece that starts smaller than this share of its size has no place; one wound round the body many times is larger.
const SMALLEST: f64 = 0.02;

/// Why pieces cannot be placed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlaceError {
    /// A word of `place:` names no body part.
    #[error("piece '{piece}': place '{words}' names no body part; use {}", place_words(str::to_owned))]
    Words {
        /// The piece.
        piece: String,
        /// The words.
        words: String,
    },
    /// The body has no such part.
    #[error(
        "piece '{piece}' goes round the {part}, which mannequin '{mannequin}' does not have; give it a place: {{at: \
         [x, y, z]}}"
    )]
    NoPart {
        /// The piece.
        piece: String,
        /// The part.
        part: &'static str,
        /// The mannequin.
        mannequin: String,
    },
    /// A seam joins two pieces by the same side of both.
    #[error(
        "seam '{seam}' joins the {side} side of '{piece}' to the {side} side of '{to}', each seen from outside: pieces \
         side by side meet right to left. If one of them shows the wearer's right half, as a back drawn to the right \
         of its centre does, write 'drawn: R' into it (or take that out where it is wrong); if the seam says L and R, \
         each is sewn to its own; or one of them is drawn upside down"
    )]
    Sides {
        /// The seam.
        seam: String,
        /// The piece it sews.
        piece: String,
        /// The piece it is sewn to.
        to: String,
        /// `left` or `right`.
        side: &'static str,
    },
    /// The seams of a piece ask for it to be nowhere.
    #[error(
        "piece '{piece}' finds no place: its seams contradict each other; check which edges they name (a front's right \
         side is sewn to a back's left) and which half is drawn (`drawn: L` or `R`), or give it a place: \
         {{at: [x, y, z]}}"
    )]
    Nowhere {
        /// The piece.
        piece: String,
    },
}

/// Start positions of all particles, on `body`; `collider` is its surface.
///
/// # Errors
/// [`PlaceError`] when a piece's place names a part that is none or that the body has not, when a seam joins pieces by
/// the same side of both, or when its seams leave a piece no place.
pub fn place(
    garment: &Garment,
    mesh: &ClothMesh,
    body: &Mannequin,
    collider: &Collider,
) -> Result<Vec<Vec3>, PlaceError> {
    let sheet = fold::folded(garment, mesh);
    let assigned = assign::assign(garment, mesh)?;
    let rows = rows::rows(garment, mesh, &sheet, &assigned);
    sides::check(garment, mesh, &sheet, &assigned, &rows)?;
    let mut x = wrap::wrap(garment, mesh, body, collider, &sheet, &rows)?;
    for (piece, part) in garment.pieces.iter().zip(&mesh.pieces) {
        if let Some(Place::At { at, turn }) = &piece.place {
            let [rx, ry, rz] = [turn.x, turn.y, turn.z].map(f64::to_radians);
            let rotation = nalgebra::Rotation3::from_euler_angles(rx, ry, rz);
            for p in part.particles.clone() {
                // The flat piece's y runs down, space's y up.
                x[p] = at + rotation * Vec3::new(mesh.flat[p].x, -mesh.flat[p].y, 0.0);
            }
        }
    }
    lay::lay(garment, mesh, &sheet, &rows.laid, &mut x);
    match mesh.pieces.iter().find(|piece| !has_room(mesh, piece, &x)) {
        Some(piece) => Err(PlaceError::Nowhere { piece: piece.name.clone() }),
        None => Ok(x),
    }
}

/// Whether a piece is anywhere, and not all in one point.
fn has_room(mesh: &ClothMesh, piece: &PieceMesh, x: &[Vec3]) -> bool {
    let range = piece.particles.clone();
    let first = range.start;
    let drawn = range.clone().map(|p| (mesh.flat[p] - mesh.flat[first]).norm()).fold(0.0, f64::max);
    let start = range.clone().map(|p| (x[p] - x[first]).norm()).fold(0.0, f64::max);
    range.into_iter().all(|p| x[p].iter().all(|c| c.is_finite())) && start > SMALLEST * drawn
}
