//! Fig. 6 of Liu, Wang & Luo 2015: the shape does not depend on the mesh. An irregular Delaunay mesh of 329 vertices
//! against a regular one of 323, and 48 against 441.
//!
//! `cargo run --release --example fig6` prints the largest distances between the surfaces for every fabric and writes
//! pictures. The sums are weighted by area (`Weighting::PerArea`); printed as they stand, (4)–(6) depend on the mesh.
//!
//! Stretch and bend alone give the same surface in both meshes where the same cloth is held: the arch is the same
//! curve in all of them, the lifted middle the same vertices in the first pair. Recovery to the flat mesh does not. It
//! holds every vertex beside a lifted one down, and the cloth falls between them, over a cell, where the energy itself
//! wants a slope h (ω_B / 4 ω_R)^¼ wide: at most 9 mm (h = 9.6 mm), but for linen's 65. Cells are 20 to 80 mm. The last
//! lines show the difference going as they become smaller.

mod common;

use std::error::Error;

use common::pairs::{arch, difference, middle, pairs};
use common::{HEIGHT, WIDTH, fifteen, picture, sheet, solve, weights};
use toile::drape::geometric::{Weighting, Weights};
use toile::report::aligned;

fn main() -> Result<(), Box<dyn Error>> {
    let pairs = pairs()?;
    let mut head = vec!["fabric".to_owned()];
    for pair in ["329", "48"] {
        for weights in ["", ", ω_R = 0"] {
            head.extend(["middle", "arch"].map(|handles| format!("{pair} {handles}{weights}")));
        }
    }
    let mut rows = vec![head];
    for fabric in fifteen()? {
        let Some(liu) = &fabric.liu else { continue };
        let published = Weights::from_percent(liu.weights);
        let mut row = vec![fabric.name.clone()];
        for pair in &pairs {
            for w in [published, Weights { recovery: 0.0, ..published }] {
                for handles in [middle, arch] {
                    row.push(format!("{:.2}", 100.0 * difference(pair, handles, w)?));
                }
            }
        }
        rows.push(row);
    }
    println!(
        "largest distance between the surfaces, % of the diagonal; published weights, and those without recovery\n"
    );
    print!("{}", aligned(&rows));
    println!("\nwool, arch, published weights");
    for [coarse, fine] in [[[8, 6], [15, 11]], [[15, 11], [29, 21]], [[29, 21], [57, 41]]] {
        let of = |[columns, rows]: [u32; 2]| sheet(WIDTH, HEIGHT, columns, rows);
        let percent = 100.0 * difference(&[of(coarse), of(fine)], arch, weights("wool_suiting")?)?;
        println!("{:>5} against {:>5} vertices {percent:.2}", coarse[0] * coarse[1], fine[0] * fine[1]);
    }
    for (name, mesh) in ["a", "b", "c", "d"].iter().zip(pairs.as_flattened()) {
        let (x, ..) = solve(&middle(mesh), weights("wool_suiting")?, Weighting::PerArea)?;
        picture(&format!("fig6_{name}"), "wool", mesh, &x)?;
    }
    Ok(())
}
