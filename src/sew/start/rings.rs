//! Where each opening's ring lies round the body's axes: on which axis, how far along it, and turned which way.

use std::f64::consts::TAU;

use super::axes::{Axes, Axis, Station};
use super::ends::Ends;
use super::harmonic::Ring;
use super::openings::Opening;
use super::profile::{Profile, best_height};
use super::winding::{Jumps, jumps};
use crate::geometry::{Vec2, Vec3};
use crate::mannequin::PartKind;

/// A neck's ring lies so far above the base of the neck, metres.
const ABOVE_NECK: f64 = 0.02;
/// A hem lies no lower than this over the floor, metres.
const LOWEST: f64 = 0.06;
/// A limb's ring lies at least so far along its axis, metres, and at most so far beyond its end.
const FIRST: f64 = 0.02;
const BEYOND: f64 = 0.08;
/// From between the legs a garment goes as far as this share of the trunk's half depth to the front before it rises.
const TO_FRONT: f64 = 1.0;
/// Cloth that widens from one ring to the next hangs down by at least this share of its length.
const STEEPEST: f64 = 0.3;

/// The openings of one connected garment, and what is known of them.
pub(super) struct Worn<'a> {
    /// Flat positions of all particles, metres.
    pub(super) flat: &'a [Vec2],
    /// The openings.
    pub(super) openings: Vec<&'a Opening>,
    /// The ends of the body that pass through each.
    pub(super) ends: Vec<Ends>,
    /// For each opening the distance of every node from it on the cloth, metres.
    pub(super) far: Vec<Vec<f64>>,
    /// For each opening the node of its rim at the middle of the front, where that is known.
    pub(super) front: Vec<Option<u32>>,
    /// For each opening the girth of the cloth at distances from it.
    pub(super) profiles: Vec<Profile>,
}

/// Where a ring is.
#[derive(Clone, Copy, Debug)]
struct Seat {
    station: Station,
    /// Of a ring round an arm or a leg: how far along its axis, metres.
    along: Option<f64>,
}

/// What a ring is turned by: the nodes of large values lie towards a direction.
struct Turn {
    towards: Vec3,
    values: Vec<f64>,
}

impl Worn<'_> {
    /// A ring for every opening that something passes through.
    pub(super) fn rings(&self, axes: &Axes) -> Vec<Option<Ring>> {
        let Some(torso) = axes.part(PartKind::Torso) else { return vec![None; self.openings.len()] };
        let top = self.top();
        let seat_of_top = top.map(|k| self.seat(k, axes, torso, None));
        let seat = |k: usize| {
            let is_top = top == Some(k);
            seat_of_top.filter(|_| is_top).unwrap_or_else(|| self.seat(k, axes, torso, top.zip(seat_of_top)))
        };
        (0..self.openings.len()).map(|k| (!self.ends[k].is_empty()).then(|| self.ring(k, seat(k)))).collect()
    }

    /// The opening that the garment hangs from: the one that the head passes through, and not the legs.
    fn top(&self) -> Option<usize> {
        let is_top = |ends: &Ends| ends.has(Ends::HEAD) && !ends.touches(Ends::LEGS);
        self.ends.iter().position(is_top)
    }

    /// The opening that exactly these ends pass through.
    pub(super) fn find(&self, ends: Ends) -> Option<usize> {
        self.ends.iter().position(|other| *other == ends)
    }

    /// Where an angle round opening `k` jumps: up to an opening that something else passes through.
    pub(super) fn jumps(&self, k: usize, triangles: &[[u32; 3]]) -> Option<Jumps> {
        let is_other = |j: &usize| *j != k && !self.ends[*j].is_empty();
        let others = (0..self.openings.len()).filter(is_other).flat_map(|j| self.openings[j].rim.iter().copied());
        jumps(triangles, &self.openings[k].rim, &others.collect::<Vec<_>>())
    }

    /// Where opening `k` lies, below the `top` and its seat.
    fn seat(&self, k: usize, axes: &Axes, torso: &Axis, top: Option<(usize, Seat)>) -> Seat {
        let ends = self.ends[k];
        if let Some(axis) = limb_of(ends).and_then(|kind| axes.part(kind)) {
            let s = self.along_limb(k, axis, torso, top).clamp(FIRST, axis.length() + BEYOND);
            return Seat { station: axis.station(s), along: Some(s) };
        }
        let neck = torso.station(torso.length());
        if ends.touches(Ends::LEGS) {
            return Seat { station: self.below(k, torso, top), along: None };
        }
        if ends.has(Ends::TOP) {
            if let Some(y) = self.above_crotch(k, axes, torso) {
                let s = torso.nearest(Vec3::new(0.0, y, torso.station(0.0).center.z));
                return Seat { station: Station { axis: Vec3::y(), ..torso.station(s) }, along: None };
            }
            let arms = axes.part(PartKind::LeftArm).map(|arm| torso.nearest(arm.station(0.0).center));
            let s = best_height(&self.profiles[k], torso, arms.unwrap_or_else(|| torso.length()));
            return Seat { station: Station { axis: Vec3::y(), ..torso.station(s) }, along: None };
        }
        // Round the neck, a shoulder with it, or both arms without the head.
        let mut center = neck.center + Vec3::y() * ABOVE_NECK;
        let mut axis = Vec3::y();
        for arm in [Ends::LEFT_ARM, Ends::RIGHT_ARM].into_iter().filter(|arm| ends.has(*arm)) {
            if let Some(arm) = limb_of(arm).and_then(|kind| axes.part(kind)) {
                let joint = arm.station(FIRST);
                center = 0.5 * (center + joint.center);
                axis += joint.axis;
            }
        }
        Seat { station: Station { center, axis: axis.normalize() }, along: None }
    }

    /// The height of a waist's opening whose cloth has a crotch: as far above the body's as on the cloth, but for the
    /// way from between the legs to the front.
    fn above_crotch(&self, k: usize, axes: &Axes, torso: &Axis) -> Option<f64> {
        let [left, right] = [Ends::LEFT_LEG, Ends::RIGHT_LEG].map(|leg| self.find(leg).map(|o| &self.far[o]));
        let (left, right) = (left?, right?);
        let later = |n: &usize| left[*n].max(right[*n]);
        let fork = (0..left.len()).filter(|n| later(n).is_finite()).min_by(|a, b| later(a).total_cmp(&later(b)))?;
        let crotch = torso.station(0.0).center.y;
        let rise = self.far[k][fork] - TO_FRONT * torso.half_depth_after(0.0);
        let highest = axes.part(PartKind::LeftArm).map_or(torso.length(), |arm| arm.station(0.0).center.y - crotch);
        Some(crotch + rise.clamp(0.0, highest))
    }

    /// How far along a limb an opening lies, metres.
    fn along_limb(&self, k: usize, axis: &Axis, torso: &Axis, top: Option<(usize, Seat)>) -> f64 {
        let Some((top, seat)) = top else { return 0.5 * axis.length() };
        let far = &self.far[top];
        let from = axis.station(0.0).center;
        if axis.kind.is_arm() {
            let nearest = self.openings[k].rim.iter().map(|n| far[*n as usize]).fold(f64::INFINITY, f64::min);
            let neck = torso.station(torso.length()).center;
            let radius = self.openings[top].length / TAU;
            return nearest - ((from - neck).norm() - radius.min(0.5 * (from - neck).norm())).max(0.0);
        }
        self.median(k, top) - (seat.station.center.y - from.y)
    }

    /// The median distance of an opening's rim from another one on the cloth, metres.
    fn median(&self, k: usize, from: usize) -> f64 {
        let mut far: Vec<f64> = self.openings[k].rim.iter().map(|n| self.far[from][*n as usize]).collect();
        far.sort_unstable_by(f64::total_cmp);
        far.get(far.len() / 2).copied().unwrap_or(0.0)
    }

    /// Round trunk and legs, as far down as the cloth reaches from the `top`.
    fn below(&self, k: usize, torso: &Axis, top: Option<(usize, Seat)>) -> Station {
        let crotch = torso.station(0.0).center;
        let y = top.map_or(crotch.y, |(top, seat)| {
            let length = self.median(k, top);
            let wider = (self.openings[k].length - self.openings[top].length) / TAU;
            let drop = (length * length - wider * wider).max(0.0).sqrt().max(STEEPEST * length);
            (seat.station.center.y - drop).max(LOWEST)
        });
        let on_trunk = torso.station(torso.nearest(Vec3::new(crotch.x, y, crotch.z))).center;
        Station { center: Vec3::new(on_trunk.x, y, on_trunk.z), axis: -Vec3::y() }
    }

    /// The ring of opening `k` in its seat, its nodes as far apart as on the rim.
    fn ring(&self, k: usize, Seat { station: Station { center, axis }, along }: Seat) -> Ring {
        let opening = self.openings[k];
        let radius = opening.length / TAU;
        let ahead = if axis.z.abs() < 0.9 { Vec3::z() } else { Vec3::y() };
        let front = (ahead - axis * ahead.dot(&axis)).normalize();
        let side = axis.cross(&front);
        // Rims run as their triangles do, which are clockwise seen from outside: right-handed about the way out.
        let phases = self.phases(opening);
        let turn = self.turn(k).map_or(0.0, |turn| {
            let mean = turn.values.iter().sum::<f64>() / turn.values.len() as f64;
            let sums = turn.values.iter().zip(&phases).fold((0.0, 0.0), |(sine, cosine), (value, phase)| {
                (sine + (value - mean) * phase.sin(), cosine + (value - mean) * phase.cos())
            });
            turn.towards.dot(&side).atan2(turn.towards.dot(&front)) - sums.0.atan2(sums.1)
        });
        let angles = phases.iter().map(|phase| phase + turn).collect();
        Ring { rim: opening.rim.clone(), angles, frame: [front, side], center, radius, along }
    }

    /// How far round an opening each node of its rim is, radians, as on the rim.
    fn phases(&self, opening: &Opening) -> Vec<f64> {
        let mut at = 0.0;
        let mut phases = Vec::with_capacity(opening.rim.len());
        for [a, b] in &opening.sides {
            phases.push(at);
            at += TAU * (self.flat[*b as usize] - self.flat[*a as usize]).norm() / opening.length;
        }
        phases
    }

    /// Which nodes of an opening lie towards which direction; `None` where nothing says.
    fn turn(&self, k: usize) -> Option<Turn> {
        let ends = self.ends[k];
        match limb_of(ends) {
            Some(kind) if kind.is_arm() => {
                let neck = &self.far[self.top()?];
                Some(Turn { towards: Vec3::y(), values: self.of_rim(k, |n| -neck[n]) })
            }
            Some(_) => {
                let other = &self.far[self.find(ends.mirrored())?];
                let inward = if ends == Ends::LEFT_LEG { -Vec3::x() } else { Vec3::x() };
                Some(Turn { towards: inward, values: self.of_rim(k, |n| -other[n]) })
            }
            None => self.turn_of_trunk(k),
        }
    }

    /// The turn of a ring round trunk or neck: by what is front, or by the limbs on either side.
    fn turn_of_trunk(&self, k: usize) -> Option<Turn> {
        if let Some(front) = self.front[k] {
            return Some(Turn { towards: Vec3::z(), values: self.of_rim(k, |n| f64::from(n as u32 == front)) });
        }
        let limbs = [Ends::LEFT_ARM, Ends::LEFT_LEG].into_iter().find_map(|left| {
            let right = self.find(left.mirrored());
            self.find(left).zip(right)
        });
        let (left, right) = limbs?;
        Some(Turn { towards: Vec3::x(), values: self.of_rim(k, |n| self.far[right][n] - self.far[left][n]) })
    }

    fn of_rim(&self, k: usize, value: impl Fn(usize) -> f64) -> Vec<f64> {
        self.openings[k].rim.iter().map(|n| value(*n as usize)).collect()
    }
}

/// The arm or leg that alone passes through an opening.
pub(super) fn limb_of(ends: Ends) -> Option<PartKind> {
    match ends {
        Ends::LEFT_ARM => Some(PartKind::LeftArm),
        Ends::RIGHT_ARM => Some(PartKind::RightArm),
        Ends::LEFT_LEG => Some(PartKind::LeftLeg),
        Ends::RIGHT_LEG => Some(PartKind::RightLeg),
        _ => None,
    }
}
