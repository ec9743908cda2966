//! Area and boundary errors.

use super::rim::RimEdge;
use crate::geometry::Vec3;

/// The two states that are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ComparedStates {
    /// A sewn, draped or flattened piece with the drawn one.
    FromDrawn,
    /// A flattened piece with the draped one.
    FromDraped,
}

/// An error by the rule for uneven seams, and without it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ErrorPair {
    pub(super) error: f64,
    pub(super) raw: f64,
}

/// |area after − area before| / area before. `left_out` says which triangles the rule leaves out; if it would leave
/// out all, none are.
pub(super) fn area_error(
    triangles: &[(u32, [u32; 3])],
    before: &[Vec3],
    after: &[Vec3],
    left_out: impl Fn(u32) -> bool,
) -> ErrorPair {
    let (mut kept, mut all) = ([0.0; 2], [0.0; 2]);
    for (index, corners) in triangles {
        for (k, at) in [before, after].into_iter().enumerate() {
            let area = area(corners, at);
            all[k] += area;
            kept[k] += if left_out(*index) { 0.0 } else { area };
        }
    }
    let raw = relative(all[1] - all[0], all[0]);
    ErrorPair { error: if kept[0] > 0.0 { relative(kept[1] - kept[0], kept[0]) } else { raw }, raw }
}

/// |length after − length before| / length before of the rim. Against the drawn piece, any length between the drawn
/// lengths a seam joins counts as right. Against the draped one, any that is no further from it than those two are
/// from each other.
pub(super) fn boundary_error<'a>(
    rim: impl IntoIterator<Item = &'a RimEdge>,
    before: &[Vec3],
    after: &[Vec3],
    way: ComparedStates,
) -> ErrorPair {
    let (mut total, mut off, mut off_raw) = (0.0, 0.0, 0.0);
    for edge in rim {
        let (from, to) = (edge.length(before), edge.length(after));
        let [low, high] = match way {
            ComparedStates::FromDrawn => edge.drawn,
            ComparedStates::FromDraped => [from / edge.ratio(), from * edge.ratio()],
        };
        total += from;
        off += to - to.max(low).min(high);
        off_raw += to - from;
    }
    ErrorPair { error: relative(off, total), raw: relative(off_raw, total) }
}

/// Area of a triangle, m².
pub(super) fn area(corners: &[u32; 3], at: &[Vec3]) -> f64 {
    let [a, b, c] = corners.map(|v| at[v as usize]);
    (b - a).cross(&(c - a)).norm() / 2.0
}

fn relative(change: f64, of: f64) -> f64 {
    if of > 0.0 { (change / of).abs() } else { 0.0 }
}
