//! The functions behind `toile.batch`, and the command line.

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use toile::batch::{
    BatchJob, BatchPlan, Event, INDEX, Limits, PANICKED, Store, Worker, check_jobs, garments_of_folder, read_jobs, run,
    run_one,
};

use crate::arguments::Count;
use crate::errors;
use crate::result::parsed;
use crate::work::with_signals;

/// Most memory that a job may be given, MiB: more is more than a number of bytes holds.
const MOST_MEMORY: i64 = 1 << 40;

/// Time between two looks for a folder, which may be on another machine.
const LOOK_AT_FOLDER: Duration = Duration::from_millis(500);

/// A number of threads or jobs.
fn count(py: Python<'_>, name: &str, Count(number): Count) -> PyResult<NonZeroUsize> {
    let positive = usize::try_from(number).ok().and_then(NonZeroUsize::new);
    positive.ok_or_else(|| errors::input(py, format!("{name}: at least one is needed, not {number}")))
}

/// How jobs are made.
fn plan(
    py: Python<'_>,
    program: Vec<OsString>,
    time: Option<f64>,
    memory: Option<Count>,
    threads: Count,
    retry: bool,
) -> PyResult<BatchPlan> {
    let duration = |s: f64| Duration::try_from_secs_f64(s).ok().filter(|time| !time.is_zero());
    let wrong_time = |s: f64| errors::input(py, format!("time: {s} is no positive number of seconds, such as 1200"));
    let time = time.map(|s| duration(s).ok_or_else(|| wrong_time(s))).transpose()?;
    let memory = memory.map(|Count(mebibytes)| mebibytes);
    if let Some(memory) = memory.filter(|memory| !(1..MOST_MEMORY).contains(memory)) {
        return Err(errors::input(py, format!("memory: {memory} is no size in MiB, such as 4096")));
    }
    Ok(BatchPlan {
        worker: Worker { program, threads: count(py, "threads", threads)? },
        limits: Limits { time, memory: memory.map(i64::unsigned_abs) },
        side_by_side: NonZeroUsize::MIN,
        retry,
        index: INDEX.to_owned(),
    })
}

/// The JSON texts of a list of jobs, or of the garments of a folder, with whole paths.
#[pyfunction]
pub(crate) fn read_list(py: Python<'_>, list: PathBuf) -> PyResult<Vec<String>> {
    let options = BatchJob::options();
    let jobs = if list.is_dir() {
        garments_of_folder(&list, &options).map(|found| found.jobs)
    } else {
        read_jobs(&list, &options)
    };
    Ok(as_texts(&jobs.map_err(|e| errors::batch(py, &e))?))
}

/// The same jobs with whole paths and an id each, if all of them are right. Their paths are relative to the folder that
/// the program is in.
#[pyfunction]
pub(crate) fn check_list(py: Python<'_>, texts: Vec<String>) -> PyResult<Vec<String>> {
    Ok(as_texts(&jobs(py, &texts)?))
}

fn as_texts(jobs: &[BatchJob]) -> Vec<String> {
    jobs.iter().map(|job| serde_json::to_string(job).unwrap_or_default()).collect()
}

/// Jobs from their JSON texts.
fn jobs(py: Python<'_>, texts: &[String]) -> PyResult<Vec<BatchJob>> {
    let numbered = (1..).zip(texts.iter().map(String::as_str));
    check_jobs(numbered, "job", Path::new(""), &BatchJob::options()).map_err(|mistakes| errors::jobs(py, &mistakes))
}

/// A work folder of the store, which is there as long as this is held. Jobs on a cluster that are made for it end when
/// it is gone.
#[pyclass(frozen, module = "toile", name = "_Hold")]
pub(crate) struct Hold(Mutex<Option<Store>>);

#[pymethods]
impl Hold {
    #[new]
    fn new(py: Python<'_>, store: PathBuf) -> PyResult<Self> {
        let store = py.detach(|| Store::open(&store)).map_err(|e| errors::batch(py, &e))?;
        Ok(Self(Mutex::new(Some(store))))
    }

    /// The work folder.
    #[getter]
    fn folder(&self) -> Option<PathBuf> {
        self.0.lock().ok()?.as_ref().map(|store| store.work().to_owned())
    }

    /// Gives the work folder up.
    fn release(&self, py: Python<'_>) {
        let held = self.0.lock().ok().and_then(|mut held| held.take());
        py.detach(|| drop(held));
    }
}

/// Makes what the store lacks of these jobs, writes the index, and gives the summary.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python hands them on one by one")]
pub(crate) fn run_batch<'py>(
    py: Python<'py>,
    texts: Vec<String>,
    store: PathBuf,
    program: Vec<OsString>,
    side_by_side: Option<Count>,
    time: Option<f64>,
    memory: Option<Count>,
    threads: Count,
    retry: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let jobs = jobs(py, &texts)?;
    let cores = || std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN);
    let side_by_side = side_by_side.map_or_else(|| Ok(cores()), |number| count(py, "side_by_side", number))?;
    let plan = BatchPlan { side_by_side, ..plan(py, program, time, memory, threads, retry)? };
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

/// Makes one job, unless the store has it, and gives its line of the index. It ends early when the folder `held` is
/// gone.
#[pyfunction]
#[allow(clippy::too_many_arguments, reason = "Python hands them on one by one")]
pub(crate) fn run_job<'py>(
    py: Python<'py>,
    text: String,
    store: PathBuf,
    held: PathBuf,
    program: Vec<OsString>,
    time: Option<f64>,
    memory: Option<Count>,
    threads: Count,
    retry: bool,
) -> PyResult<Bound<'py, PyAny>> {
    let job = jobs(py, &[text])?.swap_remove(0);
    let plan = plan(py, program, time, memory, threads, retry)?;
    let line = with_signals(py, Some(Count(1)), None, move |telling| {
        let store = Store::open(&store)?;
        let flag = telling.stop();
        let given_up = watched(held);
        run_one(&job, &store, &plan, &|| flag.load(Ordering::Relaxed) || given_up())
    })?;
    let line = line.map_err(|e| errors::batch(py, &e))?;
    parsed(py, serde_json::to_string(&line).unwrap_or_default().as_bytes())
}

/// Whether a folder is gone, looked for now and then.
fn watched(folder: PathBuf) -> impl Fn() -> bool + Sync {
    let seen = Mutex::new((Instant::now(), folder.is_dir()));
    move || {
        let Ok(mut seen) = seen.lock() else { return false };
        if seen.0.elapsed() > LOOK_AT_FOLDER {
            *seen = (Instant::now(), folder.is_dir());
        }
        !seen.1
    }
}

/// The command line: its arguments, the first of which is the program's name, and the command that starts it again.
/// Gives the exit code.
#[pyfunction]
pub(crate) fn cli(py: Python<'_>, arguments: Vec<OsString>, itself: Vec<OsString>) -> u8 {
    // A fault of the program itself is told apart from an exception of Python's, which ends a process with 1.
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(|| toile::cli::main_with(arguments, &itself))));
    done.unwrap_or(PANICKED)
}
