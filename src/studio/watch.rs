//! Watches the file and those that it names, and has the garment made anew when one of them changes.

use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread;
use std::time::{Duration, SystemTime};

use super::StudioOptions;
use super::making::Making;
use super::session::Session;
use crate::io::garment::read_file_only;
use crate::pattern::fabrics;

/// Time between two looks: short beside the 2 s in which a save should be seen, and hardly any work.
const LOOK: Duration = Duration::from_millis(150);

/// Time of the last change and length of a file, without reading it.
type Stamp = Option<(SystemTime, u64)>;

/// Starts to watch.
///
/// # Errors
/// A thread that cannot be started.
pub(super) fn start(session: Arc<Session>, options: &StudioOptions) -> io::Result<()> {
    let options = options.clone();
    thread::Builder::new().name("watch".into()).spawn(move || watch(&session, &options)).map(drop)
}

fn watch(session: &Arc<Session>, options: &StudioOptions) {
    let mut asked = 0;
    let mut beside: Vec<(PathBuf, Stamp)> = Vec::new();
    let mut making = begin(session, options, &mut beside, false);
    loop {
        let before = asked;
        session.wait(&mut asked, LOOK);
        let others = beside.iter().any(|(file, known)| stamp(file) != *known);
        // An act has it looked at by itself.
        let is_unseen = session.look() || others;
        if is_unseen || asked != before {
            // A garment of the file as it was is of no use any more.
            drop(making.take());
            making = begin(session, options, &mut beside, is_unseen);
        }
    }
}

/// Starts to make the garment and notes which files it depends on. Meanwhile it is looked at whether the file has
/// mistakes, here if it `is_unseen`. If it has, nothing is made.
fn begin(
    session: &Arc<Session>,
    options: &StudioOptions,
    beside: &mut Vec<(PathBuf, Stamp)>,
    is_unseen: bool,
) -> Option<Making> {
    *beside = named(session.file(), &session.text()).into_iter().map(|file| (file.clone(), stamp(&file))).collect();
    session.begun(true);
    let making = Making::start(session.file(), &session.wanted(), options, Arc::clone(session));
    if is_unseen {
        session.see();
    }
    let making = making.ok().filter(|_| session.is_sound());
    if making.is_none() {
        session.begun(false);
    }
    making
}

/// Files that a garment file names: its fabrics' and its body's.
fn named(file: &Path, text: &str) -> Vec<PathBuf> {
    let Ok(said) = read_file_only("", text) else { return Vec::new() };
    let folder = file.parent().unwrap_or(Path::new(""));
    let cloths = fabrics(&said).into_iter().filter_map(|fabric| fabric.spec.base);
    let names = cloths.chain(said.body.map(|body| body.value));
    names.map(|name| folder.join(name)).filter(|path| path.is_file()).collect()
}

fn stamp(file: &Path) -> Stamp {
    let found = file.metadata().ok()?;
    Some((found.modified().ok()?, found.len()))
}
