//! `toile.Body` and `toile.Fabric`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use numpy::PyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use toile::fabric::measure::{fabric_yaml, measure, measure_text};
use toile::input::LengthUnit;
use toile::io::body::{load_body, load_body_of, mannequin_obj};
use toile::io::files::write_all;
use toile::mannequin::Measures;
use toile::pipeline::Overrides;

use crate::arguments::{Given, Named};
use crate::errors;
use crate::result::{json, rows};
use crate::work::with_signals;

/// Millimetres in a metre.
const MM: f64 = 1e3;

/// A mannequin, or a body of one's own: n vertices, m triangles.
#[pyclass(frozen, module = "toile")]
pub(crate) struct Body {
    /// As `--body` takes it.
    name: String,
    units: Option<String>,
    measures: Measures,
    body: Arc<toile::io::body::Body>,
}

/// A fabric with every value.
#[pyclass(frozen, module = "toile")]
pub(crate) struct Fabric {
    /// As `--fabric` takes it. A fabric that was measured here has none.
    name: Option<String>,
    /// The fabric file of one that was measured here.
    text: Option<String>,
    notes: Vec<String>,
    fabric: Arc<toile::fabric::Fabric>,
}

/// The unit of a symbol, such as `mm`.
pub(crate) fn unit(symbol: &str) -> Result<LengthUnit, String> {
    LengthUnit::from_symbol(symbol).ok_or_else(|| {
        let known: Vec<&str> = LengthUnit::ALL.iter().map(|unit| unit.symbol()).collect();
        format!("units: '{symbol}' is no unit; known are {}", known.join(", "))
    })
}

/// What is said of a body, in the words of `Body.load`.
fn in_words(message: &str) -> String {
    errors::in_python(&message.replace("--body-units", "units"))
}

/// A body, its library name or its file.
pub(crate) struct GivenBody(Given<Body>);

/// A fabric, its library name or its file.
pub(crate) struct GivenFabric(Given<Fabric>);

impl<'a, 'py> FromPyObject<'a, 'py> for GivenBody {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        Given::of(&value, "a toile.Body, or the name or the file of a body,").map(Self)
    }
}

impl<'a, 'py> FromPyObject<'a, 'py> for GivenFabric {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<Self> {
        Given::of(&value, "a toile.Fabric, or the name or the file of a fabric,").map(Self)
    }
}

impl GivenBody {
    /// The body in place of the garment's, with its name.
    pub(crate) fn choose(self, wanted: &mut Overrides) {
        match self.0 {
            Given::Named(named) => wanted.body = Some(named.name(&toile::mannequin::library())),
            Given::Object(body) => {
                wanted.body = Some(body.get().name.clone());
                wanted.given.body = Some(Arc::clone(&body.get().body));
            }
        }
    }

    /// The name of a body, and the measures that it was built with.
    pub(crate) fn parts(self) -> (String, Measures) {
        match self.0 {
            Given::Named(named) => (named.name(&toile::mannequin::library()), Measures::default()),
            Given::Object(body) => (body.get().name.clone(), body.get().measures.clone()),
        }
    }

    pub(crate) fn is_object(&self) -> bool {
        matches!(self.0, Given::Object(_))
    }
}

impl GivenFabric {
    /// The fabric in place of the garment's main one, with its name.
    pub(crate) fn choose(self, wanted: &mut Overrides) {
        match self.0 {
            Given::Named(named) => wanted.fabric = Some(named.name(&toile::fabric::library())),
            Given::Object(fabric) => wanted.given.fabric = Some(Arc::clone(&fabric.get().fabric)),
        }
    }
}

/// What a Python value says as YAML, or the text of the file that it names.
pub(crate) fn said(py: Python<'_>, value: &Bound<'_, PyAny>) -> PyResult<(String, Option<PathBuf>)> {
    if let Ok(path) = value.extract::<PathBuf>() {
        return Ok((String::new(), Some(path)));
    }
    Ok((json(py, value)?, None))
}

/// Writes a file whole or not at all.
pub(crate) fn write(py: Python<'_>, path: &Path, text: String) -> PyResult<()> {
    let files = [(path.to_owned(), text.into_bytes())];
    py.detach(|| write_all(&files, &[])).map_err(|e| errors::write(py, &e))
}

#[pymethods]
impl Body {
    /// A mannequin by its library name, a file of sections (YAML) or a closed OBJ in ``units``.
    #[staticmethod]
    #[pyo3(signature = (name, units=None))]
    fn load(py: Python<'_>, name: Named, units: Option<String>) -> PyResult<Self> {
        let name = name.name(&toile::mannequin::library());
        let unit = units.as_deref().map(self::unit).transpose().map_err(|why| errors::input(py, why))?;
        let wanted = name.clone();
        let body = with_signals(py, None, None, move |_| load_body(&wanted, unit))?;
        let body = Arc::new(body.map_err(|e| errors::input(py, in_words(&e.to_string())))?);
        Ok(Self { body, name, units, measures: Measures::default() })
    }

    /// A mannequin with the measures of a person, as ``toile mannequin build``.
    ///
    /// Args:
    ///     like: The mannequin that has what is not measured, by its library name or its file of sections (YAML).
    ///     measures: Names and lengths, mm or texts with a unit (``{"bust": 1040, "height": "170 cm"}``), or a file of
    ///         them: ours, FreeSewing's, or a body of GarmentCode.
    ///
    /// Raises:
    ///     InputError: A name is no measure, or the measures contradict one another or are far from the mannequin's.
    #[staticmethod]
    fn build(py: Python<'_>, like: Named, measures: Bound<'_, PyAny>) -> PyResult<Self> {
        let (name, (text, file)) = (like.name(&toile::mannequin::library()), said(py, &measures)?);
        let read = match &file {
            Some(file) => Measures::read(file),
            None => Measures::parse(&text, "measures"),
        };
        let measures = read.map_err(|e| errors::input(py, e))?;
        let (wanted, given) = (name.clone(), measures.clone());
        let body = with_signals(py, None, None, move |_| load_body_of(&wanted, None, &given))?;
        let body = Arc::new(body.map_err(|e| errors::input(py, e))?);
        Ok(Self { body, name, units: None, measures })
    }

    /// Writes its surface (OBJ): millimetres, y up, feet at y = 0.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        write(py, &path, mannequin_obj(&self.body.mannequin))
    }

    /// Name, unit and measures, as a job of a batch has them.
    #[getter]
    fn _job<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let job = PyDict::new(py);
        job.set_item("body", &self.name)?;
        if let Some(units) = &self.units {
            job.set_item("body_units", units)?;
        }
        if !self.measures.is_empty() {
            let measures = PyDict::new(py);
            self.measures.named().try_for_each(|(name, mm)| measures.set_item(name, mm))?;
            job.set_item("measures", measures)?;
        }
        Ok(job)
    }

    /// Names of the mannequins that toile brings.
    #[staticmethod]
    fn library() -> Vec<&'static str> {
        toile::mannequin::library()
    }

    /// The short name.
    #[getter]
    fn name(&self) -> &str {
        &self.body.mannequin.name
    }

    /// Shape (n, 3): positions, mm, y up, where the body's own file has it.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (mesh, frame) = (&self.body.mannequin.mesh, &self.body.mannequin.frame);
        let placed: Vec<[f64; 3]> = mesh.vertices.iter().map(|p| (frame.to_file(*p) * MM).into()).collect();
        rows(py, &placed)
    }

    /// Shape (m, 3): vertices of every triangle, counter-clockwise seen from outside.
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        rows(py, &self.body.mannequin.mesh.triangles)
    }

    /// What was guessed or done when it was read: its unit, its stance, crossings.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.body.notes.iter().map(|note| in_words(note)).collect()
    }

    fn __repr__(&self) -> String {
        format!("<toile.Body '{}'>", self.name())
    }
}

#[pymethods]
impl Fabric {
    /// A fabric by its library name or its file (YAML).
    #[staticmethod]
    fn load(py: Python<'_>, name: Named) -> PyResult<Self> {
        let name = name.name(&toile::fabric::library());
        let fabric = toile::fabric::load(&name).map_err(|e| errors::input(py, e))?;
        let notes = fabric.notes();
        Ok(Self { name: Some(name), text: None, notes, fabric: Arc::new(fabric) })
    }

    /// A fabric from readings, as ``toile fabric measure``.
    ///
    /// Args:
    ///     readings: A file of readings, a table or a laboratory's sheet; or what such a file (YAML) says as nested
    ///         dicts and lists.
    ///     name: The fabric's name where the readings say none, by default that of the file.
    ///     folder: Where files that a dict names are looked for.
    ///
    /// Raises:
    ///     InputError: Too few or impossible readings, or values of no cloth.
    #[staticmethod]
    #[pyo3(signature = (readings, name=None, folder=PathBuf::new()))]
    fn measure(py: Python<'_>, readings: Bound<'_, PyAny>, name: Option<String>, folder: PathBuf) -> PyResult<Self> {
        let (text, file) = said(py, &readings)?;
        let stem = |file: &PathBuf| file.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let name = name.or_else(|| file.as_ref().and_then(stem)).unwrap_or_else(|| "measured".to_owned());
        let measured = py.detach(|| match &file {
            Some(file) => measure(file, &name),
            None => measure_text(&text, &folder.join("readings"), &name),
        });
        let measured = measured.map_err(|e| errors::input(py, e))?;
        let notes = measured.notes.into_iter().chain(measured.fabric.notes()).collect();
        let text = Some(fabric_yaml(&measured.sheet));
        Ok(Self { name: None, text, notes, fabric: Arc::new(measured.fabric) })
    }

    /// Writes the fabric file (YAML) of a fabric that was measured here.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let Some(text) = &self.text else {
            let name = self.name.as_deref().unwrap_or_default();
            return Err(errors::input(py, format!("'{name}' was loaded, not measured: it has its file already")));
        };
        if path.extension().is_none_or(|e| e != "yaml") {
            return Err(errors::input(py, format!("{}: a fabric's file is named .yaml", path.display())));
        }
        write(py, &path, text.clone())
    }

    /// The name or file, or else the text, for `pickle`.
    #[getter]
    fn _state(&self) -> (Option<String>, Option<String>, Vec<String>) {
        (self.name.clone(), self.text.clone(), self.notes.clone())
    }

    /// The fabric that `pickle` has kept.
    #[staticmethod]
    fn _restored(py: Python<'_>, name: Option<String>, text: Option<String>, notes: Vec<String>) -> PyResult<Self> {
        let fabric = match (&name, &text) {
            (Some(name), _) => toile::fabric::load(name),
            (None, text) => toile::fabric::load_text(text.as_deref().unwrap_or_default()),
        };
        let fabric = fabric.map_err(|e| errors::input(py, e))?;
        Ok(Self { name, text, notes, fabric: Arc::new(fabric) })
    }

    /// Name or file, as a job of a batch has it.
    #[getter]
    fn _job<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Some(name) = &self.name else {
            let name = &self.fabric.name;
            let why = format!("the fabric '{name}' is in no file; save it, and give the job the file's name");
            return Err(errors::input(py, why));
        };
        let job = PyDict::new(py);
        job.set_item("fabric", name)?;
        Ok(job)
    }

    /// What its user should know: doubtful readings, values that hardly any cloth has.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// Names of the fabrics that toile brings.
    #[staticmethod]
    fn library() -> Vec<&'static str> {
        toile::fabric::library()
    }

    /// The short name.
    #[getter]
    fn name(&self) -> &str {
        &self.fabric.name
    }

    /// Mass per area, kg/m².
    #[getter]
    fn areal_density(&self) -> f64 {
        self.fabric.areal_density
    }

    /// Thickness, mm.
    #[getter]
    fn thickness(&self) -> f64 {
        MM * self.fabric.thickness
    }

    /// Bending rigidity along warp and weft, N·m (per metre of width).
    #[getter]
    fn bending(&self) -> (f64, f64) {
        (self.fabric.bend_warp, self.fabric.bend_weft)
    }

    /// Extension of warp and weft under 500 gf/cm (KES EMT), as fractions.
    #[getter]
    fn extension(&self) -> (f64, f64) {
        self.fabric.emt().into()
    }

    /// Shear stiffness, N/m per radian.
    #[getter]
    fn shear(&self) -> f64 {
        self.fabric.shear
    }

    /// Coulomb friction against the body and against cloth.
    #[getter]
    fn friction(&self) -> f64 {
        self.fabric.friction
    }

    /// Source of the values.
    #[getter]
    fn source(&self) -> &str {
        &self.fabric.source
    }

    /// Values that were not measured but assumed.
    #[getter]
    fn assumed(&self) -> Vec<String> {
        self.fabric.defaults.clone()
    }

    fn __repr__(&self) -> String {
        format!("<toile.Fabric '{}'>", self.fabric.name)
    }
}
