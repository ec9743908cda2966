//! The lower layer of a lap: the cloth that another piece's rim reaches over, and where on that it lies.

use std::collections::HashMap;
use std::ops::Range;

use nalgebra::{Isometry2, Point2};

use super::glue::Follow;
use super::tails::into;
use crate::geometry::{Locator, Vec2, distance_to_segment};
use crate::mesh::ClothMesh;
use crate::sew::place::folded::FoldedPieces;

/// Beside a rim that goes on, cloth within this share of the spacing beyond its closed end lies under it too.
const BESIDE: f64 = 0.75;

/// A point lies on cloth where a particle of it is within this share of the spacing: the middle of a cell has one at
/// 0.71.
const ON: f64 = 0.75;
/// Cloth further from the rim than this many times the reach of the lap does not lie under it: the flood came round
/// the end of the rim.
const REACH: f64 = 2.0;

/// A rim that lies over other cloth.
pub(super) struct Flap<'a> {
    /// The piece of the rim, and the one that it lies over.
    pub(super) pieces: [usize; 2],
    /// Particles of the rim that lies over, in order, and of the rim under it.
    pub(super) rims: [&'a [u32]; 2],
    /// Whether the rim ends where its first and its last particle is: there the lap goes on to the end of the cloth.
    pub(super) to_end: [bool; 2],
    /// From the flat piece that lies over to the one under it.
    pub(super) to_under: Isometry2<f64>,
    /// How far the one reaches over the other, metres.
    pub(super) reach: f64,
}

/// A rim and the cloth under it.
pub(super) struct Cover {
    /// Every particle of the rim, with the one that it lies on.
    pub(super) pairs: Vec<[u32; 2]>,
    /// The particles that lie under the rim's cloth, and where on it.
    pub(super) covered: Vec<(u32, Follow)>,
}

impl Flap<'_> {
    /// The cloth it covers. `None` where its rim does not lie over the other piece.
    pub(super) fn cover(&self, mesh: &ClothMesh, sheet: &FoldedPieces) -> Option<Cover> {
        let line: Vec<Vec2> = self.rims[0].iter().map(|p| self.onto(mesh, *p)).collect();
        let mut pairs = Vec::with_capacity(line.len());
        for (p, at) in self.rims[0].iter().zip(&line) {
            let below = mesh.nearest(self.pieces[1], *at)?;
            if (mesh.flat[below] - at).norm() > mesh.spacing {
                return None;
            }
            pairs.push([*p, below as u32]);
        }
        let covered = self.flood(mesh, sheet, &line, &pairs);
        let furthest = covered.iter().map(|p| far(&line, mesh.flat[*p as usize])).fold(0.0, f64::max);
        if furthest > REACH * self.reach + mesh.spacing {
            return None;
        }
        let covered = self.follows(mesh, sheet, &covered)?;
        Some(Cover { pairs, covered })
    }

    /// Where a particle of the upper piece lies on the flat lower one.
    fn onto(&self, mesh: &ClothMesh, p: u32) -> Vec2 {
        onto(&self.to_under, mesh.flat[p as usize])
    }

    /// The particles of the lower piece that its rim leads to without a way across the line that the upper rim lies on.
    fn flood(&self, mesh: &ClothMesh, sheet: &FoldedPieces, line: &[Vec2], pairs: &[[u32; 2]]) -> Vec<u32> {
        let piece = &mesh.pieces[self.pieces[1]];
        let first = piece.particles.start;
        let mut next: Vec<Vec<u32>> = vec![Vec::new(); piece.particles.len()];
        for t in &mesh.triangles[piece.triangles.clone()] {
            (0..3).for_each(|k| next[t[k] as usize - first].extend([t[(k + 1) % 3], t[(k + 2) % 3]]));
        }
        // What is turned over there follows its own ply.
        let mut open: Vec<bool> = sheet.hidden[piece.particles.clone()].iter().map(|hidden| !hidden).collect();
        pairs.iter().for_each(|pair| open[pair[1] as usize - first] = false);
        let side = self.side(mesh, line);
        let mut take = |p: u32| {
            let is_under = under(line, self.to_end, mesh.flat[p as usize], BESIDE * mesh.spacing) * side > 0.0;
            is_under && std::mem::replace(&mut open[p as usize - first], false)
        };
        let mut out: Vec<u32> = self.rims[1].iter().copied().filter(|p| take(*p)).collect();
        let mut k = 0;
        while k < out.len() {
            out.extend(next[out[k] as usize - first].iter().copied().filter(|p| take(*p)).collect::<Vec<_>>());
            k += 1;
        }
        out
    }

    /// On which side of the line the upper piece's cloth lies: the sign of [`under`] there.
    fn side(&self, mesh: &ClothMesh, line: &[Vec2]) -> f64 {
        let is_rim = |p: &u32| self.rims[0].contains(p);
        let triangles = &mesh.triangles[mesh.pieces[self.pieces[0]].triangles.clone()];
        let beside = triangles.iter().filter(|t| t.iter().any(is_rim)).flatten().filter(|p| !is_rim(p));
        beside.map(|p| under(line, [true; 2], self.onto(mesh, *p), 0.0)).sum::<f64>().signum()
    }

    /// Where on the upper piece the particles lie that it covers.
    fn follows(&self, mesh: &ClothMesh, sheet: &FoldedPieces, covered: &[u32]) -> Option<Vec<(u32, Follow)>> {
        let triangles = &mesh.triangles[mesh.pieces[self.pieces[0]].triangles.clone()];
        let open = |t: &&[u32; 3]| !t.iter().any(|p| covered.contains(p) || sheet.hidden[*p as usize]);
        let open: Vec<[u32; 3]> = triangles.iter().filter(open).copied().collect();
        if open.is_empty() {
            return None;
        }
        let ground = Locator::new(&mesh.flat, &open, mesh.spacing);
        let to_over = self.to_under.inverse();
        let follow = |p: &u32| {
            let (corners, weights) = ground.place(onto(&to_over, mesh.flat[*p as usize]));
            (*p, Follow { corners, weights, layers: 0.0, share: 1.0 })
        };
        Some(covered.iter().map(follow).collect())
    }
}

/// Distance of a point from a line, metres.
fn far(line: &[Vec2], p: Vec2) -> f64 {
    line.windows(2).map(|pair| distance_to_segment(p, [pair[0], pair[1]])).fold(f64::INFINITY, f64::min)
}

/// How far a point lies to the left of a line, metres, negative to its right; 0 for a point that lies more than
/// `beside` beyond an end at which the line does not go straight on.
fn under(line: &[Vec2], on: [bool; 2], p: Vec2, beside: f64) -> f64 {
    let mut best = (f64::INFINITY, 0.0);
    let last = line.len().saturating_sub(2);
    let beyond = |is_end: bool, goes_on: bool| match (is_end, goes_on) {
        (false, _) => 0.0,
        (true, true) => f64::INFINITY,
        (true, false) => beside,
    };
    for (k, pair) in line.windows(2).enumerate() {
        let way = pair[1] - pair[0];
        let length = way.norm();
        if length <= 0.0 {
            continue;
        }
        let along = (p - pair[0]).dot(&way) / length;
        let [low, high] = [-beyond(k == 0, on[0]), length + beyond(k == last, on[1])];
        let far = (p - pair[0] - way * (along.clamp(low, high) / length)).norm();
        if far < best.0 {
            let is_beside = (low..=high).contains(&along) || k > 0 && along < 0.0 || k < last && along > length;
            best = (far, if is_beside { way.perp(&(p - pair[0])) / length } else { 0.0 });
        }
    }
    best.1
}

/// Which share of a rim, of the piece `own`, lies over the cloth of another piece, which goes on beyond it.
pub(super) fn share_over(mesh: &ClothMesh, own: usize, rim: &[u32], other: usize, to_other: &Isometry2<f64>) -> f64 {
    let over = lies_over(mesh, own, rim, other, to_other);
    let inner = over.get(1..over.len().saturating_sub(1)).unwrap_or_default();
    inner.iter().filter(|over| **over).count() as f64 / inner.len().max(1) as f64
}

/// The longest run of a rim's particles that lie over the cloth of another piece.
pub(super) fn longest_over(
    mesh: &ClothMesh,
    own: usize,
    rim: &[u32],
    other: usize,
    to_other: &Isometry2<f64>,
) -> Range<usize> {
    let over = lies_over(mesh, own, rim, other, to_other);
    let (mut longest, mut from) = (0..0, 0);
    for (k, is_over) in over.iter().enumerate() {
        if !is_over {
            from = k + 1;
        } else if k + 1 - from > longest.len() {
            longest = from..k + 1;
        }
    }
    longest
}

/// Which particles of a rim, of the piece `own`, lie over the cloth of another piece, which goes on beyond them.
fn lies_over(mesh: &ClothMesh, own: usize, rim: &[u32], other: usize, to_other: &Isometry2<f64>) -> Vec<bool> {
    let is_on = |at: Vec2| {
        let at = onto(to_other, at);
        mesh.nearest(other, at).is_some_and(|p| (mesh.flat[p] - at).norm() <= ON * mesh.spacing)
    };
    let is_over = |p: &u32| {
        let at = mesh.flat[*p as usize];
        outward(mesh, own, rim, at).is_some_and(|out| is_on(at) && is_on(at + out * mesh.spacing))
    };
    rim.iter().map(is_over).collect()
}

/// The direction out of a piece at the particle of its rim that is nearest to a point: across the rim, unit.
pub(super) fn outward(mesh: &ClothMesh, piece: usize, rim: &[u32], at: Vec2) -> Option<Vec2> {
    let flat = |k: usize| mesh.flat[rim[k] as usize];
    let near = (0..rim.len()).min_by(|a, b| (flat(*a) - at).norm().total_cmp(&(flat(*b) - at).norm()))?;
    let along = flat((near + 1).min(rim.len() - 1)) - flat(near.saturating_sub(1));
    Some(-into(mesh, piece, rim[near], along.try_normalize(0.0)?))
}

/// Where a flat point lies on another piece.
pub(super) fn onto(to_other: &Isometry2<f64>, at: Vec2) -> Vec2 {
    (to_other * Point2::from(at)).coords
}

/// The particles that seams join to each.
pub(super) fn partners(mesh: &ClothMesh) -> HashMap<u32, Vec<u32>> {
    let mut out: HashMap<u32, Vec<u32>> = HashMap::new();
    for [a, b] in mesh.seams.iter().flat_map(|seam| &seam.pairs) {
        out.entry(*a).or_default().push(*b);
        out.entry(*b).or_default().push(*a);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_has_a_left_and_a_right_and_ends_or_goes_on() {
        let line = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0), Vec2::new(1.0, 1.0)];
        let at = |x: f64, y: f64, on: [bool; 2]| under(&line, on, Vec2::new(x, y), 0.1);
        assert!((at(0.5, 0.2, [false; 2]) - 0.2).abs() < 1e-12);
        assert!((at(0.5, -0.2, [false; 2]) + 0.2).abs() < 1e-12);
        assert!((at(-0.5, 0.2, [true; 2]) - 0.2).abs() < 1e-12);
        assert_eq!(at(-0.5, 0.2, [false; 2]), 0.0);
        assert!((at(-0.05, 0.2, [false; 2]) - 0.2).abs() < 1e-12);
        assert!((at(0.8, 3.0, [true; 2]) - 0.2).abs() < 1e-12);
        assert!(at(1.3, -0.1, [true; 2]) < 0.0, "outside the corner");
    }
}
