//! Ends of straps: which of them a single point fastens, and knots. The tails beyond a knot lie on the straps, and the
//! straps are one band without them.

use std::collections::HashMap;

use nalgebra::{Isometry2, Point2};

use crate::geometry::{Locator, Vec2};
use crate::mesh::{ClothMesh, EdgeParticles};
use crate::pattern::{EdgeId, Garment};
use crate::sew::place::folded::FoldedPieces;

/// The end of a band no wider than this, metres, is closed by one button.
pub(super) const BAND: f64 = 0.15;

/// A single point fastens the end of a strap rather than its side where the end is no further than this many times.
const AS_NEAR: f64 = 2.0;

/// An edge that is hollow by more than this share of its length ends no strap: it is a neckline.
const HOLLOW: f64 = 0.1;

/// A strip so many times as long as wide is a band.
const LONG: f64 = 5.0;

/// The tails of the upper and of the lower strap start so many layers out of the straps: long ones lie over one
/// another.
const OUT: [f64; 2] = [2.0, 4.0];

/// The end of a strap that is knotted.
pub(super) struct StrapEnd<'a> {
    /// Its piece.
    pub(super) piece: usize,
    /// The particles of its end.
    pub(super) rim: &'a [u32],
    /// Where the knot is, flat.
    pub(super) knot: Vec2,
    /// The unit direction from there to its end.
    pub(super) out: Vec2,
}

/// Two straps joined at a knot.
pub(super) struct Knotted {
    /// Particles across the two straps where these are welded, from one side to the other.
    pub(super) across: [Vec<u32>; 2],
    /// The particles of both tails, and where on the other strap they lie.
    pub(super) tails: Vec<(u32, SpotOnStrap)>,
}

/// A place over a strap.
pub(super) struct SpotOnStrap {
    /// Particles of the triangle there, or of the nearest.
    pub(super) corners: [u32; 3],
    /// Their shares.
    pub(super) weights: [f64; 3],
    /// Layers out of the right side.
    pub(super) layers: f64,
}

/// The particles of a strap at a knot: its tail, and those across the strap before the tail, in order from one side to
/// the other.
struct Cut {
    tail: Vec<u32>,
    across: Vec<u32>,
}

impl StrapEnd<'_> {
    /// Cuts the tail off. `None` if a seam holds a part of it (`is_sewn`), or if nothing of it is beyond the knot.
    fn cut(&self, mesh: &ClothMesh, is_sewn: impl Fn(u32) -> bool, sideways: Vec2) -> Option<Cut> {
        let piece = &mesh.pieces[self.piece];
        let first = piece.particles.start;
        let beyond = |p: u32| (mesh.flat[p as usize] - self.knot).dot(&self.out) > 0.5 * mesh.spacing;
        let mut next: Vec<Vec<u32>> = vec![Vec::new(); piece.particles.len()];
        for t in &mesh.triangles[piece.triangles.clone()] {
            (0..3).for_each(|k| next[t[k] as usize - first].extend([t[(k + 1) % 3], t[(k + 2) % 3]]));
        }
        let mut is_taken = vec![false; next.len()];
        let mut take = |p: u32| !std::mem::replace(&mut is_taken[p as usize - first], true);
        let mut tail: Vec<u32> = self.rim.iter().copied().filter(|p| beyond(*p) && take(*p)).collect();
        let mut across = Vec::new();
        let mut k = 0;
        while k < tail.len() {
            for &p in &next[tail[k] as usize - first] {
                if take(p) {
                    if beyond(p) { &mut tail } else { &mut across }.push(p);
                }
            }
            k += 1;
        }
        let along = |p: &u32| mesh.flat[*p as usize].dot(&sideways);
        across.sort_by(|a, b| along(a).total_cmp(&along(b)));
        let is_free = !tail.is_empty() && !across.is_empty() && !tail.iter().any(|p| is_sewn(*p));
        is_free.then_some(Cut { tail, across })
    }
}

/// The straps of a knot, the upper one first. `to_under` maps the flat upper piece to the lower one. `None` where they
/// are no straps with free tails that lie on one another.
pub(super) fn knotted(
    mesh: &ClothMesh,
    sheet: &FoldedPieces,
    [over, under]: [StrapEnd; 2],
    to_under: &Isometry2<f64>,
    is_sewn: impl Fn(u32) -> bool,
) -> Option<Knotted> {
    let sideways = Vec2::new(-over.out.y, over.out.x);
    let upper = over.cut(mesh, &is_sewn, sideways)?;
    let lower = under.cut(mesh, &is_sewn, to_under.rotation * sideways)?;
    let is_tail = |p: u32| upper.tail.contains(&p) || lower.tail.contains(&p);
    let lies_on = |tail: &[u32], host: usize, map: &Isometry2<f64>, layers: f64| -> Option<Vec<(u32, SpotOnStrap)>> {
        let triangles = &mesh.triangles[mesh.pieces[host].triangles.clone()];
        let is_open = |t: &&[u32; 3]| !t.iter().any(|p| is_tail(*p) || sheet.hidden[*p as usize]);
        let open: Vec<[u32; 3]> = triangles.iter().filter(is_open).copied().collect();
        let ground = (!open.is_empty()).then(|| Locator::new(&mesh.flat, &open, mesh.spacing))?;
        let follow = |p: &u32| {
            let (corners, weights) = ground.place((map * Point2::from(mesh.flat[*p as usize])).coords);
            (*p, SpotOnStrap { corners, weights, layers })
        };
        Some(tail.iter().map(follow).collect())
    };
    let mut tails = lies_on(&upper.tail, under.piece, to_under, OUT[0])?;
    tails.extend(lies_on(&lower.tail, over.piece, &to_under.inverse(), OUT[1])?);
    Some(Knotted { across: [upper.across, lower.across], tails })
}

/// The direction across a line of unit direction `along` into a piece's flat cloth, at one of its particles: unit.
pub(super) fn into(mesh: &ClothMesh, piece: usize, p: u32, along: Vec2) -> Vec2 {
    let beside = mesh.triangles[mesh.pieces[piece].triangles.clone()].iter().filter(|t| t.contains(&p));
    let inward: Vec2 = beside.flatten().map(|n| mesh.flat[*n as usize] - mesh.flat[p as usize]).sum();
    let across = Vec2::new(-along.y, along.x);
    across * across.dot(&inward).signum()
}

/// How far an edge bulges into its piece, as a share of its length.
fn hollow(mesh: &ClothMesh, edge: &EdgeParticles) -> f64 {
    let [Some(&first), Some(&last)] = [edge.particles.first(), edge.particles.last()] else { return 0.0 };
    let [from, to] = [first, last].map(|p| mesh.flat[p as usize]);
    let Some(along) = (to - from).try_normalize(0.0) else { return 0.0 };
    let inward = into(mesh, edge.edge.piece, edge.particles[edge.particles.len() / 2], along);
    let deepest = edge.particles.iter().map(|p| (mesh.flat[*p as usize] - from).dot(&inward)).fold(0.0, f64::max);
    deepest / (to - from).norm()
}

/// The end of the strap or band that a single point fastens, and how far along it that is: it may be nearer to a side
/// of the strap.
pub(super) fn end_of_strap(
    garment: &Garment,
    mesh: &ClothMesh,
    partners: &HashMap<u32, Vec<u32>>,
    (piece, at): (usize, Vec2),
) -> Option<(EdgeId, f64)> {
    let is_free = |e: &EdgeParticles| e.particles.iter().any(|p| !partners.contains_key(p));
    let free = mesh.pieces[piece].edges.iter().filter(|e| is_free(e) && hollow(mesh, e) <= HOLLOW);
    let found: Vec<(f64, f64, EdgeId, f64)> = free
        .map(|e| {
            let path = &garment.pieces[piece].loops[e.edge.ring][e.edge.index].path;
            let along = path.nearest(at).0;
            ((path.point(along) - at).norm(), path.length(), e.edge, along)
        })
        .collect();
    let nearest = found.iter().map(|f| f.0).fold(f64::INFINITY, f64::min);
    let ends = found.iter().filter(|f| f.0 <= AS_NEAR * nearest && f.1 <= BAND);
    let at_end = ends.min_by(|a, b| a.1.total_cmp(&b.1));
    // Both ends of what is knotted hang from the knot.
    let longest = found.iter().map(|f| f.1).fold(0.0, f64::max);
    let of_band = found.iter().filter(|f| f.1 <= BAND && f.1 * LONG <= longest);
    at_end.or_else(|| of_band.min_by(|a, b| a.0.total_cmp(&b.0))).map(|f| (f.2, f.3))
}
