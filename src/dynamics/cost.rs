//! What contact costs, part by part.

use std::time::{Duration, Instant};

/// Wall-clock time spent on finding contacts and following them. Their forces are not in it, which are worked out
/// with all others, nor the bounds that every step is held to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactTime {
    /// Looking for the body near particles.
    pub body: Duration,
    /// Looking for its vertices and edges near triangles and edges of the cloth.
    pub features: Duration,
    /// Looking for cloth near cloth.
    pub cloth: Duration,
    /// Between two looks: telling which of them matter, turned to where their closest points have gone.
    pub follow: Duration,
}

/// What `work` gives; `total` grows by the time it takes.
pub(super) fn timed<T>(total: &mut Duration, work: impl FnOnce() -> T) -> T {
    let begin = Instant::now();
    let out = work();
    *total += begin.elapsed();
    out
}
