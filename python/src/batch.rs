//! The functions behind `toile.batch`, and the command line.

use std::collections::HashSet;
use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::Duration;

use pyo3::prelude::*;
use toile::batch::{Event, INDEX, Job, Limits, Plan, Store, Worker, parse_job, read_jobs, run, run_one};

use crate::errors;
use crate::result::parsed;
use crate::work::with_signals;

/// Most memory that a job may be given, MiB: more is more than a number of bytes holds.
const MOST_MEMORY: i64 = 1 << 40;

/// A number of threads or jobs.
fn count(py: Python<'_>, name: &str, number: isize) -> PyResult<NonZeroUsize> {
    let positive = usize::try_from(number).ok().and_then(NonZeroUsize::new);
    positive.ok_or_else(|| errors::input(py, format!("{name}: at least one is needed, not {number}")))
}

/// How jobs are made.
fn plan(
    py: Python<'_>,
    program: Vec<OsString>,
    time: Option<f64>,
    memory: Option<i64>,
    threads: isize,
    retry: bool,
) -> PyResult<Plan> {
    let duration = |s: f64| Duration::try_from_secs_f64(s).ok().filter(|time| !time.is_zero());
    let wrong_time = |s: f64| errors::input(py, format!("time: {s} is no positive number of seconds, such as 1200"));
    let time = time.map(|s| duration(s).ok_or_else(|| wrong_time(s))).transpose()?;
    if let Some(memory) = memory.filter(|memory| !(1..MOST_MEMORY).contains(memory)) {
        return Err(errors::input(py, format!("memory: {memory} is no size in MiB, such as 4096")));
    }
    Ok(Plan {
        worker: Worker { program, threads: count(py, "threads", threads)? },
        limits: Limits { time, memory: memory.map(i64::unsigned_abs) },
        side_by_side: NonZeroUsize::MIN,
        retry,
        index: INDEX.to_owned(),
    })
}

/// The JSON texts of a list of jobs, with whole paths.
#[pyfunction]
pub(crate) fn read_list(py: Python<'_>, list: PathBuf) -> PyResult<Vec<String>> {
    let list = std::path::absolute(list)?;
    let jobs = read_jobs(&list, &Job::options()).map_err(|e| errors::batch(py, &e))?;
    Ok(jobs.iter().map(|job| serde_json::to_string(job).unwrap_or_default()).collect())
}

/// Jobs from their JSON texts, whose paths are relative to `folder`.
fn jobs(py: Python<'_>, texts: &[String], folder: &Path) -> PyResult<Vec<Job>> {
    let mut jobs: Vec<Job> = Vec::new();
    let mut ids = HashSet::new();
    for (k, text) in (1..).zip(texts) {
        let job = parse_job(text, folder, &Job::options(), &k.to_string());
        let job = job.map_err(|why| errors::input(py, format!("job {k}: {why}")))?;
        if !ids.insert(job.id.clone()) {
            return Err(errors::input(py, format!("job {k}: the id '{}' is that of another; ids must differ", job.id)));
        }
        jobs.push(job);
    }
    Ok(jobs)
}

/// Makes what the store lacks of these jobs, writes the index, and gives the summary.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python hands them on one by one")]
pub(crate) fn run_batch<'py>(
    py: Python<'py>,
    texts: Vec<String>,
    folder: PathBuf,
    store: PathBuf,
    program: Vec<OsString>,
    side_by_side: Option<isize>,
    time: Option<f64>,
    memory: Option<i64>,
    threads: isize,
    retry: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let jobs = jobs(py, &texts, &folder)?;
    let cores = || std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let side_by_side = side_by_side.map_or_else(|| Ok(cores()), |number| count(py, "side_by_side", number))?;
    let plan = Plan { side_by_side, ..plan(py, program, time, memory, threads, retry)? };
    let done = with_signals(py, None, progress.as_ref(), move |telling| {
        let store = Store::open(&store)?;
        let flag = telling.stop();
        run(&jobs, &store, &plan, &|| flag.load(Ordering::Relaxed), &mut |event| {
            if let Event::Known(known, all) = event {
                telling.say("batch", known as f64 / all.max(1) as f64);
            }
        })
    })?;
    let summary = done.map_err(|e| errors::batch(py, &e))?;
    parsed(py, serde_json::to_string(&summary).unwrap_or_default().as_bytes())
}

/// Makes one job, unless the store has it, and gives its line of the index.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python hands them on one by one")]
pub(crate) fn run_job<'py>(
    py: Python<'py>,
    text: String,
    folder: PathBuf,
    store: PathBuf,
    program: Vec<OsString>,
    time: Option<f64>,
    memory: Option<i64>,
    threads: isize,
    retry: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let job = jobs(py, &[text], &folder)?.swap_remove(0);
    let plan = plan(py, program, time, memory, threads, retry)?;
    let line = with_signals(py, Some(1), None, move |telling| {
        let store = Store::open(&store)?;
        let flag = telling.stop();
        run_one(&job, &store, &plan, &|| flag.load(Ordering::Relaxed))
    })?;
    let line = line.map_err(|e| errors::batch(py, &e))?;
    parsed(py, serde_json::to_string(&line).unwrap_or_default().as_bytes())
}

/// The command line: its arguments, the first of which is the program's name, and the command that starts it again.
/// Gives the exit code.
#[pyfunction]
pub(crate) fn cli(py: Python<'_>, arguments: Vec<OsString>, itself: Vec<OsString>) -> u8 {
    py.detach(|| toile::cli::main_with(arguments, &itself))
}
