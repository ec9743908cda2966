//! Figures of a run: the measuring, the file `report.json` and the table for the terminal.
//!
//! [`measure`] computes a [`Report`] from the garment and its positions after each stage. `serde_json` writes it with
//! keys that other programs rely on. [`summary`] says the verdict in a few lines, [`table`] prints every figure,
//! [`page`] shows them in a browser. Lengths inside are metres. A [`Report`] holds millimetres, square millimetres,
//! fractions and seconds, as the file does.

mod bands;
mod bounds;
mod bunched;
mod closures;
mod crossings;
mod errors;
mod fit;
mod fit_report;
mod form;
mod laps;
mod measure;
mod measured;
mod misworn;
mod openings;
mod page;
mod rest;
mod rim;
mod ring;
mod schema;
mod seen;
mod statistics;
mod strain;
mod stretched;
mod summary;
mod table;
mod tight;
mod worn;

pub use bands::{Band, Bands};
pub use bounds::{Verdict, verdicts, verdicts_by_test};
pub use crossings::{CrossingsSeen, look};
pub use fit::pressure;
pub use fit_report::{Finished, Fit, Girth, Pressure, WornLength};
pub use form::{Apart, FormReport, LengthChange};
pub use measure::measure;
pub use measured::Measured;
pub use openings::opening_names;
pub use page::{PageParts, page, page_parts};
pub use rest::{AtRest, Restless, restless};
pub use schema::{
    Bunched, ClosureReport, ContactReport, ContactSeconds, ContinuedFrom, Crossing, Drift, Fault, FaultKind, PieceEdge,
    PieceReport, PieceSizes, Quartet, Report, SeamReport, Spread, Stage, Stretched, Turned, Worn, WornBefore,
};
pub use strain::{extensions, thread_strains, vertex_strain};
pub use summary::{shortened, summary};
pub use table::{aligned, contact_lines, table};
