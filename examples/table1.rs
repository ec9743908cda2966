//! The child's dress in the form of Table 1 of Fan, Zhou, Wang & Yuen 1999, beside the published numbers.
//!
//! ```text
//! cargo run --release --example table1 [-- GARMENT.yaml [SPACING_MM]]
//! ```
//!
//! Theirs is another child's one-piece garment of six pieces (fronts, backs, sleeves), so the numbers need not agree;
//! what should agree is their size. Sewn in less than 20 s and flattened in less than 30 s on a Pentium, they say.

use std::error::Error;
use std::path::Path;

use toile::flatten::FlattenOptions;
use toile::pipeline::{Job, Overrides, Run, read};
use toile::report::{Quartet, Report, aligned};

/// Area and boundary error from flat to space, then from space to flat, percent, as published.
const PUBLISHED: [[f64; 4]; 6] = [
    [2.55, 0.687, 0.036, 0.850],
    [0.514, 0.370, 1.18, 0.837],
    [0.682, 0.355, 0.210, 1.72],
    [2.614, 0.682, 0.025, 0.804],
    [0.597, 0.580, 1.13, 0.756],
    [0.331, 0.344, 0.205, 1.70],
];

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let file = args.next().unwrap_or_else(|| "patterns/child_dress.yaml".into());
    let spacing = args.next().map(|mm| mm.parse::<f64>().map(|mm| 1e-3 * mm)).transpose()?;
    let file = Path::new(&file);
    let job = Job::new(file, read(file)?, &Overrides { spacing, ..Overrides::default() })?;
    let mut run = Run::new(&job);
    run.flatten(&FlattenOptions::default(), &mut |_, _| {})?;
    let report = run.report();
    println!("{}, {}, spacing {} mm; percent\n", report.garment, report.fabric, report.spacing);
    print!("{}", table(&report));
    for stage in &report.stages {
        println!("  {:8} {:6.2} s, {} steps", stage.name, stage.seconds, stage.iterations);
    }
    Ok(())
}

fn table(report: &Report) -> String {
    let head =
        ["piece", "area 2D→3D", "boundary", "area 3D→2D", "boundary", "Table 1:", "boundary", "area 3D→2D", "boundary"];
    let mut rows = vec![head.map(String::from).to_vec()];
    for (k, piece) in report.pieces.iter().enumerate() {
        let way = |of: fn(&Quartet) -> Option<f64>| [of(&piece.area_error), of(&piece.boundary_error)];
        let ours = [way(|q| q.drape), way(|q| q.flatten)].concat().into_iter().map(|e| e.map(|e| 100.0 * e));
        let theirs = PUBLISHED.get(k).copied().map_or([None; 4], |row| row.map(Some));
        let numbers = ours.chain(theirs).map(|e| e.map_or_else(|| "–".into(), |e| format!("{e:.3}")));
        rows.push(std::iter::once(piece.name.clone()).chain(numbers).collect());
    }
    aligned(&rows)
}
