//! Corners and folds of an outline.

use super::Outline;

/// Whether an edge lies on the fold of the cloth.
pub(super) fn is_fold(outline: &Outline, edge: usize) -> bool {
    outline.fold.as_ref() == Some(&outline.edges[edge].name)
}

/// By how much the outline turns where an edge begins, clockwise positive.
pub(super) fn turn_before(outline: &Outline, edge: usize) -> f64 {
    let before = &outline.edges[(edge + outline.edges.len() - 1) % outline.edges.len()].path;
    let (from, to) = (before.tangent(before.length()), outline.edges[edge].path.tangent(0.0));
    from.perp(&to).atan2(from.dot(&to))
}
