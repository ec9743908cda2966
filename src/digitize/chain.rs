//! Lines that meet end to end as one.

use crate::geometry::{Path, Vec2};

/// Distance within which ends meet, metres: a tenth of a millimetre is more than the rounding of any program.
pub(super) const MEET: f64 = 1e-4;

/// Ends of one outline no farther apart than this (metres) were meant to meet: half a millimetre, a pencil's line.
const BRIDGE: f64 = 5e-4 + 1e-9;
/// Widest gap over which an outline is suspected, metres.
const GAPING: f64 = 0.03;
/// A run is closed onto itself over no more than this share of its length.
const ITSELF: f64 = 0.25;
/// A line of less (metres) is none.
const LEAST: f64 = 1e-8;
/// Among more open runs than this nobody looks for ends that nearly meet.
const MOST_RUNS: usize = 400;

/// Whether two ends may be joined.
pub(crate) fn nearly_meet(a: Vec2, b: Vec2) -> bool {
    (a - b).norm() <= BRIDGE
}

/// Runs of which ends that nearly meet are joined by a straight line.
pub struct Bridged<T> {
    /// The runs.
    pub runs: Vec<Vec<(T, Path)>>,
    /// Middle and width of every gap that was closed, metres.
    pub gaps: Vec<(Vec2, f64)>,
}

/// Joins the runs whose ends nearly meet, the nearest first.
pub fn bridged<T: Clone>(runs: Vec<Vec<(T, Path)>>) -> Bridged<T> {
    bridged_over(runs, BRIDGE)
}

/// An outline that would close if wider gaps were closed as well.
pub struct Gaping<T> {
    /// Its lines, each with the path that closes it.
    pub run: Vec<(T, Path)>,
    /// Middle and width of its widest gap, metres.
    pub widest: (Vec2, f64),
}

impl<T> Gaping<T> {
    /// Area inside if it were closed straight across, m².
    pub fn area(&self) -> f64 {
        0.5 * self.run.iter().map(|(_, path)| path.double_area()).sum::<f64>().abs()
    }
}

/// Outlines that runs would make if gaps were closed that are too wide to count as meeting ends. They are faults of a
/// drawing, not content.
pub fn gaping<T: Clone>(runs: Vec<Vec<(T, Path)>>) -> Vec<Gaping<T>> {
    let Bridged { runs, gaps } = bridged_over(runs, GAPING);
    let closed = runs.into_iter().filter(|run| is_closed(run));
    let outline = |run: Vec<(T, Path)>| {
        let is_own = |at: Vec2| run.iter().any(|(_, path)| path.nearest(at).1 <= LEAST);
        let own = gaps.iter().filter(|(at, gap)| *gap > BRIDGE && is_own(*at));
        let widest = own.max_by(|a, b| a.1.total_cmp(&b.1)).copied()?;
        Some(Gaping { run, widest })
    };
    closed.filter_map(outline).collect()
}

fn bridged_over<T: Clone>(runs: Vec<Vec<(T, Path)>>, reach: f64) -> Bridged<T> {
    let (mut open, mut done): (Vec<_>, Vec<_>) = runs.into_iter().partition(|run| !is_closed(run));
    let mut gaps = Vec::new();
    while open.len() <= MOST_RUNS
        && let Some((gap, [one, other])) = nearest_ends(&open, reach)
    {
        let [a, b] = [one, other].map(|(run, at_end)| end_of(&open[run], at_end));
        gaps.push(((a + b) / 2.0, gap));
        let second = (one.0 != other.0).then(|| open.remove(other.0));
        let first = open.remove(one.0);
        match second {
            None => {
                let to = first[0].1.start();
                done.push(led_on(first, to));
            }
            Some(second) => {
                let first = if one.1 { first } else { turned(first) };
                let second = if other.1 { turned(second) } else { second };
                let to = second[0].1.start();
                open.push([led_on(first, to), second].concat());
            }
        }
    }
    done.extend(open);
    Bridged { runs: done, gaps }
}

/// A run by its number, and whether it is its end rather than its start.
type End = (usize, bool);

/// The two ends of runs that are nearest to each other, if within reach. The earlier run first.
fn nearest_ends<T>(runs: &[Vec<(T, Path)>], reach: f64) -> Option<(f64, [End; 2])> {
    let mut best: Option<(f64, [End; 2])> = None;
    for i in 0..runs.len() {
        for j in i..runs.len() {
            for (a, b) in [(true, false), (true, true), (false, false), (false, true)] {
                // A run has but one way to meet itself.
                if i == j && (a, b) != (true, false) {
                    continue;
                }
                let [p, q] = [end_of(&runs[i], a), end_of(&runs[j], b)];
                let gap = (p - q).norm();
                if gap > reach {
                    continue;
                }
                // A line is not closed onto itself over a gap as long as it is.
                let near = i != j || gap <= ITSELF * runs[i].iter().map(|(_, path)| path.length()).sum::<f64>();
                if near && best.is_none_or(|(least, _)| gap < least) {
                    best = Some((gap, [(i, a), (j, b)]));
                }
            }
        }
    }
    best
}

/// Start or end of a run, which is never empty.
fn end_of<T>(run: &[(T, Path)], at_end: bool) -> Vec2 {
    if at_end { run[run.len() - 1].1.end() } else { run[0].1.start() }
}

fn turned<T>(run: Vec<(T, Path)>) -> Vec<(T, Path)> {
    run.into_iter().rev().map(|(what, path)| (what, path.reversed())).collect()
}

/// The run, its last line led straight on to a point.
fn led_on<T>(mut run: Vec<(T, Path)>, to: Vec2) -> Vec<(T, Path)> {
    if let Some((_, path)) = run.last_mut()
        && (path.end() - to).norm() > LEAST
    {
        *path = path.joined(&Path::line(path.end(), to));
    }
    run
}

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
