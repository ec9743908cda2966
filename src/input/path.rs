//! Paths of files, and names that stand for a file or for a part of a library.

use std::path::{Path, PathBuf};

use super::nearest::{did_you_mean, nearest};

/// The file's name without its folder and its ending; empty where it has none.
pub fn stem(file: &Path) -> String {
    file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The path from the root on. One that the system cannot complete stays as it is.
pub fn whole(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Whether the name of a body or fabric is that of a file: it is not in the library, and has an ending.
pub fn is_file_name(name: &str, library: &[&str]) -> bool {
    !library.contains(&name) && Path::new(name).extension().is_some()
}

/// Checks that a name is in the library, or that of a file that is there.
///
/// # Errors
/// A message with the names of the library, and the nearest one.
pub fn check_known(name: &str, library: &[&str]) -> Result<(), String> {
    if library.contains(&name) || Path::new(name).is_file() {
        return Ok(());
    }
    let meant = did_you_mean(nearest(name, library.iter().copied()));
    Err(format!("'{name}' is neither in the library ({}) nor a file{meant}", library.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_of_the_library_is_no_file() {
        let library = ["denim", "wool.heavy"];
        assert!(is_file_name("own/denim.yaml", &library));
        assert!(!is_file_name("wool.heavy", &library) && !is_file_name("silk", &library));
        assert_eq!(check_known("denim", &library), Ok(()));
        assert_eq!(
            check_known("denm", &library),
            Err("'denm' is neither in the library (denim, wool.heavy) nor a file; did you mean 'denim'?".into())
        );
    }
}
