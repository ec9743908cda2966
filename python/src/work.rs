//! Anything long: without the interpreter's lock, on threads of its own, ended by Ctrl-C.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError, Sender};
use std::time::Duration;

use pyo3::prelude::*;

use crate::errors;

/// Time between two looks for a signal: what a person takes for at once.
const LOOK: Duration = Duration::from_millis(50);
/// Stack of a thread, bytes, as the command line has it.
const STACK: usize = 8 << 20;

/// What a stage's work unwinds with when it was asked to end. No stage holds anything that unwinding would break: all
/// that it has made is dropped.
struct Ended;

/// What work tells while it runs.
pub(crate) struct Telling<'a> {
    stop: &'a AtomicBool,
    send: Sender<(String, f64)>,
}

impl Telling<'_> {
    /// Tells how far a stage is. Does not return when the work is to end.
    pub(crate) fn tell(&mut self, stage: &str, share: f64) {
        if self.stopped() {
            resume_unwind(Box::new(Ended));
        }
        self.say(stage, share);
    }

    /// Tells how far a stage is, and returns in any case.
    pub(crate) fn say(&self, stage: &str, share: f64) {
        // Nobody listens any more when the work is about to be ended.
        let _ = self.send.send((stage.to_owned(), share));
    }

    /// Whether the work is to end.
    pub(crate) fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// The flag behind [`Self::stopped`].
    pub(crate) fn stop(&self) -> &AtomicBool {
        self.stop
    }
}

/// Does the work on `threads` threads (all processors, without a number), while this thread waits for Python's signals
/// and calls `progress(stage, share)`.
///
/// # Errors
/// What `progress` or a signal's handler raises, such as KeyboardInterrupt. The work has ended then.
pub(crate) fn with_signals<T: Send>(
    py: Python<'_>,
    threads: Option<usize>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&mut Telling) -> T + Send,
) -> PyResult<T> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads.unwrap_or(0)).stack_size(STACK).build();
    let pool = pool.map_err(|e| errors::input(py, format!("cannot start the threads: {e}; try fewer")))?;
    let stop = AtomicBool::new(false);
    let (send, told) = mpsc::channel();
    let mut raised = Ok(());
    let stop = &stop;
    let (outcome, raised) = py.detach(move || {
        std::thread::scope(|scope| {
            let mut telling = Telling { stop, send };
            let done = scope.spawn(move || {
                let work = AssertUnwindSafe(|| pool.install(|| work(&mut telling)));
                catch_unwind(work)
            });
            while raised.is_ok() {
                match told.recv_timeout(LOOK) {
                    Ok(said) => raised = heard(said, &told, progress),
                    Err(RecvTimeoutError::Timeout) => raised = Python::attach(|py| py.check_signals()),
                    Err(RecvTimeoutError::Disconnected) => break,
                }
            }
            stop.store(raised.is_err(), Ordering::Relaxed);
            (done.join(), raised)
        })
    });
    raised?;
    match outcome {
        Ok(Ok(value)) => Ok(value),
        // A fault of the program itself: PyO3 makes an exception of it.
        Ok(Err(panic)) | Err(panic) => resume_unwind(panic),
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
