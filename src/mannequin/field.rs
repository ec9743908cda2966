//! The body as one smooth function of space: negative inside, about a distance near the surface.

use super::loft::{RowProfile, ellipse, perimeter};
use super::spec::{MannequinSpec, TorsoRow, UNIT};
use crate::geometry::{Vec3, bisect};

/// Reach of the blend of arm and trunk in the armpit, as a part of the arm's half width: small, or it would web the arm
/// to the torso.
const ARMPIT_BLEND: f64 = 0.25;
/// Blend of arm and trunk on the shoulder, as [`ARMPIT_BLEND`], where the deltoid runs into the trunk.
const SHOULDER_BLEND: f64 = 1.0;
/// Length of the rounded cap of the neck over the half axis that it closes.
const NECK_CAP: f64 = 0.5;
/// Length of the rounded cap of the wrist over the half axis that it closes.
const WRIST_CAP: f64 = 0.7;
/// Straight length of the arm beyond the row of the wrist, before the cap, in half widths of the wrist.
const WRIST_STUB: f64 = 0.5;
/// Length of the rounded cap of the foot over the half axis that it closes.
const FOOT_CAP: f64 = 0.4;
/// Extent of the torso below the row of the crotch, as a share of the height from crotch to hip. The two legs become
/// one trunk between there and the row of the hip, and the crotch comes out at its row.
const CROTCH_REACH: f64 = 0.1;

/// A convex section: half axes, exponent, and where it is cut.
#[derive(Clone, Copy)]
struct ConvexSection {
    a: f64,
    b: f64,
    n: f64,
    /// Half length of the cap beyond the end of the tube.
    cap: f64,
}

impl ConvexSection {
    /// Approximate distance from the skin of the point (u, v) across and `beyond` the tube's end. It is the section's
    /// own norm r (1 on the skin) scaled to a length that is exact along rays from the centre and smooth at the centre.
    fn distance(&self, u: f64, v: f64, beyond: f64) -> f64 {
        let (p, q) = ((u / self.a).abs(), (v / self.b).abs());
        let flat = if self.n == 2.0 { p * p + q * q } else { (p.powf(self.n) + q.powf(self.n)).powf(2.0 / self.n) };
        let r2 = flat + (beyond / self.cap).powi(2);
        let h = self.a.min(self.b);
        // At the centre the factor is h. From half of h outward it is nearly |p|/r.
        let scale = ((u * u + v * v + beyond * beyond + 0.25 * h * h) / (r2 + 0.25)).sqrt();
        (r2.sqrt() - 1.0) * scale
    }
}

/// The arm's axis and sections, left side.
pub(super) struct Arm {
    /// Start of the axis.
    pub(super) joint: Vec3,
    /// Along the axis, towards the wrist.
    pub(super) axis: Vec3,
    /// Across the axis in the plane of abduction, outward.
    pub(super) across: Vec3,
    /// Half axes (across, fore and aft) by distance from the joint.
    pub(super) profile: RowProfile<2>,
    /// Distance along the axis from the joint to the acromion's level (negative).
    pub(super) acromion: f64,
    depth_axis: Vec3,
}

impl Arm {
    fn new(spec: &MannequinSpec) -> Self {
        let arm = &spec.arm;
        let joint = Vec3::from(arm.joint) * UNIT;
        let (side, front) = (arm.abduction.to_radians(), arm.forward.to_radians());
        let axis = Vec3::new(side.sin(), -side.cos() * front.cos(), side.cos() * front.sin()).normalize();
        let across = (Vec3::x() - axis * axis.x).normalize();
        let acromion = (Vec3::from(arm.shoulder) * UNIT - joint).dot(&axis);
        let rows: Vec<_> =
            arm.rows.iter().map(|r| (r.at * UNIT + acromion, ellipse(r.girth * UNIT, arm.ratio))).collect();
        Self { joint, axis, across, profile: RowProfile::new(&rows), acromion, depth_axis: across.cross(&axis) }
    }

    fn distance(&self, p: Vec3) -> f64 {
        let q = p - self.joint;
        let t = q.dot(&self.axis);
        let [a, b] = self.profile.eval(t);
        let end = self.profile.end() + WRIST_STUB * a;
        let (beyond, cap) = if t < 0.0 { (-t, a) } else { ((t - end).max(0.0), WRIST_CAP * a) };
        ConvexSection { a, b, n: 2.0, cap }.distance(q.dot(&self.across), q.dot(&self.depth_axis), beyond)
    }
}

/// The body's surface is where [`BodyField::distance`] is zero.
pub(super) struct BodyField {
    /// (half width, z of the back, z of the front, exponent) by height. Back and front are lofted each for itself, so
    /// that the seat and the bust are as round as their own rows make them.
    torso: RowProfile<4>,
    /// (half width, half depth, x and z of the centre) by height.
    pub(super) leg: RowProfile<4>,
    pub(super) arm: Arm,
    /// Heights, metres.
    pub(super) crotch: f64,
    pub(super) hip: f64,
    pub(super) axilla: f64,
    pub(super) shoulder: f64,
    foot_cap: f64,
}

impl BodyField {
    /// From a checked spec.
    pub(super) fn new(spec: &MannequinSpec) -> Self {
        let torso: Vec<_> = spec
            .torso
            .iter()
            .map(|r| {
                let [a, b] = half_axes(r);
                (r.y * UNIT, [a, r.z * UNIT - b, r.z * UNIT + b, r.n])
            })
            .collect();
        let height = |name: &str| spec.torso_row(name).map_or(torso[0].0, |r| r.y * UNIT);
        let leg = leg_rows(spec);
        Self {
            leg: RowProfile::new(&leg),
            arm: Arm::new(spec),
            crotch: height("crotch"),
            hip: height("hip"),
            axilla: height("axilla"),
            shoulder: height("shoulder"),
            foot_cap: FOOT_CAP * leg[0].1[0],
            torso: RowProfile::new(&torso),
        }
    }

    /// Height of the trunk's last row.
    pub(super) fn neck_end(&self) -> f64 {
        self.torso.end()
    }

    /// Highest point.
    pub(super) fn top(&self) -> f64 {
        self.neck_end() + NECK_CAP * self.trunk_at(self.neck_end())[1]
    }

    /// The trunk's half width, half depth, exponent and z of the centre at a height.
    pub(super) fn trunk_at(&self, y: f64) -> [f64; 4] {
        let [a, back, front, n] = self.torso.eval(y);
        [a, 0.5 * (front - back), n, 0.5 * (front + back)]
    }

    /// A point inside the trunk, on the plane of symmetry.
    pub(super) fn inside(&self) -> Vec3 {
        Vec3::new(0.0, self.axilla, self.trunk_at(self.axilla)[3])
    }

    fn torso_distance(&self, p: Vec3) -> f64 {
        let [a, b, n, z] = self.trunk_at(p.y);
        ConvexSection { a, b, n, cap: NECK_CAP * b }.distance(p.x, p.z - z, (p.y - self.torso.end()).max(0.0))
    }

    fn leg_distance(&self, p: Vec3) -> f64 {
        let [a, b, x, z] = self.leg.eval(p.y);
        ConvexSection { a, b, n: 2.0, cap: self.foot_cap }.distance(p.x - x, p.z - z, (self.foot_cap - p.y).max(0.0))
    }

    /// Legs below, trunk above, and between crotch and hip a mixture: there the two sections have the same outline
    /// except between the legs, which fills up.
    fn trunk_distance(&self, p: Vec3) -> f64 {
        let low = self.crotch - CROTCH_REACH * (self.hip - self.crotch);
        let s = smoothstep(low, self.hip, p.y);
        if s == 0.0 {
            self.leg_distance(p)
        } else if s == 1.0 {
            self.torso_distance(p)
        } else {
            (1.0 - s) * self.leg_distance(p) + s * self.torso_distance(p)
        }
    }

    /// Negative inside, positive outside, roughly metres. Symmetric in x.
    pub(super) fn distance(&self, p: Vec3) -> f64 {
        let p = Vec3::new(p.x.abs(), p.y, p.z);
        let high = smoothstep(self.axilla, self.shoulder, p.y);
        let reach = self.arm.profile.eval(0.0)[0] * (ARMPIT_BLEND + (SHOULDER_BLEND - ARMPIT_BLEND) * high);
        smooth_union(self.trunk_distance(p), self.arm.distance(p), reach)
    }
}

/// Half width and half depth of a row, metres, scaled together to the measured girth.
fn half_axes(row: &TorsoRow) -> [f64; 2] {
    let scale = row.girth / perimeter(row.width / 2.0, row.depth / 2.0, row.n);
    [scale * row.width / 2.0 * UNIT, scale * row.depth / 2.0 * UNIT]
}

/// The leg's rows from the floor up. The topmost follows from the torso's crotch row: a tape round both legs reads
/// one leg's girth plus twice the distance of their centres, and both outer sides lie on the torso's.
fn leg_rows(spec: &MannequinSpec) -> Vec<(f64, [f64; 4])> {
    let mut rows: Vec<_> = spec
        .leg
        .rows
        .iter()
        .rev()
        .map(|r| {
            let [a, b] = ellipse(r.girth * UNIT, r.ratio);
            (r.y * UNIT, [a, b, r.x * UNIT, r.z * UNIT])
        })
        .collect();
    let crotch = &spec.torso[0];
    let x = spec.leg.crotch_x;
    let a = half_axes(crotch)[0] - x * UNIT;
    let b = ellipse_depth((crotch.girth - 4.0 * x) * UNIT, a);
    rows.push((crotch.y * UNIT, [a, b, x * UNIT, crotch.z * UNIT]));
    rows
}

/// The half depth that gives an ellipse of half width `a` that girth, which rises with the depth.
fn ellipse_depth(girth: f64, a: f64) -> f64 {
    bisect([0.0, girth / 4.0], 40, |depth| perimeter(a, depth, 2.0) - girth)
}

fn smoothstep(from: f64, to: f64, at: f64) -> f64 {
    let t = ((at - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The union of two bodies, rounded where their distances differ by less than `reach`. Untouched elsewhere.
fn smooth_union(a: f64, b: f64, reach: f64) -> f64 {
    let h = (1.0 - (a - b).abs() / reach).max(0.0);
    a.min(b) - 0.25 * reach * h * h
}
