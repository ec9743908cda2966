//! Getting the text of a file, within reason.

use std::path::Path;

use crate::input::{InputError, bytes};
use crate::pattern::Problem;

/// Bytes of a garment file: one of a few hundred pieces has a few hundred kilobytes.
pub const LARGEST_FILE: u64 = 16 << 20;

/// The text of the file at `path`.
///
/// # Errors
/// When it is missing, a directory, too large (told before anything is read where its length is known), or no UTF-8.
pub(super) fn text(path: &Path) -> Result<String, Problem> {
    let bytes = bytes(path, LARGEST_FILE).map_err(|e| match e {
        InputError::Folder => Problem::Directory,
        InputError::TooLarge { bytes, limit } => Problem::TooLarge { bytes, limit },
        other => Problem::Unreadable(other.to_string()),
    })?;
    String::from_utf8(bytes).map_err(|e| Problem::NotText(e.utf8_error().valid_up_to()))
}
