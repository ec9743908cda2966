//! Why a garment's seams do not close, where a reason is found.

use std::path::PathBuf;

use crate::mannequin::PartKind;

/// A seam that stayed open round an arm or a leg.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{}: seam '{seam}' is still open by {gap_mm:.1} mm: the {} is between its two edges{}; take a body {}, or make \
     '{}' and '{}' less wide, so that they start beside it and not round it",
    file.display(), limb.name(), hung(opening.as_deref()), apart(*limb), pieces[0], pieces[1]
)]
pub struct Caught {
    /// The garment file.
    pub file: PathBuf,
    /// The seam.
    pub seam: String,
    /// Its widest gap, mm.
    pub gap_mm: f64,
    /// The arm or leg.
    pub limb: PartKind,
    /// The opening at the end of the seam that is nearer to the hand or foot.
    pub opening: Option<String>,
    /// The pieces that the seam joins.
    pub pieces: [String; 2],
}

/// The opening that hangs on the hand or foot, in words.
fn hung(opening: Option<&str>) -> String {
    opening.map_or_else(String::new, |opening| format!(", and the opening '{opening}' hangs on it"))
}

/// Advice on a body with room round a limb.
fn apart(limb: PartKind) -> &'static str {
    if limb.is_leg() {
        "with its legs further apart (--body)"
    } else {
        "with its arms further from the trunk (--body; `abduction` in a mannequin's file)"
    }
}

/// A seam that stayed open, and two pieces that were placed so that they could not be led apart. (Cloth that starts
/// without a crossing comes to none while a seam is far open.)
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{}: seam '{seam}' is still open by {gap_mm:.1} mm: '{}' and '{}' {how} near ({:.0}, {:.0}, {:.0}) mm and could \
     not be led apart; place them neither across one another nor in one place",
    file.display(), pieces[0], pieces[1], near[0], near[1], near[2]
)]
pub struct Across {
    /// The garment file.
    pub file: PathBuf,
    /// The seam.
    pub seam: String,
    /// Its widest gap, mm.
    pub gap_mm: f64,
    /// The pieces that are stuck in one another.
    pub pieces: [String; 2],
    /// Their relation, in words.
    pub how: &'static str,
    /// Place in the frame of the body's file, mm.
    pub near: [f64; 3],
}

/// A piece that would have to stretch by more than its cloth can.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{}: piece '{piece}' is too small for the body: its seams close only if it is drawn out by {by:.0} % along its \
     {thread}, on average, and {fabric} gives no more than {gives:.0} %; make it larger there, or take a cloth that \
     gives more",
    file.display()
)]
pub struct TooSmall {
    /// The garment file.
    pub file: PathBuf,
    /// The piece.
    pub piece: String,
    /// `warp` or `weft`.
    pub thread: &'static str,
    /// Its mean strain along that, percent.
    pub by: f64,
    /// The piece's fabric.
    pub fabric: String,
    /// Strain at which that is taken to tear, percent.
    pub gives: f64,
}
