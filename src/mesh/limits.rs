//! The spacing of every piece: finer than asked for where a piece is narrow. Refuses spacings that are larger than
//! everything, or would make too many particles, before anything is allocated.

use super::Narrow;
use super::error::MeshError;
use crate::pattern::{Garment, Piece};

/// Tolerance of the length of the grain vector, which must be 1.
const UNIT: f64 = 1e-6;
/// Largest length of a spring along a narrow piece, in widths of the piece. One row of cells across then has angles of
/// at least 18°. It costs fewer particles than square cells, which seams would pass on to neighbouring pieces.
const LONGEST_CELL: f64 = 3.0;
/// Length of a piece of one row of cells, in springs, below which it counts as a plate: it cannot go round anything.
const LEAST_ALONG: f64 = 4.0;
/// Number of springs across that an error message recommends.
const GOOD_SPRINGS_ACROSS: f64 = 3.0;
/// Accuracy of widths, metres: a piece exactly one spacing wide is not narrow.
const ROUNDING: f64 = 1e-9;
/// Largest number of particles that is meshed. Two million take some gigabytes in the later stages.
const MOST_PARTICLES: usize = 2_000_000;

/// Fineness of the mesh of a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fineness {
    /// Longest springs along its rim and inside it, metres.
    pub(super) spacing: f64,
    /// Set where the piece is narrower than the spacing asked for.
    pub(super) narrow: Option<Narrow>,
}

impl Fineness {
    fn of(width: f64, spacing: f64) -> Self {
        if width < spacing - ROUNDING {
            let along = spacing.min(LONGEST_CELL * width);
            Self { spacing: along, narrow: Some(Narrow { width, along }) }
        } else {
            Self { spacing, narrow: None }
        }
    }
}

/// Fineness of every piece when `spacing` (metres) is asked for.
pub(super) fn fineness(garment: &Garment, spacing: f64) -> Result<Vec<Fineness>, MeshError> {
    if !(spacing.is_finite() && spacing > 0.0) {
        return Err(MeshError::Spacing(spacing));
    }
    let mut sizes = Vec::with_capacity(garment.pieces.len());
    for piece in &garment.pieces {
        check_grain(piece)?;
        sizes.push(Size::of(piece)?);
    }
    let all: Vec<Fineness> = sizes.iter().map(|size| Fineness::of(size.width, spacing)).collect();
    check_coarse(garment, &sizes, &all, spacing)?;
    check_fine(&sizes, &all, spacing)?;
    Ok(all)
}

/// Some piece must be worth its cells.
fn check_coarse(garment: &Garment, sizes: &[Size], all: &[Fineness], spacing: f64) -> Result<(), MeshError> {
    let is_plate = |(size, own): (&Size, &Fineness)| own.narrow.is_some() && size.length < LEAST_ALONG * own.spacing;
    let widest = sizes.iter().zip(&garment.pieces).max_by(|a, b| a.0.width.total_cmp(&b.0.width));
    match widest.filter(|_| sizes.iter().zip(all).all(is_plate)) {
        None => Ok(()),
        Some((size, piece)) => Err(MeshError::TooCoarse {
            piece: piece.name.clone(),
            width: size.width,
            length: size.length,
            spacing,
            largest: round_down(size.width),
            good: round_down(size.width / GOOD_SPRINGS_ACROSS),
        }),
    }
}

/// There must not be too many particles.
fn check_fine(sizes: &[Size], all: &[Fineness], spacing: f64) -> Result<(), MeshError> {
    let particles = |(size, own): (&Size, &Fineness)| size.area / own.spacing.powi(2) + size.rim / own.spacing;
    let expected: f64 = sizes.iter().zip(all).map(particles).sum();
    if expected <= MOST_PARTICLES as f64 {
        return Ok(());
    }
    let cloth: f64 = sizes.iter().map(|size| size.area).sum();
    let rim: f64 = sizes.iter().map(|size| size.rim).sum();
    Err(MeshError::TooMany {
        particles: expected as usize,
        limit: MOST_PARTICLES,
        spacing,
        usable: round_up(usable(cloth, rim, MOST_PARTICLES as f64)),
    })
}

/// The lattice runs along the grain, so there must be one.
fn check_grain(piece: &Piece) -> Result<(), MeshError> {
    let length = piece.warp.norm();
    // Written so that a NaN fails too.
    let is_unit = (length - 1.0).abs() < UNIT;
    if is_unit { Ok(()) } else { Err(MeshError::Grain { piece: piece.name.clone(), length }) }
}

/// Size of a piece, metres.
struct Size {
    area: f64,
    /// Half of the length of its rim, that of holes with it.
    rim: f64,
    /// Sides of the rectangle with this area and rim. A bent strip or a ring has the width of the strip.
    width: f64,
    length: f64,
}

impl Size {
    fn of(piece: &Piece) -> Result<Self, MeshError> {
        if piece.loops.is_empty() || piece.loops.iter().any(Vec::is_empty) {
            return Err(MeshError::NoOutline { piece: piece.name.clone() });
        }
        let (area, rim) = (piece.area(), 0.5 * piece.boundary_length());
        if !(area > 0.0 && rim.is_finite()) {
            return Err(MeshError::InsideOut { piece: piece.name.clone(), area });
        }
        let root = (rim * rim - 4.0 * area).max(0.0).sqrt();
        Ok(Self { area, rim, width: 0.5 * (rim - root), length: 0.5 * (rim + root) })
    }
}

/// The spacing at which cloth of this area and half rim makes this number of particles.
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
