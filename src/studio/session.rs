//! All that the page shows, and the file behind it.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use serde::Serialize;

use super::StudioError;
use super::acts::{Act, ActError, Done};
use super::earlier::Kept;
use super::frames::{About, Frame};
use super::history::History;
use super::view::{View, view};
use super::wanted::{SPACINGS, Wanted};
use crate::input::bytes;
use crate::io::files::{Private, write_all};
use crate::io::garment::{LARGEST_FILE, read_file_only};
use crate::pattern::GarmentFile;

/// Longest time that a check of the file may take: many times that of the largest garment on a busy machine.
const LONGEST_CHECK: Duration = Duration::from_secs(60);

/// The state of a studio.
pub(super) struct Session {
    file: PathBuf,
    inner: Mutex<Inner>,
    changed: Condvar,
}

#[derive(Default)]
struct Inner {
    /// The file as it was read last, or why it cannot be read.
    text: String,
    unreadable: Option<String>,
    /// Whether a garment can be made of it. `None` while that is being looked at.
    is_sound: Option<bool>,
    wanted: Wanted,
    /// Frames of a garment that came before that was known.
    early: Vec<Frame>,
    /// The last garment that came out well, and the surface of the next one, whose report is still to come.
    kept: Option<Kept>,
    surface: Option<Vec<u8>>,
    history: History,
    state: Arc<String>,
    body: Arc<Vec<u8>>,
    garment: Arc<Vec<u8>>,
    report: Arc<String>,
    about: About,
    news: News,
    /// Told whenever the watching thread should look at once.
    asked: u64,
}

/// News for the pages: version numbers of the parts, and the progress of the garment.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(super) struct News {
    /// Number of the file's state.
    pub(super) state: u64,
    /// Number of the body.
    body: u64,
    /// Number of the garment that is shown.
    garment: u64,
    /// Number of the garment that the report is of.
    report: u64,
    /// Whether a garment is being made.
    making: bool,
    /// The stage under way.
    stage: String,
    /// The share of it that is done.
    share: f64,
    /// Why the last garment could not be made.
    failed: Option<String>,
}

/// Something that the page fetches.
pub(super) enum Part {
    State,
    Body,
    Garment,
    Report,
    About,
}

impl Session {
    /// A session of a file.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(super) fn new(file: &Path, wanted: Wanted) -> Result<Self, StudioError> {
        let text = read(file).map_err(|why| StudioError::File { file: file.to_owned(), why })?;
        if let (Ok(said), Some(size)) = (read_file_only("", &text), &wanted.size) {
            known(&said, size).map_err(|_| StudioError::Size { file: file.to_owned(), size: size.clone() })?;
        }
        let inner = Inner { text, wanted, ..Inner::default() };
        let session = Self { file: file.to_owned(), inner: Mutex::new(inner), changed: Condvar::new() };
        session.see();
        Ok(session)
    }

    pub(super) fn file(&self) -> &Path {
        &self.file
    }

    /// A thread that panicked while it held the lock left a state that is still whole: it is replaced part by part.
    fn lock(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Looks at the file. Whether it is another than before: then [`Self::see`] has to be asked.
    pub(super) fn look(&self) -> bool {
        // Read under the lock: an act must not write in between.
        let mut inner = self.lock();
        match read(&self.file) {
            Ok(text) if inner.unreadable.is_none() && text == inner.text => return false,
            Err(why) if inner.unreadable.as_ref() == Some(&why) => return false,
            Ok(text) => (inner.text, inner.unreadable) = (text, None),
            Err(why) => inner.unreadable = Some(why),
        }
        inner.is_sound = None;
        true
    }

    /// Says what the file holds, and the files that it names.
    pub(super) fn see(&self) {
        let mut inner = self.lock();
        // From now on no act is done that was meant for the state before.
        inner.news.state += 1;
        inner.is_sound = None;
        let (text, unreadable, wanted) = (inner.text.clone(), inner.unreadable.clone(), inner.wanted.clone());
        drop(inner);
        // A check takes a while, in which the page is served.
        let view = view(&self.file, &text, unreadable.as_deref(), &wanted);
        let mut inner = self.lock();
        if (&inner.text, &inner.unreadable, &inner.wanted) == (&text, &unreadable, &wanted) {
            inner.renew(view);
            self.changed.notify_all();
        }
    }

    /// Whether a garment can be made of the file, as soon as that is known. One that is not known for very long cannot.
    pub(super) fn is_sound(&self) -> bool {
        let inner = self.lock();
        let known = self.changed.wait_timeout_while(inner, LONGEST_CHECK, |inner| inner.is_sound.is_none());
        known.unwrap_or_else(PoisonError::into_inner).0.is_sound == Some(true)
    }

    /// The page's wishes, as far as the file that was read last allows them.
    pub(super) fn wanted(&self) -> Wanted {
        let (text, wanted) = {
            let inner = self.lock();
            (inner.text.clone(), inner.wanted.clone())
        };
        wanted.of(read_file_only("", &text).ok().as_ref())
    }

    /// The garment that the next one may go on from, in a file. `None` where there is none, or that one is put on in
    /// another way.
    pub(super) fn earlier(&self) -> Option<Private> {
        let inner = self.lock();
        let said = read_file_only("", &inner.text).ok()?;
        inner.kept.as_ref().filter(|kept| kept.leads_to(&said))?.in_file().ok()
    }

    /// The text of the file as it was read last.
    pub(super) fn text(&self) -> String {
        self.lock().text.clone()
    }

    /// A garment is being made, or not.
    pub(super) fn begun(&self, making: bool) {
        let mut inner = self.lock();
        inner.early.clear();
        inner.news = News { making, stage: String::new(), share: 0.0, failed: None, ..inner.news.clone() };
        self.changed.notify_all();
    }

    /// Nothing more comes of the garment that was being made.
    pub(super) fn ended(&self) {
        let mut inner = self.lock();
        inner.news.making = false;
        self.changed.notify_all();
    }

    /// Takes what the process that makes the garment has to say.
    pub(super) fn take(&self, frame: Frame) {
        let mut inner = self.lock();
        if inner.is_sound.is_none() {
            // Of a file with mistakes nothing is shown.
            return inner.early.push(frame);
        }
        inner.take(frame);
        self.changed.notify_all();
    }

    /// The news, as soon as they differ from `old`. `None` when they do not for so long.
    pub(super) fn news(&self, old: &News, patience: Duration) -> Option<News> {
        let inner = self.lock();
        let waited = self.changed.wait_timeout_while(inner, patience, |inner| inner.news == *old);
        let (inner, waited) = waited.unwrap_or_else(PoisonError::into_inner);
        (!waited.timed_out()).then(|| inner.news.clone())
    }

    /// Waits until an act asks for a look at the file, or for so long.
    pub(super) fn wait(&self, asked: &mut u64, patience: Duration) {
        let inner = self.lock();
        let waited = self.changed.wait_timeout_while(inner, patience, |inner| inner.asked == *asked);
        *asked = waited.unwrap_or_else(PoisonError::into_inner).0.asked;
    }

    /// A part of the state, as bytes.
    pub(super) fn part(&self, part: &Part) -> Vec<u8> {
        let inner = self.lock();
        match part {
            Part::State => inner.state.as_bytes().to_vec(),
            Part::Body => inner.body.to_vec(),
            Part::Garment => inner.garment.to_vec(),
            Part::Report => inner.report.as_bytes().to_vec(),
            Part::About => serde_json::to_vec(&inner.about).unwrap_or_default(),
        }
    }

    /// Does an act of a page that knows the state with the number `base`. The file is written whole or not at all.
    ///
    /// # Errors
    /// [`ActError`]: nothing has changed then.
    pub(super) fn act(&self, base: u64, act: &Act) -> Result<(), ActError> {
        let mut inner = self.lock();
        if base != inner.news.state {
            return Err(ActError::Old);
        }
        if let Act::Spacing { mm } = act {
            inner.wanted.spacing = *SPACINGS.iter().find(|spacing| *spacing == mm).ok_or(ActError::Spacing)?;
        } else if *act == Act::Anew {
            inner.kept = None;
        } else if let Act::Size { name } = act {
            let said = read_file_only("", &inner.text).map_err(|e| ActError::File(e.to_string()))?;
            name.iter().try_for_each(|size| known(&said, size))?;
            inner.wanted.size.clone_from(name);
        } else {
            let there = read(&self.file).map_err(ActError::File)?;
            if there != inner.text {
                return Err(ActError::Old);
            }
            let done = match act {
                Act::Undo => inner.history.before(&there).map(|text| Done { text, label: String::new() }),
                Act::Redo => inner.history.after(&there).map(|text| Done { text, label: String::new() }),
                other => Some(other.done(&there, &self.file)?),
            };
            let done = done.ok_or(ActError::NothingToUndo)?;
            let written = write_all(&[(self.file.clone(), done.text.clone().into_bytes())], &[]);
            written.map_err(|e| ActError::File(e.to_string()))?;
            match act {
                Act::Undo => inner.history.went_back(),
                Act::Redo => inner.history.went_on(),
                _ => inner.history.keep(&done.label, &there, &done.text),
            }
            inner.text = done.text;
        }
        // The garment is begun while it is still being looked at whether one can be made.
        inner.is_sound = None;
        inner.asked += 1;
        self.changed.notify_all();
        drop(inner);
        self.see();
        Ok(())
    }
}

/// # Errors
/// A size that the file does not have.
fn known(said: &GarmentFile, size: &str) -> Result<(), ActError> {
    let has = said.sizes.iter().any(|own| own.name.value == size);
    if has { Ok(()) } else { Err(ActError::Size(size.to_owned())) }
}

impl Inner {
    fn take(&mut self, frame: Frame) {
        match frame {
            Frame::Body(bytes) if bytes == *self.body => {}
            Frame::Body(bytes) => {
                self.body = Arc::new(bytes);
                self.news.body += 1;
            }
            Frame::About(about) => self.about = about,
            Frame::Garment(bytes) => {
                self.garment = Arc::new(bytes);
                self.news.garment += 1;
            }
            Frame::Surface(bytes) => self.surface = Some(bytes),
            Frame::Report(text) => {
                let said = read_file_only("", &self.text).ok();
                let fresh = self.surface.take().zip(said).map(|(surface, said)| Kept::new(surface, &text, &said));
                // One that did not come out well is none to go on from; the one before it may be.
                self.kept = fresh.or_else(|| self.kept.take());
                self.report = Arc::new(text);
                self.news.report = self.news.garment;
            }
            Frame::Progress(stage, share) => (self.news.stage, self.news.share) = (stage, share),
            Frame::Failed(why) => self.news.failed = Some(why),
        }
    }

    /// Takes a new state of the file.
    fn renew(&mut self, View { mut json, is_sound }: View) {
        self.is_sound = Some(is_sound);
        let early = std::mem::take(&mut self.early);
        early.into_iter().filter(|_| is_sound).for_each(|frame| self.take(frame));
        self.news.state += 1;
        json["version"] = self.news.state.into();
        json["undo"] = self.history.undoable(&self.text).into();
        json["redo"] = self.history.redoable(&self.text).into();
        self.state = Arc::new(json.to_string());
    }
}

fn read(file: &Path) -> Result<String, String> {
    let bytes = bytes(file, LARGEST_FILE).map_err(|e| e.to_string())?;
    String::from_utf8(bytes).map_err(|e| format!("it is not UTF-8 text (byte {})", e.utf8_error().valid_up_to()))
}
