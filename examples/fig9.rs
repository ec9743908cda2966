//! Fig. 9 of Liu, Wang & Luo 2015: a skirt in wool and in ramie.
//!
//! `cargo run --release --example fig9` prints the numbers with the bars they must meet and draws
//! `out/experiments/fig9.png`. docs/papers.md says how the experiment is read.

mod common;

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    common::fig9::figure()?.show()
}
