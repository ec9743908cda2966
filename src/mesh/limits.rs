//! Refuses spacings that do not suit a garment, before anything is allocated.

use super::error::MeshError;
use crate::pattern::{Garment, Piece};

/// The grain is a unit vector to this much.
const UNIT: f64 = 1e-6;
/// Springs across that an error recommends.
const GOOD_SPRINGS_ACROSS: f64 = 3.0;
/// Widths are as exact as this, metres: the spacing that an error names is accepted.
const ROUNDING: f64 = 1e-9;
/// Largest mesh that is built; two million particles take some gigabytes in the later stages.
const MOST_PARTICLES: usize = 2_000_000;

/// Checks the spacing against every piece.
pub(super) fn check(garment: &Garment, spacing: f64) -> Result<(), MeshError> {
    if !(spacing.is_finite() && spacing > 0.0) {
        return Err(MeshError::Spacing(spacing));
    }
    let (mut cloth, mut rim) = (0.0, 0.0);
    for piece in &garment.pieces {
        check_grain(piece)?;
        let (area, perimeter) = measure(piece)?;
        let width = width(area, perimeter);
        // Its triangles would be good ones (27° and more at 0.6 of a spring), but so small that the piece, and what is
        // sewn to it, is not what was asked for.
        if width < spacing - ROUNDING {
            return Err(MeshError::TooCoarse {
                piece: piece.name.clone(),
                width,
                spacing,
                largest: round_down(width),
                good: round_down(width / GOOD_SPRINGS_ACROSS),
            });
        }
        cloth += area;
        rim += 0.5 * perimeter;
    }
    let expected = cloth / (spacing * spacing) + rim / spacing;
    if expected > MOST_PARTICLES as f64 {
        return Err(MeshError::TooMany {
            particles: expected as usize,
            limit: MOST_PARTICLES,
            spacing,
            usable: round_up(usable(cloth, rim, MOST_PARTICLES as f64)),
        });
    }
    Ok(())
}

/// The lattice runs along the grain, so there must be one.
fn check_grain(piece: &Piece) -> Result<(), MeshError> {
    let length = piece.warp.norm();
    // Written so that a NaN fails too.
    let is_unit = (length - 1.0).abs() < UNIT;
    if is_unit { Ok(()) } else { Err(MeshError::Grain { piece: piece.name.clone(), length }) }
}

/// Area and total rim length of a piece.
fn measure(piece: &Piece) -> Result<(f64, f64), MeshError> {
    if piece.loops.is_empty() || piece.loops.iter().any(Vec::is_empty) {
        return Err(MeshError::NoOutline { piece: piece.name.clone() });
    }
    let (area, perimeter) = (piece.area(), piece.boundary_length());
    if !(area > 0.0 && perimeter.is_finite()) {
        return Err(MeshError::InsideOut { piece: piece.name.clone(), area });
    }
    Ok((area, perimeter))
}

/// Width of the rectangle with this area and perimeter; a bent strip or a ring has the width of the strip.
fn width(area: f64, perimeter: f64) -> f64 {
    let half = 0.5 * perimeter;
    let root = (half * half - 4.0 * area).max(0.0).sqrt();
    0.5 * (half - root)
}

/// The spacing at which cloth of this area and half rim makes so many particles.
fn usable(cloth: f64, rim: f64, particles: f64) -> f64 {
    (rim + (rim * rim + 4.0 * cloth * particles).sqrt()) / (2.0 * particles)
}

/// The hundredth of a millimetre below, which messages show.
fn round_down(metres: f64) -> f64 {
    ((metres + 0.5 * ROUNDING) * 1e5).floor() / 1e5
}

/// The next tenth of a millimetre.
fn round_up(metres: f64) -> f64 {
    (metres * 1e4).ceil() / 1e4
}
