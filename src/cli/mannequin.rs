//! `mannequin`: the library of mannequins.

use std::path::Path;

use serde_json::json;

use super::args::MannequinCommand;
use super::console::Console;
use super::exit::{CliError, Exit};
use crate::io::body::mannequin_obj;
use crate::io::files::{check_writable, write_all};
use crate::mannequin::{MannequinSpec, library, load};

/// `toile mannequin …`
pub(super) fn mannequin(command: &MannequinCommand, console: &Console) -> Result<Exit, CliError> {
    match command {
        MannequinCommand::List => list(console)?,
        MannequinCommand::Build { name, output } => build(name, output, console)?,
    }
    Ok(Exit::Done)
}

fn list(console: &Console) -> Result<(), CliError> {
    console.results(&library(), || library().iter().map(|name| format!("{name}\n")).collect())
}

fn build(name: &str, output: &Path, console: &Console) -> Result<(), CliError> {
    // Also reads the file, so that a wrong name is told before a wrong output.
    MannequinSpec::load(name)?;
    let inputs = [Path::new(name)];
    check_writable(&[output.to_owned()], &inputs)?;
    let mannequin = load(name)?;
    write_all(&[(output.to_owned(), mannequin_obj(&mannequin).into_bytes())], &inputs)?;
    let (vertices, triangles) = (mannequin.mesh.vertices.len(), mannequin.mesh.triangles.len());
    let file = output.display().to_string();
    let value = json!({"mannequin": mannequin.name, "file": file, "vertices": vertices, "triangles": triangles});
    console.results(&value, || {
        format!("{}: {vertices} vertices, {triangles} triangles, written to {file}\n", mannequin.name)
    })
}
