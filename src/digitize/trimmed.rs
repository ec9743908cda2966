//! Lines on a piece that are drawn on into its allowance: of these its cloth has the part within the sewing line.

use crate::geometry::{Path, Vec2, bisect};

/// Distance between examined points of a line, metres.
const STEP: f64 = 5e-3;
/// Most points at which a line is examined.
const MOST_LOOKS: f64 = 400.0;
/// Halvings that find the place where a line leaves the cloth, to far below a micrometre.
const HALVINGS: usize = 24;

/// A line, whose middle is on the cloth, which `holds` tells, without the ends that are not. Over darts and holes it
/// goes on.
pub(super) fn trimmed(line: &Path, holds: impl Fn(Vec2) -> bool) -> Path {
    let length = line.length();
    let looks = (0.5 * length / STEP).clamp(2.0, MOST_LOOKS).ceil();
    // How far from its middle it comes to an end in one direction.
    let reach = |sign: f64| {
        let at = |way: f64| line.point(0.5 * length + sign * way);
        let way = |k: usize| 0.5 * length * k as f64 / looks;
        let last = (1..=looks as usize).rev().find(|&k| holds(at(way(k)))).unwrap_or(0);
        let ends = last < looks as usize;
        ends.then(|| bisect([way(last), way(last + 1)], HALVINGS, |way| if holds(at(way)) { -1.0 } else { 1.0 }))
    };
    match [reach(-1.0), reach(1.0)] {
        [None, None] => line.clone(),
        [back, on] => line.part(0.5 * length - back.unwrap_or(0.5 * length), 0.5 * length + on.unwrap_or(0.5 * length)),
    }
}

/// Parts shorter than this (metres) are the line's touching the cloth.
const LEAST_PART: f64 = 1e-3;
/// As far off the cloth as this (metres) lines are on its rim.
const ON_RIM: f64 = 5e-4;
/// Accuracy with which a line is cut off where it leaves the cloth, metres.
const EXACT: f64 = 1e-7;

/// The parts of a line that are on the cloth, of which `off` tells how far a point is from it, nought on it. The line
/// itself where all of it is.
pub(crate) fn parts_within(line: &Path, off: impl Fn(Vec2) -> f64) -> Vec<Path> {
    let length = line.length();
    let looks = (length / STEP).clamp(4.0, MOST_LOOKS).ceil() as usize;
    let place = |k: usize| length * k as f64 / looks as f64;
    let away: Vec<f64> = (0..=looks).map(|k| off(line.point(place(k)))).collect();
    let on = |k: usize| away[k] <= ON_RIM;
    if (0..=looks).all(on) {
        return vec![line.clone()];
    }
    let edge = |k: usize| {
        // What runs along the rim leaves it where it is no longer near it.
        let rim = if away[k].min(away[k + 1]) <= EXACT { EXACT } else { ON_RIM };
        let sign = if on(k) { -1.0 } else { 1.0 };
        bisect([place(k), place(k + 1)], HALVINGS, |at| if off(line.point(at)) <= rim { sign } else { -sign })
    };
    let mut parts = Vec::new();
    let mut from = on(0).then_some(0.0);
    for k in 0..looks {
        match (on(k), on(k + 1)) {
            (false, true) => from = Some(edge(k)),
            (true, false) => parts.extend(from.take().map(|from| [from, edge(k)])),
            _ => {}
        }
    }
    parts.extend(from.map(|from| [from, length]));
    parts.into_iter().filter(|[from, to]| to - from >= LEAST_PART).map(|[from, to]| line.part(from, to)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_where_the_cloth_does() {
        let line = Path::line(Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0));
        assert_eq!(trimmed(&line, |_| true).length(), line.length());
        let part = trimmed(&line, |p| (0.123..=0.8).contains(&p.x));
        assert!((part.start().x - 0.123).abs() < 1e-6 && (part.end().x - 0.8).abs() < 1e-6, "{part:?}");
        let part = trimmed(&line, |p| p.x <= 0.9 && !(0.2..0.3).contains(&p.x));
        assert!(part.start().x == 0.0 && (part.end().x - 0.9).abs() < 1e-6, "{part:?}");
    }
    #[test]
    fn of_a_line_that_leaves_the_cloth_the_parts_on_it_stay() {
        let line = Path::line(Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0));
        let parts = parts_within(&line, |p| (0.1 - p.x).max(p.x - 0.2).min(0.7 - p.x).max(0.0));
        let ends: Vec<[f64; 2]> = parts.iter().map(|p| [p.start().x, p.end().x]).collect();
        let wanted = [[0.1, 0.2], [0.7, 1.0]];
        assert!(ends.len() == 2, "{ends:?}");
        for (found, wanted) in ends.iter().flatten().zip(wanted.iter().flatten()) {
            assert!((found - wanted).abs() < 1e-6, "{ends:?}");
        }
        assert_eq!(parts_within(&line, |_| 0.0), vec![line.clone()]);
        assert!(parts_within(&line, |_| 1.0).is_empty());
    }
}
