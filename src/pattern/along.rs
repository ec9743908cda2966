//! The parts of a line that run along the edges of its piece.

use super::Edge;
use super::region::{SLACK, looks};
use crate::geometry::{Path, Vec2, box_of};

/// Least |cosine| between a stretch of an edge and a line that runs along it, in the same or the opposite direction.
/// Only stretches hardly longer than the slack could lie across a line and still be near it.
const SAME_WAY: f64 = 0.7;

/// A stretch of an edge that a line runs along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Ring of the edge, and its number in the ring.
    pub edge: (usize, usize),
    /// Arc length on the edge where the line comes to it, metres.
    pub from: f64,
    /// Arc length on the edge where the line leaves it, metres. It is less than `from` if the line runs against the
    /// edge.
    pub to: f64,
    /// Arc lengths on the line of both, metres.
    pub line: [f64; 2],
}

/// The stretches of edges that `line` runs along, to a millimetre, in the line's order. A stretch ends at ends of the
/// edge and where the line has its ends and corners.
pub fn along(line: &Path, loops: &[Vec<Edge>]) -> Vec<Along> {
    let edges = loops
        .iter()
        .enumerate()
        .flat_map(|(ring, edges)| edges.iter().enumerate().map(move |(index, edge)| ((ring, index), &edge.path)));
    let beside = reach(line);
    let mut out: Vec<Along> =
        edges.filter(|(_, path)| overlap(beside, reach(path))).flat_map(|(id, path)| on_edge(line, id, path)).collect();
    out.sort_by(|a, b| a.line[0].total_cmp(&b.line[0]));
    out
}

/// The corners of a box beyond which nothing runs along a path.
fn reach(path: &Path) -> [Vec2; 2] {
    // As much again for what the path has beyond the chords.
    let [low, high] = box_of(path.sampled(SLACK));
    [low.add_scalar(-2.0 * SLACK), high.add_scalar(2.0 * SLACK)]
}

fn overlap(a: [Vec2; 2], b: [Vec2; 2]) -> bool {
    (0..2).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}

fn on_edge(line: &Path, edge: (usize, usize), path: &Path) -> Vec<Along> {
    let length = path.length();
    let joints = line.joints().iter().map(|&t| path.nearest(line.point(t))).filter(|near| near.1 <= SLACK);
    let within = joints.map(|near| near.0).filter(|s| (SLACK..=length - SLACK).contains(s));
    let mut cuts: Vec<f64> = [0.0, length].into_iter().chain(within).collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup_by(|b, a| *b - *a < SLACK);
    cuts.windows(2).filter_map(|w| stretch(line, path, [w[0], w[1]])).map(|found| Along { edge, ..found }).collect()
}

/// The stretch of an edge, if all of it lies on the line.
fn stretch(line: &Path, path: &Path, [low, high]: [f64; 2]) -> Option<Along> {
    let looks = looks(high - low);
    let near = |k: usize| line.nearest(path.point(low + (high - low) * k as f64 / looks as f64)).1 <= SLACK;
    if !(0..=looks).all(near) {
        return None;
    }
    let middle = (low + high) / 2.0;
    let (at, half) = (line.nearest(path.point(middle)).0, (high - low) / 2.0);
    let cosine = path.tangent(middle).dot(&line.tangent(at));
    let (from, to) = if cosine > 0.0 { (low, high) } else { (high, low) };
    (cosine.abs() >= SAME_WAY).then_some(Along { edge: (0, 0), from, to, line: [at - half, at + half] })
}
