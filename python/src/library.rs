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

/// A mannequin, or a body of one's own.
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
    #[staticmethod]
    #[pyo3(signature = (name, units=None))]
    fn load(py: Python<'_>, name: Named, units: Option<String>) -> PyResult<Self> {
        let name = name.name();
        let unit = units.as_deref().map(self::unit).transpose().map_err(|why| errors::input(py, why))?;
        let wanted = name.clone();
        let body = with_signals(py, None, None, move |_| load_body(&wanted, unit))?;
        Ok(Self { body: body.map_err(|e| errors::input(py, e))?, name, units })
    }

    #[staticmethod]
    fn library() -> Vec<&'static str> {
        toile::mannequin::library()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.body.mannequin.name
    }

    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (mesh, frame) = (&self.body.mannequin.mesh, &self.body.mannequin.frame);
        let placed: Vec<[f64; 3]> = mesh.vertices.iter().map(|p| (frame.to_file(*p) * MM).into()).collect();
        rows(py, &placed)
    }

    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        rows(py, &self.body.mannequin.mesh.triangles)
    }

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
    #[staticmethod]
    fn load(py: Python<'_>, name: Named) -> PyResult<Self> {
        let name = name.name();
        let fabric = toile::fabric::load(&name).map_err(|e| errors::input(py, e))?;
        Ok(Self { name, fabric })
    }

    #[staticmethod]
    fn library() -> Vec<&'static str> {
        toile::fabric::library()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.fabric.name
    }

    #[getter]
    fn areal_density(&self) -> f64 {
        self.fabric.areal_density
    }

    #[getter]
    fn thickness(&self) -> f64 {
        MM * self.fabric.thickness
    }

    #[getter]
    fn bending(&self) -> (f64, f64) {
        (self.fabric.bend_warp, self.fabric.bend_weft)
    }

    #[getter]
    fn extension(&self) -> (f64, f64) {
        self.fabric.emt().into()
    }

    #[getter]
    fn shear(&self) -> f64 {
        self.fabric.shear
    }

    #[getter]
    fn friction(&self) -> f64 {
        self.fabric.friction
    }

    #[getter]
    fn source(&self) -> &str {
        &self.fabric.source
    }

    #[getter]
    fn assumed(&self) -> Vec<String> {
        self.fabric.defaults.clone()
    }

    fn __repr__(&self) -> String {
        format!("<toile.Fabric '{}'>", self.fabric.name)
    }
}
