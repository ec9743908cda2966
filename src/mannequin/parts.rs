//! The body parts of a built mannequin: sections and landmarks, read off the lofts.

use super::field::BodyField;
use super::loft::perimeter;
use super::spec::{MannequinSpec, UNIT};
use super::{BodyPart, PartKind, Section};
use crate::geometry::Vec3;

/// Largest distance between sections, metres.
const SPACING: f64 = 0.025;

/// Torso, neck, arms and legs.
pub(super) fn parts(spec: &MannequinSpec, body: &BodyField) -> Vec<BodyPart> {
    let neck = spec.torso_row("neck base").map_or(body.neck_end(), |r| r.y * UNIT);
    let trunk = |from: f64, to: f64| stations(from, to).map(|y| torso_section(body, y)).collect();
    let marks = |low: f64, high: f64| {
        let rows = spec.torso.iter().filter(move |r| (low..=high).contains(&(r.y * UNIT)));
        rows.map(|r| (r.name.clone(), torso_section(body, r.y * UNIT).center)).collect()
    };
    let torso = BodyPart { kind: PartKind::Torso, sections: trunk(body.crotch, neck), landmarks: marks(0.0, neck) };
    let neck = BodyPart {
        kind: PartKind::Neck,
        sections: trunk(neck, body.neck_end()),
        landmarks: marks(neck, body.neck_end()),
    };
    let (arm, leg) = (left_arm(spec, body), left_leg(spec, body));
    let (right_arm, right_leg) = (mirrored(&arm, PartKind::RightArm), mirrored(&leg, PartKind::RightLeg));
    vec![torso, neck, arm, right_arm, leg, right_leg]
}

/// Evenly from `from` to `to` (either way), both included.
fn stations(from: f64, to: f64) -> impl Iterator<Item = f64> {
    let count = ((to - from).abs() / SPACING).ceil().max(1.0);
    (0..=count as usize).map(move |i| from + (to - from) * i as f64 / count)
}

fn torso_section(body: &BodyField, y: f64) -> Section {
    let [a, b, n, z] = body.trunk_at(y);
    Section { center: Vec3::new(0.0, y, z), axis: Vec3::y(), half_width: a, half_depth: b, girth: perimeter(a, b, n) }
}

fn left_arm(spec: &MannequinSpec, body: &BodyField) -> BodyPart {
    let arm = &body.arm;
    let section = |t: f64| {
        let [a, b] = arm.profile.eval(t);
        Section {
            center: arm.joint + arm.axis * t,
            axis: arm.axis,
            half_width: a,
            half_depth: b,
            girth: perimeter(a, b, 2.0),
        }
    };
    let mut landmarks = vec![("shoulder".to_owned(), Vec3::from(spec.arm.shoulder) * UNIT)];
    landmarks.extend(spec.arm.rows.iter().map(|r| (r.name.clone(), section(r.at * UNIT + arm.acromion).center)));
    let sections = stations(0.0, arm.profile.end()).map(section).collect();
    BodyPart { kind: PartKind::LeftArm, sections, landmarks }
}

fn left_leg(spec: &MannequinSpec, body: &BodyField) -> BodyPart {
    let center = |y: f64| {
        let [_, _, x, z] = body.leg.eval(y);
        Vec3::new(x, y, z)
    };
    let section = |y: f64| {
        let [a, b, _, _] = body.leg.eval(y);
        let axis = (center(y - 0.5 * SPACING) - center(y + 0.5 * SPACING)).normalize();
        Section { center: center(y), axis, half_width: a, half_depth: b, girth: perimeter(a, b, 2.0) }
    };
    let mut landmarks = vec![("crotch".to_owned(), center(body.crotch))];
    landmarks.extend(spec.leg.rows.iter().map(|r| (r.name.clone(), center(r.y * UNIT))));
    let sections = stations(body.crotch, body.leg.start()).map(section).collect();
    BodyPart { kind: PartKind::LeftLeg, sections, landmarks }
}

fn mirrored(part: &BodyPart, kind: PartKind) -> BodyPart {
    let flip = |p: Vec3| Vec3::new(-p.x, p.y, p.z);
    BodyPart {
        kind,
        sections: part.sections.iter().map(|s| Section { center: flip(s.center), axis: flip(s.axis), ..*s }).collect(),
        landmarks: part.landmarks.iter().map(|(n, p)| (n.clone(), flip(*p))).collect(),
    }
}
