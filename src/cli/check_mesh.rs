//! `check --mesh`: does this surface pass through itself or a body?

use serde::Serialize;

use super::arg_values::UnitArg;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::garment_args::CheckArgs;
use crate::pipeline::judge;
use crate::report::{ContactReport, Crossing, contact_lines};

/// The findings, as JSON.
#[derive(Serialize)]
struct MeshFindings {
    file: String,
    triangles: usize,
    ok: bool,
    contact: ContactReport,
    crossings: Vec<Crossing>,
}

/// `toile check --mesh`
pub(super) fn check_mesh(mesh: &std::path::Path, args: &CheckArgs, console: &Console) -> Result<Exit, CliError> {
    let [unit, body_unit] = [args.units, args.body_units].map(|unit| unit.map(UnitArg::unit));
    let judged = judge(mesh, unit, args.body.as_deref().map(|name| (name, body_unit)))?;
    judged.notes.iter().for_each(|note| console.note(note));
    let contact = judged.seen.contact;
    let ok = contact == ContactReport::default();
    let found = MeshFindings {
        file: mesh.display().to_string(),
        triangles: judged.triangles,
        ok,
        contact,
        crossings: judged.seen.crossings,
    };
    console.results(&found, || {
        format!("{}: {} triangles\n{}", found.file, found.triangles, contact_lines(&found.contact, &found.crossings))
    })?;
    Ok(if ok { Exit::Done } else { Exit::OutOfBounds })
}
