//! A glued garment as a balloon: inflated to the shape of its pieces round the axes of the body, which grow meanwhile.
//!
//! Lengths are constraints that are met one after another, sweep by sweep (position-based dynamics; Macklin, Müller and
//! Chentanez 2016). Pressure along the normals opens every fold; bending is softer than any cloth's, so that they open.
//! Nodes further apart on the cloth than in space keep a distance from one another.

use std::collections::HashMap;
use std::f64::consts::PI;

use super::axes::Axes;
use super::crossed::crossings;
use crate::contact::Collider;
use crate::geometry::{Vec3, sorted_pair};

/// Sweeps over all constraints per step. With half as many sleeves of a shirt stay 3 % too short.
const SWEEPS: usize = 30;
/// How much softer bending is than stretch: at a quarter of this crushed sleeves stay crushed.
const BENDING: f64 = 40.0;
/// Pressure moves a free node by this much per step, metres.
const PUSH: f64 = 10e-3;
/// A node moves no further than this in one step, metres: less than the distance that layers keep.
const LONGEST: f64 = 10e-3;
/// Share of a node's motion that lives on to the next step.
const KEEP: f64 = 0.9;
/// The middle of all that is held is drawn back by this share of its way from where it belongs.
const HOLD: f64 = 0.3;
/// Distance kept from the body, metres.
const GAP: f64 = 5e-3;
/// The axes start at this share of their thickness.
const SMALLEST: f64 = 0.02;
/// Steps of inflation round thin axes, of growth, and on the body itself without pressure.
const INFLATE: usize = 60;
const GROW: usize = 80;
const SETTLE: usize = 30;
/// For so many steps nodes may pass an axis: what the film has on the wrong side of one goes where its cloth is.
const FREE: usize = 20;
/// So few crossings of one edge are led out while the garment is sewn.
const FEW: usize = 2;
/// The ways in which a surface is inflated, one after another until it does not pass through itself.
///
/// With layers 0.6 apart the legs of trousers went through one another at the crotch. A dolman whose nodes may not pass
/// an axis from the first step on is caught on its arms; a shirt whose nodes may do so for longer loses its arms.
const WAYS: [Way; 4] = [
    Way { apart: 0.8, free: FREE },
    Way { apart: 1.0, free: FREE },
    Way { apart: 0.8, free: 0 },
    Way { apart: 1.0, free: 0 },
];
/// Nodes within so many edges of one another are no layers.
const NEIGHBOURS: usize = 3;
/// The body's surface is looked for within this, metres.
const LOOK: f64 = 0.2;

/// An axis of the body that passes through the cloth counts as so many crossings: it is not led out, it is beside its
/// sleeve.
const PASSED: usize = 1000;

/// A way to inflate a surface.
#[derive(Clone, Copy, Debug)]
struct Way {
    /// Nodes of different layers keep this distance, in the mean length of the edges. A node that is so far from those
    /// of a triangle keeps off it by half of that.
    apart: f64,
    /// For so many steps nodes may pass an axis.
    free: usize,
}

/// A pair of nodes and the distance they are to have, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Length {
    /// The nodes.
    pub(super) ends: [u32; 2],
    /// Metres.
    pub(super) rest: f64,
}

/// What is held while the body grows, an opening or a section of a tube: its nodes, and where their middle belongs.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// The nodes.
    pub(super) rim: Vec<u32>,
    /// Metres.
    pub(super) middle: Vec3,
    /// A unit direction in which it may move freely.
    pub(super) along: Option<Vec3>,
    /// Whether it is held only while its nodes, which go round that direction in order, do not go round the place.
    pub(super) once_lost: bool,
}

impl Held {
    /// Whether its nodes go round the place where their middle belongs.
    fn goes_round(&self, p: &[Vec3]) -> bool {
        let Some(along) = self.along else { return false };
        let way = |n: u32| {
            let way = p[n as usize] - self.middle;
            way - along * way.dot(&along)
        };
        let turn = |a: Vec3, b: Vec3| along.dot(&a.cross(&b)).atan2(a.dot(&b));
        let sides = (0..self.rim.len()).map(|k| turn(way(self.rim[k]), way(self.rim[(k + 1) % self.rim.len()])));
        sides.sum::<f64>().abs() > PI
    }
}

/// A surface that can be inflated.
#[derive(Clone, Debug)]
pub(super) struct Balloon {
    /// Clockwise seen from outside.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Edges of the triangles.
    pub(super) stretch: Vec<Length>,
    /// Corners opposite to one another across an edge.
    pub(super) bending: Vec<Length>,
    /// What is held of it.
    pub(super) held: Vec<Held>,
    /// The level of every node among garments that are worn over one another. Each is inflated by itself.
    pub(super) level: Vec<i32>,
}

/// A balloon on its way.
struct Motion<'a> {
    balloon: &'a Balloon,
    x: Vec<Vec3>,
    velocity: Vec<Vec3>,
    /// Area of the triangles round every node at rest, twice, metres².
    area: Vec<f64>,
    /// Nodes within [`NEIGHBOURS`] edges of every node, sorted.
    near: Vec<Vec<u32>>,
    /// Distance that layers keep, metres.
    apart: f64,
}

impl Balloon {
    /// Inflates the surface that starts at `x` round the `axes`, lets these grow, and puts it on the body: in the way
    /// in which it passes through itself least.
    pub(super) fn inflate(&self, x: &[Vec3], axes: &Axes, body: &Collider) -> Vec<Vec3> {
        let mut best: Option<(usize, Vec<Vec3>)> = None;
        for way in WAYS {
            let x = self.inflated(x.to_vec(), way, axes, body);
            let passed = axes.passes(&x, &self.triangles);
            let crossings = PASSED * passed + self.crossings(&x);
            if best.as_ref().is_none_or(|(least, _)| crossings < *least) {
                best = Some((crossings, x));
            }
            if crossings <= FEW {
                break;
            }
        }
        best.map(|(_, x)| x).unwrap_or_default()
    }

    /// How often each level passes through itself.
    fn crossings(&self, x: &[Vec3]) -> usize {
        let mut levels = self.level.clone();
        levels.sort_unstable();
        levels.dedup();
        let of_level = |level: i32| -> Vec<[u32; 3]> {
            self.triangles.iter().filter(|t| self.level[t[0] as usize] == level).copied().collect()
        };
        levels.into_iter().map(|level| crossings(x, &of_level(level))).sum()
    }

    /// The same in one way.
    fn inflated(&self, x: Vec<Vec3>, way: Way, axes: &Axes, body: &Collider) -> Vec<Vec3> {
        let mut motion = Motion::new(self, x, way.apart);
        for k in 0..INFLATE {
            let held = |from, to| if k < way.free { to } else { this_side(axes, from, to) };
            motion.step(1.0, |from, to| axes.outside(held(from, to), SMALLEST, GAP));
        }
        for k in 0..GROW {
            let share = (k + 1) as f64 / GROW as f64;
            let scale = SMALLEST + (1.0 - SMALLEST) * share;
            motion.step(1.0 - share, |from, to| axes.outside(this_side(axes, from, to), scale, GAP));
        }
        for _ in 0..SETTLE {
            motion.step(0.0, |_, p| out_of(body, p));
        }
        motion.x
    }
}

/// Where a point in the body, or nearer to it than [`GAP`], is led to.
fn out_of(body: &Collider, p: Vec3) -> Vec3 {
    match body.nearest(p, LOOK) {
        Some(near) if near.distance < GAP => p + near.normal * (GAP - near.distance),
        _ => p,
    }
}

impl<'a> Motion<'a> {
    fn new(balloon: &'a Balloon, x: Vec<Vec3>, apart: f64) -> Self {
        let mean = balloon.stretch.iter().map(|l| l.rest).sum::<f64>() / balloon.stretch.len().max(1) as f64;
        let mut area = vec![0.0; x.len()];
        let rest: HashMap<[u32; 2], f64> = balloon.stretch.iter().map(|l| (l.ends, l.rest)).collect();
        let side = |a: u32, b: u32| rest.get(&sorted_pair([a, b])).copied().unwrap_or(mean);
        for &[a, b, c] in &balloon.triangles {
            let [l, m, n] = [side(a, b), side(b, c), side(c, a)];
            let s = 0.5 * (l + m + n);
            let heron = (s * (s - l) * (s - m) * (s - n)).max(0.0).sqrt();
            [a, b, c].into_iter().for_each(|v| area[v as usize] += 2.0 * heron);
        }
        let near = neighbours(x.len(), &balloon.stretch);
        Self { balloon, velocity: vec![Vec3::zeros(); x.len()], x, area, near, apart: apart * mean }
    }

    /// One step under a share of the pressure, with the openings held, clear of a body that leads points `outside` it:
    /// those that come from the first and are drawn to the second.
    fn step(&mut self, pressure: f64, outside: impl Fn(Vec3, Vec3) -> Vec3) {
        let push = self.pushed();
        let moved = self.x.iter().zip(&self.velocity).zip(&push);
        let mut p: Vec<Vec3> = moved.map(|((x, v), n)| x + v + n * (PUSH * pressure)).collect();
        let layers = self.layers(&p);
        for _ in 0..SWEEPS {
            for length in &self.balloon.stretch {
                meet(&mut p, length, 2.0);
            }
            for length in &self.balloon.bending {
                meet(&mut p, length, 2.0 + BENDING);
            }
            for pair in &layers {
                keep_apart(&mut p, *pair, self.apart);
            }
        }
        for held in &self.balloon.held {
            if held.once_lost && held.goes_round(&p) {
                continue;
            }
            let middle = held.rim.iter().map(|n| p[*n as usize]).sum::<Vec3>() / held.rim.len() as f64;
            let way = held.middle - middle;
            let way = held.along.map_or(way, |along| way - along * way.dot(&along));
            let back = way * HOLD;
            held.rim.iter().for_each(|n| p[*n as usize] += back);
        }
        for ((x, v), p) in self.x.iter_mut().zip(&mut self.velocity).zip(p) {
            let way = short(outside(*x, p) - *x);
            *v = way * KEEP;
            *x += way;
        }
    }

    /// The direction in which pressure pushes every node; shorter where the cloth round it is crushed.
    fn pushed(&self) -> Vec<Vec3> {
        let mut out = vec![Vec3::zeros(); self.x.len()];
        for t in &self.balloon.triangles {
            let [a, b, c] = t.map(|n| self.x[n as usize]);
            let normal = (c - a).cross(&(b - a));
            t.iter().for_each(|n| out[*n as usize] += normal);
        }
        out.iter().zip(&self.area).map(|(n, area)| n / area.max(f64::MIN_POSITIVE)).collect()
    }

    /// Pairs of nodes of different layers that are near each other.
    fn layers(&self, p: &[Vec3]) -> Vec<[u32; 2]> {
        let reach = self.apart + LONGEST;
        let cell = |v: &Vec3| [0, 1, 2].map(|c| (v[c] / reach).floor() as i64);
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for (n, v) in p.iter().enumerate() {
            cells.entry(cell(v)).or_default().push(n as u32);
        }
        let mut out = Vec::new();
        for (n, v) in p.iter().enumerate() {
            let [i, j, k] = cell(v);
            let around =
                (-1..=1).flat_map(|a| (-1..=1).flat_map(move |b| (-1..=1).map(move |c| [i + a, j + b, k + c])));
            for m in around.filter_map(|key| cells.get(&key)).flatten() {
                let is_level = self.balloon.level[n] == self.balloon.level[*m as usize];
                let is_layer = *m > n as u32 && is_level && (p[*m as usize] - v).norm() < reach;
                if is_layer && self.near[n].binary_search(m).is_err() {
                    out.push([n as u32, *m]);
                }
            }
        }
        out
    }
}

/// Where a node that is drawn from one point to another goes: not to the other side of an axis, where it would be led
/// out.
fn this_side(axes: &Axes, from: Vec3, to: Vec3) -> Vec3 {
    if axes.lies_between(from, to) { from + short(to - from) } else { to }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_goes_round_the_place_that_it_is_round() {
        let ring = |x: f64| -> Vec<Vec3> {
            let angle = |k: u32| f64::from(k) * PI / 4.0;
            (0..8).map(|k| Vec3::new(x + 0.1 * angle(k).cos(), 0.01 * f64::from(k % 2), 0.1 * angle(k).sin())).collect()
        };
        let held = Held { rim: (0..8).collect(), middle: Vec3::zeros(), along: Some(Vec3::y()), once_lost: true };
        assert!(held.goes_round(&ring(0.0)));
        assert!(held.goes_round(&ring(0.09)));
        assert!(!held.goes_round(&ring(0.11)));
    }
}
