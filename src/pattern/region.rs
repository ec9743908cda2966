//! The region of a piece's cloth.

use super::Edge;
use super::crossing::chords;
use crate::geometry::{Path, Vec2, encloses};

/// Distance from the cloth within which a point counts as lying on its rim, metres.
pub(crate) const SLACK: f64 = 1e-3;
/// Distance between examined points of lines and edges, metres.
const STEP: f64 = 5e-3;
/// Most points at which a line is examined, however long it is.
const MOST_LOOKS: f64 = 400.0;

/// The cloth within an outline, less the holes in it.
pub(crate) struct Region<'a> {
    rings: &'a [Vec<Edge>],
    /// Each ring as chords.
    chords: Vec<Vec<[Vec2; 2]>>,
}

impl<'a> Region<'a> {
    /// The region of an outline and the holes that follow it.
    pub(crate) fn new(rings: &'a [Vec<Edge>]) -> Self {
        let ring = |edges: &Vec<Edge>| edges.iter().flat_map(|e| chords(&e.path)).collect();
        Self { rings, chords: rings.iter().map(ring).collect() }
    }

    /// Whether there is cloth at `p`, or its rim.
    pub(crate) fn holds(&self, p: Vec2) -> bool {
        let within = |(k, chords): (usize, &Vec<[Vec2; 2]>)| encloses(chords.iter().copied(), p) == (k == 0);
        self.chords.iter().enumerate().all(within)
            || self.rings.iter().flatten().any(|edge| edge.path.nearest(p).1 <= SLACK)
    }
}

/// The first examined point of `path` that is nowhere near cloth according to `holds`.
pub(super) fn first_off(path: &Path, holds: impl Fn(Vec2) -> bool) -> Option<Vec2> {
    let length = path.length();
    let looks = looks(length);
    (0..=looks).map(|i| path.point(length * i as f64 / looks as f64)).find(|&p| !holds(p))
}

/// Number of examined points of a line of this length (metres).
pub(super) fn looks(length: f64) -> usize {
    (length / STEP).clamp(2.0, MOST_LOOKS).ceil() as usize
}
