//! From readings to a fabric file (L2–L6): the paper's three tests, photographs of the first, and the sheets and curves
//! of textile laboratories (KES, FAST).
//!
//! ```text
//! file ──▶ geometric ──▶ v, spread, v' (2), ω (8);  spline (3) where only means are known
//!     ├──▶ photo      areas of cloth in photographs
//!     ├──▶ laboratory a sheet's parameters
//!     ├──▶ cycle      recorded curves, with their hysteresis
//!     └──▶ values     values given in the file, and those they replace
//! ```

mod cycle;
mod error;
mod file;
mod geometric;
mod laboratory;
mod photo;
mod spline;
mod values;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

pub use error::MeasureError;
pub use geometric::{Measure, REPEATS, Readings, TESTS};
pub use photo::Photo;
pub use spline::NaturalSpline;

use super::library::read;
use super::resolve::{Context, from_sheet};
use super::sheet::{FabricSheet, LiuMeasures, Measurement};
use super::{Fabric, FabricError};
use crate::fabric::units::GF_PER_CM;
use crate::input::quoted;
use cycle::{CurveKind, Cycle};
use file::{Geometric, ReadMeasurement};
use laboratory::{DIRECTIONS, short};
use values::put;

pub(crate) use geometric::weights;

/// Range over which G is read, degrees, at whose ends 2HG and 2HG5 are read (KES-FB1).
const SHEAR_PLACES: [f64; 2] = [0.5, 5.0];
/// Range of curvatures over which B is read, 1/cm (KES-FB2).
const BEND_PLACES: [f64; 2] = [0.5, 1.5];
/// Curvature at which 2HB is read, 1/cm (KES-FB2).
const BEND_MIDDLE: f64 = 1.0;
/// Loads at which a recorded tensile curve is stored, gf/cm.
const LOADS: [f64; 9] = [2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 300.0, 400.0];

/// A fabric as measured.
#[derive(Clone, Debug)]
pub struct MeasuredFabric {
    /// Name, description, values and measures.
    pub sheet: FabricSheet,
    /// The fabric they make.
    pub fabric: Fabric,
    /// The three tests, if their readings were given.
    pub tests: Option<[Measure; 3]>,
    /// Notes for the user.
    pub notes: Vec<String>,
    /// Files that were read.
    pub inputs: Vec<PathBuf>,
}

/// Reads a file of readings. `name` is the fabric's where the file says none.
///
/// # Errors
/// [`MeasureError`] for files that cannot be read, too few or impossible readings, and values of no cloth.
pub fn measure(path: &Path, name: &str) -> Result<MeasuredFabric, MeasureError> {
    measured(ReadMeasurement::read(path)?, path, name)
}

/// As [`measure`], from the text of a file that need not exist: its name is the source that is said, and other files
/// are looked for in its folder.
///
/// # Errors
/// As [`measure`].
pub fn measure_text(text: &str, path: &Path, name: &str) -> Result<MeasuredFabric, MeasureError> {
    measured(ReadMeasurement::parse(text, path)?, path, name)
}

fn measured(source: ReadMeasurement, path: &Path, name: &str) -> Result<MeasuredFabric, MeasureError> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let said = source.file.source.clone().unwrap_or_else(|| format!("measured, {}", path.display()));
    let mut notes = source.notes.clone();
    let mut inputs = source.inputs.clone();
    let mut values: Vec<Measurement> = Vec::new();
    for sheet in &source.sheets {
        let (found, left_out) = sheet.values(&said)?;
        found.into_iter().for_each(|m| put(&mut values, m));
        notes.extend(left_out);
    }
    for m in curves(&source.file.curves, folder, &said, &mut inputs)? {
        put(&mut values, m);
    }
    let fault = |why| MeasureError::File { file: path.display().to_string(), row: None, why };
    let given = values::given(&source.file.values, folder, &mut inputs, fault)?;
    let own: Vec<String> = given.iter().map(|m| m.key.clone()).collect();
    for m in given {
        put(&mut values, Measurement { source: m.source.or_else(|| Some(said.clone())), ..m });
    }
    let (mut tests, mut liu) = (None, None);
    match &source.geometric {
        Some(Geometric::Tests(readings)) => {
            let [r, s, b] = readings;
            let of = |k: usize, r: &Readings| r.measure(k).map_err(|e| fault(e.to_string()));
            notes.extend(readings.iter().enumerate().flat_map(|(k, r)| r.doubts(k)));
            let made = [of(0, r)?, of(1, s)?, of(2, b)?];
            (tests, liu) = (Some(made), Some(geometric::from_tests(made)));
        }
        Some(Geometric::Means(means)) => {
            let (found, more) = geometric::from_means(*means).map_err(|e| fault(e.to_string()))?;
            notes.extend(more);
            liu = Some(found);
        }
        None => {}
    }
    if values.is_empty() && liu.is_none() {
        return Err(MeasureError::Empty { file: path.display().to_string() });
    }
    if liu.is_some() {
        // Measures have no source of their own.
        values.push(Measurement { key: "source".to_owned(), value: said, source: None, uncertainty: None });
    }
    let name = source.file.name.clone().unwrap_or_else(|| name.to_owned());
    let description = source.file.description.clone().unwrap_or_default();
    let sheet = FabricSheet { name, description, measurements: values, liu, note: None };
    // What is written must be readable again. A fabric without weight or bending is told here.
    let blame = |error: FabricError| {
        let key = error.culprit().1.filter(|key| !own.iter().any(|o| o == key));
        let row = key.and_then(|key| source.sheets.iter().find_map(|s| Some((s.file(), s.line_of(key)?))));
        match row {
            Some((file, row)) => MeasureError::File { file: file.to_owned(), row: Some(row), why: error.to_string() },
            None => fault(error.to_string()),
        }
    };
    let written = FabricSheet::parse(&fabric_yaml(&sheet), &sheet.name).map_err(blame)?;
    let context = Context { name: &sheet.name, folder: Path::new(""), garment: &[], given: None };
    let fabric = from_sheet(&written, &context).map_err(blame)?;
    Ok(MeasuredFabric { sheet, fabric, tests, notes, inputs })
}

/// Values read from recorded curves.
fn curves(
    files: &file::Curves,
    folder: &Path,
    source: &str,
    inputs: &mut Vec<PathBuf>,
) -> Result<Vec<Measurement>, MeasureError> {
    let mut out = Vec::new();
    let mut add = |key: String, value: String| {
        out.push(Measurement { key, value, source: Some(source.to_owned()), uncertainty: None });
    };
    let mut load = |file: &Option<PathBuf>, kind| -> Result<Option<Cycle>, MeasureError> {
        let Some(file) = file else { return Ok(None) };
        inputs.push(folder.join(file));
        Cycle::parse(&read(&folder.join(file))?, &file.display().to_string(), kind).map(Some)
    };
    for (direction, file) in DIRECTIONS.iter().zip([&files.tensile.warp, &files.tensile.weft]) {
        if let Some(cycle) = load(file, CurveKind::Tensile)? {
            let (curve, resilience) = cycle.tensile()?;
            let last = curve.points[curve.points.len() - 1].1 / GF_PER_CM;
            let loads = LOADS.into_iter().filter(|l| *l < 0.999 * last).chain([last]);
            let text: Vec<String> =
                loads.map(|l| format!("{}:{}", short(100.0 * curve.strain(l * GF_PER_CM)), short(l))).collect();
            add(format!("tensile.{direction}.curve"), text.join(" "));
            if let Some(rt) = resilience {
                add(format!("tensile.{direction}.RT"), format!("{} %", short(100.0 * rt)));
            }
        }
    }
    let mut shear = Vec::new();
    for file in [&files.shear.warp, &files.shear.weft] {
        if let Some(cycle) = load(file, CurveKind::Shear)? {
            shear.push(cycle.read(SHEAR_PLACES, SHEAR_PLACES)?);
        }
    }
    let mut bend = Vec::new();
    for (direction, file) in DIRECTIONS.iter().zip([&files.bend.warp, &files.bend.weft]) {
        if let Some(cycle) = load(file, CurveKind::Bending)? {
            let found = cycle.read(BEND_PLACES, [BEND_MIDDLE; 2])?;
            add(format!("bend.{direction}"), format!("{} gf.cm2/cm", short(found.slope)));
            bend.push(found);
        }
    }
    let mean = |list: Vec<f64>| (!list.is_empty()).then(|| list.iter().sum::<f64>() / list.len() as f64);
    if let Some(g) = mean(shear.iter().map(|s| s.slope).collect()) {
        add("shear.G".to_owned(), format!("{} gf/cm.deg", short(g)));
    }
    for (k, key) in ["shear.two_HG", "shear.two_HG5"].into_iter().enumerate() {
        if let Some(width) = mean(shear.iter().filter_map(|s| Some(s.widths?[k])).collect()) {
            add(key.to_owned(), format!("{} gf/cm", short(width)));
        }
    }
    if let Some(width) = mean(bend.iter().filter_map(|b| Some(b.widths?[0])).collect()) {
        add("bend.two_HB".to_owned(), format!("{} gf.cm/cm", short(width)));
    }
    Ok(out)
}

/// The text of a fabric file.
pub fn fabric_yaml(sheet: &FabricSheet) -> String {
    let mut out = format!("name: {}\ndescription: {}\n", quoted(&sheet.name), quoted(&sheet.description));
    for m in &sheet.measurements {
        // A dotted key reads the same as nested ones.
        let _ = write!(out, "{}: {{value: {}", m.key, quoted(&m.value));
        for (name, text) in [("source", &m.source), ("uncertainty", &m.uncertainty)] {
            if let Some(text) = text {
                let _ = write!(out, ", {name}: {}", quoted(text));
            }
        }
        out.push_str("}\n");
    }
    if let Some(liu) = &sheet.liu {
        out.push_str(
            "# Recovery, stretch, bend after Liu, Wang & Luo 2015; means as ratios, weights by (8) in percent.\n",
        );
        out.push_str(&liu_yaml(liu));
    }
    out
}

fn liu_yaml(liu: &LiuMeasures) -> String {
    let list = |v: [f64; 3], digits: usize| v.map(|x| format!("{x:.digits$}")).join(", ");
    let mut out = format!("liu:\n  means: [{}]\n", list(liu.means, 6));
    if let Some(spread) = liu.spread {
        let _ = writeln!(out, "  spread: [{}]", list(spread, 6));
    }
    let _ = write!(out, "  normalised: [{}]\n  weights: [{}]\n", list(liu.normalised, 6), list(liu.weights, 4));
    out
}
