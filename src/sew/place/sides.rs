//! Seams that join a front and a back by the same side of both. Seen from outside, pieces that stand side by side round
//! the body meet the right side of one to the left side of the next: right to right, one of them is the half of the
//! other side of the garment.

use std::collections::BTreeMap;

use crate::geometry::{Vec2, sorted_pair};
use crate::mesh::{ClothMesh, Stitches};
use crate::pattern::{Garment, Piece, PlaceMeaning};

/// A seam is at a side of a piece where the direction out of its cloth, in the mean of unit vectors, is to that side by
/// more than this: it runs more down than across. Shoulders do not.
const SIDEWAYS: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// A seam of the same side of two pieces.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SameSide {
    /// Number of the seam among those of the garment.
    pub seam: usize,
    /// Numbers of the pieces that it joins.
    pub pieces: [usize; 2],
    /// `left` or `right`, seen from outside.
    pub side: &'static str,
}

/// The seams that join the same sides of a piece that is said to be at the front and of one that is said to be at the
/// back, of one layer and for the same part of the body.
pub fn same_sides(garment: &Garment, mesh: &ClothMesh) -> Vec<SameSide> {
    let behind = behind(mesh);
    let found = mesh.seams.iter().enumerate().filter_map(|(number, seam)| {
        let &[a, b] = seam.pairs.first()?;
        let pieces = [mesh.piece_of(a)?, mesh.piece_of(b)?];
        let [one, other] = pieces.map(|piece| &garment.pieces[piece]);
        if one.level() != other.level() || !are_opposite(one, other) {
            return None;
        }
        let [left, right] = [0, 1].map(|k| side(outward(mesh, seam, k, &behind)));
        (left.is_some() && left == right).then(|| SameSide { seam: number, pieces, side: left.unwrap_or_default() })
    });
    found.collect()
}

/// Whether one of two pieces is said to be at the front and the other at the back of the same part of the body.
fn are_opposite(one: &Piece, other: &Piece) -> bool {
    let [one, other] = [one, other].map(Piece::meanings);
    let says = |said: &[PlaceMeaning], meaning| said.contains(&meaning);
    let differ = |meaning| says(&one, meaning) != says(&other, meaning);
    let is_faced = |said: &[PlaceMeaning]| says(said, PlaceMeaning::Front) != says(said, PlaceMeaning::Back);
    let parts = [PlaceMeaning::Trunk, PlaceMeaning::Leg, PlaceMeaning::Arm, PlaceMeaning::Neck];
    is_faced(&one) && is_faced(&other) && differ(PlaceMeaning::Front) && !parts.into_iter().any(differ)
}

/// The particle that lies behind each mesh edge of a rim, seen from outside the piece.
fn behind(mesh: &ClothMesh) -> BTreeMap<[u32; 2], u32> {
    let edges = mesh.triangles.iter().flat_map(|&[a, b, c]| [([a, b], c), ([b, c], a), ([c, a], b)]);
    edges.map(|(edge, third)| (sorted_pair(edge), third)).collect()
}

/// Mean direction, along the stitches, out of the piece at end `k` of every pair.
fn outward(mesh: &ClothMesh, seam: &Stitches, k: usize, behind: &BTreeMap<[u32; 2], u32>) -> Vec2 {
    let (mut sum, mut length) = (Vec2::zeros(), 0.0);
    for pairs in seam.pairs.windows(2) {
        let edge = [pairs[0][k], pairs[1][k]];
        let Some(&third) = behind.get(&sorted_pair(edge)) else { continue };
        let [from, to, third] = [edge[0], edge[1], third].map(|p| mesh.flat[p as usize]);
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
