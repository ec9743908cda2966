//! Pieces on a table, folded.

use crate::geometry::Vec2;

/// The pieces laid out flat, pressed folds folded over.
pub(in crate::sew) struct FoldedPieces {
    /// Flat position of every particle as drawn, but for what is folded over, y down.
    pub(in crate::sew) flat: Vec<Vec2>,
    /// Layers towards the wrong side: 0, 1 where the cloth is folded under, -1 where it is turned up;
    /// up to 4 in a pleat.
    pub(in crate::sew) under: Vec<f64>,
    /// Whether it lies on other cloth of its piece: turned over at a fold, or laid in a pleat.
    pub(in crate::sew) hidden: Vec<bool>,
    /// How far the pleat that it is laid in is shut: 1 at the pleated edge, 0 where the pleat has opened.
    /// 1 for what is laid in no pleat.
    pub(in crate::sew) shut: Vec<f64>,
}
