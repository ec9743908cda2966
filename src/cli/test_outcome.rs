//! The outcome of a garment's tests.

use std::path::PathBuf;

use serde::Serialize;

use super::exit::Exit;
use crate::report::{Restless, Verdict};

/// How a garment did.
#[derive(Serialize)]
pub(super) struct TestOutcome {
    /// Its file.
    pub(super) file: String,
    /// Its short name.
    pub(super) garment: String,
    /// Whether it was made, came to rest and keeps all its bounds.
    pub(super) ok: bool,
    /// Wall-clock time, s.
    pub(super) seconds: f64,
    /// One per bound; empty when it was not made.
    pub(super) bounds: Vec<Verdict>,
    /// The stages that did not come to rest: what was measured then is of a garment on its way.
    pub(super) restless: Vec<Restless>,
    /// Why it was not made.
    pub(super) error: Option<String>,
    #[serde(skip)]
    pub(super) exit: Exit,
    #[serde(skip)]
    pub(super) path: PathBuf,
    /// The verdicts of each of the file's tests.
    #[serde(skip)]
    pub(super) by_test: Vec<Vec<Verdict>>,
}
