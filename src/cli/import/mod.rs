//! `import`: patterns of other programs as garment files; a file per format.

mod drawing;
mod garmentcode;

use std::path::Path;

use serde::Serialize;

use super::arg_values::UnitArg;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::import_args::{ImportCommand, SvgUnitArg, TargetArgs};
use crate::io::files::{check_writable, relative, write_all};
use crate::io::garment::{EncodeError, write, write_with_offers};
use crate::mannequin;
use crate::pattern::{GarmentFile, Located, SeamFile};
use crate::pipeline::{check, pattern_picture};

/// `toile import …`
pub(super) fn import(command: &ImportCommand, console: &Console) -> Result<Exit, CliError> {
    match command {
        ImportCommand::Garmentcode(args) => garmentcode::import(args, console),
        ImportCommand::Svg { common, units } => drawing::svg(common, units.map(SvgUnitArg::metres), console),
        ImportCommand::Dxf { common, units } => drawing::dxf(common, units.map(UnitArg::metres), console),
    }
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

/// A pattern that was read.
struct Imported<'a> {
    source: &'a Path,
    target: &'a TargetArgs,
    file: &'a GarmentFile,
    seams: KnownSeams<'a>,
    /// The faults of the input.
    complaints: Vec<String>,
}

/// The seams of a pattern that are known.
enum KnownSeams<'a> {
    /// Those of the file.
    Read,
    /// They were guessed, each with what is said of it: remarks of the file.
    Offered(&'a [(SeamFile, String)]),
    /// They were guessed and are the file's.
    Taken(&'a [(SeamFile, String)]),
}

impl Imported<'_> {
    fn text(&self) -> Result<String, EncodeError> {
        match self.seams {
            KnownSeams::Offered(seams) => write_with_offers(self.file, seams),
            KnownSeams::Read | KnownSeams::Taken(_) => write(self.file),
        }
    }

    /// The pieces with all seams that are known, each with a line that tells it.
    fn picture(&self) -> Result<Vec<u8>, CliError> {
        let lines: Vec<(SeamFile, String)> = match self.seams {
            KnownSeams::Read => self.file.seams.iter().map(|seam| (seam.clone(), String::new())).collect(),
            KnownSeams::Offered(seams) | KnownSeams::Taken(seams) => seams.to_vec(),
        };
        let side = |edges: &[Located<String>]| edges.iter().map(|e| e.value.clone()).collect::<Vec<_>>().join(" + ");
        let told = |(seam, said): (SeamFile, String)| {
            let line = format!("{}: {} to {}   {said}", seam.name.value, side(&seam.sew), side(&seam.to));
            (seam, line)
        };
        Ok(pattern_picture(self.file, &lines.into_iter().map(told).collect::<Vec<_>>())?)
    }
}

fn unwritable(error: EncodeError) -> CliError {
    CliError::Argument(error.to_string())
}

/// The result.
#[derive(Serialize)]
struct ImportSummary {
    file: String,
    /// The picture of the pieces and their seams.
    picture: String,
    pieces: usize,
    seams: usize,
    /// Whether `toile check` accepts it as it is, and nothing is missing in it.
    ok: bool,
}

/// Writes the garment file and its picture, and says what a check finds in it.
fn finish(imported: &Imported, console: &Console) -> Result<Exit, CliError> {
    let target = imported.target.output.clone();
    let picture = target.with_extension("png");
    let shown = target.display().to_string();
    check_writable(&[target.clone(), picture.clone()], &[imported.source])?;
    if let Some(there) = [&target, &picture].into_iter().find(|file| file.exists() && !imported.target.force) {
        return Err(CliError::Argument(format!(
            "{} is there already, and what was written in it would be lost; choose another name with -o, or --force to \
             write over it",
            there.display()
        )));
    }
    let text = imported.text().map_err(unwritable)?;
    let files = [(target.clone(), text.into_bytes()), (picture.clone(), imported.picture()?)];
    write_all(&files, &[imported.source])?;
    let checked = check(&target, None);
    match &checked {
        Ok(checked) => checked.loaded.warnings.iter().for_each(|w| console.note(&w.to_string())),
        Err(refused) => console.complain(&refused.to_string()),
    }
    imported.complaints.iter().for_each(|complaint| console.complain(complaint));
    let ok = checked.is_ok() && imported.complaints.is_empty();
    let (pieces, seams) = (imported.file.pieces.len(), imported.file.seams.len());
    let summary = ImportSummary { file: shown, picture: picture.display().to_string(), pieces, seams, ok };
    let counted = |count: usize, what: &str| format!("{count} {what}{}", if count == 1 { "" } else { "s" });
    let made = format!("{} and {}", counted(pieces, "piece"), counted(seams, "seam"));
    console.results(&summary, || format!("{made}, written to {} and drawn in {}\n", summary.file, summary.picture))?;
    Ok(if summary.ok { Exit::Done } else { Exit::OutOfBounds })
}
