//! Fig. 6 of Liu, Wang & Luo 2015: the shape does not depend on the mesh.
//!
//! `cargo run --release --example fig6` prints the numbers with the bars they must meet and draws
//! `out/experiments/fig6.png`. docs/papers.md says how the experiment is read.

mod common;

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    common::fig6::figure()?.show()
}
