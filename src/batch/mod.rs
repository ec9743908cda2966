//! Many garments: a list of jobs, each made by a process of its own, into a store that survives being killed.
//!
//! ```text
//! jobs ─▶ key ─────────────────▶ process ─────────▶ seal ──────────▶ index
//!         hash of the content     toile make into    one rename into   one line a job
//!         and toile's build       a work folder      STORE/KEY
//! ```
//!
//! The folders of the store are the truth, and `index.jsonl` is written from them. A job is done when its folder is
//! there, which a single rename puts there whole. So a batch can be killed anywhere and started again, and several can
//! work into one store at the same time.

mod error;
mod folder;
mod inputs;
mod job;
mod key;
mod process;
mod sample;
mod store;

use std::collections::HashMap;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;

use rayon::prelude::*;
use serde::Serialize;

pub use error::{BatchError, Mistake};
pub use folder::{Garments, garments_of_folder};
pub use job::{BatchJob, check_jobs, parse_job, read_jobs};
pub use key::{BUILD, Digests, JobKey};
pub use process::{
    ASKED_TO_END, Limits, PANICKED, WORKER_CANNOT_WRITE, WORKER_EXIT, WORKER_NO_MEMORY, Worker, become_worker,
};
pub use sample::{SampleChoice, list_text, sample};
pub use store::{INDEX, JobState, Record, Store};

/// How jobs are made.
#[derive(Clone, Debug)]
pub struct BatchPlan {
    /// The program that makes one garment.
    pub worker: Worker,
    /// Limits of every job.
    pub limits: Limits,
    /// Jobs that run side by side.
    pub side_by_side: NonZeroUsize,
    /// Make jobs anew that failed before.
    pub retry: bool,
    /// Name of the index file in the store.
    pub index: String,
}

/// A job's line of the index.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct IndexLine {
    /// The job's id.
    pub id: String,
    /// Whether there is a garment.
    pub state: JobState,
    /// Exit code of `toile make`: 0 or 1 of a job that is done. Absent if a limit or a signal ended it.
    pub exit: Option<i32>,
    /// Wall-clock time, s.
    pub seconds: f64,
    /// Folder of the result or of what is known of the failure, from the store. Absent if nothing could be kept.
    pub folder: Option<String>,
    /// Why it failed.
    pub error: Option<String>,
}

impl IndexLine {
    fn new(id: &str, record: &Record) -> Self {
        Self {
            id: id.to_owned(),
            state: record.state,
            exit: record.exit,
            seconds: record.seconds,
            folder: record.kept.then(|| store::folder_name(record.state, &record.key)),
            error: record.error.clone(),
        }
    }
}

/// Something that happened in a batch.
#[derive(Debug)]
pub enum Event<'a> {
    /// So many jobs of so many are known to be done or failed.
    Known(usize, usize),
    /// A job has ended.
    Ended(&'a IndexLine),
}

/// How a batch went.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Summary {
    /// Jobs of the list.
    pub jobs: usize,
    /// Those with a garment.
    pub done: usize,
    /// Of these, garments out of their own bounds (exit code 1).
    pub out_of_bounds: usize,
    /// Those without.
    pub failed: usize,
    /// Jobs whose outcome was known before.
    pub known_before: usize,
}

/// Makes the jobs that the store does not have yet, and writes the index. `stop` is asked often. If it says yes, the
/// jobs under way are ended and left for the next time.
///
/// # Errors
/// [`BatchError`]: a store that cannot be written, a program that cannot be started, or a stop. Results until then
/// are kept.
pub fn run(
    jobs: &[BatchJob],
    store: &Store,
    plan: &BatchPlan,
    stop: &(dyn Fn() -> bool + Sync),
    tell: &mut dyn FnMut(Event),
) -> Result<Summary, BatchError> {
    let digests = Digests::default();
    let keys: Vec<JobKey> = jobs.par_iter().map(|job| JobKey::of(job, &digests)).collect();
    let mut known: HashMap<&JobKey, Record> = HashMap::new();
    let mut left: Vec<usize> = Vec::new();
    let mut asked_for: HashMap<&JobKey, Vec<usize>> = HashMap::new();
    for (k, key) in keys.iter().enumerate() {
        let same = asked_for.entry(key).or_default();
        same.push(k);
        if same.len() > 1 {
            continue;
        }
        match store.record(key, plan.retry) {
            Some(record) => drop(known.insert(key, record)),
            None => left.push(k),
        }
    }
    let before = keys.iter().filter(|key| known.contains_key(key)).count();
    let lines = |known: &HashMap<&JobKey, Record>| -> Vec<IndexLine> {
        let record = |(job, key): (&BatchJob, &JobKey)| known.get(key).map(|record| IndexLine::new(&job.id, record));
        jobs.iter().zip(&keys).filter_map(record).collect()
    };
    store.write_index(&plan.index, &lines(&known))?;
    tell(Event::Known(before, jobs.len()));
    let mut ended = before;
    let made = side_by_side(&left, jobs, &keys, store, plan, stop, &mut |k, record| {
        let same = &asked_for[&keys[k]];
        let new: Vec<IndexLine> = same.iter().map(|&k| IndexLine::new(&jobs[k].id, &record)).collect();
        known.insert(&keys[k], record);
        store.append_index(&plan.index, &new)?;
        ended += new.len();
        new.iter().for_each(|line| tell(Event::Ended(line)));
        tell(Event::Known(ended, jobs.len()));
        Ok(())
    });
    let lines = lines(&known);
    store.write_index(&plan.index, &lines)?;
    made?;
    let done = lines.iter().filter(|line| line.state == JobState::Done);
    Ok(Summary {
        jobs: jobs.len(),
        done: done.clone().count(),
        out_of_bounds: done.filter(|line| line.exit != Some(0)).count(),
        failed: lines.iter().filter(|line| line.state == JobState::Failed).count(),
        known_before: before,
    })
}

/// Makes one job, unless the store has it, and gives its line of the index, which is not written.
///
/// # Errors
/// As of [`run`].
pub fn run_one(
    job: &BatchJob,
    store: &Store,
    plan: &BatchPlan,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<IndexLine, BatchError> {
    let key = JobKey::of(job, &Digests::default());
    let record = match store.record(&key, plan.retry) {
        Some(record) => record,
        None => process::make(job, &key, store, plan, stop)?,
    };
    Ok(IndexLine::new(&job.id, &record))
}

/// Makes the jobs `left`, several at a time, and hands each outcome to `take` as it comes. After the first error no
/// job is begun, and those under way are ended.
fn side_by_side(
    left: &[usize],
    jobs: &[BatchJob],
    keys: &[JobKey],
    store: &Store,
    plan: &BatchPlan,
    stop: &(dyn Fn() -> bool + Sync),
    take: &mut dyn FnMut(usize, Record) -> Result<(), BatchError>,
) -> Result<(), BatchError> {
    let (next, over) = (AtomicUsize::new(0), AtomicBool::new(false));
    let stopped = || over.load(Ordering::Relaxed) || stop();
    let (send, outcomes) = mpsc::channel();
    let mut result = Ok(());
    std::thread::scope(|scope| {
        for _ in 0..plan.side_by_side.get().min(left.len()) {
            let (send, next, stopped) = (send.clone(), &next, &stopped);
            scope.spawn(move || {
                while let Some(&k) = left.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let outcome = process::make(&jobs[k], &keys[k], store, plan, stopped);
                    let failed = outcome.is_err();
                    if send.send((k, outcome)).is_err() || failed {
                        break;
                    }
                }
            });
        }
        drop(send);
        for (k, outcome) in outcomes {
            let taken = outcome.and_then(|record| take(k, record));
            // The first error is the cause; the others are the jobs that it ended.
            if let Err(error) = taken {
                over.store(true, Ordering::Relaxed);
                if result.is_ok() {
                    result = Err(error);
                }
            }
        }
    });
    result
}
