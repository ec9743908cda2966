//! A garment draped for its figures.

use super::Asked;
use crate::io::garment::Loaded;
use crate::pipeline::{Earlier, Job, PipelineError, Run};
use crate::report::Report;

/// A draped garment.
pub(super) struct FittedDrape {
    pub(super) report: Report,
    /// To go on from.
    pub(super) hanging: Option<Earlier>,
}

/// Drapes a garment, from nothing or from where another one hangs.
///
/// # Errors
/// A garment that cannot be made.
pub(super) fn drape(
    asked: &Asked,
    loaded: &Loaded,
    from: Option<&Earlier>,
    tell: &mut dyn FnMut(f64),
) -> Result<FittedDrape, PipelineError> {
    let job = Job::new(asked.file, loaded.clone(), asked.overrides)?;
    let mut run = match from {
        Some(earlier) => Run::going_on(&job, earlier.clone()),
        None => Run::new(&job),
    };
    run.drape(&mut |_, share| tell(share))?;
    Ok(FittedDrape { report: run.report(), hanging: Earlier::of(&run) })
}
