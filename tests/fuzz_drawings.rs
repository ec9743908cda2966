//! Readers of foreign files under random damage: whatever stands in a file, there is an answer, in bounded time and
//! memory, and what is made of it is a garment file that can be read.
//!
//! Every run tries some hundred damaged files, the same ones each time. `TOILE_FUZZ_SECONDS=600 cargo test --release
//! --test fuzz_drawings` goes on with others for so long.

#[path = "fuzz/damage.rs"]
mod damage;
#[path = "fuzz/dxf.rs"]
mod dxf;
#[path = "fuzz/svg.rs"]
mod svg;

use std::time::{Duration, Instant};

use damage::Damage;

/// Files that are tried in any case.
const ROUNDS: u64 = 400;
/// Longest that one file may take: seconds where milliseconds are usual, for the machine may be busy.
const LONGEST: Duration = Duration::from_secs(20);

/// Damages `seeds` in turn and hands them to `read`.
fn shake(seeds: &[&str], read: impl Fn(&str)) {
    let more = std::env::var("TOILE_FUZZ_SECONDS")
        .ok()
        .and_then(|s| s.parse().ok())
        .map_or(Duration::ZERO, Duration::from_secs);
    let begin = Instant::now();
    let mut round = 0;
    while round < ROUNDS || begin.elapsed() < more {
        let mut damage = Damage::new(round);
        let text = damage.of(seeds[round as usize % seeds.len()]);
        let start = Instant::now();
        read(&text);
        assert!(start.elapsed() < LONGEST, "round {round} took {:?}: {text}", start.elapsed());
        round += 1;
    }
}
