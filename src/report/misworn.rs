//! Openings at which the garment is not worn where it belongs. Topology, sizes and the words of `place` decide. Names
//! of pieces and edges play no part.

use std::f64::consts::PI;

use super::measured::Measured;
use super::openings::SewnRim;
use super::ring::{FlatCloth, FlatRing};
use super::schema::{Fault, FaultKind};
use super::seen::Seen;
use crate::geometry::{DisjointSets, MM, range_of};
use crate::mannequin::PartKind;
use crate::pattern::{Place, TrunkLevel};
use crate::verify::{Passage, Through, Welded, is_dealt};

/// Largest relative difference of the lengths, and of the areas of the pieces, of two openings that are a pair. Pieces
/// cut as a pair are alike within rounding.
const ALIKE: f64 = 0.01;

/// A rim that turns by less than this towards its cloth or away from it, radians, ends a tube: half-way between a tube
/// and a hole, and between a tube and the rim of a sheet.
const TUBE: f64 = PI;

/// A hole is no slit from this share of a circle's area on.
const ROUND: f64 = 0.3;

/// An arm goes through an opening of this share of its largest girth: cloth gives.
const GIVES: f64 = 0.9;

/// Largest descent of the opening that holds a garment while it drapes, metres.
const SETTLES: f64 = 0.08;

/// Largest distance from the waist of pieces placed by `waist`, metres.
const AT_WAIST: f64 = 0.07;

/// Least height over the waist that pieces placed by `torso` or `chest` reach, metres.
const ABOVE_WAIST: f64 = 0.05;

/// The openings of a garment in its states.
pub(super) struct Wear<'a> {
    run: &'a Measured<'a>,
    welded: &'a Welded,
    openings: Vec<&'a SewnRim>,
    names: &'a [String],
    /// As the garment was put on, if that is known.
    placed: Option<&'a [Seen]>,
    /// After sewing, if it has been draped since.
    sewn: Option<&'a [Seen]>,
    now: &'a [Seen],
    flat: Vec<FlatRing>,
    /// For every opening, the part of the garment that it is of.
    part: Vec<u32>,
    /// For every particle the same.
    part_of: Vec<u32>,
}

impl<'a> Wear<'a> {
    pub(super) fn new(
        run: &'a Measured<'a>,
        welded: &'a Welded,
        openings: Vec<&'a SewnRim>,
        names: &'a [String],
        [placed, sewn]: [Option<&'a [Seen]>; 2],
        now: &'a [Seen],
    ) -> Self {
        let cloth = FlatCloth::new(run.mesh, welded);
        let flat = openings.iter().map(|o| cloth.ring(&o.ring)).collect();
        let parts = parts(run, welded);
        let part = openings.iter().map(|o| parts[o.ring[0] as usize]).collect();
        let part_of = welded.vertex_of.iter().map(|&v| parts[v as usize]).collect();
        Self { run, welded, openings, names, placed, sewn, now, flat, part, part_of }
    }

    /// The fault of every opening. On a body without a torso nothing can be judged.
    pub(super) fn faults(&self) -> Vec<Option<Fault>> {
        if self.run.body.part(PartKind::Torso).is_none() {
            let text = "the body has no torso that the garment could be worn on".to_owned();
            return vec![Some(Fault { kind: FaultKind::Unknown, text }); self.openings.len()];
        }
        let level = self.levels();
        let fault = |(k, level): (usize, Option<Fault>)| {
            self.lost(k).or_else(|| self.empty(k)).or_else(|| self.askew(k)).or_else(|| self.slid(k)).or(level)
        };
        level.into_iter().enumerate().map(fault).collect()
    }

    /// Openings of the same part of the garment, itself among them.
    fn together(&self, k: usize) -> impl Iterator<Item = usize> {
        (0..self.openings.len()).filter(move |&j| self.part[j] == self.part[k])
    }

    /// An opening that another part of the body passes through than before, or none.
    fn lost(&self, k: usize) -> Option<Fault> {
        let dealt = |placed: &&[Seen]| {
            let passages: Vec<&Passage> = self.together(k).map(|j| &placed[j].passage).collect();
            is_dealt(&passages, self.run.body)
        };
        let states = [("put on", self.placed.filter(dealt)), ("sewn", self.sewn)];
        let (stage, before) = states.iter().find_map(|(stage, seen)| {
            let before = &seen.as_ref()?[k];
            let other = before.passage.ends != self.now[k].passage.ends;
            (other && before.passage.through.is_some() && !self.has_fallen_back(k, before)).then_some((stage, before))
        })?;
        let text = format!(
            "was round {} when it was {stage}, at a height of {:.0} mm, and is round {}, at {:.0} mm: nothing \
             holds it there",
            part_name(before),
            before.height * MM,
            part_name(&self.now[k]),
            self.now[k].height * MM
        );
        Some(Fault { kind: FaultKind::Lost, text })
    }

    /// An opening that nothing passes through, and that is no slit, keyhole, vent or rim of an open piece.
    fn empty(&self, k: usize) -> Option<Fault> {
        if !self.is_empty(k) || self.is_face(k) || self.is_bag(k) {
            return None;
        }
        let text = if self.together(k).all(|j| self.is_empty(j)) {
            // A single rim is that of an open piece: a cape, a scarf.
            (self.together(k).count() > 1).then(|| "nothing passes through it".to_owned())
        } else if let Some(worn) = self.pair(k).filter(|&j| !self.is_empty(j)) {
            let (other, part) = (&self.names[worn], part_name(&self.now[worn]));
            Some(format!("nothing passes through it, and {part} through '{other}', which is its pair"))
        } else if self.flat[k].turning.abs() < TUBE {
            Some("nothing passes through it, and it is the end of a tube".to_owned())
        } else {
            self.is_armhole(k)
                .then(|| "nothing passes through it, and it is one of a pair as wide as an arm".to_owned())
        };
        Some(Fault { kind: FaultKind::Empty, text: text? })
    }

    /// Whether an empty opening is the seam round a bag of a part of the garment that is worn elsewhere.
    fn is_bag(&self, k: usize) -> bool {
        self.flat[k].is_sewn && !self.together(k).all(|j| self.is_empty(j))
    }

    fn is_empty(&self, k: usize) -> bool {
        self.now[k].passage.through.is_none()
    }

    /// Whether an opening is the face of a hood that lies over the end of the neck: with the head in it, and not
    /// without, each end of the body is beyond one opening of this part of the garment.
    fn is_face(&self, k: usize) -> bool {
        let face = Passage { through: None, ends: self.with_head(k) };
        let passages: Vec<&Passage> = self.together(k).map(|j| &self.now[j].passage).collect();
        let with_face: Vec<&Passage> =
            self.together(k).map(|j| if j == k { &face } else { &self.now[j].passage }).collect();
        !is_dealt(&passages, self.run.body) && is_dealt(&with_face, self.run.body)
    }

    /// Whether an opening is the face of a hood that stood up over the end of the neck, and has fallen off it since: no
    /// mannequin has a head that would hold it up.
    fn has_fallen_back(&self, k: usize, before: &Seen) -> bool {
        let end_of_neck = self.run.body.part(PartKind::Neck).and_then(|neck| neck.sections.last());
        let stood = if self.is_empty(k) {
            end_of_neck.is_some_and(|end| before.height > end.center.y)
        } else {
            // The rim of an open front goes round the face and down to the hem.
            self.part_alike(&before.passage.ends, &self.with_head(k))
        };
        self.is_face(k) && stood
    }

    /// The ends of the body on one side of an opening, with the head on the other side than it is now.
    fn with_head(&self, k: usize) -> Vec<PartKind> {
        let mut ends = self.now[k].passage.ends.clone();
        match ends.iter().position(|part| *part == PartKind::Neck) {
            Some(at) => drop(ends.remove(at)),
            None => ends.push(PartKind::Neck),
        }
        ends
    }

    /// Whether two groups of ends part the body alike: they are one group, or each other's rest.
    fn part_alike(&self, one: &[PartKind], other: &[PartKind]) -> bool {
        let ends = self.run.body.parts.iter().map(|part| part.kind).filter(|kind| *kind != PartKind::Torso);
        let in_both: Vec<bool> = ends.map(|end| one.contains(&end) == other.contains(&end)).collect();
        in_both.iter().all(|both| *both) || !in_both.contains(&true)
    }

    /// The other one of a pair: as long, and of pieces as large.
    fn pair(&self, k: usize) -> Option<usize> {
        let near = |a: f64, b: f64| (a - b).abs() <= ALIKE * a.max(b);
        let areas = |j: usize| self.openings[j].areas.as_slice();
        let alike = |&j: &usize| {
            let pieces = areas(j).len() == areas(k).len() && areas(j).iter().zip(areas(k)).all(|(&a, &b)| near(a, b));
            j != k && pieces && near(self.flat[j].length, self.flat[k].length)
        };
        (0..self.openings.len()).find(alike)
    }

    /// Whether an empty opening is one of two that are round, and wide enough for an arm, of a part of the garment that
    /// goes round the trunk and both arms.
    fn is_armhole(&self, k: usize) -> bool {
        let arms = self.run.body.parts.iter().filter(|part| part.kind.is_arm());
        let girth = arms.flat_map(|arm| &arm.sections).map(|s| s.girth).fold(0.0, f64::max);
        let has_room = |j: usize| self.flat[j].length >= GIVES * girth && self.flat[j].roundness >= ROUND;
        let passes_arm = |j: usize| matches!(self.now[j].passage.through, Some(Through::Part(part)) if part.is_arm());
        girth > 0.0
            && has_room(k)
            && self.pair(k).is_some_and(|j| self.part[j] == self.part[k] && self.is_empty(j))
            && !self.together(k).any(passes_arm)
    }

    /// An opening that is the same on the left and the right, with one arm or leg in it alone.
    fn askew(&self, k: usize) -> Option<Fault> {
        let Some(Through::Part(part)) = self.now[k].passage.through else { return None };
        let text =
            || format!("is the same on the left and the right, and only {} passes through it", part_name(&self.now[k]));
        let is_askew = self.openings[k].is_symmetric && (part.is_arm() || part.is_leg());
        is_askew.then(|| Fault { kind: FaultKind::Askew, text: text() })
    }

    /// Fault of an opening that hung on the body when it was sewn and has slid down since.
    fn slid(&self, k: usize) -> Option<Fault> {
        let text = self.fallen(k).or_else(|| {
            let sewn = &self.sewn?[k];
            // What hangs from the highest point of an open piece falls without it.
            let gone = if self.together(k).count() == 1 {
                sewn.top - self.now[k].top
            } else {
                sewn.along() - self.now[k].along()
            };
            (self.holds(k) && gone > SETTLES).then(|| {
                format!(
                    "has slid down by {:.0} mm since it was sewn, to a height of {:.0} mm: nothing holds it on {}",
                    gone * MM,
                    self.now[k].height * MM,
                    part_name(&self.now[k])
                )
            })
        })?;
        Some(Fault { kind: FaultKind::Slid, text })
    }

    /// Whether an opening is the highest of its part of the garment that something passes through.
    fn holds(&self, k: usize) -> bool {
        let above = |&j: &usize| j != k && !self.is_empty(j) && self.now[j].height > self.now[k].height;
        !self.is_empty(k) && !self.together(k).any(|j| above(&j))
    }

    /// A part of the garment that is round both legs alone, below the crotch, or that has a crotch of its own and is
    /// not drawn up to the body's.
    fn fallen(&self, k: usize) -> Option<String> {
        let legs = |j: usize| self.now[j].passage.through == Some(Through::Legs);
        let one_leg = |&j: &usize| matches!(self.now[j].passage.through, Some(Through::Part(part)) if part.is_leg());
        if let Some(leg) = self.together(k).find(one_leg).filter(|_| self.holds(k) && legs(k)) {
            return Some(format!(
                "is round both legs, at a height of {:.0} mm, and one leg alone passes through '{}': it is not drawn \
                 up to the trunk",
                self.now[k].height * MM,
                self.names[leg]
            ));
        }
        let crotch = self.run.body.part(PartKind::Torso)?.sections.first()?.center.y;
        (self.together(k).all(legs) && self.highest(self.part[k]) < crotch).then(|| {
            format!(
                "is round the legs, at a height of {:.0} mm: nothing holds it on the trunk",
                self.now[k].height * MM
            )
        })
    }

    /// Whether the part of the garment with this opening is round the neck or an arm: then its pattern alone decides
    /// how far down a band reaches, and how high up a skirt begins.
    fn hangs_from_shoulders(&self, k: usize) -> bool {
        let holds = |part: PartKind| part == PartKind::Neck || part.is_arm();
        self.together(k).any(|j| matches!(self.now[j].passage.through, Some(Through::Part(part)) if holds(part)))
    }

    /// The highest point of a part of the garment.
    fn highest(&self, part: u32) -> f64 {
        let heights = self.welded.vertex_of.iter().zip(&self.part_of).filter(|(_, own)| **own == part);
        heights.map(|(&v, _)| self.welded.surface.vertices[v as usize].y).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Faults of pieces at another height of the trunk than their place says, each at the opening that holds their part
    /// of the garment.
    fn levels(&self) -> Vec<Option<Fault>> {
        let mut out = vec![None; self.openings.len()];
        let torso = self.run.body.part(PartKind::Torso);
        let mark = |name: &str| torso?.landmarks.iter().find(|(n, _)| n == name).map(|(_, p)| p.y);
        let (Some(waist), bust) = (mark("waist"), mark("bust")) else { return out };
        for (piece, mesh) in self.run.garment.pieces.iter().zip(&self.run.mesh.pieces) {
            let Some(Place::Around { words }) = &piece.place else { continue };
            let Some(level) = words.iter().find_map(|word| word.level()) else { continue };
            let part = self.part_of[mesh.particles.start];
            let Some(k) = (0..out.len()).find(|&k| self.part[k] == part && self.holds(k)) else { continue };
            let heights = mesh.particles.clone().map(|p| self.welded.vertex_of[p] as usize);
            let [low, high] = range_of(heights.map(|v| self.welded.surface.vertices[v].y));
            let text = match (level, bust) {
                (TrunkLevel::Waist, _) if high < waist - AT_WAIST && self.hangs_from_shoulders(k) => continue,
                (TrunkLevel::Hip, _) if self.hangs_from_shoulders(k) => continue,
                (TrunkLevel::Waist, _) if low > waist + AT_WAIST || high < waist - AT_WAIST => {
                    let off = (if high < waist { waist - high } else { low - waist }) * MM;
                    let side = if high < waist { "below" } else { "above" };
                    format!("'{}' is placed by the waist and lies {off:.0} mm {side} it", piece.name)
                }
                (TrunkLevel::Hip, Some(bust)) if high > 0.5 * (waist + bust) => {
                    let off = (high - waist) * MM;
                    format!("'{}' is placed by the hips and reaches {off:.0} mm above the waist", piece.name)
                }
                (TrunkLevel::Chest, _) if self.highest(part) < waist + ABOVE_WAIST => {
                    let off = (self.highest(part) - waist) * MM;
                    format!(
                        "'{}' is placed by the trunk, and the garment reaches up to {off:.0} mm above the waist",
                        piece.name
                    )
                }
                _ => continue,
            };
            out[k].get_or_insert(Fault { kind: FaultKind::Level, text });
        }
        out
    }
}

/// `the left arm`, `nothing`.
fn part_name(seen: &Seen) -> String {
    seen.passage.through.map_or_else(|| "nothing".into(), |part| format!("the {}", part.name()))
}

/// A label per vertex of the surface, the same for cloth that seams or closures hold together.
fn parts(run: &Measured, welded: &Welded) -> Vec<u32> {
    let mut sets = DisjointSets::new(welded.surface.vertices.len());
    for &[a, b, c] in &welded.surface.triangles {
        sets.join(a, b);
        sets.join(b, c);
    }
    for tack in run.garment.closures.iter().flat_map(|closure| &closure.tacks) {
        let [a, b] = tack.map(|(piece, at)| run.mesh.nearest(piece, at).map(|p| welded.vertex_of[p]));
        if let Some((a, b)) = a.zip(b) {
            sets.join(a, b);
        }
    }
    (0..welded.surface.vertices.len() as u32).map(|v| sets.root(v)).collect()
}
