//! The key of a job: a hash of its content and of toile's build.

use std::collections::{BTreeSet, HashMap};
use std::fmt;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use sha2::{Digest, Sha256};

use super::job::BatchJob;
use crate::fabric;
use crate::input::{bytes, stem, texts};
use crate::io::garment::LARGEST_FILE;
use crate::mannequin;

/// Bytes of a hash that are written, two characters each: with 16 of them no two of a billion jobs have the same key
/// by chance.
const BYTES: usize = 16;
/// Bytes of a path, as Linux has them at most. A longer text is none.
const LONGEST_PATH: usize = 4096;
/// A garment names a fabric, the fabric a curve. Files that name one another in a circle end here.
const DEEPEST: usize = 4;

/// The build of toile: a hash of the sources that it is compiled from, with its fabrics and mannequins. The command and
/// the Python package of the same sources have the same.
pub const BUILD: &str = env!("TOILE_BUILD");

/// The inputs of a job: the names and contents of its garment files and of all that they name, its body and
/// fabric, its options, and toile's build. Folders are left out, so that a job keeps its key when it is moved.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct JobKey(String);

impl fmt::Display for JobKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Hashes of files that have been read: thousands of jobs have one body.
#[derive(Debug, Default)]
pub struct Digests(Mutex<HashMap<PathBuf, String>>);

impl Digests {
    /// The hash of a file's bytes, or the reason why there is none and the path that leads nowhere: two files that are
    /// missing are not the same.
    pub(super) fn of(&self, file: &Path) -> String {
        let known = |digests: &Self| digests.0.lock().unwrap_or_else(PoisonError::into_inner).get(file).cloned();
        if let Some(digest) = known(self) {
            return digest;
        }
        let digest = read(file).unwrap_or_else(|why| format!("unreadable: {why}: {}", file.display()));
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(file.to_owned(), digest.clone());
        digest
    }
}

fn read(file: &Path) -> Result<String, String> {
    // A pipe would be waited for, and nothing would be left in it for the process that makes the garment.
    if !std::fs::metadata(file).map_err(|e| e.kind().to_string())?.is_file() {
        return Err("no file".into());
    }
    let mut hash = Sha256::new();
    let mut opened = File::open(file).map_err(|e| e.kind().to_string())?;
    std::io::copy(&mut opened, &mut hash).map_err(|e| e.kind().to_string())?;
    Ok(hex(&hash.finalize()))
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().take(BYTES).map(|byte| format!("{byte:02x}")).collect()
}

impl JobKey {
    /// The key of a job as its files are now.
    pub fn of(job: &BatchJob, digests: &Digests) -> Self {
        Self::of_build(job, digests, BUILD)
    }

    fn of_build(job: &BatchJob, digests: &Digests, build: &str) -> Self {
        let mut content = Content(Sha256::new());
        content.say("toile", build);
        for garment in &job.garment {
            content.file("garment", garment, digests);
        }
        let named = [("body", &job.body, mannequin::library()), ("fabric", &job.fabric, fabric::library())];
        for (what, name, shipped) in named {
            match name {
                Some(name) if shipped.contains(&name.as_str()) => content.say(what, name),
                Some(file) => content.file(what, Path::new(file), digests),
                None => {}
            }
        }
        // The process gets its options as these words.
        for option in job.arguments().iter().filter(|o| !o.starts_with("--body=") && !o.starts_with("--fabric=")) {
            content.say("option", option);
        }
        Self(hex(&content.0.finalize()))
    }
}

/// Files of a job that can be read, each once: its garments and all that they name, its body and its fabric.
pub(super) fn files_of(job: &BatchJob) -> Vec<PathBuf> {
    let given = [&job.body, &job.fabric].into_iter().flatten().map(PathBuf::from).filter(|path| path.is_file());
    let mut files: Vec<PathBuf> = Vec::new();
    let mut next: Vec<PathBuf> = job.garment.iter().cloned().chain(given).collect();
    for _ in 0..=DEEPEST {
        next.retain(|file| file.is_file() && !files.contains(file));
        let named = next.iter().flat_map(|file| named_files(file)).map(|(_, path)| path).collect();
        for file in std::mem::replace(&mut next, named) {
            if !files.contains(&file) {
                files.push(file);
            }
        }
    }
    files
}

/// A hash of names and values.
struct Content(Sha256);

impl Content {
    /// Adds a value. Lengths keep two values from running into one another.
    fn say(&mut self, what: &str, value: &str) {
        for text in [what, value] {
            self.0.update((text.len() as u64).to_le_bytes());
            self.0.update(text);
        }
    }

    /// Adds a file: its name, which results bear, its content, and the files that it names.
    fn file(&mut self, what: &str, file: &Path, digests: &Digests) {
        self.say(what, &stem(file));
        self.say("content", &digests.of(file));
        let mut seen = BTreeSet::from([file.to_owned()]);
        self.named_in(file, digests, &mut seen, DEEPEST);
    }

    fn named_in(&mut self, file: &Path, digests: &Digests, seen: &mut BTreeSet<PathBuf>, deep: usize) {
        for (name, inner) in named_files(file) {
            if deep > 0 && seen.insert(inner.clone()) {
                self.say("named", &name);
                self.say("content", &digests.of(&inner));
                self.named_in(&inner, digests, seen, deep - 1);
            }
        }
    }
}

/// The files that a file names, in their order. Any text that is the name of a file counts: a file too many does no
/// harm. The name of a file does not tell whether it names others, but a surface is long and names none.
fn named_files(file: &Path) -> Vec<(String, PathBuf)> {
    if file.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj")) {
        return Vec::new();
    }
    let text = bytes(file, LARGEST_FILE).ok().and_then(|bytes| String::from_utf8(bytes).ok());
    let texts = text.map(|text| texts(text.strip_prefix('\u{feff}').unwrap_or(&text)));
    let Some(Ok(texts)) = texts else { return Vec::new() };
    let folder = file.parent().unwrap_or(Path::new(""));
    let beside = |text: String| {
        let name = text.trim();
        let path = folder.join(name);
        (!name.is_empty() && name.len() <= LONGEST_PATH && path.is_file()).then(|| (name.to_owned(), path))
    };
    texts.into_iter().filter_map(beside).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_build_has_other_keys() {
        assert!(BUILD.len() == 16 && BUILD.bytes().all(|byte| byte.is_ascii_hexdigit()), "{BUILD}");
        let (job, digests) = (BatchJob::options(), Digests::default());
        let key = |build| JobKey::of_build(&job, &digests, build);
        assert_eq!(key(BUILD), JobKey::of(&job, &digests));
        assert_ne!(key("another"), key(BUILD));
    }
}
