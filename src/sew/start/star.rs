//! A glued garment as a star: every node in a direction of its own from a point within the body.
//!
//! A star passes nowhere through itself, whatever the distances of its nodes are, if and only if no triangle is turned
//! over and the surface goes round the point once. So a garment that starts as a star starts without a crossing, the
//! body's axes inside and each end of the body leaving by its own opening.

use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

use super::axes::Axes;
use super::balloon::Length;
use super::circles::{Circle, Mouth, circles, room};
use super::harmonic::{Film, OpeningRing};
use super::reach;
use super::unfold::{Facet, Rounds, unfold};
use super::way_out::{WayOut, axis_of, ways_out};
use crate::geometry::{Vec2, Vec3, sorted_pair};
use crate::mannequin::PartKind;

/// An edge round a tube pulls with at least this share of the force of one along it. With 1 a sleeve narrows towards
/// its opening by a factor of 500 on one turn of its length, as directions to a soap film do.
const ROUND: f64 = 0.05;
/// A hole's middle pulls at its rim like an edge of this length, metres.
const SPOKE: f64 = 0.05;
/// A hole weighs as much as this share of its area: its shape is nobody's.
const HOLE: f64 = 0.1;
/// At most this share of the sphere may be covered the wrong way round before the star is unfolded.
const TURNED: f64 = 0.1;
/// The point within is looked for at places so far apart on an axis, metres, and so many are tried.
const APART: f64 = 0.02;
const TRIES: usize = 8;
/// By so much a metre on the flat piece directions differ at least, radians: what hangs on one node is a point of the
/// film, and a point does not unfold.
const SPREAD: f64 = 1e-2;

/// A connected part of a glued garment.
#[derive(Debug)]
pub(super) struct GluedPart<'a> {
    /// The openings that the body leaves by.
    pub(super) mouths: Vec<Mouth<'a>>,
    /// Rims that nothing passes through.
    pub(super) holes: Vec<&'a [u32]>,
    /// Clockwise seen from outside.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Flat corners of the triangles, metres.
    pub(super) flat: Vec<[Vec2; 3]>,
    /// The edges of the triangles.
    pub(super) edges: Vec<Length>,
    /// Distance of every node of the whole garment from the nearest mouth on the cloth, metres.
    pub(super) far: Vec<f64>,
    /// Width of the cloth over a shoulder at every node of the whole garment, metres: how far the mouths of an arm and
    /// of the head are from there. Infinite without either.
    pub(super) over_shoulder: Vec<f64>,
}

/// A part of a garment as a star.
#[derive(Clone, Debug)]
pub(super) struct Star {
    /// Where the nodes are; those of other parts are anywhere.
    pub(super) nodes: Vec<Vec3>,
    /// The ways of the body through it.
    pub(super) ways: Vec<WayOut>,
}

/// Directions from a point.
#[derive(Clone, Debug)]
struct Sight {
    from: Vec3,
    /// The mouths.
    circles: Vec<Circle>,
    directions: Vec<Vec3>,
    /// Share of the sphere that is covered the wrong way round.
    turned: f64,
    /// The least angle between two mouths, radians.
    room: f64,
}

impl GluedPart<'_> {
    /// The part as a star round a point on the `axes`. `None` where none was found.
    pub(super) fn star(&self, axes: &Axes) -> Option<Star> {
        let pulls = self.pulls();
        let rims: Vec<OpeningRing> = self.mouths.iter().map(|mouth| mouth.ring.clone()).collect();
        let film = Film::new(self.count(), &pulls, &rims)?;
        let middles = Film::new(self.count(), &pulls, &self.middles())?;
        let sights = self.sights(&film, axes)?;
        let (to, room) = sights.first().map(|roomiest| (roomiest.from, roomiest.room))?;
        let mut tried: Vec<Sight> = sights.into_iter().take(TRIES).collect();
        tried.iter_mut().for_each(|sight| self.spread_out(&mut sight.directions));
        let found = [Rounds::Short, Rounds::Long]
            .into_iter()
            .find_map(|rounds| tried.iter().find_map(|sight| self.unfolded(sight.clone(), rounds, &middles)))?;
        // Where mouths overlap from every point, there is none to lead it to.
        let found = if room < 0.0 { found } else { self.led_to(to, found, &middles) };
        let Sight { from, circles, directions, .. } = found;
        let ways = ways_out(&self.mouths, from, axes);
        let mut nodes = self.at_reach(&directions, &circles, &rims)?;
        reach::clear(&mut nodes, &self.triangles, &ways, from);
        nodes.iter_mut().for_each(|x| *x += from);
        Some(Star { nodes, ways })
    }

    /// A sight whose directions are unfolded. `None` where that does not succeed.
    fn unfolded(&self, mut sight: Sight, rounds: Rounds, middles: &Film) -> Option<Sight> {
        unfold(&mut sight.directions, &self.facets(&sight.circles), middles, rounds).then_some(sight)
    }

    /// Leads the point of an unfolded sight from which mouths overlap towards a point `to` from which they are apart:
    /// in steps that keep it unfolded, as far as that goes. Started anew there it may not unfold: a shirt's cuff was
    /// turned inside out from all points but those at its hem.
    fn led_to(&self, to: Vec3, mut sight: Sight, middles: &Film) -> Sight {
        let mut step = to - sight.from;
        while sight.room < 0.0 && step.norm() >= APART {
            let left = to - sight.from;
            let from = sight.from + if left.norm() <= step.norm() { left } else { step };
            let circles = circles(&self.mouths, from);
            let mut directions = sight.directions.clone();
            self.point_at(&circles, &mut directions);
            let ahead = Sight { from, circles, directions, room: room(&self.mouths, from), ..sight };
            match self.unfolded(ahead, Rounds::Long, middles) {
                Some(unfolded) => sight = unfolded,
                None => step /= 2.0,
            }
        }
        sight
    }

    /// Puts the nodes in the middles of mouths into the middles of their circles.
    fn point_at(&self, circles: &[Circle], directions: &mut [Vec3]) {
        for ((middle, _), circle) in self.caps().skip(self.holes.len()).zip(circles) {
            directions[middle as usize] = circle.middle;
        }
    }

    /// All nodes of the garment, and one in the middle of every hole and mouth.
    fn count(&self) -> usize {
        self.far.len() + self.holes.len() + self.mouths.len()
    }

    /// The rims of holes and mouths, each with the node in its middle.
    fn caps(&self) -> impl Iterator<Item = (u32, &[u32])> {
        let mouths = self.mouths.iter().map(|mouth| mouth.ring.rim.as_slice());
        let first = self.far.len() as u32;
        self.holes.iter().copied().chain(mouths).enumerate().map(move |(k, rim)| (first + k as u32, rim))
    }

    /// The middle of every mouth as a ring of one node.
    fn middles(&self) -> Vec<OpeningRing> {
        let nodes = self.caps().skip(self.holes.len()).map(|(middle, _)| middle);
        nodes.zip(&self.mouths).map(|(n, mouth)| OpeningRing { rim: vec![n], ..mouth.ring.clone() }).collect()
    }

    /// The edges as the lengths of springs that pull along tubes and little round them, and those that close holes.
    fn pulls(&self) -> Vec<Length> {
        let pull = |length: &Length| {
            let [a, b] = length.ends.map(|n| self.far[n as usize]);
            let along = ((a - b) / length.rest).clamp(-1.0, 1.0);
            Length { ends: length.ends, rest: length.rest / (ROUND + (1.0 - ROUND) * along * along) }
        };
        let spokes =
            self.caps().flat_map(|(middle, rim)| rim.iter().map(move |&n| Length { ends: [n, middle], rest: SPOKE }));
        self.edges.iter().map(pull).chain(spokes).collect()
    }

    /// The film as seen from points on the axis that the part is round, where it goes round them once: in turn those
    /// from which the mouths are furthest apart, and those from which least of the film is turned over.
    fn sights(&self, film: &Film, axes: &Axes) -> Option<Vec<Sight>> {
        let axis = axis_of(&self.mouths, axes).or_else(|| axes.part(PartKind::Torso))?;
        let count = (axis.length() / APART) as usize;
        let places = (0..=count).map(|k| axis.station(APART * k as f64).center);
        let mut by_room: Vec<Sight> = places.filter_map(|from| self.sight(from, film)).collect();
        let mut by_turned: Vec<usize> = (0..by_room.len()).collect();
        by_room.sort_by(|a, b| b.room.total_cmp(&a.room));
        by_turned.sort_by(|a, b| by_room[*a].turned.total_cmp(&by_room[*b].turned));
        let mut order: Vec<usize> = Vec::new();
        for k in (0..by_room.len()).flat_map(|k| [k, by_turned[k]]) {
            if !order.contains(&k) {
                order.push(k);
            }
        }
        let mut sights: Vec<Option<Sight>> = by_room.into_iter().map(Some).collect();
        Some(order.into_iter().filter_map(|k| sights[k].take()).collect())
    }

    /// The film between the mouths' circles as seen from a point; `None` where it does not go round that once.
    fn sight(&self, from: Vec3, film: &Film) -> Option<Sight> {
        let circles = circles(&self.mouths, from);
        let mut given = vec![Vec3::zeros(); self.count()];
        for (mouth, circle) in self.mouths.iter().zip(&circles) {
            mouth.on(*circle).for_each(|(n, direction)| given[n] = direction * circle.far);
        }
        let mut directions = film.spread_points(&given);
        self.point_at(&circles, &mut directions);
        directions.iter_mut().for_each(|d| *d = d.try_normalize(1e-12).unwrap_or_else(Vec3::z));
        let [turned, winding] = self.turned(&directions);
        let room = room(&self.mouths, from);
        ((winding - 1.0).abs() < 0.5 && turned < TURNED).then_some(Sight { from, circles, directions, turned, room })
    }

    /// The share of the sphere that is covered the wrong way round, and how often the surface goes round the middle.
    fn turned(&self, directions: &[Vec3]) -> [f64; 2] {
        let fan = |(middle, rim): (u32, &[u32])| -> Vec<[u32; 3]> {
            (0..rim.len()).map(|i| [rim[(i + 1) % rim.len()], rim[i], middle]).collect()
        };
        let (mut turned, mut winding) = (0.0, 0.0);
        for t in self.triangles.iter().copied().chain(self.caps().flat_map(fan)) {
            let [a, b, c] = t.map(|n| directions[n as usize]);
            // Its solid angle (Van Oosterom and Strackee 1983), as a share of the sphere; clockwise counts as positive.
            let share = 2.0 * (-a.dot(&b.cross(&c))).atan2(1.0 + a.dot(&b) + b.dot(&c) + c.dot(&a)) / (4.0 * PI);
            winding += share;
            turned -= share.min(0.0);
        }
        [turned, winding]
    }

    /// Moves directions by a little of how their nodes lie on the flat pieces.
    fn spread_out(&self, directions: &mut [Vec3]) {
        let mut flat = vec![(Vec2::zeros(), 0.0); directions.len()];
        for (t, corners) in self.triangles.iter().zip(&self.flat) {
            for (n, p) in t.iter().zip(corners) {
                let (sum, count) = &mut flat[*n as usize];
                *sum += p;
                *count += 1.0;
            }
        }
        for (direction, (sum, count)) in directions.iter_mut().zip(flat).filter(|(_, (_, count))| *count > 0.0) {
            let ahead = if direction.y.abs() < 0.9 { Vec3::y() } else { Vec3::z() };
            let side = ahead.cross(direction).normalize();
            let up = direction.cross(&side);
            let p = sum / count * SPREAD;
            // The right side faces the reader of the flat piece, y down.
            *direction = (*direction + side * p.x - up * p.y).normalize();
        }
    }

    /// The triangles as they are to lie on the sphere, which they cover with the holes and mouths. Triangles that lie
    /// on each other with all corners cannot both look outward, and are left out.
    fn facets(&self, circles: &[Circle]) -> Vec<Facet> {
        let whole: f64 = self.flat.iter().map(flat_area).sum();
        let scale = (4.0 * PI / whole).sqrt();
        let sorted = |t: &[u32; 3]| {
            let mut t = *t;
            t.sort_unstable();
            t
        };
        let mut times: BTreeMap<[u32; 3], usize> = BTreeMap::new();
        self.triangles.iter().for_each(|t| *times.entry(sorted(t)).or_default() += 1);
        let own = self.triangles.iter().zip(&self.flat).filter(|(t, _)| times[&sorted(t)] == 1);
        let own = own.filter_map(|(t, c)| Facet::new(*t, c.map(|p| p * scale), flat_area(c) / whole));
        own.chain(self.cap_facets(circles, scale)).collect()
    }

    /// Holes as regular polygons of their length, mouths as their circles.
    fn cap_facets(&self, circles: &[Circle], scale: f64) -> Vec<Facet> {
        let rest: BTreeMap<[u32; 2], f64> = self.edges.iter().map(|l| (l.ends, l.rest)).collect();
        let mut out = Vec::new();
        for (k, (middle, rim)) in self.caps().enumerate() {
            let sides: Vec<[u32; 2]> = (0..rim.len()).map(|i| [rim[i], rim[(i + 1) % rim.len()]]).collect();
            let length = |side: &[u32; 2]| rest.get(&sorted_pair(*side)).copied().unwrap_or(0.0);
            let whole: f64 = sides.iter().map(length).sum();
            let circle = k.checked_sub(self.holes.len()).map(|k| circles[k]);
            let radius = circle.map_or(scale * whole / TAU, |circle| circle.width.sin());
            for side in &sides {
                let base = length(side) / whole.max(f64::MIN_POSITIVE) * TAU * radius;
                let flat = [Vec2::zeros(), Vec2::new(base, 0.0), Vec2::new(0.5 * base, radius)];
                let share = if circle.is_some() { 1.0 } else { HOLE };
                out.extend(Facet::new([side[1], side[0], middle], flat, share * 0.5 * base * radius / (4.0 * PI)));
            }
        }
        out
    }

    /// The nodes in their directions, as far off as the openings are.
    fn at_reach(&self, directions: &[Vec3], circles: &[Circle], rims: &[OpeningRing]) -> Option<Vec<Vec3>> {
        let mut reach = vec![0.0; self.far.len()];
        for (mouth, circle) in self.mouths.iter().zip(circles) {
            mouth.ring.rim.iter().for_each(|n| reach[*n as usize] = circle.far);
        }
        let reach = Film::new(reach.len(), &self.edges, rims)?.spread(&reach);
        Some(reach.iter().zip(directions).map(|(far, direction)| direction * *far).collect())
    }
}

/// Area of a flat triangle, square metres.
pub(super) fn flat_area(corners: &[Vec2; 3]) -> f64 {
    0.5 * (corners[1] - corners[0]).perp(&(corners[2] - corners[0])).abs()
}
