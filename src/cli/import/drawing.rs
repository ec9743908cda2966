//! `import svg` and `import dxf`

use super::{Imported, finish};
use crate::cli::args::DrawingArgs;
use crate::cli::console::Console;
use crate::cli::exit::{CliError, Exit};
use crate::digitize::{Drawing, Suggestion, garment_file};
use crate::io::dxf_read::read_dxf;
use crate::io::svg_read::read_svg;

/// `toile import svg FILE.svg -o GARMENT.yaml`
pub(super) fn svg(args: &DrawingArgs, console: &Console) -> Result<Exit, CliError> {
    let drawing = read_svg(&args.drawing).map_err(|e| refused(args, e.to_string()))?;
    write(args, &drawing, console)
}

/// `toile import dxf FILE.dxf -o GARMENT.yaml`
pub(super) fn dxf(args: &DrawingArgs, unit: Option<f64>, console: &Console) -> Result<Exit, CliError> {
    let drawing = read_dxf(&args.drawing, unit).map_err(|e| refused(args, e.to_string()))?;
    write(args, &drawing, console)
}

fn refused(args: &DrawingArgs, reason: String) -> CliError {
    CliError::Import { file: args.drawing.display().to_string(), reason }
}

/// Writes the pieces with all edges free, and says what is not among them and which may belong together.
fn write(args: &DrawingArgs, drawing: &Drawing, console: &Console) -> Result<Exit, CliError> {
    let stem = || args.drawing.file_stem().map_or_else(|| "garment".to_owned(), |s| s.to_string_lossy().into_owned());
    let made = garment_file(&drawing.title.clone().unwrap_or_else(stem), &drawing.pieces);
    let exit = finish(&Imported { source: &args.drawing, target: &args.target, file: &made.file }, console)?;
    drawing.left_out.iter().chain(&drawing.notes).chain(&made.notes).for_each(|note| console.note(note));
    console
        .note("seams are to be written; until then all edges are free, afterwards 'free' lists those that stay open");
    if !made.suggestions.is_empty() {
        console.note("by their lengths these edges may belong together:");
    }
    made.suggestions.iter().for_each(|s| console.note(&suggestion(s)));
    Ok(exit)
}

fn suggestion(s: &Suggestion) -> String {
    let [sew, to] = s.lengths.map(|metres| 1e3 * metres);
    let notches = if s.notched { ", both notched" } else { "" };
    format!("  {{sew: {}, to: {}}}   # {sew:.1} and {to:.1} mm{notches}", s.sew, s.to)
}
