//! `alter`: a pattern altered and written as a new garment file.

use std::path::Path;

use serde::Serialize;

use super::console::Console;
use super::exit::{CliError, Exit};
use super::garment_args::AlterArgs;
use crate::geometry::MM;
use crate::io::files::{check_writable, write_all};
use crate::io::garment::{Changed, change};
use crate::pipeline::PipelineError;
use crate::report::aligned;

/// The file that was written. Lengths are mm.
#[derive(Serialize)]
struct AlterSummary {
    file: String,
    edges: Vec<ChangedEdge>,
}

/// An edge that changed its length.
#[derive(Serialize)]
struct ChangedEdge {
    edge: String,
    before: f64,
    after: f64,
}

/// `toile alter`
pub(super) fn alter(args: &AlterArgs, console: &Console) -> Result<Exit, CliError> {
    let inputs = [args.garment.as_path(), args.changes.as_path()];
    check_writable(std::slice::from_ref(&args.output), &inputs)?;
    let shown = args.output.display().to_string();
    let changed = change(&args.garment, &args.changes, &shown).map_err(PipelineError::from)?;
    write_all(&[(args.output.clone(), changed.text.clone().into_bytes())], &inputs)?;
    if !changed.in_place {
        note_written_anew(&args.output, &args.garment, console);
    }
    let written = AlterSummary::new(shown, &changed);
    console.results(&written, || written.text())?;
    match &changed.refused {
        None => Ok(Exit::Done),
        Some(refused) => {
            console.complain(&refused.to_string());
            Ok(Exit::OutOfBounds)
        }
    }
}

/// Says that a garment file was not only changed.
pub(super) fn note_written_anew(new: &Path, old: &Path, console: &Console) {
    console.note(&format!("{} is written anew, without the comments of {}", new.display(), old.display()));
}

impl AlterSummary {
    fn new(file: String, changed: &Changed) -> Self {
        let row = |e: &crate::io::garment::EdgeChange| ChangedEdge {
            edge: e.edge.clone(),
            before: e.before * MM,
            after: e.after * MM,
        };
        Self { file, edges: changed.edges.iter().map(row).collect() }
    }

    fn text(&self) -> String {
        let mut rows = vec![["edge", "mm before", "mm after", "change"].map(String::from).to_vec()];
        let number = |x: f64| format!("{x:.2}");
        rows.extend(
            self.edges.iter().map(|e| {
                vec![e.edge.clone(), number(e.before), number(e.after), format!("{:+.2}", e.after - e.before)]
            }),
        );
        format!("{}\n  written to {}\n", aligned(&rows), self.file)
    }
}
