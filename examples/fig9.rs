//! Fig. 9 of Liu, Wang & Luo 2015: a skirt whose waist is fixed and whose hem is drawn, in wool and in ramie.
//!
//! `cargo run --release --example fig9` prints how far the two differ and writes pictures into `out/experiments`.

mod common;

use std::error::Error;

use common::{picture, skirt, solve, weights};
use toile::drape::geometric::Weighting;

fn main() -> Result<(), Box<dyn Error>> {
    let skirt = skirt();
    let mut shapes = Vec::new();
    for name in ["wool_suiting", "ramie"] {
        let (x, report, settled) = solve(&skirt, weights(name)?, Weighting::Plain)?;
        println!("{name:14} {settled} iterations, energy {:.4e} m2", report.energy.total);
        picture(&format!("fig9_{name}"), name, &skirt.mesh, &x)?;
        shapes.push(x);
    }
    let apart = shapes[0].iter().zip(&shapes[1]).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    println!("apart by up to {:.1} mm", 1e3 * apart);
    Ok(())
}
