//! Garments made from nothing and from an earlier result, on one thread: seconds of meshing, sewing, draping and
//! flattening, their ratio, and how far apart the two drapes lie. `cargo bench --bench restart -- NAME` takes garments
//! whose file name holds NAME.
//!
//! One run each; compare medians of several, on a quiet machine.

#[allow(dead_code, reason = "nothing here is sampled")]
mod common;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

use toile::flatten::FlattenOptions;
use toile::geometry::Vec3;
use toile::io::garment::read_text;
use toile::pipeline::{Job, Overrides, PictureOptions, Run};

/// Metres.
const SPACING: f64 = 0.015;

/// A garment file below `patterns`, and what is changed in it.
struct Case {
    garment: &'static str,
    change: &'static str,
    /// Texts of the file, and what takes their places.
    edits: &'static [(&'static str, &'static str)],
    fabric: Option<&'static str>,
}

const CASES: [Case; 5] = [
    Case { garment: "tshirt.yaml", change: "nothing", edits: &[], fabric: None },
    Case {
        garment: "tshirt.yaml",
        change: "hem 10 mm longer",
        edits: &[("265.5 598", "265.5 608"), ("L 0 598", "L 0 608")],
        fabric: None,
    },
    Case { garment: "tshirt.yaml", change: "cotton_poplin", edits: &[], fabric: Some("cotton_poplin") },
    Case {
        garment: "sheath_dress.yaml",
        change: "hem 10 mm longer",
        edits: &[("240 1055", "240 1065"), ("0 1055", "0 1065"), ("240 1030", "240 1040"), ("0 1030", "0 1040")],
        fabric: None,
    },
    Case { garment: "sheath_dress.yaml", change: "denim", edits: &[], fabric: Some("denim") },
];

fn main() -> Result<(), Box<dyn Error>> {
    let names: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    println!("{:<20}{:<20}{:>9}{:>9}{:>8}   apart mm (mean, max)", "garment", "change", "cold s", "from s", "ratio");
    for case in CASES.iter().filter(|case| names.is_empty() || names.iter().any(|n| case.garment.contains(n.as_str())))
    {
        println!("{}", pool.install(|| line(case).map_err(|error| error.to_string()))?);
    }
    Ok(())
}

fn line(case: &Case) -> Result<String, Box<dyn Error>> {
    let folder = earlier(case)?;
    let (cold, drape) = made(case, None)?;
    let (from, again) = made(case, Some(&folder))?;
    let far: Vec<f64> = drape.iter().zip(&again).map(|(a, b)| 1e3 * (a - b).norm()).collect();
    let (mean, most) = (far.iter().sum::<f64>() / far.len() as f64, far.iter().copied().fold(0.0, f64::max));
    let Case { garment, change, .. } = case;
    Ok(format!("{garment:<20}{change:<20}{cold:>9.2}{from:>9.2}{:>8.2}   {mean:.1}, {most:.1}", from / cold))
}

/// The result of the garment before the change, in a folder.
fn earlier(case: &Case) -> Result<PathBuf, Box<dyn Error>> {
    let job = common::job(&format!("patterns/{}", case.garment), SPACING)?;
    let mut run = Run::new(&job);
    run.drape(&mut |_, _| {})?;
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("restart-{}", case.garment));
    fs::create_dir_all(&folder)?;
    for (name, bytes) in run.results(&run.report(), &PictureOptions::default())? {
        fs::write(folder.join(name), bytes)?;
    }
    Ok(folder)
}

/// Seconds of making the changed garment, and where every particle hangs.
fn made(case: &Case, from: Option<&Path>) -> Result<(f64, Vec<Vec3>), Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns").join(case.garment);
    let text = case.edits.iter().fold(fs::read_to_string(&file)?, |text, (old, new)| text.replace(old, new));
    let begin = Instant::now();
    let loaded = read_text("garment", case.garment, &text)?;
    let fabric = case.fabric.map(str::to_owned);
    let job = Job::new(&file, loaded, &Overrides { spacing: Some(SPACING), fabric, ..Overrides::default() })?;
    let mut run = match from {
        Some(folder) => Run::continued(&job, folder)?,
        None => Run::new(&job),
    };
    run.flatten(&FlattenOptions::default(), &mut |_, _| {})?;
    let seconds = begin.elapsed().as_secs_f64();
    Ok((seconds, run.last().unwrap_or_default().to_vec()))
}
