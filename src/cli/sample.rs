//! `sample`: jobs for a batch, drawn at random and reproducibly.

use std::path::{Path, PathBuf};

use super::args::in_millimetres;
use super::batch_args::SampleArgs;
use super::console::Console;
use super::exit::{CliError, Exit};
use super::make::borrowed;
use crate::batch::{Choice, Job, garments_of_folder, list_text, sample as draw};
use crate::io::files::{check_writable, write_all};
use crate::{fabric, mannequin};

/// `toile sample`
pub(super) fn sample(args: &SampleArgs, console: &Console) -> Result<Exit, CliError> {
    let options = Job { spacing: args.spacing.map(in_millimetres), ..Job::options() };
    let garments = garments(&args.garments)?;
    let or_all = |given: &[String], all: Vec<&str>| {
        if given.is_empty() { all.into_iter().map(str::to_owned).collect() } else { given.to_vec() }
    };
    let choice = Choice {
        garments,
        bodies: or_all(&args.bodies, mannequin::library()),
        fabrics: or_all(&args.fabrics, fabric::library()),
    };
    check_known("--bodies", &choice.bodies, &mannequin::library())?;
    check_known("--fabrics", &choice.fabrics, &fabric::library())?;
    let jobs = draw(&choice, args.count.get(), args.seed, &options)?;
    let inputs = inputs(&choice);
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
fn garments(path: &Path) -> Result<Vec<PathBuf>, CliError> {
    if !path.is_dir() {
        crate::pipeline::read(path)?;
        return Ok(vec![path.to_owned()]);
    }
    let jobs = garments_of_folder(path, &Job::options())?;
    Ok(jobs.into_iter().flat_map(|job| job.garment).collect())
}

/// Finds a slip of the pen now instead of in a thousand failures.
fn check_known(option: &str, names: &[String], shipped: &[&str]) -> Result<(), CliError> {
    let unknown = names.iter().find(|name| !shipped.contains(&name.as_str()) && !Path::new(name).is_file());
    unknown.map_or(Ok(()), |name| {
        let nearest = crate::input::nearest(name, shipped.iter().copied());
        let meant = nearest.map_or_else(String::new, |name| format!("; did you mean '{name}'?"));
        Err(CliError::Argument(format!(
            "{option}: '{name}' is neither in the library ({}) nor a file{meant}",
            shipped.join(", ")
        )))
    })
}

fn inputs(choice: &Choice) -> Vec<PathBuf> {
    let named = choice.bodies.iter().chain(&choice.fabrics).map(PathBuf::from).filter(|path| path.is_file());
    choice.garments.iter().cloned().chain(named).collect()
}
