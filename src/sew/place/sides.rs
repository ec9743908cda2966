//! Seams that join two pieces by the same side of both. Seen from outside, pieces that stand side by side round the
//! body meet the right side of one to the left side of the next: right to right, one of them is the half of the other
//! side of the garment.

use super::PlaceError;
use super::assign::Assigned;
use super::fold::Sheet;
use super::rows::{Link, Rows, extent, is_at, stitched};
use crate::geometry::Vec2;
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// A seam lies at one side of a piece where it is further from its middle than this share of half its width. (The sides
/// of a diamond are half way out.)
const AT_SIDE: f64 = 0.6;

/// Refuses upright seams that join the same sides of two pieces round one part, each said to be at its front or its
/// back. What says neither (a gusset), lies in a slit or on another piece may be sewn any way round.
pub(super) fn check(
    garment: &Garment,
    mesh: &ClothMesh,
    sheet: &Sheet,
    assigned: &[Assigned],
    rows: &Rows,
) -> Result<(), PlaceError> {
    let alone = |p: usize| {
        let in_slit = rows.rows.iter().flat_map(|row| &row.inserts).any(|insert| insert.own.piece == p);
        assigned[p].facing.is_some() && !in_slit && rows.laid[p].is_none() && !is_at(&garment.pieces[p].place)
    };
    let ring = |p: usize| (assigned[p].part, garment.pieces[p].layer);
    let beside = |link: &Link| link.pieces.iter().all(|&p| alone(p)) && ring(link.pieces[0]) == ring(link.pieces[1]);
    let flank = |link: &Link| link.upright && !link.through && beside(link);
    for link in rows.links.iter().filter(|link| flank(link)) {
        let sides = [0, 1].map(|k| side(stitched(link, sheet, k), extent(mesh, sheet, link.pieces[k])));
        let [Some(one), Some(other)] = sides else { continue };
        if one == other {
            let [piece, to] = link.pieces.map(|p| garment.pieces[p].name.clone());
            let seam = garment.seams[link.seam].name.clone();
            return Err(PlaceError::Sides { seam, piece, to, side: one });
        }
    }
    Ok(())
}

/// The side of a box that a place in it is at, seen from outside.
fn side(at: Vec2, [low, high]: [Vec2; 2]) -> Option<&'static str> {
    let off = (2.0 * at.x - low.x - high.x) / (high.x - low.x);
    (off.abs() > AT_SIDE).then_some(if off > 0.0 { "right" } else { "left" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seam_is_at_a_side_only_near_it() {
        let piece = [Vec2::new(0.1, 0.0), Vec2::new(0.5, 0.6)];
        let at = |x: f64| side(Vec2::new(x, 0.3), piece);
        assert_eq!(
            [0.1, 0.17, 0.2, 0.3, 0.41, 0.43, 0.5].map(at),
            [Some("left"), Some("left"), None, None, None, Some("right"), Some("right")]
        );
        // A piece without width has no sides.
        assert_eq!(side(Vec2::zeros(), [Vec2::zeros(), Vec2::y()]), None);
    }
}
