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
use crate::flatten::{FlattenError, Flattened, Mode, flatten_between, one_sided};
use crate::io::obj_read::ObjFaces;

/// A surface as it was read, to be cut and laid flat.
pub(super) struct Source<'a> {
    pub(super) file: &'a Path,
    pub(super) faces: &'a ObjFaces,
    pub(super) nodes: &'a Nodes,
    /// Metres per unit of the file.
    pub(super) unit: f64,
    /// Name of parts without a name of their own.
    pub(super) stem: &'a str,
    pub(super) options: &'a SurfaceOptions,
}

/// A part of the surface laid flat.
pub(super) struct Laid {
    pub(super) part: Part,
    pub(super) flat: Flattened,
    /// Between which of its rim's vertices lengths were to stay.
    breaks: Vec<u32>,
    /// Path of a dart that would relieve it, rim first. Empty if it is within the limit, or if no place can be found.
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

impl Source<'_> {
    pub(super) fn parts(&self, marks: &Marks) -> Vec<Part> {
        parts(self.faces, self.nodes, &marks.edges, self.unit, self.stem)
    }

    fn lay(&self, part: Part, breaks: Vec<u32>) -> Result<Laid, PipelineError> {
        if part.turned.is_none() {
            let error = FlattenError::OneSided(one_sided(&part.surface.triangles));
            return Err(cuts::advise(self.file, &part, error));
        }
        let flat = match flatten_between(&part.surface, &breaks, &self.options.flatten) {
            Ok(flat) => flat,
            Err(error) => return Err(cuts::advise(self.file, &part, error)),
        };
        let strained = self.options.limit.passed(&flat.report);
        let dart = if strained { cuts::dart(&part, &flat) } else { Vec::new() };
        Ok(Laid { part, flat, breaks, dart, darts: 0, stop: None })
    }

    fn lay_all(&self, parts: Vec<Part>) -> Result<Vec<Laid>, PipelineError> {
        let breaks = breaks_of(&parts.iter().collect::<Vec<_>>());
        let laid = parts.into_par_iter().zip(breaks).map(|(part, breaks)| self.lay(part, breaks));
        let laid: Vec<Result<Laid, PipelineError>> = laid.collect();
        // Of several errors the first in the file's order, not the first in time.
        laid.into_iter().collect()
    }

    /// A part with its next dart, and the cuts that make it.
    fn with_next_dart(&self, laid: &[Laid], k: usize, marks: &Marks) -> Result<(Laid, Marks), PipelineError> {
        let mut marks = marks.clone();
        marks.cut(&laid[k].part, &laid[k].dart, CutWhy::Dart);
        // A dart ends inside its part and leaves it whole, so that all parts keep their numbers.
        let mut parts = self.parts(&marks);
        let breaks = breaks_of(&parts.iter().collect::<Vec<_>>()).swap_remove(k);
        let cut = self.lay(parts.swap_remove(k), breaks)?;
        Ok((Laid { darts: laid[k].darts + 1, ..cut }, marks))
    }

    /// Lays parts flat again whose rim a dart in another part has divided: the edge sewn to the dart's mouth must end
    /// there too.
    fn match_breaks(&self, laid: &mut [Laid]) -> Result<(), PipelineError> {
        let breaks = breaks_of(&laid.iter().map(|l| &l.part).collect::<Vec<_>>());
        for (own, breaks) in laid.iter_mut().zip(breaks) {
            if self.options.flatten.mode == Mode::Woven && own.breaks != breaks {
                let flat = flatten_between(&own.part.surface, &breaks, &self.options.flatten);
                own.flat = flat.map_err(|error| cuts::advise(self.file, &own.part, error))?;
                own.breaks = breaks;
            }
        }
        Ok(())
    }

    /// The most strained of the parts beyond the limit that may get a dart. Of equal ones the first.
    fn neediest(&self, laid: &[Laid]) -> Option<usize> {
        let strain = |k: usize| self.options.limit.share(&laid[k].flat.report);
        let open = (0..laid.len()).filter(|&k| laid[k].dart.len() > 1 && laid[k].stop.is_none());
        open.max_by(|&a, &b| strain(a).total_cmp(&strain(b)).then(b.cmp(&a)))
    }
}

/// Lays all parts flat. The part that is strained most gets the next dart, until all are within the limit or the darts
/// that `source.options` allows are cut. A dart that would make a flat piece lie on itself is not cut, and its part
/// gets no other. `marks` collects the darts that are cut.
pub(super) fn with_darts(source: &Source<'_>, marks: &mut Marks) -> Result<Vec<Laid>, PipelineError> {
    let mut laid = source.lay_all(source.parts(marks))?;
    let mut left = source.options.darts;
    while left > 0
        && let Some(k) = source.neediest(&laid)
    {
        let (cut, cuts) = source.with_next_dart(&laid, k, marks)?;
        if cut.flat.report.overlaps > laid[k].flat.report.overlaps {
            laid[k].stop = Some(DartStop::Overlap);
        } else {
            (laid[k], *marks) = (cut, cuts);
            left -= 1;
        }
    }
    source.match_breaks(&mut laid)?;
    if source.options.darts > 0 {
        laid.iter_mut().filter(|l| source.options.limit.passed(&l.flat.report)).for_each(Laid::say_why);
    }
    Ok(laid)
}

impl Laid {
    /// Says why a part beyond the limit got no further dart.
    fn say_why(&mut self) {
        let other = if self.dart.len() > 1 { DartStop::NoneLeft } else { DartStop::NoPlace };
        self.stop.get_or_insert(other);
    }
}
