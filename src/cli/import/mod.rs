//! `import`: patterns of other programs as garment files; a file per format.

mod drawing;
mod garmentcode;

use std::path::{Component, Path, PathBuf};

use serde::Serialize;

use super::args::{ImportCommand, SvgUnitArg, TargetArgs, UnitArg};
use super::console::Console;
use super::exit::{CliError, Exit};
use crate::input::bytes;
use crate::io::files::{check_writable, write_all};
use crate::io::garment::write;
use crate::mannequin;
use crate::pattern::GarmentFile;
use crate::pipeline::check;

/// `toile import …`
pub(super) fn import(command: &ImportCommand, console: &Console) -> Result<Exit, CliError> {
    match command {
        ImportCommand::Garmentcode(args) => garmentcode::import(args, console),
        ImportCommand::Svg { common, units } => drawing::svg(common, units.map(SvgUnitArg::metres), console),
        ImportCommand::Dxf { common, units } => drawing::dxf(common, units.map(UnitArg::metres), console),
    }
}

/// Patterns of more bytes than this are none.
const LARGEST: u64 = 64 << 20;

/// The text of a pattern.
fn text(path: &Path) -> Result<String, String> {
    let bytes = bytes(path, LARGEST).map_err(|e| e.to_string())?;
    String::from_utf8(bytes).map_err(|e| format!("it is not UTF-8 text (byte {})", e.utf8_error().valid_up_to()))
}

/// How a garment file written to `output` names a body that the user named from here: relative to the file, as far as
/// there is a way from the one to the other.
fn body(named: Option<&str>, output: &Path) -> Option<String> {
    let named = named?;
    if mannequin::library().contains(&named) {
        return Some(named.to_owned());
    }
    let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let way = relative(Path::new(named), folder).unwrap_or_else(|| named.into());
    Some(way.display().to_string())
}

/// The way to a file from a folder, both as named from here; `None` where there is none, as between drives.
fn relative(file: &Path, folder: &Path) -> Option<PathBuf> {
    let [file, folder] = [whole(file)?, whole(folder)?];
    let (own, from): (Vec<Component>, Vec<Component>) = (file.components().collect(), folder.components().collect());
    let shared = own.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let has_way = shared > 0 && !from[shared..].iter().any(|part| matches!(part, Component::Prefix(_)));
    has_way.then(|| from[shared..].iter().map(|_| Component::ParentDir).chain(own[shared..].iter().copied()).collect())
}

/// A path from the root on, without steps back.
fn whole(path: &Path) -> Option<PathBuf> {
    let mut whole = PathBuf::new();
    for part in std::path::absolute(path).ok()?.components() {
        if part == Component::ParentDir {
            whole.pop();
        } else {
            whole.push(part);
        }
    }
    Some(whole)
}

/// A pattern that was read.
struct Imported<'a> {
    source: &'a Path,
    target: &'a TargetArgs,
    file: &'a GarmentFile,
    /// What is wrong with what it was read from.
    complaints: Vec<String>,
}

/// What was made of it.
#[derive(Serialize)]
struct Summary {
    file: String,
    pieces: usize,
    seams: usize,
    /// Whether `toile check` accepts it as it is, and nothing is missing in it.
    ok: bool,
}

/// Writes the garment file and says what a check finds in it.
fn finish(imported: &Imported, console: &Console) -> Result<Exit, CliError> {
    let text = write(imported.file).map_err(|e| CliError::Argument(e.to_string()))?;
    let target = imported.target.output.clone();
    let shown = target.display().to_string();
    check_writable(std::slice::from_ref(&target), &[imported.source])?;
    if target.exists() && !imported.target.force {
        return Err(CliError::Argument(format!(
            "{shown} is there already, and what was written in it would be lost; choose another name with -o, or \
             --force to write over it"
        )));
    }
    write_all(&[(target.clone(), text.into_bytes())], &[imported.source])?;
    let checked = check(&target, None);
    match &checked {
        Ok(checked) => checked.loaded.warnings.iter().for_each(|w| console.note(&w.to_string())),
        Err(refused) => console.complain(&refused.to_string()),
    }
    imported.complaints.iter().for_each(|complaint| console.complain(complaint));
    let ok = checked.is_ok() && imported.complaints.is_empty();
    let (pieces, seams) = (imported.file.pieces.len(), imported.file.seams.len());
    let summary = Summary { file: shown, pieces, seams, ok };
    let counted = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let made = format!("{} and {}", counted(pieces, "piece"), counted(seams, "seam"));
    console.results(&summary, || format!("{made}, written to {}\n", summary.file))?;
    Ok(if summary.ok { Exit::Done } else { Exit::OutOfBounds })
}
