//! A file of readings: YAML, a table of readings, or a laboratory's sheet.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_yaml::Mapping;

use super::geometric::{PHOTO_ERROR, Readings, TESTS};
use super::photo::{CLEAR, Photo};
use super::{MeasureError, laboratory::DataSheet};
use crate::fabric::columns::{Columns, above_zero, rows};
use crate::fabric::library::read;
use crate::input::yaml;

/// Message for a text that is no table.
const NO_TABLE: &str =
    "the first line must name the columns: repeat, recovery, stretch, bend; or parameter, warp, weft, unit";
/// Endings of the names of files that hold a table. All other files are YAML.
const TABLES: [&str; 3] = ["csv", "tsv", "txt"];
/// Grey value below which a pixel is cloth, where the file gives none.
const THRESHOLD: u8 = 128;
/// Largest relative change of the area when a well placed threshold is moved.
const DOUBT: f64 = 0.02;
/// Area of the paper's specimen, 460 × 400 mm, cm². It cancels in the measure, because photographs are compared with
/// each other only.
const IMAGED: f64 = 1840.0;

/// Contents of a file of readings.
#[derive(Debug, Default, Deserialize)]
#[serde(
    deny_unknown_fields,
    default,
    expecting = "a map of recovery, stretch, bend, means, table, sheet, curves or values"
)]
pub(super) struct MeasureFile {
    pub(super) name: Option<String>,
    pub(super) description: Option<String>,
    pub(super) source: Option<String>,
    recovery: Option<ExtensionTest>,
    stretch: Option<ExtensionTest>,
    bend: Option<ExtensionTest>,
    means: Option<Means>,
    /// File of a table with the readings of all three tests.
    table: Option<PathBuf>,
    pub(super) sheet: Option<PathBuf>,
    pub(super) curves: Curves,
    /// As a fabric file has them. A map that two values of one key are refused in.
    pub(super) values: Mapping,
}

/// One of the three tests.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a map of initial, unit, readings, photos or load")]
struct ExtensionTest {
    initial: Option<f64>,
    /// For the reader. Ratios have none.
    #[serde(rename = "unit")]
    _unit: Option<String>,
    readings: Vec<f64>,
    photos: Option<Photos>,
    /// Load of the stretch test, gf. Other tests have none.
    load: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a map of flat, crumpled, threshold, cloth or imaged")]
struct Photos {
    flat: PathBuf,
    crumpled: Vec<PathBuf>,
    #[serde(default)]
    threshold: Option<u8>,
    #[serde(default)]
    cloth: ClothTone,
    /// Area a whole picture shows, cm².
    #[serde(default)]
    imaged: Option<f64>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum ClothTone {
    #[default]
    Dark,
    Light,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a map of recovery, stretch and bend")]
struct Means {
    recovery: f64,
    stretch: f64,
    bend: f64,
}

/// Files of recorded curves.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a map of tensile, shear or bend")]
pub(super) struct Curves {
    pub(super) tensile: Directions,
    pub(super) shear: Directions,
    pub(super) bend: Directions,
}

/// One file per direction.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default, expecting = "a map of warp or weft")]
pub(super) struct Directions {
    pub(super) warp: Option<PathBuf>,
    pub(super) weft: Option<PathBuf>,
}

/// Readings of the three tests, or their means.
pub(super) enum Geometric {
    Tests([Readings; 3]),
    Means([f64; 3]),
}

/// A file that was read, with the sheet if it is nothing else.
pub(super) struct ReadMeasurement {
    pub(super) file: MeasureFile,
    pub(super) geometric: Option<Geometric>,
    pub(super) sheets: Vec<DataSheet>,
    /// Everything that was read.
    pub(super) inputs: Vec<PathBuf>,
    pub(super) notes: Vec<String>,
}

impl ReadMeasurement {
    pub(super) fn read(path: &Path) -> Result<Self, MeasureError> {
        let mut out = Self::parse(&read(path)?, path)?;
        out.inputs.insert(0, path.to_owned());
        Ok(out)
    }

    /// As [`Self::read`], from the text of a file that need not exist.
    pub(super) fn parse(text: &str, path: &Path) -> Result<Self, MeasureError> {
        let name = path.display().to_string();
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let mut out = Self {
            file: MeasureFile::default(),
            geometric: None,
            sheets: Vec::new(),
            inputs: Vec::new(),
            notes: Vec::new(),
        };
        let is_table = path.extension().is_some_and(|e| TABLES.iter().any(|t| e.eq_ignore_ascii_case(t)));
        if is_table && DataSheet::is_one(text) {
            out.sheets.push(DataSheet::parse(text, &name)?);
        } else if is_table {
            out.geometric = Some(out.tests_of(text, &name)?);
        } else {
            let fault = |why: String| MeasureError::File { file: name.clone(), row: None, why };
            out.file = yaml(text).map_err(|why| fault(plainly(&why)))?;
            out.geometric = out.tests(&folder).map_err(|error| match error {
                MeasureError::Test { .. } => fault(error.to_string()),
                other => other,
            })?;
            if let Some(sheet) = out.file.sheet.clone() {
                let path = folder.join(&sheet);
                let text = read(&path)?;
                if !DataSheet::is_one(&text) {
                    let why = "a sheet begins with the line `parameter, warp, weft, unit`".to_owned();
                    return Err(MeasureError::File { file: sheet.display().to_string(), row: Some(1), why });
                }
                out.sheets.push(DataSheet::parse(&text, &sheet.display().to_string())?);
                out.inputs.push(path);
            }
        }
        Ok(out)
    }

    /// The readings of all three tests, or the means.
    fn tests(&mut self, folder: &Path) -> Result<Option<Geometric>, MeasureError> {
        let tests = [self.file.recovery.take(), self.file.stretch.take(), self.file.bend.take()];
        let given: Vec<&str> = tests.iter().zip(TESTS).filter(|(t, _)| t.is_some()).map(|(_, n)| n).collect();
        let fault = |test, why: &str| Err(MeasureError::Test { test, why: why.to_owned() });
        if let Some(table) = self.file.table.take() {
            if !given.is_empty() || self.file.means.is_some() {
                return fault("table", "readings or means are given too; leave one out");
            }
            let path = folder.join(&table);
            let text = read(&path)?;
            self.inputs.push(path);
            return self.tests_of(&text, &table.display().to_string()).map(Some);
        }
        match (given.len(), self.file.means) {
            (0, None) => return Ok(None),
            (0, Some(m)) => return Ok(Some(Geometric::Means([m.recovery, m.stretch, m.bend]))),
            (_, Some(_)) => return fault("means", "readings are given too, from which they follow; leave one out"),
            (3, None) => {}
            (_, None) => {
                let missing = TESTS.into_iter().find(|t| !given.contains(t)).unwrap_or(TESTS[0]);
                return fault(missing, "not given; the weights (8) need all three of recovery, stretch and bend");
            }
        }
        let mut out = Vec::new();
        for (k, test) in tests.into_iter().flatten().enumerate() {
            out.push(self.readings(k, test, folder)?);
        }
        Ok(<[Readings; 3]>::try_from(out).ok().map(Geometric::Tests))
    }

    /// The readings in the `text` of a table.
    fn tests_of(&mut self, text: &str, name: &str) -> Result<Geometric, MeasureError> {
        let tests = table(text, name)?;
        self.notes.extend(tests[2].initial.map(unused_height));
        Ok(Geometric::Tests(tests))
    }

    fn readings(&mut self, k: usize, test: ExtensionTest, folder: &Path) -> Result<Readings, MeasureError> {
        let fault = |why: &str| Err(MeasureError::Test { test: TESTS[k], why: why.to_owned() });
        if let Some(load) = test.load {
            if k != 1 {
                return fault("only stretch has a load");
            }
            if !(load.is_finite() && load > 0.0) {
                return fault(&format!("a load of {load} gf; a number above 0 is expected"));
            }
            if !(400.0..=800.0).contains(&load) {
                self.notes
                    .push(format!("stretch: pulled by {load} gf; the fifteen fabrics were pulled by 400 to 800 gf"));
            }
        }
        if let Some(height) = test.initial.filter(|_| k == 2) {
            self.notes.push(unused_height(height));
        }
        let Some(photos) = test.photos else {
            return Ok(Readings { initial: test.initial, repeats: test.readings, rows: Vec::new() });
        };
        if k != 0 {
            return fault("only recovery is photographed");
        }
        if !test.readings.is_empty() || test.initial.is_some() {
            return fault("give photos or readings, not both");
        }
        self.photographed(&photos, folder)
    }

    /// Areas of cloth in photographs: imaged area × pixels of cloth over all pixels (L2).
    fn photographed(&mut self, photos: &Photos, folder: &Path) -> Result<Readings, MeasureError> {
        let threshold = photos.threshold.unwrap_or(THRESHOLD);
        let imaged = photos.imaged.unwrap_or(IMAGED);
        let mut size: Option<(usize, usize)> = None;
        let (mut shares, mut doubts) = (Vec::new(), Vec::new());
        for file in std::iter::once(&photos.flat).chain(&photos.crumpled) {
            let path = folder.join(file);
            let fault = |why: String| MeasureError::Photo { file: file.display().to_string(), why };
            if self.inputs.contains(&path) {
                return Err(fault("it stands there twice; every repeat has a photograph of its own".to_owned()));
            }
            let photo = Photo::read(&path)?;
            let own = (photo.width, photo.height);
            let first = *size.get_or_insert(own);
            if own != first {
                let why = format!(
                    "{} × {} pixels, the first {} × {}; the camera must not move",
                    own.0, own.1, first.0, first.1
                );
                return Err(fault(why));
            }
            let share = photo.share(threshold, photos.cloth == ClothTone::Light);
            if share <= 0.0 || share >= 1.0 {
                let found = if share <= 0.0 { "no pixel" } else { "every pixel" };
                let what =
                    format!("{found} is cloth at threshold {threshold}; set threshold, and cloth: dark or light");
                return Err(fault(what));
            }
            let flat = *shares.first().unwrap_or(&share);
            if share > flat * (1.0 + PHOTO_ERROR) {
                return Err(fault(format!(
                    "cloth covers {:.1} % of it and {:.1} % of the flat one's; crumpled cloth covers no more: is the \
                     cloth the light part, or the threshold another?",
                    100.0 * share,
                    100.0 * flat
                )));
            }
            shares.push(share);
            doubts.push((photo.doubt(threshold), file.display().to_string()));
            self.inputs.push(path);
        }
        self.notes.extend(seen(&shares, &doubts, threshold));
        let mut areas: Vec<f64> = shares.iter().map(|share| imaged * share).collect();
        let repeats = areas.split_off(1);
        Ok(Readings { initial: areas.first().copied(), repeats, rows: Vec::new() })
    }
}

/// Notes on photographs: the share that the cloth covers, and whether the threshold separates it from the table.
fn seen(shares: &[f64], doubts: &[(f64, String)], threshold: u8) -> Vec<String> {
    let [flat, crumpled @ ..] = shares else { return Vec::new() };
    let least = crumpled.iter().copied().fold(f64::INFINITY, f64::min);
    let most = crumpled.iter().copied().fold(0.0, f64::max);
    let [flat, least, most] = [*flat, least, most].map(|share| 100.0 * share);
    let mut out = vec![format!(
        "recovery: cloth covers {flat:.1} % of the flat one's photograph, {least:.1} to {most:.1} % of the others"
    )];
    let worst = doubts.iter().max_by(|a, b| a.0.total_cmp(&b.0));
    if let Some((doubt, file)) = worst.filter(|worst| worst.0 > DOUBT) {
        let count = doubts.iter().filter(|d| d.0 > DOUBT).count();
        out.push(format!(
            "recovery: the threshold {threshold} does not part cloth and table in {count} of {} photographs: {CLEAR} \
             more or less change the area by {:.0} % in {file}; light them evenly, or set threshold",
            doubts.len(),
            100.0 * doubt
        ));
    }
    out
}

/// A message of the YAML reader in the words of its user.
fn plainly(why: &str) -> String {
    why.replace("expected f64", "expected a number without unit")
        .replace("expected u8", "expected a whole number from 0 to 255")
}

/// Note on a fold height from which nothing follows.
fn unused_height(height: f64) -> String {
    format!("bend: initial, {height}, is not used; folds are measured by the highest of them")
}

/// A table `repeat, recovery, stretch, bend` with a row `initial` and a row per numbered repeat.
fn table(text: &str, file: &str) -> Result<[Readings; 3], MeasureError> {
    let fault = |row: usize, why: String| MeasureError::File { file: file.to_owned(), row: Some(row), why };
    let mut lines = rows(text);
    let (first, header) = lines.next().unwrap_or((1, ""));
    let columns = Columns::new(header);
    let mut places = [0; 3];
    for (place, name) in places.iter_mut().zip(TESTS) {
        let found = columns.find(name).map_err(|why| fault(first, why))?;
        let found = found.filter(|_| columns.names()[0] == "repeat");
        *place = found.ok_or_else(|| fault(first, NO_TABLE.to_owned()))?;
    }
    let mut out = TESTS.map(|_| Readings { initial: None, repeats: Vec::new(), rows: Vec::new() });
    let mut labels: Vec<String> = Vec::new();
    for (row, line) in lines {
        let fields = columns.cut(line).map_err(|why| fault(row, why))?;
        let is_initial = fields[0].eq_ignore_ascii_case("initial");
        let label = match fields[0].parse::<u32>() {
            // `01` is the first one, too.
            Ok(number) => number.to_string(),
            Err(_) if is_initial => "initial".to_owned(),
            Err(_) => {
                let why = format!("'{}' is no repeat; number these, and leave out what sums them up", fields[0]);
                return Err(fault(row, why));
            }
        };
        if labels.contains(&label) {
            return Err(fault(row, format!("repeat '{label}' stands there twice")));
        }
        labels.push(label);
        for ((test, place), name) in out.iter_mut().zip(places).zip(TESTS) {
            let text = fields.get(place).copied().unwrap_or_default();
            if text.is_empty() {
                continue;
            }
            let value = above_zero(text).map_err(|why| fault(row, format!("{name}: {why}")))?;
            if is_initial {
                test.initial = Some(value);
            } else {
                test.repeats.push(value);
                test.rows.push(row);
            }
        }
    }
    Ok(out)
}
