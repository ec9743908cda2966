//! `toile.flatten` and `toile.Flat`

use std::path::PathBuf;

use numpy::{AllowTypeChange, IntoPyArray, PyArray1, PyArray3, PyArrayLike2, PyArrayMethods};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use toile::flatten::{FlattenOptions, Mode};
use toile::geometry::Vec3;
use toile::io::obj_read::ObjFaces;
use toile::pipeline::{Cuts, Darts, FlatSurface, REPORT_JSON, SurfaceOptions, Weld, flatten_faces};

use crate::arguments::Count;
use crate::errors;
use crate::library::unit;
use crate::result::{NamedBytes, as_bytes, corners, corners_of, named, parsed, save, values_of};
use crate::work::with_signals;

/// A surface laid flat: m triangles.
#[pyclass(frozen, module = "toile")]
pub(crate) struct Flat {
    uv: Vec<[[f64; 2]; 3]>,
    piece_of_face: Vec<i32>,
    pieces: Vec<String>,
    notes: Vec<String>,
    files: Vec<NamedBytes>,
}

fn mode(name: &str) -> Result<Mode, String> {
    match name {
        "balanced" => Ok(Mode::Balanced),
        "isometric" => Ok(Mode::Isometric),
        "boundary" => Ok(Mode::Boundary),
        "woven" => Ok(Mode::Woven),
        "spring" => Ok(Mode::Spring),
        _ => Err(format!("mode: '{name}' is unknown; known are balanced, isometric, boundary, woven, spring")),
    }
}

/// An array of rows of three, whose NumPy kind is one of `kinds`: a cast would hide that others were meant.
fn triples<'py>(value: &Bound<'py, PyAny>, what: &str, [kinds, expected]: [&str; 2]) -> PyResult<Bound<'py, PyAny>> {
    let py = value.py();
    let wrong = |why: String| errors::input(py, format!("{what}: {why}"));
    let numpy = py.import("numpy")?;
    if numpy.getattr("ma")?.call_method1("is_masked", (value,))?.extract()? {
        return Err(wrong("some are masked; leave them out, or give them with filled()".into()));
    }
    let array = numpy.call_method1("asarray", (value,)).map_err(|e| wrong(e.value(py).to_string()))?;
    let shape: Vec<usize> = array.getattr("shape")?.extract()?;
    if shape.contains(&0) {
        return Err(wrong("there are none".into()));
    }
    if shape.len() != 2 || shape[1] != 3 {
        return Err(wrong(format!("the shape is to be (n, 3), not {}", array.getattr("shape")?)));
    }
    let dtype = array.getattr("dtype")?;
    let kind: String = dtype.getattr("kind")?.extract()?;
    if !kinds.contains(&kind) {
        return Err(wrong(format!("{expected} are expected, not {dtype}")));
    }
    // Whole numbers that our type does not hold would become others.
    let largest = array.call_method0("max")?;
    if kind == "u" && largest.gt(i64::MAX)? {
        return Err(wrong(format!("{largest} is too large")));
    }
    Ok(array)
}

/// The arrays as a surface of one group.
fn surface(
    vertices: &PyArrayLike2<'_, f64, AllowTypeChange>,
    faces: &PyArrayLike2<'_, i64, AllowTypeChange>,
    name: &str,
) -> Result<ObjFaces, String> {
    let (vertices, faces) = (vertices.as_array(), faces.as_array());
    let count = vertices.nrows();
    let index = |&v: &i64| u32::try_from(v).ok().filter(|&v| (v as usize) < count);
    let corner = |v: &i64| index(v).ok_or_else(|| format!("faces name the vertex {v}; there are {count}"));
    let triangle = |row: numpy::ndarray::ArrayView1<i64>| row.iter().map(corner).collect::<Result<Vec<u32>, _>>();
    if let Some(v) = vertices.rows().into_iter().position(|row| row.iter().any(|x| !(*x as f32).is_finite())) {
        return Err(format!("vertex {v} has a coordinate that is not finite"));
    }
    Ok(ObjFaces {
        vertices: vertices.rows().into_iter().map(|row| Vec3::new(row[0], row[1], row[2])).collect(),
        faces: faces.rows().into_iter().map(triangle).collect::<Result<_, _>>()?,
        texture: Vec::new(),
        texture_of_face: vec![Vec::new(); faces.nrows()],
        groups: vec![name.to_owned()],
        group_of_face: vec![0; faces.nrows()],
    })
}

/// Lays a surface flat, as the command ``toile flatten``.
///
/// Args:
///     vertices: Shape (n, 3): positions.
///     faces: Shape (m, 3): vertices of every triangle, counter-clockwise seen from outside. Messages, notes and the
///         report number vertices and faces as these arrays do, from 0; the command ``toile flatten`` does from 1.
///     mode: What to keep where not everything can be kept.
///     units: Unit of the positions; None guesses it from the size.
///     up: Direction that lies along the grain (y, or z where the surface runs along z).
///     cut: Cut the surface open where it is needed.
///     darts: Number of darts at most that are cut where the strain passes 10 %; into a round piece as many even ones.
///     weld: Join vertices within so many millimetres of each other, none with 0. By default those of different parts
///         within 0.01 mm are joined.
///     threads: Number of threads (all processors by default). Results do not depend on it.
///     name: Its name in the report.
///
/// Raises:
///     InputError: The surface cannot be laid flat as it is.
///     ComputationError: It could not be computed.
#[pyfunction]
#[pyo3(signature = (
    vertices, faces, mode="balanced", units="mm", up=None, cut=false, darts=Count(0), weld=None, threads=None,
    name="surface"
))]
#[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
pub(crate) fn flatten(
    py: Python<'_>,
    vertices: &Bound<'_, PyAny>,
    faces: &Bound<'_, PyAny>,
    mode: &str,
    units: Option<&str>,
    up: Option<[f64; 3]>,
    cut: bool,
    darts: Count,
    weld: Option<f64>,
    threads: Option<Count>,
    name: &str,
) -> PyResult<Flat> {
    let wrong = |why: String| errors::input(py, why);
    let darts = usize::try_from(darts.0).map_err(|_| wrong(format!("darts: none or more are cut, not {}", darts.0)))?;
    let up = up.map(Vec3::from);
    if up.is_some_and(|up| !up.norm().is_normal()) {
        return Err(wrong("up: a direction of three numbers is expected, such as (0, 1, 0)".into()));
    }
    if let Some(mm) = weld.filter(|mm| !(*mm >= 0.0 && mm.is_finite())) {
        return Err(wrong(format!("weld: {mm} is no distance in millimetres, such as 0.01")));
    }
    let options = SurfaceOptions {
        unit: units.map(unit).transpose().map_err(wrong)?,
        up: up.map(|up| up.normalize()),
        weld: weld.map_or_else(Weld::default, |mm| Weld::Within(mm / 1e3)),
        cuts: Cuts { auto: cut, ..Cuts::default() },
        darts: (darts > 0).then_some(Darts::Count(darts)),
        flatten: FlattenOptions { mode: self::mode(mode).map_err(wrong)?, ..FlattenOptions::default() },
        first_number: 0,
        ..SurfaceOptions::default()
    };
    let vertices = triples(vertices, "vertices", ["fiu", "numbers"])?.extract()?;
    let faces = triples(faces, "faces", ["iu", "whole numbers"])?.extract()?;
    let faces = surface(&vertices, &faces, name).map_err(wrong)?;
    let name = PathBuf::from(name);
    let flat = with_signals(py, threads, None, move |_| {
        let flat = flatten_faces(&name, faces, &options)?;
        let files = flat.results()?;
        Ok((flat, files))
    })?;
    let (flat, files) = flat.map_err(|e| errors::pipeline(py, &e, &[]))?;
    Ok(Flat::new(&flat, named(files)))
}

impl Flat {
    fn new(flat: &FlatSurface, files: Vec<NamedBytes>) -> Self {
        let mut out = Self {
            uv: Vec::new(),
            piece_of_face: Vec::new(),
            pieces: flat.report.pieces.iter().map(|piece| piece.name.clone()).collect(),
            notes: flat.notes.clone(),
            files,
        };
        for corners in flat.corners() {
            let known = corners.and_then(|c| Some((c.piece as i32, <[[f64; 2]; 3]>::try_from(c.at).ok()?)));
            let (piece, at) = known.unwrap_or((-1, [[f64::NAN; 2]; 3]));
            out.uv.push(at);
            out.piece_of_face.push(piece);
        }
        out
    }
}

#[pymethods]
impl Flat {
    /// Shape (m, 3, 2): flat position (x, −y) at every corner of every face that was given, mm.
    ///
    /// NaN for a face that was left out (doubled, without area), is split by a cut, or cannot be laid flat.
    #[getter]
    fn uv<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        corners(py, &self.uv)
    }

    /// Shape (m,): the piece of every face, an index into ``pieces``; −1 for a face without.
    #[getter]
    fn piece_of_face<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<i32>> {
        self.piece_of_face.clone().into_pyarray(py)
    }

    /// Names of the pieces.
    #[getter]
    fn pieces(&self) -> Vec<String> {
        self.pieces.clone()
    }

    /// What was done or guessed on the way.
    #[getter]
    fn notes(&self) -> Vec<String> {
        errors::all_in_python(&self.notes)
    }

    /// The figures, as in ``report.json`` of ``toile flatten``.
    #[getter]
    fn report<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let report = self.files.iter().find(|file| file.0 == REPORT_JSON);
        report.map_or_else(|| Err(errors::input(py, "there is no report")), |(_, text)| parsed(py, text))
    }

    /// Writes the files of ``toile flatten``, whole or not at all.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        save(py, &folder, &self.files, &[])
    }

    /// The state for `pickle`.
    #[getter]
    fn _state<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let Self { pieces, notes, files, .. } = self;
        (self.uv(py)?, self.piece_of_face(py), pieces, notes, as_bytes(py, files)).into_bound_py_any(py)
    }

    /// The flat surface that `pickle` has kept.
    #[staticmethod]
    fn _restored(
        uv: Bound<'_, PyAny>,
        piece_of_face: Bound<'_, PyAny>,
        pieces: Vec<String>,
        notes: Vec<String>,
        files: Vec<NamedBytes>,
    ) -> PyResult<Self> {
        let (uv, piece_of_face) = (corners_of(&uv)?, values_of(&piece_of_face)?.to_vec()?);
        Ok(Self { uv, piece_of_face, pieces, notes, files })
    }

    fn __repr__(&self) -> String {
        format!("<toile.Flat: {} pieces, {} faces>", self.pieces.len(), self.uv.len())
    }
}
