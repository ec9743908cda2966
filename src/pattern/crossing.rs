//! Outlines that cross themselves or their holes.

use super::Edge;
use crate::geometry::{Path, Vec2, encloses};

/// Largest distance of a curve from the chords that replace it in the search, metres.
pub(super) const CHORD_ERROR: f64 = 2e-5;

struct Chord {
    ends: [Vec2; 2],
    ring: usize,
    /// Position in the ring, and the ring's number of chords.
    index: usize,
    edge: usize,
}

/// First crossing of two edges of a piece: the point, and (ring, index) of both.
pub(super) fn first_crossing(rings: &[Vec<Edge>]) -> Option<(Vec2, [(usize, usize); 2])> {
    let mut chords = Vec::new();
    let mut counts = Vec::new();
    for (ring, edges) in rings.iter().enumerate() {
        let before = chords.len();
        for (edge, e) in edges.iter().enumerate() {
            for ends in self::chords(&e.path) {
                chords.push(Chord { ends, ring, index: chords.len() - before, edge });
            }
        }
        counts.push(chords.len() - before);
    }
    // Sweep in x: only chords whose x ranges overlap are compared.
    let low = |c: &Chord| c.ends[0].x.min(c.ends[1].x);
    let high = |c: &Chord| c.ends[0].x.max(c.ends[1].x);
    chords.sort_by(|a, b| low(a).total_cmp(&low(b)));
    for (i, a) in chords.iter().enumerate() {
        for b in chords[i + 1..].iter().take_while(|b| low(b) <= high(a)) {
            if a.ring == b.ring && neighbours(a.index, b.index, counts[a.ring]) {
                continue;
            }
            if let Some(point) = intersection(a.ends, b.ends) {
                return Some((point, [(a.ring, a.edge), (b.ring, b.edge)]));
            }
        }
    }
    None
}

/// First crossing of a closed row of paths with itself: the point, and the numbers of both paths.
pub(crate) fn loop_crossing(paths: &[Path]) -> Option<(Vec2, [usize; 2])> {
    let edge = |path: &Path| Edge { name: String::new(), path: path.clone(), against: false };
    first_crossing(&[paths.iter().map(edge).collect()]).map(|(at, [one, other])| (at, [one.1, other.1]))
}

fn neighbours(i: usize, j: usize, count: usize) -> bool {
    let apart = i.abs_diff(j);
    apart <= 1 || apart == count - 1
}

/// Crossing point of two segments, touching included.
fn intersection(a: [Vec2; 2], b: [Vec2; 2]) -> Option<Vec2> {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let det = u.perp(&v);
    if det.abs() <= 1e-12 * u.norm() * v.norm() {
        return None;
    }
    let (s, t) = (w.perp(&v) / det, w.perp(&u) / det);
    let inside = |x: f64| (-1e-9..=1.0 + 1e-9).contains(&x);
    (inside(s) && inside(t)).then(|| a[0] + u * s)
}

/// Whether `point` lies inside the ring.
pub(super) fn contains(ring: &[Edge], point: Vec2) -> bool {
    encloses(ring.iter().flat_map(|edge| chords(&edge.path)), point)
}

/// A path as chords, which leave it by at most [`CHORD_ERROR`].
pub(super) fn chords(path: &Path) -> Vec<[Vec2; 2]> {
    path.sampled(CHORD_ERROR).windows(2).map(|w| [w[0], w[1]]).collect()
}
