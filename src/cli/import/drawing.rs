//! `import svg` and `import dxf`

use std::path::{Path, PathBuf};

use super::{Imported, KnownSeams, finish};
use crate::cli::console::Console;
use crate::cli::exit::{CliError, Exit};
use crate::cli::import_args::{DrawingArgs, TargetArgs};
use crate::digitize::{Drawing, garment_file, sewn};
use crate::input::stem;
use crate::io::dxf_read::{DxfOptions, read_dxf};
use crate::io::garment::seam_line;
use crate::io::svg_read::{SvgOptions, read_svg};
use crate::pattern::SeamFile;

/// The value of `--size` for every size.
const ALL: &str = "all";

/// `toile import svg FILE.svg -o GARMENT.yaml`
pub(super) fn svg(args: &DrawingArgs, unit: Option<f64>, console: &Console) -> Result<Exit, CliError> {
    let read = |size: Option<String>| {
        read_svg(&args.drawing, &SvgOptions { unit, size }).map_err(|e| refused(args, e.to_string()))
    };
    import(args, read, console)
}

/// `toile import dxf FILE.dxf -o GARMENT.yaml`
pub(super) fn dxf(args: &DrawingArgs, unit: Option<f64>, console: &Console) -> Result<Exit, CliError> {
    let read = |size: Option<String>| {
        read_dxf(&args.drawing, &DxfOptions { unit, size }).map_err(|e| refused(args, e.to_string()))
    };
    import(args, read, console)
}

/// Imports the size that is wanted, or each of them into a file of its own.
fn import(
    args: &DrawingArgs,
    read: impl Fn(Option<String>) -> Result<Drawing, CliError>,
    console: &Console,
) -> Result<Exit, CliError> {
    if args.size.as_deref() != Some(ALL) {
        return write(args, &args.target, &read(args.size.clone())?, console);
    }
    let sizes = read(None)?.sizes;
    if sizes.is_empty() {
        return Err(refused(args, "it is drawn in one size; leave --size out".to_owned()));
    }
    let mut exit = Exit::Done;
    for size in sizes {
        let target = TargetArgs { output: sized(&args.target.output, &size), force: args.target.force };
        if write(args, &target, &read(Some(size))?, console)? != Exit::Done {
            exit = Exit::OutOfBounds;
        }
    }
    Ok(exit)
}

/// `shirt.yaml` of size M as `shirt_M.yaml`.
fn sized(output: &Path, size: &str) -> PathBuf {
    let kept = |c: char| if c.is_alphanumeric() || c == '-' { c } else { '_' };
    let size: String = size.chars().map(kept).collect();
    let stem = stem(output);
    let ending = output.extension().map_or_else(String::new, |e| format!(".{}", e.to_string_lossy()));
    output.with_file_name(format!("{stem}_{size}{ending}"))
}

fn refused(args: &DrawingArgs, reason: String) -> CliError {
    CliError::Import { file: args.drawing.display().to_string(), reason }
}

/// Writes the pieces with all edges free, and says what is not among them and which may belong together.
fn write(args: &DrawingArgs, target: &TargetArgs, drawing: &Drawing, console: &Console) -> Result<Exit, CliError> {
    let stem = || args.drawing.file_stem().map_or_else(|| "garment".to_owned(), |s| s.to_string_lossy().into_owned());
    let made = garment_file(&drawing.title.clone().unwrap_or_else(stem), &drawing.pieces);
    let file = if args.seams { sewn(&made.file, &made.suggestions) } else { made.file.clone() };
    let offers: Vec<(SeamFile, String)> = made.suggestions.iter().map(|s| (s.seam(), s.reason())).collect();
    let seams = if args.seams { KnownSeams::Taken(&offers) } else { KnownSeams::Offered(&offers) };
    let complaints = drawing.complaints();
    let exit = finish(&Imported { source: &args.drawing, target, file: &file, seams, complaints }, console)?;
    drawing.left_out.iter().chain(&drawing.notes).chain(&made.notes).for_each(|note| console.note(note));
    say_seams(args.seams, &offers, console)?;
    Ok(exit)
}

/// Says which seams are offered, and what to do with them.
fn say_seams(taken: bool, offers: &[(SeamFile, String)], console: &Console) -> Result<(), CliError> {
    if taken {
        console.note("these seams were guessed and are written as seams; look through them, and through 'free':");
    } else {
        console.note(
            "seams are to be written; until then all edges are free, afterwards 'free' lists those that stay open",
        );
    }
    if !taken && !offers.is_empty() {
        console
            .note("these may be meant, best first, and stand in the file as remarks (--seams writes them as seams):");
    }
    for (seam, reason) in offers {
        let line = seam_line(seam).map_err(|e| CliError::Argument(e.to_string()))?;
        console.note(&format!("  {line}   # {reason}"));
    }
    Ok(())
}
