//! Fig. 7 of Liu, Wang & Luo 2015: 2,601 vertices over a ball, pulled along the diagonal, in horizontal wrinkles.
//!
//! `cargo run --release --example fig7` prints energies and writes pictures of ten fabrics into `out/experiments`. As
//! in `fig5`, recovery holds every vertex where it was in the initial mesh: of most fabrics nothing moves but what is
//! held and a cell or two beside it (E_P is little more than that of the held vertices), and only linen lies in a
//! wave between its two sides. Told apart they are by what stretches and bends there.

mod common;

use std::error::Error;

use common::{ball, picture, pull, solve, weights, wrinkles};
use toile::drape::geometric::Weighting;

/// Those of the fifteen that the paper photographed.
const PHOTOGRAPHED: [&str; 10] = [
    "linen",
    "ramie",
    "cotton_poplin",
    "wool_suiting",
    "gabardine",
    "silk_charmeuse",
    "denim",
    "canvas",
    "nylon_taffeta",
    "fine_cotton",
];

fn main() -> Result<(), Box<dyn Error>> {
    println!("{:16} {:10} {:>10} {:>12} {:>12} {:>12}", "fabric", "", "iterations", "E_P m2", "E_L m2", "E_A m2");
    for name in PHOTOGRAPHED {
        for experiment in [ball(51), pull(51), wrinkles(51)] {
            let (x, report, settled) = solve(&experiment, weights(name)?, Weighting::Plain)?;
            let (e, what) = (report.energy, experiment.name);
            println!("{name:16} {what:10} {settled:>10} {:>12.3e} {:>12.3e} {:>12.3e}", e.recovery, e.stretch, e.bend);
            picture(&format!("fig7_{what}_{name}"), name, &experiment.mesh, &x)?;
        }
    }
    Ok(())
}
