//! `toile.Body` and `toile.Fabric`

use std::path::PathBuf;

use numpy::PyArray2;
use pyo3::prelude::*;
use toile::input::LengthUnit;
use toile::io::body::load_body;

use crate::errors;
use crate::result::rows;
use crate::work::with_signals;

/// Millimetres in a metre.
const MM: f64 = 1e3;

/// A mannequin, or a body of one's own: n vertices, m triangles.
#[pyclass(frozen, module = "toile")]
pub(crate) struct Body {
    name: String,
    units: Option<String>,
    body: toile::io::body::Body,
}

/// A fabric with every value.
#[pyclass(frozen, module = "toile")]
pub(crate) struct Fabric {
    name: String,
    fabric: toile::fabric::Fabric,
}

/// The unit of a symbol, such as `mm`.
pub(crate) fn unit(symbol: &str) -> Result<LengthUnit, String> {
    LengthUnit::from_symbol(symbol).ok_or_else(|| {
        let known: Vec<&str> = LengthUnit::ALL.iter().map(|unit| unit.symbol()).collect();
        format!("units: '{symbol}' is no unit; known are {}", known.join(", "))
    })
}

/// A body or a fabric, its library name or its file.
#[derive(FromPyObject)]
pub(crate) enum Named {
    Body(Py<Body>),
    Fabric(Py<Fabric>),
    Text(String),
    Path(PathBuf),
}

impl Named {
    /// The name or path, as `--body` and `--fabric` take it.
    pub(crate) fn name(self) -> String {
        match self {
            Self::Body(body) => body.get().name.clone(),
            Self::Fabric(fabric) => fabric.get().name.clone(),
            Self::Text(name) => name,
            Self::Path(path) => path.display().to_string(),
        }
    }

    /// The unit that a body was loaded in.
    pub(crate) fn unit(&self) -> Option<String> {
        match self {
            Self::Body(body) => body.get().units.clone(),
            Self::Fabric(_) | Self::Text(_) | Self::Path(_) => None,
        }
    }
}

#[pymethods]
impl Body {
    /// A mannequin by its library name, a file of sections (YAML) or a closed OBJ in ``units``.
    #[staticmethod]
    #[pyo3(signature = (name, units=None))]
    fn load(py: Python<'_>, name: Named, units: Option<String>) -> PyResult<Self> {
        let name = name.name();
        let unit = units.as_deref().map(self::unit).transpose().map_err(|why| errors::input(py, why))?;
        let wanted = name.clone();
        let body = with_signals(py, None, None, move |_| load_body(&wanted, unit))?;
        Ok(Self { body: body.map_err(|e| errors::input(py, e))?, name, units })
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
        self.body.notes.clone()
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
        let name = name.name();
        let fabric = toile::fabric::load(&name).map_err(|e| errors::input(py, e))?;
        Ok(Self { name, fabric })
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
