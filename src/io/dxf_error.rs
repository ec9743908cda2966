//! Why a DXF file cannot be read.

use crate::input::InputError;

/// Letters of a text that messages show.
pub(super) const SHOWN: usize = 40;

/// Why a DXF file could not be read.
#[derive(Debug, thiserror::Error)]
pub enum DxfError {
    /// The system refused.
    #[error("{0}")]
    Input(#[from] InputError),
    /// A binary file, or no DXF at all.
    #[error("it is not a DXF text file: line {line} should be a group code and is '{found}'")]
    NotText {
        /// From 1.
        line: usize,
        /// The text that stands there.
        found: String,
    },
    /// A coordinate that is no number.
    #[error("line {line}: '{found}' is not a coordinate")]
    Number {
        /// From 1.
        line: usize,
        /// The text that stands there.
        found: String,
    },
    /// Too many lines.
    #[error("block '{block}' has more than {most} lines; leave out what does not belong to the pattern")]
    TooMany {
        /// Its name.
        block: String,
        /// The limit.
        most: usize,
    },
    /// A line without its end: what follows it would be lost.
    #[error("line {line}: the POLYLINE that begins here has no SEQEND after its VERTEXes; export the file again")]
    Unended {
        /// From 1.
        line: usize,
    },
    /// A size that it has not.
    #[error("it has no size '{wanted}'; its sizes are {known}")]
    NoSize {
        /// The size that was asked for.
        wanted: String,
        /// Those there are.
        known: String,
    },
    /// A table of grade rules that cannot be read.
    #[error("{file}: line {line}: {why}; export the rules again, or read the file without them: move them away")]
    Rules {
        /// The file of the rules.
        file: String,
        /// From 1.
        line: usize,
        /// The mistake and what is expected.
        why: String,
    },
    /// Blocks within blocks without end.
    #[error("block '{block}' holds itself, or others more than {most} deep")]
    TooDeep {
        /// Its name.
        block: String,
        /// The limit.
        most: usize,
    },
    /// No block is a piece.
    #[error(
        "neither a block nor the drawing has a closed boundary on layer 1, so this is not a DXF-AAMA (ASTM D6673) \
         pattern; \
         layers found: {layers}; export it as AAMA or ASTM, or as SVG{besides}"
    )]
    NoPieces {
        /// Those there are.
        layers: String,
        /// The parts that were left out, which may be the reason.
        besides: String,
    },
}
