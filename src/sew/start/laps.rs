//! Where closures hold one rim over another.

use std::collections::HashSet;

use crate::geometry::Vec2;
use crate::mesh::ClothMesh;
use crate::pattern::{EdgeId, Fastening, Garment, fastenings};

/// A rim goes on closed beyond its last button for this much, metres, or for the distance between two buttons if that
/// is more: where the rest of the edge is no longer, all of it is closed.
const BEYOND: f64 = 0.05;
/// The end of a band no wider than this, metres, is closed by one button.
const BAND: f64 = 0.15;

/// A single point fastens the end of a strap rather than its side where the end is no further than this many times.
const AS_NEAR: f64 = 2.0;

/// Two rims that a row of closures holds one over the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Lap {
    /// The piece that lies over: the one that the closure's other half is on, as a buttonhole over its button.
    pub over: usize,
    /// The piece under it.
    pub under: usize,
    /// How far the one reaches over the other, metres.
    pub reach: f64,
    /// Particles of the two rims that are welded for the start, that of what lies over first.
    pub pairs: Vec<[u32; 2]>,
}

/// The laps of a garment.
pub fn laps(garment: &Garment, mesh: &ClothMesh) -> Vec<Lap> {
    let mut all = fastenings(garment);
    all.sort_by_key(|f| f.row);
    let rows = all.chunk_by(|a, b| a.row == b.row);
    rows.filter_map(|row| lap(garment, mesh, row)).collect()
}

/// The lap of a row of fastenings; none where its two rims are one point.
fn lap(garment: &Garment, mesh: &ClothMesh, row: &[Fastening]) -> Option<Lap> {
    let mut edges = row.first()?.ends.map(|end| end.edge);
    let mut spots = [0, 1].map(|side| row.iter().map(|f| f.ends[side].at).collect::<Vec<f64>>());
    if let [one] = row {
        let tack = garment.closures[one.tack[0]].tacks[one.tack[1]];
        for side in 0..2 {
            if let Some((edge, at)) = end_of_strap(garment, mesh, tack[side]) {
                (edges[side], spots[side]) = (edge, vec![at]);
            }
        }
    }
    let rims = [0, 1].map(|side| rim(garment, mesh, edges[side]));
    let lengths = [0, 1].map(|side| rims[side].last().map_or(0.0, |r| r.0));
    let runs_with = runs_with(&spots);
    let chosen = [0, 1].map(|side| {
        let [from, to] = closed(&spots[side], lengths[side]);
        let mut stretch: Vec<u32> = rims[side].iter().filter(|r| r.0 >= from && r.0 <= to).map(|r| r.1).collect();
        if side == 1 && !runs_with {
            stretch.reverse();
        }
        stretch
    });
    let pairs = matched(&chosen[0], &chosen[1]);
    let reach = row.iter().map(|f| f.reach).sum::<f64>() / row.len() as f64;
    // What a closure is on lies under what it meets, as a button under its hole.
    let (over, under) = (edges[1].piece, edges[0].piece);
    let pairs: Vec<[u32; 2]> = pairs.into_iter().filter(|[a, b]| a != b).map(|[a, b]| [b, a]).collect();
    (!pairs.is_empty()).then_some(Lap { over, under, reach, pairs })
}

/// The end of the strap or band that a single point fastens, and how far along it that is: it may be nearer to a side
/// of the strap.
fn end_of_strap(garment: &Garment, mesh: &ClothMesh, (piece, at): (usize, Vec2)) -> Option<(EdgeId, f64)> {
    let sewn: HashSet<u32> = mesh.seams.iter().flat_map(|s| s.pairs.iter().flatten()).copied().collect();
    let free = mesh.pieces[piece].edges.iter().filter(|e| e.particles.iter().any(|p| !sewn.contains(p)));
    let found: Vec<(f64, f64, EdgeId, f64)> = free
        .map(|e| {
            let path = &garment.pieces[piece].loops[e.edge.ring][e.edge.index].path;
            let along = path.nearest(at).0;
            ((path.point(along) - at).norm(), path.length(), e.edge, along)
        })
        .collect();
    let nearest = found.iter().map(|f| f.0).fold(f64::INFINITY, f64::min);
    let ends = found.iter().filter(|f| f.0 <= AS_NEAR * nearest && f.1 <= BAND);
    ends.min_by(|a, b| a.1.total_cmp(&b.1)).map(|f| (f.2, f.3))
}

/// Particles of an edge with their distance from its start, metres.
fn rim(garment: &Garment, mesh: &ClothMesh, edge: EdgeId) -> Vec<(f64, u32)> {
    let found = mesh.pieces[edge.piece].edges.iter().find(|e| e.edge == edge);
    let Some(particles) = found.map(|e| &e.particles) else { return Vec::new() };
    let mut at = 0.0;
    let mut out = Vec::with_capacity(particles.len());
    for (k, &p) in particles.iter().enumerate() {
        if k > 0 {
            at += (mesh.flat[p as usize] - mesh.flat[particles[k - 1] as usize]).norm();
        }
        out.push((at, p));
    }
    // Chords are shorter than the edge: fastenings count along the edge.
    let length = garment.pieces[edge.piece].loops[edge.ring][edge.index].path.length();
    let scale = if at > 0.0 { length / at } else { 1.0 };
    out.iter_mut().for_each(|r| r.0 *= scale);
    out
}

/// Whether two edges run the same way along a row. Outer edges of pieces that lie right side out run opposite ways.
fn runs_with([own, met]: &[Vec<f64>; 2]) -> bool {
    let ends = |s: &[f64]| s.last().zip(s.first()).map_or(0.0, |(b, a)| b - a);
    ends(own) * ends(met) > 0.0
}

/// From where to where an edge of this length is closed by fastenings at these places.
fn closed(spots: &[f64], length: f64) -> [f64; 2] {
    let low = spots.iter().copied().fold(f64::INFINITY, f64::min);
    let high = spots.iter().copied().fold(0.0, f64::max);
    let pitch = (high - low) / (spots.len().max(2) - 1) as f64;
    let beyond = if length <= BAND { BAND } else { BEYOND.max(1.5 * pitch) };
    [if low <= beyond { 0.0 } else { low }, if length - high <= beyond { length } else { high }]
}

/// Every particle of the shorter run with one of the longer, evenly and in order.
pub(super) fn matched(a: &[u32], b: &[u32]) -> Vec<[u32; 2]> {
    let (short, long) = if a.len() <= b.len() { (a, b) } else { (b, a) };
    if short.is_empty() {
        return Vec::new();
    }
    let partner = |k: usize| match short.len() {
        1 => long[long.len() / 2],
        n => long[(k * (long.len() - 1) + (n - 1) / 2) / (n - 1)],
    };
    let pairs = short.iter().enumerate().map(|(k, &p)| [p, partner(k)]);
    pairs.map(|[s, l]| if a.len() <= b.len() { [s, l] } else { [l, s] }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_matched_evenly_and_each_once() {
        assert_eq!(matched(&[0, 1, 2], &[10, 11, 12, 13, 14]), [[0, 10], [1, 12], [2, 14]]);
        assert_eq!(matched(&[10, 11, 12, 13], &[0, 1]), [[10, 0], [13, 1]]);
        assert_eq!(matched(&[], &[0, 1]), Vec::<[u32; 2]>::new());
    }

    #[test]
    fn a_rim_is_closed_to_its_end_where_that_is_near() {
        assert_eq!(closed(&[0.05, 0.15, 0.25], 0.6), [0.0, 0.25]);
        assert_eq!(closed(&[0.2, 0.3], 0.4), [0.2, 0.4]);
    }
}
