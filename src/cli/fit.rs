//! `fit`: the alterations that give a garment the fit that is wanted.

use super::alter::note_written_anew;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::garment_args::FitArgs;
use super::make::borrowed;
use crate::fitting::{Asked, Fitting, KnobRow, SPACING, WantRow, fit as fitted};
use crate::io::files::{check_writable, write_all};
use crate::io::garment::read_wants;
use crate::pipeline::{Overrides, PipelineError, inputs, read};
use crate::report::aligned;

/// `toile fit`
pub(super) fn fit(args: &FitArgs, console: &Console) -> Result<Exit, CliError> {
    let overrides = args.overrides.checked();
    if overrides.size.is_some() {
        let why = "--size: sizes follow the alterations of the garment; fit the garment as it is drawn".to_owned();
        return Err(CliError::Argument(why));
    }
    let overrides = Overrides { spacing: overrides.spacing.or(Some(SPACING)), ..overrides };
    let loaded = read(&args.garment)?;
    let mut from = inputs(&args.garment, &loaded.garment, &overrides);
    from.extend(args.want.clone());
    check_writable(args.output.as_slice(), &borrowed(&from))?;
    let wants = args.want.as_ref().map(|file| read_wants(file, loaded.file.unit()));
    let wants = wants.transpose().map_err(PipelineError::from)?;
    let new = args.output.as_ref().unwrap_or(&args.garment).display().to_string();
    let asked = Asked {
        file: &args.garment,
        loaded: &loaded,
        wants: wants.as_ref(),
        overrides: &overrides,
        new: &new,
        drapes: args.drapes,
    };
    let bars = console.progress();
    let found = fitted(&asked, &mut |stage, share| bars.show(stage, share))?;
    drop(bars);
    write(args, &found, &from, console)?;
    console.results(&found, || text(&found, args))?;
    found.refused.iter().for_each(|why| console.complain(&format!("cannot be had: {why}")));
    found.problems.iter().for_each(|problem| console.complain(&format!("the altered garment: {problem}")));
    Ok(if found.refused.is_empty() && found.problems.is_empty() { Exit::Done } else { Exit::OutOfBounds })
}

/// Writes the new garment file, if one was asked for and there is one.
fn write(args: &FitArgs, found: &Fitting, inputs: &[std::path::PathBuf], console: &Console) -> Result<(), CliError> {
    let Some((file, new)) = args.output.as_ref().zip(found.new.as_ref()) else { return Ok(()) };
    write_all(&[(file.clone(), new.text.clone().into_bytes())], &borrowed(inputs))?;
    if !new.in_place {
        note_written_anew(file, &args.garment, console);
    }
    Ok(())
}

fn text(found: &Fitting, args: &FitArgs) -> String {
    let Fitting { garment, mannequin, fabric, spacing, drapes, .. } = found;
    let s = if *drapes == 1 { "" } else { "s" };
    let head = format!("{garment} on {mannequin}, {fabric}: {drapes} drape{s}, {spacing} mm between particles\n");
    let mut out = head + &wants(&found.wants);
    if !found.knobs.is_empty() && *drapes > 1 {
        out.push_str(&format!("\n{}", knobs(&found.knobs, &found.wants)));
    }
    out.push('\n');
    if found.refused.is_empty() && found.new.is_none() {
        out.push_str("fits as it is wanted; nothing is to be changed\n");
    }
    found.changes.iter().for_each(|change| out.push_str(&format!("{change}\n")));
    if found.new.is_some() {
        out.push_str(&match &args.output {
            Some(file) => format!("  written to {}\n", file.display()),
            None => format!("  for the file: alter: [{}]; -o NEW.yaml writes it\n", found.alter.join(", ")),
        });
    }
    if !found.refused.is_empty() {
        out.push_str("nothing is written\n");
    }
    out
}

/// The wants with their figures before and after.
fn wants(rows: &[WantRow]) -> String {
    let mut table = vec![["want", "", "wanted", "before", "after", ""].map(String::from).to_vec()];
    table.extend(rows.iter().enumerate().map(|(k, row)| {
        vec![
            letter(k),
            row.want.clone(),
            wanted(row),
            value(row.before, row.unit),
            value(row.after, row.unit),
            if row.ok { "ok" } else { "NO" }.to_owned(),
        ]
    }));
    aligned(&table)
}

/// Letters of the wants in the table of knobs.
fn letter(k: usize) -> String {
    let letters = "abcdefghijklmnopqrstuvwxyz";
    letters.chars().nth(k).map_or_else(|| (k + 1).to_string(), String::from)
}

fn wanted(row: &WantRow) -> String {
    match (row.from, row.to) {
        (Some(from), Some(to)) if from == to => format!("{from} {}", row.unit),
        (Some(from), Some(to)) => format!("{from}..{to} {}", row.unit),
        (Some(from), None) => format!("above {from} {}", row.unit),
        (None, Some(to)) => format!("below {to} {}", row.unit),
        (None, None) => String::new(),
    }
}

fn value(x: f64, unit: &str) -> String {
    let digits = if unit == "kPa" { 2 } else { 1 };
    if x.is_nan() { "-".to_owned() } else { format!("{x:.digits$}") }
}

/// The knobs with their amounts, and what 10 mm of each change.
fn knobs(rows: &[KnobRow], wants: &[WantRow]) -> String {
    let mut head: Vec<String> = vec!["change by 10 mm of".to_owned()];
    head.extend((0..wants.len()).map(letter));
    head.extend(["found", "range", ""].map(String::from));
    let mut table = vec![head];
    for row in rows {
        let mut line = vec![row.knob.clone()];
        line.extend(row.effects.iter().zip(wants).map(|(x, want)| {
            let digits = if want.unit == "kPa" { 2 } else { 1 };
            format!("{x:+.digits$}")
        }));
        let end = if row.at_end { "at its end" } else { "" };
        line.extend([format!("{:.1}", row.amount), format!("{}..{}", row.from, row.to), end.to_owned()]);
        table.push(line);
    }
    aligned(&table)
}
