//! `batch`: many garments.

use std::ffi::OsString;
use std::num::NonZeroUsize;

use super::batch_args::{BatchArgs, BatchPart};
use super::console::Console;
use super::exit::{CliError, Exit};
use crate::batch::{
    BatchJob, BatchPlan, Event, Garments, INDEX, IndexLine, JobState, Limits, Store, Summary, Worker,
    garments_of_folder, read_jobs, run,
};
use crate::io::files::stop_on_interrupt;

/// Characters of a failure on the terminal. The index has all of it.
const REASON: usize = 160;

/// `toile batch`
pub(super) fn batch(
    args: &BatchArgs,
    threads: Option<NonZeroUsize>,
    itself: &[OsString],
    console: &Console,
) -> Result<Exit, CliError> {
    let defaults = args.overrides.job_options();
    let jobs = if args.jobs.is_dir() {
        told(garments_of_folder(&args.jobs, &defaults)?, console)
    } else {
        read_jobs(&args.jobs, &defaults)?
    };
    let (jobs, index) = part(jobs, args.part);
    let store = Store::open(&args.output)?;
    let cores = || std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let plan = BatchPlan {
        worker: Worker { program: itself.to_vec(), threads: threads.unwrap_or(NonZeroUsize::MIN) },
        limits: Limits { time: args.time.0, memory: args.memory },
        side_by_side: args.side_by_side.unwrap_or_else(cores),
        retry: args.retry,
        index,
    };
    let stop = stop_on_interrupt();
    let bars = console.progress();
    let summary = run(&jobs, &store, &plan, &stop, &mut |event| match event {
        Event::Known(known, all) => bars.show("batch", known as f64 / all as f64),
        Event::Ended(line) if line.state == JobState::Failed => console.note(&failed(line)),
        Event::Ended(_) => {}
    })?;
    console.results(&summary, || said(&summary, &store.index(&plan.index).display().to_string()))?;
    Ok(judge(&summary))
}

/// The jobs of a folder. Says what of it is left out.
pub(super) fn told(found: Garments, console: &Console) -> Vec<BatchJob> {
    let names: Vec<String> = found.left_out.iter().map(|file| file.display().to_string()).collect();
    if !names.is_empty() {
        let names = crate::input::shown(&names.join(", "), REASON);
        console.note(&format!("left out, since they are no garment files ('garment: 1'): {names}"));
    }
    found.jobs
}

/// Every `of`th job, and the index for them.
fn part(jobs: Vec<BatchJob>, part: Option<BatchPart>) -> (Vec<BatchJob>, String) {
    let Some(BatchPart { number, of }) = part else { return (jobs, INDEX.to_owned()) };
    let jobs = jobs.into_iter().skip(number - 1).step_by(of).collect();
    (jobs, format!("index.{number}-of-{of}.jsonl"))
}

fn failed(line: &IndexLine) -> String {
    let why = line.error.as_deref().unwrap_or_default();
    let first = why.lines().next().unwrap_or_default();
    format!("{} failed: {}", line.id, crate::input::shown(first, REASON))
}

fn said(summary: &Summary, index: &str) -> String {
    let Summary { jobs, done, out_of_bounds, failed, known_before } = summary;
    let out = if *out_of_bounds > 0 { format!(" ({out_of_bounds} out of bounds)") } else { String::new() };
    let before = if *known_before > 0 { format!("; {known_before} were known before") } else { String::new() };
    format!("{jobs} jobs: {done} done{out}, {failed} failed{before}\n  {index} has a line for each\n")
}

fn judge(summary: &Summary) -> Exit {
    if summary.failed > 0 {
        Exit::Failed
    } else if summary.out_of_bounds > 0 {
        Exit::OutOfBounds
    } else {
        Exit::Done
    }
}
