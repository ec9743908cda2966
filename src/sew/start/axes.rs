//! The body as its axes: limbs and trunk as bent elliptic cylinders whose thickness can be scaled down to nothing.
//!
//! A garment is inflated round these first; the cylinders then grow to the body's own size. A point in two of them
//! (at a shoulder, in the crotch) is led out of one and then of the other.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Rotation3;

use crate::geometry::Vec3;
use crate::mannequin::{BodyPart, Mannequin, PartKind, Section};

/// Sections of an axis are at least this far apart, metres: enough for the bend of a spine or an elbow, and few enough
/// to search for every particle in every step.
const SPACING: f64 = 0.06;
/// Half axes are at least this, metres, at every scale: no edge of a start mesh (25 mm) spans so thick an axis, and no
/// step carries a node through it. With 4 mm the fronts of trousers ended behind the legs.
const THINNEST: f64 = 0.02;

/// An arm's axis begins where the arm leaves the trunk. The shoulder joint lies further in by this share of its width.
/// Raised about its beginning, an arm was grown through the cloth under it.
const TO_JOINT: f64 = 0.75;

/// A cross-section.
#[derive(Clone, Copy, Debug)]
struct Disk {
    center: Vec3,
    /// Unit vectors along the axis, sideways and to the front.
    frame: [Vec3; 3],
    /// Half extents sideways and front to back, metres.
    half: [f64; 2],
    /// Metres.
    girth: f64,
}

/// One part of the body as a bent elliptic cylinder.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// The part.
    pub(super) kind: PartKind,
    disks: Vec<Disk>,
    /// Distance along the axis from where the part begins, metres. That of a shoulder joint is negative.
    along: Vec<f64>,
    /// Places that have a name in lower case.
    landmarks: Vec<(String, Vec3)>,
    low: Vec3,
    high: Vec3,
}

/// Arms in sleeves hang at no less than this from straight down, radians: 30°, less than those of the mannequins. Of a
/// shirt on a body with its arms beside its trunk 311 triangles started through the body, and 25 so.
const STANCE: f64 = 30.0 * PI / 180.0;

/// How the arms are raised while a garment is put on.
#[derive(Clone, Copy, Debug)]
pub(super) struct RaisedArms {
    /// The share of the way to straight sideways.
    share: f64,
}

impl RaisedArms {
    /// As they hang.
    pub(super) const NONE: Self = Self { share: 0.0 };
    /// Straight sideways, of a garment without sleeves.
    pub(super) const SIDEWAYS: Self = Self { share: 1.0 };

    /// The arms of these axes in sleeves: at [`STANCE`] where they hang closer to the trunk.
    pub(super) fn in_sleeves(axes: &Axes) -> Self {
        let angle = |axis: &Axis| (axis.station(axis.length()).center - axis.station(0.0).center).angle(&-Vec3::y());
        let least = axes.axes.iter().filter(|axis| axis.kind.is_arm()).map(angle).fold(FRAC_PI_2, f64::min);
        let share = if least < STANCE { (STANCE - least) / (FRAC_PI_2 - least) } else { 0.0 };
        Self { share }
    }

    /// Where a point beside a raised arm is once the arm is raised only by this share of that: beyond the joint it goes
    /// with the arm. `arm` is the axis as it hangs.
    pub(super) fn carried(&self, p: Vec3, arm: &Axis, share: f64) -> Vec3 {
        if self.share == 0.0 {
            return p;
        }
        let (joint, reach) = arm.joint();
        let [raised, now] = [1.0, share].map(|share| turn_sideways(&reach, self.share * share));
        let off = p - joint;
        if off.dot(&(raised * reach)) > 0.0 { joint + now * raised.inverse() * off } else { p }
    }

    /// The axes with the arms raised by this share of how they are raised.
    pub(super) fn pose(&self, axes: &Axes, share: f64) -> Axes {
        let share = self.share * share;
        if self.share > 0.0 { axes.with_arms_raised(share) } else { axes.clone() }
    }
}

/// A place on an axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxisPlace {
    /// On the axis.
    pub(super) center: Vec3,
    /// Unit direction, away from the trunk.
    pub(super) axis: Vec3,
}

impl Axis {
    /// Of a part, if it has two sections at least.
    fn of(part: &BodyPart) -> Option<Self> {
        let mut kept: Vec<&Section> = Vec::new();
        for section in &part.sections {
            if kept.last().is_none_or(|last| (section.center - last.center).norm() >= SPACING) {
                kept.push(section);
            }
        }
        // The last one is where the part ends.
        let last = part.sections.last()?;
        if kept.len() > 1 && kept.last().is_some_and(|k| (last.center - k.center).norm() < 0.5 * SPACING) {
            kept.pop();
        }
        if kept.last().is_some_and(|k| k.center != last.center) {
            kept.push(last);
        }
        let landmarks = part.landmarks.iter().map(|(name, at)| (name.to_lowercase(), *at)).collect();
        Self::new(part.kind, kept.into_iter().map(disk).collect(), 0.0, landmarks)
    }

    /// Of disks, the first at this place along the axis, if there are two at least.
    fn new(kind: PartKind, disks: Vec<Disk>, first: f64, landmarks: Vec<(String, Vec3)>) -> Option<Self> {
        let mut along = vec![first];
        for pair in disks.windows(2) {
            along.push(along.last().copied().unwrap_or(0.0) + (pair[1].center - pair[0].center).norm());
        }
        let reach = disks.iter().map(|d| d.half[0].max(d.half[1])).fold(0.0, f64::max);
        let low = disks.iter().fold(Vec3::repeat(f64::INFINITY), |low, d| low.inf(&d.center)).add_scalar(-reach);
        let high = disks.iter().fold(Vec3::repeat(f64::NEG_INFINITY), |high, d| high.sup(&d.center)).add_scalar(reach);
        (disks.len() > 1).then_some(Self { kind, disks, along, landmarks, low, high })
    }

    /// An arm from its joint on, turned about that by this share of the way to straight sideways. Places along it are
    /// those of the arm that hangs.
    fn raised(&self, share: f64) -> Self {
        let first = self.disks[0];
        let (joint, reach) = self.joint();
        let turn = turn_sideways(&reach, share);
        let place = |p: Vec3| joint + turn * (p - joint);
        let turned = |disk: &Disk| Disk { center: place(disk.center), frame: disk.frame.map(|v| turn * v), ..*disk };
        let landmarks = self.landmarks.iter().map(|(name, at)| (name.clone(), place(*at))).collect();
        let at_joint = Disk { center: joint, ..first };
        let disks = std::iter::once(&at_joint).chain(&self.disks).map(turned).collect();
        let further_in = (first.center - joint).norm();
        Self::new(self.kind, disks, -further_in, landmarks).unwrap_or_else(|| self.clone())
    }

    /// The joint that an arm is raised about, and the way from there to its end.
    fn joint(&self) -> (Vec3, Vec3) {
        let first = self.disks[0];
        let further_in = TO_JOINT * (first.half[0] + first.half[1]);
        let joint = first.center - self.station(0.0).axis * further_in;
        (joint, self.disks[self.disks.len() - 1].center - joint)
    }

    /// Its length, metres.
    pub(super) fn length(&self) -> f64 {
        self.along.last().copied().unwrap_or(0.0)
    }

    /// The disks before and after the place `s` metres along it, and the share of the way from the one to the other;
    /// less than 0 or more than 1 beyond an end.
    fn between(&self, s: f64) -> (&Disk, &Disk, f64) {
        let k = self.along.partition_point(|a| *a <= s).clamp(1, self.disks.len() - 1);
        let length = self.along[k] - self.along[k - 1];
        let share = if length > 0.0 { (s - self.along[k - 1]) / length } else { 0.0 };
        (&self.disks[k - 1], &self.disks[k], share)
    }

    /// The place `s` metres along it, straight on beyond either end.
    pub(super) fn station(&self, s: f64) -> AxisPlace {
        let (from, to, share) = self.between(s);
        let axis = (to.center - from.center).try_normalize(0.0).unwrap_or(from.frame[0]);
        AxisPlace { center: from.center + (to.center - from.center) * share, axis }
    }

    /// Its girth `s` metres along it, metres.
    pub(super) fn girth(&self, s: f64) -> f64 {
        let (from, to, share) = self.between(s);
        from.girth + (to.girth - from.girth) * share.clamp(0.0, 1.0)
    }

    /// Its largest girth, metres.
    pub(super) fn widest(&self) -> f64 {
        self.disks.iter().map(|disk| disk.girth).fold(0.0, f64::max)
    }

    /// Half its extent front to back at the first section after the place `s` metres along it, metres.
    pub(super) fn half_depth_after(&self, s: f64) -> f64 {
        self.between(s).1.half[1]
    }

    /// How far along it the place of a name is, metres: of that name, else with it in its own.
    pub(super) fn landmark(&self, name: &str) -> Option<f64> {
        let called = self.landmarks.iter().find(|l| l.0 == name);
        let found = called.or_else(|| self.landmarks.iter().find(|l| l.0.contains(name)));
        found.map(|l| self.nearest(l.1))
    }

    /// How far along it the point nearest to `p` is, metres.
    pub(super) fn nearest(&self, p: Vec3) -> f64 {
        let (k, share) = self.nearest_segment(p);
        self.along[k] + (self.along[k + 1] - self.along[k]) * share
    }

    /// The segment nearest to `p`, and the share of it where it is.
    fn nearest_segment(&self, p: Vec3) -> (usize, f64) {
        let mut best = (f64::INFINITY, 0, 0.0);
        for (k, pair) in self.disks.windows(2).enumerate() {
            let way = pair[1].center - pair[0].center;
            let length = way.norm_squared();
            let share = if length > 0.0 { ((p - pair[0].center).dot(&way) / length).clamp(0.0, 1.0) } else { 0.0 };
            let far = (p - pair[0].center - way * share).norm_squared();
            if far < best.0 {
                best = (far, k, share);
            }
        }
        (best.1, best.2)
    }

    /// The disks before and after its point that is nearest to `p`, the share of the way between them, and that point.
    fn nearest_center(&self, p: Vec3) -> ([&Disk; 2], f64, Vec3) {
        let (k, share) = self.nearest_segment(p);
        let [from, to] = [&self.disks[k], &self.disks[k + 1]];
        ([from, to], share, from.center + (to.center - from.center) * share)
    }

    /// The point of it that is nearest to a point, and how far that is off in the axis's mean thickness there.
    fn middle(&self, p: Vec3) -> (Vec3, f64) {
        let ([from, to], share, center) = self.nearest_center(p);
        let mean = |disk: &Disk| 0.5 * (disk.half[0] + disk.half[1]);
        (center, (p - center).norm() / (mean(from) + (mean(to) - mean(from)) * share).max(THINNEST))
    }

    /// Where a point that lies within the axis at `scale` of its thickness, plus `gap` metres, is led out to.
    fn led_out(&self, p: Vec3, scale: f64, gap: f64) -> Option<Vec3> {
        let is_far = (0..3).any(|c| p[c] < self.low[c] - gap || p[c] > self.high[c] + gap);
        if is_far {
            return None;
        }
        let ([from, to], share, center) = self.nearest_center(p);
        let mix = |a: f64, b: f64| a + (b - a) * share;
        let off = p - center;
        let half = [0, 1].map(|c| (scale * mix(from.half[c], to.half[c])).max(THINNEST) + gap);
        let [along, side, front] = from.frame;
        // Beyond an end the axis is rounded off.
        let parts = [off.dot(&along) / half[0].min(half[1]), off.dot(&side) / half[0], off.dot(&front) / half[1]];
        let depth = parts.iter().map(|c| c * c).sum::<f64>().sqrt();
        (depth < 1.0 && depth > 1e-6).then(|| center + off / depth)
    }
}

/// The rotation by this share of the way from a direction to straight sideways.
fn turn_sideways(way: &Vec3, share: f64) -> Rotation3<f64> {
    let sideways = Vec3::x() * way.x.signum();
    Rotation3::scaled_rotation_between(way, &sideways, share).unwrap_or_else(Rotation3::identity)
}

/// The cross-section of a part, with its directions.
fn disk(section: &Section) -> Disk {
    let along = section.axis.try_normalize(0.0).unwrap_or_else(Vec3::y);
    let ahead = if along.z.abs() < 0.9 { Vec3::z() } else { Vec3::y() };
    let front = (ahead - along * ahead.dot(&along)).normalize();
    Disk {
        center: section.center,
        frame: [along, front.cross(&along), front],
        half: [section.half_width, section.half_depth],
        girth: section.girth,
    }
}

/// All axes of a body.
#[derive(Clone, Debug)]
pub(super) struct Axes {
    axes: Vec<Axis>,
}

impl Axes {
    /// Of a body's parts.
    pub(super) fn of(body: &Mannequin) -> Self {
        Self::of_parts(&body.parts)
    }

    /// The same of these parts alone.
    pub(super) fn of_parts(parts: &[BodyPart]) -> Self {
        Self { axes: parts.iter().filter_map(Axis::of).collect() }
    }

    /// The point of the axis that a point is nearest to for that axis's thickness.
    pub(super) fn middle(&self, p: Vec3) -> Option<Vec3> {
        let near = self.axes.iter().map(|axis| axis.middle(p));
        near.min_by(|a, b| a.1.total_cmp(&b.1)).map(|near| near.0)
    }

    /// The axis of a part, if the body has it.
    pub(super) fn part(&self, kind: PartKind) -> Option<&Axis> {
        self.axes.iter().find(|axis| axis.kind == kind)
    }

    /// The same body with its arms raised by this share of the way to straight sideways.
    pub(super) fn with_arms_raised(&self, share: f64) -> Self {
        let raised = |axis: &Axis| if axis.kind.is_arm() { axis.raised(share) } else { axis.clone() };
        Self { axes: self.axes.iter().map(raised).collect() }
    }

    /// Where a point is led to that lies within the axes at `scale` of their thickness, plus `gap` metres; the point
    /// itself outside.
    pub(super) fn outside(&self, p: Vec3, scale: f64, gap: f64) -> Vec3 {
        self.axes.iter().fold(p, |p, axis| axis.led_out(p, scale, gap).unwrap_or(p))
    }
}

#[cfg(test)]
impl Axes {
    /// A trunk alone, 1 m high on the floor, with these half extents sideways and front to back, metres.
    pub(super) fn of_cylinder(half: [f64; 2]) -> Self {
        let section = |k: u32| Section {
            center: Vec3::new(0.0, 0.05 * f64::from(k), 0.0),
            axis: Vec3::y(),
            half_width: half[0],
            half_depth: half[1],
            girth: 1.0,
        };
        let sections = (0..=20).map(section).collect();
        Self::of_parts(&[BodyPart { kind: PartKind::Torso, sections, landmarks: Vec::new() }])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cylinder() -> Axis {
        Axes::of_cylinder([0.2, 0.1]).axes.swap_remove(0)
    }

    /// A limb of 0.6 m from a shoulder in this direction.
    fn limb(kind: PartKind, way: Vec3) -> BodyPart {
        let section = |k: u32| Section {
            center: Vec3::new(0.2, 1.4, 0.0) + way * (0.1 * f64::from(k)),
            axis: way,
            half_width: 0.05,
            half_depth: 0.03,
            girth: 0.28,
        };
        BodyPart { kind, sections: (0..=6).map(section).collect(), landmarks: Vec::new() }
    }

    #[test]
    fn an_axis_goes_from_end_to_end_and_straight_on() {
        let axis = cylinder();
        assert!((axis.length() - 1.0).abs() < 1e-12);
        for s in [-0.2, 0.0, 0.31, 1.0, 1.3] {
            assert!((axis.station(s).center - Vec3::new(0.0, s, 0.0)).norm() < 1e-12, "{s}");
            assert!((axis.nearest(Vec3::new(0.3, s, 0.1)) - s.clamp(0.0, 1.0)).abs() < 1e-12, "{s}");
        }
    }

    #[test]
    fn an_arm_is_raised_about_its_shoulder_joint() {
        let way = Vec3::new(0.6, -0.8, 0.0);
        let body = Axes::of_parts(&[limb(PartKind::LeftArm, way), limb(PartKind::LeftLeg, way)]);
        let at = |body: &Axes, kind, s: f64| body.part(kind).map(|axis| axis.station(s).center).expect("an axis");
        let joint = Vec3::new(0.2, 1.4, 0.0) - way * (TO_JOINT * 0.08);
        let raised = body.with_arms_raised(1.0);
        for s in [0.0, 0.3, 0.6] {
            let straight = joint + Vec3::x() * (TO_JOINT * 0.08 + s);
            assert!((at(&raised, PartKind::LeftArm, s) - straight).norm() < 1e-12, "{s}");
            assert_eq!(at(&raised, PartKind::LeftLeg, s), at(&body, PartKind::LeftLeg, s), "legs stay");
            let lowered = at(&body.with_arms_raised(0.0), PartKind::LeftArm, s);
            assert!((lowered - at(&body, PartKind::LeftArm, s)).norm() < 1e-12, "{s}");
        }
        let hanging = body.part(PartKind::LeftArm).expect("an arm");
        for share in [0.0, 0.4, 1.0] {
            let carried = RaisedArms::SIDEWAYS.carried(at(&raised, PartKind::LeftArm, 0.3), hanging, share);
            let posed = RaisedArms::SIDEWAYS.pose(&body, share);
            assert!((carried - at(&posed, PartKind::LeftArm, 0.3)).norm() < 1e-12, "{share}");
        }
        let in_trunk = joint - Vec3::x() * 0.05;
        assert_eq!(RaisedArms::SIDEWAYS.carried(in_trunk, hanging, 0.0), in_trunk);
        assert_eq!(RaisedArms::NONE.carried(joint + Vec3::x(), hanging, 0.0), joint + Vec3::x());
        let half = at(&body.with_arms_raised(0.5), PartKind::LeftArm, 0.6) - joint;
        assert!((half.y.atan2(half.x) - 0.5 * (-0.8f64).atan2(0.6)).abs() < 1e-12);
        // What lies between the trunk and the arm is led out too.
        assert!(raised.outside(joint + Vec3::new(0.03, 0.01, 0.0), 1.0, 0.0).y > joint.y + 0.02);
        assert_eq!(raised.part(PartKind::LeftArm).map(Axis::length), body.part(PartKind::LeftArm).map(Axis::length));
    }

    #[test]
    fn arms_in_sleeves_are_raised_only_where_they_hang_beside_the_trunk() {
        let body = |way: Vec3| Axes::of_parts(&[limb(PartKind::LeftArm, way)]);
        let angle = |axes: &Axes| {
            let arm = axes.part(PartKind::LeftArm).expect("an arm");
            (arm.station(arm.length()).center - arm.station(0.0).center).angle(&-Vec3::y())
        };
        let hanging = body(Vec3::new(0.1f64.sin(), -0.1f64.cos(), 0.0));
        let arms = RaisedArms::in_sleeves(&hanging);
        assert!((angle(&arms.pose(&hanging, 1.0)) - STANCE).abs() < 1e-9);
        assert!((angle(&arms.pose(&hanging, 0.0)) - 0.1).abs() < 1e-9, "they come down");
        let apart = body(Vec3::new(0.6, -0.8, 0.0));
        assert_eq!(RaisedArms::in_sleeves(&apart).share, 0.0);
    }

    #[test]
    fn points_within_are_led_to_the_scaled_ellipse() {
        let axis = cylinder();
        let p = axis.led_out(Vec3::new(0.05, 0.5, 0.0), 0.5, 0.0).expect("inside");
        assert!((p - Vec3::new(0.1, 0.5, 0.0)).norm() < 1e-12, "{p:?}");
        let p = axis.led_out(Vec3::new(0.0, 0.5, -0.05), 1.0, 0.01).expect("inside");
        assert!((p - Vec3::new(0.0, 0.5, -0.11)).norm() < 1e-12, "{p:?}");
        assert!(axis.led_out(Vec3::new(0.15, 0.5, 0.0), 0.5, 0.0).is_none());
    }
}
