//! A glued garment as a balloon: inflated to the shape of its pieces round the axes of the body, which grow meanwhile.
//!
//! Lengths are constraints that are met one after another, sweep by sweep (position-based dynamics; Macklin, Müller and
//! Chentanez 2016). Pressure along the normals opens every fold; bending is softer than any cloth's, so that they open.
//! Raised arms come down as the body grows, and the ways of the body with them.
//!
//! No step carries cloth through cloth, or through the ways of the body (the bounds of contact): what starts without a
//! crossing, round the right parts, stays so.

use std::collections::HashMap;

use super::axes::{Axes, RaisedArms};
use super::facing;
use super::lids::{InflatedRound, Lid};
use super::ribbon::Ribbons;
use super::rings::{ABOVE_NECK, Neckline};
use super::star::GluedPart;
use super::way_out::WayOut;
use crate::contact::{Bounds, ClothDetector, Collider, Contact, Neighbourhood};
use crate::geometry::Vec3;
use crate::mannequin::PartKind;

/// Sweeps over all constraints per step. With half as many sleeves of a shirt stay 3 % too short.
const SWEEPS: usize = 30;
/// How much softer bending is than stretch: at a quarter of this crushed sleeves stay crushed.
const BENDING: f64 = 40.0;
/// Pressure moves a free node by this much per step, metres.
const PUSH: f64 = 10e-3;
/// Cloth no wider than this between the openings of the head and of an arm, metres, is a strap, which is not inflated;
/// cloth of twice this width is inflated fully. Inflated straps lay round the trunk as a belt, and not over the
/// shoulders.
pub(super) const STRAP: f64 = 0.1;
/// While it settles the weight of cloth that hangs from the shoulders moves a free node by this per step, metres. With
/// more a slip dress is drawn into its body and takes four times as many steps to sew.
const WEIGHT: f64 = 0.2e-3;
/// A node moves no further than this in one step, metres: less than it may go between two looks at [`REACH`].
const LONGEST: f64 = 10e-3;
/// A ribbon that is so near to where it belongs, metres, stays where it is: rounding does not move it.
const STILL: f64 = 1e-9;
/// Cloth is looked for within this distance of cloth, metres: no step is longer than half of it.
const REACH: f64 = 21e-3;
/// Cloth keeps this distance from cloth, metres, where it had it before.
const MARGIN: f64 = 1e-3;
/// Nodes of different layers are drawn apart to this share of the mean length of the edges. Layers that lie on one
/// another would hinder each other.
const APART: f64 = 0.8;
/// Share of a node's motion that lives on to the next step.
const KEEP: f64 = 0.9;
/// The middle of all that is held is drawn back by this share of its way from where it belongs.
const HOLD: f64 = 0.3;
/// Distance kept from the body, metres.
const GAP: f64 = 5e-3;
/// Distance that the middles of edges keep from the body in the end, metres: a chord of 25 mm lies 1.4 mm within the
/// circle of a neck. With 4 mm more where folded halves lie beneath, a shirt's cuff came to lie beside its wrist.
const MIDDLE_GAP: f64 = 3e-3;
/// The axes start at this share of their thickness.
const SMALLEST: f64 = 0.02;
/// Steps of inflation round thin axes (trousers need 50), of growth (no node is pushed further in one than
/// [`LONGEST`]), and on the body itself without pressure.
const INFLATE: usize = 60;
const GROW: usize = 50;
const SETTLE: usize = 30;
/// Rounds of moving the middles of edges out of the body, after the last step.
const CLEAR: usize = 5;
/// Nodes within so many edges of one another are no layers.
const NEIGHBOURS: usize = 3;
/// The body's surface is looked for within this, metres: of nodes, and of the middles of edges whose ends are outside.
const LOOK: f64 = 0.2;
const LOOK_FROM_MIDDLE: f64 = 0.03;

/// A pair of nodes and the distance they are to have, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Length {
    /// The nodes.
    pub(super) ends: [u32; 2],
    /// Metres.
    pub(super) rest: f64,
}

/// An opening or a section of a tube that is held while the body grows.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// The nodes that are moved, all alike.
    pub(super) rim: Vec<u32>,
    /// Those of them whose middle belongs in the place of `middle`.
    pub(super) by: Vec<u32>,
    /// Metres.
    pub(super) middle: Vec3,
    /// The limb that its middle goes with, and how far along that it is, metres.
    pub(super) limb: Option<(PartKind, f64)>,
    /// A unit direction in which it may move freely.
    pub(super) along: Option<Vec3>,
}

impl Held {
    /// How far its nodes are to move in one step round these axes.
    fn back(&self, p: &[Vec3], axes: &Axes) -> Vec3 {
        let middle = self.by.iter().map(|n| p[*n as usize]).sum::<Vec3>() / self.by.len() as f64;
        let on_limb = self.limb.and_then(|(kind, s)| axes.part(kind).map(|axis| axis.station(s).center));
        let way = on_limb.unwrap_or(self.middle) - middle;
        self.along.map_or(way, |along| way - along * way.dot(&along)) * HOLD
    }
}

/// A connected part of a garment that can be inflated.
#[derive(Debug)]
pub(super) struct Balloon<'a> {
    /// Its triangles and edges.
    pub(super) part: &'a GluedPart<'a>,
    /// The piece of every triangle.
    pub(super) piece: Vec<u32>,
    /// Corners opposite to one another across an edge.
    pub(super) bending: Vec<Length>,
    /// Its openings and sections that are held.
    pub(super) held: Vec<Held>,
    /// The lids of its hems.
    pub(super) lids: Vec<Lid>,
    /// The ways of the body through it.
    pub(super) ways: &'a [WayOut],
    /// How the arms are raised while it is put on. They come down as the body grows.
    pub(super) arms: RaisedArms,
    /// Whether it hangs from the shoulders: nothing of it is held where it settles, and its weight draws straps taut.
    pub(super) hangs: bool,
    /// Its neckline, if it has one on the shoulders.
    pub(super) neckline: Option<Neckline>,
}

/// The forces on a balloon in one step.
#[derive(Clone, Copy)]
struct Load {
    /// Share of the full pressure.
    pressure: f64,
    /// Axes or body. The share of the pressure on their lids that hems carry depends on it.
    round: InflatedRound,
    /// Way by which the weight moves a free node.
    weight: Vec3,
    /// Whether openings and sections are held.
    is_held: bool,
}

/// A balloon on its way.
struct Motion<'a> {
    balloon: &'a Balloon<'a>,
    /// The nodes, then those of the ribbons.
    x: Vec<Vec3>,
    velocity: Vec<Vec3>,
    /// Area of the triangles round every node at rest, twice, metres².
    area: Vec<f64>,
    /// For every triangle 1 where it is of a strap, 0 where it is inflated fully.
    strap: Vec<f64>,
    /// Nodes within [`NEIGHBOURS`] edges of every node, sorted.
    near: Vec<Vec<u32>>,
    /// Distance that layers are drawn apart to, metres.
    apart: f64,
    /// The ways of the body, as they are while it is inflated.
    ribbons: Ribbons,
    detector: ClothDetector,
}

impl Balloon<'_> {
    /// Inflates the part, whose nodes start at `x`, round the `axes`, lets these grow, and puts it on the body.
    pub(super) fn inflate(&self, x: &[Vec3], axes: &Axes, body: &Collider) -> Vec<Vec3> {
        let mut motion = Motion::new(self, x);
        let held = |pressure: f64, round: InflatedRound| Load { pressure, round, weight: Vec3::zeros(), is_held: true };
        let thin = self.arms.pose(axes, 1.0);
        let ribbons = motion.ribbons.nodes.clone();
        for _ in 0..INFLATE {
            motion.step(held(1.0, InflatedRound::Axes), &thin, &ribbons, |p| thin.outside(p, SMALLEST, GAP));
        }
        for k in 0..GROW {
            let share = (k + 1) as f64 / GROW as f64;
            let scale = SMALLEST + (1.0 - SMALLEST) * share;
            let growing = self.arms.pose(axes, 1.0 - share);
            let ribbons = motion.ribbons.carried(self.arms, axes, 1.0 - share);
            motion.step(held(1.0 - share, InflatedRound::Body), &growing, &ribbons, |p| growing.outside(p, scale, GAP));
        }
        let hung = Load { pressure: 0.0, round: InflatedRound::Body, weight: -Vec3::y() * WEIGHT, is_held: false };
        let settling = if self.hangs { hung } else { held(0.0, InflatedRound::Body) };
        let ribbons = motion.ribbons.carried(self.arms, axes, 0.0);
        for _ in 0..SETTLE {
            motion.step(settling, axes, &ribbons, |p| p + way_out(body, p, GAP, LOOK));
        }
        for _ in 0..CLEAR {
            if !motion.clear_middles(body) {
                break;
            }
        }
        motion.x.truncate(x.len());
        motion.x
    }

    /// The mean length of its edges, metres.
    fn mean_edge(&self) -> f64 {
        let edges = &self.part.edges;
        edges.iter().map(|l| l.rest).sum::<f64>() / edges.len().max(1) as f64
    }

    /// Twice the area of the triangles round every node at rest, metres².
    fn areas(&self, count: usize) -> Vec<f64> {
        let mut area = vec![0.0; count];
        for (t, [a, b, c]) in self.part.triangles.iter().zip(&self.part.flat) {
            let double = (b - a).perp(&(c - a)).abs();
            t.iter().for_each(|n| area[*n as usize] += double);
        }
        area
    }

    /// Finds what is near each other in the cloth and of the cloth and ribbons whose nodes are those from `count` on.
    fn detector(&self, ribbons: &Ribbons, count: usize) -> ClothDetector {
        let first = count as u32;
        let next = self.piece.iter().max().map_or(0, |last| last + 1);
        let part = self.part;
        let own = ribbons.triangles.iter().map(|t| t.map(|n| first + n));
        let triangles: Vec<[u32; 3]> = part.triangles.iter().copied().chain(own).collect();
        let flat: Vec<_> = part.flat.iter().chain(&ribbons.flat).copied().collect();
        let piece: Vec<u32> = self.piece.iter().copied().chain(ribbons.way.iter().map(|way| next + way)).collect();
        let nodes = first + ribbons.nodes.len() as u32;
        let hood = Neighbourhood { class: (0..nodes).collect(), passing: (0..nodes).map(|n| n >= first).collect() };
        ClothDetector::new(&triangles, &flat, &piece, hood)
    }
}

/// The way out of the body of a point that lies in it, or nearer to it than `gap`, metres. The surface is looked for
/// within `look`.
fn way_out(body: &Collider, p: Vec3, gap: f64, look: f64) -> Vec3 {
    match body.nearest(p, look) {
        Some(near) if near.distance < gap => near.normal * (gap - near.distance),
        _ => Vec3::zeros(),
    }
}

impl<'a> Motion<'a> {
    fn new(balloon: &'a Balloon<'a>, x: &[Vec3]) -> Self {
        let ribbons = Ribbons::along(balloon.ways);
        let detector = balloon.detector(&ribbons, x.len());
        let near = neighbours(x.len(), &balloon.part.edges);
        let (area, apart) = (balloon.areas(x.len()), APART * balloon.mean_edge());
        let part = balloon.part;
        let width = |t: &[u32; 3]| t.map(|n| part.over_shoulder[n as usize]).into_iter().fold(f64::INFINITY, f64::min);
        let strap = part.triangles.iter().map(|t| 1.0 - inflated(width(t))).collect();
        let mut x = x.to_vec();
        x.extend(&ribbons.nodes);
        Self { balloon, velocity: vec![Vec3::zeros(); x.len()], x, area, strap, near, apart, ribbons, detector }
    }

    /// Number of nodes of the garment.
    fn count(&self) -> usize {
        self.area.len()
    }

    /// One step under a load, clear of a body that leads points `outside` it. Straps turn away from its `axes`, and the
    /// ribbons go to where they are given.
    fn step(&mut self, load: Load, axes: &Axes, ribbons: &[Vec3], outside: impl Fn(Vec3) -> Vec3) {
        let push = self.pushed(load.round);
        let turn = facing::turned(&self.x[..self.count()], &self.balloon.part.triangles, &self.strap, axes);
        let mut p: Vec<Vec3> = self.x.iter().zip(&self.velocity).map(|(x, v)| x + v).collect();
        for ((p, push), turn) in p.iter_mut().zip(&push).zip(turn) {
            *p += push * (PUSH * load.pressure) + turn + load.weight;
        }
        let layers = self.layers(&p);
        for _ in 0..SWEEPS {
            self.balloon.part.edges.iter().for_each(|length| meet(&mut p, length, 2.0));
            self.balloon.bending.iter().for_each(|length| meet(&mut p, length, 2.0 + BENDING));
            layers.iter().for_each(|pair| keep_apart(&mut p, *pair, self.apart));
        }
        for held in self.balloon.held.iter().filter(|_| load.is_held) {
            let back = held.back(&p, axes);
            held.rim.iter().for_each(|n| p[*n as usize] += back);
        }
        if let Some(neckline) = &self.balloon.neckline {
            lower(&mut p, neckline);
        }
        for (x, p) in self.x.iter().zip(&mut p).take(self.area.len()) {
            *p = x + short(outside(*p) - x);
        }
        let count = self.count();
        for ((x, p), to) in self.x.iter().zip(&mut p).skip(count).zip(ribbons) {
            let way = to - x;
            *p = if way.norm() < STILL { *x } else { x + short(way) };
        }
        self.go(p);
    }

    /// Moves edges out of the body whose middles are in it, or too near to it, though their ends are not. Returns
    /// whether there were any.
    fn clear_middles(&mut self, body: &Collider) -> bool {
        let mut shift = vec![(Vec3::zeros(), 0.0); self.count()];
        for [a, b] in self.balloon.part.edges.iter().map(|length| length.ends.map(|n| n as usize)) {
            let way = way_out(body, (self.x[a] + self.x[b]) / 2.0, MIDDLE_GAP, LOOK_FROM_MIDDLE);
            if way != Vec3::zeros() {
                for n in [a, b] {
                    shift[n].0 += way;
                    shift[n].1 += 1.0;
                }
            }
        }
        if shift.iter().all(|(_, count)| *count == 0.0) {
            return false;
        }
        let moved = |(x, (way, count)): (&Vec3, &(Vec3, f64))| x + short(way / f64::max(*count, 1.0));
        let mut p: Vec<Vec3> = self.x.iter().zip(&shift).map(moved).collect();
        p.extend_from_slice(&self.x[self.count()..]);
        self.go(p);
        true
    }

    /// Moves towards `p` as far as nothing meets. Ribbons that stay give way to nothing.
    fn go(&mut self, mut p: Vec<Vec3>) {
        let contacts = self.detector.detect(&self.x, REACH);
        let mut bounds = Bounds::new(&self.x, REACH, MARGIN);
        let [leash, _] = Bounds::allowances_after_all(REACH, REACH);
        (0..self.x.len()).for_each(|n| bounds.restart(n, self.x[n], leash));
        bounds.hold((self.count()..self.x.len()).filter(|n| p[*n] == self.x[*n]).map(|n| n as u32).collect());
        bounds.clamp(&contacts.iter().collect::<Vec<&Contact>>(), &self.x, &mut p);
        for ((x, v), p) in self.x.iter_mut().zip(&mut self.velocity).zip(p) {
            *v = (p - *x) * KEEP;
            *x = p;
        }
    }

    /// The direction in which pressure pushes every node; shorter where the cloth round it is crushed, and on straps.
    /// Nodes at a hem carry pressure on its lid too.
    fn pushed(&self, round: InflatedRound) -> Vec<Vec3> {
        let mut out = vec![Vec3::zeros(); self.count()];
        for t in &self.balloon.part.triangles {
            let [a, b, c] = t.map(|n| self.x[n as usize]);
            let normal = (c - a).cross(&(b - a));
            t.iter().for_each(|n| out[*n as usize] += normal);
        }
        let width = |n: usize| inflated(self.balloon.part.over_shoulder[n]);
        for (n, (out, area)) in out.iter_mut().zip(&self.area).enumerate() {
            *out = *out * width(n) / area.max(f64::MIN_POSITIVE);
        }
        let lids = self.balloon.lids.iter();
        lids.flat_map(|lid| lid.push(round, &self.x, &self.area)).for_each(|(n, push)| out[n] += push * width(n));
        out
    }

    /// Pairs of nodes of different layers that are near each other.
    fn layers(&self, p: &[Vec3]) -> Vec<[u32; 2]> {
        let reach = self.apart + LONGEST;
        let cell = |v: &Vec3| [0, 1, 2].map(|c| (v[c] / reach).floor() as i64);
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        let own = || p.iter().zip(&self.area).enumerate().filter(|(_, (_, area))| **area > 0.0);
        for (n, (v, _)) in own() {
            cells.entry(cell(v)).or_default().push(n as u32);
        }
        let mut out = Vec::new();
        for (n, (v, _)) in own() {
            let [i, j, k] = cell(v);
            let around =
                (-1..=1).flat_map(|a| (-1..=1).flat_map(move |b| (-1..=1).map(move |c| [i + a, j + b, k + c])));
            for m in around.filter_map(|key| cells.get(&key)).flatten() {
                let is_layer = *m > n as u32 && (p[*m as usize] - v).norm() < reach;
                if is_layer && self.near[n].binary_search(m).is_err() {
                    out.push([n as u32, *m]);
                }
            }
        }
        out
    }
}

/// Lowers a neckline that rises above its shoulders: what has more length than the way up to the neck falls in folds,
/// as a cowl does, and does not stand up before the throat.
fn lower(p: &mut [Vec3], neckline: &Neckline) {
    let highest = neckline.shoulders.map(|n| p[n as usize].y).into_iter().fold(f64::NEG_INFINITY, f64::max);
    neckline.rim.iter().for_each(|n| p[*n as usize].y = p[*n as usize].y.min(highest + ABOVE_NECK));
}

/// The share of the pressure that inflates cloth of this width over a shoulder, metres.
fn inflated(width: f64) -> f64 {
    ((width - STRAP) / STRAP).clamp(0.0, 1.0)
}

/// A way no longer than [`LONGEST`].
fn short(way: Vec3) -> Vec3 {
    way * (LONGEST / way.norm().max(LONGEST))
}

/// Moves both nodes so that their distance comes nearer to what it is to be; by all of the error for a `weight` of 2.
fn meet(p: &mut [Vec3], length: &Length, weight: f64) {
    let [a, b] = length.ends.map(|n| n as usize);
    let way = p[b] - p[a];
    let far = way.norm().max(1e-12);
    let shift = way * ((far - length.rest) / (weight * far));
    p[a] += shift;
    p[b] -= shift;
}

/// Moves both nodes apart if they are nearer than `apart`.
fn keep_apart(p: &mut [Vec3], [a, b]: [u32; 2], apart: f64) {
    let way = p[b as usize] - p[a as usize];
    let far = way.norm();
    if far < apart && far > 1e-9 {
        let shift = way * (0.5 * (apart - far) / far);
        p[a as usize] -= shift;
        p[b as usize] += shift;
    }
}

/// Nodes within [`NEIGHBOURS`] edges of every node, itself among them, sorted.
fn neighbours(count: usize, edges: &[Length]) -> Vec<Vec<u32>> {
    let mut next: Vec<Vec<u32>> = vec![Vec::new(); count];
    for [a, b] in edges.iter().map(|l| l.ends) {
        next[a as usize].push(b);
        next[b as usize].push(a);
    }
    let within = |n: usize| {
        let mut all = vec![n as u32];
        let mut from = 0;
        for _ in 0..NEIGHBOURS {
            let to = all.len();
            for k in from..to {
                for m in &next[all[k] as usize] {
                    if !all.contains(m) {
                        all.push(*m);
                    }
                }
            }
            from = to;
        }
        all.sort_unstable();
        all
    };
    (0..count).map(within).collect()
}
