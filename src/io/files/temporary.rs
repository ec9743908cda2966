//! Files under temporary names, and the list of changes that an interrupt has to undo.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use super::error::WriteError;

/// Files that an interrupt has to undo. Global: the interrupt's handler has no other way to know. It is locked from
/// before a temporary file appears until after it is registered, and while files are renamed, so the handler sees none
/// unregistered and no set half renamed.
static REGISTRY: Mutex<Registry> = Mutex::new(Registry { temporary: Vec::new(), previous: Vec::new() });

/// The changes that an interrupt has to undo.
pub(super) struct Registry {
    /// Temporary files that exist now.
    temporary: Vec<PathBuf>,
    /// Where previews stand, and what stood there before.
    previous: Vec<(PathBuf, Previous)>,
}

impl Registry {
    /// Notes what stood at `real` before a preview. Only before the first preview of a file it is what the user had.
    pub(super) fn preview(&mut self, real: PathBuf, previous: Previous) {
        if !self.previous.iter().any(|(path, _)| *path == real) {
            self.previous.push((real, previous));
        }
    }

    /// A file at `real` is final: nothing is put back there.
    pub(super) fn keep(&mut self, real: &Path) {
        self.previous.retain(|(path, _)| path != real);
    }

    /// Puts back what stood at `real` before its preview, if a preview stands there.
    pub(super) fn put_back(&mut self, real: &Path) {
        if let Some(k) = self.previous.iter().position(|(path, _)| path == real) {
            self.previous.swap_remove(k).1.put_back(real);
        }
    }

    /// Removes all temporary files and previews. Nobody is left to tell if that fails.
    pub(super) fn undo(&mut self) {
        for path in self.temporary.drain(..) {
            let _ = fs::remove_file(path);
        }
        self.previous.drain(..).for_each(|(real, previous)| previous.put_back(&real));
    }
}

/// The list, locked. A thread that panicked while it held the lock left a list that is still right.
pub(super) fn registry() -> MutexGuard<'static, Registry> {
    REGISTRY.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The state of a path before a preview of a file was written there.
pub(super) struct Previous {
    contents: Option<Vec<u8>>,
    /// Folders above it that did not exist, the innermost first.
    missing: Vec<PathBuf>,
}

impl Previous {
    /// Reads what stands at `target` now.
    ///
    /// # Errors
    /// [`WriteError::File`] when there is a file that cannot be read.
    pub(super) fn read(target: &Path) -> Result<Self, WriteError> {
        let contents = match fs::read(target) {
            Ok(contents) => Some(contents),
            Err(e) if e.kind() == ErrorKind::NotFound => None,
            Err(source) => return Err(WriteError::File { path: target.to_owned(), source }),
        };
        let above = target.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty());
        let missing = above.take_while(|folder| !folder.exists()).map(Path::to_owned).collect();
        Ok(Self { contents, missing })
    }

    /// Writes it to `real` again, or removes the file and the folders that were made for it and hold nothing else.
    /// Nobody is left to tell if this fails.
    fn put_back(self, real: &Path) {
        let Some(contents) = &self.contents else {
            let _ = fs::remove_file(real);
            self.missing.iter().for_each(|folder| drop(fs::remove_dir(folder)));
            return;
        };
        let Ok(mut file) = builder().tempfile_in(folder_of(real)) else { return };
        if file.write_all(contents).and_then(|()| file.flush()).is_ok() {
            let _ = fs::metadata(real).map(|old| file.as_file().set_permissions(old.permissions()));
            let _ = file.persist(real);
        }
    }
}

/// The folder that a file is in; that of a bare name is the one we are in.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The file a path leads to, or the path where there is none yet.
pub(super) fn behind_links(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

/// A complete file under a temporary name; removed when dropped.
pub(super) struct Pending {
    /// `None` only once renamed.
    file: Option<NamedTempFile>,
    /// Where it goes: the file behind the target, where that is a link.
    real: PathBuf,
}

impl Pending {
    /// Writes contents beside `target`, making its folder if there is none.
    ///
    /// # Errors
    /// [`WriteError::Folder`], [`WriteError::File`], naming the target.
    pub(super) fn create(target: &Path, contents: &[u8]) -> Result<Self, WriteError> {
        let real = behind_links(target);
        let folder = folder_of(&real);
        fs::create_dir_all(folder).map_err(|source| WriteError::Folder { path: folder.to_owned(), source })?;
        let failed = |source| WriteError::File { path: target.to_owned(), source };
        let file = {
            let mut registry = registry();
            let file = builder().tempfile_in(folder).map_err(failed)?;
            registry.temporary.push(file.path().to_owned());
            file
        };
        let old = fs::metadata(&real);
        let mut pending = Self { file: Some(file), real };
        if let Some(file) = &mut pending.file {
            file.write_all(contents).and_then(|()| file.flush()).map_err(failed)?;
            if let Ok(old) = old {
                file.as_file().set_permissions(old.permissions()).map_err(failed)?;
            }
        }
        Ok(pending)
    }

    /// Gives the file its name, which is returned.
    ///
    /// # Errors
    /// [`WriteError::File`], naming the target.
    pub(super) fn rename(mut self, target: &Path, registry: &mut Registry) -> Result<PathBuf, WriteError> {
        let real = std::mem::take(&mut self.real);
        let Some(file) = self.file.take() else { return Ok(real) };
        registry.temporary.retain(|path| path != file.path());
        match file.persist(&real) {
            Ok(_) => Ok(real),
            // Dropping the error removes the temporary file.
            Err(e) => Err(WriteError::File { path: target.to_owned(), source: e.error }),
        }
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        if let Some(file) = self.file.take() {
            let path = file.path().to_owned();
            drop(file);
            // `try_lock`: when a rename fails, `write_all` drops the rest while it holds the lock itself. The entries
            // that then stay name files that no longer exist.
            if let Ok(mut registry) = REGISTRY.try_lock() {
                registry.temporary.retain(|p| *p != path);
            }
        }
    }
}

/// A temporary file that only its owner may read. It is removed when this is dropped, and when the program is
/// interrupted.
pub struct Private(Option<NamedTempFile>);

impl Private {
    /// Writes such a file, whose name ends with `ending`.
    ///
    /// # Errors
    /// [`WriteError::File`] when the system's folder for temporary files cannot be written.
    pub fn new(ending: &str, contents: &[u8]) -> Result<Self, WriteError> {
        let failed = |source| WriteError::File { path: std::env::temp_dir(), source };
        let mut registry = registry();
        let made = tempfile::Builder::new().prefix("toile-").suffix(ending).tempfile();
        let mut file = made.map_err(failed)?;
        registry.temporary.push(file.path().to_owned());
        drop(registry);
        file.write_all(contents).and_then(|()| file.flush()).map_err(failed)?;
        Ok(Self(Some(file)))
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        self.0.as_ref().map_or(Path::new(""), |file| file.path())
    }
}

impl Drop for Private {
    fn drop(&mut self) {
        if let Some(file) = self.0.take() {
            registry().temporary.retain(|path| path != file.path());
        }
    }
}

/// Temporary files would be private; results get the permissions any new file gets.
fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".toile-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder
}
