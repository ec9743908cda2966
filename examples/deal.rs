//! How garments are worn: which ends of the body pass through which opening, and how clear that is.
//!
//! `cargo run --release --example deal -- FILE.yaml … [--body NAME] [--spacing MM]`

use std::error::Error;
use std::path::Path;

use toile::pipeline::{Job, Overrides, read};
use toile::sew::start::{Dealing, Glued, GluedOpening, edges, glue, guess, openings};

/// Metres per millimetre.
const MM: f64 = 1e-3;
/// Spacing when none is asked for, metres: girths are as right on a coarse mesh.
const SPACING: f64 = 0.02;

fn main() -> Result<(), Box<dyn Error>> {
    let mut overrides = Overrides { spacing: Some(SPACING), ..Overrides::default() };
    let mut files = Vec::new();
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--body" => overrides.body = args.next(),
            "--spacing" => overrides.spacing = Some(MM * args.next().ok_or("--spacing MM")?.parse::<f64>()?),
            _ => files.push(arg),
        }
    }
    for file in &files {
        match table(Path::new(file), &overrides) {
            Ok(text) => print!("{text}"),
            Err(error) => println!("{file}: {error}"),
        }
    }
    Ok(())
}

/// The openings of a garment and the parts of the body that pass through them.
fn table(file: &Path, overrides: &Overrides) -> Result<String, Box<dyn Error>> {
    let job = Job::new(file, read(file)?, overrides)?;
    let glued = glue(&job.garment, &job.mesh, &[]);
    let found = openings(&glued, &job.mesh);
    let dealing = guess(&job.garment, &job.mesh, &glued, &found, &job.body);
    let mut text = format!("{}: margin {:.1}{}\n", file.display(), dealing.margin, beside(&job, &glued));
    for i in 0..found.len() {
        text += &row(&job, &glued, &found, &dealing, i);
    }
    if !dealing.zips.is_empty() {
        let zipped = glue(&job.garment, &job.mesh, &dealing.zips);
        let found = openings(&zipped, &job.mesh);
        let dealing = guess(&job.garment, &job.mesh, &zipped, &found, &job.body);
        text += &format!("  with its fronts closed: margin {:.1}\n", dealing.margin);
        for i in 0..found.len() {
            text += &row(&job, &zipped, &found, &dealing, i);
        }
    }
    Ok(text)
}

/// The pieces that are not part of the surface, and where it is lapped.
fn beside(job: &Job, glued: &Glued) -> String {
    let name = |piece: usize| job.garment.pieces[piece].name.as_str();
    let out: Vec<&str> = glued.left_out.iter().map(|&piece| name(piece)).collect();
    let laps = glued.laps.iter().map(|lap| format!("{} over {}", name(lap.over), name(lap.under)));
    let laps: Vec<String> = laps.collect();
    let said = |what: &str, list: String| if list.is_empty() { list } else { format!("; {what} {list}") };
    said("lies on others:", out.join(", ")) + &said("lapped:", laps.join(", "))
}

fn row(job: &Job, glued: &Glued, found: &[GluedOpening], dealing: &Dealing, i: usize) -> String {
    let opening = &found[i];
    let along = edges(&job.garment, &job.mesh, glued, opening).join(", ");
    let next = dealing.runner_up.as_ref().map_or(String::new(), |next| format!(" (or {})", next[i]));
    let (length, girth) = (opening.length / MM, opening.girth / MM);
    format!(
        "  part {} {:24} {length:6.0} mm, girth {girth:6.0}  {along}{next}\n",
        opening.part,
        dealing.ends[i].to_string()
    )
}
