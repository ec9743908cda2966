//! Pieces that lie on each other, and on which layer.

use super::diagnostic::{Findings, Spot};
use super::place_word::PlaceMeaning;
use super::problem::Problem;
use super::{Garment, Piece, Seam};

/// Warns of pieces on one layer that a seam with `face: same` lays on each other: a facing would start outside. `laid`
/// marks the seams of that kind, and `at` has their places.
pub(super) fn check(garment: &Garment, laid: &[bool], at: &[Spot], findings: &mut Findings) {
    for ((seam, _), &spot) in garment.seams.iter().zip(laid).zip(at).filter(|((_, laid), _)| **laid) {
        let Some([one, other]) = level(garment, seam) else { continue };
        let (small, large) = if one.area() < other.area() { (one, other) } else { (other, one) };
        let (piece, on) = (small.drawn_as.clone(), large.drawn_as.clone());
        findings.warn(spot, Problem::OneLayer { piece, on, layer: small.layer });
    }
}

/// Two pieces that the seam lays on each other, for the same part of the body and on one layer.
fn level<'g>(garment: &'g Garment, seam: &Seam) -> Option<[&'g Piece; 2]> {
    let pairs = seam.a.iter().flat_map(|a| seam.b.iter().map(move |b| [a, b].map(|s| &garment.pieces[s.edge.piece])));
    pairs.into_iter().find(|[a, b]| a.drawn_as != b.drawn_as && a.layer == b.layer && lies_on(a, b))
}

/// Whether both go to the front, or both to the back, and neither round the neck. A collar is turned down over its
/// partner, on whichever layer.
fn lies_on(a: &Piece, b: &Piece) -> bool {
    let [a, b] = [a, b].map(Piece::meanings);
    let says = |said: &[PlaceMeaning], meaning| said.contains(&meaning);
    let alike = |meaning| says(&a, meaning) == says(&b, meaning);
    let faces = says(&a, PlaceMeaning::Front) != says(&a, PlaceMeaning::Back);
    let round_neck = says(&a, PlaceMeaning::Neck) || says(&b, PlaceMeaning::Neck);
    faces && alike(PlaceMeaning::Front) && alike(PlaceMeaning::Back) && !round_neck
}
