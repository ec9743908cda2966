//! Lines that meet end to end as one.

use crate::geometry::{Path, Vec2};

/// Ends nearer than this (metres) meet: a tenth of a millimetre is beyond what any program rounds.
pub(super) const MEET: f64 = 1e-4;

/// The strokes in an order and direction in which each begins where the one before it ends, as far as they do: a list
/// per run. A run whose ends meet is closed.
pub fn chained<T: Clone>(strokes: &[(T, Path)]) -> Vec<Vec<(T, Path)>> {
    let mut left: Vec<Option<(T, Path)>> = strokes.iter().cloned().map(Some).collect();
    let mut runs = Vec::new();
    for first in 0..left.len() {
        let Some(seed) = left[first].take() else { continue };
        let mut run = vec![seed];
        while !is_closed(&run) && grow(&mut run, &mut left) {}
        runs.push(run);
    }
    runs
}

/// Whether a run ends where it begins.
pub(super) fn is_closed<T>(run: &[(T, Path)]) -> bool {
    match (run.first(), run.last()) {
        (Some(first), Some(last)) => (first.1.start() - last.1.end()).norm() <= MEET,
        _ => false,
    }
}

/// Adds one of `left` to an end of the run.
fn grow<T: Clone>(run: &mut Vec<(T, Path)>, left: &mut [Option<(T, Path)>]) -> bool {
    let (Some(start), Some(end)) = (run.first().map(|r| r.1.start()), run.last().map(|r| r.1.end())) else {
        return false;
    };
    let near = |a: Vec2, b: Vec2| (a - b).norm() <= MEET;
    for slot in left.iter_mut() {
        let Some((_, path)) = &*slot else { continue };
        let (from, to) = (path.start(), path.end());
        let (after, turned) = if near(from, end) {
            (true, false)
        } else if near(to, end) {
            (true, true)
        } else if near(to, start) {
            (false, false)
        } else if near(from, start) {
            (false, true)
        } else {
            continue;
        };
        let Some((name, path)) = slot.take() else { continue };
        let path = if turned { path.reversed() } else { path };
        if after {
            run.push((name, path));
        } else {
            run.insert(0, (name, path));
        }
        return true;
    }
    false
}
