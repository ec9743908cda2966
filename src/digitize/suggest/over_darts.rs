//! Darts in an outline: their legs, and what goes on over them once they are sewn.

use std::f64::consts::PI;

use super::Outline;
use super::corner::{is_fold, turn_before};
use crate::digitize::edges::CORNER;
use crate::geometry::{Path, Vec2};

/// Legs of a dart differ by less (metres), and the angle inside the piece between them is within this (250 to 355
/// degrees): where it is a full turn, it is a slit.
const LEGS_APART: f64 = 1e-3;
const DART: std::ops::Range<f64> = 250.0 / 180.0 * PI..355.0 / 180.0 * PI;

/// Whether two lines of these lengths, with this angle inside the piece between them, are the legs of a dart.
pub(super) fn are_legs([a, b]: [f64; 2], angle: f64) -> bool {
    DART.contains(&angle) && (a - b).abs() <= LEGS_APART
}

/// The parts of an outline, those joined that a dart between them brings together without a corner.
pub(super) fn over_darts(outline: &Outline, parts: Vec<Vec<usize>>) -> Vec<Vec<usize>> {
    let count = parts.len();
    // A dart has two legs and something beside each.
    if count < 4 {
        return parts;
    }
    let is_dart = |k: usize| {
        let [a, b] = [&parts[k % count], &parts[(k + 1) % count]];
        let length = |part: &[usize]| part.iter().map(|&edge| outline.edges[edge].path.length()).sum::<f64>();
        are_legs([length(a), length(b)], PI - turn_before(outline, b[0]))
    };
    // Neighbours of legs are no legs: of a zigzag nothing is known.
    let dart: Vec<bool> = (0..count).map(|k| is_dart(k) && !is_dart(k + count - 1) && !is_dart(k + 1)).collect();
    let goes_on = |k: usize| {
        let [a, b] = [&parts[(k + count - 1) % count], &parts[(k + 2) % count]];
        dart[k] && !is_fold(outline, a[0]) && !is_fold(outline, b[0]) && is_smooth(outline, a[a.len() - 1], b[0])
    };
    let joined: Vec<bool> = (0..count).map(goes_on).collect();
    let is_leg = |k: usize| dart[k] || dart[(k + count - 1) % count];
    // Begin where nothing goes on.
    let Some(first) = (0..count).find(|&k| !is_leg(k) && !joined[(k + count - 2) % count]) else { return parts };
    let at = |i: usize| (first + i) % count;
    let (mut done, mut legs, mut i) = (Vec::new(), Vec::new(), 0);
    while i < count {
        let mut part = parts[at(i)].clone();
        i += 1;
        while i + 2 < count && joined[at(i)] {
            legs.extend([parts[at(i)].clone(), parts[at(i + 1)].clone()]);
            part.extend(&parts[at(i + 2)]);
            i += 3;
        }
        done.push(part);
    }
    done.extend(legs);
    done
}

/// Whether an edge follows another one, so that no dart is between them.
pub(super) fn follows(outline: &Outline, edge: usize, next: usize) -> bool {
    (edge + 1) % outline.edges.len() == next
}

/// The tip of the dart between two edges: where the outline turns most.
fn tip_between(outline: &Outline, edge: usize, next: usize) -> Vec2 {
    let count = outline.edges.len();
    let between = (edge + 2..edge + count).map(|k| k % count).take_while(|&k| k != next);
    let sharpest = between.max_by(|&i, &k| turn_before(outline, i).abs().total_cmp(&turn_before(outline, k).abs()));
    outline.edges[sharpest.unwrap_or(next)].path.start()
}

/// The turn about a point that brings one point to the direction of another: its matrix and its shift.
fn turned(about: Vec2, from: Vec2, to: Vec2) -> (nalgebra::Matrix2<f64>, Vec2) {
    let (a, b) = (from - about, to - about);
    let turn = nalgebra::Rotation2::rotation_between(&a, &b);
    (*turn.matrix(), about - turn * about)
}

/// The course of edges with the darts between them closed.
pub(super) fn closed_course(outline: &Outline, edges: &[usize]) -> Option<Path> {
    let mut course: Option<(usize, Path)> = None;
    for &edge in edges {
        let own = &outline.edges[edge].path;
        let path = match course {
            None => own.clone(),
            Some((last, path)) if follows(outline, last, edge) => path.joined(own),
            Some((last, path)) => {
                let (linear, shift) = turned(tip_between(outline, last, edge), path.end(), own.start());
                path.mapped(linear, shift).joined(own)
            }
        };
        course = Some((edge, path));
    }
    course.map(|(_, path)| path)
}

/// Whether two edges with a dart between them make no corner once that is closed.
fn is_smooth(outline: &Outline, edge: usize, next: usize) -> bool {
    let (a, b) = (&outline.edges[edge].path, &outline.edges[next].path);
    let (linear, _) = turned(tip_between(outline, edge, next), a.end(), b.start());
    let (from, to) = (linear * a.tangent(a.length()), b.tangent(0.0));
    from.perp(&to).atan2(from.dot(&to)).abs() <= CORNER
}
