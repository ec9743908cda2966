//! Slits in a hem are closed with themselves for the start: the vent of a skirt, the open end of a side seam.
//!
//! A hem's rim goes up one side of a slit and down the other. Left open it would start as a ring of twice the hem's
//! width, as high up as the slit's end.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use super::cloth::Distances;
use super::glue::Glued;
use super::laps::{Lap, matched};
use super::openings::GluedOpening;
use crate::mesh::ClothMesh;

/// The sides of a slit leave its end at no more than this angle to each other, radians: 15°. A neckline's V is wider.
const SHARPEST: f64 = 0.26;
/// A rim that turns by more than this is at a corner, where a slit's sides end: 40°.
const CORNER: f64 = 0.7;
/// The sides of a slit are no further apart than this share of the way from its end, and [`EDGE`]. Cutaway fronts are.
const OPEN: f64 = 0.25;
/// Length of an edge of a start mesh, metres.
const EDGE: f64 = 0.025;
/// Shorter ones stay open, metres.
const SHORTEST: f64 = 0.06;
/// Shorter ones below a lap stay open, metres. The tails of a man's shirt, 155 mm long, start well; with them closed,
/// its collar and cuffs started with 223 crossings for 41, by chance, and it took 70 s of CPU time to sew for 21. The
/// fronts of a coat open for 470 mm started bunched at the hips.
const SHORTEST_BELOW_LAP: f64 = 0.2;

/// The pairs of particles that close the slits of an opening. None where its rim would be shorter than `least`, metres:
/// then the body passes through the slits too. Laps are closed already. The two edges of a slit that goes on from a lap
/// are paired: by these pairs the lap is carried on.
pub(super) fn slits(
    glued: &Glued,
    mesh: &ClothMesh,
    cloth: &Distances,
    opening: &GluedOpening,
    least: f64,
) -> Vec<[u32; 2]> {
    let rim = Rim { mesh, opening, cloth };
    if opening.sides.len() != opening.rim.len() {
        return Vec::new();
    }
    let mut taken: BTreeSet<u32> = glued.laps.iter().flat_map(|lap| lap.pairs.iter().flatten().copied()).collect();
    let (mut out, mut left) = (Vec::new(), opening.length);
    let at_laps = glued.laps.iter().flat_map(|lap| rim.below_lap(glued, lap));
    let sharp = (0..opening.rim.len()).filter(|&k| rim.angle(k) > TAU - SHARPEST).map(|end| rim.slit(end));
    for [a, b] in at_laps.chain(sharp) {
        let pairs = matched(&a.particles, &b.particles);
        if a.length.min(b.length) >= SHORTEST && pairs.iter().flatten().all(|p| !taken.contains(p)) {
            taken.extend(pairs.iter().flatten());
            out.extend(pairs);
            left -= a.length + b.length;
        }
    }
    if left < least { Vec::new() } else { out }
}

/// The rim of an opening.
struct Rim<'a> {
    mesh: &'a ClothMesh,
    opening: &'a GluedOpening,
    cloth: &'a Distances<'a>,
}

/// One side of a slit on its way from the end.
struct Side {
    /// Heading, radians from the middle of the slit.
    heading: f64,
    /// Distance from the middle of the slit, metres.
    off: f64,
    /// Length so far, metres.
    length: f64,
    particles: Vec<u32>,
}

impl Rim<'_> {
    /// The angle of the cloth at a node of the rim, radians.
    fn angle(&self, k: usize) -> f64 {
        self.cloth.angle(self.opening.rim[k])
    }

    /// The two sides of the slit that ends at a node, from there on.
    fn slit(&self, end: usize) -> [Side; 2] {
        let count = self.opening.rim.len();
        let begin = || Side { heading: (TAU - self.angle(end)) / 2.0, off: 0.0, length: 0.0, particles: Vec::new() };
        let mut sides = [begin(), begin()];
        for k in 1..count / 2 {
            let next = [(end + k) % count, (end + count - k) % count];
            self.go(&mut sides[0], (end + k - 1) % count, 1);
            self.go(&mut sides[1], next[1], 0);
            let [a, b] = &sides;
            if a.off + b.off > OPEN * a.length.min(b.length) + EDGE {
                sides.iter_mut().for_each(|side| side.particles.truncate(k - 1));
                break;
            }
            if next.iter().any(|&n| (PI - self.angle(n)).abs() > CORNER) {
                break;
            }
            for (side, n) in sides.iter_mut().zip(next) {
                side.heading += PI - self.angle(n);
            }
        }
        sides
    }

    /// The two sides of the slits at the ends of a lap, below the last button of a coat: the upper piece's rim goes
    /// straight on, and the lower piece comes out from under it. Where two straps are tied the rim does not turn.
    fn below_lap(&self, glued: &Glued, lap: &Lap) -> Vec<[Side; 2]> {
        let count = self.opening.rim.len();
        let ends = [lap.pairs.first(), lap.pairs.last()].into_iter().flatten();
        let place = |p: u32| glued.node_of[p as usize].and_then(|n| self.opening.rim.iter().position(|m| *m == n));
        let slit = |end: usize| {
            let [on, back] = [self.along(end, 1, lap.over, false), self.along(end, count - 1, lap.over, false)];
            let (over, way) = if on.length >= back.length { (on, count - 1) } else { (back, 1) };
            [over, self.along(end, way, lap.under, true)]
        };
        let places = ends.filter_map(|pair| place(pair[0]));
        let slits = places.filter(|end| self.angle(*end) > TAU - SHARPEST).map(slit);
        slits.filter(|sides| sides.iter().all(|side| side.length >= SHORTEST_BELOW_LAP)).collect()
    }

    /// The edge of a piece along the rim from the end of a lap, by `step` nodes each time, up to a corner.
    ///
    /// The rim of the lower piece begins where the cloth beneath the lap is taken off. That and the corner after it are
    /// passed over.
    fn along(&self, end: usize, step: usize, piece: usize, is_lower: bool) -> Side {
        let count = self.opening.rim.len();
        let mut out = Side { heading: 0.0, off: 0.0, length: 0.0, particles: Vec::new() };
        let edges = &self.mesh.pieces[piece].edges;
        let is_own = |p: u32| edges.iter().any(|edge| edge.particles.contains(&p));
        let mut at = end;
        for _ in 1..count / 2 {
            let next = (at + step) % count;
            let (side, to) = if step == 1 { (at, 1) } else { (next, 0) };
            let particles = self.opening.sides[side];
            if self.mesh.piece_of(particles[to]) != Some(piece) {
                break;
            }
            let is_on_edge = particles.iter().all(|p| is_own(*p));
            if is_on_edge {
                self.go(&mut out, side, to);
            }
            let is_corner = (PI - self.angle(next)).abs() > CORNER;
            if is_on_edge && is_corner || !is_on_edge && !is_lower {
                break;
            }
            at = next;
        }
        out
    }

    /// Along a side of the rim to its first or last particle.
    fn go(&self, side: &mut Side, along: usize, to: usize) {
        let particles = self.opening.sides[along];
        let step = (self.mesh.flat[particles[1] as usize] - self.mesh.flat[particles[0] as usize]).norm();
        side.off += step * side.heading.sin();
        side.length += step;
        side.particles.push(particles[to]);
    }
}
