//! Options of `Garment.make` and `Garment.fit`.

use std::path::PathBuf;

use pyo3::prelude::*;
use toile::input::check_known;
use toile::pipeline::{GARMENT_OBJ, Overrides, REPORT_JSON};
use toile::report::Bands;

use crate::arguments::Given;
use crate::errors;
use crate::library::{self, GivenBody, GivenFabric};
use crate::result::Result as Outcome;

/// A spacing in metres.
pub(crate) fn spacing(py: Python<'_>, mm: Option<f64>) -> PyResult<Option<f64>> {
    if let Some(mm) = mm.filter(|mm| !(*mm > 0.0 && mm.is_finite())) {
        return Err(errors::input(py, format!("spacing: {mm} is no positive number of millimetres, such as 10")));
    }
    Ok(mm.map(|mm| 1e-3 * mm))
}

/// An earlier result, from memory or in a folder.
pub(crate) struct Start(Given<Outcome>);

impl<'a, 'py> FromPyObject<'a, 'py> for Start {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        Given::of(&value, "start: a toile.Result, or the folder of one,").map(Self)
    }
}

/// The same, ready for another thread.
pub(crate) enum Earlier {
    Folder(PathBuf),
    Files { name: PathBuf, surface: Vec<u8>, report: Vec<u8> },
}

impl Start {
    pub(crate) fn earlier(self, py: Python<'_>) -> PyResult<Earlier> {
        match self.0 {
            Given::Named(folder) => {
                let folder = PathBuf::from(folder.text());
                let why = || format!("start: {} is no folder of results; give a Result or a folder", folder.display());
                if folder.is_dir() { Ok(Earlier::Folder(folder)) } else { Err(errors::input(py, why())) }
            }
            Given::Object(result) => {
                let result = result.get();
                let file = |name| result.file(name).unwrap_or_default();
                let (surface, report) = (file(GARMENT_OBJ), file(REPORT_JSON));
                Ok(Earlier::Files { name: result.title().into(), surface, report })
            }
        }
    }
}

/// Options of `make` and `fit` that replace what the garment file says.
pub(crate) fn overrides(
    py: Python<'_>,
    body: Option<GivenBody>,
    fabric: Option<GivenFabric>,
    mm: Option<f64>,
    body_units: Option<&str>,
) -> PyResult<Overrides> {
    let body_unit = body_units.map(library::unit).transpose();
    let body_unit = body_unit.map_err(|why| errors::input(py, format!("body_{why}")))?;
    if body_unit.is_some() && body.as_ref().is_some_and(GivenBody::is_object) {
        return Err(errors::input(py, "body_units: a Body has its unit already"));
    }
    let mut wanted = Overrides { spacing: spacing(py, mm)?, body_unit, ..Overrides::default() };
    if let Some(body) = body {
        body.choose(&mut wanted);
    }
    if let Some(fabric) = fabric {
        fabric.choose(&mut wanted);
    }
    Ok(wanted)
}

/// Limits of the bands of pressure, kPa.
pub(crate) fn bands(py: Python<'_>, limits: Option<(f64, f64)>) -> PyResult<Option<Bands>> {
    let Some((tight, too_tight)) = limits else { return Ok(None) };
    let why = "pressure_bands: two rising pressures in kPa are expected, such as (2.3, 4.7)";
    let wrong = || errors::input(py, format!("{why}, not {tight} and {too_tight}"));
    Bands::given(tight, too_tight).ok_or_else(wrong).map(Some)
}

/// A body by its name, which is to be in the library, or a file.
pub(crate) fn known_body(py: Python<'_>, name: &str) -> PyResult<()> {
    check_known(name, &toile::mannequin::library()).map_err(|why| errors::input(py, format!("body: {why}")))
}
