//! `toile.Garment`

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use toile::digitize::{garment_file, sewn};
use toile::io::body::floor_of;
use toile::io::garment::write;
use toile::io::garmentcode::{self, Wearer};
use toile::io::svg_read::{SvgOptions, read_svg};
use toile::pattern::GarmentFile;
use toile::pipeline::{Job, Overrides, PictureOptions, PipelineError, Run, check_text, problems, read_text};

use crate::result::{Made, Result as Outcome};
use crate::work::with_signals;
use crate::{errors, library};

/// A garment: its pieces, seams, fabrics and body, as a garment file says them.
#[pyclass(frozen, module = "toile")]
pub(crate) struct Garment {
    /// Its file, which need not exist: the name is the garment's, and files that it names are in its folder.
    file: PathBuf,
    text: String,
    /// What was said when it was imported.
    #[pyo3(get)]
    notes: Vec<String>,
}

/// The options of `make` as the pipeline takes them.
fn overrides(
    py: Python<'_>,
    body: Option<library::Named>,
    body_units: Option<&str>,
    fabric: Option<library::Named>,
    spacing: Option<f64>,
) -> PyResult<Overrides> {
    if let Some(mm) = spacing.filter(|mm| !(*mm > 0.0 && mm.is_finite())) {
        return Err(errors::input(py, format!("spacing: {mm} is no positive number of millimetres, such as 10")));
    }
    let units = body.as_ref().and_then(library::Named::unit).or(body_units.map(str::to_owned));
    let body_unit = units.map(|unit| library::unit(&unit)).transpose().map_err(|why| errors::input(py, why))?;
    Ok(Overrides {
        size: None,
        spacing: spacing.map(|mm| 1e-3 * mm),
        fabric: fabric.map(library::Named::name),
        body: body.map(library::Named::name),
        body_unit,
        bands: None,
    })
}

impl Garment {
    fn imported(py: Python<'_>, file: PathBuf, said: &GarmentFile, notes: Vec<String>) -> PyResult<Self> {
        let text = write(said).map_err(|e| errors::input(py, e))?;
        Ok(Self { file, text, notes })
    }
}

#[pymethods]
impl Garment {
    /// Reads a garment file (YAML). Its mistakes raise :class:`GarmentError`.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        toile::pipeline::read(&path).map_err(|e| errors::pipeline(py, &e, &[]))?;
        let text = std::fs::read_to_string(&path)?;
        Ok(Self { file: path, text, notes: Vec::new() })
    }

    /// A garment from what a garment file says, as nested dicts and lists.
    ///
    /// Files that it names, as fabrics and bodies, are looked for in ``folder``.
    #[staticmethod]
    #[pyo3(signature = (data, name="garment", folder=PathBuf::new()))]
    fn from_dict(py: Python<'_>, data: Bound<'_, PyDict>, name: &str, folder: PathBuf) -> PyResult<Self> {
        // JSON is YAML.
        let options = PyDict::new(py);
        options.set_item("ensure_ascii", false)?;
        options.set_item("indent", 1)?;
        let text: String = py.import("json")?.call_method("dumps", (data,), Some(&options))?.extract()?;
        let file = folder.join(format!("{name}.yaml"));
        read_text(&file, &text).map_err(|e| errors::pipeline(py, &e, &[]))?;
        Ok(Self { file, text, notes: Vec::new() })
    }

    /// A garment from GarmentCode's pattern specification (JSON), worn by ``body``.
    #[staticmethod]
    #[pyo3(signature = (path, body=None))]
    fn from_garmentcode(py: Python<'_>, path: PathBuf, body: Option<library::Named>) -> PyResult<Self> {
        let text = std::fs::read_to_string(&path)?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let name = stem.strip_suffix("_specification").unwrap_or(&stem);
        let body = body.map(library::Named::name);
        let floor = body.as_deref().map_or(Ok(0.0), |body| floor_of(body, None));
        let floor = floor.map_err(|e| errors::input(py, e))?;
        // As the garment is not written, its folder is the one that the caller is in.
        let said = garmentcode::read(name, &text, Wearer { body: body.as_deref(), floor });
        let said = said.map_err(|e| errors::input(py, format!("{}: {e}", path.display())))?;
        Self::imported(py, PathBuf::from(format!("{name}.yaml")), &said, Vec::new())
    }

    /// A garment from a drawing (SVG).
    ///
    /// Args:
    ///     seams: Sew the seams that are suggested; otherwise all edges are free.
    ///     units: Length of the drawing's unit, mm.
    ///     size: The size to read of a drawing in several.
    #[staticmethod]
    #[pyo3(signature = (path, seams=true, units=None, size=None))]
    fn from_svg(
        py: Python<'_>,
        path: PathBuf,
        seams: bool,
        units: Option<f64>,
        size: Option<String>,
    ) -> PyResult<Self> {
        let options = SvgOptions { unit: units.map(|mm| 1e-3 * mm), size };
        let drawing = read_svg(&path, &options);
        let drawing = drawing.map_err(|e| errors::input(py, format!("{}: {e}", path.display())))?;
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let made = garment_file(&drawing.title.clone().unwrap_or_else(|| stem.clone()), &drawing.pieces);
        let said = if seams { sewn(&made.file, &made.suggestions) } else { made.file.clone() };
        let mut notes = drawing.complaints();
        notes.extend(drawing.left_out.iter().chain(&drawing.notes).chain(&made.notes).cloned());
        Self::imported(py, path.with_file_name(format!("{stem}.yaml")), &said, notes)
    }

    /// The short name, which is that of the file.
    #[getter]
    fn name(&self) -> String {
        self.file.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }

    /// The text of the garment file.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// Finds everything that is wrong before cloth moves; mistakes raise :class:`GarmentError`.
    ///
    /// Args:
    ///     spacing: Distance of neighbouring particles that it will be made with, mm (10 by default).
    ///
    /// Returns:
    ///     What its author may not have meant so.
    #[pyo3(signature = (spacing=None))]
    fn check<'py>(&self, py: Python<'py>, spacing: Option<f64>) -> PyResult<Bound<'py, PyList>> {
        let Overrides { spacing, .. } = overrides(py, None, None, None, spacing)?;
        let (file, text) = (self.file.clone(), self.text.clone());
        let checked = with_signals(py, Some(1), None, move |_| {
            check_text(&file, &text, spacing).map(|checked| checked.loaded.warnings)
        })?;
        errors::diagnostics(py, &checked.map_err(|all| errors::refused(py, &all))?)
    }

    /// Sews, drapes and flattens the garment, as the command ``toile make``.
    ///
    /// Args:
    ///     body: Library name or file in place of the garment's own body.
    ///     fabric: Library name or file in place of its main fabric.
    ///     spacing: Distance of neighbouring particles, mm (10 by default).
    ///     threads: Number of threads (all processors by default). Results do not depend on it.
    ///     progress: Called with the stage and the share of it that is done, from 0 to 1. What it raises ends the work.
    ///     body_units: Unit of the body's OBJ file.
    ///
    /// Raises:
    ///     GarmentError: The garment file has mistakes.
    ///     InputError: The body, the fabric or the spacing is wrong.
    ///     ComputationError: It cannot be sewn, draped or flattened.
    #[pyo3(signature = (body=None, fabric=None, spacing=None, threads=None, progress=None, body_units=None))]
    #[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn make(
        &self,
        py: Python<'_>,
        body: Option<library::Named>,
        fabric: Option<library::Named>,
        spacing: Option<f64>,
        threads: Option<usize>,
        progress: Option<Py<PyAny>>,
        body_units: Option<&str>,
    ) -> PyResult<Outcome> {
        let overrides = overrides(py, body, body_units, fabric, spacing)?;
        let (file, text) = (self.file.clone(), self.text.clone());
        let made = with_signals(py, threads, progress.as_ref(), move |telling| {
            make(&file, &text, &overrides, &mut |stage, share| telling.tell(stage, share))
        })?;
        made.map(Outcome::new).map_err(|failed| errors::pipeline(py, &failed.error, &failed.files))
    }

    fn __repr__(&self) -> String {
        format!("<toile.Garment '{}'>", self.name())
    }
}

/// A run that ended early, with the files of the state that it reached.
struct Failed {
    error: Box<PipelineError>,
    files: Vec<toile::pipeline::ResultFile>,
}

impl From<PipelineError> for Failed {
    fn from(error: PipelineError) -> Self {
        Self { error: Box::new(error), files: Vec::new() }
    }
}

fn make(
    file: &Path,
    text: &str,
    overrides: &Overrides,
    tell: &mut dyn FnMut(&str, f64),
) -> std::result::Result<Made, Failed> {
    let job = Job::new(file, read_text(file, text)?, overrides)?;
    let mut run = Run::new(&job);
    if let Err(error) = run.flatten(&toile::flatten::Options::default(), tell) {
        let files = run.state(&PictureOptions::default()).unwrap_or_default();
        return Err(Failed { error: Box::new(error), files });
    }
    let report = run.report();
    let files = run.results(&report, &PictureOptions::default())?;
    let found = problems(&job, &report);
    Ok(Made {
        name: report.garment.clone(),
        files,
        arrays: run.arrays().unwrap_or_default(),
        in_bounds: !found.iter().any(|problem| problem.out_of_bounds),
        notes: job.notes.clone(),
        inputs: toile::pipeline::inputs(file, &job.garment, overrides),
    })
}
