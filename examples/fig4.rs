//! Fig. 4 of Liu, Wang & Luo 2015: each term of the energy added to the last, on 961 vertices.
//!
//! `cargo run --release --example fig4` prints the numbers with the bars they must meet and draws
//! `out/experiments/fig4.png`. docs/papers.md says how the experiment is read.

mod common;

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    common::fig4::figure()?.show()
}
