//! Wall-clock time of contact, part by part.

use std::time::{Duration, Instant};

/// Wall-clock time spent on finding and following contacts. It excludes their forces, which are evaluated with all
/// others, and the bounds of every step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactTime {
    /// Search for the body near particles.
    pub body: Duration,
    /// Search for vertices and edges of the body near triangles and edges of the cloth.
    pub features: Duration,
    /// Search for cloth near cloth.
    pub cloth: Duration,
    /// Between two searches: selecting the contacts that matter, and updating their closest points.
    pub follow: Duration,
}

/// Runs `work`, adds its time to `total` and returns its result.
pub(super) fn timed<T>(total: &mut Duration, work: impl FnOnce() -> T) -> T {
    let begin = Instant::now();
    let out = work();
    *total += begin.elapsed();
    out
}
