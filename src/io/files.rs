//! Writing results: a set of files whole or not at all, never over an input.
//!
//! Every file is written beside its target under a temporary name and renamed when all of them are complete. When the
//! program is interrupted, the handler that [`remove_on_interrupt`] sets up removes the files that are still temporary.

use std::fs;
use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

/// Exit code of a program stopped by Ctrl-C (128 + SIGINT).
const INTERRUPTED: i32 = 130;

/// Whether the first Ctrl-C only asks to stop ([`stop_on_interrupt`]), and whether it has come.
static ASKS: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);

/// Temporary files that exist now. Global, as the flags above: an interrupt handler has no other way to know.
/// It is locked from before a temporary file appears until after it is registered, and while files are renamed, so
/// the handler sees none unregistered and no set half renamed.
static PENDING: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

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

/// Writes every (path, contents) pair, making folders as needed, or writes no file.
///
/// A file that exists keeps its permissions, and a link to it stays one. `inputs` are the files the program has read;
/// none is overwritten, also not through a link. All contents are written under temporary names before the first
/// rename (the system may still hold them in memory: after a power cut files may be missing or short). Only if a rename
/// itself fails (a folder loses its permissions in that moment) may earlier files of the set be in place; each one is
/// whole even then.
///
/// # Errors
/// [`WriteError`], naming the path.
pub fn write_all(files: &[(PathBuf, Vec<u8>)], inputs: &[&Path]) -> Result<(), WriteError> {
    for (path, _) in files {
        refuse(path, inputs)?;
    }
    let mut temporary = Vec::with_capacity(files.len());
    for (path, contents) in files {
        temporary.push(Pending::create(path, contents)?);
    }
    // Once more, now that the folders are there: a path through one that was missing (`new/../input`)
    // led nowhere before.
    for (path, _) in files {
        refuse(path, inputs)?;
    }
    let mut registry = registry();
    for (pending, (path, _)) in temporary.into_iter().zip(files) {
        pending.rename(path, &mut registry)?;
    }
    Ok(())
}

/// Checks, before a long computation, that [`write_all`] will be able to write these files: that none is an input or a
/// folder, and that a file can be made where they are to go, or in the nearest folder above that exists.
///
/// # Errors
/// [`WriteError`], naming the path.
pub fn check_writable(paths: &[PathBuf], inputs: &[&Path]) -> Result<(), WriteError> {
    for path in paths {
        refuse(path, inputs)?;
        // The parent of a bare name is the empty path: the folder one is in.
        let existing = path.ancestors().skip(1).find(|p| fs::symlink_metadata(p).is_ok());
        if let Some(file) = existing.filter(|p| !p.is_dir()) {
            return Err(WriteError::NotFolder { target: path.clone(), path: file.to_owned() });
        }
        // Created and dropped: permissions, read-only disks and files in the way all show.
        Pending::create(&existing.unwrap_or(Path::new(".")).join("toile"), b"").map_err(|e| match e {
            WriteError::File { source, .. } | WriteError::Folder { source, .. } => {
                WriteError::File { path: path.clone(), source }
            }
            other => other,
        })?;
    }
    Ok(())
}

/// Removes temporary files when the program is interrupted and ends it with exit code 130. Called once, by the command
/// line.
///
/// # Errors
/// [`WriteError::Handler`] when there is a handler already or the system refuses.
pub fn remove_on_interrupt() -> Result<(), WriteError> {
    ctrlc::set_handler(|| {
        if ASKS.load(Ordering::SeqCst) && !ASKED.swap(true, Ordering::SeqCst) {
            return;
        }
        abandon();
    })?;
    Ok(())
}

/// From now on the first Ctrl-C only asks to stop. The function that is returned tells whether it has. The second
/// Ctrl-C ends the program as before.
pub fn stop_on_interrupt() -> impl Fn() -> bool + Sync {
    ASKS.store(true, Ordering::SeqCst);
    || ASKED.load(Ordering::SeqCst)
}

/// Removes temporary files and ends the program with exit code 130.
pub fn abandon() -> ! {
    // The lock is never given back: no file may appear after the sweep.
    for path in registry().iter() {
        // Nobody is left to tell if this fails.
        let _ = fs::remove_file(path);
    }
    std::process::exit(INTERRUPTED);
}

/// The way to a file from a folder, both as named from here; `None` where there is none, as between drives.
pub fn relative(file: &Path, folder: &Path) -> Option<PathBuf> {
    let [file, folder] = [whole(file)?, whole(folder)?];
    let (own, from): (Vec<Component>, Vec<Component>) = (file.components().collect(), folder.components().collect());
    let shared = own.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let has_way = shared > 0 && !from[shared..].iter().any(|part| matches!(part, Component::Prefix(_)));
    has_way.then(|| from[shared..].iter().map(|_| Component::ParentDir).chain(own[shared..].iter().copied()).collect())
}

/// A path from the root on, without steps back.
fn whole(path: &Path) -> Option<PathBuf> {
    let mut whole = PathBuf::new();
    for part in std::path::absolute(path).ok()?.components() {
        if part == Component::ParentDir {
            whole.pop();
        } else {
            whole.push(part);
        }
    }
    Some(whole)
}

/// A thread that panicked while it held the lock left a list that is still right.
fn registry() -> MutexGuard<'static, Vec<PathBuf>> {
    PENDING.lock().unwrap_or_else(PoisonError::into_inner)
}

fn refuse(path: &Path, inputs: &[&Path]) -> Result<(), WriteError> {
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

/// The file a path leads to, or the path where there is none yet.
fn behind_links(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_owned())
}

/// A complete file under a temporary name; removed when dropped.
struct Pending {
    /// `None` only once renamed.
    file: Option<NamedTempFile>,
    /// Where it goes: the file behind the target, where that is a link.
    real: PathBuf,
}

impl Pending {
    fn create(target: &Path, contents: &[u8]) -> Result<Self, WriteError> {
        let real = behind_links(target);
        let folder = match real.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        fs::create_dir_all(folder).map_err(|source| WriteError::Folder { path: folder.to_owned(), source })?;
        let failed = |source| WriteError::File { path: target.to_owned(), source };
        let file = {
            let mut registry = registry();
            let file = builder().tempfile_in(folder).map_err(failed)?;
            registry.push(file.path().to_owned());
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

    fn rename(mut self, target: &Path, registry: &mut Vec<PathBuf>) -> Result<(), WriteError> {
        let Some(file) = self.file.take() else { return Ok(()) };
        registry.retain(|path| path != file.path());
        match file.persist(&self.real) {
            Ok(_) => Ok(()),
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
            if let Ok(mut registry) = PENDING.try_lock() {
                registry.retain(|p| *p != path);
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
        registry.push(file.path().to_owned());
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
            registry().retain(|path| path != file.path());
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

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("a folder");
        let mut names: Vec<String> = entries.filter_map(|e| e.ok()?.file_name().into_string().ok()).collect();
        names.sort();
        names
    }

    #[test]
    #[cfg(unix)]
    fn a_link_stays_a_link_and_a_file_keeps_its_permissions() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().expect("a folder");
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, "old").expect("written");
        fs::set_permissions(&file, fs::Permissions::from_mode(0o600)).expect("set");
        symlink(&file, &link).expect("linked");
        write_all(&[(link.clone(), b"new".to_vec())], &[]).expect("written");
        assert!(fs::symlink_metadata(&link).expect("there").is_symlink());
        assert_eq!(fs::read(&file).expect("there"), b"new");
        assert_eq!(fs::metadata(&file).expect("there").permissions().mode() & 0o777, 0o600);

        fs::set_permissions(&file, fs::Permissions::from_mode(0o400)).expect("set");
        let refused = write_all(&[(file.clone(), b"newer".to_vec())], &[]);
        assert!(matches!(refused, Err(WriteError::Protected(_))), "{refused:?}");
        assert_eq!(fs::read(&file).expect("there"), b"new");
    }

    #[test]
    #[cfg(unix)]
    fn what_is_no_file_stays_what_it_is() {
        use std::os::unix::fs::FileTypeExt;
        use std::os::unix::net::UnixListener;
        let folder = tempfile::tempdir().expect("a folder");
        let socket = folder.path().join("socket");
        let _listener = UnixListener::bind(&socket).expect("bound");
        let refused = write_all(&[(socket.clone(), b"new".to_vec())], &[]);
        assert!(matches!(refused, Err(WriteError::NotFile(_))), "{refused:?}");
        assert!(fs::metadata(&socket).expect("there").file_type().is_socket());
    }

    #[test]
    fn a_set_is_written_and_replaced() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let out = dir.path().join("out/dress");
        let files = [(out.join("a.txt"), b"one".to_vec()), (out.join("b.txt"), b"two".to_vec())];
        write_all(&files, &[]).expect("written");
        write_all(&[(out.join("a.txt"), b"three".to_vec())], &[]).expect("replaced");
        assert_eq!(names(&out), ["a.txt", "b.txt"]);
        assert_eq!(fs::read(out.join("a.txt")).expect("read"), b"three");
    }

    #[test]
    fn an_input_is_not_overwritten_through_a_folder_that_is_missing_yet() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let input = dir.path().join("dress.yaml");
        fs::write(&input, "pieces").expect("written");
        let round = dir.path().join("new/../dress.yaml");
        let refused = write_all(&[(round, b"vertices".to_vec())], &[&input]);
        assert!(matches!(refused, Err(WriteError::IsInput(_))), "{refused:?}");
        assert_eq!(fs::read(&input).expect("read"), b"pieces");
    }

    #[test]
    fn an_input_is_never_overwritten() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let input = dir.path().join("dress.yaml");
        fs::write(&input, "pieces").expect("written");
        let roundabout = dir.path().join("./dress.yaml");
        let files = [(dir.path().join("a.txt"), vec![1]), (roundabout, vec![2])];
        assert!(matches!(write_all(&files, &[&input]), Err(WriteError::IsInput(_))));
        assert_eq!(names(dir.path()), ["dress.yaml"]);
        assert_eq!(fs::read(&input).expect("read"), b"pieces");
    }

    #[test]
    fn nothing_is_left_when_one_file_cannot_be_written() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let blocked = dir.path().join("file");
        fs::write(&blocked, "").expect("written");
        let files = [(dir.path().join("a.txt"), vec![1]), (blocked.join("b.txt"), vec![2])];
        let error = write_all(&files, &[]).expect_err("a file is no folder");
        assert!(matches!(error, WriteError::Folder { .. }), "{error}");
        assert_eq!(names(dir.path()), ["file"]);
        fs::create_dir(dir.path().join("folder")).expect("made");
        let files = [(dir.path().join("a.txt"), vec![1]), (dir.path().join("folder"), vec![2])];
        assert!(matches!(write_all(&files, &[]), Err(WriteError::IsFolder(_))));
        assert_eq!(names(dir.path()), ["file", "folder"]);
    }

    #[cfg(unix)]
    #[test]
    fn results_have_ordinary_permissions() {
        use std::os::unix::fs::PermissionsExt;
        let dir = tempfile::tempdir().expect("a temporary folder");
        let (ours, plain) = (dir.path().join("ours"), dir.path().join("plain"));
        write_all(&[(ours.clone(), vec![])], &[]).expect("written");
        fs::write(&plain, "").expect("written");
        let mode = |p: &Path| fs::metadata(p).expect("there").permissions().mode();
        assert_eq!(mode(&ours), mode(&plain));
    }

    /// Set for the child process of the test below: the folder it works in.
    #[cfg(unix)]
    const CHILD_FOLDER: &str = "TOILE_TEST_INTERRUPTED_IN";

    /// Not a test of its own: what the test below interrupts.
    #[cfg(unix)]
    #[test]
    fn interrupted_child() {
        let Some(folder) = std::env::var_os(CHILD_FOLDER).map(PathBuf::from) else { return };
        remove_on_interrupt().expect("a handler");
        let _pending = Pending::create(&folder.join("half.txt"), b"half").expect("written");
        std::thread::sleep(std::time::Duration::from_secs(20));
    }

    #[cfg(unix)]
    #[test]
    fn an_interrupt_leaves_nothing_behind() {
        let dir = tempfile::tempdir().expect("a temporary folder");
        let mut child = std::process::Command::new(std::env::current_exe().expect("this test"))
            .args(["--exact", "io::files::tests::interrupted_child"])
            .env(CHILD_FOLDER, dir.path())
            .stdout(std::process::Stdio::null())
            .spawn()
            .expect("started");
        // The handler is set before the file appears.
        while names(dir.path()).is_empty() && child.try_wait().expect("a child").is_none() {
            std::thread::sleep(std::time::Duration::from_millis(5));
        }
        let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        assert!(kill.expect("a kill command").success());
        assert_eq!(child.wait().expect("ended").code(), Some(INTERRUPTED));
        assert!(names(dir.path()).is_empty());
    }
}
