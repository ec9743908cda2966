//! Messages from the process that makes the garment to the studio: a kind, a length and bytes each.

use std::cell::RefCell;
use std::io::{self, Read, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use super::earlier::{begun, is_sound};
use crate::flatten;
use crate::geometry::MM;
use crate::pipeline::{Glimpse, Job, Overrides, PipelineError, Reached, Run, json_text, read_variant};

/// Bytes of a frame. A garment of a million particles has fewer.
const LARGEST: u32 = 1 << 28;
/// Time between two frames that tell the progress.
const PACE: Duration = Duration::from_millis(100);

/// A message.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Frame {
    /// The body, as binary glTF.
    Body(Vec<u8>),
    /// Description of the next garment.
    About(About),
    /// The garment, as binary glTF.
    Garment(Vec<u8>),
    /// The garment as `garment.obj`, for the next one to go on from. The report follows.
    Surface(Vec<u8>),
    /// The text of `report.json`.
    Report(String),
    /// The stage under way, and the share of it that is done.
    Progress(String, f64),
    /// Why there is no garment.
    Failed(String),
}

/// Description of a garment that is shown.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct About {
    /// Name of the garment.
    pub(super) garment: String,
    /// Name of its body.
    pub(super) mannequin: String,
    /// Names of its fabrics.
    pub(super) fabric: String,
    /// Spacing of the mesh, mm.
    pub(super) spacing: f64,
    /// How far it has come, in words.
    pub(super) reached: String,
    /// Whether it is the one that was asked for, at rest, and not on its way.
    pub(super) done: bool,
}

impl Frame {
    /// # Errors
    /// A reader that is gone.
    pub(super) fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let (kind, bytes) = match self {
            Self::Body(bytes) => (b'b', bytes.clone()),
            Self::About(about) => (b'a', serde_json::to_vec(about)?),
            Self::Garment(bytes) => (b'g', bytes.clone()),
            Self::Surface(bytes) => (b's', bytes.clone()),
            Self::Report(text) => (b'r', text.clone().into_bytes()),
            Self::Progress(stage, share) => (b'p', serde_json::to_vec(&(stage, share))?),
            Self::Failed(text) => (b'f', text.clone().into_bytes()),
        };
        let length = u32::try_from(bytes.len()).ok().filter(|length| *length <= LARGEST);
        let length = length.ok_or_else(|| io::Error::other("a frame is too long"))?;
        out.write_all(&[kind])?;
        out.write_all(&length.to_le_bytes())?;
        out.write_all(&bytes)?;
        out.flush()
    }

    /// The next frame. `None` where the writer has ended, or writes something else.
    pub(super) fn read(from: &mut impl Read) -> Option<Self> {
        let mut head = [0; 5];
        from.read_exact(&mut head).ok()?;
        let length = u32::from_le_bytes([head[1], head[2], head[3], head[4]]);
        let mut bytes = Vec::new();
        from.take(u64::from(length.min(LARGEST))).read_to_end(&mut bytes).ok()?;
        if bytes.len() != length as usize {
            return None;
        }
        Some(match head[0] {
            b'b' => Self::Body(bytes),
            b'a' => Self::About(serde_json::from_slice(&bytes).ok()?),
            b'g' => Self::Garment(bytes),
            b's' => Self::Surface(bytes),
            b'r' => Self::Report(String::from_utf8(bytes).ok()?),
            b'p' => serde_json::from_slice(&bytes).ok().map(|(stage, share)| Self::Progress(stage, share))?,
            b'f' => Self::Failed(String::from_utf8(bytes).ok()?),
            _ => return None,
        })
    }
}

/// Makes a garment and writes it in frames, coarser levels first. It goes on from the one in the file `earlier`, which
/// the studio has written, if it can. A garment that cannot be made is a frame, too.
///
/// # Errors
/// A reader that is gone.
pub fn write_frames(file: &Path, overrides: &Overrides, earlier: Option<&Path>, out: impl Write) -> io::Result<()> {
    let out = RefCell::new(out);
    let gone = RefCell::new(None);
    let send = |frame: Frame| {
        if let Err(error) = frame.write(&mut *out.borrow_mut()) {
            gone.borrow_mut().get_or_insert(error);
        }
    };
    if let Err(error) = make(file, overrides, earlier, &send) {
        send(Frame::Failed(error.to_string()));
    }
    gone.into_inner().map_or(Ok(()), Err)
}

fn make(file: &Path, overrides: &Overrides, earlier: Option<&Path>, send: &dyn Fn(Frame)) -> Result<(), PipelineError> {
    let loaded = read_variant(file, overrides.variant())?;
    let job = Job::new(file, loaded, overrides)?;
    send(Frame::Body(job.body_glb()));
    let about = |spacing: f64, reached: &str, done: bool| About {
        garment: job.garment.title.clone(),
        mannequin: job.body.name.clone(),
        fabric: job.fabric_names(),
        spacing: MM * spacing,
        reached: reached.to_owned(),
        done,
    };
    let watch = |glimpse: &Glimpse| {
        let reached = match glimpse.reached {
            Reached::Begun => "before it is sewn",
            Reached::Sewn => "sewn",
            Reached::Draped => "draped",
        };
        send(Frame::About(about(glimpse.mesh.spacing, reached, false)));
        send(Frame::Garment(job.glimpse_glb(glimpse)));
    };
    let show = |run: &Run, reached: &str, done: bool| {
        if let Some(surface) = run.surface() {
            send(Frame::About(about(job.mesh.spacing, reached, done)));
            send(Frame::Garment(surface));
        }
    };
    let mut run = begun(&job, earlier).watched_by(&watch);
    let hung = |run: &Run| if run.is_carried() { "where the one before hung" } else { "sewn" };
    let made = stages(&mut run, send, &|run| show(run, hung(run), false));
    let report = made.is_ok().then(|| run.report());
    let reached = if report.is_some() { "draped" } else { "as far as it came" };
    show(&run, reached, report.is_some());
    if let Some(report) = report {
        if is_sound(&report) {
            run.garment_obj().into_iter().for_each(|surface| send(Frame::Surface(surface)));
        }
        send(Frame::Report(json_text(&report)?));
    }
    made
}

/// All stages, with their progress told now and then. `sewn` is told of the garment before it is draped.
fn stages(run: &mut Run, send: &dyn Fn(Frame), sewn: &dyn Fn(&Run)) -> Result<(), PipelineError> {
    let mut told: Option<Instant> = None;
    let mut tell = |stage: &str, share: f64| {
        if told.is_none_or(|told| told.elapsed() >= PACE) {
            told = Some(Instant::now());
            send(Frame::Progress(stage.to_owned(), share));
        }
    };
    run.sew(&mut tell)?;
    sewn(run);
    run.drape(&mut tell)?;
    run.flatten(&flatten::FlattenOptions::default(), &mut tell)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_come_as_they_went() {
        let about = About { garment: "é".into(), spacing: 25.0, ..About::default() };
        let frames = [
            Frame::Body(vec![1, 2, 3]),
            Frame::About(about),
            Frame::Garment(Vec::new()),
            Frame::Surface(vec![4]),
            Frame::Report("{}".into()),
            Frame::Progress("sew".into(), 0.25),
            Frame::Failed("no body".into()),
        ];
        let mut bytes = Vec::new();
        frames.iter().for_each(|frame| frame.write(&mut bytes).expect("written"));
        let mut from = bytes.as_slice();
        for frame in &frames {
            assert_eq!(Frame::read(&mut from).as_ref(), Some(frame));
        }
        assert_eq!(Frame::read(&mut from), None);
        assert_eq!(Frame::read(&mut &bytes[..6]), None, "cut off");
        assert_eq!(Frame::read(&mut [b'b', 255, 255, 255, 255, 0].as_slice()), None, "longer than it is");
    }
}
