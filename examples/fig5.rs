//! Fig. 5 of Liu, Wang & Luo 2015: one sheet of 2,000 vertices in fifteen fabrics.
//!
//! `cargo run --release --example fig5` prints the numbers with the bars they must meet and draws
//! `out/experiments/fig5.png`. docs/papers.md says how the experiment is read.

mod common;

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    common::fig5::figure()?.show()
}
