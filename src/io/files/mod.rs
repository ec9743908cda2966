//! Writing results: a set of files whole or not at all, never over an input.
//!
//! Every file is written beside its target under a temporary name and renamed when all of them are complete. When the
//! program is interrupted, the handler that [`undo_on_interrupt`] sets up removes files that are still temporary. It
//! puts back what a [`Preview`] stands in for.

mod error;
mod preview;
mod refuse;
mod temporary;

use std::fs;
use std::path::{Component, Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

pub use self::error::WriteError;
pub use self::preview::Preview;
use self::refuse::refuse;
pub use self::temporary::Private;
use self::temporary::{Pending, registry};

/// Exit code of a program stopped by Ctrl-C (128 + SIGINT).
const INTERRUPTED: i32 = 130;

/// Whether the first Ctrl-C only asks to stop ([`stop_on_interrupt`]), and whether it has come.
static ASKS: AtomicBool = AtomicBool::new(false);
static ASKED: AtomicBool = AtomicBool::new(false);

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
        let real = pending.rename(path, &mut registry)?;
        registry.keep(&real);
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

/// Removes temporary files and previews when the program is interrupted and ends it with exit code 130. Called once, by
/// the command line.
///
/// # Errors
/// [`WriteError::Handler`] when there is a handler already or the system refuses.
pub fn undo_on_interrupt() -> Result<(), WriteError> {
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

/// Removes temporary files and previews and ends the program with exit code 130.
pub fn abandon() -> ! {
    // The lock is never given back: no file may appear after the sweep.
    let mut registry = registry();
    registry.undo();
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
        undo_on_interrupt().expect("a handler");
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
