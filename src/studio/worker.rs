//! The process that makes the garment of a file.

use std::cell::RefCell;
use std::io::{self, Write};
use std::path::Path;
use std::time::{Duration, Instant};

use super::earlier::{begun, is_sound};
use super::frames::{About, Frame};
use crate::flatten;
use crate::geometry::MM;
use crate::pipeline::{Glimpse, Job, Overrides, PipelineError, Reached, Run, json_text, read_variant};

/// Time between two frames that tell the progress.
const PACE: Duration = Duration::from_millis(100);

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
