//! One job in a process of its own, within its limits.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, Read as _};
use std::num::NonZeroUsize;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use super::BatchPlan;
use super::error::BatchError;
use super::job::BatchJob;
use super::key::{Digests, JobKey};
use super::store::{JobState, LOG, Record, Store};
use crate::input::shown;
use crate::io::files::abandon;
use crate::io::result_names::{GARMENT_OBJ, REPORT_JSON};

/// Exit codes of a worker are those of its command and this number. A worker that toile did not end, as a Python that
/// does not find toile, has others.
pub const WORKER_EXIT: u8 = 80;
/// Exit code of a worker that cannot write its results: then the store is at fault, not the job.
pub const WORKER_CANNOT_WRITE: u8 = 74;
/// Exit code of a worker that its memory limit does not let begin.
pub const WORKER_NO_MEMORY: u8 = 75;
/// Exit code of a Rust program that has panicked: a fault of toile, which one garment may have and another not.
pub const PANICKED: u8 = 101;
/// Exit code of a program that is asked to end by a signal, as by Ctrl-C: 128 and the signal's number.
pub const ASKED_TO_END: u8 = 130;
/// Codes that a command ends with when there is a result, and when there is none.
const MADE: [i32; 2] = [0, 1];
const NOT_MADE: [i32; 2] = [2, 3];
/// Time between two looks at a process: short beside the quickest garments (0.1 s), and hardly any work.
const LOOK: Duration = Duration::from_millis(10);
/// Characters of an error in the index.
const MESSAGE: usize = 2000;
/// Bytes at the end of a log in which the error is looked for.
const LOG_END: usize = 64 << 10;
/// Files that every result has.
const RESULTS: [&str; 2] = [GARMENT_OBJ, REPORT_JSON];
/// Messages with which Rust's and Python's programs end that get no memory.
const NO_MEMORY: [&str; 2] = ["memory allocation of", "MemoryError"];
/// A mebibyte, the unit of memory limits.
const MIB: u64 = 1 << 20;

/// Limits of a job. None is unlimited.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Wall-clock time.
    pub time: Option<Duration>,
    /// Address space, MiB. It is enforced on Linux and other Unix systems that have the limit (`RLIMIT_AS`).
    pub memory: Option<u64>,
}

/// The program that makes one garment: toile itself.
#[derive(Clone, Debug)]
pub struct Worker {
    /// The program and its first arguments: `toile`, or `python -m toile`.
    pub program: Vec<OsString>,
    /// Its threads.
    pub threads: NonZeroUsize,
}

impl Worker {
    /// Its first words, for messages.
    fn shown(&self) -> String {
        self.program.iter().map(|word| word.to_string_lossy()).collect::<Vec<_>>().join(" ")
    }
}

/// Makes a process a batch's worker: it ends when the batch does, however that ends, and it gets no more than so many
/// MiB of memory. Called by the command line of the worker, first of all.
///
/// # Errors
/// [`BatchError::Limit`] when the system has no such limit.
pub fn become_worker(memory: u64) -> Result<(), BatchError> {
    // The thread is started first: it takes memory, too.
    end_with_batch().map_err(|e| BatchError::Limit(e.to_string()))?;
    if memory > 0 { limit_memory(memory * MIB) } else { Ok(()) }
}

fn end_with_batch() -> io::Result<()> {
    // The batch holds the other end and never writes. The system closes it with the batch.
    let watch = || {
        let mut byte = [0];
        while io::stdin().read(&mut byte).is_ok_and(|read| read > 0) {}
        abandon()
    };
    std::thread::Builder::new().stack_size(64 << 10).spawn(watch).map(drop)
}

#[cfg(all(unix, not(target_os = "openbsd")))]
fn limit_memory(bytes: u64) -> Result<(), BatchError> {
    use nix::sys::resource::{Resource, setrlimit};
    setrlimit(Resource::RLIMIT_AS, bytes, bytes).map_err(|e| BatchError::Limit(e.to_string()))
}

#[cfg(not(all(unix, not(target_os = "openbsd"))))]
fn limit_memory(_: u64) -> Result<(), BatchError> {
    Err(BatchError::Limit("this system has no such limit; leave out --memory".into()))
}

/// Makes a job and seals its folder in the store.
pub(super) fn make(
    job: &BatchJob,
    key: &JobKey,
    store: &Store,
    plan: &BatchPlan,
    stop: &(dyn Fn() -> bool + Sync),
) -> Result<Record, BatchError> {
    let folder = store.scratch();
    fs::create_dir(&folder).map_err(|e| store.unwritable(e))?;
    let begin = Instant::now();
    let mut child = start(job, &folder, store, plan)?;
    let end = wait(&mut child, begin, plan.limits.time, stop).map_err(|e| store.unwritable(e))?;
    let seconds = begin.elapsed().as_secs_f64();
    let (state, exit, error) = match end {
        ProcessEnd::Stopped => return Err(BatchError::Stopped),
        ProcessEnd::TimeUp(limit) => {
            let why = format!("not done after {} s, the time limit (--time)", limit.as_secs_f64());
            (JobState::Failed, None, Some(why))
        }
        ProcessEnd::Exited(status) => judged(&folder, &status, store, plan)?,
    };
    let mut record = Record { key: key.clone(), state, exit, seconds, error, kept: true };
    if JobKey::of(job, &Digests::default()) != *key {
        // Its folder would bear the name of another content.
        let why = "its input changed while it was made; start again to make it as it is now";
        record = Record { state: JobState::Failed, exit: None, error: Some(why.into()), kept: false, ..record };
        fs::remove_dir_all(&folder).map_err(|e| store.unwritable(e))?;
        return Ok(record);
    }
    store.seal(&folder, job, &record)?;
    Ok(record)
}

/// Whether a worker that has ended made the garment, the exit code of its command, and why it did not.
fn judged(
    folder: &Path,
    status: &ExitStatus,
    store: &Store,
    plan: &BatchPlan,
) -> Result<(JobState, Option<i32>, Option<String>), BatchError> {
    let log = log_end(&folder.join(LOG));
    let Some(code) = status.code() else { return Ok((JobState::Failed, None, Some(failure(&log, status, plan)))) };
    if code == i32::from(WORKER_CANNOT_WRITE) {
        return Err(store.unwritable(message(&log).unwrap_or("it is full or protected")));
    }
    if code == i32::from(WORKER_NO_MEMORY) {
        return Ok((JobState::Failed, None, Some(too_little_memory(plan))));
    }
    let exit = code - i32::from(WORKER_EXIT);
    if MADE.contains(&exit) {
        let missing = RESULTS.into_iter().find(|name| !folder.join(name).is_file());
        return Ok(match missing {
            None => (JobState::Done, Some(exit), None),
            Some(name) => {
                (JobState::Failed, None, Some(format!("it ended without {name}, although it said that all is done")))
            }
        });
    }
    let has_panicked = code == i32::from(PANICKED);
    if NOT_MADE.contains(&exit) || has_panicked {
        let exit = if has_panicked { None } else { Some(exit) };
        return Ok((JobState::Failed, exit, Some(failure(&log, status, plan))));
    }
    if code == i32::from(ASKED_TO_END) {
        return Ok((JobState::Failed, None, Some("its process was asked to end by a signal".into())));
    }
    if plan.limits.memory.is_some() && no_memory(&log) {
        return Ok((JobState::Failed, None, Some(too_little_memory(plan))));
    }
    let last = last_line(&log).unwrap_or("it said nothing").trim_start_matches("error: ");
    Err(BatchError::Worker { program: plan.worker.shown(), code, why: cut(last) })
}

/// Starts the process. Its output goes into the log.
fn start(job: &BatchJob, folder: &Path, store: &Store, plan: &BatchPlan) -> Result<Child, BatchError> {
    let Worker { program, threads } = &plan.worker;
    let log = File::create(folder.join(LOG)).map_err(|e| store.unwritable(e))?;
    let mut words = program.iter();
    let mut command = Command::new(words.next().cloned().unwrap_or_default());
    command.args(words);
    command.arg(format!("--worker={}", plan.limits.memory.unwrap_or(0))).arg(format!("--threads={threads}"));
    // In one word: a folder's name may begin with a dash.
    let mut output = OsString::from("--output=");
    output.push(folder);
    command.arg("make").args(job.arguments()).arg(output).arg("--").args(&job.garment);
    command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(log);
    // Ctrl-C on a terminal is for the batch, which ends its workers.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.spawn().map_err(|source| BatchError::Start { program: plan.worker.shown(), source })
}

enum ProcessEnd {
    Exited(ExitStatus),
    TimeUp(Duration),
    Stopped,
}

fn wait(
    child: &mut Child,
    begin: Instant,
    limit: Option<Duration>,
    stop: &(dyn Fn() -> bool + Sync),
) -> io::Result<ProcessEnd> {
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(ProcessEnd::Exited(status));
        }
        let late = limit.filter(|limit| begin.elapsed() > *limit);
        let stopped = stop();
        if late.is_some() || stopped {
            // It may have ended meanwhile.
            let _ = child.kill();
            child.wait()?;
            return Ok(late.filter(|_| !stopped).map_or(ProcessEnd::Stopped, ProcessEnd::TimeUp));
        }
        std::thread::sleep(LOOK);
    }
}

/// The end of a log, or what can be read of it.
fn log_end(file: &Path) -> String {
    let bytes = fs::read(file).unwrap_or_default();
    String::from_utf8_lossy(&bytes[bytes.len().saturating_sub(LOG_END)..]).into_owned()
}

/// The error that a log ends with: diagnostics of a garment file begin with their places, others with `error:`.
fn message(log: &str) -> Option<&str> {
    let starts = |line: &str| line.starts_with("error: ") || line.contains(": error: ");
    let mut at = 0;
    for line in log.split_inclusive('\n') {
        if starts(line) {
            return Some(log[at..].trim_end());
        }
        at += line.len();
    }
    None
}

/// The last line of a log that says anything.
fn last_line(log: &str) -> Option<&str> {
    log.lines().rev().find(|line| !line.trim().is_empty())
}

fn no_memory(log: &str) -> bool {
    NO_MEMORY.iter().any(|words| log.contains(words))
}

fn too_little_memory(plan: &BatchPlan) -> String {
    plan.limits.memory.map_or_else(
        || "the system has no memory left; run fewer side by side (--jobs)".into(),
        |mib| format!("it needs more than {mib} MiB, the memory limit (--memory)"),
    )
}

/// Why a worker ended without a garment. A worker that the system ends has said only notes, which are no reason.
fn failure(log: &str, status: &ExitStatus, plan: &BatchPlan) -> String {
    if status.code().is_none() && no_memory(log) {
        return too_little_memory(plan);
    }
    let said = message(log).or_else(|| last_line(log).filter(|_| status.code().is_some()));
    let said = said.map(|text| text.strip_prefix("error: ").unwrap_or(text));
    let text = match (said, status.code()) {
        (Some(said), Some(_)) => said.to_owned(),
        (Some(said), None) => format!("ended by the system ({status}): {said}"),
        (None, _) => format!(
            "ended by the system ({status}), which does so when its memory runs out; run fewer side by side (--jobs), \
             or limit each (--memory)"
        ),
    };
    cut(&text)
}

/// The text within the limit, line by line so that lines stay.
fn cut(text: &str) -> String {
    if text.chars().count() <= MESSAGE { text.to_owned() } else { shown(text, MESSAGE) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_error_of_a_log_is_what_stands_behind_the_notes() {
        let log = "a note\nskirt.yaml:3:1: warning: so\nerror: it cannot be sewn\n  help: another --spacing\n";
        assert_eq!(message(log), Some("error: it cannot be sewn\n  help: another --spacing"));
        let log = "skirt.yaml:4:7: error: unknown edge\n  | waist\n";
        assert_eq!(message(log), Some(log.trim_end()));
        assert_eq!(message("a note\n"), None);
    }
}
