//! The last garment that came out well, for the next one to go on from.

use std::io;
use std::path::Path;

use super::frames::Frame;
use crate::input::bytes;
use crate::io::files::Private;
use crate::pattern::GarmentFile;
use crate::pipeline::{EarlierFiles, Job, Run};
use crate::report::Report;

/// Name of the earlier garment in the report of the one that goes on from it.
const NAME: &str = "the garment before";

/// Larger files are not read, bytes: one of the two frames may have 256 MiB.
const LARGEST: u64 = 1 << 29;

/// A garment to go on from.
#[derive(Debug)]
pub(super) struct Kept {
    surface: Vec<u8>,
    report: String,
    put_on: String,
}

impl Kept {
    /// The garment of a file, as `garment.obj` and `report.json` have it.
    pub(super) fn new(surface: Vec<u8>, report: &str, said: &GarmentFile) -> Self {
        Self { surface, report: report.to_owned(), put_on: put_on(said) }
    }

    /// Whether the garment of a file may hang where this one does: it is put on as this one was, on the same body.
    pub(super) fn leads_to(&self, said: &GarmentFile) -> bool {
        self.put_on == put_on(said)
    }

    /// This garment in a file that only the process which goes on from it is told of.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub(super) fn in_file(&self) -> io::Result<Private> {
        let mut bytes = Vec::new();
        Frame::Surface(self.surface.clone()).write(&mut bytes)?;
        Frame::Report(self.report.clone()).write(&mut bytes)?;
        Private::new(".frames", &bytes).map_err(io::Error::other)
    }
}

/// The words of a file that decide how a garment is put on: another body or another place needs a start of its own.
fn put_on(said: &GarmentFile) -> String {
    let piece = |own: &crate::pattern::PieceFile| {
        let place = own.place.as_ref().map(|place| &place.value);
        let (layer, side) = (own.layer.as_ref().map(|l| l.value), own.drawn.as_ref().map(|side| side.value));
        format!("{} {place:?} {layer:?} {side:?}", own.name.value)
    };
    let body = said.body.as_ref().map(|body| &body.value);
    format!("{body:?} {:?}", said.pieces.iter().map(piece).collect::<Vec<_>>())
}

/// A run of a job, which goes on from the garment in a file of [`Kept::in_file`], if it can.
pub(super) fn begun<'a>(job: &'a Job, file: Option<&Path>) -> Run<'a> {
    let on = |file: &Path| {
        let bytes = bytes(file, LARGEST).ok()?;
        let mut from = bytes.as_slice();
        let (Frame::Surface(surface), Frame::Report(report)) = (Frame::read(&mut from)?, Frame::read(&mut from)?)
        else {
            return None;
        };
        let files = EarlierFiles { name: Path::new(NAME), surface: &surface, report: report.as_bytes() };
        Run::continued_from(job, &files).ok()
    };
    file.and_then(on).unwrap_or_else(|| Run::new(job))
}

/// Whether a garment came out so well that another may go on from it: at rest, worn, and through nothing.
pub(super) fn is_sound(report: &Report) -> bool {
    let rests = report.stages.iter().all(|stage| stage.converged);
    rests && report.crossings.is_empty() && report.worn.iter().all(|opening| opening.fault.is_none())
}
