//! `draft`: a garment from style lines on a body.

use std::path::{Path, PathBuf};

use serde::Serialize;

use super::arg_values::UnitArg;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::flatten_args::DraftArgs;
use crate::io::files::{check_writable, write_all};
use crate::pipeline::{Drafted, DraftedEase, DraftedPiece, draft as drafted};
use crate::report::aligned;

/// The file that was written.
#[derive(Serialize)]
struct DraftSummary<'a> {
    file: String,
    pieces: &'a [DraftedPiece],
    ease: &'a [DraftedEase],
    darts: usize,
}

/// `toile draft`
pub(super) fn draft(args: &DraftArgs, console: &Console) -> Result<Exit, CliError> {
    let mut inputs: Vec<&Path> = vec![&args.lines];
    let body = PathBuf::from(&args.body);
    inputs.extend(body.exists().then_some(body.as_path()));
    check_writable(std::slice::from_ref(&args.output), &inputs)?;
    let made = drafted(&args.body, args.body_units.map(UnitArg::unit), &args.lines)?;
    made.notes.iter().for_each(|note| console.note(note));
    write_all(&[(args.output.clone(), made.text.clone().into_bytes())], &inputs)?;
    let file = args.output.display().to_string();
    let written = DraftSummary { file, pieces: &made.pieces, ease: &made.ease, darts: made.darts };
    console.results(&written, || told(&made, &written.file))?;
    Ok(Exit::Done)
}

fn told(made: &Drafted, file: &str) -> String {
    let mut rows = vec![["piece", "strain", "darts"].map(String::from).to_vec()];
    let row = |p: &DraftedPiece| vec![p.name.clone(), format!("{:.1} %", 100.0 * p.strain), p.darts.to_string()];
    rows.extend(made.pieces.iter().map(row));
    let mut out = format!("{}\n", aligned(&rows));
    for DraftedEase { girth, asked, drafted } in &made.ease {
        out.push_str(&format!("ease  {girth}: {drafted:.1} mm of {asked:.1} mm asked for\n"));
    }
    out.push_str(&format!("  written to {file}\n"));
    out
}
