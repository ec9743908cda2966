//! The girths of a body that garments are measured at.

use crate::geometry::Vec3;
use crate::mannequin::{BodyPart, Mannequin, PartKind};
use PartKind::{LeftArm, LeftLeg, Neck, RightArm, RightLeg, Torso};

/// A girth by its name, the parts of the body that have it, and their landmark.
const GIRTHS: [(&str, &[PartKind], &str); 12] = [
    ("neck", &[Neck], "neck base"),
    ("bust", &[Torso], "bust"),
    ("underbust", &[Torso], "underbust"),
    ("waist", &[Torso], "waist"),
    ("high hip", &[Torso], "high hip"),
    ("hip", &[Torso], "hip"),
    ("thigh", &[LeftLeg, RightLeg], "thigh"),
    ("knee", &[LeftLeg, RightLeg], "knee"),
    ("calf", &[LeftLeg, RightLeg], "calf"),
    ("biceps", &[LeftArm, RightArm], "biceps"),
    ("elbow", &[LeftArm, RightArm], "elbow"),
    ("wrist", &[LeftArm, RightArm], "wrist"),
];

/// A girth of a body.
#[derive(Clone, Debug)]
pub(super) struct GirthPlace {
    /// `bust`, `left biceps`.
    pub(super) name: String,
    /// A point within the part.
    pub(super) center: Vec3,
    /// Unit direction along the part.
    pub(super) axis: Vec3,
    /// Length of a tape round the part, metres.
    pub(super) girth: f64,
    /// The part.
    pub(super) kind: PartKind,
}

impl GirthPlace {
    /// Points within other parts, in the plane of this girth through `center`: cloth that goes round one of them as
    /// well is not the part's own.
    pub(super) fn others(&self, body: &Mannequin, center: Vec3) -> Vec<Vec3> {
        let beside = body.parts.iter().filter(|part| is_beside(self.kind, part.kind));
        beside.flat_map(|part| crossings(part, center, self.axis)).collect()
    }
}

/// The girths that the body's landmarks tell.
pub(super) fn places(body: &Mannequin) -> Vec<GirthPlace> {
    let of = |(name, kinds, landmark): (&str, &'static [PartKind], &'static str)| {
        let name = name.to_owned();
        kinds.iter().filter_map(move |kind| place(&name, *kind, landmark, body)).collect::<Vec<_>>()
    };
    GIRTHS.into_iter().flat_map(of).collect()
}

fn place(name: &str, kind: PartKind, landmark: &str, body: &Mannequin) -> Option<GirthPlace> {
    let part = body.part(kind)?;
    let center = part.landmarks.iter().find(|(name, _)| name == landmark)?.1;
    let far = |center: &Vec3, other: &Vec3| (center - other).norm();
    let section = part.sections.iter().min_by(|a, b| far(&center, &a.center).total_cmp(&far(&center, &b.center)))?;
    let (axis, reach) = (section.axis, section.half_width.max(section.half_depth));
    let tape = body.tape(center, axis, |middle| (middle - center).norm() < reach);
    Some(GirthPlace {
        name: match kind {
            LeftArm | LeftLeg => format!("left {name}"),
            RightArm | RightLeg => format!("right {name}"),
            Torso | Neck => name.to_owned(),
        },
        center,
        axis,
        girth: tape.unwrap_or(section.girth),
        kind,
    })
}

/// Whether a part may lie beside another in one plane across it. The trunk goes on in neck and legs.
fn is_beside(part: PartKind, other: PartKind) -> bool {
    match part {
        Torso | Neck => other.is_arm(),
        LeftArm | RightArm => other != part && (other.is_arm() || other == Torso),
        LeftLeg | RightLeg => other != part && (other.is_arm() || other.is_leg()),
    }
}

/// Points at which the middle line of a part passes through a plane.
fn crossings(part: &BodyPart, center: Vec3, axis: Vec3) -> Vec<Vec3> {
    let side = |p: Vec3| (p - center).dot(&axis);
    let line = part.sections.windows(2).map(|pair| [pair[0].center, pair[1].center]);
    let crossed = line.filter(|[p, q]| (side(*p) < 0.0) != (side(*q) < 0.0));
    crossed.map(|[p, q]| p.lerp(&q, side(p) / (side(p) - side(q)))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn girths_are_those_that_tests_may_name() {
        assert_eq!(GIRTHS.map(|girth| girth.0), crate::pattern::GIRTHS);
    }

    #[test]
    fn a_shipped_body_has_its_measured_girths() {
        let woman = crate::mannequin::load("woman_92").expect("shipped");
        let places = places(&woman);
        let girth = |name: &str| places.iter().find(|p| p.name == name).map(|p| (1e3 * p.girth).round());
        // As its file says: a tape reads the surface, which is faceted, within 2 mm.
        for (name, mm) in [("bust", 916.0), ("waist", 735.0), ("hip", 972.0), ("left knee", 382.0), ("neck", 366.0)] {
            let measured = girth(name).unwrap_or(0.0);
            assert!((measured - mm).abs() <= 2.0, "{name}: {measured}, not {mm}");
        }
        assert_eq!(girth("left biceps"), girth("right biceps"));
        assert_eq!(places.len(), 18);
    }
}
