//! The store: a folder a job, the index, and the work folders of the processes that are at it.
//!
//! ```text
//! STORE/index.jsonl      one line a job of the last list
//! STORE/KEY/             a result: the files of `toile make`, job.json, log.txt
//! STORE/failed/KEY/      a failure: job.json with the reason, log.txt, input/, what there was of a result
//! STORE/.work/NAME/      what a running batch has not finished; NAME/lock is locked while it runs
//! ```

use std::fmt::Display;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use serde::{Deserialize, Serialize};

use super::IndexLine;
use super::error::BatchError;
use super::inputs::{Input, keep_inputs};
use super::job::BatchJob;
use super::key::{BUILD, JobKey};
use crate::io::files::write_all;

/// The index.
pub const INDEX: &str = "index.jsonl";
/// Name of the file in a job's folder with its record.
const RECORD: &str = "job.json";
/// Name of the file in a job's folder with the output of `toile make`.
pub(super) const LOG: &str = "log.txt";
/// Folder of the failures.
const FAILED: &str = "failed";
/// Folder of the work folders.
const WORK: &str = ".work";
/// Locked by a process as long as it uses its work folder.
const LOCK: &str = "lock";

/// Whether there is a garment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum JobState {
    /// It was made, within its bounds or not.
    Done,
    /// It was not.
    Failed,
}

/// How a job ended.
#[derive(Clone, Debug)]
pub struct Record {
    /// Its folder's name.
    pub key: JobKey,
    /// Whether there is a garment.
    pub state: JobState,
    /// Exit code of `toile make`.
    pub exit: Option<i32>,
    /// Wall-clock time, s.
    pub seconds: f64,
    /// Why it failed.
    pub error: Option<String>,
    /// Whether there is a folder of it in the store.
    pub kept: bool,
}

/// The record as it is written.
#[derive(Serialize, Deserialize)]
struct WrittenRecord {
    toile: String,
    /// Absent in records of toile before it knew its build.
    #[serde(default)]
    build: String,
    key: String,
    state: JobState,
    exit: Option<i32>,
    seconds: f64,
    error: Option<String>,
    /// As it was asked for: a hint for people, of which nothing is read.
    #[serde(default, skip_deserializing)]
    job: serde_json::Value,
    /// The files that a failure was made from.
    #[serde(default, skip_deserializing, skip_serializing_if = "Vec::is_empty")]
    inputs: Vec<Input>,
}

/// A job's folder from the store.
pub(super) fn folder_name(state: JobState, key: &JobKey) -> String {
    match state {
        JobState::Done => key.to_string(),
        JobState::Failed => format!("{FAILED}/{key}"),
    }
}

/// A folder of results that this process may add to. Its work folder is removed when it is dropped.
#[derive(Debug)]
pub struct Store {
    root: PathBuf,
    work: PathBuf,
    /// Locked until the process ends, however it ends.
    lock: Option<File>,
    /// Number of the next folder in the work folder.
    next: AtomicUsize,
}

impl Store {
    /// Opens a store, or makes it. Work folders of processes that ended without clearing them are removed; those of
    /// processes that still run are left alone.
    ///
    /// # Errors
    /// [`BatchError::Store`].
    pub fn open(root: &Path) -> Result<Self, BatchError> {
        let all = root.join(WORK);
        let failed = |e: io::Error| fault(&all, e);
        fs::create_dir_all(&all).map_err(failed)?;
        // Held while work folders come and go: a folder that is not locked yet must not look like one left behind.
        let gate = locked(&all.join(LOCK)).map_err(failed)?;
        clear_left_behind(&all).map_err(failed)?;
        let work = (0..)
            .map(|n| all.join(format!("{}-{n}", std::process::id())))
            .find(|folder| !folder.exists())
            .unwrap_or_else(|| all.join("work"));
        fs::create_dir(&work).map_err(failed)?;
        let lock = locked(&work.join(LOCK)).map_err(failed)?;
        drop(gate);
        Ok(Self { root: root.to_owned(), work, lock: Some(lock), next: AtomicUsize::new(0) })
    }

    /// The record of a job. A failure that is to be tried again has none.
    pub fn record(&self, key: &JobKey, retry: bool) -> Option<Record> {
        let done = self.read_record(JobState::Done, key);
        done.or_else(|| self.read_record(JobState::Failed, key).filter(|_| !retry))
    }

    fn read_record(&self, state: JobState, key: &JobKey) -> Option<Record> {
        let text = fs::read_to_string(self.folder(state, key).join(RECORD)).ok()?;
        let written: WrittenRecord = serde_json::from_str(&text).ok()?;
        let WrittenRecord { exit, seconds, error, .. } = written;
        (written.state == state).then(|| Record { key: key.clone(), state, exit, seconds, error, kept: true })
    }

    fn folder(&self, state: JobState, key: &JobKey) -> PathBuf {
        self.root.join(folder_name(state, key))
    }

    /// A new folder in the work folder, that does not exist yet.
    pub(super) fn scratch(&self) -> PathBuf {
        self.work.join(self.next.fetch_add(1, Ordering::Relaxed).to_string())
    }

    /// Puts a job's folder in its place: complete with its record, by one rename. If another process was first, its
    /// result stays, which is the same.
    pub(super) fn seal(&self, folder: &Path, job: &BatchJob, record: &Record) -> Result<(), BatchError> {
        let target = self.folder(record.state, &record.key);
        let failed = |e: io::Error| fault(&target, e);
        let mut inputs = Vec::new();
        if record.state == JobState::Failed {
            inputs = keep_inputs(folder, job).map_err(failed)?;
            fs::create_dir_all(self.root.join(FAILED)).map_err(failed)?;
        }
        name_places(folder, &target).map_err(failed)?;
        let written = WrittenRecord {
            toile: env!("CARGO_PKG_VERSION").to_owned(),
            build: BUILD.to_owned(),
            key: record.key.to_string(),
            state: record.state,
            exit: record.exit,
            seconds: record.seconds,
            error: record.error.clone(),
            job: serde_json::to_value(job).unwrap_or_default(),
            inputs,
        };
        let text = serde_json::to_vec_pretty(&written).map_err(|e| failed(e.into()))?;
        fs::write(folder.join(RECORD), text).map_err(failed)?;
        // What lies there is of an attempt before, or broken, unless another process has just been first.
        let first = record.state == JobState::Done && self.read_record(JobState::Done, &record.key).is_some();
        if first {
            return fs::remove_dir_all(folder).map_err(failed);
        }
        if target.exists() {
            fs::rename(&target, self.scratch()).map_err(failed)?;
        }
        fs::rename(folder, &target).map_err(failed)?;
        if record.state == JobState::Done {
            remove(&self.folder(JobState::Failed, &record.key)).map_err(failed)?;
        }
        Ok(())
    }

    /// Replaces an index by these lines.
    ///
    /// # Errors
    /// [`BatchError::Store`].
    pub(super) fn write_index(&self, name: &str, lines: &[IndexLine]) -> Result<(), BatchError> {
        let path = self.root.join(name);
        let text = index_text(lines);
        write_all(&[(path.clone(), text)], &[]).map_err(|e| fault(&path, e))
    }

    /// Adds lines to an index while a batch runs. If it is killed here, half a line may stay until it starts again.
    ///
    /// # Errors
    /// [`BatchError::Store`].
    pub(super) fn append_index(&self, name: &str, lines: &[IndexLine]) -> Result<(), BatchError> {
        let path = self.root.join(name);
        let opened = OpenOptions::new().append(true).create(true).open(&path);
        opened.and_then(|mut file| file.write_all(&index_text(lines))).map_err(|e| fault(&path, e))
    }

    /// The work folder of this process, which is there as long as the store is open.
    pub fn work(&self) -> &Path {
        &self.work
    }

    /// The path of an index.
    pub fn index(&self, name: &str) -> PathBuf {
        self.root.join(name)
    }

    pub(super) fn unwritable(&self, why: impl Display) -> BatchError {
        fault(&self.root, why)
    }
}

impl Drop for Store {
    fn drop(&mut self) {
        // Unlocked first: some systems remove no file that is open. If it fails, the next batch does it.
        drop(self.lock.take());
        let _ = fs::remove_dir_all(&self.work);
    }
}

fn fault(path: &Path, why: impl Display) -> BatchError {
    BatchError::Store { path: path.to_owned(), why: why.to_string() }
}

fn index_text(lines: &[IndexLine]) -> Vec<u8> {
    let text = |line: &IndexLine| serde_json::to_string(line).unwrap_or_default() + "\n";
    lines.iter().map(text).collect::<String>().into_bytes()
}

/// The file at `path`, locked by this process as soon as no other holds it.
fn locked(path: &Path) -> io::Result<File> {
    let file = OpenOptions::new().write(true).create(true).truncate(false).open(path)?;
    file.lock()?;
    Ok(file)
}

/// Removes the work folders that nobody holds a lock in. The caller holds the gate.
fn clear_left_behind(all: &Path) -> io::Result<()> {
    for entry in fs::read_dir(all)? {
        let folder = entry?.path();
        if !folder.is_dir() {
            continue;
        }
        let in_use = match OpenOptions::new().write(true).open(folder.join(LOCK)) {
            Ok(file) => file.try_lock().is_err(),
            Err(_) => false,
        };
        if !in_use {
            remove(&folder)?;
        }
    }
    Ok(())
}

/// Removes a folder, if there is one. A process that has lost its batch may add a last file to it meanwhile, which the
/// next attempt removes.
fn remove(folder: &Path) -> io::Result<()> {
    match fs::remove_dir_all(folder) {
        Err(e) if !matches!(e.kind(), io::ErrorKind::NotFound | io::ErrorKind::DirectoryNotEmpty) => Err(e),
        _ => Ok(()),
    }
}

/// Has the log name the folder that its files will be in, instead of the one that they were written into.
fn name_places(folder: &Path, target: &Path) -> io::Result<()> {
    let log = folder.join(LOG);
    let Ok(bytes) = fs::read(&log) else { return Ok(()) };
    let text = String::from_utf8_lossy(&bytes);
    fs::write(&log, text.replace(&folder.display().to_string(), &target.display().to_string()))
}
