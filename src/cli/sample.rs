//! `sample`: jobs for a batch, drawn at random and reproducibly.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use super::arg_values::in_millimetres;
use super::batch::told;
use super::batch_args::SampleArgs;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::make::borrowed;
use crate::batch::{BatchJob, SampleChoice, garments_of_folder, list_text, sample as draw};
use crate::io::files::{check_writable, write_all};
use crate::io::garment::{Ranges, Variant};
use crate::mannequin::{MannequinSpec, Measures};
use crate::pipeline::{PipelineError, read_variant};
use crate::{fabric, input, mannequin};

/// The word for a garment as it is drawn, among the names of its sizes.
const DRAWN: &str = "none";

/// `toile sample`
pub(super) fn sample(args: &SampleArgs, console: &Console) -> Result<Exit, CliError> {
    let options = BatchJob { spacing: args.spacing.map(in_millimetres), ..BatchJob::options() };
    let garments = garments(&args.garments, console)?;
    let or_all = |given: &[String], all: Vec<&str>| {
        if given.is_empty() { all.into_iter().map(str::to_owned).collect() } else { once_each(given) }
    };
    let choice = SampleChoice {
        garments: sized(&garments, &args.sizes)?,
        ranges: args
            .vary
            .as_deref()
            .map_or_else(|| Ok(Ranges::default()), Ranges::read)
            .map_err(PipelineError::from)?,
        bodies: or_all(&args.bodies, mannequin::library()),
        fabrics: or_all(&args.fabrics, fabric::library()),
    };
    check_names("--bodies", &choice.bodies, &mannequin::library())?;
    check_names("--fabrics", &choice.fabrics, &fabric::library())?;
    check_ends(&choice, args.vary.as_deref())?;
    let jobs = draw(&choice, args.count.get(), args.seed, &options)?;
    let inputs = inputs(&choice, args.vary.as_deref());
    let target = [args.output.clone()];
    check_writable(&target, &borrowed(&inputs))?;
    let folder = match args.output.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    // Files are named from the list's folder, which may be missing yet.
    std::fs::create_dir_all(folder)
        .map_err(|e| CliError::Argument(format!("cannot make the folder {}: {e}", folder.display())))?;
    let text = list_text(&jobs, folder);
    write_all(&[(args.output.clone(), text.into_bytes())], &borrowed(&inputs))?;
    console.results(&jobs, || {
        let list = args.output.display();
        format!("{} jobs written to {list}\n  toile batch {list} -o STORE makes them\n", jobs.len())
    })?;
    Ok(Exit::Done)
}

/// The garment files of a folder, or the one that is named.
fn garments(path: &Path, console: &Console) -> Result<Vec<PathBuf>, CliError> {
    if !path.is_dir() {
        crate::pipeline::read(path)?;
        return Ok(vec![path.to_owned()]);
    }
    let jobs = told(garments_of_folder(path, &BatchJob::options())?, console);
    Ok(jobs.into_iter().flat_map(|job| job.garment).collect())
}

/// The names without those that come again, also as another way to the same file: all jobs are to differ.
fn once_each(names: &[String]) -> Vec<String> {
    let meant = |name: &String| Path::new(name).canonicalize().unwrap_or_else(|_| PathBuf::from(name));
    let mut seen = HashSet::new();
    names.iter().filter(|name| seen.insert(meant(name))).cloned().collect()
}

/// Finds a slip of the pen now instead of in a thousand failures.
fn check_names(option: &str, names: &[String], shipped: &[&str]) -> Result<(), CliError> {
    let known = |name: &String| input::check_known(name, shipped);
    names.iter().try_for_each(known).map_err(|why| CliError::Argument(format!("{option}: {why}")))
}

/// Each garment with each of its sizes that is to be drawn.
fn sized(garments: &[PathBuf], wanted: &[String]) -> Result<Vec<(PathBuf, Option<String>)>, CliError> {
    let mut out = Vec::new();
    for file in garments {
        // A broken garment among others fails when it is made, as in any batch.
        let own: Vec<String> = crate::pipeline::read(file).map_or_else(
            |_| Vec::new(),
            |loaded| loaded.file.sizes.iter().map(|size| size.name.value.clone()).collect(),
        );
        let all = || std::iter::once(DRAWN.to_owned()).chain(own.clone()).collect();
        let sizes: Vec<String> = if wanted.is_empty() { all() } else { once_each(wanted) };
        if let Some(size) = sizes.iter().find(|size| *size != DRAWN && !own.contains(size)) {
            let known = if own.is_empty() { "none".to_owned() } else { own.join(", ") };
            let file = file.display();
            return Err(CliError::Argument(format!("--sizes: {file} has no size '{size}'; its sizes: {known}")));
        }
        out.extend(sizes.into_iter().map(|size| (file.clone(), Some(size).filter(|size| size != DRAWN))));
    }
    Ok(out)
}

/// Tries both ends of all ranges on every garment and body, so that a slip of the pen is found now.
fn check_ends(choice: &SampleChoice, file: Option<&Path>) -> Result<(), CliError> {
    for end in [0.0, 1.0] {
        if choice.ranges.has_measures() {
            choice.bodies.iter().try_for_each(|body| check_measures(&choice.ranges, body, end))?;
        }
        let drawn = choice.ranges.draw(|_| None, || end);
        let alter: Vec<String> = drawn.alter.iter().map(ToString::to_string).collect();
        if !alter.is_empty() {
            let ranges = file.unwrap_or(Path::new("--vary"));
            for (file, size) in &choice.garments {
                let variant = Variant { size: size.as_deref(), alter: &alter };
                read_variant(file, variant).map_err(|e| out_of_range(ranges, file, end, &e))?;
            }
        }
    }
    Ok(())
}

/// An alteration that cannot be carried out at one end of its ranges. Its place is in a text that nobody has written.
fn out_of_range(ranges: &Path, garment: &Path, end: f64, error: &PipelineError) -> CliError {
    let (ranges, garment) = (ranges.display(), garment.display());
    let which = if end == 0.0 { "least" } else { "largest" };
    CliError::Argument(format!(
        "{ranges}: with the {which} numbers of its ranges {garment} cannot be altered:\n{error}"
    ))
}

/// Puts the measures at one end of their ranges on a body.
fn check_measures(ranges: &Ranges, body: &str, end: f64) -> Result<(), CliError> {
    let wrong = |why: String| CliError::Argument(format!("--vary: measures: {why}"));
    let spec = MannequinSpec::load(body)?;
    if let Some(name) = ranges.shares().find(|name| spec.measure(name).is_none()) {
        return Err(wrong(format!("'{name}' is no measure of the body {body}, of which a share could be drawn")));
    }
    let mut measures = Measures::default();
    for (name, mm) in &ranges.draw(|name| spec.measure(name), || end).measures {
        measures.add(name, mm.as_f64().unwrap_or_default()).map_err(wrong)?;
    }
    spec.measured(&measures)?;
    Ok(())
}

fn inputs(choice: &SampleChoice, ranges: Option<&Path>) -> Vec<PathBuf> {
    let named = choice.bodies.iter().chain(&choice.fabrics).map(PathBuf::from).filter(|path| path.is_file());
    let garments = choice.garments.iter().map(|(file, _)| file.clone());
    garments.chain(named).chain(ranges.map(Path::to_owned)).collect()
}
