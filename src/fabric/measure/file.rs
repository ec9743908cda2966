//! A file of readings: YAML, a table of readings, or a laboratory's sheet.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_yaml::Mapping;

use super::geometric::{Readings, TESTS};
use super::photo::Photo;
use super::{MeasureError, laboratory::Sheet};
use crate::fabric::columns::{Columns, above_zero, rows};
use crate::fabric::library::read;
use crate::input::yaml;

/// What is said of a table that is none.
const NO_TABLE: &str =
    "the first line must name the columns: repeat, recovery, stretch, bend; or parameter, warp, weft, unit";
/// Names of files that hold a table end so; all others are YAML.
const TABLES: [&str; 3] = ["csv", "tsv", "txt"];
/// Grey value below which a pixel is cloth, where the file gives none.
const THRESHOLD: u8 = 128;
/// Area of the paper's specimen, 460 × 400 mm, cm²: what a photograph shows of it is compared with itself only.
const IMAGED: f64 = 1840.0;

/// What a file of readings holds.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct File {
    pub(super) name: Option<String>,
    pub(super) description: Option<String>,
    pub(super) source: Option<String>,
    recovery: Option<Test>,
    stretch: Option<Test>,
    bend: Option<Test>,
    means: Option<Means>,
    pub(super) sheet: Option<PathBuf>,
    pub(super) curves: Curves,
    /// As a fabric file has them; a map that two values of one key are refused in.
    pub(super) values: Mapping,
}

/// One of the three tests.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Test {
    initial: Option<f64>,
    /// For the reader; ratios have none.
    #[serde(rename = "unit")]
    _unit: Option<String>,
    readings: Vec<f64>,
    photos: Option<Photos>,
    /// gf, stretch only.
    load: Option<f64>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Photos {
    flat: PathBuf,
    crumpled: Vec<PathBuf>,
    #[serde(default)]
    threshold: Option<u8>,
    #[serde(default)]
    cloth: Cloth,
    /// Area a whole picture shows, cm².
    #[serde(default)]
    imaged: Option<f64>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Cloth {
    #[default]
    Dark,
    Light,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Means {
    recovery: f64,
    stretch: f64,
    bend: f64,
}

/// Files of recorded curves.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Curves {
    pub(super) tensile: Directions,
    pub(super) shear: Directions,
    pub(super) bend: Directions,
}

/// One file per direction.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
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
pub(super) struct Source {
    pub(super) file: File,
    pub(super) geometric: Option<Geometric>,
    pub(super) sheets: Vec<Sheet>,
    /// Everything that was read.
    pub(super) inputs: Vec<PathBuf>,
    pub(super) notes: Vec<String>,
}

impl Source {
    pub(super) fn read(path: &Path) -> Result<Self, MeasureError> {
        let text = read(path)?;
        let name = path.display().to_string();
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let mut out = Self {
            file: File::default(),
            geometric: None,
            sheets: Vec::new(),
            inputs: vec![path.to_owned()],
            notes: Vec::new(),
        };
        let is_table = path.extension().is_some_and(|e| TABLES.iter().any(|t| e.eq_ignore_ascii_case(t)));
        if is_table && Sheet::is_one(&text) {
            out.sheets.push(Sheet::parse(&text, &name)?);
        } else if is_table {
            out.geometric = Some(Geometric::Tests(table(&text, &name)?));
        } else {
            let fault = |why: String| MeasureError::File { file: name.clone(), row: None, why };
            out.file = yaml(&text).map_err(fault)?;
            out.geometric = out.tests(&folder)?;
            if let Some(sheet) = out.file.sheet.clone() {
                let path = folder.join(&sheet);
                let text = read(&path)?;
                if !Sheet::is_one(&text) {
                    let why = "a sheet begins with the line `parameter, warp, weft, unit`".to_owned();
                    return Err(MeasureError::File { file: sheet.display().to_string(), row: Some(1), why });
                }
                out.sheets.push(Sheet::parse(&text, &sheet.display().to_string())?);
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

    fn readings(&mut self, k: usize, test: Test, folder: &Path) -> Result<Readings, MeasureError> {
        let fault = |why: &str| Err(MeasureError::Test { test: TESTS[k], why: why.to_owned() });
        if let Some(load) = test.load {
            if k != 1 {
                return fault("only stretch has a load");
            }
            if !(400.0..=800.0).contains(&load) {
                self.notes
                    .push(format!("stretch: pulled by {load} gf; the fifteen fabrics were pulled by 400 to 800 gf"));
            }
        }
        let Some(photos) = test.photos else {
            return Ok(Readings { initial: test.initial, repeats: test.readings });
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
        let mut areas = Vec::new();
        for file in std::iter::once(&photos.flat).chain(&photos.crumpled) {
            let path = folder.join(file);
            let photo = Photo::read(&path)?;
            let fault = |why: String| MeasureError::Photo { file: file.display().to_string(), why };
            let own = (photo.width, photo.height);
            let first = *size.get_or_insert(own);
            if own != first {
                let why = format!(
                    "{} × {} pixels, the first {} × {}; the camera must not move",
                    own.0, own.1, first.0, first.1
                );
                return Err(fault(why));
            }
            let share = photo.share(threshold, photos.cloth == Cloth::Light);
            if share <= 0.0 || share >= 1.0 {
                let found = if share <= 0.0 { "no pixel" } else { "every pixel" };
                let what =
                    format!("{found} is cloth at threshold {threshold}; set threshold, and cloth: dark or light");
                return Err(fault(what));
            }
            areas.push(imaged * share);
            self.inputs.push(path);
        }
        let repeats = areas.split_off(1);
        Ok(Readings { initial: areas.first().copied(), repeats })
    }
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
    let mut out = TESTS.map(|_| Readings { initial: None, repeats: Vec::new() });
    let mut labels: Vec<String> = Vec::new();
    for (row, line) in lines {
        let fields = columns.cut(line).map_err(|why| fault(row, why))?;
        let label = fields[0].to_lowercase();
        let is_initial = label == "initial";
        if !is_initial && label.parse::<u32>().is_err() {
            return Err(fault(
                row,
                format!("'{}' is no repeat; number these, and leave out what sums them up", fields[0]),
            ));
        }
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
            }
        }
    }
    Ok(out)
}
