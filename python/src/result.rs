//! `toile.Result`

use std::path::PathBuf;

use numpy::{IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use toile::io::files::write_all;
use toile::pipeline::{Arrays, REPORT_JSON, ResultFile};

use crate::errors;

/// A garment that was made.
pub(crate) struct Made {
    pub(crate) name: String,
    pub(crate) files: Vec<ResultFile>,
    pub(crate) arrays: Arrays,
    pub(crate) in_bounds: bool,
    pub(crate) notes: Vec<String>,
    /// Files that must not be written over.
    pub(crate) inputs: Vec<PathBuf>,
}

/// A garment as it was sewn, draped and laid flat: n vertices, m triangles. Every array is a copy.
#[pyclass(frozen, module = "toile")]
pub(crate) struct Result(Made);

impl Result {
    pub(crate) fn new(made: Made) -> Self {
        Self(made)
    }

    /// The garment's name.
    pub(crate) fn title(&self) -> &str {
        &self.0.name
    }

    /// The bytes of one of its files.
    pub(crate) fn file(&self, name: &str) -> Option<Vec<u8>> {
        self.0.files.iter().find(|file| file.0 == name).map(|file| file.1.clone())
    }
}

/// Rows of equal length as an array of two dimensions.
pub(crate) fn rows<'py, T: numpy::Element + Copy, const N: usize>(
    py: Python<'py>,
    rows: &[[T; N]],
) -> PyResult<Bound<'py, PyArray2<T>>> {
    rows.concat().into_pyarray(py).reshape([rows.len(), N])
}

/// Values at the three corners of triangles.
pub(crate) fn corners<'py>(py: Python<'py>, values: &[[[f64; 2]; 3]]) -> PyResult<Bound<'py, PyArray3<f64>>> {
    values.concat().concat().into_pyarray(py).reshape([values.len(), 3, 2])
}

/// A JSON text as Python's own values.
pub(crate) fn parsed<'py>(py: Python<'py>, text: &[u8]) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (text,))
}

/// A Python value as JSON, which is YAML.
pub(crate) fn json(py: Python<'_>, value: &Bound<'_, PyAny>) -> PyResult<String> {
    py.import("toile._json")?.call_method1("dumps", (value,))?.extract()
}

/// Writes files into a folder, whole or not at all.
pub(crate) fn save(py: Python<'_>, folder: &std::path::Path, files: &[ResultFile], inputs: &[PathBuf]) -> PyResult<()> {
    let files: Vec<_> = files.iter().map(|(name, bytes)| (folder.join(name), bytes.clone())).collect();
    let inputs: Vec<_> = inputs.iter().map(PathBuf::as_path).collect();
    py.detach(|| write_all(&files, &inputs)).map_err(|e| errors::write(py, &e))
}

#[pymethods]
impl Result {
    /// The garment's name.
    #[getter]
    fn name(&self) -> &str {
        &self.0.name
    }

    /// Shape (n, 3): positions, mm, y up. Particles that a seam joins are one vertex.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, &self.0.arrays.vertices)
    }

    /// Shape (m, 3): vertices of every triangle, counter-clockwise seen from the right side of the cloth.
    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        rows(py, &self.0.arrays.faces)
    }

    /// Shape (m, 3, 2): flat position (x, −y) at every corner of every triangle, mm.
    #[getter]
    fn uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        corners(py, &self.0.arrays.uv)
    }

    /// Names of the pieces.
    #[getter]
    fn pieces(&self) -> Vec<String> {
        self.0.arrays.pieces.clone()
    }

    /// Shape (m,): the piece of every triangle, an index into ``pieces``.
    #[getter]
    fn piece_of_face<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        self.0.arrays.piece_of_face.clone().into_pyarray(py)
    }

    /// Shape (m, 3, 2): strain of warp and of weft at every corner of every triangle, as fractions.
    #[getter]
    fn strain<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        corners(py, &self.0.arrays.strain)
    }

    /// Shape (n,): distance of every vertex from the body, mm.
    #[getter]
    fn ease<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.arrays.ease.clone().into_pyarray(py)
    }

    /// Shape (n,): pressure on the body, kPa.
    #[getter]
    fn pressure<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.arrays.pressure.clone().into_pyarray(py)
    }

    /// The figures, as in ``report.json``.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let report = self.0.files.iter().find(|file| file.0 == REPORT_JSON);
        report.map_or_else(|| Err(errors::input(py, "there is no report")), |(_, text)| parsed(py, text))
    }

    /// Whether it keeps its own bounds (exit code 0 of ``toile make``, otherwise 1).
    #[getter]
    fn in_bounds(&self) -> bool {
        self.0.in_bounds
    }

    /// What its author may not have meant so.
    #[getter]
    fn notes(&self) -> Vec<String> {
        errors::all_in_python(&self.0.notes)
    }

    /// Writes the files of ``toile make``, whole or not at all: the same bytes, but for times in the report.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        save(py, &folder, &self.0.files, &self.0.inputs)
    }

    fn __repr__(&self) -> String {
        let Arrays { vertices, faces, pieces, .. } = &self.0.arrays;
        let (n, m, p) = (vertices.len(), faces.len(), pieces.len());
        format!("<toile.Result '{}': {p} pieces, {n} vertices, {m} faces>", self.0.name)
    }
}
