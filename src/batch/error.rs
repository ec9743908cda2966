//! Why a batch cannot go on.

use std::io;
use std::path::PathBuf;

/// Mistakes of a list that are shown.
const SHOWN: usize = 10;

/// A line of a list that is no job.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mistake {
    /// Number of the line, from 1.
    pub line: usize,
    /// The mistake.
    pub why: String,
}

/// Why a batch cannot begin or go on.
#[derive(Debug, thiserror::Error)]
pub enum BatchError {
    /// The list cannot be read.
    #[error("cannot read {}: {why}", file.display())]
    Read {
        /// The list or folder.
        file: PathBuf,
        /// The system's message.
        why: String,
    },
    /// Lines of the list are no jobs.
    #[error("{}", listed(file, mistakes))]
    Jobs {
        /// The list.
        file: PathBuf,
        /// All of them.
        mistakes: Vec<Mistake>,
    },
    /// There is nothing to make.
    #[error("{}: {why}", file.display())]
    Empty {
        /// The list or folder.
        file: PathBuf,
        /// The reason.
        why: &'static str,
    },
    /// More samples are asked for than a list can have.
    #[error("{asked} samples are asked for; a list has {most} at most: draw several, each with a --seed of its own")]
    TooManySamples {
        /// As asked.
        asked: usize,
        /// Samples of the longest list.
        most: usize,
    },
    /// More samples are asked for than there are.
    #[error(
        "{asked} samples are asked for, but there are only {there}: {garments} garments × {bodies} bodies × {fabrics} \
         fabrics, each size a garment; ask for fewer, give more of them, or ranges to draw from (--vary)"
    )]
    Samples {
        /// As asked.
        asked: usize,
        /// Different samples.
        there: usize,
        /// Garments to draw from, each of their sizes counted.
        garments: usize,
        /// Bodies to draw from.
        bodies: usize,
        /// Fabrics to draw from.
        fabrics: usize,
    },
    /// The store cannot be written.
    #[error(
        "cannot write the store {}: {why}; what is done is kept: start again when it can be written",
        path.display()
    )]
    Store {
        /// File or folder.
        path: PathBuf,
        /// The system's message.
        why: String,
    },
    /// The program that makes one garment cannot be started.
    #[error("cannot start {program}: {source}")]
    Start {
        /// The program.
        program: String,
        /// The system's message.
        source: io::Error,
    },
    /// The program that makes one garment is not, or no longer, toile.
    #[error(
        "{program} ended with exit code {code} before it began to make a garment: {why}; what is done is kept: start \
         again when toile can be run"
    )]
    Worker {
        /// The program.
        program: String,
        /// Its exit code.
        code: i32,
        /// The last line that it wrote.
        why: String,
    },
    /// The memory limit cannot be set.
    #[error("cannot limit the memory of a job: {0}")]
    Limit(String),
    /// Somebody stopped the batch.
    #[error("stopped; what is done is kept: start again to go on")]
    Stopped,
}

impl BatchError {
    /// Whether the user must change the input. Otherwise the batch could not be carried out.
    pub fn is_input(&self) -> bool {
        match self {
            Self::Read { .. }
            | Self::Jobs { .. }
            | Self::Empty { .. }
            | Self::TooManySamples { .. }
            | Self::Samples { .. } => true,
            Self::Store { .. } | Self::Start { .. } | Self::Worker { .. } | Self::Limit(_) | Self::Stopped => false,
        }
    }
}

fn listed(file: &std::path::Path, mistakes: &[Mistake]) -> String {
    let line = |m: &Mistake| format!("{}:{}: error: {}", file.display(), m.line, m.why);
    let mut lines: Vec<String> = mistakes.iter().take(SHOWN).map(line).collect();
    if mistakes.len() > SHOWN {
        lines.push(format!("and {} more", mistakes.len() - SHOWN));
    }
    lines.join("\n")
}
