//! Fig. 5 of Liu, Wang & Luo 2015: one rectangle of 2,000 vertices in fifteen fabrics.
//!
//! `cargo run --release --example fig5` prints how the shapes differ and writes fifteen pictures into
//! `out/experiments`. With the targets at the initial mesh, as (4) is printed, recovery holds every vertex beside a
//! lifted one back: with most of the published weights the lifted places stand up as spikes. Only linen, which has next
//! to no recovery, follows them.

mod common;

use std::error::Error;

use common::{diagonal, fifteen, picture, solve};
use toile::drape::geometric::{Weighting, Weights};

fn main() -> Result<(), Box<dyn Error>> {
    let sheet = diagonal("fig5", 50, 40);
    println!("{:20} {:>10} {:>12} {:>14} {:>14}", "fabric", "iterations", "mean z mm", "above 30 mm %", "longest + %");
    for fabric in fifteen()? {
        let Some(liu) = &fabric.liu else { continue };
        let (x, _, settled) = solve(&sheet, Weights::from_percent(liu.weights), Weighting::Plain)?;
        let mean = x.iter().map(|v| v.z).sum::<f64>() / x.len() as f64;
        let high = x.iter().filter(|v| v.z > 0.03).count() as f64 / x.len() as f64;
        let stretch = sheet.mesh.triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
        let longest = stretch
            .map(|e| {
                let of = |x: &[toile::geometry::Vec3]| (x[e[0] as usize] - x[e[1] as usize]).norm();
                of(&x) / of(&sheet.mesh.vertices) - 1.0
            })
            .fold(0.0, f64::max);
        println!(
            "{:20} {settled:>10} {:>12.2} {:>14.2} {:>14.1}",
            fabric.name,
            1e3 * mean,
            100.0 * high,
            100.0 * longest
        );
        picture(&format!("fig5_{}", fabric.name), &fabric.description, &sheet.mesh, &x)?;
    }
    Ok(())
}
