//! Where lines and edges of a piece cross.

use crate::geometry::{Path, Vec2};
use crate::pattern::SLACK;

/// Distance within which the end of a line counts as lying on the rim, on a corner or on another line, metres. `check`
/// uses the same.
pub(super) const REACHES: f64 = SLACK;
/// Length of the chords in which lines are searched for crossings, metres: shorter than any bend of a sewn line.
const CHORD: f64 = 2.5e-3;
/// Newton steps that refine a crossing. Each doubles the number of correct digits.
const POLISH: usize = 4;

/// A path and its chords.
pub(super) struct Chords<'a> {
    path: &'a Path,
    /// Arc lengths and points that cut it. A straight path is its own chord.
    cuts: Vec<(f64, Vec2)>,
}

impl<'a> Chords<'a> {
    pub(super) fn new(path: &'a Path) -> Self {
        let length = path.length();
        let n = if path.is_straight() { 1 } else { (length / CHORD).ceil().max(1.0) as usize };
        let cuts = (0..=n).map(|k| length * k as f64 / n as f64).map(|s| (s, path.point(s))).collect();
        Self { path, cuts }
    }

    /// Arc lengths on this path and the other where they cross.
    pub(super) fn crossings(&self, other: &Self) -> Vec<(f64, f64)> {
        let mut found = Vec::new();
        for v in self.cuts.windows(2) {
            for w in other.cuts.windows(2) {
                if let Some((x, y)) = segments_cross([v[0].1, v[1].1], [w[0].1, w[1].1]) {
                    let (s, t) = (v[0].0 + x * (v[1].0 - v[0].0), w[0].0 + y * (w[1].0 - w[0].0));
                    found.push(polish(self.path, other.path, s, t));
                }
            }
        }
        found
    }
}

/// Shares along both segments where they cross.
fn segments_cross(a: [Vec2; 2], b: [Vec2; 2]) -> Option<(f64, f64)> {
    let (d, e, gap) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let det = d.perp(&e);
    let (x, y) = (gap.perp(&e) / det, gap.perp(&d) / det);
    let within = |t: f64| (0.0..=1.0).contains(&t);
    (within(x) && within(y)).then_some((x, y))
}

/// Newton's method on a(s) = b(t).
fn polish(a: &Path, b: &Path, mut s: f64, mut t: f64) -> (f64, f64) {
    for _ in 0..POLISH {
        let (gap, d, e) = (b.point(t) - a.point(s), a.tangent(s), b.tangent(t));
        let det = d.perp(&e);
        if det.abs() < 1e-6 {
            break;
        }
        s = (s + gap.perp(&e) / det).clamp(0.0, a.length());
        t = (t + gap.perp(&d) / det).clamp(0.0, b.length());
    }
    (s, t)
}
