//! Finds torso, neck, arms and legs of a body that nobody has labelled, well enough to wrap pieces round them.
//!
//! The body stands upright, its feet on y = 0, arms away from the trunk (hanging, A- or T-pose).

use super::slice::{Loop, slice, tape};
use super::{BodyPart, PartKind, Section};
use crate::geometry::{TriMesh, Vec3, range_of};

/// Distance between the horizontal cuts, metres.
const STEP: f64 = 0.02;
/// Largest height of a crotch, as a share of the body's height. Legs are searched below it.
const HIGHEST_CROTCH: f64 = 0.62;
/// Height below which the feet are, as a share of the body's height.
const ANKLE: f64 = 0.05;
/// Width of a trunk over that of its waist above which the cut contains the arms.
const ARMS_IN_CUT: f64 = 1.6;
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
struct Cut {
    y: f64,
    low: Vec3,
    high: Vec3,
    girth: f64,
}

impl Cut {
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
    let levels: Vec<(f64, Vec<Loop>)> = (1..(top / STEP) as usize)
        .map(|i| i as f64 * STEP)
        .map(|y| (y, slice(mesh, Vec3::new(0.0, y, 0.0), Vec3::y())))
        .collect();
    let middle = middle(&levels, top).ok_or("no trunk found at mid height")?;
    let trunk: Vec<Cut> = levels
        .iter()
        .filter_map(|(_, loops)| loops.iter().filter(|l| holds(l, middle)).max_by(by_width))
        .map(Cut::new)
        .collect();
    let crotch = crotch(&levels, middle, top).ok_or("no two legs found: the body must stand upright, y up")?;
    let trunk: Vec<Cut> = trunk.into_iter().filter(|c| c.y > crotch).collect();
    let neck = neck_base(&trunk).ok_or("no neck found above the shoulders")?;
    let side = trunk_side(&trunk[..neck], middle).ok_or("no trunk found between crotch and neck")?;
    let mut parts = vec![torso(&trunk[..neck], crotch, middle, side), neck_part(&trunk[neck - 1..])];
    for (kind, sign) in [(PartKind::LeftArm, 1.0), (PartKind::RightArm, -1.0)] {
        parts.push(arm(mesh, kind, &ArmSearch { trunk: &trunk[..neck], middle, side, sign, crotch })?);
    }
    for (kind, sign) in [(PartKind::LeftLeg, 1.0), (PartKind::RightLeg, -1.0)] {
        parts.push(leg(&levels, kind, crotch, middle, sign, top)?);
    }
    Ok(parts)
}

fn by_width(a: &&Loop, b: &&Loop) -> std::cmp::Ordering {
    (a.high.x - a.low.x).total_cmp(&(b.high.x - b.low.x))
}

/// The x coordinate of the trunk: the middle of the widest loop a little above the highest crotch.
fn middle(levels: &[(f64, Vec<Loop>)], top: f64) -> Option<f64> {
    let (_, loops) = levels.iter().find(|l| l.0 > HIGHEST_CROTCH * top)?;
    let depth = |l: &&Loop| (l.high.x - l.low.x).min(l.high.z - l.low.z);
    loops.iter().max_by(|a, b| depth(a).total_cmp(&depth(b))).map(|l| l.center().x)
}

/// Share of a loop's width by which it must reach to either side of the body's middle to contain it. Thighs that nearly
/// touch may have their gap a little beside the middle.
const HELD: f64 = 0.1;

/// Whether the middle of the body runs through a loop, rather than along its rim.
fn holds(l: &Loop, middle: f64) -> bool {
    (middle - l.low.x).min(l.high.x - middle) > HELD * (l.high.x - l.low.x)
}

/// The highest level at which no loop holds the middle and there is one on each side.
fn crotch(levels: &[(f64, Vec<Loop>)], middle: f64, top: f64) -> Option<f64> {
    let parted = |loops: &[Loop]| {
        let beside = |sign: f64| loops.iter().any(|l| sign * (l.center().x - middle) > 0.0);
        beside(1.0) && beside(-1.0) && !loops.iter().any(|l| holds(l, middle))
    };
    levels.iter().rev().find(|(y, loops)| *y < HIGHEST_CROTCH * top && parted(loops)).map(|l| l.0)
}

/// Index of the first cut of the neck, searched downward from the narrowest cut of the upper half without its very top.
fn neck_base(trunk: &[Cut]) -> Option<usize> {
    let (half, end) = (trunk.len() / 2, trunk.len().checked_sub(2)?);
    let narrowest = (half..end).min_by(|&a, &b| trunk[a].girth.total_cmp(&trunk[b].girth))?;
    let limit = NECK_FLARE * trunk[narrowest].girth;
    (half..=narrowest).rev().take_while(|&i| trunk[i].girth < limit).last().filter(|&i| i > 0)
}

/// Half width of the trunk where the arms leave it: the widest cut of the upper trunk that is not yet as wide as with
/// arms.
fn trunk_side(trunk: &[Cut], middle: f64) -> Option<f64> {
    let width = |c: &Cut| c.high.x - c.low.x;
    // The lower half holds the waist. The upper one narrows again at the neck.
    let narrowest = trunk[..trunk.len() / 2].iter().map(width).fold(f64::INFINITY, f64::min);
    trunk[trunk.len() / 2..]
        .iter()
        .take_while(|c| width(c) < ARMS_IN_CUT * narrowest)
        .map(|c| (c.high.x - middle).min(middle - c.low.x))
        .fold(None, |most, w| Some(most.map_or(w, |m: f64| m.max(w))))
}

fn torso(trunk: &[Cut], crotch: f64, middle: f64, side: f64) -> BodyPart {
    let clipped = |c: &Cut| {
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
fn neck_part(cuts: &[Cut]) -> BodyPart {
    let narrowest = (0..cuts.len()).min_by(|&a, &b| {
        // The very top of a head, or of a form without one, is no neck.
        let edge = |i: usize| i + 2 >= cuts.len();
        edge(a).cmp(&edge(b)).then(cuts[a].girth.total_cmp(&cuts[b].girth))
    });
    let end = (narrowest.unwrap_or(0) + 3).min(cuts.len());
    let sections: Vec<Section> = cuts[..end].iter().map(Cut::section).collect();
    let landmarks = vec![("neck base".to_owned(), sections[0].center)];
    BodyPart { kind: PartKind::Neck, sections, landmarks }
}

/// Inputs of the search for an arm.
struct ArmSearch<'a> {
    trunk: &'a [Cut],
    middle: f64,
    side: f64,
    sign: f64,
    crotch: f64,
}

impl ArmSearch<'_> {
    /// Whether a point lies beside the trunk: beyond the trunk's own cut at that height, or beyond its side where the
    /// arms are in the cut.
    fn beside(&self, p: &Vec3) -> bool {
        if p.y < self.crotch {
            return false;
        }
        let cut = self.trunk.iter().min_by(|a, b| (a.y - p.y).abs().total_cmp(&(b.y - p.y).abs()));
        let own = cut.map_or(self.side, |c| 0.5 * (c.high.x - c.low.x));
        // In the upper trunk the cut may hold the arms. Below it, the hips may be wider than the chest.
        let upper = self.trunk.get(self.trunk.len() / 2).is_some_and(|c| p.y > c.y);
        let limit = if upper { own.min(self.side) } else { own };
        self.sign * (p.x - self.middle) > limit + ARM_CLEARANCE
    }
}

fn arm(mesh: &TriMesh, kind: PartKind, search: &ArmSearch) -> Result<BodyPart, String> {
    let missing = || format!("no {kind:?} found beside the trunk: arms must stand off the body");
    let points: Vec<Vec3> = mesh.vertices.iter().copied().filter(|p| search.beside(p)).collect();
    let inner = points.iter().map(|p| search.sign * p.x).fold(f64::INFINITY, f64::min);
    let at_trunk: Vec<Vec3> = points
        .iter()
        .copied()
        .filter(|p| search.sign * p.x < inner + 2.0 * STEP && p.y > search.trunk[search.trunk.len() / 2].y)
        .collect();
    let shoulder = mean(&at_trunk).ok_or_else(missing)?;
    let reach = points.iter().map(|p| (p - shoulder).norm()).fold(0.0, f64::max);
    let near = |from: f64, to: f64| {
        let inside = |p: &&Vec3| {
            ((p.x - shoulder.x) * search.sign > 0.0) && { (from * reach..to * reach).contains(&(*p - shoulder).norm()) }
        };
        mean(&points.iter().filter(inside).copied().collect::<Vec<_>>())
    };
    let axis = (near(WRIST[0], WRIST[1]).ok_or_else(missing)? - shoulder).normalize();
    let across = (Vec3::x() * search.sign - axis * (axis.x * search.sign)).try_normalize(1e-6).unwrap_or(Vec3::y());
    let sections: Vec<Section> = (1..(reach / STEP) as usize)
        .filter_map(|i| limb_section(mesh, shoulder + axis * (i as f64 * STEP), axis, across))
        .collect();
    let sections = without_trunk(sections).ok_or_else(missing)?;
    let wrist = wrist(&sections).ok_or_else(missing)?;
    let sections = sections[..=wrist].to_vec();
    let mark = |name: &str, part: f64| (name.to_owned(), sections[(part * wrist as f64) as usize].center);
    let landmarks = vec![mark("shoulder", 0.0), mark("biceps", 0.22), mark("elbow", 0.5), mark("wrist", 1.0)];
    Ok(BodyPart { kind, sections, landmarks })
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

fn leg(
    levels: &[(f64, Vec<Loop>)],
    kind: PartKind,
    crotch: f64,
    middle: f64,
    sign: f64,
    top: f64,
) -> Result<BodyPart, String> {
    let mut sections: Vec<Section> = Vec::new();
    for (_, loops) in levels.iter().rev().filter(|l| l.0 <= crotch && l.0 >= ANKLE * top) {
        let own = loops.iter().filter(|l| sign * (l.center().x - middle) > 0.0);
        // Hands may hang beside the legs. The leg is nearer to the leg above it.
        let expected = sections.last().map_or(middle, |s| s.center.x);
        let Some(l) = own.min_by(|a, b| (a.center().x - expected).abs().total_cmp(&(b.center().x - expected).abs()))
        else {
            continue;
        };
        sections.push(Section { axis: -Vec3::y(), ..Cut::new(l).section() });
    }
    let last = sections.len().checked_sub(1).ok_or_else(|| format!("no {kind:?} found below the crotch"))?;
    let mark = |name: &str, part: f64| (name.to_owned(), sections[(part * last as f64) as usize].center);
    // The knee is a little below the middle of crotch and ankle.
    let landmarks = vec![mark("crotch", 0.0), mark("thigh", 0.08), mark("knee", 0.5), mark("ankle", 1.0)];
    Ok(BodyPart { kind, sections, landmarks })
}
