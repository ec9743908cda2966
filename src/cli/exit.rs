//! How a command ends.

use crate::batch::BatchError;
use crate::fabric::FabricError;
use crate::fabric::measure::MeasureError;
use crate::io::files::WriteError;
use crate::mannequin::MannequinError;
use crate::picture::PictureError;
use crate::pipeline::{PipelineError, SewError};
use crate::specimen::SpecimenError;
use crate::studio::StudioError;

/// Exit codes, the worst last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Exit {
    /// Done, and within the bounds.
    Done = 0,
    /// Done, but out of bounds.
    OutOfBounds = 1,
    /// The input is wrong.
    Input = 2,
    /// It could not be computed.
    Failed = 3,
    /// A batch could not go on.
    Unable = 4,
    /// A worker of a batch cannot write its results.
    CannotWrite = crate::batch::WORKER_CANNOT_WRITE as isize,
    /// A worker of a batch does not get the memory to begin with.
    NoMemory = crate::batch::WORKER_NO_MEMORY as isize,
    /// Stopped by Ctrl-C.
    Stopped = crate::batch::ASKED_TO_END as isize,
}

/// Why a command was not done.
#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    /// A stage, or what it was given.
    #[error(transparent)]
    Pipeline(#[from] PipelineError),
    /// Results that cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Standard output that cannot be written.
    #[error("cannot write to standard output: {0}")]
    Print(std::io::Error),
    /// No such fabric.
    #[error(transparent)]
    Fabric(#[from] FabricError),
    /// Readings that make no fabric.
    #[error(transparent)]
    Measure(#[from] MeasureError),
    /// A specimen that cannot be tested.
    #[error(transparent)]
    Specimen(#[from] SpecimenError),
    /// A picture that cannot be drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// No such mannequin.
    #[error(transparent)]
    Mannequin(#[from] MannequinError),
    /// A pattern of another program that cannot be read.
    #[error("{file}: {reason}")]
    Import {
        /// As the user named it.
        file: String,
        /// Its fault.
        reason: String,
    },
    /// A picture that is to be written under another name than a PNG file's.
    #[error("--picture {0}: the picture is a PNG file, which a name such as {0}.png says")]
    NotPng(String),
    /// An argument that makes no sense.
    #[error("{0}")]
    Argument(String),
    /// A batch that cannot begin or go on.
    #[error(transparent)]
    Batch(#[from] BatchError),
    /// A studio that cannot be opened.
    #[error(transparent)]
    Studio(#[from] StudioError),
    /// The system gives no threads.
    #[error("cannot start the threads: {0}; try a smaller --threads")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}

impl Exit {
    /// The code of a process, which tells a batch of its worker's outcome more than others are told.
    pub(super) fn code(self, worker: bool) -> u8 {
        let plain = self as u8;
        match self {
            Self::CannotWrite | Self::NoMemory | Self::Stopped => plain,
            _ if worker => plain + crate::batch::WORKER_EXIT,
            _ => plain,
        }
    }
}

impl CliError {
    /// How a batch's worker ends: a full disk is no fault of its job, and threads are not started for want of memory.
    pub(super) fn exit_of_worker(&self, limited: bool) -> Exit {
        match self {
            Self::Write(_) => Exit::CannotWrite,
            Self::Threads(_) if limited => Exit::NoMemory,
            _ => self.exit(),
        }
    }

    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::Pipeline(e) if !e.is_input() => Exit::Failed,
            Self::Batch(BatchError::Stopped) => Exit::Stopped,
            Self::Batch(e) if !e.is_input() => Exit::Unable,
            Self::Specimen(_) | Self::Picture(_) | Self::Threads(_) => Exit::Failed,
            _ => Exit::Input,
        }
    }

    /// The remedy, where the message itself does not say it.
    pub(super) fn help(&self) -> Option<&'static str> {
        match self {
            Self::Pipeline(PipelineError::Sew(SewError::InsideBody { .. } | SewError::UnderFloor { .. })) => {
                Some("garment.png shows where every piece was placed")
            }
            Self::Pipeline(e @ PipelineError::Surface { .. }) if !e.has_remedy() => {
                Some("cut it open with --cut A,B,…, from its rim to where it is most pointed or bulges most")
            }
            Self::Pipeline(e) if !e.has_remedy() => {
                Some("try another --spacing, and `toile check` and `toile sew` to see where it begins")
            }
            Self::Write(
                WriteError::File { .. }
                | WriteError::Folder { .. }
                | WriteError::NotFolder { .. }
                | WriteError::IsFolder(_),
            ) => Some("choose a place that can be written, with -o"),
            _ => None,
        }
    }
}
