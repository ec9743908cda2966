//! `mannequin`: the library of mannequins.

use std::path::Path;

use serde_json::{Value, json};

use super::console::Console;
use super::exit::{CliError, Exit};
use super::library_args::MannequinCommand;
use crate::io::body::{Body, load_body_of, mannequin_obj};
use crate::io::files::{check_writable, write_all};
use crate::mannequin::{MannequinSpec, Measures, library};
use crate::pipeline::PipelineError;
use crate::report::aligned;

/// `toile mannequin …`
pub(super) fn mannequin(command: &MannequinCommand, console: &Console) -> Result<Exit, CliError> {
    match command {
        MannequinCommand::List => list(console)?,
        MannequinCommand::Show { name } => show(name, console)?,
        MannequinCommand::Build { name, measures, output } => build(name, measures.as_deref(), output, console)?,
    }
    Ok(Exit::Done)
}

fn list(console: &Console) -> Result<(), CliError> {
    console.results(&library(), || library().iter().map(|name| format!("{name}\n")).collect())
}

/// The sections from above to below, arms and legs last, as a tape would take them.
fn show(name: &str, console: &Console) -> Result<(), CliError> {
    let spec = MannequinSpec::load(name)?;
    let torso = spec.torso.iter().rev().map(|r| ("torso", &r.name, "height", r.y, r.girth));
    let leg = spec.leg.rows.iter().map(|r| ("leg", &r.name, "height", r.y, r.girth));
    let arm = spec.arm.rows.iter().map(|r| ("arm", &r.name, "from_shoulder", r.at, r.girth));
    let sections: Vec<_> = torso.chain(leg).chain(arm).collect();
    let values: Vec<Value> = sections
        .iter()
        .map(|(part, name, along, at, girth)| json!({"part": part, "name": name, *along: at, "girth": girth}))
        .collect();
    console.results(&json!({"name": spec.name, "unit": "mm", "sections": values}), || {
        let mut rows = vec![["part", "section", "at mm", "girth mm"].map(String::from).to_vec()];
        rows.extend(sections.iter().map(|(part, name, along, at, girth)| {
            let from = if *along == "height" { "from the floor" } else { "from the shoulder" };
            vec![(*part).to_owned(), (*name).clone(), format!("{} {from}", tenths(*at)), tenths(*girth)]
        }));
        format!("{}\n\n{}", spec.name, aligned(&rows))
    })
}

/// To a tenth of a millimetre, whole ones without a decimal.
fn tenths(mm: f64) -> String {
    ((10.0 * mm).round() / 10.0).to_string()
}

fn build(name: &str, measures: Option<&Path>, output: &Path, console: &Console) -> Result<(), CliError> {
    // Also reads the files, so that a wrong name is told before a wrong output.
    MannequinSpec::load(name)?;
    let given = measures.map_or_else(|| Ok(Measures::default()), Measures::read)?;
    let inputs: Vec<&Path> = std::iter::once(Path::new(name)).chain(measures).collect();
    check_writable(&[output.to_owned()], &inputs)?;
    let Body { mannequin, notes } = load_body_of(name, None, &given).map_err(PipelineError::from)?;
    notes.iter().for_each(|note| console.note(note));
    write_all(&[(output.to_owned(), mannequin_obj(&mannequin).into_bytes())], &inputs)?;
    let (vertices, triangles) = (mannequin.mesh.vertices.len(), mannequin.mesh.triangles.len());
    let file = output.display().to_string();
    let value = json!({"mannequin": mannequin.name, "file": file, "vertices": vertices, "triangles": triangles});
    console.results(&value, || {
        format!("{}: {vertices} vertices, {triangles} triangles, written to {file}\n", mannequin.name)
    })
}
