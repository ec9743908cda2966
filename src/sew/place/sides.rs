//! Seams that join two pieces by the same side of both. Seen from outside, pieces that stand side by side round the
//! body meet the right side of one to the left side of the next: right to right, one of them is the half of the other
//! side of the garment.

use std::collections::BTreeMap;

use super::PlaceError;
use super::assign::Assigned;
use super::fold::FoldedPieces;
use super::rows::{Link, Row, Rows};
use crate::geometry::{Vec2, sorted_pair};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// A seam is at one side of a piece where the direction out of its cloth is to that side by more than this, in the mean
/// of unit vectors: side seams of a peplum may slant by 70°; one that goes round a cut-out looks to both sides.
const SIDEWAYS: f64 = 0.34;

/// A seam is not judged that is less sideways than this share of the most sideways seam of the same two pieces: where
/// those have a side seam, what slants is their shoulder.
const SLANTED: f64 = 0.5;

/// Refuses upright seams that join the same sides of two pieces round one part, each said to be at its front or its
/// back. A piece that says neither (a gusset), or lies in a slit or on another piece, may be sewn any way round.
pub(super) fn check(
    garment: &Garment,
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    assigned: &[Assigned],
    rows: &Rows,
) -> Result<(), PlaceError> {
    let facing = |p: usize| assigned[p].facing;
    // What is said to be on the other side of the body than its host is no godet.
    let in_slit = |p: usize| {
        let lies = |row: &Row| {
            let mut own = row.inserts.iter().filter(|insert| insert.own.piece == p);
            own.any(|insert| facing(row.members[insert.host].piece) == facing(p))
        };
        rows.rows.iter().any(lies)
    };
    let alone =
        |p: usize| facing(p).is_some() && !in_slit(p) && rows.laid[p].is_none() && !garment.pieces[p].has_position();
    let ring = |p: usize| (assigned[p].part, garment.pieces[p].level());
    let beside = |link: &Link| link.pieces.iter().all(|&p| alone(p)) && ring(link.pieces[0]) == ring(link.pieces[1]);
    let flanks: Vec<&Link> = rows.links.iter().filter(|l| l.upright && !l.through && beside(l)).collect();
    let within = behind(mesh, &flanks);
    let outward = |link: &&Link| [0, 1].map(|k| outward(link, k, &sheet.straight, &within));
    let outward: Vec<[Vec2; 2]> = flanks.iter().map(outward).collect();
    let sideways = |[one, other]: &[Vec2; 2]| one.x.abs().min(other.x.abs());
    let mut most: BTreeMap<[usize; 2], f64> = BTreeMap::new();
    for (link, outward) in flanks.iter().zip(&outward) {
        let known = most.entry(pair(link)).or_default();
        *known = known.max(sideways(outward));
    }
    for (link, outward) in flanks.into_iter().zip(&outward) {
        let [Some(one), Some(other)] = outward.map(side) else { continue };
        if sideways(outward) < SLANTED * most[&pair(link)] {
            continue;
        }
        if one == other {
            let [piece, to] = link.pieces.map(|p| garment.pieces[p].name.clone());
            let seam = garment.seams[link.seam].name.clone();
            return Err(PlaceError::Sides { seam, piece, to, side: one });
        }
    }
    Ok(())
}

/// The two pieces of a link, whichever it names first.
fn pair(link: &Link) -> [usize; 2] {
    let [a, b] = link.pieces;
    [a.min(b), a.max(b)]
}

/// The particle that lies behind each mesh edge on the rim of the pieces of these links, seen from outside the piece.
fn behind(mesh: &ClothMesh, links: &[&Link]) -> BTreeMap<[u32; 2], u32> {
    let mut pieces: Vec<usize> = links.iter().flat_map(|l| l.pieces).collect();
    pieces.sort_unstable();
    pieces.dedup();
    let triangles = pieces.into_iter().flat_map(|p| &mesh.triangles[mesh.pieces[p].triangles.clone()]);
    let edges = triangles.flat_map(|&[a, b, c]| [([a, b], c), ([b, c], a), ([c, a], b)]);
    edges.map(|(edge, third)| (sorted_pair(edge), third)).collect()
}

/// Mean direction, along the stitches, out of piece number `k` of a link.
fn outward(link: &Link, k: usize, flat: &[Vec2], behind: &BTreeMap<[u32; 2], u32>) -> Vec2 {
    let (mut sum, mut length) = (Vec2::zeros(), 0.0);
    for pairs in link.pairs.windows(2) {
        let edge = [pairs[0][k], pairs[1][k]];
        let Some(&third) = behind.get(&sorted_pair(edge)) else { continue };
        let [from, to, third] = [edge[0], edge[1], third].map(|p| flat[p as usize]);
        let along = to - from;
        let across = Vec2::new(along.y, -along.x);
        sum += if across.dot(&(third - from)) < 0.0 { across } else { -across };
        length += along.norm();
    }
    if length > 0.0 { sum / length } else { sum }
}

/// The side that cloth which looks outward like this is at, seen from outside.
fn side(outward: Vec2) -> Option<&'static str> {
    (outward.x.abs() > SIDEWAYS).then_some(if outward.x > 0.0 { "right" } else { "left" })
}
