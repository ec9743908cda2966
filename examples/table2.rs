//! Table 2 of Liu, Wang & Luo 2015 with the weights computed anew by (8), and where the two differ.
//!
//! `cargo run --release --example table2`

mod common;

use std::error::Error;

use common::sheets;
use toile::report::aligned;

/// Points by which a rounded table may differ from itself.
const ROUNDED: f64 = 0.02;

fn main() -> Result<(), Box<dyn Error>> {
    let head = ["#", "fabric", "v'(r)", "v'(s)", "v'(b)", "ω_R", "ω_S", "ω_B", "(8) R", "S", "B", "off", ""];
    let mut rows = vec![head.map(String::from).to_vec()];
    for sheet in sheets()? {
        let Some(liu) = &sheet.liu else { continue };
        let again = liu.recomputed_weights();
        let off = again.iter().zip(liu.weights).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let mut row = vec![liu.sample.map_or_else(String::new, |n| n.to_string()), sheet.name.clone()];
        row.extend(liu.normalised.map(|v| format!("{v:.4}")));
        row.extend(liu.weights.map(|w| w.to_string()));
        row.extend(again.map(|w| format!("{w:.4}")));
        row.push(format!("{off:.4}"));
        row.push(if off > ROUNDED { "the table contradicts itself" } else { "" }.to_owned());
        rows.push(row);
    }
    print!("{}", aligned(&rows));
    Ok(())
}
