//! Seams that pass the girths of the body on the draped garment.

use crate::geometry::{MM, Vec3};
use crate::mannequin::{BodyPart, Mannequin, PartKind};
use crate::pattern::{Garment, GarmentFile, Seam, SeamFile, SeamKind, Side};
use crate::pipeline::Job;
use crate::report::Girth;

/// Least |cosine| between a seam, from its start to its end as worn, and the axis of the body there: it runs along.
const ALONG: f64 = 0.5;
/// Share of a seam's length from an end within which the end itself is meant.
const AT_END: f64 = 0.08;

/// A seam that ends within this distance of a girth, metres, shapes it with its end: garments are measured just below
/// their armholes, where side seams begin.
const SHORT: f64 = 0.06;

/// A girth of the body on the garment: a plane.
pub(super) struct GirthPlane {
    /// Of the trunk or of a limb.
    part: PartKind,
    center: Vec3,
    axis: Vec3,
}

impl GirthPlane {
    /// The plane in which a girth was measured.
    pub(super) fn new(girth: &Girth, body: &Mannequin) -> Option<Self> {
        let sides =
            [("left ", [PartKind::LeftArm, PartKind::LeftLeg]), ("right ", [PartKind::RightArm, PartKind::RightLeg])];
        let limb = sides.into_iter().find_map(|(word, kinds)| Some((girth.name.strip_prefix(word)?, kinds)));
        let (name, kinds) = limb.unwrap_or((girth.name.as_str(), [PartKind::Torso, PartKind::Neck]));
        let has = |part: &BodyPart| part.landmarks.iter().find(|(own, _)| own == name).map(|(_, at)| *at);
        let (part, at) = kinds.into_iter().find_map(|kind| {
            let part = body.part(kind)?;
            Some((part, has(part)?))
        })?;
        let far = |section: &&crate::mannequin::Section| (section.center - at).norm();
        let axis = part.sections.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?.axis;
        // Of the trunk a garment may have been measured lower.
        let center = if limb.is_some() { at } else { Vec3::new(at.x, girth.height / MM, at.z) };
        Some(Self { part: part.kind, center, axis })
    }

    /// Whether cloth that is nearest to a part of the body may shape this girth. A skirt is nearer to the legs.
    fn has(&self, part: PartKind) -> bool {
        match self.part {
            PartKind::Torso | PartKind::Neck => !part.is_arm(),
            limb => part == limb,
        }
    }

    /// How far a point is beyond the plane, along the part.
    fn beyond(&self, p: Vec3) -> f64 {
        (p - self.center).dot(&self.axis)
    }

    /// How squarely a point lies at the side of the trunk: 1 at the side, 0 in front or behind. Anywhere on a limb.
    fn sideways(&self, p: Vec3) -> f64 {
        let off = p - self.center;
        let wide = off.x.hypot(off.z);
        if self.part == PartKind::Torso && wide > 0.0 { off.x.abs() / wide } else { 1.0 }
    }
}

/// A seam of the file where it passes a girth.
#[derive(Clone, Debug)]
pub(super) struct Passing {
    /// Its name.
    pub(super) seam: String,
    /// Share of the length of its first edge as drawn.
    pub(super) share: f64,
    /// How squarely it lies at the side, the least of its copies.
    pub(super) sideways: f64,
    /// Whether a copy lies on the wearer's left, and whether one lies on the right.
    pub(super) sides: [bool; 2],
}

/// The seams of a garment that run along the body and pass a girth, as they are worn at `at`.
pub(super) fn passing(plane: &GirthPlane, file: &GarmentFile, job: &Job, at: &[Vec3]) -> Vec<Passing> {
    file.seams.iter().filter(|seam| is_plain(seam)).filter_map(|seam| pass(plane, seam, job, at)).collect()
}

/// Whether a seam joins one whole edge to another, which can be taken in.
pub(super) fn is_plain(seam: &SeamFile) -> bool {
    let whole = |chain: &[crate::pattern::Located<String>]| chain.len() == 1 && !chain[0].value.contains('@');
    whole(&seam.sew) && whole(&seam.to)
}

/// Seams of a garment that come from one of its file.
fn copies<'a>(garment: &'a Garment, name: &'a str) -> impl Iterator<Item = (usize, &'a Seam)> {
    let is_copy = move |seam: &Seam| seam.kind == SeamKind::Written && Side::is_copy(&seam.name, name);
    garment.seams.iter().enumerate().filter(move |(_, seam)| is_copy(seam))
}

fn pass(plane: &GirthPlane, seam: &SeamFile, job: &Job, at: &[Vec3]) -> Option<Passing> {
    let name = seam.name.value.as_str();
    let mut found: Option<Passing> = None;
    for (k, copy) in copies(&job.garment, name) {
        let Some((share, point)) = crossing(plane, k, copy, job, at) else { continue };
        let passing = found.get_or_insert_with(|| Passing {
            seam: name.to_owned(),
            share: snapped(share),
            sideways: 1.0,
            sides: [false; 2],
        });
        passing.sideways = passing.sideways.min(plane.sideways(point));
        passing.sides[usize::from(point.x < plane.center.x)] = true;
    }
    found
}

fn snapped(share: f64) -> f64 {
    match share {
        s if s < AT_END => 0.0,
        s if s > 1.0 - AT_END => 1.0,
        s => s,
    }
}

/// Share of its first edge as drawn at which a seam passes the plane or nearly does, and where that is. `None` where it
/// does neither, or runs across.
fn crossing(plane: &GirthPlane, k: usize, seam: &Seam, job: &Job, at: &[Vec3]) -> Option<(f64, Vec3)> {
    let pairs = &job.mesh.seams.get(k)?.pairs;
    let line: Vec<u32> = pairs.iter().map(|pair| pair[0]).collect();
    let place = |n: u32| at[n as usize];
    let (first, last) = (place(*line.first()?), place(*line.last()?));
    let chord = (last - first).try_normalize(0.0)?;
    if chord.dot(&plane.axis).abs() < ALONG {
        return None;
    }
    // As drawn: where a dart is sewn shut, its mouth counts.
    let mut ends = vec![0.0];
    for step in line.windows(2) {
        let [a, b] = [step[0], step[1]].map(|n| job.mesh.flat[n as usize]);
        ends.push(ends[ends.len() - 1] + (b - a).norm());
    }
    let whole = ends[ends.len() - 1];
    let passes = line.windows(2).position(|step| {
        let [a, b] = [step[0], step[1]].map(|n| plane.beyond(place(n)));
        (a < 0.0) != (b < 0.0)
    });
    let near = |p: Vec3| plane.beyond(p).abs();
    let (step, share) = match passes {
        Some(step) => {
            let [a, b] = [line[step], line[step + 1]].map(|n| plane.beyond(place(n)));
            (step, a / (a - b))
        }
        None if near(first).min(near(last)) > SHORT => return None,
        None if near(first) <= near(last) => (0, 0.0),
        None => (line.len() - 2, 1.0),
    };
    let point = place(line[step]).lerp(&place(line[step + 1]), share);
    // At an armpit a side seam is nearer to the arm.
    let is_there = |p: Vec3| job.body.nearest_section(p).is_some_and(|(part, _)| plane.has(part));
    let most = || 2 * line.iter().filter(|n| is_there(place(**n))).count() >= line.len();
    if !is_there(point) && !most() {
        return None;
    }
    let along = (ends[step] + share * (ends[step + 1] - ends[step])) / whole;
    let span = seam.a.first()?;
    let edge = &job.garment.pieces[span.edge.piece].loops[span.edge.ring][span.edge.index];
    let as_drawn = (span.to > span.from) != edge.against;
    Some((if as_drawn { along } else { 1.0 - along }, point))
}
