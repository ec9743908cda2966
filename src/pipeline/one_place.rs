//! Pieces that lie in one another.

use std::collections::HashSet;

use crate::contact::Skin;
use crate::geometry::{Vec3, box_of};
use crate::mesh::{ClothMesh, PieceMesh};

/// Distance within which a particle lies on another piece, metres: less than the thickness of any cloth.
const ON: f64 = 0.05e-3;
/// Share of a piece that lies on another one from which both are in one place. Panels that widen towards their hem
/// start over one another with up to a fifth.
const SHARE: f64 = 0.5;

/// Pieces that lie in one another with the particles at `at`, two and two, and a particle that does.
pub(super) fn in_one_place<'a>(mesh: &'a ClothMesh, at: &'a [Vec3]) -> impl Iterator<Item = ([usize; 2], Vec3)> + 'a {
    let skin = |piece: &PieceMesh| {
        let triangles = mesh.triangles[piece.triangles.clone()].iter();
        let own = triangles.map(|t| t.map(|p| p - piece.particles.start as u32));
        Skin::new(&at[piece.particles.clone()], own.collect())
    };
    let skins: Vec<Option<Skin>> = mesh.pieces.iter().map(skin).collect();
    let boxes: Vec<[Vec3; 2]> = mesh.pieces.iter().map(|p| box_of(at[p.particles.clone()].iter().copied())).collect();
    // Where two pieces are sewn together they meet.
    let stitches = mesh.seams.iter().flat_map(|s| &s.pairs).flat_map(|&[p, q]| [[p, q], [q, p]]);
    let sewn: HashSet<(usize, usize)> = stitches.filter_map(|[p, q]| Some((p as usize, mesh.piece_of(q)?))).collect();
    let lying = move |a: usize, b: usize| {
        let (piece, skin) = (&mesh.pieces[a], skins[b].as_ref()?);
        let lies_on = |&p: &usize| !sewn.contains(&(p, b)) && skin.distance(at[p], ON).is_some();
        let on: Vec<usize> = piece.particles.clone().filter(lies_on).collect();
        let first = at[*on.first()?];
        (on.len() as f64 >= SHARE * piece.particles.len() as f64).then_some(([a, b], first))
    };
    let count = mesh.pieces.len();
    let pairs = (0..count).flat_map(move |a| (a + 1..count).map(move |b| [a, b]));
    // Most pieces are nowhere near each other.
    let near = move |&[a, b]: &[usize; 2]| {
        let ([low, high], [other_low, other_high]) = (boxes[a], boxes[b]);
        (0..3).all(|k| low[k] <= other_high[k] + ON && other_low[k] <= high[k] + ON)
    };
    pairs.filter(near).filter_map(move |[a, b]| lying(a, b).or_else(|| lying(b, a)))
}
