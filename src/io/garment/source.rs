//! Getting the text of a file, within reason.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use crate::pattern::Problem;

/// A garment file of a few hundred pieces has a few hundred kilobytes.
const LARGEST: u64 = 16 << 20;

/// The text of the file at `path`.
///
/// # Errors
/// When it is missing, a directory, too large (told before anything is read), or no UTF-8.
pub(super) fn text(path: &Path) -> Result<String, Problem> {
    let unreadable = |e: std::io::Error| Problem::Unreadable(e.to_string());
    let file = File::open(path).map_err(unreadable)?;
    let about = file.metadata().map_err(unreadable)?;
    if about.is_dir() {
        return Err(Problem::Directory);
    }
    if about.len() > LARGEST {
        return Err(Problem::TooLarge { bytes: about.len(), limit: LARGEST });
    }
    let mut bytes = Vec::new();
    // Pipes and devices have no length: read one byte more than allowed and see.
    file.take(LARGEST + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > LARGEST {
        return Err(Problem::TooLarge { bytes: bytes.len() as u64, limit: LARGEST });
    }
    String::from_utf8(bytes).map_err(|e| Problem::NotText(e.utf8_error().valid_up_to()))
}
