//! `fabric test`: virtual specimens of a fabric beside what is known.

use std::path::Path;
use std::sync::Arc;

use rayon::prelude::*;
use serde_json::{Value, json};

use super::console::Console;
use super::exit::{CliError, Exit};
use crate::fabric::{load, sheet};
use crate::io::files::{check_writable, write_all};
use crate::picture::draw_shadow;
use crate::report::aligned;
use crate::specimen::{BenchFigure, BenchTest, DrapedDisc, Known, Sample, TESTS};

/// `toile fabric test …`; out of bounds when a figure with a known value is further off than it may be or a test
/// gives none.
pub(super) fn test(name: &str, only: &[String], output: Option<&Path>, console: &Console) -> Result<Exit, CliError> {
    let sheet = sheet(name)?;
    let sample = Sample {
        fabric: Arc::new(load(name)?),
        drape: sheet.drape_band(),
        published: sheet.liu.as_ref().map(|liu| liu.means),
    };
    let tests: Vec<&BenchTest> = TESTS.iter().filter(|t| only.is_empty() || only.iter().any(|o| o == t.name)).collect();
    if let Some(output) = output {
        let home = Path::new(name).parent().unwrap_or(Path::new(""));
        let curves: Vec<_> = sheet.curve_files().map(|file| home.join(file)).collect();
        let inputs: Vec<&Path> = std::iter::once(Path::new(name)).chain(curves.iter().map(AsRef::as_ref)).collect();
        check_writable(&[output.to_owned()], &inputs)?;
        if !tests.iter().any(|t| t.name == "drape") {
            return Err(CliError::Argument("-o draws the shadow of the drape test: add --only drape".to_owned()));
        }
    }
    // No test waits for another, and one that fails takes none with it.
    let outcomes: Vec<_> = tests.par_iter().map(|t| t.run(&sample)).collect();
    let (mut figures, mut draped, mut failed) = (Vec::new(), None, Vec::new());
    for (test, outcome) in tests.iter().zip(outcomes) {
        match outcome {
            Ok(outcome) => {
                figures.extend(outcome.figures);
                draped = outcome.draped.or(draped);
            }
            Err(error) => failed.push((test.name, error.to_string())),
        }
    }
    if let (Some(output), Some(draped)) = (output, draped) {
        write_all(&[(output.to_owned(), picture(&sample, &draped)?)], &[])?;
    }
    let value = json!({
        "fabric": sample.fabric.name,
        "assumed": sample.fabric.defaults,
        "figures": figures.iter().map(figure_value).collect::<Vec<_>>(),
        "failed": failed.iter().map(|(test, why)| json!({"test": test, "why": why})).collect::<Vec<_>>(),
    });
    let lines = || failed.iter().map(|(test, why)| format!("\n  {test}: no figure, {why}")).collect::<String>();
    console.results(&value, || table(&figures) + &lines())?;
    let holds = failed.is_empty() && figures.iter().all(|f| f.holds() != Some(false));
    Ok(if holds { Exit::Done } else { Exit::OutOfBounds })
}

fn picture(sample: &Sample, draped: &DrapedDisc) -> Result<Vec<u8>, CliError> {
    let words = format!("one lay: drape coefficient {:.0} %, {} folds", 100.0 * draped.coefficient, draped.folds);
    Ok(draw_shadow(&draped.shadow.dark, draped.shadow.width, &sample.fabric.name, &words)?)
}

fn figure_value(f: &BenchFigure) -> Value {
    let mut value = json!({"test": f.test, "what": f.what, "unit": f.unit, "measured": f.measured});
    match f.known {
        Known::Value { value: known, tolerance } => {
            value["known"] = json!(known);
            value["error"] = json!(f.error());
            value["tolerance"] = json!(tolerance);
            value["holds"] = json!(f.holds());
        }
        Known::Band(band) => value["band"] = json!(band),
        Known::Nothing => {}
    }
    value
}

fn table(figures: &[BenchFigure]) -> String {
    let mut rows = vec![["test", "figure", "measured", "known", "error %", "at most", ""].map(String::from).to_vec()];
    for f in figures {
        let number = |x: f64| if x.abs() < 0.1 || x.abs() >= 1e4 { format!("{x:.3e}") } else { format!("{x:.4}") };
        let (known, error, most, holds) = match f.known {
            Known::Value { value, tolerance } => (
                number(value),
                f.error().map_or_else(String::new, |e| format!("{:.2}", 100.0 * e)),
                format!("{:.0}", 100.0 * tolerance),
                if f.holds() == Some(true) { "" } else { "off" }.to_owned(),
            ),
            Known::Band([low, high]) => {
                let inside = (low..=high).contains(&f.measured);
                (format!("{low}…{high}"), String::new(), String::new(), if inside { "" } else { "outside" }.to_owned())
            }
            Known::Nothing => Default::default(),
        };
        let what = if f.unit.is_empty() { f.what.clone() } else { format!("{}, {}", f.what, f.unit) };
        rows.push(vec![f.test.to_owned(), what, number(f.measured), known, error, most, holds]);
    }
    aligned(&rows)
}
