//! What every bench begins with.

use std::error::Error;
use std::path::Path;
use std::time::Duration;

use criterion::Criterion;
use toile::pipeline::{Job, Overrides, read};

/// Ten samples in about two seconds each, and what the command line asks for.
pub(crate) fn criterion() -> Criterion {
    let criterion = Criterion::default().sample_size(10).warm_up_time(Duration::from_millis(500));
    criterion.measurement_time(Duration::from_secs(2)).configure_from_args()
}

/// A garment of the repository, meshed at `spacing` metres.
///
/// # Errors
/// As the pipeline's.
pub(crate) fn job(garment: &str, spacing: f64) -> Result<Job, Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(garment);
    Ok(Job::new(&file, read(&file)?, &Overrides { spacing: Some(spacing), ..Overrides::default() })?)
}
