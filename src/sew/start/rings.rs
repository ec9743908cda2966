//! Where each opening's ring lies round the body's axes: on which axis, how far along it, and turned which way.

use std::f64::consts::TAU;

use super::axes::{Axes, Axis, AxisPlace};
use super::balloon::Held;
use super::ends::Ends;
use super::harmonic::OpeningRing;
use super::openings::GluedOpening;
use super::profile::{Profile, best_height};
use super::winding::{Jumps, jumps};
use crate::geometry::{Vec2, Vec3};
use crate::mannequin::PartKind;
use crate::pattern::{PlaceWord, TrunkLevel};

/// A neck's ring lies so far above the base of the neck, metres.
pub(super) const ABOVE_NECK: f64 = 0.02;
/// A hem lies no lower than this over the floor, metres.
const LOWEST: f64 = 0.06;
/// A limb's ring lies at least so far along its axis, metres, and at most so far beyond its end.
pub(super) const FIRST: f64 = 0.02;
const BEYOND: f64 = 0.08;
/// A sleeve's ring lies nearer than its sleeve reaches by this share of the way from the neck. Cloth that is drawn taut
/// goes straight and below the shoulder, which then grows through it: of two shirts 233 and 518 triangles started
/// through the body, and 52 and none with this slack.
const SLACK: f64 = 0.04;
/// The top of a garment that is placed by the waist lies no further from the waist than this, metres, and that of one
/// that is placed by the trunk at least so far above it.
const AT_WAIST: f64 = 0.05;
/// From between the legs a garment goes as far as this share of the trunk's half depth to the front before it rises.
const TO_FRONT: f64 = 1.0;
/// Cloth that widens from one ring to the next hangs down by at least this share of its length.
const STEEPEST: f64 = 0.3;

/// A leg's ring reaches so much of the way to the middle between the legs.
const BESIDE: f64 = 0.9;
/// Share of a rim that lies nearer than its shoulders.
const NEARLY_ALL: f64 = 0.9;
/// The ring of a neck lies below its shoulders by this share of what its rim does on the average. It is flat: lowered
/// by all of that, it drew the straps of a slip dress down beside the shoulders.
const LOWERED: f64 = 0.5;
/// Distances along the edges of a start mesh are alike if they differ by no more than this, metres: an edge.
const ALIKE: f64 = 0.025;
/// The opening that both arms pass through, of a halter, lies in front of the shoulders and behind the neck and the
/// back by this, metres.
const SADDLE: f64 = 0.1;

/// The openings of one connected garment, and what is known of them.
pub(super) struct WornOpenings<'a> {
    /// Flat positions of all particles, metres.
    pub(super) flat: &'a [Vec2],
    /// The openings.
    pub(super) openings: Vec<&'a GluedOpening>,
    /// The ends of the body that pass through each.
    pub(super) ends: Vec<Ends>,
    /// For each opening the distance of every node from it on the cloth, metres.
    pub(super) far: Vec<Vec<f64>>,
    /// For each opening the node of its rim at the middle of the front, where that is known.
    pub(super) front: Vec<Option<u32>>,
    /// For the opening of a hood or a collar how far every node of its rim is from the seam that joins it to the
    /// rest, metres.
    pub(super) above: Vec<Option<Vec<f64>>>,
    /// The words that say where its pieces go.
    pub(super) words: Vec<&'static str>,
    /// For each opening the heights on the trunk where the pieces on its rim go.
    pub(super) levels: Vec<Vec<TrunkLevel>>,
    /// For each opening the girth of the cloth at distances from it.
    pub(super) profiles: Vec<Profile>,
}

/// The rim of an opening for the head that lies on the shoulders.
#[derive(Clone, Debug)]
pub(super) struct Neckline {
    /// Its nodes.
    pub(super) rim: Vec<u32>,
    /// Those of them that lie on the shoulders.
    pub(super) shoulders: [u32; 2],
}

/// Where a ring is.
#[derive(Clone, Copy, Debug)]
struct Seat {
    station: AxisPlace,
    /// Of a ring round an arm or a leg: how far along its axis, metres.
    along: Option<f64>,
}

/// The turn of a ring: the nodes of large values lie towards a direction.
struct Turn {
    towards: Vec3,
    values: Vec<f64>,
}

impl WornOpenings<'_> {
    /// A ring for every opening that something passes through.
    pub(super) fn rings(&self, axes: &Axes) -> Vec<Option<OpeningRing>> {
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
        let is_top =
            |ends: &Ends| ends.has(Ends::HEAD) && !ends.touches(Ends::LEGS) && limb_of(ends.others()).is_none();
        self.ends.iter().position(is_top)
    }

    /// Whether cloth lies over the shoulders, or over one: between the opening of the head and those of the arms, of
    /// which one may be in the head's.
    pub(super) fn hangs(&self) -> bool {
        let Some(top) = self.top() else { return false };
        let arms = [Ends::LEFT_ARM, Ends::RIGHT_ARM];
        let has = |arm: &&Ends| self.find(**arm).is_some();
        let over = arms.iter().filter(has).count();
        over > 0 && arms.iter().all(|arm| has(&arm) || self.ends[top].has(*arm))
    }

    /// The opening of a head that lies on the shoulders: no hood, no collar.
    pub(super) fn neckline(&self) -> Option<Neckline> {
        let top = self.top().filter(|top| self.above[*top].is_none())?;
        let rim = &self.openings[top].rim;
        let legs = || self.ends.iter().zip(&self.far).filter(|(ends, _)| ends.touches(Ends::LEGS));
        let up = |n: u32| legs().map(|(_, far)| far[n as usize]).fold(f64::INFINITY, f64::min);
        // A strap is as near to its arm all along: its shoulder is where it is furthest from the legs.
        let shoulder = |arm: Ends| {
            let far = &self.far[self.find(arm)?];
            let nearest = rim.iter().map(|n| far[*n as usize]).fold(f64::INFINITY, f64::min);
            let alike = rim.iter().copied().filter(|n| far[*n as usize] <= nearest + ALIKE);
            alike.max_by(|a, b| up(*a).total_cmp(&up(*b)))
        };
        Some(Neckline { shoulders: [shoulder(Ends::LEFT_ARM)?, shoulder(Ends::RIGHT_ARM)?], rim: rim.clone() })
    }

    /// How the opening that these ends pass through is held: by its middle, in that of its `ring`; where the garment
    /// hangs from the shoulders, its neckline by these. The middle of a steep neckline lies far below them, and held by
    /// it a dress with straps was drawn down beside the shoulders.
    pub(super) fn held(&self, ends: Ends, ring: &OpeningRing) -> Held {
        let top = self.top().filter(|top| self.hangs() && self.ends[*top] == ends);
        let rim = ring.rim.clone();
        match top.zip(self.neckline()) {
            Some((top, Neckline { shoulders, .. })) => {
                let middle = ring.center + Vec3::y() * self.below_shoulders(top);
                Held { rim, by: shoulders.to_vec(), middle, limb: None, along: None }
            }
            None => {
                let limb = limb_of(ends).zip(ring.along);
                Held { by: rim.clone(), rim, middle: ring.center, limb, along: None }
            }
        }
    }

    /// Whether an arm is in a sleeve, as its `rings` say: further out than where it begins.
    pub(super) fn has_sleeves(&self, rings: &[Option<OpeningRing>]) -> bool {
        let is_arm = |ends: Ends| limb_of(ends).is_some_and(PartKind::is_arm);
        let is_sleeve = |(ends, ring): (&Ends, &Option<OpeningRing>)| {
            let along = ring.as_ref().and_then(|ring| ring.along);
            is_arm(ends.others()) || is_arm(*ends) && along > Some(FIRST)
        };
        self.ends.iter().zip(rings).any(is_sleeve)
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
            let s = match self.find(ends.others()) {
                Some(inner) => self.on_limb(inner, axis) + self.median(k, inner),
                None => self.along_limb(k, axis, torso, top),
            };
            let s = s.clamp(FIRST, axis.length() + BEYOND);
            return Seat { station: axis.station(s), along: Some(s) };
        }
        if let Some(axis) = limb_of(ends.others()).and_then(|kind| axes.part(kind)) {
            let AxisPlace { center, axis } = axis.station(self.on_limb(k, axis));
            return Seat { station: AxisPlace { center, axis: -axis }, along: None };
        }
        let neck = torso.station(torso.length());
        if ends.touches(Ends::LEGS) {
            return Seat { station: self.below(k, torso, top), along: None };
        }
        if ends == Ends::ARMS {
            let joints = [PartKind::LeftArm, PartKind::RightArm].map(|arm| axes.part(arm).map(|arm| arm.station(0.0)));
            let middle = joints.iter().flatten().map(|joint| joint.center).sum::<Vec3>() / 2.0;
            return Seat { station: AxisPlace { center: middle, axis: -Vec3::z() }, along: None };
        }
        if ends.has(Ends::TOP) {
            let waist = torso.landmark(PlaceWord::Waist.name());
            if let Some(y) = self.above_crotch(k, axes, torso) {
                // What is placed by the waist may have a crotch that hangs low.
                let at_waist = waist.filter(|_| self.levels[k].contains(&TrunkLevel::Waist));
                let y = at_waist.map_or(y, |waist| y.min(torso.station(waist + AT_WAIST).center.y));
                let s = torso.nearest(Vec3::new(0.0, y, torso.station(0.0).center.z));
                return Seat { station: AxisPlace { axis: Vec3::y(), ..torso.station(s) }, along: None };
            }
            let arms = axes.part(PartKind::LeftArm).map(|arm| torso.nearest(arm.station(0.0).center));
            let highest = arms.unwrap_or_else(|| torso.length());
            let range = match waist {
                Some(waist) if self.levels[k].contains(&TrunkLevel::Waist) => [waist - AT_WAIST, waist + AT_WAIST],
                Some(waist) if self.levels[k].contains(&TrunkLevel::Chest) => [waist + AT_WAIST, highest],
                _ => [0.0, highest],
            };
            let s = best_height(&self.profiles[k], torso, range.map(|s| s.clamp(0.0, highest)));
            return Seat { station: AxisPlace { axis: Vec3::y(), ..torso.station(s) }, along: None };
        }
        if let Some(station) = self.over_neck(k, neck) {
            return Seat { station, along: None };
        }
        // Round the neck, and a shoulder with it.
        let mut center = neck.center + Vec3::y() * (ABOVE_NECK - self.below_shoulders(k));
        let mut axis = Vec3::y();
        for arm in [Ends::LEFT_ARM, Ends::RIGHT_ARM].into_iter().filter(|arm| ends.has(*arm)) {
            if let Some(arm) = limb_of(arm).and_then(|kind| axes.part(kind)) {
                let joint = arm.station(FIRST);
                // It goes round below the arm.
                let below = joint.center - Vec3::y() * (arm.girth(FIRST) / TAU);
                center = 0.5 * (center + below);
                axis += joint.axis;
            }
        }
        Seat { station: AxisPlace { center, axis: axis.normalize() }, along: None }
    }

    /// The opening of a hood or a collar, over the seam that joins it to the rest: as high above the neck's base as
    /// on the cloth. A hood stands up as a tube: without a head, or before it is drawn over one.
    fn over_neck(&self, k: usize, neck: AxisPlace) -> Option<AxisPlace> {
        let above = self.above[k].as_ref()?;
        let mean = above.iter().sum::<f64>() / above.len() as f64;
        Some(AxisPlace { center: neck.center + Vec3::y() * mean.max(ABOVE_NECK), axis: Vec3::y() })
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

    /// How far along a limb the opening of a tube round it lies that is nearer to the trunk, metres: where the tube
    /// fits, over the place that a word names.
    fn on_limb(&self, k: usize, axis: &Axis) -> f64 {
        let length = self.find(self.ends[k].others()).map_or(0.0, |outer| self.median(outer, k));
        let lowest = (axis.length() - length).max(FIRST);
        let named = self.words.iter().find_map(|word| axis.landmark(word));
        let range = named.map_or([FIRST, lowest], |at| [at - length, at].map(|s| s.clamp(FIRST, lowest)));
        best_height(&self.profiles[k], axis, range)
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
            let to_arm = ((from - neck).norm() - radius.min(0.5 * (from - neck).norm())).max(0.0);
            return nearest * (1.0 - SLACK) - to_arm;
        }
        let (highest, length) = self.hung(k, torso, top, seat);
        length - (highest - from.y)
    }

    /// The height that an opening hangs from, and how far below it is on the cloth, metres: from the shoulders, or
    /// from the `top` and its seat.
    fn hung(&self, k: usize, torso: &Axis, top: usize, seat: Seat) -> (f64, f64) {
        let from_shoulders = self.neckline().map(|neckline| {
            let length = neckline.shoulders.map(|n| self.far[k][n as usize]).into_iter().fold(f64::INFINITY, f64::min);
            (torso.station(torso.length()).center.y, length)
        });
        from_shoulders
            .or_else(|| self.below_nape(k, torso, top))
            .unwrap_or_else(|| (seat.station.center.y, self.median(k, top)))
    }

    /// The same of a halter, from the nape: its strap goes a quarter of the way round the neck before it goes down.
    fn below_nape(&self, k: usize, torso: &Axis, top: usize) -> Option<(f64, f64)> {
        self.find(Ends::ARMS)?;
        let nape = self.openings[top].rim.iter().map(|n| self.far[k][*n as usize]).fold(0.0, f64::max);
        let neck = torso.length();
        Some((torso.station(neck).center.y, (nape - 0.25 * torso.girth(neck)).max(0.0)))
    }

    /// How far an opening lies on the cloth from the rim of another one, metres: from its middle, and from its
    /// shoulders, which are furthest.
    fn rim_from(&self, k: usize, other: usize) -> [f64; 2] {
        let mut far: Vec<f64> = self.openings[other].rim.iter().map(|n| self.far[k][*n as usize]).collect();
        far.sort_unstable_by(f64::total_cmp);
        let mean = far.iter().sum::<f64>() / far.len().max(1) as f64;
        [mean, far.get((far.len() as f64 * NEARLY_ALL) as usize).copied().unwrap_or(mean)]
    }

    /// How far the ring of a neck's opening lies below its shoulders, metres: the share [`LOWERED`] of how much nearer
    /// its middle is to the hem.
    fn below_shoulders(&self, k: usize) -> f64 {
        let is_hung = [Ends::LEFT_ARM, Ends::RIGHT_ARM, Ends::ARMS].into_iter().any(|arm| self.find(arm).is_some());
        let hem = self.ends.iter().position(|ends| ends.touches(Ends::LEGS)).filter(|_| is_hung);
        hem.map_or(0.0, |hem| {
            let [mean, shoulders] = self.rim_from(hem, k);
            LOWERED * (shoulders - mean).max(0.0)
        })
    }

    /// The median distance of an opening's rim from another one on the cloth, metres.
    fn median(&self, k: usize, from: usize) -> f64 {
        let mut far: Vec<f64> = self.openings[k].rim.iter().map(|n| self.far[from][*n as usize]).collect();
        far.sort_unstable_by(f64::total_cmp);
        far.get(far.len() / 2).copied().unwrap_or(0.0)
    }

    /// Round trunk and legs, as far down as the cloth reaches from the `top`.
    fn below(&self, k: usize, torso: &Axis, top: Option<(usize, Seat)>) -> AxisPlace {
        let crotch = torso.station(0.0).center;
        let y = top.map_or(crotch.y, |(top, seat)| {
            let (highest, length) = self.hung(k, torso, top, seat);
            let wider = (self.openings[k].length - self.openings[top].length) / TAU;
            let drop = (length * length - wider * wider).max(0.0).sqrt().max(STEEPEST * length);
            (highest - drop).max(LOWEST)
        });
        let on_trunk = torso.station(torso.nearest(Vec3::new(crotch.x, y, crotch.z))).center;
        AxisPlace { center: Vec3::new(on_trunk.x, y, on_trunk.z), axis: -Vec3::y() }
    }

    /// The ring of opening `k` in its seat, its nodes as far apart as on the rim.
    fn ring(&self, k: usize, Seat { station: AxisPlace { center, axis }, along }: Seat) -> OpeningRing {
        let opening = self.openings[k];
        // The rings of two wide legs stay beside one another.
        let most =
            if self.ends[k].touches(Ends::LEGS) && along.is_some() { BESIDE * center.x.abs() } else { f64::INFINITY };
        let radius = (opening.length / TAU).min(most);
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
        let saddle = if self.ends[k] == Ends::ARMS { SADDLE } else { 0.0 };
        OpeningRing { rim: opening.rim.clone(), angles, frame: [front, side], center, radius, along, saddle }
    }

    /// How far round an opening each node of its rim is, radians, as on the rim.
    fn phases(&self, opening: &GluedOpening) -> Vec<f64> {
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
            None if ends == Ends::ARMS => {
                let neck = &self.far[self.find(Ends::HEAD)?];
                Some(Turn { towards: Vec3::y(), values: self.of_rim(k, |n| -neck[n]) })
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
