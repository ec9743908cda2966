//! Why style lines give no pattern.

use crate::fabric::FabricError;
use crate::io::body::BodyError;

/// The fault of a draft, and how to mend it.
#[derive(Debug, thiserror::Error)]
pub enum DraftError {
    /// The file of lines cannot be read.
    #[error("{file}: {why}")]
    File {
        /// Path.
        file: String,
        /// The fault, with line and column where it has them.
        why: String,
    },
    /// A style line cannot be drawn on this body.
    #[error("{file}: line '{line}': {why}")]
    Line {
        /// Path.
        file: String,
        /// Its name.
        line: String,
        /// The reason, and what to do.
        why: String,
    },
    /// The lines bound no such panel.
    #[error("{file}: panel '{panel}': {why}")]
    Panel {
        /// Path.
        file: String,
        /// Its name.
        panel: String,
        /// The reason, and what to do.
        why: String,
    },
    /// Nothing to draft on.
    #[error(transparent)]
    Body(#[from] BodyError),
    /// No such fabric.
    #[error(transparent)]
    Fabric(#[from] FabricError),
}
