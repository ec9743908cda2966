//! Errors in readings.

use crate::fabric::FabricError;

/// Why readings make no fabric. Every message names the file or test and the expected input.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeasureError {
    /// A file that is not as it should be.
    #[error("{file}{}: {why}", row.map(|r| format!(", row {r}")).unwrap_or_default())]
    File {
        /// Path.
        file: String,
        /// Line of the file, from 1, where one is to blame.
        row: Option<usize>,
        /// The fault.
        why: String,
    },
    /// Readings of a test that cannot be right.
    #[error("{test}: {why}")]
    Test {
        /// `recovery`, `stretch`, `bend`, `means` or `table`.
        test: &'static str,
        /// The fault.
        why: String,
    },
    /// A photograph that cannot be used.
    #[error("{file}: {why}")]
    Photo {
        /// Path.
        file: String,
        /// The fault.
        why: String,
    },
    /// Nothing was measured.
    #[error("{file} has no measurements; give recovery, stretch and bend readings, their means, a sheet, or curves")]
    Empty {
        /// Path.
        file: String,
    },
    /// The fabric that was made, or one of the library, is not valid.
    #[error(transparent)]
    Fabric(#[from] FabricError),
}
