//! The form that the cloth takes: the body with ease, its hollows spanned.
//!
//! Cloth goes round the trunk and the legs as a tape does: along the convex hull of every level. The hull moved out by
//! d all round is longer by 2πd exactly, so that d is the ease over 2π. Above the armpits and at the crotch, where no
//! tape goes round, the skin is moved out along its normals.

use std::f64::consts::TAU;

use crate::geometry::{Vec2, Vec3, bisect, distance_to_segment, half_hull, sides_of};
use crate::mannequin::{BodyPart, Mannequin, PartKind};

/// Distance between levels, metres.
const STEP: f64 = 0.010;
/// Height over which the spanned form goes over into the skin moved out, metres.
const RAMP: f64 = 0.04;
/// Width of a level over that of the trunk above which it has the arms in it.
const WITH_ARMS: f64 = 1.12;
/// Corrections of the ease by what a tape reads: the form has corners, and they take a little of it.
const ROUNDS: usize = 3;

/// How much longer the cloth is than the skin, by height.
#[derive(Clone, Debug)]
pub(super) struct ShellEase {
    /// The girth's name, its height and ease, metres; from below. Without names and heights in one of all.
    pub(super) stations: Vec<(String, f64, f64)>,
}

impl ShellEase {
    /// Distance from the skin at a height, metres.
    fn off(&self, y: f64) -> f64 {
        let at = self.stations.partition_point(|s| s.1 < y);
        let ease = match (at.checked_sub(1).and_then(|k| self.stations.get(k)), self.stations.get(at)) {
            (Some(a), Some(b)) => a.2 + (b.2 - a.2) * (y - a.1) / (b.1 - a.1),
            (Some(only), None) | (None, Some(only)) => only.2,
            (None, None) => 0.0,
        };
        ease / TAU
    }
}

/// The convex hull of a level.
struct HullLevel {
    y: f64,
    center: Vec2,
    hull: Vec<Vec2>,
}

impl HullLevel {
    fn of(body: &Mannequin, part: &BodyPart, y: f64) -> Option<Self> {
        let section = part.sections.iter().min_by(|a, b| (a.center.y - y).abs().total_cmp(&(b.center.y - y).abs()))?;
        let near = |middle: Vec3| (middle.x - section.center.x).abs() < 0.5 * section.half_width;
        let points = body.section_points(Vec3::new(0.0, y, 0.0), Vec3::y(), near);
        let flat: Vec<Vec2> = points.iter().map(|p| Vec2::new(p.x, p.z)).collect();
        let (low, high) =
            (flat.iter().copied().reduce(|a, b| a.inf(&b))?, flat.iter().copied().reduce(|a, b| a.sup(&b))?);
        let has_arms = part.kind == PartKind::Torso && high.x - low.x > WITH_ARMS * 2.0 * section.half_width;
        (!has_arms).then(|| Self { y, center: 0.5 * (low + high), hull: hull(flat) })
    }

    /// Where a ray from the middle leaves the hull moved out by `off`.
    fn out(&self, way: Vec2, off: f64) -> Vec2 {
        let far = |p: Vec2| {
            let inside = sides_of(&self.hull).all(|[a, b]| (b - a).perp(&(p - a)) >= 0.0);
            let least = sides_of(&self.hull).map(|side| distance_to_segment(p, side)).fold(f64::INFINITY, f64::min);
            if inside { -least } else { least }
        };
        /// Halvings of two metres to less than a nanometre.
        const HALVINGS: usize = 32;
        self.center + way * bisect([0.0, 2.0], HALVINGS, |reach| far(self.center + way * reach) - off)
    }
}

/// The convex hull, counter-clockwise.
fn hull(mut points: Vec<Vec2>) -> Vec<Vec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut out = half_hull(points.iter().copied());
    out.pop();
    out.extend(half_hull(points.iter().rev().copied()));
    out.pop();
    out.reverse();
    out
}

/// Levels of a part where a tape goes round it alone, from below.
fn levels(body: &Mannequin, part: &BodyPart) -> Vec<HullLevel> {
    let heights = || part.sections.iter().map(|s| s.center.y);
    let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(0.0, f64::max));
    let count = ((high - low) / STEP) as usize;
    let all = (0..=count).map(|k| low + STEP * k as f64);
    all.skip(1).map_while(|y| HullLevel::of(body, part, y)).collect()
}

/// The body as its clothes see it.
pub(super) fn shell(body: &Mannequin, ease: &ShellEase) -> Mannequin {
    let parts = body.parts.iter().filter(|p| p.kind == PartKind::Torso || p.kind.is_leg());
    let levels: Vec<(PartKind, Vec<HullLevel>)> = parts.map(|part| (part.kind, levels(body, part))).collect();
    let mut given = ease.clone();
    let mut out = moved(body, &levels, &given);
    for _ in 0..ROUNDS {
        for (station, wanted) in given.stations.iter_mut().zip(&ease.stations) {
            if let Some((was, now)) = tape(body, &station.0).zip(tape(&out, &station.0)) {
                station.2 += wanted.2 - (now - was);
            }
        }
        out = moved(body, &levels, &given);
    }
    out
}

/// Girth of a body at one of its landmarks, metres.
pub(super) fn tape(body: &Mannequin, girth: &str) -> Option<f64> {
    let part = body.parts.iter().find(|p| p.landmarks.iter().any(|l| l.0 == girth))?;
    let center = part.landmarks.iter().find(|l| l.0 == girth)?.1;
    let far = |s: &&crate::mannequin::Section| (s.center - center).norm();
    let section = part.sections.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
    let reach = section.half_width.max(section.half_depth);
    body.tape(center, section.axis, |middle| (middle - center).norm() < reach)
}

fn moved(body: &Mannequin, levels: &[(PartKind, Vec<HullLevel>)], ease: &ShellEase) -> Mannequin {
    let normals = body.mesh.vertex_normals();
    let mut out = body.clone();
    for (p, normal) in out.mesh.vertices.iter_mut().zip(normals) {
        let off = ease.off(p.y);
        let along = *p + normal * off;
        let kind = body.nearest_section(*p).map(|s| s.0);
        let own = levels.iter().find(|(of, levels)| Some(*of) == kind && levels.len() > 1);
        *p = match own.and_then(|(kind, levels)| spanned(*p, *kind, levels, off)) {
            Some((spanned, share)) => along.lerp(&spanned, share),
            None => along,
        };
    }
    out
}

/// A point moved out onto the spanned form, and the share of that in its place.
fn spanned(p: Vec3, kind: PartKind, levels: &[HullLevel], off: f64) -> Option<(Vec3, f64)> {
    let at = levels.partition_point(|l| l.y <= p.y);
    let (below, above) = (levels.get(at.checked_sub(1)?)?, levels.get(at)?);
    let t = (p.y - below.y) / (above.y - below.y);
    let middle = below.center.lerp(&above.center, t);
    let way = (Vec2::new(p.x, p.z) - middle).try_normalize(1e-9)?;
    let found = below.out(way, off).lerp(&above.out(way, off), t);
    let (low, high) = (levels.first()?.y, levels.last()?.y);
    let near = if kind == PartKind::Torso { (p.y - low).min(high - p.y) } else { high - p.y };
    let x = (near / RAMP).clamp(0.0, 1.0);
    Some((Vec3::new(found.x, p.y, found.y), x * x * (3.0 - 2.0 * x)))
}
