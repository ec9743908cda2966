//! Finds torso, neck, arms and legs of a body that nobody has labelled, well enough to wrap pieces round them.
//!
//! The body stands upright, its feet on y = 0, arms away from the trunk (hanging, A- or T-pose).

use super::label::{Labels, no_arm};
use super::slice::{Loop, slice, tape};
use super::{BodyPart, PartKind, Section};
use crate::geometry::{Topology, TriMesh, Vec3, range_of};

/// Distance between the horizontal cuts, metres.
const STEP: f64 = 0.02;
/// Height, metres, of the smallest body with cuts so far apart. Those of smaller ones are nearer by their height.
const SMALL: f64 = 0.9;
/// Height above every crotch, as a share of the body's height, where the trunk's middle is.
const WAIST: f64 = 0.62;
/// Height below which the feet are, as a share of the body's height.
const ANKLE: f64 = 0.05;
/// Width of the cut above the shoulders over that of the trunk between the armpits.
const SHOULDERS: f64 = 0.8;
/// Largest height of the narrowest cut of a neck above the shoulders, as a share of the body's height. Above it, a bun
/// of hair may be narrower.
const NECK: f64 = 0.1;
/// Girth over the smallest girth of the neck at which the neck ends, downward.
const NECK_FLARE: f64 = 1.25;
/// Distance from the trunk's side beyond which an arm begins, metres.
const ARM_CLEARANCE: f64 = 0.01;
/// Range of the wrist along an arm with its hand, as shares of its length.
const WRIST: [f64; 2] = [0.6, 0.85];
/// Length of a cut across an arm over that of the middle cut above which it runs through the trunk as well.
const TRUNK_IN_CUT: f64 = 1.7;
/// Girth of the hand over that of the wrist.
const HAND: f64 = 1.1;

/// A horizontal cut of the trunk.
#[derive(Clone, Copy)]
struct TrunkCut {
    y: f64,
    low: Vec3,
    high: Vec3,
    girth: f64,
}

impl TrunkCut {
    fn new(l: &Loop) -> Self {
        Self { y: l.low.y, low: l.low, high: l.high, girth: tape(&l.points, Vec3::x(), Vec3::z()) }
    }

    fn section(&self) -> Section {
        let half = 0.5 * (self.high - self.low);
        Section {
            center: 0.5 * (self.low + self.high),
            axis: Vec3::y(),
            half_width: half.x,
            half_depth: half.z,
            girth: self.girth,
        }
    }
}

/// Body parts of `mesh`, or the part that could not be found.
///
/// # Errors
/// A sentence naming the part that is missing.
pub fn find_parts(mesh: &TriMesh) -> Result<Vec<BodyPart>, String> {
    let top = mesh.vertices.iter().map(|p| p.y).fold(0.0, f64::max);
    let labels = Labels::new(mesh, &Topology::new(&mesh.triangles).edges, top)?;
    let step = STEP * scale(top);
    let levels: Vec<(f64, Vec<Loop>)> = (1..(top / step) as usize)
        .map(|i| i as f64 * step)
        .map(|y| (y, slice(mesh, Vec3::new(0.0, y, 0.0), Vec3::y())))
        .collect();
    let trunk: Vec<TrunkCut> = levels.iter().filter_map(|(y, loops)| trunk_cut(*y, loops, &labels)).collect();
    let waist = trunk.iter().find(|c| c.y > WAIST * top).ok_or("no trunk found at mid height")?;
    let middle = 0.5 * (waist.low.x + waist.high.x);
    let side = trunk_side(&trunk, middle, labels.armpit).ok_or("no trunk found between crotch and armpits")?;
    let neck = Neck::find(&trunk, labels.armpit, side, NECK * top).ok_or("no neck found above the shoulders")?;
    let above = &trunk[neck.base - 1..];
    let trunk = &trunk[..neck.base];
    let mut parts = vec![torso(trunk, labels.crotch, middle, side), neck_part(above, neck.narrowest + 1 - neck.base)];
    for (kind, sign) in [(PartKind::LeftArm, 1.0), (PartKind::RightArm, -1.0)] {
        let search = ArmSearch { trunk, middle, side, sign, kind, labels: &labels, scale: scale(top) };
        parts.push(search.arm(mesh)?);
    }
    for kind in [PartKind::LeftLeg, PartKind::RightLeg] {
        parts.push(leg(&levels, kind, &labels, ANKLE * top)?);
    }
    Ok(parts)
}

/// Share of the distances between cuts that is taken of a body of this height. A doll has no room for those of a child.
fn scale(top: f64) -> f64 {
    (top / SMALL).min(1.0)
}

fn by_width(a: &&Loop, b: &&Loop) -> std::cmp::Ordering {
    (a.high.x - a.low.x).total_cmp(&(b.high.x - b.low.x))
}

/// The cut of the trunk at height `y`, if there is one above the crotch.
fn trunk_cut(y: f64, loops: &[Loop], labels: &Labels) -> Option<TrunkCut> {
    let own = |l: &&Loop| l.edges.iter().any(|edge| labels.is_of_trunk(*edge, y));
    loops.iter().filter(|_| y > labels.crotch).filter(own).max_by(by_width).map(TrunkCut::new)
}

/// Where the neck is among the cuts of the trunk.
struct Neck {
    /// The first cut of it.
    base: usize,
    /// The narrowest.
    narrowest: usize,
}

impl Neck {
    /// Found downward from the narrowest cut, which is no more than `high` metres above the shoulders of a trunk with
    /// this half width at the `armpit`.
    fn find(trunk: &[TrunkCut], armpit: f64, side: f64, high: f64) -> Option<Self> {
        let width = |c: &TrunkCut| 0.5 * (c.high.x - c.low.x);
        let shoulders = trunk.iter().position(|c| c.y > armpit && width(c) < SHOULDERS * side)?;
        // The very top of a head, or of a form without one, is no neck unless that is short.
        let end = trunk.len().checked_sub(2)?.max(shoulders + 1);
        let within = (shoulders..end).take_while(|&i| trunk[i].y < trunk[shoulders].y + high);
        let narrowest = within.min_by(|&a, &b| trunk[a].girth.total_cmp(&trunk[b].girth))?;
        let limit = NECK_FLARE * trunk[narrowest].girth;
        let base = (trunk.len() / 2..=narrowest).rev().take_while(|&i| trunk[i].girth < limit).last()?;
        (base > 0).then_some(Self { base, narrowest })
    }
}

/// Half width of the trunk where the arms leave it: the widest cut between its waist and the lower `armpit`.
fn trunk_side(trunk: &[TrunkCut], middle: f64, armpit: f64) -> Option<f64> {
    // In the upper half of what is below the armpit. The hips are in the lower one.
    let below = &trunk[..trunk.iter().take_while(|c| c.y < armpit).count()];
    let half_width = |c: &TrunkCut| (c.high.x - middle).min(middle - c.low.x);
    below[below.len() / 2..].iter().map(half_width).reduce(f64::max)
}

fn torso(trunk: &[TrunkCut], crotch: f64, middle: f64, side: f64) -> BodyPart {
    let clipped = |c: &TrunkCut| {
        // Where arms are in the cut, the trunk ends at its own side.
        let mut section = c.section();
        if section.half_width > side && c.y > 0.5 * (crotch + trunk[trunk.len() - 1].y) {
            section.half_width = side;
            section.center.x = middle;
            section.girth = std::f64::consts::PI * (side + section.half_depth);
        }
        section
    };
    let sections: Vec<Section> = trunk.iter().map(clipped).collect();
    let mut landmarks = vec![("crotch".to_owned(), sections[0].center)];
    let n = sections.len();
    let girth = |i: &usize, j: &usize| sections[*i].girth.total_cmp(&sections[*j].girth);
    // A waist lies in the middle of the trunk, the hip below it and the bust above, under the arms.
    let waist = (n / 4..n / 2 + 1).min_by(girth).unwrap_or(0);
    let marks = [
        ("waist", Some(waist)),
        ("hip", (0..=waist).max_by(girth)),
        ("bust", (waist..(3 * n / 4).max(waist + 1)).max_by(girth)),
        ("shoulder", Some(n - 1)),
    ];
    landmarks.extend(marks.into_iter().filter_map(|(name, i)| Some((name.to_owned(), sections[i?].center))));
    BodyPart { kind: PartKind::Torso, sections, landmarks }
}

/// The neck, up to its narrowest cut and the two above.
fn neck_part(cuts: &[TrunkCut], narrowest: usize) -> BodyPart {
    let end = (narrowest + 3).min(cuts.len());
    let sections: Vec<Section> = cuts[..end].iter().map(TrunkCut::section).collect();
    let landmarks = vec![("neck base".to_owned(), sections[0].center)];
    BodyPart { kind: PartKind::Neck, sections, landmarks }
}

/// Inputs of the search for an arm.
struct ArmSearch<'a> {
    trunk: &'a [TrunkCut],
    middle: f64,
    side: f64,
    sign: f64,
    kind: PartKind,
    labels: &'a Labels,
    scale: f64,
}

impl ArmSearch<'_> {
    /// Whether a point lies beside the trunk: beyond the trunk's own cut at that height, or beyond its
    /// side where the arms are in the cut.
    fn is_beside(&self, p: &Vec3) -> bool {
        let cut = self.trunk.iter().min_by(|a, b| (a.y - p.y).abs().total_cmp(&(b.y - p.y).abs()));
        let own = cut.map_or(self.side, |c| 0.5 * (c.high.x - c.low.x));
        // In the upper trunk the cut may hold the arms. Below it, the hips may be wider than the chest.
        let upper = self.trunk.get(self.trunk.len() / 2).is_some_and(|c| p.y > c.y);
        let limit = if upper { own.min(self.side) } else { own };
        self.sign * (p.x - self.middle) > limit + ARM_CLEARANCE * self.scale
    }

    fn arm(&self, mesh: &TriMesh) -> Result<BodyPart, String> {
        let missing = || no_arm(self.kind);
        let neck = self.trunk.last().map_or(0.0, |c| c.y);
        let skin = mesh.vertices.iter().enumerate().filter(|(v, _)| self.labels.can_be_of(*v, neck, self.kind));
        let points: Vec<Vec3> = skin.map(|(_, p)| *p).filter(|p| self.is_beside(p)).collect();
        let step = STEP * self.scale;
        let inner = points.iter().map(|p| self.sign * p.x).fold(f64::INFINITY, f64::min);
        let at_trunk: Vec<Vec3> = points
            .iter()
            .copied()
            .filter(|p| self.sign * p.x < inner + 2.0 * step && p.y > self.trunk[self.trunk.len() / 2].y)
            .collect();
        let shoulder = mean(&at_trunk).ok_or_else(missing)?;
        let reach = points.iter().map(|p| (p - shoulder).norm()).fold(0.0, f64::max);
        let near = |from: f64, to: f64| {
            let inside = |p: &&Vec3| {
                ((p.x - shoulder.x) * self.sign > 0.0) && {
                    (from * reach..to * reach).contains(&(*p - shoulder).norm())
                }
            };
            mean(&points.iter().filter(inside).copied().collect::<Vec<_>>())
        };
        let axis = (near(WRIST[0], WRIST[1]).ok_or_else(missing)? - shoulder).normalize();
        let across = (Vec3::x() * self.sign - axis * (axis.x * self.sign)).try_normalize(1e-6).unwrap_or(Vec3::y());
        let sections: Vec<Section> = (1..(reach / step) as usize)
            .filter_map(|i| limb_section(mesh, shoulder + axis * (i as f64 * step), axis, across))
            .collect();
        let sections = without_trunk(sections).ok_or_else(missing)?;
        let wrist = wrist(&sections).ok_or_else(missing)?;
        let sections = sections[..=wrist].to_vec();
        let mark = |name: &str, part: f64| (name.to_owned(), sections[(part * wrist as f64) as usize].center);
        let landmarks = vec![mark("shoulder", 0.0), mark("biceps", 0.22), mark("elbow", 0.5), mark("wrist", 1.0)];
        Ok(BodyPart { kind: self.kind, sections, landmarks })
    }
}

/// The sections beyond the last one whose cut runs through the trunk as well.
fn without_trunk(arm: Vec<Section>) -> Option<Vec<Section>> {
    let mut girths: Vec<f64> = arm.iter().map(|s| s.girth).collect();
    girths.sort_by(f64::total_cmp);
    let limit = TRUNK_IN_CUT * *girths.get(girths.len() / 2)?;
    let first = arm.iter().rposition(|s| s.girth > limit).map_or(0, |i| i + 1);
    (arm.len() > first + 4).then(|| arm[first..].to_vec())
}

/// Index of the wrist: the narrowest section where it may lie, if a hand follows. Otherwise the arm's end.
fn wrist(arm: &[Section]) -> Option<usize> {
    let part = |p: f64| (p * arm.len() as f64) as usize;
    let narrowest = (part(WRIST[0])..part(WRIST[1])).min_by(|&a, &b| arm[a].girth.total_cmp(&arm[b].girth))?;
    let hand = arm[narrowest..].iter().any(|s| s.girth > HAND * arm[narrowest].girth);
    if hand { Some(narrowest) } else { arm.len().checked_sub(2) }
}

fn mean(points: &[Vec3]) -> Option<Vec3> {
    (!points.is_empty()).then(|| points.iter().sum::<Vec3>() / points.len() as f64)
}

/// The loop of a square cut that goes round `at`, if there is one no farther away than itself is wide.
fn limb_section(mesh: &TriMesh, at: Vec3, axis: Vec3, across: Vec3) -> Option<Section> {
    let along = axis.cross(&across);
    let found = slice(mesh, at, axis)
        .into_iter()
        .min_by(|a, b| (a.center() - at).norm().total_cmp(&(b.center() - at).norm()))?;
    let extent = |d: Vec3| range_of(found.points.iter().map(|p| p.dot(&d)));
    let (w, d) = (extent(across), extent(along));
    let center = found.center();
    if (center - at).norm() > (w[1] - w[0]).max(d[1] - d[0]) {
        return None;
    }
    Some(Section {
        center,
        axis,
        half_width: 0.5 * (w[1] - w[0]),
        half_depth: 0.5 * (d[1] - d[0]),
        girth: tape(&found.points, across, along),
    })
}

/// A leg from the crotch to the `ankle`.
fn leg(levels: &[(f64, Vec<Loop>)], kind: PartKind, labels: &Labels, ankle: f64) -> Result<BodyPart, String> {
    let of_leg = |l: &&Loop| l.edges.iter().any(|edge| labels.is_of_leg(*edge, kind));
    let below = levels.iter().rev().filter(|l| l.0 < labels.crotch && l.0 >= ankle);
    let cuts = below.filter_map(|(_, loops)| loops.iter().filter(of_leg).max_by(by_width));
    let sections: Vec<Section> = cuts.map(|l| Section { axis: -Vec3::y(), ..TrunkCut::new(l).section() }).collect();
    let last = sections.len().checked_sub(1).ok_or_else(|| format!("no {} found below the crotch", kind.name()))?;
    let mark = |name: &str, part: f64| (name.to_owned(), sections[(part * last as f64) as usize].center);
    // The knee is a little below the middle of crotch and ankle.
    let landmarks = vec![mark("crotch", 0.0), mark("thigh", 0.08), mark("knee", 0.5), mark("ankle", 1.0)];
    Ok(BodyPart { kind, sections, landmarks })
}
