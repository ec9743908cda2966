//! The body part that passes through each opening.
//!
//! The body is thought of as a tree of lines: the trunk, and from it neck, arms and legs, each carried on to far away.
//! An opening is worn when its rim separates the far ends of that tree into two groups, that is, when it is linked
//! with the line from one end to another. How the rim lies, folds or ripples does not matter.

use super::linking::linking;
use crate::geometry::{Vec3, nearest_on_segment};
use crate::mannequin::{BodyPart, Mannequin, PartKind};

/// Distance at which the lines of the body end, metres. From there a rim of a metre's size subtends less than a
/// millionth of a turn.
const FAR_AWAY: f64 = 2000.0;

/// A limb goes straight on for this long (metres), past a hand or a foot and a long sleeve on it, before it turns
/// aside: carried on straight, hanging arms would pass through the hem of a wide skirt.
const BEYOND_END: f64 = 0.2;

/// Heights above the top of the neck (metres) at which a hood may be open: at the chin only, where it has slipped over
/// the face.
const FACE: [f64; 3] = [0.1, 0.05, 0.0];

/// Body part that passes through an opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Through {
    /// One part of the body. The torso also for a strap or toga round the trunk and an arm.
    Part(PartKind),
    /// Both legs, below the crotch: the hem of a skirt.
    Legs,
}

impl Through {
    /// `torso`, `neck`, `left arm`, `right arm`, `left leg`, `right leg`, `legs`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Part(part) => part.name(),
            Self::Legs => "legs",
        }
    }
}

/// Body part that passes through a rim, and the far ends of the body (head, hands, feet) that the rim separates from
/// the others.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Passage {
    /// Body part that passes through. `None` if there is none, or if the body has no torso.
    pub through: Option<Through>,
    /// The parts that lead to the ends of the smaller group. Of two equally large ones that without the neck.
    pub ends: Vec<PartKind>,
}

/// The passage of every rim (a closed polygon, in order).
pub fn worn(rims: &[Vec<Vec3>], body: &Mannequin) -> Vec<Passage> {
    let Some(skeleton) = Skeleton::new(&body.parts) else { return vec![Passage::default(); rims.len()] };
    rims.iter().map(|rim| skeleton.passage(rim)).collect()
}

/// More rims of one surface than this are not dealt the body's ends: there would be 2ⁿ ways.
const MOST_RIMS: usize = 16;

/// Whether `rims` can be all the rims of one surface that lies round the body: each end of the body is beyond exactly
/// one of them. Rims of pieces that are not sewn yet may part the ends in other ways, and then tell nothing.
pub fn is_dealt(rims: &[&Passage], body: &Mannequin) -> bool {
    let bit = |kind: PartKind| 1u8 << kind as u8;
    let ends = |parts: &mut dyn Iterator<Item = PartKind>| parts.fold(0, |all, kind| all | bit(kind));
    let all = ends(&mut body.parts.iter().map(|p| p.kind).filter(|kind| *kind != PartKind::Torso));
    let groups: Vec<u8> = rims.iter().map(|rim| ends(&mut rim.ends.iter().copied())).collect();
    groups.len() <= MOST_RIMS && can_fill(all, 0, &groups)
}

/// Whether one group of ends or its complement per rim, none of them in another, make up `all` with the `taken` ones.
fn can_fill(all: u8, taken: u8, groups: &[u8]) -> bool {
    let Some((first, rest)) = groups.split_first() else { return taken == all };
    [*first, all ^ first].into_iter().any(|group| group & taken == 0 && can_fill(all, taken | group, rest))
}

/// Distance of the middle of a rim round an arm or a leg past the last section of that limb, metres along it: the
/// length of a sleeve or a leg beyond the body's. Negative before the end. `None` for other parts.
pub fn past_end(rim: &[Vec3], through: Through, body: &Mannequin) -> Option<f64> {
    let Through::Part(kind) = through else { return None };
    let limb = body.parts.iter().find(|p| p.kind == kind && (kind.is_arm() || kind.is_leg()))?;
    let middle = rim.iter().sum::<Vec3>() / rim.len() as f64;
    let line: Vec<Vec3> = limb.sections.iter().rev().map(|s| s.center).collect();
    let end = limb.sections.last()?;
    let beyond = (middle - end.center).dot(&end.axis);
    if beyond > 0.0 {
        return Some(beyond);
    }
    let mut walked = 0.0;
    let mut nearest = (f64::INFINITY, 0.0);
    for ends in line.windows(2) {
        let (long, (share, off)) = ((ends[1] - ends[0]).norm(), nearest_on_segment(middle, [ends[0], ends[1]]));
        if off < nearest.0 {
            nearest = (off, walked + share * long);
        }
        walked += long;
    }
    Some(-nearest.1)
}

/// The body as lines that all begin at the upper end of the trunk.
struct Skeleton {
    torso: Vec<Vec3>,
    /// From the trunk to far away.
    ends: Vec<(PartKind, Vec<Vec3>)>,
    /// The neck's line leaving the head through the face instead of the crown, at each height of [`FACE`]. None without
    /// a neck.
    faces: Vec<Vec<Vec3>>,
}

impl Skeleton {
    fn new(parts: &[BodyPart]) -> Option<Self> {
        let line = |kind: PartKind| {
            let part = parts.iter().find(|p| p.kind == kind)?;
            let line: Vec<Vec3> = part.sections.iter().map(|s| s.center).collect();
            (!line.is_empty()).then_some(line)
        };
        let mut torso = line(PartKind::Torso)?;
        torso.reverse();
        let top = torso[0];
        let mut ends = Vec::new();
        for kind in [PartKind::Neck, PartKind::LeftArm, PartKind::RightArm, PartKind::LeftLeg, PartKind::RightLeg] {
            let Some(limb) = line(kind) else { continue };
            let mut path = if kind.is_leg() { torso.clone() } else { vec![top] };
            path.extend(limb);
            carry_on(&mut path, kind);
            ends.push((kind, path));
        }
        let neck = line(PartKind::Neck);
        let leaving_at = |height: f64| {
            let mut path = vec![top];
            path.extend(neck.as_ref()?);
            path.push(path[path.len() - 1] + Vec3::y() * height);
            path.push(path[path.len() - 1] + Vec3::z() * FAR_AWAY);
            Some(path)
        };
        let faces = FACE.into_iter().filter_map(leaving_at).collect();
        Some(Self { torso, ends, faces })
    }

    fn passage(&self, rim: &[Vec3]) -> Passage {
        let shares: Vec<(PartKind, f64)> = self.ends.iter().map(|(kind, line)| (*kind, linking(rim, line))).collect();
        let ends = parted(&shares);
        let through = match ends.as_slice() {
            [] => self.through_face(rim, &shares),
            [one] => Some(Through::Part(*one)),
            [PartKind::LeftLeg, PartKind::RightLeg] => Some(self.torso_or_legs(rim, &shares)),
            _ => Some(Through::Part(PartKind::Torso)),
        };
        // A face is an end of the head.
        let ends = if ends.is_empty() && through.is_some() { vec![PartKind::Neck] } else { ends };
        Passage { through, ends }
    }

    /// The rim of a hood is not round the line through the crown, but round one through the face.
    fn through_face(&self, rim: &[Vec3], shares: &[(PartKind, f64)]) -> Option<Through> {
        let is_round = |line: &Vec<Vec3>| {
            let share = linking(rim, line);
            let changed: Vec<(PartKind, f64)> =
                shares.iter().map(|&(kind, s)| (kind, if kind == PartKind::Neck { share } else { s })).collect();
            parted(&changed) == [PartKind::Neck]
        };
        self.faces.iter().any(is_round).then_some(Through::Part(PartKind::Neck))
    }

    /// Torso or legs: a waist and a hem separate the ends alike. The part in the rim's plane is the one with the larger
    /// share of the turn.
    fn torso_or_legs(&self, rim: &[Vec3], shares: &[(PartKind, f64)]) -> Through {
        let trunk = linking(rim, &self.torso).abs();
        let legs = shares.iter().filter(|(kind, _)| kind.is_leg());
        let (sum, count) = legs.fold((0.0, 0.0), |(sum, n), &(_, s)| (sum + s, n + 1.0));
        let beside_trunk = (sum / count - linking(rim, &self.torso)).abs();
        if trunk >= beside_trunk { Through::Part(PartKind::Torso) } else { Through::Legs }
    }
}

/// Carries a line on to far away: the head up, the legs down, the arms on for a while and then out to their side.
fn carry_on(path: &mut Vec<Vec3>, kind: PartKind) {
    let end = path[path.len() - 1];
    let along = (end - path[path.len() - 2]).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    let aside = match kind {
        PartKind::Neck | PartKind::Torso => Vec3::y(),
        PartKind::LeftArm => Vec3::x(),
        PartKind::RightArm => -Vec3::x(),
        PartKind::LeftLeg | PartKind::RightLeg => -Vec3::y(),
    };
    path.push(end + along * BEYOND_END);
    path.push(end + along * BEYOND_END + aside * FAR_AWAY);
}

/// The ends that the rim parts from the others: the smaller group. Of two equally large ones that without the neck.
/// Empty when it parts none.
fn parted(shares: &[(PartKind, f64)]) -> Vec<PartKind> {
    // Every line begins at the same point, so differences of two are whole numbers.
    let level = |s: f64| shares.first().map_or(0, |first| (s - first.1).round() as i64);
    let (same, other): (Vec<_>, Vec<_>) = shares.iter().partition(|(_, s)| level(*s) == 0);
    let smaller = if same.len() < other.len() { same } else { other };
    smaller.into_iter().map(|(kind, _)| kind).collect()
}
