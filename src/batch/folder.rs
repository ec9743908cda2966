//! The garments of a folder as jobs.

use std::fs;
use std::path::{Path, PathBuf};

use super::error::BatchError;
use super::job::BatchJob;
use crate::input::{bytes, stem};
use crate::io::garment::LARGEST_FILE;

/// The garments of a folder.
#[derive(Clone, Debug, PartialEq)]
pub struct Garments {
    /// A job each, sorted and named by their files.
    pub jobs: Vec<BatchJob>,
    /// YAML files that are no garment files, as those of fabrics, ranges and mannequins.
    pub left_out: Vec<PathBuf>,
}

/// Every garment file (`*.yaml`, `*.yml`) of a folder as a job. Other YAML files are left out, and hidden ones.
///
/// # Errors
/// [`BatchError`]: a folder that cannot be read, or without garments.
pub fn garments_of_folder(folder: &Path, defaults: &BatchJob) -> Result<Garments, BatchError> {
    let unreadable = |e: std::io::Error| BatchError::Read { file: folder.to_owned(), why: e.to_string() };
    let entries: Vec<fs::DirEntry> = fs::read_dir(folder).and_then(Iterator::collect).map_err(unreadable)?;
    let mut files: Vec<PathBuf> = entries.iter().map(fs::DirEntry::path).filter(|path| is_yaml(path)).collect();
    files.sort();
    let (files, left_out): (Vec<PathBuf>, Vec<PathBuf>) = files.into_iter().partition(|file| is_garment(file));
    if files.is_empty() {
        return Err(BatchError::Empty { file: folder.to_owned(), why: "no garment file (*.yaml) in this folder" });
    }
    // a.yaml and a.yml would both be named a.
    let twice = |file: &Path| files.iter().filter(|other| stem(other) == stem(file)).count() > 1;
    let id = |file: &Path| if twice(file) { name(file) } else { stem(file) };
    let jobs = files.iter().map(|file| BatchJob::of_file(id(file), file.clone(), defaults)).collect();
    Ok(Garments { jobs, left_out })
}

fn name(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn is_yaml(path: &Path) -> bool {
    let hidden = name(path).starts_with('.');
    path.is_file() && !hidden && path.extension().is_some_and(|e| e == "yaml" || e == "yml")
}

/// Whether a file has a line with the key `garment`, as every garment file has. One with a mistake further down is a
/// garment too, and so is one that cannot be read: its job says why.
fn is_garment(file: &Path) -> bool {
    let Ok(bytes) = bytes(file, LARGEST_FILE) else { return true };
    let Ok(text) = String::from_utf8(bytes) else { return true };
    text.trim_start_matches('\u{feff}').lines().any(begins_garment)
}

/// `garment: 1`, also in quotes and as JSON.
fn begins_garment(line: &str) -> bool {
    let bare = line.trim_start_matches('{').trim_start().trim_start_matches(['"', '\'']);
    let indented = line.starts_with([' ', '\t']) && !line.trim_start().starts_with('"');
    let after = bare.strip_prefix("garment").map(|rest| rest.trim_start_matches(['"', '\'']).trim_start());
    !indented && after.is_some_and(|rest| rest.starts_with(':'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn garment_files_are_known_by_their_key() {
        for line in
            ["garment: 1", "garment : 1", "\"garment\": 1", "{garment: 1}", "{\"garment\": 1,", "  \"garment\": 1,"]
        {
            assert!(begins_garment(line), "{line}");
        }
        for line in ["# garment: 1", "garments: 1", "  garment: 1", "measures: {garment: 3}", "weight: 100 g/m2"] {
            assert!(!begins_garment(line), "{line}");
        }
    }
}
