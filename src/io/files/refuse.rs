//! Targets that no result may replace.

use std::fs;
use std::path::Path;

use super::error::WriteError;

/// Refuses a target that is an input, a folder, no ordinary file or write-protected.
pub(super) fn refuse(path: &Path, inputs: &[&Path]) -> Result<(), WriteError> {
    let Ok(real) = path.canonicalize() else { return Ok(()) };
    if inputs.iter().any(|input| input.canonicalize().is_ok_and(|i| i == real)) {
        return Err(WriteError::IsInput(path.to_owned()));
    }
    let Ok(is) = fs::metadata(&real) else { return Ok(()) };
    match path.to_owned() {
        path if is.is_dir() => Err(WriteError::IsFolder(path)),
        path if !is.is_file() => Err(WriteError::NotFile(path)),
        path if is.permissions().readonly() => Err(WriteError::Protected(path)),
        _ => Ok(()),
    }
}
