//! Values of a garment file that stand in no file yet.

use crate::geometry::{MM, Vec2};
use crate::pattern::{Located, Spot};

/// A value without a place.
pub(super) fn at_no_place<T>(value: T) -> Located<T> {
    Located::new(value, Spot::default())
}

/// Ten nanometres in a millimetre file: nobody's rounding, and short.
fn rounded(x: f64) -> f64 {
    let r = (x * 1e5).round() / 1e5;
    if r == 0.0 { 0.0 } else { r }
}

/// A point in the file's millimetres.
pub(super) fn file_point(p: Vec2) -> [f64; 2] {
    [rounded(p.x * MM), rounded(p.y * MM)]
}
