//! GarmentCode's pattern specifications (JSON) as garment files.
//!
//! ```text
//! JSON ─▶ spec ─▶ drawing ─▶ pieces ─▶ edges ─▶ seams ─▶ GarmentFile
//!         checked  upright,   pairs,    named    mirrored ones once,
//!                  clockwise  places             long ones in one
//! ```
//!
//! Panels are placed by where they are: one whose outline runs the other way round is walked anew. Heights count from
//! the floor that the body stands on.
//!
//! Every edge of a panel is an edge of its piece with the same length; every stitch is in one seam. Only edges too
//! short to be meshed are left out, and stitches between two of them. Grain, fabric and allowance,
//! which the format does not know, are filled in: the grain runs down the drawing, the cloth is a cotton poplin.

mod drawing;
mod edges;
mod error;
mod garment;
mod outward;
mod pieces;
mod role;
mod seams;
mod short;
mod spec;

pub use error::ImportError;

use std::path::Path;

use crate::geometry::MM;
use crate::input::bytes;
use crate::pattern::GarmentFile;
use spec::Specification;

/// The body that a specification is worn by.
#[derive(Clone, Copy, Debug, Default)]
pub struct Wearer<'a> {
    /// As the garment file is to name it.
    pub body: Option<&'a str>,
    /// Height of the floor that it stands on in its own file, metres: the specification counts heights as that does.
    pub floor: f64,
}

/// Bytes of a specification: a garment of hundreds of panels. Larger files are none.
const LARGEST_FILE: u64 = 64 << 20;

/// The text of a specification's file.
///
/// # Errors
/// Why it cannot be read: the system's reason, a folder or a pipe, too many bytes, bytes that are no text.
pub fn text_of(path: &Path) -> Result<String, String> {
    let bytes = bytes(path, LARGEST_FILE).map_err(|e| e.to_string())?;
    String::from_utf8(bytes).map_err(|e| format!("it is not UTF-8 text (byte {})", e.utf8_error().valid_up_to()))
}

/// Reads a specification as a garment file called `name`, to be worn by `wearer`.
///
/// Lengths are millimetres, rounded to thousandths or to as many decimals as keep every edge within 0.005 mm of its
/// length.
///
/// # Errors
/// [`ImportError`], naming panel, edge or stitch.
pub fn read(name: &str, text: &str, wearer: Wearer) -> Result<GarmentFile, ImportError> {
    let mut spec = Specification::parse(text)?;
    spec.panels.iter_mut().for_each(|panel| panel.translation.y -= MM * wearer.floor);
    garment::garment(name, &spec, wearer.body)
}
