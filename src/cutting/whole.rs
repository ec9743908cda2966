//! Pieces as they are cut: folds opened, both of a pair, every copy.

use nalgebra::Matrix2;

use super::{Mark, MarkKind, NotchMark, Paper, SewLine};
use crate::geometry::Vec2;
use crate::pattern::{CutKind, DrawnPiece};

/// A point within this (metres) of the fold's line is on it.
const ON_FOLD: f64 = 1e-6;

/// The half of a whole piece's contour to the right of its fold. Contours that the fold cuts are open along it. `None`
/// if nothing lies there.
pub(super) fn halved(contour: &[Vec2], [start, end]: [Vec2; 2]) -> Option<Vec<Vec2>> {
    let along = (end - start).normalize();
    let points = with_crossings(contour, |p| along.perp(&(p - start)));
    let aside: Vec<f64> = points.iter().map(|p| along.perp(&(p - start))).collect();
    if aside.iter().all(|&d| d > -ON_FOLD) {
        return Some(points);
    }
    let reach = |i: &usize| along.dot(&(points[*i] - start));
    let on_fold = || (0..points.len()).filter(|&i| aside[i].abs() < ON_FOLD);
    let first = on_fold().min_by(|a, b| reach(a).total_cmp(&reach(b)))?;
    let last = on_fold().max_by(|a, b| reach(a).total_cmp(&reach(b)))?;
    let stretch = |from: usize, to: usize| from..=if to < from { to + points.len() } else { to };
    let beside = |from: usize, to: usize| stretch(from, to).map(|k| aside[k % points.len()]).fold(0.0, f64::max);
    let (from, to) = if beside(last, first) >= beside(first, last) { (last, first) } else { (first, last) };
    let mut half: Vec<Vec2> = stretch(from, to).map(|k| points[k % points.len()]).collect();
    // Rounding has left both ends beside the fold.
    for k in [0, half.len() - 1] {
        half[k] = start + along * along.dot(&(half[k] - start));
    }
    (half.len() > 2).then_some(half)
}

/// A contour with a point wherever it crosses the line from which `aside` is the signed distance.
fn with_crossings(contour: &[Vec2], aside: impl Fn(&Vec2) -> f64) -> Vec<Vec2> {
    let mut points = Vec::new();
    for (a, b) in contour.iter().zip(contour.iter().cycle().skip(1)) {
        points.push(*a);
        let (from, to) = (aside(a), aside(b));
        if from.abs().min(to.abs()) >= ON_FOLD && from * to < 0.0 {
            points.push(a + (b - a) * (from / (from - to)));
        }
    }
    points
}

/// The papers of one drawing, each cut once. Lettering is not carried over.
pub(super) fn as_cut(paper: &Paper, drawing: &DrawnPiece) -> Vec<Paper> {
    let named = |name: String, of: &Paper| Paper {
        name,
        count: "cut 1".to_owned(),
        quantity: 1,
        mirrored: false,
        drawn: None,
        ..of.clone()
    };
    match &drawing.cut {
        CutKind::One => vec![named(paper.name.clone(), paper)],
        CutKind::Count(n) => (1..=*n).map(|k| named(format!("{}.{k}", paper.name), paper)).collect(),
        CutKind::Pair => {
            let other = paper.mapped(Matrix2::new(-1.0, 0.0, 0.0, 1.0), Vec2::zeros());
            let sided = |p: &Paper, side: crate::pattern::Side| named(format!("{}{}", p.name, side.suffix()), p);
            vec![sided(paper, drawing.drawn), sided(&other, drawing.drawn.other())]
        }
        CutKind::Fold(_) => vec![named(paper.name.clone(), &unfolded(paper, drawing))],
    }
}

fn unfolded(paper: &Paper, drawing: &DrawnPiece) -> Paper {
    let Some([from, to]) = paper.fold else { return paper.clone() };
    let along = (to - from).normalize();
    let linear = 2.0 * along * along.transpose() - Matrix2::identity();
    let other = paper.mapped(linear, from - linear * from);
    let sides = [drawing.drawn, drawing.drawn.other()].map(|s| s.letter());
    let mut whole = paper.clone();
    whole.fold = None;
    whole.cut.clear();
    for (half, image) in paper.cut.iter().zip(&other.cut) {
        whole.cut.extend(unfolded_contour(half, image, |p| along.perp(&(p - from)).abs() < ON_FOLD));
    }
    let sided = |lines: &[SewLine], side: &str| -> Vec<SewLine> {
        lines.iter().map(|s| SewLine { name: format!("{}.{side}", s.name), ..s.clone() }).collect()
    };
    whole.sew = [sided(&paper.sew, sides[0]), sided(&other.sew, sides[1])].concat();
    // A notch on the fold is its own mirror image. A double one is not, even if one of its marks is.
    let is_one = |n: &&NotchMark| paper.notches.iter().any(|own| (own.at - n.at).norm() < 1e-6);
    let new_notch = |n: &&NotchMark| n.kind.is_double() || !is_one(n);
    let on_side = |n: &NotchMark, side: &str| NotchMark { edge: format!("{}.{side}", n.edge), ..n.clone() };
    whole.notches = paper.notches.iter().map(|n| on_side(n, sides[0])).collect();
    whole.notches.extend(other.notches.iter().filter(new_notch).map(|n| on_side(n, sides[1])));
    whole.marks.retain(|m| m.kind != MarkKind::Fold);
    let lines = other.marks.iter().filter(|m| m.kind != MarkKind::Fold);
    // A line along the fold is its own mirror image.
    let elsewhere = |m: &&Mark| {
        let off = |p: Vec2| along.perp(&(p - from)).abs() > 1e-6;
        off(m.path.start()) || off(m.path.end())
    };
    whole.marks.extend(lines.filter(elsewhere).cloned());
    let new_drill = |d: &&(String, Vec2)| !paper.drills.iter().any(|own| (own.1 - d.1).norm() < 1e-6);
    whole.drills.extend(other.drills.iter().filter(new_drill).cloned());
    whole
}

/// Two halves that end on the fold as one contour, and else both of them.
fn unfolded_contour(half: &[Vec2], image: &[Vec2], on_fold: impl Fn(Vec2) -> bool) -> Vec<Vec<Vec2>> {
    match (half.first(), half.last()) {
        (Some(&first), Some(&last)) if on_fold(first) && on_fold(last) => {
            let back = image.iter().rev().skip(1).take(image.len().saturating_sub(2));
            vec![half.iter().chain(back).copied().collect()]
        }
        _ => vec![half.to_vec(), image.to_vec()],
    }
}
