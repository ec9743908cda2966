//! Makes the strip between rim and core well shaped: turns springs, moves, removes and adds free particles.
//!
//! Only triangles that are not good are worked on, so the lattice stays regular wherever it can.

use super::patch::Patch;
use super::shape::{GAIN, POOR, quality, quality_of_degrees};
use crate::geometry::Vec2;

/// Smallest angle from which a triangle is left alone, degrees. Half a square cell has 45°, and more than a third of a
/// right angle suits every later stage.
const GOOD: f64 = 33.0;
/// Sweeps of adding and removing particles. Grading from a tiny rim spring to the lattice takes one sweep per doubling.
const MENDS: usize = 6;
/// Sweeps of turning springs and moving particles. Most pieces settle after three.
const SWEEPS: usize = 6;
/// First and last step by which a particle is moved, in spacings. Steps are halved in between.
const STEPS: [f64; 2] = [0.24, 0.01];
/// Steps from triangle to triangle when looking for the one that holds a new particle.
const WALK: usize = 12;

/// A patch with its constraints.
pub(super) struct Improver<'p> {
    /// The mesh under repair.
    pub(super) patch: &'p mut Patch,
    /// Vertices below this number lie on the rim.
    pub(super) rim: u32,
    /// Target spacing, metres.
    pub(super) spacing: f64,
}

impl Improver<'_> {
    /// Turns springs and moves free particles until the triangles are good or nothing helps.
    pub(super) fn relax(&mut self) {
        for _ in 0..SWEEPS {
            let mut changed = false;
            for t in self.worse_than(GOOD) {
                if self.patch.is_alive(t) {
                    changed |= self.turn_best(t);
                    for v in self.patch.corners(t) {
                        changed |= self.settle(v);
                    }
                }
            }
            if !changed {
                break;
            }
        }
    }

    /// Removes or adds free particles where triangles are still poor.
    pub(super) fn mend(&mut self) {
        let poor = |p: &Patch, t: u32| p.is_alive(t) && p.quality(t) < quality_of_degrees(POOR);
        for _ in 0..MENDS {
            let mut changed = false;
            for t in self.worse_than(POOR) {
                changed |= poor(self.patch, t) && (self.try_removals(t) || self.try_additions(t));
            }
            if !changed {
                break;
            }
        }
    }

    /// Living triangles with an angle below this many degrees, in order.
    fn worse_than(&self, degrees: f64) -> Vec<u32> {
        let limit = quality_of_degrees(degrees);
        self.patch.alive().filter(|&t| self.patch.quality(t) < limit).collect()
    }

    /// Turns the side of `t` that gains most, if any does.
    fn turn_best(&mut self, t: u32) -> bool {
        let best = (0..3).filter_map(|k| self.turned(t, k)).max_by(|a, b| a.gain.total_cmp(&b.gain));
        let Some(turn) = best.filter(|turn| turn.gain > GAIN) else { return false };
        self.patch.replace(&[t, turn.other], &turn.new);
        true
    }

    /// Turning side `k` of `t`, unless it must stay or the new spring would join two rim particles.
    pub(super) fn turned(&self, t: u32, k: usize) -> Option<SpringTurn> {
        let other = self.patch.partner(t, k)?;
        let v = self.patch.corners(t);
        let (a, b, c) = (v[k], v[(k + 1) % 3], v[(k + 2) % 3]);
        let d = self.patch.third(other, b, c);
        if a < self.rim && d < self.rim {
            return None;
        }
        let new = [[a, b, d], [a, d, c]];
        let after = new.iter().map(|tri| self.quality_of(tri)).fold(1.0, f64::min);
        let before = self.patch.quality(t).min(self.patch.quality(other));
        (after > 0.0).then(|| SpringTurn { other, new, after, gain: after / before.max(1e-12) })
    }

    fn quality_of(&self, tri: &[u32; 3]) -> f64 {
        let [a, b, c] = tri.map(|v| self.patch.point(v));
        quality(a, b, c)
    }

    /// Moves a free particle to where the worst triangle round it is best, or good enough.
    pub(super) fn settle(&mut self, v: u32) -> bool {
        if !self.patch.is_free(v) {
            return false;
        }
        let star = self.patch.star(v);
        let start = self.patch.point(v);
        let (good, mut at) = (quality_of_degrees(GOOD), start);
        let mut best = self.patch.quality_at(&star, v, at);
        let mut step = STEPS[0] * self.spacing;
        while best < good && step > STEPS[1] * self.spacing {
            let tries = COMPASS.map(|[x, y]| at + step * Vec2::new(x, y));
            let scored = tries.map(|p| (self.patch.quality_at(&star, v, p), p));
            let top = scored.iter().fold(scored[0], |m, s| if s.0 > m.0 { *s } else { m });
            if top.0 > best * 1.001 + 1e-9 {
                (best, at) = top;
            } else {
                step *= 0.5;
            }
        }
        if at == start {
            return false;
        }
        self.patch.move_to(v, at);
        true
    }

    /// Lets the free particles round `v`, and `v` itself, settle and their springs turn.
    fn settle_round(&mut self, v: u32) {
        for _ in 0..3 {
            for t in self.patch.star(v) {
                if self.patch.is_alive(t) {
                    self.turn_best(t);
                }
            }
            self.settle(v);
            for w in self.ring(v) {
                self.settle(w);
            }
        }
    }

    /// Tries to draw a free corner of `t` into one of its neighbours.
    fn try_removals(&mut self, t: u32) -> bool {
        for v in self.patch.corners(t) {
            if !self.patch.is_free(v) {
                continue;
            }
            let star = self.patch.star(v);
            let ring = self.ring(v);
            if ring.into_iter().any(|u| !self.joins_rim(&star, v, u) && self.try_drawing(v, u, &star)) {
                return true;
            }
        }
        false
    }

    /// Removes `v` by drawing it into its neighbour `u`, if that makes the triangles better.
    fn try_drawing(&mut self, v: u32, u: u32, star: &[u32]) -> bool {
        let rest = star.iter().map(|&t| self.patch.corners(t)).filter(|tri| !tri.contains(&u));
        let new: Vec<[u32; 3]> = rest.map(|tri| tri.map(|x| if x == v { u } else { x })).collect();
        // A neighbour round which the cloth would fold over cannot take the place.
        if new.iter().any(|tri| self.quality_of(tri) <= 0.0) {
            return false;
        }
        self.patch.begin();
        self.patch.replace(star, &new);
        self.settle_round(u);
        self.patch.end(|before, after| after.improves(before))
    }

    /// Neighbours of `v`, rising.
    fn ring(&self, v: u32) -> Vec<u32> {
        let corners = self.patch.star(v).into_iter().flat_map(|t| self.patch.corners(t));
        let mut ring: Vec<u32> = corners.filter(|&w| w != v).collect();
        ring.sort_unstable();
        ring.dedup();
        ring
    }

    /// Whether drawing `v` into rim particle `u` would join `u` to a rim particle it is not joined to yet.
    fn joins_rim(&self, star: &[u32], v: u32, u: u32) -> bool {
        let beside: Vec<u32> =
            star.iter().map(|&t| self.patch.corners(t)).filter(|tri| tri.contains(&u)).flatten().collect();
        let mut others = star.iter().flat_map(|&t| self.patch.corners(t)).filter(|&w| w != v && w != u);
        u < self.rim && others.any(|w| w < self.rim && !beside.contains(&w))
    }

    /// Tries to add a particle in or near `t`.
    fn try_additions(&mut self, t: u32) -> bool {
        let tri = self.patch.corners(t);
        let [a, b, c] = tri.map(|v| self.patch.point(v));
        let centre = (a + b + c) / 3.0;
        let mut tries = vec![(t, centre)];
        if let Some(p) = circumcentre(a, b, c)
            && let Some(holder) = self.holder(t, p)
        {
            tries.insert(0, (holder, p));
        }
        for (holder, p) in tries {
            self.patch.begin();
            let v = self.insert(holder, p);
            self.settle_round(v);
            if self.patch.end(|before, after| after.improves(before)) {
                return true;
            }
        }
        for k in 0..3 {
            if let Some(other) = self.patch.partner(t, k) {
                self.patch.begin();
                let v = self.split(t, other, k);
                self.settle_round(v);
                if self.patch.end(|before, after| after.improves(before)) {
                    return true;
                }
            }
        }
        false
    }

    /// Adds a particle inside triangle `t`.
    fn insert(&mut self, t: u32, p: Vec2) -> u32 {
        let [a, b, c] = self.patch.corners(t);
        let v = self.patch.add(p);
        self.patch.replace(&[t], &[[a, b, v], [b, c, v], [c, a, v]]);
        v
    }

    /// Adds a particle in the middle of side `k` of `t`, which it shares with `other`.
    pub(super) fn split(&mut self, t: u32, other: u32, k: usize) -> u32 {
        let v = self.patch.corners(t);
        let (a, b, c) = (v[k], v[(k + 1) % 3], v[(k + 2) % 3]);
        let d = self.patch.third(other, b, c);
        let m = self.patch.add(0.5 * (self.patch.point(b) + self.patch.point(c)));
        self.patch.replace(&[t, other], &[[a, b, m], [a, m, c], [d, c, m], [d, m, b]]);
        m
    }

    /// The triangle that holds `p`, walking from `t` without crossing a rim or a line.
    fn holder(&self, mut t: u32, p: Vec2) -> Option<u32> {
        for _ in 0..WALK {
            let v = self.patch.corners(t);
            let outside = (0..3).find(|&k| {
                let (b, c) = (self.patch.point(v[(k + 1) % 3]), self.patch.point(v[(k + 2) % 3]));
                (c - b).perp(&(p - b)) <= 0.0
            });
            match outside {
                None => return Some(t),
                Some(k) => t = self.patch.partner(t, k)?,
            }
        }
        None
    }
}

/// Eight unit directions.
const COMPASS: [[f64; 2]; 8] = {
    const D: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [[1.0, 0.0], [D, D], [0.0, 1.0], [-D, D], [-1.0, 0.0], [-D, -D], [0.0, -1.0], [D, -D]]
};

/// A spring turned within its two triangles.
pub(super) struct SpringTurn {
    /// The triangle across the spring.
    pub(super) other: u32,
    /// The two triangles that replace the old ones.
    pub(super) new: [[u32; 3]; 2],
    /// Worst quality of the two, afterwards.
    pub(super) after: f64,
    /// ... and by which factor it grows.
    gain: f64,
}

fn circumcentre(a: Vec2, b: Vec2, c: Vec2) -> Option<Vec2> {
    let (d, e) = (b - a, c - a);
    let det = 2.0 * d.perp(&e);
    let centre =
        Vec2::new(e.y * d.norm_squared() - d.y * e.norm_squared(), d.x * e.norm_squared() - e.x * d.norm_squared());
    (det > 0.0).then(|| a + centre / det)
}
