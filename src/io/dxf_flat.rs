//! Patterns without blocks: pieces side by side in the drawing itself, each what lies in one boundary.

use super::dxf_block::Block;
use crate::geometry::Path;
use crate::geometry::{encloses, sides_of};

/// A boundary round less than this (square metres, a square of 1 cm) is no piece.
const SMALLEST: f64 = 1e-4;
/// More pieces than this in one drawing are none.
const MOST: usize = 1_000;
/// Chords that stand for curves.
const COARSE: f64 = 1e-4;

/// The pieces of a drawing as blocks; the drawing itself where nothing in it is closed, so that this is said.
pub(super) fn flat(drawing: Block) -> Vec<Block> {
    let mut boundaries = drawing.boundaries();
    boundaries.retain(|b| 0.5 * b.double_area().abs() >= SMALLEST);
    boundaries.truncate(MOST);
    let within = |a: &Path, b: &Path| {
        a.double_area().abs() < b.double_area().abs() && encloses(sides_of(&b.sampled(COARSE)), a.start())
    };
    let outer = boundaries.iter().filter(|a| !boundaries.iter().any(|b| within(a, b)));
    let pieces: Vec<Block> = outer.map(|boundary| drawing.part(boundary)).collect();
    if pieces.is_empty() { vec![drawing] } else { pieces }
}
