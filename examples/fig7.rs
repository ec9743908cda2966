//! Fig. 7 of Liu, Wang & Luo 2015: 2,601 vertices over a ball, drawn along the diagonal, and in wrinkles.
//!
//! `cargo run --release --example fig7` prints the numbers with the bars they must meet and draws
//! `out/experiments/fig7_ball.png`, `fig7_diagonal.png` and `fig7_wrinkles.png`. docs/papers.md says how the
//! experiments are read.

mod common;

use std::error::Error;

use common::fig7::{balls, pulls, wrinkled};

fn main() -> Result<(), Box<dyn Error>> {
    for figure in [balls()?, pulls()?, wrinkled()?] {
        figure.show()?;
        println!();
    }
    Ok(())
}
