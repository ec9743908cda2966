//! How a drawn piece lies in the pieces that are cut from it.

use nalgebra::Matrix2;

use crate::geometry::{Path, Vec2};
use crate::pattern::{CutKind, GarmentFile, PieceFile, Side};

/// A drawing as it lies in a cut piece: `p ↦ linear · p + shift`.
#[derive(Clone, Debug)]
pub(super) struct Laying {
    /// Name of the cut piece.
    pub(super) piece: String,
    linear: Matrix2<f64>,
    shift: Vec2,
}

impl Laying {
    /// A point of the drawing in the cut piece.
    pub(super) fn point(&self, p: Vec2) -> Vec2 {
        self.linear * p + self.shift
    }

    /// A direction of the cut piece in the drawing.
    pub(super) fn back(&self, direction: Vec2) -> Vec2 {
        self.linear.transpose() * direction
    }
}

/// How the piece with this index is cut, and the side that is drawn, also where it has them by `like`.
pub(super) fn cut_of(file: &GarmentFile, index: usize) -> (CutKind, Side) {
    let cut = inherited(file, index, |p| p.cut.as_ref().map(|c| c.value.clone()));
    let drawn = inherited(file, index, |p| p.drawn.as_ref().map(|d| d.value));
    (cut.unwrap_or(CutKind::One), drawn.unwrap_or(Side::Left))
}

/// The statement of a piece, or of the first of those that it is like.
fn inherited<T>(file: &GarmentFile, index: usize, of: impl Fn(&PieceFile) -> Option<T>) -> Option<T> {
    let mut piece = &file.pieces[index];
    // A circle of `like` is reported elsewhere.
    for _ in 0..=file.pieces.len() {
        if let Some(stated) = of(piece) {
            return Some(stated);
        }
        let like = piece.like.as_ref()?;
        piece = file.pieces.iter().find(|p| p.name.value == like.value)?;
    }
    None
}

/// Everywhere that the piece with this index lies. `fold` is the course of its fold edge.
pub(super) fn layings(file: &GarmentFile, index: usize, fold: Option<&Path>) -> Vec<Laying> {
    let name = &file.pieces[index].name.value;
    let as_drawn = |piece: String| Laying { piece, linear: Matrix2::identity(), shift: Vec2::zeros() };
    let (cut, drawn) = cut_of(file, index);
    match (cut, fold) {
        (CutKind::Count(n), _) => (1..=n).map(|copy| as_drawn(format!("{name}.{copy}"))).collect(),
        (CutKind::Pair, _) => {
            let linear = Matrix2::new(-1.0, 0.0, 0.0, 1.0);
            let other = Laying { piece: format!("{name}{}", drawn.other().suffix()), linear, shift: Vec2::zeros() };
            vec![as_drawn(format!("{name}{}", drawn.suffix())), other]
        }
        (CutKind::Fold(_), Some(axis)) => {
            let along = (axis.end() - axis.start()).try_normalize(0.0).unwrap_or_else(Vec2::y);
            let linear = 2.0 * along * along.transpose() - Matrix2::identity();
            let shift = axis.start() - linear * axis.start();
            vec![as_drawn(name.clone()), Laying { piece: name.clone(), linear, shift }]
        }
        _ => vec![as_drawn(name.clone())],
    }
}
