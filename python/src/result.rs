//! `toile.Result`

use std::path::PathBuf;

use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray1};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use toile::io::files::write_all;
use toile::pipeline::{Arrays, REPORT_JSON, ResultFile};

use crate::errors;

/// The name and the bytes of a file.
pub(crate) type NamedBytes = (String, Vec<u8>);

/// Arrays that `pickle` has kept: positions, ease and pressure.
type OnVertices<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Bound<'py, PyAny>);
/// Faces, flat positions, names of pieces, the piece of each face, strain.
type OnFaces<'py> = (Bound<'py, PyAny>, Bound<'py, PyAny>, Vec<String>, Bound<'py, PyAny>, Bound<'py, PyAny>);

/// A garment that was made.
pub(crate) struct Made {
    pub(crate) name: String,
    pub(crate) files: Vec<NamedBytes>,
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

/// The rows of an array that [`rows`] has made.
fn rows_of<T: Element + Copy, const N: usize>(array: &Bound<'_, PyAny>) -> PyResult<Vec<[T; N]>> {
    Ok(values_of(array)?.as_slice()?.as_chunks().0.to_vec())
}

/// The values of an array that [`corners`] has made.
pub(crate) fn corners_of(array: &Bound<'_, PyAny>) -> PyResult<Vec<[[f64; 2]; 3]>> {
    Ok(values_of::<f64>(array)?.as_slice()?.as_chunks().0.as_chunks().0.to_vec())
}

/// All values of an array, one after the other.
pub(crate) fn values_of<'py, T: Element>(array: &Bound<'py, PyAny>) -> PyResult<PyReadonlyArray1<'py, T>> {
    array.call_method0("ravel")?.extract()
}

/// Files of the library with names of their own.
pub(crate) fn named(files: Vec<ResultFile>) -> Vec<NamedBytes> {
    files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect()
}

/// Files whose bytes can be pickled as such.
pub(crate) fn as_bytes<'py>(py: Python<'py>, files: &[NamedBytes]) -> Vec<(String, Bound<'py, PyBytes>)> {
    files.iter().map(|(name, bytes)| (name.clone(), PyBytes::new(py, bytes))).collect()
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
pub(crate) fn save(py: Python<'_>, folder: &std::path::Path, files: &[NamedBytes], inputs: &[PathBuf]) -> PyResult<()> {
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

    /// The state for `pickle`: the arrays are in the order of [`Arrays`].
    #[getter]
    fn _state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Made { name, files, in_bounds, notes, inputs, .. } = &self.0;
        let on_faces = (self.faces(py)?, self.uv(py)?, self.pieces(), self.piece_of_face(py), self.strain(py)?);
        let on_vertices = (self.vertices(py)?, self.ease(py), self.pressure(py));
        (name, as_bytes(py, files), on_vertices, on_faces, in_bounds, notes, inputs).into_bound_py_any(py)
    }

    /// The result that `pickle` has kept.
    #[staticmethod]
    fn _restored(
        name: String,
        files: Vec<NamedBytes>,
        on_vertices: OnVertices<'_>,
        on_faces: OnFaces<'_>,
        in_bounds: bool,
        notes: Vec<String>,
        inputs: Vec<PathBuf>,
    ) -> PyResult<Self> {
        let (vertices, ease, pressure) = on_vertices;
        let (faces, uv, pieces, piece_of_face, strain) = on_faces;
        let arrays = Arrays {
            vertices: rows_of(&vertices)?,
            faces: rows_of(&faces)?,
            uv: corners_of(&uv)?,
            pieces,
            piece_of_face: values_of(&piece_of_face)?.to_vec()?,
            strain: corners_of(&strain)?,
            ease: values_of(&ease)?.to_vec()?,
            pressure: values_of(&pressure)?.to_vec()?,
        };
        Ok(Self(Made { name, files, arrays, in_bounds, notes, inputs }))
    }

    fn __repr__(&self) -> String {
        let Arrays { vertices, faces, pieces, .. } = &self.0.arrays;
        let (n, m, p) = (vertices.len(), faces.len(), pieces.len());
        format!("<toile.Result '{}': {p} pieces, {n} vertices, {m} faces>", self.0.name)
    }
}
