//! `import garmentcode`

use super::{Imported, KnownSeams, finish};
use crate::cli::console::Console;
use crate::cli::exit::{CliError, Exit};
use crate::cli::import_args::GarmentcodeArgs;
use crate::io::body::floor_of;
use crate::io::garmentcode::{Wearer, read, text_of};

/// `toile import garmentcode SPEC.json -o GARMENT.yaml`
pub(super) fn import(args: &GarmentcodeArgs, console: &Console) -> Result<Exit, CliError> {
    let refused = |reason: String| CliError::Import { file: args.spec.display().to_string(), reason };
    let text = text_of(&args.spec).map_err(refused)?;
    let stem = args.spec.file_stem().map_or_else(|| "garment".to_owned(), |s| s.to_string_lossy().into_owned());
    let name = stem.strip_suffix("_specification").unwrap_or(&stem);
    let body = super::body(args.body.as_deref(), &args.target.output);
    let floor = args.body.as_deref().map_or(Ok(0.0), |body| floor_of(body, None));
    let floor = floor.map_err(|e| CliError::Argument(e.to_string()))?;
    let file = read(name, &text, Wearer { body: body.as_deref(), floor });
    let file = file.map_err(|e| refused(e.to_string()))?;
    let (target, complaints) = (&args.target, Vec::new());
    finish(&Imported { source: &args.spec, target, file: &file, seams: KnownSeams::Read, complaints }, console)
}
