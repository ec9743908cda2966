//! Sleeves and other tubes of one piece, sewn into an opening between others: their own seam belongs at its foot.

use super::rim::{Identities, Rims};
use super::{Piece, Span};
use crate::geometry::Vec2;

/// Height of a chain's ends above or below its middle, as a share of its length, from which they lie clearly there. An
/// armhole's ends lie there by two fifths, those of a waist or a hem by next to nothing.
const CLEARLY: f64 = 0.15;

/// Whether a chain is the rim of a tube: all of one piece, whose ends a seam of it brings together.
pub(super) fn is_tube(chain: &[Span], rims: &Rims, sewn: &Identities) -> bool {
    let (Some(first), Some(last)) = (chain.first(), chain.last()) else { return false };
    let (start, end) = (rims.point(first.edge, first.from), rims.point(last.edge, last.to));
    let of_one_piece = chain.iter().all(|span| span.edge.piece == first.edge.piece);
    of_one_piece && !rims.same(start, end) && sewn.one(rims, start, end)
}

/// Positions of the ends of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EndPlaces {
    /// Above its middle, as drawn.
    Above,
    /// Beside it.
    Level,
    /// Below it.
    Below,
}

/// Positions of the ends of a chain, with its pieces one after the other as they are sewn.
pub(super) fn ends(pieces: &[Piece], chain: &[Span]) -> EndPlaces {
    let length: f64 = chain.iter().map(Span::length).sum();
    let (mut walked, mut height, mut middle) = (0.0, 0.0, 0.0);
    for span in chain {
        let at = |share: f64| -> Vec2 {
            let path = &pieces[span.edge.piece].loops[span.edge.ring][span.edge.index].path;
            path.point(span.from + (span.to - span.from) * share)
        };
        let share = (0.5 * length - walked) / span.length();
        if (0.0..1.0).contains(&share) {
            middle = height + at(share).y - at(0.0).y;
        }
        height += at(1.0).y - at(0.0).y;
        walked += span.length();
    }
    // y points down.
    match (0.5 * height - middle) / length {
        low if low > CLEARLY => EndPlaces::Below,
        low if low < -CLEARLY => EndPlaces::Above,
        _ => EndPlaces::Level,
    }
}
