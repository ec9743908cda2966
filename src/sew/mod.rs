//! Sewing: pieces placed round the body, seams drawn shut, stitched (F2–F11, F14).

mod close;
mod error;
mod lead_off;
pub mod place;
mod recover;
mod settle;
mod stance;
pub mod start;
mod stitch;
mod untangle;

pub use close::{SewOptions, Sewn, sew, stitch};
pub use error::SewError;
pub(crate) use lead_off::lead_off;
pub(crate) use recover::left_inside;
pub(crate) use settle::{CLEARANCE, NEAREST_LOOK};
pub use settle::{Calm, drape_reach, draping_world, join, settle, sewn_world};
pub use stance::{Stance, sewn_on};
pub use stitch::Stitching;
