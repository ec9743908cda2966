//! `fabric`: the library of fabrics, fabric files from readings; `specimen` holds its tests.

use std::path::Path;

use serde_json::{Value, json};

use super::console::Console;
use super::exit::{CliError, Exit};
use super::library_args::FabricCommand;
use super::specimen;
use crate::fabric::measure::{MeasuredFabric, TESTS, fabric_yaml, measure};
use crate::fabric::{Fabric, FabricSheet, LiuMeasures, library, load, sheet};
use crate::io::files::{check_writable, write_all};
use crate::report::aligned;

/// `toile fabric …`
pub(super) fn fabric(command: &FabricCommand, console: &Console) -> Result<Exit, CliError> {
    match command {
        FabricCommand::List => list(console)?,
        FabricCommand::Show { name } => show(name, console)?,
        FabricCommand::Test { name, only, output } => return specimen::test(name, only, output.as_deref(), console),
        FabricCommand::Measure { readings, output } => from_readings(readings, output, console)?,
    }
    Ok(Exit::Done)
}

fn list(console: &Console) -> Result<(), CliError> {
    let mut values = Vec::new();
    let head = ["fabric", "g/m²", "bending mm", "ω_R %", "ω_S %", "ω_B %", "description"];
    let mut rows = vec![head.map(String::from).to_vec()];
    for name in library() {
        let (sheet, fabric) = (sheet(name)?, load(name)?);
        let (weight, length) = (1e3 * fabric.areal_density, 1e3 * fabric.bending_length_mean());
        let omega = sheet.liu.as_ref().map(|l| l.weights);
        values.push(json!({"name": sheet.name, "description": sheet.description, "weight_g_m2": weight,
                           "bending_length_mm": length, "weights": omega}));
        let mut row = vec![sheet.name, format!("{weight:.0}"), format!("{length:.1}")];
        row.extend(omega.map_or_else(|| vec!["–".to_owned(); 3], |w| w.map(|x| x.to_string()).to_vec()));
        row.push(sheet.description);
        rows.push(row);
    }
    console.results(&values, || aligned(&rows))
}

fn show(name: &str, console: &Console) -> Result<(), CliError> {
    let sheet = sheet(name)?;
    // A sheet can be read whose values make no fabric; the user should know.
    let fabric = load(name)?;
    console.results(&shown(&sheet, &fabric), || text(&sheet, &fabric))
}

fn shown(sheet: &FabricSheet, fabric: &Fabric) -> Value {
    let values: Vec<_> = sheet
        .measurements
        .iter()
        .map(|m| json!({"key": m.key, "value": m.value, "uncertainty": m.uncertainty, "source": m.source}))
        .collect();
    let liu = sheet.liu.as_ref().map(|l| {
        json!({"sample": l.sample, "means": l.means, "spread": l.spread, "normalised": l.normalised,
               "weights": l.weights, "recomputed_weights": l.recomputed_weights(),
               "fallback_bending_length_mm": 1e3 * l.fallback_bending_length()})
    });
    json!({
        "name": sheet.name,
        "description": sheet.description,
        "values": values,
        "assumed": fabric.defaults,
        "bending_length_mm": 1e3 * fabric.bending_length_mean(),
        "note": sheet.note,
        "notes": fabric.notes(),
        "liu": liu,
    })
}

fn text(sheet: &FabricSheet, fabric: &Fabric) -> String {
    let mut rows = vec![["value", "", "±", "source"].map(String::from).to_vec()];
    let or_nothing = |text: &Option<String>| text.clone().unwrap_or_default();
    let (said, values): (Vec<_>, Vec<_>) = sheet.measurements.iter().partition(|m| m.key == "source");
    rows.extend(
        values.iter().map(|m| vec![m.key.clone(), m.value.clone(), or_nothing(&m.uncertainty), or_nothing(&m.source)]),
    );
    let mut out = sheet.name.clone();
    if !sheet.description.is_empty() {
        out.push_str(&format!(": {}", sheet.description));
    }
    out.push('\n');
    // Where only the three tests were made there is nothing to head.
    if rows.len() > 1 {
        out.push_str(&format!("\n{}", aligned(&rows)));
    }
    // Of what has no source of its own.
    for all in said {
        out.push_str(&format!("\n  source: {}", all.value));
    }
    out.push_str(&format!("\n  bending length {:.1} mm\n", 1e3 * fabric.bending_length_mean()));
    if !fabric.defaults.is_empty() {
        out.push_str(&format!("  not measured but assumed: {}\n", fabric.defaults.join(", ")));
    }
    for note in fabric.notes() {
        out.push_str(&format!("  {note}\n"));
    }
    if let Some(note) = &sheet.note {
        out.push_str(&format!("  {note}\n"));
    }
    if let Some(liu) = &sheet.liu {
        out.push_str(&format!("\n{}", measures(liu)));
    }
    out
}

/// The three measures as a table.
fn measures(liu: &LiuMeasures) -> String {
    let of = liu.sample.map_or("measured as by".to_owned(), |n| format!("sample {n} of"));
    let mut rows = vec![["test", "v", "±", "v'", "ω %", "ω by (8)"].map(String::from).to_vec()];
    let recomputed = liu.recomputed_weights();
    for (k, test) in TESTS.iter().enumerate() {
        let spread = liu.spread.map_or("–".to_owned(), |s| format!("{:.4}", s[k]));
        rows.push(vec![
            (*test).to_owned(),
            format!("{:.4}", liu.means[k]),
            spread,
            format!("{:.4}", liu.normalised[k]),
            format!("{:.4}", liu.weights[k]),
            format!("{:.4}", recomputed[k]),
        ]);
    }
    let length = 1e3 * liu.fallback_bending_length();
    let fallback =
        format!("bending length by ω_B/ω_R alone {length:.1} mm: a last resort, for fabrics without physical values");
    format!("{of} Liu, Wang & Luo 2015:\n{}  {fallback}\n", aligned(&rows))
}

fn from_readings(readings: &Path, output: &Path, console: &Console) -> Result<(), CliError> {
    check_writable(&[output.to_owned()], &[readings])?;
    if !output.extension().is_some_and(|e| e == "yaml" || e == "yml") {
        let name = output.display();
        return Err(CliError::Argument(format!("-o {name}: a fabric's file is named {name}.yaml, or it is not found")));
    }
    let stem = output.file_stem().map_or("fabric".into(), |s| s.to_string_lossy());
    let MeasuredFabric { sheet, fabric, tests, notes, inputs } = measure(readings, &stem)?;
    let inputs: Vec<&Path> = inputs.iter().map(AsRef::as_ref).collect();
    write_all(&[(output.to_owned(), fabric_yaml(&sheet).into_bytes())], &inputs)?;
    for note in &notes {
        console.note(&format!("note: {note}"));
    }
    let mut value = shown(&sheet, &fabric);
    value["file"] = json!(output.display().to_string());
    value["notes"] = json!([notes, fabric.notes()].concat());
    value["ranges"] = json!(tests.map(|t| t.map(|m| m.range)));
    console.results(&value, || format!("{}\nwritten to {}\n", text(&sheet, &fabric), output.display()))
}
