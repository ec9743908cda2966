//! `toile.Fit`: the alterations that give a garment the fit that is wanted.

use std::path::PathBuf;

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use toile::fitting::{Asked, DRAPES, Fitting, LEAST_DRAPES, SPACING, fit};
use toile::io::garment::{Variant, read_wants, wants_of};
use toile::pattern::Unit;
use toile::pipeline::{Overrides, PipelineError, json_text, read_text};

use crate::arguments::Count;
use crate::errors;
use crate::garment::Garment;
use crate::library::said;
use crate::result::parsed;
use crate::work::with_signals;

/// The alterations that were found to give a garment the fit that is wanted.
#[pyclass(frozen, module = "toile")]
pub(crate) struct Fit {
    garment: Option<Py<Garment>>,
    /// The name of the garment.
    of: String,
    changes: Vec<String>,
    alterations: Vec<String>,
    problems: Vec<String>,
    /// The figures as JSON.
    report: String,
}

/// Wants that are not read yet: a text, or a file. The garment's unit is that of their bare lengths.
enum Wants {
    Own,
    Text(String),
    File(PathBuf),
}

impl Wants {
    fn read(&self, unit: Unit) -> Result<Option<toile::pattern::WantsFile>, PipelineError> {
        Ok(match self {
            Self::Own => None,
            Self::Text(text) => Some(wants_of("wants", text, unit)?),
            Self::File(file) => Some(read_wants(file, unit)?),
        })
    }
}

/// Most drapes, from the caller's number.
pub(crate) fn drapes(py: Python<'_>, wanted: Option<Count>) -> PyResult<usize> {
    let Some(Count(wanted)) = wanted else { return Ok(DRAPES) };
    let enough = usize::try_from(wanted).ok().filter(|count| *count >= LEAST_DRAPES);
    enough.ok_or_else(|| errors::input(py, format!("drapes: at least {LEAST_DRAPES} are needed, not {wanted}")))
}

/// Looks for the alterations of a garment file's text.
pub(crate) fn find(
    py: Python<'_>,
    (file, text): (PathBuf, String),
    wants: Option<Bound<'_, PyAny>>,
    overrides: Overrides,
    drapes: usize,
    threads: Option<Count>,
    progress: Option<&Py<PyAny>>,
) -> PyResult<Fitting> {
    let wants = match wants.map(|wants| said(py, &wants)).transpose()? {
        None => Wants::Own,
        Some((_, Some(file))) => Wants::File(file),
        Some((text, None)) => Wants::Text(text),
    };
    let overrides = Overrides { spacing: overrides.spacing.or(Some(SPACING)), ..overrides };
    let found = with_signals(py, threads, progress, move |telling| {
        let loaded = read_text(&file, &text, Variant::default())?;
        let wants = wants.read(loaded.file.unit())?;
        let new = file.display().to_string();
        let (file, wants) = (file.as_path(), wants.as_ref());
        let asked = Asked { file, loaded: &loaded, wants, overrides: &overrides, new: &new, drapes };
        fit(&asked, &mut |stage, share| telling.tell(stage, share))
    })?;
    found.map_err(|e: PipelineError| errors::pipeline(py, &e, &[]))
}

impl Fit {
    pub(crate) fn new(py: Python<'_>, garment: Option<Py<Garment>>, found: &Fitting) -> PyResult<Self> {
        let report = json_text(found).map_err(|e| errors::pipeline(py, &e, &[]))?;
        let problems = found.refused.iter().chain(&found.problems);
        Ok(Self {
            garment,
            of: found.garment.clone(),
            changes: found.changes.clone(),
            alterations: found.alter.clone(),
            problems: problems.map(|problem| errors::in_python(problem)).collect(),
            report,
        })
    }
}

#[pymethods]
impl Fit {
    /// The garment with the alterations, or as it was if it fits already; None if the wants cannot be had.
    #[getter]
    fn garment(&self, py: Python<'_>) -> Option<Py<Garment>> {
        self.garment.as_ref().map(|garment| garment.clone_ref(py))
    }

    /// The changes in words.
    #[getter]
    fn changes(&self) -> Vec<String> {
        self.changes.clone()
    }

    /// The alterations as they stand in a garment file, a text each, as :meth:`Garment.alter` takes them.
    #[getter]
    fn alterations(&self) -> Vec<String> {
        self.alterations.clone()
    }

    /// Why the wants cannot be had, and problems that the altered garment has and the one before had not.
    #[getter]
    fn problems(&self) -> Vec<String> {
        self.problems.clone()
    }

    /// The figures, as of ``toile fit --json``: the wants before and after, the alterations and their amounts.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        parsed(py, self.report.as_bytes())
    }

    /// Whether the garment fits as it is wanted (exit code 0 of ``toile fit``, otherwise 1).
    #[getter]
    fn in_bounds(&self) -> bool {
        self.problems.is_empty()
    }

    /// The state for `pickle`.
    #[getter]
    fn _state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Self { of, changes, alterations, problems, report, .. } = self;
        (self.garment(py), of, changes, alterations, problems, report).into_bound_py_any(py)
    }

    /// The fit that `pickle` has kept.
    #[staticmethod]
    fn _restored(
        garment: Option<Py<Garment>>,
        of: String,
        changes: Vec<String>,
        alterations: Vec<String>,
        problems: Vec<String>,
        report: String,
    ) -> Self {
        Self { garment, of, changes, alterations, problems, report }
    }

    fn __repr__(&self) -> String {
        let fits = if self.in_bounds() { "fits" } else { "does not fit" };
        format!("<toile.Fit of '{}': {fits}, {} changes>", self.of, self.changes.len())
    }
}
