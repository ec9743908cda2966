//! The scenes of `tests/scenes` at full size, each draped once: how long it takes, what contact costs of that, and
//! whether it rests without a crossing. `cargo bench --bench scenes -- NAME` takes those whose file name holds NAME.
//!
//! One run each, for the longest takes minutes; compare medians of several.

#[allow(dead_code, reason = "nothing here is sampled")]
mod common;

use std::error::Error;

use toile::pipeline::Run;
use toile::report::{ContactReport, Stage};

/// Files below `tests/scenes` and their spacings, mm.
const SCENES: [(&str, f64); 13] = [
    ("sheet_on_sphere.yaml", 20.0),
    ("sheet_on_sphere.yaml", 10.0),
    ("sheet_on_bar.yaml", 10.0),
    ("sheet_on_edge.yaml", 10.0),
    ("sheet_on_cone.yaml", 10.0),
    ("heap.yaml", 10.0),
    ("five_sheets.yaml", 20.0),
    ("cushion.yaml", 10.0),
    ("belt.yaml", 5.0),
    ("turned_cuff.yaml", 8.0),
    ("two_layers.yaml", 10.0),
    ("close_legs.yaml", 10.0),
    ("close_arms.yaml", 10.0),
];

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo adds `--bench` to what is asked for.
    let asked: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    println!("{:<24}{:>10}{:>8}{:>9}   contact: body, features, cloth, following", "scene", "particles", "steps", "s");
    for (name, spacing) in SCENES {
        if asked.is_empty() || asked.iter().any(|a| name.contains(a.as_str())) {
            println!("{}", line(name, spacing)?);
        }
    }
    Ok(())
}

/// What a scene at `spacing` mm took.
fn line(name: &str, spacing: f64) -> Result<String, Box<dyn Error>> {
    let job = common::job(&format!("tests/scenes/{name}"), 1e-3 * spacing)?;
    let mut run = Run::new(&job);
    run.drape(&mut |_, _| {})?;
    let report = run.report();
    let particles: usize = report.pieces.iter().map(|p| p.particles).sum();
    let seconds: f64 = report.stages.iter().map(|s| s.seconds).sum();
    let drape = report.stages.iter().find(|s| s.name == "drape").ok_or("no drape")?;
    let crossed = if report.contact == ContactReport::default() { "" } else { "  CROSSES" };
    let rests = if drape.converged { "" } else { "  DRIFTS" };
    let (steps, contact) = (drape.iterations, shares(drape));
    Ok(format!("{name:<24}{particles:>10}{steps:>8}{seconds:>9.1}   {contact}{crossed}{rests}"))
}

/// Shares of a drape that the parts of contact take, and their sum.
fn shares(drape: &Stage) -> String {
    let Some(c) = drape.contact_seconds else { return String::new() };
    let parts = [c.body, c.features, c.cloth, c.follow];
    let each = parts.map(|part| format!("{:4.1}", 100.0 * part / c.of)).join(" +");
    format!("{each} = {:4.1} %", 100.0 * parts.iter().sum::<f64>() / c.of)
}
