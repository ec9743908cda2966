//! GarmentCode's pattern specifications (JSON) as garment files.
//!
//! ```text
//! JSON ─▶ spec ─▶ drawing ─▶ pieces ─▶ edges ─▶ seams ─▶ GarmentFile
//!         checked  upright,   pairs,    named    mirrored ones once,
//!                  clockwise  places             long ones in one
//! ```
//!
//! Every edge of a panel is an edge of its piece with the same length; every stitch is in one seam. Only edges too
//! short to be meshed are left out, and stitches between two of them. What the format does not know (grain, fabric,
//! allowance) is filled in: the grain runs down the drawing, the cloth is a cotton poplin.

mod drawing;
mod edges;
mod error;
mod garment;
mod pieces;
mod role;
mod seams;
mod short;
mod spec;

pub use error::ImportError;

use crate::pattern::GarmentFile;
use spec::Specification;

/// Reads a specification as a garment file called `name`, to be worn by `body` if given.
///
/// Lengths are millimetres, rounded to thousandths or to as many decimals as keep every edge within 0.005 mm of its
/// length.
///
/// # Errors
/// [`ImportError`], naming panel, edge or stitch.
pub fn read(name: &str, text: &str, body: Option<&str>) -> Result<GarmentFile, ImportError> {
    garment::garment(name, &Specification::parse(text)?, body)
}
