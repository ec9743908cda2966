//! Fitting: the alterations of a garment that give it the fit that is wanted.
//!
//! [`fit`] drapes the garment, tries each knob (an alteration whose amount is free) once from there, and takes least
//! squares steps, with slopes that are corrected after each. The altered garment file is draped from nothing in the
//! end, and that drape decides.

mod draped;
mod figure;
mod knob;
mod own;
mod refusal;
mod seams;
mod search;
mod solve;
mod words;

use std::path::Path;

use serde::Serialize;

use crate::io::garment::Loaded;
use crate::pattern::{AlterationFile, WantsFile};
use crate::pipeline::{Overrides, PipelineError};

use search::KnobSearch;

/// The garment, its wants, and how they are looked for.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// The garment file.
    pub file: &'a Path,
    /// The same, read.
    pub loaded: &'a Loaded,
    /// Wants and knobs. `None`: those of the garment's own tests, or that no girth is tight.
    pub wants: Option<&'a WantsFile>,
    /// Spacing, fabric and body.
    pub overrides: &'a Overrides,
    /// Name of the new file, in messages.
    pub new: &'a str,
    /// Most drapes.
    pub drapes: usize,
}

/// Spacing when none is asked for, metres: that of a garment whose figures no longer change by more than they must be
/// kept to, at a quarter of the cost.
pub const SPACING: f64 = 0.020;

/// Least drapes: the garment, a knob, and the altered garment.
pub const LEAST_DRAPES: usize = 3;

/// Drapes that a fit with four knobs needs at most, as a rule: the garment, each knob, four steps, and two from nothing
/// in the end.
pub const DRAPES: usize = 12;

/// The result. Lengths are mm, pressures kPa.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Fitting {
    /// The garment's name.
    pub garment: String,
    /// The mannequin's name.
    pub mannequin: String,
    /// The fabric's name.
    pub fabric: String,
    /// Mesh spacing, mm.
    pub spacing: f64,
    /// Number of drapes.
    pub drapes: usize,
    /// The wants.
    pub wants: Vec<WantRow>,
    /// The knobs.
    pub knobs: Vec<KnobRow>,
    /// The changes in words. Empty where nothing is to be changed, or the wants cannot be had.
    pub changes: Vec<String>,
    /// The same as they stand in the new file.
    pub alter: Vec<String>,
    /// Why the wants cannot be had.
    pub refused: Vec<String>,
    /// Problems of the altered garment that the one before did not have.
    pub problems: Vec<String>,
    /// The new garment file.
    #[serde(skip)]
    pub new: Option<New>,
}

/// The new garment file.
#[derive(Clone, Debug, PartialEq)]
pub struct New {
    /// The alterations.
    pub alterations: Vec<AlterationFile>,
    /// The text.
    pub text: String,
    /// Whether that is the old text with the new lines.
    pub in_place: bool,
}

/// A want and its figures.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct WantRow {
    /// `ease at the bust`.
    pub want: String,
    /// `mm`, `kPa` or `%`.
    pub unit: &'static str,
    /// Least value that is wanted.
    pub from: Option<f64>,
    /// Largest value that is wanted.
    pub to: Option<f64>,
    /// The value before.
    pub before: f64,
    /// The value of the new garment, draped from nothing. Where the wants cannot be had, of the last try.
    pub after: f64,
    /// Whether it is what is wanted.
    pub ok: bool,
}

/// A knob and what it does.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct KnobRow {
    /// Its name.
    pub knob: String,
    /// Amount found, mm. Seams: positive taken in. Lengths: positive longer.
    pub amount: f64,
    /// Least amount, mm.
    pub from: f64,
    /// Largest amount, mm.
    pub to: f64,
    /// Whether the amount is one of these two.
    pub at_end: bool,
    /// For every want its change by 10 mm of the knob.
    pub effects: Vec<f64>,
}

/// Finds the alterations that give a garment the fit that is wanted. `progress` is told the work under way and the
/// share of it that is done.
///
/// # Errors
/// [`PipelineError`]: a garment, fabric or body that cannot be used, or a garment that cannot be made. That wants
/// cannot be had is no error: [`Fitting::refused`].
pub fn fit(asked: &Asked, progress: &mut dyn FnMut(&str, f64)) -> Result<Fitting, PipelineError> {
    KnobSearch::begin(asked, progress)?.finish(progress)
}
