//! Input from users, within limits: bytes of a file, length of a text in a message, names, paths, and units of
//! length.

mod nearest;
mod path;
mod unit;
mod yaml;

pub use nearest::{did_you_mean, nearest};
pub use path::{check_known, is_file_name, stem, whole};
pub use unit::LengthUnit;
pub use yaml::{quoted, texts, yaml};

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

/// Why the bytes of a file cannot be had.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InputError {
    /// The system refused.
    #[error("{0}")]
    System(String),
    /// A folder.
    #[error("it is a folder, not a file")]
    Folder,
    /// A named pipe: opening one waits for a writer, who may never come.
    #[error("it is a named pipe; give a file")]
    Pipe,
    /// More than the limit.
    #[error("{bytes} bytes or more; at most {limit} are read")]
    TooLarge {
        /// As far as it was looked at.
        bytes: u64,
        /// The limit.
        limit: u64,
    },
}

/// The bytes of the file at `path`, at most `limit`. A length that the system knows is checked before reading. Files
/// without one (devices, pipes) are read up to the limit.
///
/// # Errors
/// [`InputError`].
pub fn bytes(path: &Path, limit: u64) -> Result<Vec<u8>, InputError> {
    let system = |e: std::io::Error| InputError::System(e.to_string());
    let about = std::fs::metadata(path).map_err(system)?;
    if about.is_dir() {
        return Err(InputError::Folder);
    }
    if is_named_pipe(&about, path) {
        return Err(InputError::Pipe);
    }
    if about.len() > limit {
        return Err(InputError::TooLarge { bytes: about.len(), limit });
    }
    let mut bytes = Vec::new();
    // One byte more than allowed tells a file that is too long from one that just fits.
    File::open(path).and_then(|file| file.take(limit + 1).read_to_end(&mut bytes)).map_err(system)?;
    match bytes.len() as u64 {
        read if read > limit => Err(InputError::TooLarge { bytes: read, limit }),
        _ => Ok(bytes),
    }
}

/// The shell's own pipes (`/dev/stdin`, `<(…)`) have a writer already, and lead to no path.
#[cfg(unix)]
fn is_named_pipe(about: &std::fs::Metadata, path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    about.file_type().is_fifo() && path.canonicalize().is_ok()
}

#[cfg(not(unix))]
fn is_named_pipe(_: &std::fs::Metadata, _: &Path) -> bool {
    false
}

/// The text for a message: at most `most` characters, with `…` in place of its middle, and `�` for characters that
/// would move a terminal's cursor.
pub fn shown(text: &str, most: usize) -> String {
    let visible = |c: char| if c.is_control() { char::REPLACEMENT_CHARACTER } else { c };
    let count = text.chars().count();
    if count <= most {
        return text.chars().map(visible).collect();
    }
    let tail = most / 4;
    let head = most.saturating_sub(tail + 1);
    let ends = text.chars().take(head).chain(['…']).chain(text.chars().skip(count - tail));
    ends.map(visible).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shown_is_short_and_harmless() {
        assert_eq!(shown("waist", 5), "waist");
        assert_eq!(shown("abcdefghijkl", 8), "abcde…kl");
        assert_eq!(shown("a\u{1b}[2J\n", 9), "a\u{fffd}[2J\u{fffd}");
        assert_eq!(shown(&"é".repeat(5000), 200).chars().count(), 200);
    }
}
