//! Why files could not be written.

use std::io;
use std::path::PathBuf;

/// Why files could not be written. Paths are as the user gave them.
#[derive(Debug, thiserror::Error)]
pub enum WriteError {
    /// A result would replace a file the program reads.
    #[error("will not write {}: it is an input; choose another folder with -o", .0.display())]
    IsInput(PathBuf),
    /// A target exists and is a folder.
    #[error("cannot write {}: it is a folder", .0.display())]
    IsFolder(PathBuf),
    /// A target exists and is a device or a pipe.
    #[error("cannot write {}: it is no ordinary file; give another name with -o", .0.display())]
    NotFile(PathBuf),
    /// A target exists and is write-protected.
    #[error("cannot write {}: it is write-protected; give another name with -o, or lift the protection", .0.display())]
    Protected(PathBuf),
    /// The folder to write into is a file.
    #[error("cannot write {}: {} is a file, not a folder", target.display(), path.display())]
    NotFolder {
        /// The file to write.
        target: PathBuf,
        /// The file in its way.
        path: PathBuf,
    },
    /// The output folder cannot be made.
    #[error("cannot make the folder {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// A file cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The interrupt handler cannot be set up.
    #[error("cannot watch for Ctrl-C: {0}")]
    Handler(#[from] ctrlc::Error),
}
