//! `report`: the page of a garment that was made before.

use std::fs;
use std::path::Path;

use super::arg_values::UnitArg;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::garment_args::ReportArgs;
use super::make::write;
use crate::io::body::load_body;
use crate::io::files::check_writable;
use crate::io::glb_write::surface_glb;
use crate::pipeline::{GARMENT_GLB, REPORT_HTML, REPORT_JSON};
use crate::report::{Report, page};

/// How binary glTF begins.
const GLB: &[u8] = b"glTF";

/// `toile report DIR`
pub(super) fn report(args: &ReportArgs, console: &Console) -> Result<Exit, CliError> {
    let target = args.folder.join(REPORT_HTML);
    let inputs = [args.folder.join(GARMENT_GLB), args.folder.join(REPORT_JSON)];
    check_writable(std::slice::from_ref(&target), &[])?;
    let (garment, figures) = (read(&inputs[0])?, read(&inputs[1])?);
    let wrong = |why: &dyn std::fmt::Display| {
        CliError::Argument(format!("{}: this is no report of a garment: {why}", inputs[1].display()))
    };
    let text = String::from_utf8(figures).map_err(|e| wrong(&e))?;
    let figures: Report = serde_json::from_str(&text).map_err(|e| wrong(&e))?;
    if !garment.starts_with(GLB) {
        return Err(CliError::Argument(format!("{}: this is no binary glTF file", inputs[0].display())));
    }
    let body = body(args, &figures, console)?;
    let page = page(&figures.garment, &text, &garment, body.as_deref());
    write(vec![(REPORT_HTML, page.into_bytes())], &args.folder, &[])?;
    let file = target.display().to_string();
    console.results(&serde_json::json!({ "file": file }), || format!("written to {file}\n"))?;
    Ok(Exit::Done)
}

fn read(file: &Path) -> Result<Vec<u8>, CliError> {
    fs::read(file).map_err(|e| {
        CliError::Argument(format!("cannot read {}: {e}; `toile make` writes it into its folder", file.display()))
    })
}

/// The body's surface where the garment is: the one given, or the mannequin that the report names.
fn body(args: &ReportArgs, figures: &Report, console: &Console) -> Result<Option<Vec<u8>>, CliError> {
    let name = args.body.as_deref().unwrap_or(&figures.mannequin);
    match load_body(name, args.body_units.map(UnitArg::unit)) {
        Ok(body) => {
            let mannequin = body.mannequin;
            Ok(Some(surface_glb(&mannequin.name, &mannequin.mesh, |p| mannequin.frame.to_file(p))))
        }
        // A body of one's own is known by its stem only.
        Err(_) if args.body.is_none() => {
            console.note(&format!(
                "no mannequin is called '{name}', so the page has no body; give it with --body FILE.obj"
            ));
            Ok(None)
        }
        Err(error) => Err(CliError::Argument(error.to_string())),
    }
}
