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
    /// A worker of a batch cannot write its results.
    CannotWrite = crate::batch::WORKER_CANNOT_WRITE as isize,
    /// Stopped by Ctrl-C.
    Stopped = 130,
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

impl CliError {
    pub(super) fn exit(&self) -> Exit {
        match self {
            Self::Pipeline(e) if !e.is_input() => Exit::Failed,
            Self::Batch(BatchError::Stopped) => Exit::Stopped,
            Self::Batch(e) if !e.is_input() => Exit::Failed,
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
