//! Messages and results on the terminal.

use std::cell::RefCell;
use std::io::{self, ErrorKind, IsTerminal, Write};

use indicatif::{ProgressBar, ProgressStyle};

use super::exit::CliError;
use crate::batch::BatchError;
use crate::pipeline::{PipelineError, json_text};

/// Standard output and standard error, as `--quiet` and `--json` want them.
pub(super) struct Console {
    quiet: bool,
    json: bool,
    /// Draw progress bars.
    bars: bool,
    /// Somebody may be watching.
    watched: bool,
}

impl Console {
    /// `alone`: a process of a batch, which nobody watches.
    pub(super) fn new(quiet: bool, json: bool, alone: bool) -> Self {
        let watched = !quiet && !json && !alone;
        Self { quiet, json, bars: watched && io::stderr().is_terminal(), watched }
    }

    /// Whether somebody may be watching the results as they come.
    pub(super) fn watched(&self) -> bool {
        self.watched
    }

    /// Whether results are asked for as JSON.
    pub(super) fn json(&self) -> bool {
        self.json
    }

    /// Prints results: `value` as JSON, or else `text` unless all should be quiet.
    pub(super) fn results(&self, value: &impl serde::Serialize, text: impl FnOnce() -> String) -> Result<(), CliError> {
        if self.json {
            print(&json_text(value)?)
        } else if self.quiet {
            Ok(())
        } else {
            print(&text())
        }
    }

    /// Prints a text that is itself what was asked for.
    pub(super) fn document(&self, text: &str) -> Result<(), CliError> {
        print(text)
    }

    /// Says something besides the results, unless all should be quiet.
    pub(super) fn note(&self, text: &str) {
        if !self.quiet {
            say(text);
        }
    }

    /// Says what is wrong, also when all should be quiet: an exit code alone helps nobody.
    pub(super) fn complain(&self, text: &str) {
        say(text);
    }

    /// Says why a command was not done.
    pub(super) fn error(&self, error: &CliError) {
        // The diagnostics of a garment file or a list begin with their places, as those of compilers do.
        let named =
            matches!(error, CliError::Pipeline(PipelineError::Garment(_)) | CliError::Batch(BatchError::Jobs { .. }));
        say(&if named { error.to_string() } else { format!("error: {error}") });
        if let Some(help) = error.help() {
            say(&format!("  help: {help}"));
        }
    }

    /// Progress bars on a terminal, nothing elsewhere.
    pub(super) fn progress(&self) -> Progress {
        Progress { bar: self.bars.then(|| RefCell::new((String::new(), ProgressBar::hidden()))) }
    }
}

/// Writes to standard output. A reader that has gone away (`| head`) has seen what it wanted.
fn print(text: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => Err(CliError::Print(e)),
        _ => Ok(()),
    }
}

/// Writes a line to standard error; nobody is left to tell if that fails.
fn say(text: &str) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// A bar per stage.
pub(super) struct Progress {
    /// The stage under way and its bar.
    bar: Option<RefCell<(String, ProgressBar)>>,
}

/// Steps of a bar.
const STEPS: u64 = 1000;

impl Progress {
    /// Shows that `stage` has done this share of its work.
    pub(super) fn show(&self, stage: &str, share: f64) {
        let Some(bar) = &self.bar else { return };
        let (name, bar) = &mut *bar.borrow_mut();
        if name != stage {
            bar.finish();
            *bar = ProgressBar::new(STEPS).with_style(style()).with_message(stage.to_owned());
            stage.clone_into(name);
        }
        // Gaps may widen for a step; a bar that goes back only worries.
        bar.set_position(bar.position().max((share.clamp(0.0, 1.0) * STEPS as f64) as u64));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.borrow().1.finish();
        }
    }
}

fn style() -> ProgressStyle {
    ProgressStyle::with_template("  {msg:8} {bar:40} {percent:>3} %  {elapsed}, {eta} left")
        .unwrap_or_else(|_| ProgressStyle::default_bar())
}
