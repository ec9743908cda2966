//! Why a garment cannot be sewn.

use super::place::PlaceError;
use crate::dynamics::StepError;

/// A seam that is open by less than so many times its limit is jammed rather than wrong.
const NEARLY: f64 = 5.0;

/// Why sewing ended without a garment.
#[derive(Debug, thiserror::Error)]
pub enum SewError {
    /// The pieces cannot be placed.
    #[error(transparent)]
    Place(#[from] PlaceError),
    /// A step could not be made.
    #[error("sewing stopped: {0}")]
    Step(#[from] StepError),
    /// The body is no solid that cloth can touch.
    #[error("the mannequin '{0}' cannot be used for contact; check that its mesh is closed and oriented")]
    Body(String),
    /// A piece starts in the body, and no straight way of a few centimetres leads out.
    #[error("piece '{piece}' starts inside the body by {depth_mm:.0} mm; move its place, or check the file's units")]
    InsideBody {
        /// The piece.
        piece: String,
        /// Depth of its deepest particle, mm.
        depth_mm: f64,
    },
    /// A piece hangs through the floor that the body stands on.
    #[error(
        "piece '{piece}' reaches {depth_mm:.0} mm under the floor that the body stands on; shorten what it hangs from, \
         or move its place"
    )]
    UnderFloor {
        /// The piece.
        piece: String,
        /// Depth of its lowest particle, mm.
        depth_mm: f64,
    },
    /// A seam does not close.
    #[error(
        "seam '{seam}' is still open by {gap_mm:.1} mm after {iterations} steps (limit {limit_mm:.1} mm); check that \
         its two edges begin at the same end, that a half that is drawn for the right says `drawn: R`, that a facing \
         or overlay has a layer of its own and `face: same`, that the garment is large enough for the body there, and \
         the place of '{piece_a}' and '{piece_b}'{}",
        if self.is_nearly_closed() { "; it is all but closed: another --spacing may do" } else { "" }
    )]
    Open {
        /// The seam.
        seam: String,
        /// Its widest gap, mm.
        gap_mm: f64,
        /// The limit, mm.
        limit_mm: f64,
        /// Steps made.
        iterations: usize,
        /// A piece it joins.
        piece_a: String,
        /// The other.
        piece_b: String,
    },
}

impl SewError {
    /// Whether a seam is open by so little that it has jammed.
    pub fn is_nearly_closed(&self) -> bool {
        matches!(self, Self::Open { gap_mm, limit_mm, .. } if *gap_mm < NEARLY * limit_mm)
    }
}
