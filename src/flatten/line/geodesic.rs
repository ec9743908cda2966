//! The straightest way beside a chain of vertices: the strip of triangles along it is unfolded into the plane and a
//! thread is drawn tight in it; where the thread lies round a vertex that it could pass on the other side on a shorter
//! way, the strip is led there (after Xin & Wang 2007, "Efficiently determining a locally exact shortest path on
//! polyhedral surfaces").

use std::f64::consts::PI;

use super::SurfacePoint;
use super::web::Web;
use crate::geometry::{TriMesh, Vec2, sorted_pair};

/// Rounds of leading the strip; each makes the way shorter, and few are needed but where mistakes of rounding decide.
const ROUNDS: usize = 1000;
/// A vertex with less than half a turn on its other side is passed there; by this much less, radians, for rounding.
const SURELY: f64 = 1e-7;
/// A thread runs along a gate when the sine of the angle between them is smaller.
const ALONG: f64 = 1e-9;

/// The straightest way from the first vertex of a chain to its last, round the same side of every hole.
pub(super) fn straightest(surface: &TriMesh, web: &Web, chain: &[u32]) -> Vec<SurfacePoint> {
    let as_it_is = || chain.iter().map(|&v| SurfacePoint::Vertex(v)).collect();
    let [from, .., to] = *chain else { return as_it_is() };
    let Some(triangles) = strip_along(web, chain) else { return as_it_is() };
    let mut strip = TriangleStrip { surface, web, from, to, triangles };
    for _ in 0..ROUNDS {
        strip.clean();
        if strip.triangles.len() < 2 {
            return if from == to { as_it_is() } else { vec![SurfacePoint::Vertex(from), SurfacePoint::Vertex(to)] };
        }
        let Some(unfolded) = strip.unfolded() else { return as_it_is() };
        let bends = unfolded.drawn_tight();
        if !strip.lead(&unfolded, &bends) {
            return unfolded.spots(&strip, &bends);
        }
    }
    as_it_is()
}

/// Triangles that lie beside a chain of vertices, each a neighbour of the next: at every vertex on the side where the
/// chain turns by less. `None` where the rim is on both sides.
fn strip_along(web: &Web, chain: &[u32]) -> Option<Vec<u32>> {
    let mut strip: Vec<u32> = Vec::new();
    for w in chain.windows(3) {
        let fans = [true, false].map(|left| fan(web, w[1], [w[0], w[2]], left));
        let fan = fans.into_iter().flatten().min_by_key(Vec::len)?;
        strip.extend(fan);
    }
    if chain.len() == 2 {
        strip.extend(web.beside([chain[0], chain[1]]).first());
    }
    strip.dedup();
    Some(strip)
}

/// The triangles round a vertex from one of its neighbours to another, on the left or on the right of the way through
/// it. `None` across the rim.
fn fan(web: &Web, v: u32, [before, after]: [u32; 2], left: bool) -> Option<Vec<u32>> {
    // On the left of a way to v lies the triangle that runs against it: v, before.
    let runs = |t: u32, a: u32, b: u32| {
        let corners = web.corners(t);
        (0..3).any(|k| corners[k] == a && corners[(k + 1) % 3] == b)
    };
    let (a, b) = if left { (before, v) } else { (v, before) };
    let mut triangle = *web.round(v).iter().find(|&&t| runs(t, a, b))?;
    let mut edge = before;
    let mut fan = vec![triangle];
    for _ in 0..web.round(v).len() {
        edge = web.corners(triangle).into_iter().find(|&w| w != v && w != edge)?;
        if edge == after {
            return Some(fan);
        }
        triangle = web.beyond(triangle, [v, edge])?;
        fan.push(triangle);
    }
    None
}

/// Neighbouring triangles from one vertex to another.
struct TriangleStrip<'a> {
    surface: &'a TriMesh,
    web: &'a Web,
    from: u32,
    to: u32,
    triangles: Vec<u32>,
}

/// An edge that the way crosses: the ends on its left and on its right.
type Gate = [u32; 2];

impl TriangleStrip<'_> {
    /// The edge between a triangle and the next.
    fn gate(&self, k: usize) -> Option<Gate> {
        let (own, next) = (self.web.corners(self.triangles[k]), self.web.corners(self.triangles[k + 1]));
        let side = (0..3).map(|k| [own[k], own[(k + 1) % 3]]).find(|ends| ends.iter().all(|v| next.contains(v)))?;
        // Left of a side that runs round its triangle lies the triangle.
        Some([side[1], side[0]])
    }

    /// Leaves out ways there and back, and what only turns round the ends.
    fn clean(&mut self) {
        let mut kept: Vec<u32> = Vec::with_capacity(self.triangles.len());
        for &t in &self.triangles {
            if kept.len() > 1 && kept[kept.len() - 2] == t {
                kept.pop();
            } else if kept.last() != Some(&t) {
                kept.push(t);
            }
        }
        self.triangles = kept;
        let turns = |strip: &Self, k: usize, end: u32| strip.gate(k).is_some_and(|gate| gate.contains(&end));
        while self.triangles.len() > 1 && turns(self, 0, self.from) {
            self.triangles.remove(0);
        }
        while self.triangles.len() > 1 && turns(self, self.triangles.len() - 2, self.to) {
            self.triangles.pop();
        }
    }

    /// The strip in the plane.
    fn unfolded(&self) -> Option<Unfolded> {
        let at = |v: u32| self.surface.vertices[v as usize];
        let gates: Vec<Gate> = (0..self.triangles.len() - 1).map(|k| self.gate(k)).collect::<Option<_>>()?;
        let first = gates[0];
        let mut places = [Vec2::new((at(first[0]) - at(first[1])).norm(), 0.0), Vec2::zeros()];
        let apex = |v: u32, gate: Gate, [left, right]: [Vec2; 2]| {
            let (along, way) = (at(gate[1]) - at(gate[0]), at(v) - at(gate[0]));
            let length = along.norm();
            let share = along.dot(&way) / length;
            let height = along.cross(&way).norm() / length;
            let u = (right - left) / (right - left).norm();
            left + u * share + Vec2::new(-u.y, u.x) * height
        };
        let mut portals = Vec::with_capacity(gates.len() + 2);
        // Seen through the first gate the beginning lies behind.
        let start = apex(self.from, [first[1], first[0]], [places[1], places[0]]);
        portals.push([start; 2]);
        portals.push(places);
        for (k, gate) in gates.iter().enumerate() {
            let corners = self.web.corners(self.triangles[k + 1]);
            let v = corners.into_iter().find(|v| !gate.contains(v))?;
            let next = apex(v, *gate, places);
            match gates.get(k + 1) {
                Some(&[left, right]) => {
                    let place = |w: u32| if w == v { next } else { places[usize::from(w == gate[1])] };
                    places = [place(left), place(right)];
                    portals.push(places);
                }
                None => portals.push([next; 2]),
            }
        }
        Some(Unfolded { gates, portals })
    }

    /// Leads the strip round those vertices on the other side of which the way is shorter; whether there were any.
    fn lead(&mut self, unfolded: &Unfolded, bends: &[GateBend]) -> bool {
        let mut led = false;
        let mut end = usize::MAX;
        for (k, bend) in bends.iter().enumerate().rev() {
            let v = unfolded.gates[bend.portal - 1][bend.side];
            let holds = |gate: usize| unfolded.gates[gate].contains(&v);
            let (mut low, mut high) = (bend.portal - 1, bend.portal - 1);
            while low > 0 && holds(low - 1) {
                low -= 1;
            }
            while high + 1 < unfolded.gates.len() && holds(high + 1) {
                high += 1;
            }
            let other = self.web.angle(v) - PI - unfolded.turn(bends, k);
            if high + 1 >= end || other > PI - SURELY || self.web.is_rim(v) {
                continue;
            }
            let gate = unfolded.gates[low];
            if let Some(round) = self.round(v, gate, [self.triangles[low], self.triangles[high + 1]]) {
                self.triangles.splice(low + 1..=high + 1, round);
                (led, end) = (true, low);
            }
        }
        led
    }

    /// The triangles round a vertex from one to another, away from a gate at the first.
    fn round(&self, v: u32, gate: Gate, [first, last]: [u32; 2]) -> Option<Vec<u32>> {
        let mut edge = self.web.corners(first).into_iter().find(|w| !gate.contains(w))?;
        let (mut triangle, mut round) = (first, Vec::new());
        while triangle != last && round.len() <= self.web.round(v).len() {
            triangle = self.web.beyond(triangle, [v, edge])?;
            round.push(triangle);
            edge = self.web.corners(triangle).into_iter().find(|&w| w != v && w != edge)?;
        }
        Some(round)
    }
}

/// A strip in the plane.
struct Unfolded {
    gates: Vec<Gate>,
    /// The ends, left and right, of what the way crosses: the start, every gate, the end.
    portals: Vec<[Vec2; 2]>,
}

/// Where a drawn thread bends round an end of a gate.
#[derive(Clone, Copy, Debug)]
struct GateBend {
    portal: usize,
    /// 0 on the left, 1 on the right.
    side: usize,
}

impl Unfolded {
    /// The bends of a thread drawn tight from the start to the end: the funnel algorithm (Lee & Preparata 1984).
    fn drawn_tight(&self) -> Vec<GateBend> {
        let mut bends: Vec<GateBend> = Vec::new();
        let mut apex = self.portals[0][0];
        let mut funnel = [0, 0];
        let mut k = 1;
        while k < self.portals.len() {
            let place = |side: usize, funnel: [usize; 2]| self.portals[funnel[side]][side];
            let mut bent = None;
            for side in [1, 0] {
                let sign = if side == 1 { 1.0 } else { -1.0 };
                let new = self.portals[k][side] - apex;
                let (own, other) = (place(side, funnel) - apex, place(1 - side, funnel) - apex);
                if sign * own.perp(&new) < 0.0 {
                    continue;
                }
                let open = own == Vec2::zeros() || sign * other.perp(&new) < 0.0;
                if open {
                    funnel[side] = k;
                } else {
                    bent = Some(1 - side);
                    break;
                }
            }
            if let Some(side) = bent {
                let portal = funnel[side];
                apex = self.portals[portal][side];
                bends.push(GateBend { portal, side });
                funnel = [portal; 2];
                // Both sides of the funnel begin in its new tip.
                k = portal + 1;
                while k + 1 < self.portals.len() && self.portals[k][side] == apex {
                    funnel[side] = k;
                    k += 1;
                }
                funnel[1 - side] = k;
                funnel[side] = k;
                if k < self.portals.len() {
                    k += 1;
                }
                continue;
            }
            k += 1;
        }
        bends.retain(|bend| bend.portal > 0 && bend.portal + 1 < self.portals.len());
        bends
    }

    /// The corners of the drawn thread with their portals, from the start to the end.
    fn corners(&self, bends: &[GateBend]) -> Vec<(usize, Vec2)> {
        let last = self.portals.len() - 1;
        let bent = bends.iter().map(|b| (b.portal, self.portals[b.portal][b.side]));
        std::iter::once((0, self.portals[0][0])).chain(bent).chain([(last, self.portals[last][0])]).collect()
    }

    /// By how much the thread turns at a bend, radians.
    fn turn(&self, bends: &[GateBend], k: usize) -> f64 {
        let corners = self.corners(bends);
        let (before, after) = (corners[k + 1].1 - corners[k].1, corners[k + 2].1 - corners[k + 1].1);
        before.perp(&after).atan2(before.dot(&after)).abs()
    }

    /// The spots of the drawn thread.
    fn spots(&self, strip: &TriangleStrip<'_>, bends: &[GateBend]) -> Vec<SurfacePoint> {
        let corners = self.corners(bends);
        let mut spots = vec![SurfacePoint::Vertex(strip.from)];
        for w in corners.windows(2) {
            let [(first, a), (last, b)] = [w[0], w[1]];
            for portal in first + 1..last {
                spots.push(self.spot(strip, portal, [a, b]));
            }
            match bends.iter().find(|bend| bend.portal == last) {
                Some(bend) => spots.push(SurfacePoint::Vertex(self.gates[last - 1][bend.side])),
                None => spots.push(SurfacePoint::Vertex(strip.to)),
            }
        }
        spots.dedup();
        spots
    }

    /// Where a stretch of the thread crosses a gate.
    fn spot(&self, strip: &TriangleStrip<'_>, portal: usize, [a, b]: [Vec2; 2]) -> SurfacePoint {
        let ([left, right], ends) = (self.portals[portal], self.gates[portal - 1]);
        let (across, way) = (right - left, b - a);
        let (length, det) = (across.norm(), across.perp(&way));
        let at = if det.abs() > ALONG * length * way.norm() {
            ((a - left).perp(&way) / det).clamp(0.0, 1.0)
        } else {
            // Along the gate: one of its ends is the thread's.
            f64::from(u8::from((right - a).norm() < (left - a).norm()))
        };
        for (side, end) in ends.into_iter().enumerate() {
            let off = length * if side == 0 { at } else { 1.0 - at };
            if off <= strip.web.near(end) {
                return SurfacePoint::Vertex(end);
            }
        }
        let [low, high] = sorted_pair(ends);
        SurfacePoint::Edge { ends: [low, high], at: if low == ends[0] { at } else { 1.0 - at } }
    }
}
