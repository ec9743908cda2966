//! The fabrics that are shipped, and where others come from.

use std::path::Path;

use super::error::FabricError;
use super::resolve::{Context, from_sheet};
use super::{Fabric, FabricSheet};
use crate::input::{InputError, bytes, nearest, shown};

/// Name and text of every shipped fabric: the fifteen of Liu, Wang & Luo 2015 in their order, then two knits.
const SHIPPED: [(&str, &str); 17] = [
    ("fine_cotton", include_str!("../../fabrics/fine_cotton.yaml")),
    ("denim", include_str!("../../fabrics/denim.yaml")),
    ("canvas", include_str!("../../fabrics/canvas.yaml")),
    ("linen", include_str!("../../fabrics/linen.yaml")),
    ("ramie", include_str!("../../fabrics/ramie.yaml")),
    ("silk_charmeuse", include_str!("../../fabrics/silk_charmeuse.yaml")),
    ("cotton_poplin", include_str!("../../fabrics/cotton_poplin.yaml")),
    ("chiffon", include_str!("../../fabrics/chiffon.yaml")),
    ("nylon_spandex_knit", include_str!("../../fabrics/nylon_spandex_knit.yaml")),
    ("polyester", include_str!("../../fabrics/polyester.yaml")),
    ("nylon_taffeta", include_str!("../../fabrics/nylon_taffeta.yaml")),
    ("gabardine", include_str!("../../fabrics/gabardine.yaml")),
    ("garment_leather", include_str!("../../fabrics/garment_leather.yaml")),
    ("wool_suiting", include_str!("../../fabrics/wool_suiting.yaml")),
    ("velvet", include_str!("../../fabrics/velvet.yaml")),
    ("jersey", include_str!("../../fabrics/jersey.yaml")),
    ("rib", include_str!("../../fabrics/rib.yaml")),
];

/// Number of characters of an unknown name that an error shows.
const NAME: usize = 120;

/// Names of the shipped fabrics.
pub fn library() -> Vec<&'static str> {
    SHIPPED.iter().map(|s| s.0).collect()
}

/// The values of a shipped fabric or of a `.yaml` file as written, with their sources.
///
/// # Errors
/// [`FabricError`] when there is no such fabric or its file cannot be read.
pub fn sheet(name_or_path: &str) -> Result<FabricSheet, FabricError> {
    sheet_in(name_or_path, Path::new(""), &[])
}

/// A shipped fabric or a `.yaml` file in physical units.
///
/// # Errors
/// [`FabricError`] when there is no such fabric or a value of it is wrong.
pub fn load(name_or_path: &str) -> Result<Fabric, FabricError> {
    load_in(name_or_path, Path::new(""), &[])
}

/// A fabric in physical units from the text of its file, which names no curves.
///
/// # Errors
/// As of [`load`].
pub fn load_text(text: &str) -> Result<Fabric, FabricError> {
    let sheet = FabricSheet::parse(text, "fabric.yaml")?;
    from_sheet(&sheet, &Context { name: &sheet.name, folder: Path::new(""), garment: &[], given: None })
}

/// As [`load`], paths being relative to `folder`. `others` are further names for the list in the error.
pub(super) fn load_in(name: &str, folder: &Path, others: &[&str]) -> Result<Fabric, FabricError> {
    let sheet = sheet_in(name, folder, others)?;
    // Curves that a fabric file names lie beside that file.
    let home = folder.join(name);
    let folder = if is_shipped(name) { folder } else { home.parent().unwrap_or(folder) };
    from_sheet(&sheet, &Context { name: &sheet.name, folder, garment: &[], given: None }).map_err(|error| {
        match error.culprit() {
            // A fabric's name does not say where it is written.
            (Some(_), _) if !is_shipped(name) => {
                FabricError::Syntax { file: home.display().to_string(), why: error.to_string() }
            }
            _ => error,
        }
    })
}

fn is_shipped(name: &str) -> bool {
    SHIPPED.iter().any(|s| s.0 == name)
}

fn sheet_in(name: &str, folder: &Path, others: &[&str]) -> Result<FabricSheet, FabricError> {
    if let Some((_, text)) = SHIPPED.iter().find(|s| s.0 == name) {
        return FabricSheet::parse(text, name);
    }
    let path = folder.join(name);
    if path.extension().is_none() {
        let known: Vec<&str> = others.iter().copied().chain(library()).collect();
        let longer = known.iter().copied().find(|k| !name.is_empty() && k.contains(name));
        // Part of a name, as `poplin`, is far from it by its letters.
        let nearest = longer.or_else(|| nearest(name, known.iter().copied())).map(str::to_owned);
        return Err(FabricError::Unknown { name: shown(name, NAME), nearest, known: known.join(", ") });
    }
    let file = path.display().to_string();
    let text = read(&path)?;
    FabricSheet::parse(&text, &file)
}

/// Largest file of a fabric, bytes. Such files are a page of text, and a curve of ten thousand points has a few hundred
/// kilobytes.
const LARGEST: u64 = 4 << 20;

/// The text of a fabric's or a curve's file, told to be too large before it is read.
pub(super) fn read(path: &Path) -> Result<String, FabricError> {
    let fault = |why: String| FabricError::Read { file: path.display().to_string(), why };
    let bytes = bytes(path, LARGEST).map_err(|e| match e {
        InputError::TooLarge { bytes, limit } => {
            fault(format!("{} MiB or more are no fabric; at most {} MiB are read", bytes >> 20, limit >> 20))
        }
        other => fault(other.to_string()),
    })?;
    let text = String::from_utf8(bytes).map_err(|_| fault("it is no UTF-8 text".to_owned()))?;
    // Spreadsheets begin UTF-8 with a byte order mark.
    match text.strip_prefix('\u{feff}') {
        Some(rest) => Ok(rest.to_owned()),
        None => Ok(text),
    }
}
