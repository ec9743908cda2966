//! A body part as stations along its axis, downward or outward.

use super::ellipse::Ellipse;
use crate::geometry::{TriMesh, Vec3, range_of};
use crate::mannequin::{BodyPart, Mannequin, PartKind, Section};

/// Over this height above the ankles the ring round both legs widens to the feet, metres.
const INSTEP: f64 = 0.12;

/// A cross-section with the frame that rows are bent in.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyStation {
    pub(super) center: Vec3,
    /// Where a row's front middle goes: forward for the trunk, outward for an arm.
    pub(super) front: Vec3,
    /// To the right of somebody who looks at that middle from outside.
    pub(super) right: Vec3,
    pub(super) half_width: f64,
    pub(super) half_depth: f64,
}

/// Stations of one part; the coordinate grows downward on trunk and neck (it is −y) and outward along an arm.
#[derive(Clone)]
pub(super) struct Stations {
    part: PartKind,
    list: Vec<(f64, BodyStation)>,
    landmarks: Vec<(String, f64)>,
}

impl Stations {
    /// `None` when the body has no such part.
    pub(super) fn new(body: &Mannequin, part: PartKind) -> Option<Self> {
        let own = body.part(part)?;
        let mut list = match part {
            PartKind::Torso | PartKind::Neck => {
                let mut list: Vec<(f64, BodyStation)> =
                    own.sections.iter().map(|s| (-s.center.y, upright(s))).collect();
                if part == PartKind::Torso
                    && let (Some(left), Some(right)) = (body.part(PartKind::LeftLeg), body.part(PartKind::RightLeg))
                {
                    list.extend(both_legs([left, right], &list, &body.mesh));
                }
                list
            }
            _ => along_limb(own, part),
        };
        list.sort_by(|a, b| a.0.total_cmp(&b.0));
        let landmarks = own.landmarks.iter().map(|(n, p)| (n.to_lowercase(), -p.y)).collect();
        (!list.is_empty()).then_some(Self { part, list, landmarks })
    }

    /// Coordinate of the end where rows begin: the neck side of the trunk, the shoulder end of an arm,
    /// the foot of the neck.
    pub(super) fn low(&self) -> f64 {
        let end = if self.part == PartKind::Neck { self.list.len() - 1 } else { 0 };
        self.list[end].0
    }

    /// Coordinate of the first landmark that the part has: of that name, or with it in its own.
    pub(super) fn landmark(&self, names: &[&str]) -> Option<f64> {
        let called = |n: &&str| self.landmarks.iter().find(|l| l.0 == **n);
        let like = |n: &&str| self.landmarks.iter().find(|l| l.0.contains(*n));
        names.iter().find_map(called).or_else(|| names.iter().find_map(like)).map(|l| l.1)
    }

    /// Coordinate of the place at this height, straight on beyond the ends.
    pub(super) fn at_height(&self, y: f64) -> f64 {
        let n = self.list.len();
        if n == 1 {
            return self.list[0].0;
        }
        let height = |k: usize| self.list[k].1.center.y;
        // Downward from station to station, as limbs and trunks do.
        let k = (1..n - 1).find(|&k| height(k) < y).unwrap_or(n - 1);
        let fall = height(k - 1) - height(k);
        let share = if fall.abs() > 1e-9 { (height(k - 1) - y) / fall } else { 0.0 };
        self.list[k - 1].0 + share * (self.list[k].0 - self.list[k - 1].0)
    }

    /// The station at a coordinate, linear between sections, straight on beyond the ends.
    pub(super) fn at(&self, s: f64) -> BodyStation {
        let n = self.list.len();
        if n == 1 {
            return self.list[0].1;
        }
        let k = self.list.partition_point(|e| e.0 <= s).clamp(1, n - 1);
        let ((s0, a), (s1, b)) = (self.list[k - 1], self.list[k]);
        let t = if s1 > s0 { (s - s0) / (s1 - s0) } else { 0.0 };
        let inside = t.clamp(0.0, 1.0);
        let mix = |x: f64, y: f64| x + (y - x) * inside;
        let mut out = if inside < 0.5 { a } else { b };
        out.half_width = mix(a.half_width, b.half_width);
        out.half_depth = mix(a.half_depth, b.half_depth);
        // The centre goes straight on; upright parts only change their height there.
        out.center = a.center + (b.center - a.center) * inside;
        let beyond = (t - inside) * (s1 - s0);
        let down = out.right.cross(&out.front);
        out.center += down * beyond;
        out
    }
}

impl BodyStation {
    /// Length of a ring that stays `clearance` metres off the section.
    pub(super) fn perimeter(&self, clearance: f64) -> f64 {
        Ellipse::new(self.half_width + clearance, self.half_depth + clearance).perimeter
    }

    /// The point at a share of the ring, `outward` metres off it.
    pub(super) fn point(&self, ellipse: &Ellipse, share: f64, outward: f64) -> Vec3 {
        let (p, n) = ellipse.at(share);
        self.center + self.right * (p[0] + outward * n[0]) + self.front * (p[1] + outward * n[1])
    }

    /// Angle of a point round the axis, radians from the front towards the right-hand side seen from outside.
    pub(super) fn angle(&self, p: Vec3) -> f64 {
        let d = p - self.center;
        d.dot(&self.right).atan2(d.dot(&self.front))
    }
}

/// A section of the trunk or the neck as a station: rows begin at its front.
fn upright(s: &Section) -> BodyStation {
    BodyStation {
        center: s.center,
        front: Vec3::z(),
        right: Vec3::x(),
        half_width: s.half_width,
        half_depth: s.half_depth,
    }
}

/// Below the crotch the trunk's ring goes round both legs, and round the feet where the body has any.
fn both_legs(legs: [&BodyPart; 2], trunk: &[(f64, BodyStation)], body: &TriMesh) -> Vec<(f64, BodyStation)> {
    let lowest = trunk.iter().map(|s| s.0).fold(f64::NEG_INFINITY, f64::max);
    let ankle = legs.iter().flat_map(|leg| &leg.sections).map(|s| s.center.y).fold(f64::INFINITY, f64::min);
    // How far the feet reach back and forward.
    let feet = range_of(body.vertices.iter().filter(|v| v.y < ankle).map(|v| v.z));
    let [left, right] = legs.map(|leg| leg.sections.iter());
    left.zip(right)
        .filter(|(s, _)| -s.center.y > lowest)
        .map(|(s, other)| {
            let share = (1.0 - (s.center.y - ankle) / INSTEP).clamp(0.0, 1.0);
            let (low, high) = (s.center.z - s.half_depth, s.center.z + s.half_depth);
            // Without feet the share of nothing is nothing.
            let back = if feet[0] < low { low + share * (feet[0] - low) } else { low };
            let front = if feet[1] > high { high + share * (feet[1] - high) } else { high };
            // From the right side of one to the left side of the other, wherever the body stands.
            let sides = [other.center.x - other.half_width, s.center.x + s.half_width];
            let center = Vec3::new(0.5 * (sides[0] + sides[1]), s.center.y, 0.5 * (back + front));
            let (half_width, half_depth) = (0.5 * (sides[1] - sides[0]), 0.5 * (front - back));
            (-s.center.y, BodyStation { center, front: Vec3::z(), right: Vec3::x(), half_width, half_depth })
        })
        .collect()
}

/// Stations along a limb, from the trunk outward: a row's front middle goes to the side away from the other limb.
fn along_limb(part: &BodyPart, kind: PartKind) -> Vec<(f64, BodyStation)> {
    let sideways = if matches!(kind, PartKind::LeftArm | PartKind::LeftLeg) { Vec3::x() } else { -Vec3::x() };
    let mut out = Vec::new();
    let mut s = 0.0;
    for (i, section) in part.sections.iter().enumerate() {
        if i > 0 {
            s += (section.center - part.sections[i - 1].center).norm();
        }
        let d = section.axis;
        let front = (sideways - d * d.dot(&sideways)).try_normalize(1e-9).unwrap_or(sideways);
        let right = front.cross(&d);
        let (half_width, half_depth) = (section.half_depth, section.half_width);
        out.push((s, BodyStation { center: section.center, front, right, half_width, half_depth }));
    }
    out
}
