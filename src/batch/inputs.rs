//! The input of a failure, kept beside it.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use serde::Serialize;

use super::job::BatchJob;
use super::key::{Digests, files_of};

/// Folder of the input, in that of the failure.
const INPUT: &str = "input";
/// Bytes of a file that is kept with a failure. A larger one is known by its path and hash.
const LARGEST_KEPT: u64 = 1 << 20;

/// A file that a failed job was made from.
#[derive(Debug, Serialize)]
pub(super) struct Input {
    /// Where it was.
    path: String,
    /// The hash of its bytes, as keys have it.
    hash: String,
    /// Its copy, from the failure's folder. Absent of one that is too large.
    kept: Option<String>,
}

/// Copies the files of a failed job into its folder, as they lie beside one another, so that the garment can be made
/// from the copies.
///
/// # Errors
/// A copy that cannot be written. An input that cannot be read is passed over.
pub(super) fn keep_inputs(folder: &Path, job: &BatchJob) -> io::Result<Vec<Input>> {
    let files = files_of(job);
    let plain: Vec<PathBuf> = files.iter().map(|file| without_steps_back(file)).collect();
    let (shared, digests) = (shared_folder(&plain), Digests::default());
    let mut kept = Vec::new();
    for (file, plain) in files.iter().zip(&plain) {
        let own = Path::new(INPUT).join(from_shared(plain, shared));
        let copied = copy(file, &folder.join(&own))?;
        kept.push(Input {
            path: file.display().to_string(),
            hash: digests.of(file),
            kept: copied.then(|| own.display().to_string()),
        });
    }
    Ok(kept)
}

/// Copies a file, if it is small and can be read.
fn copy(file: &Path, to: &Path) -> io::Result<bool> {
    let small = fs::metadata(file).is_ok_and(|about| about.is_file() && about.len() <= LARGEST_KEPT);
    let Some(bytes) = small.then(|| fs::read(file).ok()).flatten() else { return Ok(false) };
    fs::create_dir_all(to.parent().unwrap_or(Path::new("")))?;
    fs::write(to, bytes)?;
    Ok(true)
}

/// A whole path without `.` and `..`.
fn without_steps_back(file: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for part in file.components() {
        match part {
            Component::ParentDir => drop(out.pop()),
            Component::CurDir => {}
            part => out.push(part),
        }
    }
    out
}

/// Number of the leading parts of the path that all files share, their names not among them.
fn shared_folder(files: &[PathBuf]) -> usize {
    let Some(first) = files.first() else { return 0 };
    let folder: Vec<Component> = first.parent().unwrap_or(Path::new("")).components().collect();
    let with = |file: &PathBuf| {
        let own = file.parent().unwrap_or(Path::new("")).components().collect::<Vec<_>>();
        folder.iter().zip(own).take_while(|(a, b)| **a == *b).count()
    };
    files.iter().map(with).min().unwrap_or(0)
}

/// The path from the shared folder. Roots and drives, which no folder can hold, fall away.
fn from_shared(file: &Path, shared: usize) -> PathBuf {
    let ordinary = |part: &Component| matches!(part, Component::Normal(_));
    file.components().skip(shared).filter(ordinary).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_lie_as_the_files_do() {
        let files: Vec<PathBuf> = ["/data/a/skirt.yaml", "/data/b/../b/skirt.yaml", "/data/cloth.yaml"]
            .iter()
            .map(|file| without_steps_back(Path::new(file)))
            .collect();
        let shared = shared_folder(&files);
        let places: Vec<PathBuf> = files.iter().map(|file| from_shared(file, shared)).collect();
        assert_eq!(places, ["a/skirt.yaml", "b/skirt.yaml", "cloth.yaml"].map(PathBuf::from));
        let alone = [PathBuf::from("/data/a/skirt.yaml")];
        assert_eq!(from_shared(&alone[0], shared_folder(&alone)), Path::new("skirt.yaml"));
    }
}
