//! Parts laid flat, and darts where they are strained too much: one at a time,
//! the next always into the part that needs it most.

use std::f64::consts::PI;
use std::path::Path;

use rayon::prelude::*;
use serde::Serialize;

use super::super::error::PipelineError;
use super::SurfaceOptions;
use super::cuts;
use super::edges::breaks_of;
use super::even::even_darts;
use super::parts::SurfacePart;
use super::report::CutWhy;
use super::sheet::CutFaces;
use crate::flatten::{FlattenError, Flattened, Mode, flatten_between, one_sided};

/// How a surface is laid flat.
pub(super) struct LayingInput<'a> {
    pub(super) file: &'a Path,
    pub(super) options: &'a SurfaceOptions,
}

/// A dart brings nothing where a part is strained by no more than this share of its strain without it: by what two
/// ways down to the same minimum differ.
const IDLE: f64 = 1.001;

/// A part of the surface laid flat.
pub(super) struct LaidPart {
    /// Its place among all parts.
    pub(super) number: usize,
    pub(super) part: SurfacePart,
    pub(super) flat: Flattened,
    /// Between which of its rim's vertices lengths were to stay.
    pub(super) breaks: Vec<u32>,
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
    /// Its place among all parts.
    number: usize,
    pub(super) part: SurfacePart,
    /// In the file's numbers, with where to cut if that is the remedy.
    pub(super) error: PipelineError,
}

/// All parts of a surface, each with its own outcome.
pub(super) struct LaidSurface {
    pub(super) laid: Vec<LaidPart>,
    pub(super) failed: Vec<Failed>,
}

impl LayingInput<'_> {
    /// A part laid flat, `number` being its place among all parts.
    pub(super) fn lay(
        &self,
        number: usize,
        part: SurfacePart,
        breaks: Vec<u32>,
    ) -> Result<LaidPart, Box<(SurfacePart, FlattenError)>> {
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
        Ok(LaidPart { number, part, flat, breaks, dart, darts: 0, stop: None })
    }

    /// The part of this number of a sheet laid flat.
    pub(super) fn lay_of(&self, sheet: &CutFaces, number: usize) -> Result<LaidPart, Box<(SurfacePart, FlattenError)>> {
        let mut parts = sheet.parts();
        let breaks = breaks_of(&parts.iter().collect::<Vec<_>>()).swap_remove(number);
        self.lay(number, parts.swap_remove(number), breaks)
    }

    /// Lays all parts flat, each by itself. One that cannot be laid flat, or is strained beyond the limit, is cut where
    /// that is its remedy.
    fn lay_all(&self, sheet: &mut CutFaces) -> Result<LaidSurface, PipelineError> {
        let parts = sheet.parts();
        let breaks = breaks_of(&parts.iter().collect::<Vec<_>>());
        let numbered = parts.into_par_iter().enumerate().zip(breaks);
        let all: Vec<_> = numbered.map(|((number, part), breaks)| self.lay(number, part, breaks)).collect();
        let cut_before = sheet.made.len();
        let mut out = LaidSurface { laid: Vec::new(), failed: Vec::new() };
        for (number, result) in all.into_iter().enumerate() {
            match self.remedied(number, result, sheet) {
                Ok(laid) => out.laid.push(laid),
                Err(failed) => {
                    let (part, error) = *failed;
                    out.failed.push(Failed { number, error: cuts::advise(self.file, &part, error), part });
                }
            }
        }
        if sheet.made.len() > cut_before {
            self.refresh(&mut out, sheet)?;
        }
        Ok(out)
    }

    /// A part, or that part cut where a cut is what it needs: from rim to rim where no flat piece has all its rims, and
    /// from the rim to its far end where it is too deep to be laid flat at all.
    fn remedied(
        &self,
        number: usize,
        whole: Result<LaidPart, Box<(SurfacePart, FlattenError)>>,
        sheet: &mut CutFaces,
    ) -> Result<LaidPart, Box<(SurfacePart, FlattenError)>> {
        let needs_none = match &whole {
            Ok(laid) => !self.options.limit.passed(&laid.flat.report),
            Err(failed) => !matches!(failed.1, FlattenError::Breakdown | FlattenError::FlippedStart(_)),
        };
        if needs_none {
            return whole;
        }
        let mut cut = sheet.clone();
        cuts::cut_open(&mut cut, Some(number));
        let deep = |laid: &LaidPart| self.options.darts.is_none() && laid.is_deep();
        if cut.made.len() == sheet.made.len() && whole.as_ref().map_or(true, deep) {
            // Earlier cuts may have split it, so that its numbers are those of the sheet as it is now.
            let part = cut.parts().swap_remove(number);
            let line = cuts::straight_inside(&part, &cuts::slit(&part));
            cut.cut(&part, &line, CutWhy::Auto);
        }
        if cut.made.len() == sheet.made.len() {
            return whole;
        }
        match (self.lay_of(&cut, number), whole) {
            (Ok(cut), Ok(whole)) if !is_worth_a_cut(&cut, &whole) => Ok(whole),
            (Ok(laid), _) => {
                *sheet = cut;
                Ok(laid)
            }
            (Err(_), whole) => whole,
        }
    }

    /// A part with its next dart, and the sheet with it; `None` where it cannot be laid flat with it.
    fn with_next_dart(&self, own: &LaidPart, sheet: &CutFaces) -> Option<(LaidPart, CutFaces)> {
        let mut cut = sheet.clone();
        cut.cut(&own.part, &cuts::straight_inside(&own.part, &own.dart), CutWhy::Dart);
        // A dart ends inside its part and leaves it whole, so that all parts keep their numbers.
        let laid = self.lay_of(&cut, own.number).ok()?;
        cut.tell_strain(sheet.made.len(), [own, &laid].map(|laid| laid.flat.report.strain_p99));
        Some((LaidPart { darts: own.darts + 1, ..laid }, cut))
    }

    /// Closes those darts of a part again, cut from number `first` on, that bring nothing any more: without which it is
    /// strained no more. While darts are cut that cannot be known, for a part may need several before one helps.
    fn close_idle(&self, own: &mut LaidPart, sheet: &mut CutFaces, first: usize) {
        let share = |laid: &LaidPart| self.options.limit.share(&laid.flat.report);
        for number in (first..sheet.made.len()).rev() {
            if sheet.made[number].piece != own.part.name {
                continue;
            }
            let mut closed = sheet.clone();
            closed.close(number);
            let Ok(laid) = self.lay_of(&closed, own.number) else { continue };
            if share(&laid) <= IDLE * share(own) && laid.lies_as_well_as(own) {
                *own = LaidPart { darts: own.darts - 1, stop: own.stop, ..laid };
                *sheet = closed;
                if own.stop.is_none() && share(own) > 1.0 {
                    // The next one would be this one again.
                    (own.stop, own.dart) = (Some(DartStop::NoPlace), Vec::new());
                }
            }
        }
    }

    /// Lays those parts once more that a cut in another one has changed: what is sewn to its mouth has a vertex there
    /// too and, where only whole chains of the rim are held, must end there.
    pub(super) fn refresh(&self, outcome: &mut LaidSurface, sheet: &CutFaces) -> Result<(), PipelineError> {
        let parts = sheet.parts();
        let mut breaks = breaks_of(&parts.iter().collect::<Vec<_>>());
        for own in &mut outcome.laid {
            let (part, breaks) = (&parts[own.number], std::mem::take(&mut breaks[own.number]));
            let held = self.options.flatten.mode == Mode::Woven && own.breaks != breaks;
            if held || own.part.faces != part.faces {
                let laid = self.lay(own.number, part.clone(), breaks);
                let laid = laid.map_err(|failed| cuts::advise(self.file, &failed.0, failed.1))?;
                *own = LaidPart { darts: own.darts, stop: own.stop, ..laid };
            }
        }
        for failed in &mut outcome.failed {
            failed.part = parts[failed.number].clone();
        }
        Ok(())
    }

    /// Of the parts beyond the limit that may get a dart the one that is strained most, the first of several.
    fn neediest(&self, laid: &[LaidPart]) -> Option<usize> {
        let strain = |k: usize| self.options.limit.share(&laid[k].flat.report);
        let open = (0..laid.len()).filter(|&k| laid[k].dart.len() > 1 && laid[k].stop.is_none());
        open.max_by(|&a, &b| strain(a).total_cmp(&strain(b)).then(b.cmp(&a)))
    }
}

/// Whether a cut from rim to rim brings a part much: a ring that stays whole needs no seam.
fn is_worth_a_cut(cut: &LaidPart, whole: &LaidPart) -> bool {
    /// Share of the strain that may be left.
    const LEFT: f64 = 0.5;
    cut.flat.report.strain_p99 < LEFT * whole.flat.report.strain_p99
}

/// Lays all parts flat and cuts the darts that `source.options` asks for: even ones into round parts, all the others
/// one by one, the next always into the part that is strained most, until all are within the limit or so many are cut.
/// A dart that would make a flat piece lie on itself is not cut, and its part gets no other. Those that bring nothing
/// in the end are closed again. `sheet` has those that are left.
pub(super) fn with_darts(source: &LayingInput<'_>, sheet: &mut CutFaces) -> Result<LaidSurface, PipelineError> {
    let mut out = source.lay_all(sheet)?;
    let Some(darts) = source.options.darts else { return Ok(out) };
    even_darts(source, sheet, &mut out.laid, darts);
    let first = sheet.made.len();
    let mut left = darts.most();
    while left > 0
        && let Some(k) = source.neediest(&out.laid)
    {
        match source.with_next_dart(&out.laid[k], sheet) {
            Some((cut, cuts)) if cut.lies_as_well_as(&out.laid[k]) => {
                (out.laid[k], *sheet) = (cut, cuts);
                left -= 1;
            }
            _ => out.laid[k].stop = Some(DartStop::Overlap),
        }
    }
    out.laid.iter_mut().for_each(|own| source.close_idle(own, sheet, first));
    source.refresh(&mut out, sheet)?;
    out.laid.iter_mut().filter(|l| source.options.limit.passed(&l.flat.report)).for_each(LaidPart::say_why);
    Ok(out)
}

impl LaidPart {
    /// Whether it is much deeper than wide, so that no flat piece with its rim has a quarter of its area.
    fn is_deep(&self) -> bool {
        /// Least L²/4πS.
        const FLAT: f64 = 0.25;
        let report = &self.flat.report;
        report.boundary_before.powi(2) < FLAT * 4.0 * PI * report.area_before
    }

    /// Whether it lies on itself no more than before a dart, and was not kept from it at the price of its rim.
    pub(super) fn lies_as_well_as(&self, before: &Self) -> bool {
        let (own, other) = (&self.flat.report, &before.flat.report);
        own.overlaps <= other.overlaps && (own.rim_missed.is_none() || other.rim_missed.is_some())
    }

    /// Says why a part beyond the limit got no further dart.
    fn say_why(&mut self) {
        let other = if self.dart.len() > 1 { DartStop::NoneLeft } else { DartStop::NoPlace };
        self.stop.get_or_insert(other);
    }
}
