//! Why there is no fabric.

use crate::input::did_you_mean;

/// Why a fabric cannot be had. Every message tells the expected input.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FabricError {
    /// Neither a library name, nor a fabric of the garment, nor a file.
    #[error("fabric '{name}' not found{}; there are {known}, or give the path of a .yaml file",
            did_you_mean(nearest.as_deref()))]
    Unknown {
        /// As asked for.
        name: String,
        /// The most alike, if any is.
        nearest: Option<String>,
        /// All names.
        known: String,
    },
    /// A file cannot be read.
    #[error("{file}: {why}")]
    Read {
        /// Path.
        file: String,
        /// The system's message.
        why: String,
    },
    /// The text is no fabric.
    #[error("{file}: {why}")]
    Syntax {
        /// Path or name.
        file: String,
        /// The fault, with line and column if the reader knows them.
        why: String,
    },
    /// A key that means nothing.
    #[error("fabric '{fabric}' has no value '{key}'; it may have {known}")]
    Key {
        /// The fabric.
        fabric: String,
        /// As written.
        key: String,
        /// All keys.
        known: String,
    },
    /// A value that is no number with one of the units expected.
    #[error("fabric '{fabric}': cannot read {key} '{text}'; expected {expected}")]
    Unit {
        /// The fabric.
        fabric: String,
        /// The value.
        key: String,
        /// As written.
        text: String,
        /// A number and its units.
        expected: String,
    },
    /// A number that no cloth has.
    #[error("fabric '{fabric}': {key} '{text}' is out of range; {why}")]
    Range {
        /// The fabric.
        fabric: String,
        /// The value.
        key: String,
        /// As written.
        text: String,
        /// Its requirement.
        why: String,
    },
    /// A value beside another that says the same.
    #[error("fabric '{fabric}': {key} '{text}' is said in other words too; {why}")]
    Twice {
        /// The fabric.
        fabric: String,
        /// The value.
        key: String,
        /// As written.
        text: String,
        /// The other statement of it.
        why: String,
    },
    /// A value that nothing can stand in for.
    #[error("fabric '{fabric}' has no {key} value; give {key} in {expected}")]
    Missing {
        /// The fabric.
        fabric: String,
        /// The value.
        key: String,
        /// Its units.
        expected: String,
    },
    /// A curve file with a wrong row.
    #[error("tensile curve {file}, row {row}: {why}")]
    Curve {
        /// Path.
        file: String,
        /// Line of the file, from 1.
        row: usize,
        /// The fault.
        why: String,
    },
    /// A fabric whose base is, by some way, itself.
    #[error("fabric '{fabric}' is based on itself; name a fabric of the library at the end of the chain")]
    Cycle {
        /// The fabric.
        fabric: String,
    },
    /// A fabric at the end of too many that are based on one another.
    #[error("fabric '{fabric}' is the base of {most} fabrics in a row; name one of the library sooner")]
    Deep {
        /// The fabric.
        fabric: String,
        /// So many are allowed.
        most: usize,
    },
}

impl FabricError {
    /// The file that is wrong, if it is one.
    pub fn file(&self) -> Option<&str> {
        match self {
            Self::Read { file, .. } | Self::Syntax { file, .. } | Self::Curve { file, .. } => Some(file),
            _ => None,
        }
    }

    /// The fabric that is wrong and the value of it, as far as the error is about a fabric's own values.
    pub fn culprit(&self) -> (Option<&str>, Option<&str>) {
        match self {
            Self::Key { fabric, key, .. }
            | Self::Unit { fabric, key, .. }
            | Self::Range { fabric, key, .. }
            | Self::Twice { fabric, key, .. }
            | Self::Missing { fabric, key, .. } => (Some(fabric), Some(key)),
            Self::Cycle { fabric } | Self::Deep { fabric, .. } => (Some(fabric), Some("base")),
            Self::Unknown { .. } | Self::Read { .. } | Self::Syntax { .. } | Self::Curve { .. } => (None, None),
        }
    }
}
