//! The stages in order, as the command line and the tests run them.
//!
//! ```text
//! garment file ─▶ Job ─────────────▶ Run ───────────────────▶ files in memory
//!                 garment, fabrics,  sew ─▶ drape ─▶ flatten   OBJ · SVG · PNG · report
//!                 body, mesh
//! ```
//!
//! A [`Job`] holds everything that is known before cloth moves. Making one finds every mistake of the input. A [`Run`]
//! takes it through the stages one by one and keeps the result of each, so that a failing stage leaves the state before
//! it. Nothing here writes a file: [`Run::results`] gives names and bytes.

mod across;
mod arrays;
mod caught;
mod cloth;
mod draft;
mod draft_error;
mod earlier;
mod error;
mod first_look;
mod fit;
mod form;
mod glimpse;
mod job;
mod judged;
mod levels;
mod live;
mod maps;
mod material;
mod obstacle;
mod one_place;
mod overrides;
mod pattern_picture;
mod problems;
mod result_file;
mod results;
mod run;
mod saved;
mod settling;
mod start_picture;
mod surface;
mod tight;
mod too_small;

pub use crate::io::result_names::*;
use crate::report::AtRest;
pub use crate::sew::SewError;
pub use arrays::Arrays;
pub use draft::{Drafted, DraftedEase, DraftedPiece, draft};
pub use draft_error::DraftError;
pub use earlier::{Earlier, EarlierFiles};
pub use error::PipelineError;
pub use form::{FormAsked, NewPattern};
pub use glimpse::{Glimpse, Reached, Watch};
pub use job::{Job, inputs, read, read_variant};
pub use judged::{Judged, judge};
pub use material::{Checked, check, check_text, check_variant, read_text};
pub use obstacle::{Across, Caught, TooSmall};
pub use overrides::{Given, Overrides};
pub use pattern_picture::pattern_picture;
pub use problems::{ResultProblem, problems};
pub use result_file::{ResultFile, json_text};
pub use results::{Color, PictureOptions};
pub use run::{Progress, Run};
pub use settling::WordShown;
pub use start_picture::{DoubtShown, OpeningShown, RimShown, StartPicture, StartShown, start_picture};
pub use surface::{
    CutReport, CutWhy, Cuts, DARTS, DartStop, Darts, Ease, EaseReport, EdgeReport, FailedReport, FlatCorners,
    FlatSurface, HalvingReport, Limit, PartReport, SurfaceOptions, SurfaceReport, Weld, flatten_faces, flatten_surface,
};

/// Bounds of rest of a draped garment.
pub const AT_REST: AtRest = AtRest { drift: 1e3 * crate::drape::DRIFT, residual: crate::drape::RESIDUAL };
