//! Limits of seam allowances.

use super::WIDEST_ALLOWANCE;
use super::diagnostic::{Findings, Located, Spot};
use super::file::{AllowanceFile, AllowanceWidth, GarmentFile, PieceFile};
use super::problem::Problem;
use super::value::Quantity;

/// Finds those of the garment, its pieces, their edges and its seams that are too wide.
pub(super) fn check(file: &GarmentFile, findings: &mut Findings) {
    let plain = |a: &Located<Quantity>| (a.at, a.value);
    let seams = file.seams.iter().filter_map(|s| s.allowance.as_ref());
    let widths = file.allowance.iter().chain(seams).map(plain).chain(file.pieces.iter().flat_map(of_piece));
    for (at, width) in widths.filter(|(_, width)| width.value(file.unit()) > WIDEST_ALLOWANCE) {
        let width = (1e4 * width.value(file.unit())).round() / 10.0;
        findings.error(at, Problem::AllowanceWide { width, widest: 1e3 * WIDEST_ALLOWANCE });
    }
}

fn of_piece(piece: &PieceFile) -> Vec<(Spot, Quantity)> {
    let written = |a: &Located<AllowanceWidth>| (a.at, a.value.width);
    match &piece.allowance {
        None => Vec::new(),
        Some(AllowanceFile::All(width)) => vec![written(width)],
        Some(AllowanceFile::Edges(edges)) => edges.iter().map(|(_, width)| written(width)).collect(),
    }
}
