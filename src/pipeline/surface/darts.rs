//! Parts laid flat, and darts where they are strained too much: one at a time,
//! the next always into the part that needs it most.

use std::path::Path;

use rayon::prelude::*;
use serde::Serialize;

use super::super::error::PipelineError;
use super::SurfaceOptions;
use super::cuts::{self, Marks};
use super::edges::breaks_of;
use super::parts::{Nodes, Part, parts};
use super::report::CutWhy;
use super::size::Space;
use crate::flatten::{FlattenError, Flattened, Mode, flatten_between, one_sided};
use crate::io::obj_read::ObjFaces;

/// A surface as it was read, to be cut and laid flat.
pub(super) struct Source<'a> {
    pub(super) file: &'a Path,
    pub(super) faces: &'a ObjFaces,
    pub(super) nodes: &'a Nodes,
    pub(super) space: Space,
    /// Name of what has none.
    pub(super) stem: &'a str,
    pub(super) options: &'a SurfaceOptions,
}

/// A part of the surface laid flat.
pub(super) struct Laid {
    /// Its place among all parts.
    number: usize,
    pub(super) part: Part,
    pub(super) flat: Flattened,
    /// Between which of its rim's vertices lengths were to stay.
    breaks: Vec<u32>,
    /// Where a dart would relieve it, rim first; empty where it is within the limit, or where no place can be told.
    pub(super) dart: Vec<u32>,
    /// Darts that were cut into it.
    pub(super) darts: usize,
    /// Why it got no more, where it is still beyond the limit.
    pub(super) stop: Option<DartStop>,
}

/// Why a part that is strained beyond the limit got no further dart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum DartStop {
    /// All that were allowed are cut.
    NoneLeft,
    /// With the next the flat piece would lie on itself, or more so.
    Overlap,
    /// Nothing says where the next would help: no place has cloth to spare.
    NoPlace,
}

/// A part that could not be laid flat.
pub(super) struct Failed {
    pub(super) part: Part,
    /// In the file's numbers, with where to cut if that is the remedy.
    pub(super) error: PipelineError,
}

/// All parts of a surface, each with its own outcome.
pub(super) struct Outcome {
    pub(super) laid: Vec<Laid>,
    pub(super) failed: Vec<Failed>,
}

impl Source<'_> {
    pub(super) fn parts(&self, marks: &Marks) -> Vec<Part> {
        parts(self.faces, self.nodes, &marks.edges, self.space, self.stem)
    }

    /// A part laid flat, `number` being its place among all parts.
    fn lay(&self, number: usize, part: Part, breaks: Vec<u32>) -> Result<Laid, Box<(Part, FlattenError)>> {
        if part.turned.is_none() {
            let error = FlattenError::OneSided(one_sided(&part.surface.triangles));
            return Err(Box::new((part, error)));
        }
        let flat = match flatten_between(&part.surface, &breaks, &self.options.flatten) {
            Ok(flat) => flat,
            Err(error) => return Err(Box::new((part, error))),
        };
        let strained = self.options.limit.passed(&flat.report);
        let dart = if strained { cuts::dart(&part, &flat) } else { Vec::new() };
        Ok(Laid { number, part, flat, breaks, dart, darts: 0, stop: None })
    }

    /// Lays all parts flat, each by itself. One that cannot be laid flat, or is strained beyond the limit, is cut where
    /// that is its remedy.
    fn lay_all(&self, marks: &mut Marks) -> Outcome {
        let parts = self.parts(marks);
        let breaks = breaks_of(&parts.iter().collect::<Vec<_>>());
        let numbered = parts.into_par_iter().enumerate().zip(breaks);
        let laid: Vec<_> = numbered.map(|((number, part), breaks)| self.lay(number, part, breaks)).collect();
        let mut out = Outcome { laid: Vec::new(), failed: Vec::new() };
        for (number, result) in laid.into_iter().enumerate() {
            match self.remedied(number, result, marks) {
                Ok(laid) => out.laid.push(laid),
                Err(failed) => {
                    let (part, error) = *failed;
                    out.failed.push(Failed { error: cuts::advise(self.file, &part, error), part });
                }
            }
        }
        out
    }

    /// A part, or that part cut where a cut is what it needs: from rim to rim where no flat piece has all its rims, and
    /// from the rim to its far end where it is too deep to be laid flat at all.
    fn remedied(
        &self,
        number: usize,
        whole: Result<Laid, Box<(Part, FlattenError)>>,
        marks: &mut Marks,
    ) -> Result<Laid, Box<(Part, FlattenError)>> {
        let part = match &whole {
            Ok(laid) => &laid.part,
            Err(failed) => &failed.0,
        };
        let ways = match &whole {
            Ok(laid) if !self.options.limit.passed(&laid.flat.report) => Vec::new(),
            Err(failed) if !matches!(failed.1, FlattenError::Breakdown | FlattenError::FlippedStart(_)) => Vec::new(),
            _ => {
                let between_rims = cuts::opening(part);
                if between_rims.is_empty() && whole.is_err() { vec![cuts::slit(part)] } else { between_rims }
            }
        };
        if ways.is_empty() {
            return whole;
        }
        let mut cut_marks = marks.clone();
        ways.iter().for_each(|way| cut_marks.cut(part, way, CutWhy::Auto));
        // A cut that opens a part leaves it whole, so that all parts keep their numbers.
        let mut parts = self.parts(&cut_marks);
        let breaks = breaks_of(&parts.iter().collect::<Vec<_>>()).swap_remove(number);
        match (self.lay(number, parts.swap_remove(number), breaks), whole) {
            (Ok(cut), Ok(whole)) if !is_worth_a_cut(&cut, &whole) => Ok(whole),
            (Ok(cut), _) => {
                *marks = cut_marks;
                Ok(cut)
            }
            (Err(_), whole) => whole,
        }
    }

    /// A part with its next dart, and the cuts that make it; `None` where it cannot be laid flat with it.
    fn with_next_dart(&self, own: &Laid, marks: &Marks) -> Option<(Laid, Marks)> {
        let mut marks = marks.clone();
        marks.cut(&own.part, &own.dart, CutWhy::Dart);
        // A dart ends inside its part and leaves it whole, so that all parts keep their numbers.
        let mut parts = self.parts(&marks);
        let breaks = breaks_of(&parts.iter().collect::<Vec<_>>()).swap_remove(own.number);
        let cut = self.lay(own.number, parts.swap_remove(own.number), breaks).ok()?;
        Some((Laid { darts: own.darts + 1, ..cut }, marks))
    }

    /// Lays those parts once more that a cut in another one has broken: what is sewn to its mouth must end there too.
    fn match_breaks(&self, laid: &mut [Laid], marks: &Marks) -> Result<(), PipelineError> {
        let mut breaks = breaks_of(&self.parts(marks).iter().collect::<Vec<_>>());
        for own in laid {
            let breaks = std::mem::take(&mut breaks[own.number]);
            if self.options.flatten.mode == Mode::Woven && own.breaks != breaks {
                let flat = flatten_between(&own.part.surface, &breaks, &self.options.flatten);
                own.flat = flat.map_err(|error| cuts::advise(self.file, &own.part, error))?;
                own.breaks = breaks;
            }
        }
        Ok(())
    }

    /// Of the parts beyond the limit that may get a dart the one that is strained most, the first of several.
    fn neediest(&self, laid: &[Laid]) -> Option<usize> {
        let strain = |k: usize| self.options.limit.share(&laid[k].flat.report);
        let open = (0..laid.len()).filter(|&k| laid[k].dart.len() > 1 && laid[k].stop.is_none());
        open.max_by(|&a, &b| strain(a).total_cmp(&strain(b)).then(b.cmp(&a)))
    }
}

/// Whether a cut from rim to rim brings a part much: a ring that stays whole needs no seam.
fn is_worth_a_cut(cut: &Laid, whole: &Laid) -> bool {
    /// Share of the strain that may be left.
    const LEFT: f64 = 0.5;
    cut.flat.report.strain_p99 < LEFT * whole.flat.report.strain_p99
}

/// Lays all parts flat. The part that is strained most gets the next dart, until all are within the limit or the darts
/// that `source.options` allows are cut. A dart that would make a flat piece lie on itself is not cut, and its part
/// gets no other; `marks` has those that are.
pub(super) fn with_darts(source: &Source<'_>, marks: &mut Marks) -> Result<Outcome, PipelineError> {
    let Outcome { mut laid, failed } = source.lay_all(marks);
    let mut left = source.options.darts;
    while left > 0
        && let Some(k) = source.neediest(&laid)
    {
        match source.with_next_dart(&laid[k], marks) {
            Some((cut, cuts)) if cut.lies_as_well_as(&laid[k]) => {
                (laid[k], *marks) = (cut, cuts);
                left -= 1;
            }
            _ => laid[k].stop = Some(DartStop::Overlap),
        }
    }
    source.match_breaks(&mut laid, marks)?;
    if source.options.darts > 0 {
        laid.iter_mut().filter(|l| source.options.limit.passed(&l.flat.report)).for_each(Laid::say_why);
    }
    Ok(Outcome { laid, failed })
}

impl Laid {
    /// Whether it lies on itself no more than before a dart, and was not kept from it at the price of its rim.
    fn lies_as_well_as(&self, before: &Self) -> bool {
        let (own, other) = (&self.flat.report, &before.flat.report);
        own.overlaps <= other.overlaps && (own.rim_missed.is_none() || other.rim_missed.is_some())
    }

    /// Says why a part beyond the limit got no further dart.
    fn say_why(&mut self) {
        let other = if self.dart.len() > 1 { DartStop::NoneLeft } else { DartStop::NoPlace };
        self.stop.get_or_insert(other);
    }
}
