//! `flatten`: any surface, or a garment's draped pieces.

use std::path::{Path, PathBuf};

use super::args::FlattenArgs;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::make::{Goal, Plan, carry_out, folder, write};
use crate::flatten::Options;
use crate::io::files::check_writable;
use crate::pipeline::{Color, FLAT_OBJ, PATTERN_SVG, REPORT_JSON, SurfaceReport, flatten_surface};
use crate::report::{aligned, restless};

/// `toile flatten`
pub(super) fn flatten(args: &FlattenArgs, console: &Console) -> Result<Exit, CliError> {
    let options = Options { mode: args.mode.into(), ..Options::default() };
    if is_garment(&args.input) {
        let plan = Plan {
            garment: &args.input,
            output: args.output.as_deref(),
            overrides: args.overrides.checked(),
            color: Color::default(),
            goal: Goal::Flat { from: args.from.as_deref(), options },
        };
        return carry_out(&plan, console);
    }
    if args.from.is_some() {
        return Err(CliError::Argument("--from belongs to a garment file; a surface is flattened as it is".into()));
    }
    surface(args, &options, console)
}

fn is_garment(path: &Path) -> bool {
    path.extension().is_some_and(|e| e.eq_ignore_ascii_case("yaml") || e.eq_ignore_ascii_case("yml"))
}

fn surface(args: &FlattenArgs, options: &Options, console: &Console) -> Result<Exit, CliError> {
    let stem = args.input.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let folder = folder(args.output.as_deref(), &stem);
    let inputs = [args.input.as_path()];
    let targets: Vec<PathBuf> = [FLAT_OBJ, PATTERN_SVG, REPORT_JSON].map(|name| folder.join(name)).into();
    check_writable(&targets, &inputs)?;
    let flat = flatten_surface(&args.input, args.units.metres(), options)?;
    write(flat.results()?, &folder, &inputs)?;
    let report = &flat.report;
    console.results(report, || format!("{}\n  written to {}\n", figures(report), folder.display()))?;
    for stage in restless(&report.stages) {
        console.note(&stage.to_string());
    }
    let mut exit = Exit::Done;
    for piece in report.pieces.iter().filter(|p| p.overlaps > 0) {
        console.complain(&format!("out of bounds: '{}' lies on itself when flat; cut it in two", piece.name));
        exit = Exit::OutOfBounds;
    }
    Ok(exit)
}

fn figures(report: &SurfaceReport) -> String {
    let head = ["piece", "cm²", "area %", "rim %", "largest edge %", "overlaps"];
    let mut rows = vec![head.map(String::from).to_vec()];
    rows.extend(report.pieces.iter().map(|p| {
        let percent = |e: Option<f64>| format!("{:.3}", 100.0 * e.unwrap_or(0.0));
        vec![
            p.name.clone(),
            format!("{:.1}", p.area_draped / 100.0),
            percent(p.area_error.flatten),
            percent(p.boundary_error.flatten),
            percent(Some(p.largest_edge_error)),
            p.overlaps.to_string(),
        ]
    }));
    aligned(&rows)
}
