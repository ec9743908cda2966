//! `fabric`: the library of fabrics.

use serde_json::json;

use super::args::FabricCommand;
use super::console::Console;
use super::exit::{CliError, Exit};
use crate::fabric::{FabricSheet, library, load, sheet};
use crate::report::aligned;

/// `toile fabric …`
pub(super) fn fabric(command: &FabricCommand, console: &Console) -> Result<Exit, CliError> {
    match command {
        FabricCommand::List => list(console)?,
        FabricCommand::Show { name } => show(name, console)?,
    }
    Ok(Exit::Done)
}

fn list(console: &Console) -> Result<(), CliError> {
    let sheets: Vec<FabricSheet> = library().into_iter().map(sheet).collect::<Result<_, _>>()?;
    let rows: Vec<_> = sheets.iter().map(|s| json!({"name": s.name, "description": s.description})).collect();
    console.results(&rows, || {
        let mut rows = vec![["fabric", "description"].map(String::from).to_vec()];
        rows.extend(sheets.iter().map(|s| vec![s.name.clone(), s.description.clone()]));
        aligned(&rows)
    })
}

fn show(name: &str, console: &Console) -> Result<(), CliError> {
    let sheet = sheet(name)?;
    // A sheet can be read whose values make no fabric; the user should know.
    let fabric = load(name)?;
    let values: Vec<_> = sheet
        .measurements
        .iter()
        .map(|m| json!({"key": m.key, "value": m.value, "uncertainty": m.uncertainty, "source": m.source}))
        .collect();
    let liu = sheet.liu.as_ref().map(|l| {
        json!({"sample": l.sample, "means": l.means, "normalised": l.normalised, "weights": l.weights,
               "recomputed_weights": l.recomputed_weights()})
    });
    let value = json!({
        "name": sheet.name,
        "description": sheet.description,
        "values": values,
        "assumed": fabric.defaults,
        "bending_length_mm": 1e3 * fabric.bending_length_mean(),
        "liu": liu,
    });
    console.results(&value, || text(&sheet, &fabric.defaults, fabric.bending_length_mean()))
}

fn text(sheet: &FabricSheet, assumed: &[String], bending_length: f64) -> String {
    let mut rows = vec![["value", "", "±", "source"].map(String::from).to_vec()];
    let or_nothing = |text: &Option<String>| text.clone().unwrap_or_default();
    rows.extend(
        sheet
            .measurements
            .iter()
            .map(|m| vec![m.key.clone(), m.value.clone(), or_nothing(&m.uncertainty), or_nothing(&m.source)]),
    );
    let mut out = format!("{}: {}\n\n{}", sheet.name, sheet.description, aligned(&rows));
    out.push_str(&format!("\n  bending length {:.1} mm\n", 1e3 * bending_length));
    if !assumed.is_empty() {
        out.push_str(&format!("  not measured but assumed: {}\n", assumed.join(", ")));
    }
    if let Some(liu) = &sheet.liu {
        let three = |v: [f64; 3], digits: usize| v.map(|x| format!("{x:.digits$}")).join(" / ");
        out.push_str(&format!(
            "  Liu, Wang & Luo 2015, sample {}: weights {} % (from v': {} %)\n",
            liu.sample,
            three(liu.weights, 3),
            three(liu.recomputed_weights(), 3)
        ));
    }
    out
}
