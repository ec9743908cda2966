//! Sides of seams given the lengths that fit each other.

use nalgebra::{DMatrix, DVector};

use super::Fault;
use super::reshape::ShiftedPiece;
use crate::geometry::Vec2;
use crate::pattern::{Findings, GarmentFile, Give, Problem, Seam, SeamKind, Spot, expand};

/// Seams fit each other when they are off by less, metres: a tenth of what a seam may be off by.
const FITS: f64 = 1e-6;
/// Most rounds of moving corners. Each leaves about a hundredth of what was off.
const ROUNDS: usize = 6;
/// By how much a corner is moved to see what becomes of the lengths, metres.
const TRIAL: f64 = 1e-3;
/// Changes of length by metre of a corner's way that count as none.
const NONE: f64 = 1e-3;

/// A corner that may be moved along a direction.
struct MovableCorner {
    shape: usize,
    corner: usize,
    along: Vec2,
}

/// Writes the shapes into the file. Corners of the pieces that change are moved by the least amounts (in squares) that
/// keep the difference of the two sides of each seam, or their ratio where one is gathered or stretched. Gives the file
/// and how far a seam is off.
pub(super) fn evened(file: &GarmentFile, shapes: &[ShiftedPiece]) -> Result<(GarmentFile, f64), Fault> {
    let before = seams(file)?;
    let still: Vec<Vec<Vec2>> = shapes.iter().map(|s| vec![Vec2::zeros(); s.corners()]).collect();
    let written = |tilt: &[Vec<Vec2>]| -> Result<GarmentFile, Fault> {
        let mut new = file.clone();
        shapes.iter().zip(tilt).try_for_each(|(shape, tilt)| shape.write(&mut new, tilt))?;
        Ok(new)
    };
    let off = |new: &GarmentFile| -> Result<DVector<f64>, Fault> { missed(&before, &seams(new)?, new) };
    let mut tilt = still;
    let mut new = written(&tilt)?;
    let mut miss = off(&new)?;
    let mut slopes: Option<DMatrix<f64>> = None;
    let knobs = knobs(shapes);
    for _ in 0..ROUNDS {
        if miss.amax() <= FITS || knobs.is_empty() {
            break;
        }
        let back = match &slopes {
            Some(back) => back,
            None => {
                let mut effects = DMatrix::zeros(miss.len(), knobs.len());
                for (k, knob) in knobs.iter().enumerate() {
                    let mut tried = tilt.clone();
                    tried[knob.shape][knob.corner] += knob.along * TRIAL;
                    effects.set_column(k, &((off(&written(&tried)?)? - &miss) / TRIAL));
                }
                let singular = |_| (Spot::default(), Problem::Unreadable("seams cannot be made to fit".to_owned()));
                slopes.insert(effects.pseudo_inverse(NONE).map_err(singular)?)
            }
        };
        let moves = -(back * &miss);
        for (knob, by) in knobs.iter().zip(moves.iter()) {
            tilt[knob.shape][knob.corner] += knob.along * *by;
        }
        new = written(&tilt)?;
        miss = off(&new)?;
    }
    let left = if miss.is_empty() { 0.0 } else { miss.amax() };
    Ok((new, left))
}

/// The corners that may be moved. Pieces that keep their shape keep it to the last digit.
fn knobs(shapes: &[ShiftedPiece]) -> Vec<MovableCorner> {
    let of = |(shape, s): (usize, &ShiftedPiece)| {
        let along = |corner| s.directions(corner).into_iter().map(move |along| MovableCorner { shape, corner, along });
        (0..s.corners()).flat_map(along).collect::<Vec<_>>()
    };
    shapes.iter().enumerate().filter(|(_, s)| !s.is_still()).flat_map(of).collect()
}

/// The seams that a file states.
fn seams(file: &GarmentFile) -> Result<Vec<Seam>, Fault> {
    // Faults are reported when the new file is read.
    let garment = expand("", file, &mut Findings::default());
    let why = || (Spot::default(), Problem::Unreadable("its new shape is no garment".to_owned()));
    let written = |seam: &Seam| seam.kind == SeamKind::Written;
    Ok(garment.ok_or_else(why)?.seams.into_iter().filter(written).collect())
}

/// By how much each seam is off.
fn missed(before: &[Seam], after: &[Seam], file: &GarmentFile) -> Result<DVector<f64>, Fault> {
    if before.len() != after.len() {
        let why = "its new shape has other seams".to_owned();
        return Err((file.version.at, Problem::Unreadable(why)));
    }
    let off = |(old, new): (&Seam, &Seam)| match old.give {
        Give::Even | Give::Ease(_) => (new.length_a() - new.length_b()) - (old.length_a() - old.length_b()),
        Give::Gather(_) | Give::Stretch(_) => new.length_a() - new.length_b() * (old.length_a() / old.length_b()),
    };
    Ok(DVector::from_iterator(before.len(), before.iter().zip(after).map(off)))
}
