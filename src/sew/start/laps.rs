//! Where closures hold one rim over another.

use std::collections::HashMap;
use std::ops::Range;

use nalgebra::Isometry2;

use super::cover::{Cover, Flap, longest_over, onto, outward, partners, share_over};
use super::glue::Follow;
use super::tails::{BAND, Knotted, SpotOnStrap, StrapEnd, end_of_strap, knotted};
use crate::geometry::Vec2;
use crate::mesh::{ClothMesh, EdgeParticles};
use crate::pattern::{EdgeId, Fastening, Garment, RimSpot, fastenings};
use crate::sew::place::folded::FoldedPieces;
use crate::sew::place::lay::fit;

/// A rim goes on closed beyond its last button for this much, metres, or for the distance between two buttons if that
/// is more: where the rest of the edge is no longer, all of it is closed.
const BEYOND: f64 = 0.05;

/// A run of fewer particles of a rim lies over nothing.
const SHORTEST: usize = 4;

/// The map between the two sides of a lap is read from the cloth within this distance of its end, metres.
const ALONG: f64 = 0.15;

/// And only where its stitches on the one side lie within this share of the spacing over those on the other.
const NEAR: f64 = 0.4;

/// Closures hold one lap where one turn and shift brings all their points together within this, metres: two
/// points that do not say quite the same.
const ONE_LAP: f64 = 10e-3;

/// A rim lies over other cloth where at least this share of it does.
const OVER: f64 = 0.6;

/// Where one rim lies over other cloth.
#[derive(Clone, Debug, PartialEq)]
pub struct Lap {
    /// The piece that lies over: the one that the closure's other half is on, as a buttonhole over its button.
    pub over: usize,
    /// The piece under it.
    pub under: usize,
    /// Particles that are welded for the start: those of the rim, each with the one that it lies on.
    pub pairs: Vec<[u32; 2]>,
    /// Particles that are no part of the surface, and where on it they lie: those of the lower piece under the rim's
    /// cloth, and the tails of knotted straps.
    pub covered: Vec<(u32, Follow)>,
    /// Of how many plies the upper piece is where it is thickest: of more than one where it is folded over.
    pub plies: f64,
}

/// The laps of a garment: where closures hold a rim, and where that goes on across a seam. Those whose rims `zips` join
/// beyond their ends go on to the ends of the edges: such pairs are taken out of `zips`.
pub(super) fn laps(garment: &Garment, mesh: &ClothMesh, sheet: &FoldedPieces, zips: &mut Vec<[u32; 2]>) -> Vec<Lap> {
    let mut all = fastenings(garment);
    all.sort_by_key(|f| f.row);
    let partners = partners(mesh);
    let held = of_one_lap(garment, &all);
    let mut rows: Vec<RimPair> = held.iter().filter_map(|row| RimPair::new(garment, mesh, &partners, row)).collect();
    rows.iter_mut().for_each(|row| row.carry_on(mesh, zips));
    let mut next = 0;
    while next < rows.len() {
        for end in 0..2 {
            let more = rows[next].beyond(mesh, &partners, end);
            rows.extend(more.filter(|more| !rows.iter().any(|row| row.is_between(more.pieces()))));
        }
        next += 1;
    }
    rows.iter().filter_map(|row| row.lap(mesh, sheet, &partners)).collect()
}

/// Where a closure joins two pieces; what lies under comes first.
#[derive(Clone)]
struct ClosureJoint {
    /// The edges nearest to the two points, and how far along them they are, metres.
    ends: [RimSpot; 2],
    /// The two points, each with its piece.
    points: [(usize, Vec2); 2],
    /// How far the two edges overlap there, metres.
    reach: f64,
}

impl ClosureJoint {
    fn new(garment: &Garment, fastening: &Fastening) -> Self {
        let points = garment.closures[fastening.tack[0]].tacks[fastening.tack[1]];
        Self { ends: fastening.ends, points, reach: fastening.reach }
    }

    fn pieces(&self) -> [usize; 2] {
        self.points.map(|end| end.0)
    }

    fn swapped(mut self) -> Self {
        self.ends.reverse();
        self.points.reverse();
        self
    }
}

/// The joints of closures by the lap that they hold: rows of one closure, and those of others between the same two
/// pieces that the same turn and shift brings together. The first closure says which piece lies over.
fn of_one_lap(garment: &Garment, all: &[Fastening]) -> Vec<Vec<ClosureJoint>> {
    let mut laps: Vec<Vec<ClosureJoint>> = Vec::new();
    for row in all.chunk_by(|a, b| a.row == b.row) {
        let mut row: Vec<ClosureJoint> = row.iter().map(|f| ClosureJoint::new(garment, f)).collect();
        let [own, met] = row[0].pieces();
        if own != met && laps.iter().any(|lap| lap[0].pieces() == [met, own]) {
            row = row.into_iter().map(ClosureJoint::swapped).collect();
        }
        let goes_on = |lap: &&mut Vec<ClosureJoint>| {
            let points: Vec<[Vec2; 2]> = lap.iter().chain(&row).map(|joint| joint.points.map(|end| end.1)).collect();
            let meet = |map: &Isometry2<f64>| points.iter().all(|[a, b]| (onto(map, *a) - b).norm() <= ONE_LAP);
            lap[0].pieces() == row[0].pieces() && fit(&points).is_some_and(|map| meet(&map))
        };
        match laps.iter_mut().find(goes_on) {
            Some(lap) => lap.append(&mut row),
            None => laps.push(row),
        }
    }
    laps
}

/// For particles in seams those that they are sewn to.
type Partners = HashMap<u32, Vec<u32>>;

/// Two rims of which one lies over the other; what lies under comes first.
struct RimPair {
    edges: [EdgeId; 2],
    /// Particles of the rims where they are closed, side by side.
    rims: [Vec<u32>; 2],
    /// Whether they are closed to the end of the edge, at the first and the last particle.
    to_end: [bool; 2],
    /// From the flat piece that lies over to the one under it.
    to_under: Option<Isometry2<f64>>,
    /// How far the one reaches over the other, metres.
    reach: f64,
    /// Whether closures hold these rims themselves.
    is_held: bool,
    /// Where a single point fastens the ends of two straps.
    knot: Option<[Vec2; 2]>,
}

impl RimPair {
    /// Of a row of fastenings; none where its two rims are one point.
    fn new(garment: &Garment, mesh: &ClothMesh, partners: &Partners, row: &[ClosureJoint]) -> Option<Self> {
        let mut edges = row.first()?.ends.map(|end| end.edge);
        let mut spots = [0, 1].map(|side| row.iter().map(|f| f.ends[side].at).collect::<Vec<f64>>());
        let tacks: Vec<[(usize, Vec2); 2]> = row.iter().map(|f| f.points).collect();
        let mut knot = None;
        if let [tack] = tacks[..] {
            let ends = [0, 1].map(|side| end_of_strap(garment, mesh, partners, tack[side]));
            knot = (ends[0].is_some() && ends[1].is_some()).then(|| tack.map(|end| end.1));
            for (side, end) in ends.into_iter().enumerate() {
                if let Some((edge, at)) = end {
                    (edges[side], spots[side]) = (edge, vec![at]);
                }
            }
        }
        let whole = [0, 1].map(|side| rim(garment, mesh, edges[side]));
        let lengths = [0, 1].map(|side| whole[side].last().map_or(0.0, |r| r.0));
        let mut closed = [0, 1].map(|side| closed(&spots[side], lengths[side]));
        // The end of a strap closes as much of a wide edge as it is wide.
        let wide = wider(closed).filter(|_| tacks.len() == 1);
        if let Some((side, width)) = wide {
            closed[side] = about(spots[side][0], width, lengths[side]);
        }
        let is_wide = |side: usize| wide.is_some_and(|(wide, _)| wide == side);
        // A lone point of two long edges closes a stretch of both: two sheets that share one particle part there.
        let is_lone = tacks.len() == 1 && closed.iter().all(|[from, to]| to - from < BEYOND);
        if is_lone {
            closed = [0, 1].map(|side| about(spots[side][0], BEYOND.max(mesh.spacing), lengths[side]));
        }
        let mut rims = [0, 1].map(|side| {
            let within = if is_wide(side) || is_lone { nearest_between } else { between };
            within(&whole[side], closed[side]).into_iter().map(|r| r.1).collect::<Vec<u32>>()
        });
        // The edge of the lower piece is walked as the upper one's.
        if !runs_with(&spots) {
            rims[0].reverse();
        }
        let to_end = [closed[1][0] <= 0.0, closed[1][1] >= lengths[1]];
        let mut ends: Vec<[Vec2; 2]> = tacks.iter().map(|tack| [tack[1].1, tack[0].1]).collect();
        if let [one] = ends[..] {
            // One point says where, the rims which way round.
            let out = [1, 0].map(|side| {
                let (piece, rim) = (edges[side].piece, &rims[side]);
                if is_wide(side) { outward(mesh, piece, rim, tacks[0][side].1) } else { out_of(mesh, piece, rim) }
            });
            ends.push([one[0] + out[0]? * mesh.spacing, one[1] - out[1]? * mesh.spacing]);
        }
        let reach = row.iter().map(|f| f.reach).sum::<f64>() / row.len() as f64;
        let mut row = Self { edges, rims, to_end, to_under: fit(&ends), reach, is_held: true, knot };
        row.look_for_rims(mesh, partners);
        Some(row)
    }

    /// Of points all over a wide lap the nearest edges may be others than those that lie over and under: looks for them
    /// among all free edges of the two pieces.
    fn look_for_rims(&mut self, mesh: &ClothMesh, partners: &Partners) {
        let Some(to_under) = self.to_under else { return };
        let [under, over] = self.pieces();
        let maps = [to_under.inverse(), to_under];
        let others = [over, under];
        let share = |side: usize, rim: &[u32]| share_over(mesh, self.edges[side].piece, rim, others[side], &maps[side]);
        if (0..2).all(|side| share(side, &self.rims[side]) >= OVER) {
            return;
        }
        let free =
            |side: usize| mesh.pieces[self.edges[side].piece].edges.iter().filter(|e| is_free(partners, &e.particles));
        let whole = |side: usize| {
            let found = free(side).map(|e| (share(side, &e.particles), e)).filter(|(share, _)| *share >= OVER);
            found.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, e)| (e.edge, e.particles.clone(), [true; 2]))
        };
        // Two rims may cross, as those of a wrapped front do.
        let part = |side: usize| {
            let own = self.edges[side].piece;
            let run = |e: &EdgeParticles| {
                let run = longest_over(mesh, own, &e.particles, others[side], &maps[side]);
                (run.len() >= SHORTEST)
                    .then(|| (e.edge, e.particles[run.clone()].to_vec(), ends_of(&run, e.particles.len())))
            };
            free(side).filter_map(run).max_by_key(|run| run.1.len())
        };
        let best = |side: usize| whole(side).or_else(|| part(side));
        let (Some((lower, mut low, _)), Some((upper, up, to_end))) = (best(0), best(1)) else { return };
        let above = |p: u32| onto(&to_under, mesh.flat[p as usize]);
        let far = |a: usize, b: usize| (above(up[a]) - mesh.flat[low[b] as usize]).norm();
        if far(0, 0) + far(up.len() - 1, low.len() - 1) > far(0, low.len() - 1) + far(up.len() - 1, 0) {
            low.reverse();
        }
        let middle = mesh.flat[low[low.len() / 2] as usize];
        self.reach = up.iter().map(|p| (above(*p) - middle).norm()).fold(f64::INFINITY, f64::min);
        (self.edges, self.rims, self.to_end) = ([lower, upper], [low, up], to_end);
    }

    /// Carries the lap on to the end of its edges where `zips` join them beyond its own end, and takes these out.
    fn carry_on(&mut self, mesh: &ClothMesh, zips: &mut Vec<[u32; 2]>) {
        let whole = self.edges.map(|edge| {
            let found = mesh.pieces[edge.piece].edges.iter().find(|e| e.edge == edge);
            found.map_or(&[][..], |e| e.particles.as_slice())
        });
        for end in 0..2 {
            let beyond = [0, 1].map(|side| beyond(whole[side], &self.rims[side], end == 0));
            let joins = |zip: &[u32; 2]| {
                let [a, b] = zip;
                beyond[0].contains(a) && beyond[1].contains(b) || beyond[0].contains(b) && beyond[1].contains(a)
            };
            if self.to_end[end] || !zips.iter().any(joins) {
                continue;
            }
            zips.retain(|zip| !joins(zip));
            for (rim, mut more) in self.rims.iter_mut().zip(beyond) {
                if end == 0 {
                    more.reverse();
                    rim.splice(0..0, more);
                } else {
                    rim.extend(more);
                }
            }
            self.to_end[end] = true;
        }
    }

    fn pieces(&self) -> [usize; 2] {
        self.edges.map(|edge| edge.piece)
    }

    fn is_between(&self, pieces: [usize; 2]) -> bool {
        let [a, b] = self.pieces();
        pieces == [a, b] || pieces == [b, a]
    }

    /// The two rims beyond the seams at one end of this row's.
    fn beyond(&self, mesh: &ClothMesh, partners: &Partners, end: usize) -> Option<Self> {
        if !self.to_end[end] {
            return None;
        }
        let to_under = self.to_under?;
        let corner = |side: usize| {
            let rim = &self.rims[side];
            if end == 0 { rim.first().copied() } else { rim.last().copied() }
        };
        let next = |side: usize| {
            let others = partners.get(&corner(side)?)?;
            others.iter().find_map(|p| free_edge_from(mesh, partners, *p))
        };
        let [(under, first), (over, upper)] = [next(0)?, next(1)?];
        // What the seams join on both sides lies over one another as this row's pieces do.
        let sewn_to = |p: u32, piece: usize| {
            let of_piece = |q: &&u32| mesh.pieces[piece].particles.contains(&(**q as usize));
            partners.get(&p).and_then(|all| all.iter().find(of_piece)).copied()
        };
        let [lower_row, upper_row] = self.pieces();
        let sewn = mesh.pieces[lower_row].particles.clone().filter_map(|p| Some((p, sewn_to(p as u32, under.piece)?)));
        let sewn: Vec<(usize, u32)> = sewn.collect();
        let at = mesh.flat[corner(1)? as usize];
        let near = mesh.pieces[upper_row].particles.clone().filter(|p| (mesh.flat[*p] - at).norm() < ALONG);
        let mut ends: Vec<[Vec2; 2]> = near
            .filter_map(|p| {
                let above = sewn_to(p as u32, over.piece)?;
                let below = onto(&to_under, mesh.flat[p]);
                let far = |q: &&(usize, u32)| (mesh.flat[q.0] - below).norm();
                let nearest = sewn.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
                (far(&nearest) <= NEAR * mesh.spacing).then(|| [above, nearest.1].map(|q| mesh.flat[q as usize]))
            })
            .collect();
        if let [one] = ends[..] {
            let out = [(over, &upper), (under, &first)].map(|(edge, rim)| out_of(mesh, edge.piece, rim));
            ends.push([one[0] + out[0]? * mesh.spacing, one[1] - out[1]? * mesh.spacing]);
        }
        let to_under = fit(&ends)?;
        let rims = [first, upper];
        Some(Self {
            edges: [under, over],
            rims,
            to_end: [true; 2],
            to_under: Some(to_under),
            reach: self.reach,
            is_held: false,
            knot: None,
        })
    }

    /// The two straps of a knot with long tails.
    fn knotted(&self, mesh: &ClothMesh, sheet: &FoldedPieces, partners: &Partners) -> Option<Knotted> {
        let end = |side: usize| {
            let (piece, rim) = (self.edges[side].piece, self.rims[side].as_slice());
            Some(StrapEnd { piece, rim, knot: self.knot?[side], out: out_of(mesh, piece, rim)? })
        };
        knotted(mesh, sheet, [end(1)?, end(0)?], self.to_under.as_ref()?, |p| partners.contains_key(&p))
    }

    /// The lap: the upper rim over the cloth under it; a knot, where that is far from the rims; or the upper rim
    /// against the other one, which it does not reach over.
    fn lap(&self, mesh: &ClothMesh, sheet: &FoldedPieces, partners: &Partners) -> Option<Lap> {
        let [under, over] = self.pieces();
        let flap = |to_under| Flap {
            pieces: [over, under],
            rims: [&self.rims[1], &self.rims[0]],
            to_end: self.to_end,
            to_under,
            reach: self.reach,
        };
        let plies = 1.0 + mesh.pieces[over].particles.clone().map(|p| sheet.under[p]).fold(0.0, f64::max);
        let cover = self.to_under.and_then(|to_under| flap(to_under).cover(mesh, sheet));
        let (pairs, covered) = match cover {
            Some(Cover { pairs, covered }) => (pairs, covered),
            None if self.is_held => match self.knotted(mesh, sheet, partners) {
                Some(knotted) => of_knot(knotted),
                None => (matched(&self.rims[1], &self.rims[0]), Vec::new()),
            },
            None => return None,
        };
        let pairs: Vec<[u32; 2]> = pairs.into_iter().filter(|[a, b]| a != b).collect();
        (!pairs.is_empty()).then_some(Lap { over, under, pairs, covered, plies })
    }
}

/// The pairs that a knot welds, and where its tails lie.
fn of_knot(Knotted { across: [upper, lower], tails }: Knotted) -> (Vec<[u32; 2]>, Vec<(u32, Follow)>) {
    let follow = |(p, SpotOnStrap { corners, weights, layers })| (p, Follow { corners, weights, layers, share: 1.0 });
    (matched(&upper, &lower), tails.into_iter().map(follow).collect())
}

/// The particles of an edge beyond the first or the last one of a run of them, from there on. The run goes either way.
fn beyond(edge: &[u32], run: &[u32], from_first: bool) -> Vec<u32> {
    let place = |p: Option<&u32>| p.and_then(|p| edge.iter().position(|q| q == p));
    let (Some(first), Some(last)) = (place(run.first()), place(run.last())) else { return Vec::new() };
    let at = if from_first { first } else { last };
    if (first <= last) == from_first { edge[..at].iter().rev().copied().collect() } else { edge[at + 1..].to_vec() }
}

/// The direction out of a piece across one of its edges, unit: from the middle of the cloth near the middle of the edge
/// to that. Slanted and rounded ends of a band point along the band so.
fn out_of(mesh: &ClothMesh, piece: usize, edge: &[u32]) -> Option<Vec2> {
    let middle = mesh.flat[*edge.get(edge.len() / 2)? as usize];
    let ways = mesh.pieces[piece].particles.clone().map(|p| middle - mesh.flat[p]);
    ways.filter(|way| way.norm() < ALONG).sum::<Vec2>().try_normalize(0.0)
}

/// Whether no seam joins what lies between the ends of an edge.
fn is_free(partners: &Partners, edge: &[u32]) -> bool {
    let inner = edge.get(1..edge.len().saturating_sub(1)).unwrap_or_default();
    !inner.is_empty() && inner.iter().all(|p| !partners.contains_key(p))
}

/// The free edge that begins or ends at a particle, and its particles from there.
fn free_edge_from(mesh: &ClothMesh, partners: &Partners, corner: u32) -> Option<(EdgeId, Vec<u32>)> {
    let edges = &mesh.pieces[mesh.piece_of(corner)?].edges;
    edges.iter().filter(|e| is_free(partners, &e.particles)).find_map(|e| {
        let mut particles = e.particles.clone();
        if particles.last() == Some(&corner) {
            particles.reverse();
        }
        (particles.first() == Some(&corner)).then_some((e.edge, particles))
    })
}

/// Whether a run of an edge's particles ends at the edge's own ends.
fn ends_of(run: &Range<usize>, count: usize) -> [bool; 2] {
    [run.start == 0, run.end == count]
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

/// The side that is a wide edge, and the width of the other one, metres: what it closes is wider than that, or only a
/// point far from its ends. `None` where both are as wide, or points.
fn wider(closed: [[f64; 2]; 2]) -> Option<(usize, f64)> {
    let widths = closed.map(|[from, to]| to - from);
    let is_point = widths.map(|width| width <= 0.0);
    let side = if is_point[0] != is_point[1] { usize::from(is_point[1]) } else { usize::from(widths[1] > widths[0]) };
    let other = widths[1 - side];
    (other > 0.0 && widths[side] != other).then_some((side, other))
}

/// The stretch of an edge of so many metres that is `width` wide and has its middle nearest to a spot.
fn about(spot: f64, width: f64, length: f64) -> [f64; 2] {
    let from = (spot - 0.5 * width).clamp(0.0, (length - width).max(0.0));
    [from, from + width]
}

/// The particles of a rim within a stretch.
fn between(rim: &[(f64, u32)], [from, to]: [f64; 2]) -> Vec<(f64, u32)> {
    rim.iter().filter(|r| r.0 >= from && r.0 <= to).copied().collect()
}

/// The particles of a rim from the one nearest to the start of a stretch to the one nearest to its end.
fn nearest_between(rim: &[(f64, u32)], stretch: [f64; 2]) -> Vec<(f64, u32)> {
    let nearest = |at: f64| {
        (0..rim.len()).min_by(|a, b| (rim[*a].0 - at).abs().total_cmp(&(rim[*b].0 - at).abs())).unwrap_or_default()
    };
    let [first, last] = stretch.map(nearest);
    rim.get(first..=last).unwrap_or_default().to_vec()
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
    fn a_strap_closes_its_own_width_of_a_wide_edge() {
        let is_about = |[spot, width, length]: [f64; 3], from: f64| {
            let [low, high] = about(spot, width, length);
            (low - from).abs() < 1e-12 && (high - from - width).abs() < 1e-12
        };
        assert!(is_about([0.085, 0.04, 0.105], 0.065));
        assert!(is_about([0.01, 0.04, 0.105], 0.0));
        assert!(is_about([0.05, 0.2, 0.1], 0.0), "no wider than the edge");
        let rim: Vec<(f64, u32)> = (0..5).map(|k| (0.0525 * f64::from(k), k)).collect();
        assert_eq!(nearest_between(&rim, [0.065, 0.105]), [rim[1], rim[2]]);
        assert_eq!(nearest_between(&rim, [0.0, 1.0]), rim);
        assert_eq!(nearest_between(&[], [0.0, 1.0]), []);
    }

    #[test]
    fn a_strap_is_narrower_than_the_edge_that_it_ends_on() {
        assert_eq!(wider([[0.0, 0.05], [0.0, 0.2]]), Some((1, 0.05)));
        assert_eq!(wider([[0.0, 0.2], [0.0, 0.05]]), Some((0, 0.05)));
        // A button in the middle of a long edge.
        assert_eq!(wider([[0.0, 0.05], [0.7, 0.7]]), Some((1, 0.05)));
        assert_eq!(wider([[0.7, 0.7], [0.0, 0.05]]), Some((0, 0.05)));
        assert_eq!(wider([[0.7, 0.7], [0.3, 0.3]]), None);
        assert_eq!(wider([[0.0, 0.25], [0.25, 0.5]]), None);
    }

    #[test]
    fn a_rim_is_closed_to_its_end_where_that_is_near() {
        assert_eq!(closed(&[0.05, 0.15, 0.25], 0.6), [0.0, 0.25]);
        assert_eq!(closed(&[0.2, 0.3], 0.4), [0.2, 0.4]);
    }
}
