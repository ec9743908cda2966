//! Pieces as they are cut: folds opened, both of a pair, every copy.

use nalgebra::Matrix2;

use super::{Mark, MarkKind, NotchMark, Paper, SewLine};
use crate::geometry::Vec2;
use crate::pattern::{Cut, Drawing};

/// The papers of one drawing, each cut once. Lettering is not carried over.
pub(super) fn as_cut(paper: &Paper, drawing: &Drawing) -> Vec<Paper> {
    let named = |name: String, of: &Paper| Paper {
        name,
        count: "cut 1".to_owned(),
        quantity: 1,
        mirrored: false,
        drawn: None,
        ..of.clone()
    };
    match &drawing.cut {
        Cut::One => vec![named(paper.name.clone(), paper)],
        Cut::Count(n) => (1..=*n).map(|k| named(format!("{}.{k}", paper.name), paper)).collect(),
        Cut::Pair => {
            let other = paper.mapped(Matrix2::new(-1.0, 0.0, 0.0, 1.0), Vec2::zeros());
            let sided = |p: &Paper, side: crate::pattern::Side| named(format!("{}.{}", p.name, side.letter()), p);
            vec![sided(paper, drawing.drawn), sided(&other, drawing.drawn.other())]
        }
        Cut::Fold(_) => vec![named(paper.name.clone(), &unfolded(paper, drawing))],
    }
}

fn unfolded(paper: &Paper, drawing: &Drawing) -> Paper {
    let Some([from, to]) = paper.fold else { return paper.clone() };
    let along = (to - from).normalize();
    let linear = 2.0 * along * along.transpose() - Matrix2::identity();
    let other = paper.mapped(linear, from - linear * from);
    let sides = [drawing.drawn, drawing.drawn.other()].map(|s| s.letter());
    let mut whole = paper.clone();
    whole.fold = None;
    if let (Some(outline), Some(mirror)) = (whole.cut.first_mut(), other.cut.first()) {
        // Both ends are on the fold already.
        let back = mirror.iter().rev().skip(1).take(mirror.len().saturating_sub(2));
        outline.extend(back.copied());
    }
    whole.cut.extend(other.cut.iter().skip(1).cloned());
    let sided = |lines: &[SewLine], side: &str| -> Vec<SewLine> {
        lines.iter().map(|s| SewLine { name: format!("{}.{side}", s.name), ..s.clone() }).collect()
    };
    whole.sew = [sided(&paper.sew, sides[0]), sided(&other.sew, sides[1])].concat();
    // A notch on the fold is its own mirror image; a double one is not, even if one of its marks is.
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
