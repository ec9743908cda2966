//! Alterations: a garment file changed as a maker changes a pattern, exactly on its curves.
//!
//! [`altered`] carries out a list of alterations on the outlines. Names, notches, grain, allowances and seams stay.
//! Every position along an edge (notches, darts, pleats) goes with the cloth that it marks.

mod course;
mod cut;
mod even;
mod fullness;
mod join;
mod laying;
mod lengthen;
mod name;
mod open;
mod parts;
mod reshape;
mod sheet;
mod shift;

pub use reshape::{Given, Reshaped, reshape};

use crate::pattern::{AlterationFile, Findings, GarmentFile, Located, Problem, Spot};

/// A mistake of an alteration and its place in the file.
type Fault = (Spot, Problem);

/// The file with its alterations carried out, those of `alter` first and then those of the size. The first
/// that cannot be done is reported, and the file has those before it. A size has no sizes.
pub fn altered(file: &GarmentFile, size: Option<&str>, findings: &mut Findings) -> GarmentFile {
    let mut own = file.clone();
    let mut list = std::mem::take(&mut own.alter);
    if let Some(wanted) = size {
        let sizes = std::mem::take(&mut own.sizes);
        match sizes.iter().find(|s| s.name.value == wanted) {
            Some(size) => list.extend(size.alter.iter().cloned()),
            None => findings.error(Spot::default(), name::unknown_size(wanted, &sizes)),
        }
    }
    carry_out(&mut own, &list, findings);
    own
}

/// Carries out alterations on a file, in order, up to the first that cannot be done, which is reported.
pub fn carry_out(file: &mut GarmentFile, list: &[Located<AlterationFile>], findings: &mut Findings) {
    for alteration in list {
        let mut next = file.clone();
        match one(&mut next, alteration) {
            Ok(()) => *file = next,
            Err((at, problem)) => {
                // The place of an outline is of no help where the fault is the alteration's.
                let own = matches!(problem, Problem::AlterCrosses { .. });
                findings.error(if own { alteration.at } else { at }, problem);
                return;
            }
        }
    }
}

/// Lengths as drawn of the edges of every piece with an outline of its own, metres: `piece.edge` each.
pub fn edge_lengths(file: &GarmentFile) -> Vec<(String, f64)> {
    let sheets = (0..file.pieces.len()).filter_map(|index| sheet::AlteredPiece::read(file, index).ok());
    let lengths =
        |s: sheet::AlteredPiece| (0..s.edges.len()).map(|i| (s.shown(i), s.edges[i].length())).collect::<Vec<_>>();
    sheets.flat_map(lengths).collect()
}

/// Lengths that are sewn of the edges of every piece with an outline of its own, without the mouths of darts, and the
/// intakes of its darts, metres: `piece.edge` and `piece.dart` each.
pub fn sewn_lengths(file: &GarmentFile) -> [Vec<(String, f64)>; 2] {
    let [mut edges, mut darts] = [Vec::new(), Vec::new()];
    for (index, piece) in file.pieces.iter().enumerate() {
        let Ok(sheet) = sheet::AlteredPiece::read(file, index) else { continue };
        let intake = |dart: usize| piece.darts[dart].intake.value.value(sheet.unit);
        let wedges = sheet.wedges(piece);
        for edge in 0..sheet.edges.len() {
            let mouths: f64 = wedges.iter().filter(|w| w.edge == edge).map(|w| intake(w.dart)).sum();
            edges.push((sheet.shown(edge), sheet.edges[edge].length() - mouths));
        }
        let name = |dart: usize| format!("{}.{}", sheet.piece, name::dart_name(&piece.darts[dart], dart));
        darts.extend((0..piece.darts.len()).map(|dart| (name(dart), intake(dart))));
    }
    [edges, darts]
}

fn one(file: &mut GarmentFile, alteration: &Located<AlterationFile>) -> Result<(), Fault> {
    match &alteration.value {
        AlterationFile::Take { seam, at, out } => shift::take(file, seam, at, *out),
        AlterationFile::Move { edge, at } => shift::move_points(file, edge, at),
        AlterationFile::Lengthen { pieces, at, by, over, across, shorter } => {
            let sign = if *shorter { -1.0 } else { 1.0 };
            let zone = lengthen::LengthenedPiece {
                at,
                by,
                sign,
                over: over.as_ref(),
                across: across.as_ref().is_some_and(|a| a.value),
            };
            // Of pieces that are like one another each is altered once.
            pieces.iter().try_for_each(|piece| name::piece(file, piece).map(drop))?;
            pieces.iter().try_for_each(|piece| zone.apply(file, piece))
        }
        AlterationFile::Pivot { dart, to, share, name } => open::pivot(file, dart, to, share.as_ref(), name.as_ref()),
        AlterationFile::Fullness { edge, to, by, to_by, slashes } => {
            let (to_by, slashes) = (to_by.as_ref(), slashes.as_ref());
            fullness::Fullness { edge, to, by, to_by, slashes }.apply(file)
        }
        AlterationFile::Join { seam } => join::join(file, seam),
        AlterationFile::Cut { from, to, via, name, seam } => {
            cut::StyleLine { ends: [from, to], via, name, seam: seam.as_ref() }.apply(file)
        }
        AlterationFile::Spread { from, to, by, to_by } => open::spread(file, [from, to], by, to_by.as_ref()),
    }
}
