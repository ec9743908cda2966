//! `studio`: a garment file and its garment as a live page.

use std::ffi::OsString;
use std::io;
use std::num::NonZeroUsize;

use super::console::Console;
use super::exit::{CliError, Exit};
use super::garment_args::StudioArgs;
use crate::geometry::MM;
use crate::pipeline::Overrides;
use crate::studio::{Studio, StudioOptions, opened, write_frames};

/// `toile studio GARMENT.yaml`
pub(super) fn studio(
    args: &StudioArgs,
    threads: Option<NonZeroUsize>,
    itself: &[OsString],
    console: &Console,
) -> Result<Exit, CliError> {
    let size = args.size.clone();
    if args.frames {
        let overrides = Overrides { spacing: Some(args.spacing / MM), size, ..Overrides::default() };
        let out = io::BufWriter::new(io::stdout());
        return write_frames(&args.garment, &overrides, args.earlier.as_deref(), out)
            .map(|()| Exit::Done)
            .map_err(CliError::Print);
    }
    let (port, spacing, program) = (args.port, args.spacing, itself.to_vec());
    let studio = Studio::open(&args.garment, StudioOptions { port, spacing, size, program, threads })?;
    let address = studio.address();
    console.document(&format!("{address}\n"))?;
    // Kept until the end: the browser may read it late.
    let _page = if args.no_open { None } else { Some(opened(&address)?) };
    studio.serve()?;
    Ok(Exit::Done)
}
