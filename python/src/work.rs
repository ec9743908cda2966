//! Anything long: without the interpreter's lock, on threads of its own, ended by Ctrl-C.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::time::Duration;

use pyo3::prelude::*;

use crate::arguments::Count;
use crate::errors;

/// Time between two looks for a signal: what a person takes for at once.
const LOOK: Duration = Duration::from_millis(50);
/// Longest time that work which is to end is waited for. A stage may tell nothing for longer; it then ends by itself.
const PATIENCE: Duration = Duration::from_secs(2);
/// Most threads that are started, as by the command line: every one takes a stack.
const MOST_THREADS: usize = 256;
/// Stack of a thread, bytes, as the command line has it.
const STACK: usize = 8 << 20;

/// What a stage's work unwinds with when it was asked to end. No stage holds anything that unwinding would break: all
/// that it has made is dropped.
struct Ended;

/// What work tells while it runs.
pub(crate) struct Telling {
    stop: Arc<AtomicBool>,
    send: Sender<(String, f64)>,
}

impl Telling {
    /// Tells how far a stage is. Does not return when the work is to end.
    pub(crate) fn tell(&mut self, stage: &str, share: f64) {
        if self.stop.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Ended));
        }
        self.say(stage, share);
    }

    /// Tells how far a stage is, and returns in any case.
    pub(crate) fn say(&self, stage: &str, share: f64) {
        // Nobody listens any more when the work is about to be ended.
        let _ = self.send.send((stage.to_owned(), share));
    }

    /// The flag that says whether the work is to end.
    pub(crate) fn stop(&self) -> Arc<AtomicBool> {
        self.stop.clone()
    }
}

/// Does the work on `threads` threads (all processors, without a number), while this thread waits for Python's signals
/// and calls `progress(stage, share)`.
///
/// # Errors
/// What `progress` or a signal's handler raises, such as KeyboardInterrupt. The work ends then when it next tells
/// something, which is not waited for longer than [`PATIENCE`].
pub(crate) fn with_signals<T: Send + 'static>(
    py: Python<'_>,
    threads: Option<Count>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&mut Telling) -> T + Send + 'static,
) -> PyResult<T> {
    if threads.is_some_and(|Count(threads)| threads < 1) {
        return Err(errors::input(py, "threads: at least one is needed; leave it out to have all processors"));
    }
    let threads =
        threads.map_or(0, |Count(threads)| usize::try_from(threads).unwrap_or(MOST_THREADS).min(MOST_THREADS));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).stack_size(STACK).build();
    let pool = pool.map_err(|e| errors::input(py, format!("cannot start the threads: {e}; try fewer")))?;
    let stop = Arc::new(AtomicBool::new(false));
    let (send, told) = mpsc::channel();
    let (end, outcome) = mpsc::channel();
    let mut telling = Telling { stop: stop.clone(), send };
    std::thread::spawn(move || {
        let done = catch_unwind(AssertUnwindSafe(|| pool.install(|| work(&mut telling))));
        // Nobody may wait for it any more.
        let _ = end.send(done);
    });
    let raised = py.detach(move || {
        let raised = listen(&told, progress);
        (raised, told)
    });
    let (raised, _) = raised;
    if raised.is_err() {
        stop.store(true, Ordering::Relaxed);
    }
    let waiting = if raised.is_err() { PATIENCE } else { Duration::MAX };
    let outcome = py.detach(move || outcome.recv_timeout(waiting));
    raised?;
    match outcome {
        Ok(Ok(value)) => Ok(value),
        // A fault of the program itself: PyO3 makes an exception of it.
        Ok(Err(panic)) => resume_unwind(panic),
        Err(_) => Err(errors::input(py, "the work ended without a result")),
    }
}

/// Hands on what is told and looks for signals, until the work has ended or something is raised.
fn listen(told: &Receiver<(String, f64)>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    loop {
        match told.recv_timeout(LOOK) {
            Ok(said) => heard(said, told, progress)?,
            Err(RecvTimeoutError::Timeout) => Python::attach(|py| py.check_signals())?,
            Err(RecvTimeoutError::Disconnected) => return Ok(()),
        }
    }
}

/// Hands on what was told last; of what came meanwhile only a new stage matters.
fn heard(mut said: (String, f64), told: &mpsc::Receiver<(String, f64)>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    Python::attach(|py| {
        py.check_signals()?;
        let call = |(stage, share): &(String, f64)| match progress {
            Some(progress) => progress.call1(py, (stage, share.clamp(0.0, 1.0))).map(drop),
            None => Ok(()),
        };
        while let Ok(next) = told.try_recv() {
            if next.0 != said.0 {
                call(&said)?;
            }
            said = next;
        }
        call(&said)
    })
}
