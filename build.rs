//! Tells the library which sources it is built from: `TOILE_BUILD` is a hash of everything that decides its results. A
//! batch puts it into the keys of its jobs.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// Files and folders that decide results. The lock file is absent where toile is a dependency of another program.
const DECIDING: [&str; 5] = ["src", "fabrics", "mannequins", "Cargo.toml", "Cargo.lock"];
/// Bytes of the hash that are kept, two characters each: builds are few, and nobody forges one.
const BYTES: usize = 8;

fn main() -> Result<(), Box<dyn Error>> {
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR")?);
    let mut files = Vec::new();
    for name in DECIDING {
        let path = root.join(name);
        if path.exists() {
            println!("cargo::rerun-if-changed={name}");
            gather(&path, &mut files)?;
        }
    }
    println!("cargo::rustc-env=TOILE_BUILD={}", hash(&root, files)?);
    Ok(())
}

/// All files in a folder, or the file itself.
fn gather(path: &Path, files: &mut Vec<PathBuf>) -> Result<(), Box<dyn Error>> {
    if !path.is_dir() {
        files.push(path.to_owned());
        return Ok(());
    }
    for entry in fs::read_dir(path)? {
        gather(&entry?.path(), files)?;
    }
    Ok(())
}

/// The hash of names and contents. Names are from the root and have slashes, and line ends are those of Unix, so that
/// it is the same on every system.
fn hash(root: &Path, files: Vec<PathBuf>) -> Result<String, Box<dyn Error>> {
    let mut named: Vec<(String, PathBuf)> = Vec::new();
    for file in files {
        let parts: Vec<_> = file.strip_prefix(root)?.iter().map(|part| part.to_string_lossy()).collect();
        named.push((parts.join("/"), file));
    }
    named.sort();
    let mut hash = Sha256::new();
    for (name, file) in named {
        let bytes: Vec<u8> = fs::read(file)?.into_iter().filter(|byte| *byte != b'\r').collect();
        for part in [name.as_bytes(), &bytes] {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        }
    }
    Ok(hash.finalize().iter().take(BYTES).map(|byte| format!("{byte:02x}")).collect())
}
