//! Slits in a hem are closed with themselves for the start: the vent of a skirt, the open end of a side seam.
//!
//! A hem's rim goes up one side of a slit and down the other. Left open it would start as a ring of twice the hem's
//! width, as high up as the slit's end.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};

use super::glue::Glued;
use super::laps::matched;
use super::openings::GluedOpening;
use crate::geometry::Vec2;
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

/// The pairs of particles that close the slits of an opening. None where its rim would be shorter than `least`, metres:
/// then the body passes through the slits too. Laps are closed already.
pub(super) fn slits(glued: &Glued, mesh: &ClothMesh, opening: &GluedOpening, least: f64) -> Vec<[u32; 2]> {
    let rim = Rim::new(glued, mesh, opening);
    if opening.sides.len() != opening.rim.len() {
        return Vec::new();
    }
    let mut taken: BTreeSet<u32> = glued.laps.iter().flat_map(|lap| lap.pairs.iter().flatten().copied()).collect();
    let (mut out, mut left) = (Vec::new(), opening.length);
    for end in (0..opening.rim.len()).filter(|&k| rim.angle(k) > TAU - SHARPEST) {
        let [a, b] = rim.slit(end);
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
    /// The angle of the cloth at every node of the garment, radians.
    angles: Vec<f64>,
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

impl<'a> Rim<'a> {
    fn new(glued: &Glued, mesh: &'a ClothMesh, opening: &'a GluedOpening) -> Self {
        let mut angles = vec![0.0; glued.count];
        for (k, nodes) in glued.triangles.iter().enumerate() {
            let flat = glued.flat(mesh, k);
            for (k, n) in nodes.iter().enumerate() {
                let way = |to: usize| -> Vec2 { flat[(k + to) % 3] - flat[k] };
                angles[*n as usize] += way(1).angle(&way(2));
            }
        }
        Self { mesh, opening, angles }
    }

    /// The angle of the cloth at a node of the rim, radians.
    fn angle(&self, k: usize) -> f64 {
        self.angles[self.opening.rim[k] as usize]
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

    /// Along a side of the rim to its first or last particle.
    fn go(&self, side: &mut Side, along: usize, to: usize) {
        let particles = self.opening.sides[along];
        let step = (self.mesh.flat[particles[1] as usize] - self.mesh.flat[particles[0] as usize]).norm();
        side.off += step * side.heading.sin();
        side.length += step;
        side.particles.push(particles[to]);
    }
}
