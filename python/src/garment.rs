//! `toile.Garment`

use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use toile::digitize::{garment_file, sewn};
use toile::input::{stem, whole};
use toile::io::body::floor_of;
use toile::io::garment::{Loaded, Variant, change_text, write};
use toile::io::garmentcode::{self, Wearer};
use toile::io::svg_read::{SvgOptions, read_svg};
use toile::mannequin::Measures;
use toile::pattern::{GarmentFile, Located, Quantity, Spot, Unit};
use toile::pipeline::{
    EarlierFiles, Job, Overrides, PictureOptions, PipelineError, Run, check_text, problems, read_text,
};

use crate::arguments::{Count, wrong_kind};
use crate::fit::{self, Fit};
use crate::library::{GivenBody, GivenFabric};
use crate::options::{self, Earlier, Start, known_body, overrides};
use crate::result::{Made, Result as Outcome, json, named};
use crate::work::with_signals;
use crate::{errors, library};

/// A garment: its pieces, seams, fabrics and body, as a garment file says them.
#[pyclass(frozen, module = "toile")]
pub(crate) struct Garment {
    /// Its file, which need not exist: the name is the garment's, and files that it names are in its folder.
    file: PathBuf,
    text: String,
    /// Alterations that follow those of the text.
    alter: Vec<String>,
    /// What was said when it was imported.
    #[pyo3(get)]
    notes: Vec<String>,
}

impl Garment {
    fn imported(py: Python<'_>, file: PathBuf, said: &GarmentFile, notes: Vec<String>) -> PyResult<Self> {
        let text = write(said).map_err(|e| errors::input(py, e))?;
        Ok(Self { file: whole(&file), text, alter: Vec::new(), notes })
    }

    /// The name of the file, and what it says with all alterations.
    fn source(&self, py: Python<'_>) -> PyResult<(PathBuf, String)> {
        Ok((self.file.clone(), self.text(py)?))
    }
}

#[pymethods]
impl Garment {
    /// Reads a garment file (YAML). Its mistakes raise :class:`GarmentError`.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        toile::pipeline::read(&path).map_err(|e| errors::pipeline(py, &e, &[]))?;
        let text = std::fs::read_to_string(&path);
        let text = text.map_err(|e| errors::input(py, format!("{}: {e}", path.display())))?;
        Ok(Self { file: whole(&path), text, alter: Vec::new(), notes: Vec::new() })
    }

    /// A garment from what a garment file says, as nested dicts and lists.
    ///
    /// Files that it names, as fabrics and bodies, are looked for in ``folder``.
    #[staticmethod]
    #[pyo3(signature = (data, name="garment", folder=PathBuf::new()))]
    fn from_dict(py: Python<'_>, data: Bound<'_, PyDict>, name: &str, folder: PathBuf) -> PyResult<Self> {
        let text = json(py, data.as_any())?;
        let file = whole(&folder.join(format!("{name}.yaml")));
        read_text(&file, &text, Variant::default()).map_err(|e| errors::pipeline(py, &e, &[]))?;
        Ok(Self { file, text, alter: Vec::new(), notes: Vec::new() })
    }

    /// A garment from GarmentCode's pattern specification (JSON), worn by ``body``.
    #[staticmethod]
    #[pyo3(signature = (path, body=None))]
    fn from_garmentcode(py: Python<'_>, path: PathBuf, body: Option<GivenBody>) -> PyResult<Self> {
        let text = garmentcode::text_of(&path);
        let text = text.map_err(|why| errors::input(py, format!("{}: {why}", path.display())))?;
        let stem = stem(&path);
        let name = stem.strip_suffix("_specification").unwrap_or(&stem);
        let (body, measures) = body.map(GivenBody::parts).map_or((None, None), |(b, m)| (Some(b), Some(m)));
        body.as_deref().map_or(Ok(()), |body| known_body(py, body))?;
        let floor = body.as_deref().map_or(Ok(0.0), |body| floor_of(body, None));
        let floor = floor.map_err(|e| errors::input(py, e))?;
        // As the garment is not written, its folder is the one that the caller is in.
        let said = garmentcode::read(name, &text, Wearer { body: body.as_deref(), floor });
        let mut said = said.map_err(|e| errors::input(py, format!("{}: {e}", path.display())))?;
        for (name, mm) in measures.iter().flat_map(Measures::named) {
            let length = Quantity { number: mm, unit: Some(Unit::Millimetre) };
            said.body_measures.push((unplaced(name.to_owned()), unplaced(length)));
        }
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
        if let Some(mm) = units.filter(|mm| !(*mm > 0.0 && mm.is_finite())) {
            return Err(errors::input(py, format!("units: {mm} is no positive number of millimetres")));
        }
        let options = SvgOptions { unit: units.map(|mm| 1e-3 * mm), size };
        let drawing = read_svg(&path, &options);
        let drawing = drawing.map_err(|e| errors::input(py, format!("{}: {e}", path.display())))?;
        let stem = stem(&path);
        let made = garment_file(&drawing.title.clone().unwrap_or_else(|| stem.clone()), &drawing.pieces);
        let said = if seams { sewn(&made.file, &made.suggestions) } else { made.file.clone() };
        let mut notes = drawing.complaints();
        notes.extend(drawing.left_out.iter().chain(&drawing.notes).chain(&made.notes).cloned());
        Self::imported(py, path.with_file_name(format!("{stem}.yaml")), &said, errors::all_in_python(&notes))
    }

    /// The short name, which is that of the file.
    #[getter]
    fn name(&self) -> String {
        stem(&self.file)
    }

    /// The text of the garment file, with its alterations carried out if there are any of :meth:`alter`.
    #[getter]
    fn text(&self, py: Python<'_>) -> PyResult<String> {
        if self.alter.is_empty() {
            return Ok(self.text.clone());
        }
        let changed = change_text(&self.text, &self.file.display().to_string(), &self.alter);
        Ok(changed.map_err(|all| errors::refused(py, &all))?.text)
    }

    /// Names of the sizes that the garment file has.
    #[getter]
    fn sizes(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let loaded = read_text(&self.file, &self.text, Variant::default());
        let loaded = loaded.map_err(|e| errors::pipeline(py, &e, &[]))?;
        Ok(loaded.file.sizes.iter().map(|size| size.name.value.clone()).collect())
    }

    /// The garment with its pattern altered, as ``toile alter``; this one stays as it is.
    ///
    /// Args:
    ///     changes: Alterations as a garment file has them under ``alter``: a dict
    ///         (``{"lengthen": ["front", "back"], "at": 200, "by": 20}``), a list of them, or a text (YAML).
    ///
    /// Raises:
    ///     GarmentError: An alteration cannot be done, or seams no longer match.
    fn alter(&self, py: Python<'_>, changes: Bound<'_, PyAny>) -> PyResult<Self> {
        let text = match changes.extract::<String>() {
            Ok(text) => text,
            Err(_) if changes.is_none() => {
                return Err(wrong_kind(&changes, "changes: an alteration, a list of them or a text"));
            }
            Err(_) => json(py, &changes)?,
        };
        let alter = [self.alter.clone(), vec![text]].concat();
        let variant = Variant { size: None, alter: &alter };
        read_text(&self.file, &self.text, variant).map_err(|e| errors::pipeline(py, &e, &[]))?;
        Ok(Self { file: self.file.clone(), text: self.text.clone(), alter, notes: self.notes.clone() })
    }

    /// Finds everything that is wrong before cloth moves; mistakes raise :class:`GarmentError`.
    ///
    /// Args:
    ///     spacing: Distance of neighbouring particles that it will be made with, mm (10 by default).
    ///     size: A size of the garment.
    ///
    /// Returns:
    ///     What its author may not have meant so.
    #[pyo3(signature = (spacing=None, size=None))]
    fn check<'py>(&self, py: Python<'py>, spacing: Option<f64>, size: Option<String>) -> PyResult<Bound<'py, PyList>> {
        let spacing = options::spacing(py, spacing)?;
        let (file, text, alter) = (self.file.clone(), self.text.clone(), self.alter.clone());
        let checked = with_signals(py, Some(Count(1)), None, move |_| {
            let variant = Variant { size: size.as_deref(), alter: &alter };
            check_text(&file, &text, variant, spacing).map(|checked| checked.loaded.warnings)
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
    ///     start: An earlier result to go on from, or its folder: of this garment, or of what it was before its pieces,
    ///         fabrics, body or spacing were changed. The cloth starts where that one hangs.
    ///     progress: Called with the stage and the share of it that is done, from 0 to 1. What it raises ends the work.
    ///     body_units: Unit of the body's OBJ file.
    ///     size: A size of the garment.
    ///     pressure_bands: Pressures in kPa from which cloth is tight, and above which it is too tight.
    ///     over: Garments that are worn over this one, from the skin outwards. All must be made for the same body,
    ///         unless ``body`` is given. A size holds for all of them. ``fabric`` does not say of which garment.
    ///
    /// Raises:
    ///     GarmentError: The garment file has mistakes.
    ///     InputError: The body, the fabric, the spacing or the earlier result is wrong.
    ///     ComputationError: It cannot be sewn, draped or flattened.
    #[pyo3(signature = (
        body=None, fabric=None, spacing=None, threads=None, start=None, progress=None, body_units=None, size=None,
        pressure_bands=None, over=Vec::new()
    ))]
    #[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn make(
        &self,
        py: Python<'_>,
        body: Option<GivenBody>,
        fabric: Option<GivenFabric>,
        spacing: Option<f64>,
        threads: Option<Count>,
        start: Option<Start>,
        progress: Option<Py<PyAny>>,
        body_units: Option<&str>,
        size: Option<String>,
        pressure_bands: Option<(f64, f64)>,
        over: Vec<PyRef<'_, Self>>,
    ) -> PyResult<Outcome> {
        let wanted = overrides(py, body, fabric, spacing, body_units)?;
        let bands = options::bands(py, pressure_bands)?;
        let wanted = Overrides { size, bands, ..wanted };
        let start = start.map(|start| start.earlier(py)).transpose()?;
        let worn = std::iter::once(self).chain(over.iter().map(|outer| &**outer)).map(Said::of).collect::<Vec<_>>();
        let made = with_signals(py, threads, progress.as_ref(), move |telling| {
            make(&worn, &wanted, start.as_ref(), &mut |stage, share| telling.tell(stage, share))
        })?;
        made.map(Outcome::new).map_err(|failed| errors::pipeline(py, &failed.error, &failed.files))
    }

    /// Finds the alterations that give the garment a fit, as ``toile fit``; this one stays as it is.
    ///
    /// Args:
    ///     wants: What is wanted, and alterations that may be made, as a file of wants says them: nested dicts, or a
    ///         file. By default the garment's own tests of ease, pressure and hem, or else that no girth is tight.
    ///     body: Library name or file in place of the garment's own body.
    ///     fabric: Library name or file in place of its main fabric.
    ///     spacing: Distance of neighbouring particles, mm (20 by default).
    ///     threads: Number of threads (all processors by default). Results do not depend on it.
    ///     drapes: Most drapes (12 by default).
    ///     progress: Called with the work under way and the share of it that is done. What it raises ends the work.
    ///     body_units: Unit of the body's OBJ file.
    ///
    /// Raises:
    ///     GarmentError: The garment file or the wants have mistakes.
    ///     InputError: The body, the fabric or a number is wrong.
    ///     ComputationError: The garment cannot be made.
    #[pyo3(signature = (
        wants=None, body=None, fabric=None, spacing=None, threads=None, drapes=None, progress=None, body_units=None
    ))]
    #[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn fit(
        &self,
        py: Python<'_>,
        wants: Option<Bound<'_, PyAny>>,
        body: Option<GivenBody>,
        fabric: Option<GivenFabric>,
        spacing: Option<f64>,
        threads: Option<Count>,
        drapes: Option<Count>,
        progress: Option<Py<PyAny>>,
        body_units: Option<&str>,
    ) -> PyResult<Fit> {
        let wanted = overrides(py, body, fabric, spacing, body_units)?;
        let drapes = fit::drapes(py, drapes)?;
        let (file, old) = self.source(py)?;
        let found = fit::find(py, (file.clone(), old.clone()), wants, wanted, drapes, threads, progress.as_ref())?;
        let text = found.new.as_ref().map(|new| new.text.clone()).or_else(|| found.refused.is_empty().then_some(old));
        let altered = text.map(|text| Self { file, text, alter: Vec::new(), notes: self.notes.clone() });
        Fit::new(py, altered.map(|garment| Py::new(py, garment)).transpose()?, &found)
    }

    /// Writes the garment file (YAML), with its alterations carried out, whole or not at all.
    ///
    /// Args:
    ///     path: The file. Bodies and fabrics that the garment names by files must be found from its folder, too.
    ///
    /// Raises:
    ///     InputError: A file that the garment names is not found from there.
    ///     WriteError: The file cannot be written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let (file, text) = self.source(py)?;
        let loaded = read_text(&file, &text, Variant::default()).map_err(|e| errors::pipeline(py, &e, &[]))?;
        let (old, target) = (file.parent().unwrap_or(Path::new("")), whole(&path));
        let new = target.parent().unwrap_or(Path::new(""));
        for named in toile::pipeline::inputs(&file, &loaded.garment, &Overrides::default()).iter().skip(1) {
            let Ok(name) = named.strip_prefix(old) else { continue };
            let same = |other: PathBuf| other.canonicalize().ok().zip(named.canonicalize().ok());
            if same(new.join(name)).is_none_or(|(one, other)| one != other) {
                let (name, folder) = (name.display(), old.display());
                let why = format!("{}: the garment names {name}, which is in {folder}: save it there", path.display());
                return Err(errors::input(py, why));
            }
        }
        library::write(py, &path, text)
    }

    /// The state for `pickle`.
    #[getter]
    fn _state(&self) -> (PathBuf, String, Vec<String>, Vec<String>) {
        (self.file.clone(), self.text.clone(), self.alter.clone(), self.notes.clone())
    }

    /// The garment that `pickle` has kept.
    #[staticmethod]
    fn _restored(file: PathBuf, text: String, alter: Vec<String>, notes: Vec<String>) -> Self {
        Self { file, text, alter, notes }
    }

    fn __repr__(&self) -> String {
        format!("<toile.Garment '{}'>", self.name())
    }
}

/// A statement that stands in no file.
fn unplaced<T>(value: T) -> Located<T> {
    Located::new(value, Spot::default())
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

/// A garment for another thread.
struct Said {
    file: PathBuf,
    text: String,
    alter: Vec<String>,
}

impl Said {
    fn of(garment: &Garment) -> Self {
        Self { file: garment.file.clone(), text: garment.text.clone(), alter: garment.alter.clone() }
    }

    fn read(&self, size: Option<&str>) -> std::result::Result<Loaded, PipelineError> {
        read_text(&self.file, &self.text, Variant { size, alter: &self.alter })
    }
}

/// Makes garments that are worn over one another, from the skin outwards.
fn make(
    worn: &[Said],
    overrides: &Overrides,
    start: Option<&Earlier>,
    tell: &mut dyn FnMut(&str, f64),
) -> std::result::Result<Made, Failed> {
    let (mut read, mut inputs) = (Vec::new(), Vec::new());
    for said in worn {
        let loaded = said.read(overrides.size.as_deref())?;
        inputs.extend(toile::pipeline::inputs(&said.file, &loaded.garment, overrides));
        read.push((said.file.clone(), loaded));
    }
    let job = Job::dressed(read, overrides)?;
    let mut run = match start {
        None => Run::new(&job),
        Some(Earlier::Folder(folder)) => Run::continued(&job, folder)?,
        Some(Earlier::Files { name, surface, report }) => {
            Run::continued_from(&job, &EarlierFiles { name, surface, report })?
        }
    };
    if let Err(error) = run.flatten(&toile::flatten::FlattenOptions::default(), tell) {
        let files = run.state(&PictureOptions::default()).unwrap_or_default();
        return Err(Failed { error: Box::new(error), files });
    }
    let report = run.report();
    let files = named(run.results(&report, &PictureOptions::default())?);
    let found = problems(&job, &report);
    Ok(Made {
        name: report.garment.clone(),
        files,
        arrays: run.arrays().unwrap_or_default(),
        in_bounds: !found.iter().any(|problem| problem.out_of_bounds),
        notes: job.notes.clone(),
        inputs,
    })
}
