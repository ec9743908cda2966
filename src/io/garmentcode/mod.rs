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

use crate::geometry::MM;
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
