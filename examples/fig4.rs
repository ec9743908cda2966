//! Fig. 4 of Liu, Wang & Luo 2015: 961 vertices, each term of the energy alone, then all three (poplin).
//!
//! `cargo run --release --example fig4` prints energies and writes four pictures into `out/experiments`.

mod common;

use std::error::Error;

use common::{diagonal, picture, solve, weights};
use toile::drape::geometric::{Weighting, Weights};

fn main() -> Result<(), Box<dyn Error>> {
    let sheet = diagonal("fig4", 31, 31);
    let alone = |k: usize| {
        let on = |j: usize| if j == k { 1.0 } else { 0.0 };
        Weights { recovery: on(0), stretch: on(1), bend: on(2) }
    };
    let runs =
        [("recovery", alone(0)), ("stretch", alone(1)), ("bend", alone(2)), ("together", weights("cotton_poplin")?)];
    println!("{:10} {:>10} {:>12} {:>12} {:>12}", "term", "iterations", "E_P m2", "E_L m2", "E_A m2");
    for (name, weights) in runs {
        let (x, report, settled) = solve(&sheet, weights, Weighting::Plain)?;
        let e = report.energy;
        println!("{name:10} {settled:>10} {:>12.3e} {:>12.3e} {:>12.3e}", e.recovery, e.stretch, e.bend);
        picture(&format!("fig4_{name}"), "rim fixed, five places of the diagonal lifted by 60 mm", &sheet.mesh, &x)?;
    }
    Ok(())
}
