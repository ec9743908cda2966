//! How wide an opening is that parts some ends of a body from the rest, and how far openings are from each other.

use super::ends::Ends;
use crate::mannequin::{Mannequin, PartKind};

/// Girths of the openings of a garment that part some ends from the rest, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Range {
    /// No opening is narrower: the part would not go through it.
    pub(super) least: f64,
    /// Usual ones.
    pub(super) usual: [f64; 2],
}

/// Cloth and elastic give so much: an opening may be narrower than what goes through it by this share.
const GIVE: f64 = 0.85;
/// The waist and what is widest lie below the armpits: in this share of the trunk from the crotch to the neck.
const BELOW_ARMPITS: f64 = 0.7;
/// Girths of a body whose parts are not measured: those of a woman of 1.68 m, metres.
const NECK: f64 = 0.35;
const WRIST: f64 = 0.155;
const ANKLE: f64 = 0.21;
const WAIST: f64 = 0.7;
const HEIGHT: f64 = 1.68;

/// The known girths of a body, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    /// Least girth of the neck.
    pub(super) neck: f64,
    /// Least girth of the trunk.
    pub(super) waist: f64,
    /// Greatest girth of the trunk.
    pub(super) trunk: f64,
    /// Least and greatest of an arm.
    pub(super) arm: [f64; 2],
    /// Least and greatest of a leg.
    pub(super) leg: [f64; 2],
    /// From the crotch to the neck.
    torso_length: f64,
    arm_length: f64,
    leg_length: f64,
    /// From the middle to a shoulder.
    shoulder: f64,
}

impl Sizes {
    /// Read off a body's sections.
    pub(super) fn of(body: &Mannequin) -> Self {
        let top = body.mesh.vertices.iter().map(|v| v.y).fold(0.0, f64::max);
        let scale = top / HEIGHT;
        let girths = |kind: PartKind, otherwise: [f64; 2]| {
            let part = body.part(kind).filter(|part| !part.sections.is_empty());
            part.map_or(otherwise.map(|g| g * scale), |part| {
                let share = if kind == PartKind::Torso { BELOW_ARMPITS } else { 1.0 };
                let count = (share * part.sections.len() as f64).ceil() as usize;
                let girths = part.sections.iter().take(count).map(|s| s.girth);
                [girths.clone().fold(f64::INFINITY, f64::min), girths.fold(0.0, f64::max)]
            })
        };
        let length = |kind: PartKind, otherwise: f64| {
            let part = body.part(kind).filter(|part| part.sections.len() > 1);
            part.map_or(otherwise * scale, |part| {
                part.sections.windows(2).map(|s| (s[1].center - s[0].center).norm()).sum()
            })
        };
        let shoulder = body.part(PartKind::LeftArm).and_then(|arm| arm.sections.first()).map(|s| s.center.x.abs());
        let trunk = girths(PartKind::Torso, [WAIST, 1.4 * WAIST]);
        Self {
            neck: girths(PartKind::Neck, [NECK; 2])[0],
            waist: trunk[0],
            trunk: trunk[1],
            arm: girths(PartKind::LeftArm, [WRIST, 2.0 * WRIST]),
            leg: girths(PartKind::LeftLeg, [ANKLE, 2.6 * ANKLE]),
            torso_length: length(PartKind::Torso, 0.65),
            arm_length: length(PartKind::LeftArm, 0.58),
            leg_length: length(PartKind::LeftLeg, 0.72),
            shoulder: shoulder.unwrap_or(0.17 * scale),
        }
    }

    /// Girths of openings that part these ends from the rest.
    pub(super) fn range(&self, ends: Ends) -> Range {
        let (arm, leg) = (self.arm, self.leg);
        let range = |least: f64, low: f64, high: f64| Range { least: GIVE * least, usual: [low, high] };
        let one_arm = ends.touches(Ends::ARMS) && !ends.has(Ends::ARMS);
        match ends {
            Ends::NONE => range(0.0, 0.0, 1.3 * self.neck),
            Ends::HEAD => range(self.neck, self.neck, 2.1 * self.neck),
            Ends::LEFT_ARM | Ends::RIGHT_ARM => range(arm[0], arm[0], 2.0 * arm[1]),
            Ends::LEFT_LEG | Ends::RIGHT_LEG => range(leg[0], leg[0], 1.4 * leg[1]),
            Ends::LEGS => range(self.waist, self.waist, 6.0 * self.waist),
            Ends::TOP => range(self.waist, self.waist, 1.1 * self.trunk),
            Ends::ALL => range(0.0, 2.0 * self.waist, 12.0 * self.waist),
            Ends::ARMS => range(0.9 * self.waist, 1.1 * self.waist, 2.4 * self.waist),
            _ if ends == Ends::HEAD.with(Ends::LEGS) || ends == Ends::ARMS.with(Ends::LEGS) => {
                range(1.5 * self.waist, 2.1 * self.waist, 8.0 * self.waist)
            }
            _ if ends.has(Ends::HEAD) && one_arm && !ends.touches(Ends::LEGS) => {
                range(0.7 * self.waist, 0.8 * self.waist, 1.5 * self.waist)
            }
            _ => range(0.7 * self.waist, 1.3 * self.waist, 6.0 * self.waist),
        }
    }

    /// Least and greatest distance on the cloth from an opening of these ends to one of those, metres; none where it
    /// says nothing.
    pub(super) fn apart(&self, one: Ends, other: Ends) -> Option<[f64; 2]> {
        let Self { torso_length: torso, arm_length: arm, leg_length: leg, shoulder, .. } = *self;
        let (is_arm, is_leg) = (one_arm(one) || one_arm(other), one_leg(one) || one_leg(other));
        let is = |ends: Ends| one == ends || other == ends;
        let between = |low: f64, high: f64| Some([low, 1.1 * high]);
        // Straps and bands may be narrow: from the neck to an arm there is no least distance.
        if is(Ends::HEAD) && is_arm {
            between(0.005, shoulder + arm + 0.1)
        } else if is(Ends::HEAD) && is(Ends::LEGS) {
            between(0.1 * torso, torso + leg)
        } else if is(Ends::HEAD) && is_leg {
            between(1.05 * torso, torso + leg + 0.1)
        } else if is(Ends::HEAD) && is(Ends::ARMS.with(Ends::LEGS)) {
            // A cape may be closed by one hook at the neck.
            between(0.03, torso + 0.5 * leg)
        } else if is(Ends::LEGS) && is_arm {
            between(0.05 * torso, torso + leg)
        } else if is(Ends::TOP) && is(Ends::LEGS) {
            between(0.12 * torso, torso + leg)
        } else if is(Ends::TOP) && is_leg {
            // The sides of a bikini or a thong are bands.
            between(0.01, 0.7 * torso + leg)
        } else if is_arm && is_leg {
            between(0.45 * torso, 0.5 * arm + torso + leg)
        } else if one_arm(one) && one_arm(other) {
            between(0.15 * torso, 2.0 * (shoulder + arm))
        } else if one_leg(one) && one_leg(other) {
            between(0.03, 2.0 * leg)
        } else {
            None
        }
    }
}

fn one_arm(ends: Ends) -> bool {
    ends.len() == 1 && ends.touches(Ends::ARMS)
}

fn one_leg(ends: Ends) -> bool {
    ends.len() == 1 && ends.touches(Ends::LEGS)
}
