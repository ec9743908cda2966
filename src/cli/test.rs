//! `test`: garments against their own bounds.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Serialize;

use super::args::TestArgs;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::junit;
use crate::flatten::Options;
use crate::io::files::{check_writable, write_all};
use crate::pipeline::{Job, Overrides, PipelineError, Run, read};
use crate::report::{Verdict, aligned, verdicts};

/// How a garment did.
#[derive(Serialize)]
pub(super) struct Outcome {
    /// Its file.
    pub(super) file: String,
    /// Its short name.
    pub(super) garment: String,
    /// Whether it was made and keeps all its bounds.
    pub(super) ok: bool,
    /// Wall-clock time, s.
    pub(super) seconds: f64,
    /// One per bound; empty when it was not made.
    pub(super) bounds: Vec<Verdict>,
    /// Why it was not made.
    pub(super) error: Option<String>,
    #[serde(skip)]
    exit: Exit,
}

/// `toile test`
pub(super) fn test(args: &TestArgs, console: &Console) -> Result<Exit, CliError> {
    let files = garment_files(&args.paths)?;
    let inputs: Vec<&Path> = files.iter().map(PathBuf::as_path).collect();
    if let Some(junit) = &args.junit {
        check_writable(std::slice::from_ref(junit), &inputs)?;
    }
    let overrides = args.overrides.checked();
    let outcomes: Vec<Outcome> = files.iter().flat_map(|file| outcomes(file, &overrides, console)).collect();
    if let Some(file) = &args.junit {
        write_all(&[(file.clone(), junit::xml(&outcomes).into_bytes())], &inputs)?;
    }
    console.results(&outcomes, || summary(&outcomes))?;
    for outcome in &outcomes {
        complain(outcome, console);
    }
    Ok(outcomes.iter().map(|o| o.exit).max().unwrap_or(Exit::Done))
}

/// The files as given, and every garment of the folders, sorted by name.
fn garment_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, CliError> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let unreadable = |e: std::io::Error| CliError::Argument(format!("cannot read {}: {e}", path.display()));
        let entries: Vec<fs::DirEntry> = fs::read_dir(path).and_then(Iterator::collect).map_err(unreadable)?;
        let mut found: Vec<PathBuf> = entries.iter().map(fs::DirEntry::path).filter(|p| is_yaml(p)).collect();
        if found.is_empty() {
            return Err(CliError::Argument(format!("{}: no garment (*.yaml) in this folder", path.display())));
        }
        found.sort();
        files.extend(found);
    }
    Ok(files)
}

fn is_yaml(path: &Path) -> bool {
    path.is_file() && path.extension().is_some_and(|e| e == "yaml" || e == "yml")
}

/// Makes one garment as its file says, and once more in every fabric that it has bounds for.
fn outcomes(file: &Path, overrides: &Overrides, console: &Console) -> Vec<Outcome> {
    let mut out = vec![outcome(file, overrides, console)];
    if overrides.fabric.is_some() {
        return out;
    }
    let Ok(loaded) = read(file) else { return out };
    let mut fabrics: Vec<&str> = loaded.garment.tests.iter().filter_map(|t| t.fabric.as_deref()).collect();
    fabrics.sort_unstable();
    fabrics.dedup();
    for fabric in fabrics {
        let overrides = Overrides { fabric: Some(fabric.to_owned()), ..overrides.clone() };
        let mut made = outcome(file, &overrides, console);
        made.garment = format!("{} in {fabric}", made.garment);
        made.file = format!("{} in {fabric}", made.file);
        out.push(made);
    }
    out
}

/// Makes one garment, in memory.
fn outcome(file: &Path, overrides: &Overrides, console: &Console) -> Outcome {
    let begin = Instant::now();
    let made = made(file, overrides, console);
    let seconds = begin.elapsed().as_secs_f64();
    let (bounds, error, exit) = match made {
        Ok(bounds) => {
            let exit = if bounds.iter().all(|v| v.ok) { Exit::Done } else { Exit::OutOfBounds };
            (bounds, None, exit)
        }
        Err(e) => (Vec::new(), Some(e.to_string()), if e.is_input() { Exit::Input } else { Exit::Failed }),
    };
    Outcome {
        file: file.display().to_string(),
        garment: file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned()),
        ok: exit == Exit::Done,
        seconds,
        bounds,
        error,
        exit,
    }
}

fn made(file: &Path, overrides: &Overrides, console: &Console) -> Result<Vec<Verdict>, PipelineError> {
    let job = Job::new(file, read(file)?, overrides)?;
    let bars = console.progress();
    let mut run = Run::new(&job);
    run.flatten(&Options::default(), &mut |stage, share| bars.show(stage, share))?;
    Ok(verdicts(&job.garment, &run.report()))
}

fn summary(outcomes: &[Outcome]) -> String {
    let head = ["garment", "bound", "measured", "limit", "", "at", ""];
    let mut rows = vec![head.map(String::from).to_vec()];
    for outcome in outcomes {
        rows.extend(outcome.bounds.iter().map(|v| row(outcome, v)));
        if outcome.error.is_some() {
            let mut row = vec![outcome.garment.clone(), "made".into()];
            row.extend(["", "", "", "", "NO"].map(String::from));
            rows.push(row);
        }
    }
    let good = outcomes.iter().filter(|o| o.ok).count();
    let seconds: f64 = outcomes.iter().map(|o| o.seconds).sum();
    format!("{}\n  {good} of {} garments within their bounds, {seconds:.1} s\n", aligned(&rows), outcomes.len())
}

fn row(outcome: &Outcome, v: &Verdict) -> Vec<String> {
    let digits = if v.unit.is_empty() { 0 } else { 3 };
    vec![
        outcome.garment.clone(),
        v.bound.clone(),
        format!("{:.digits$}", v.measured),
        format!("{}", v.limit),
        v.unit.into(),
        v.at.clone().unwrap_or_default(),
        if v.ok { "ok" } else { "OUT" }.into(),
    ]
}

fn complain(outcome: &Outcome, console: &Console) {
    for verdict in outcome.bounds.iter().filter(|v| !v.ok) {
        console.complain(&format!("{}: out of bounds: {verdict}", outcome.file));
    }
    if let Some(error) = &outcome.error {
        console.complain(&format!("{}: not made: {error}", outcome.file));
    }
}
