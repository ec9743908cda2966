//! Notches that a DXF file draws: as slits, with both flanks, as a T, a castle or a U, alone or beside their points.

use super::dxf_write::layer;
use crate::digitize::{DOUBLE, ImportedNotch};
use crate::geometry::{Path, Vec2, box_of};

/// Layers of notches: the slit, T, castle, check and U.
pub(super) const LAYERS: [u32; 5] = [layer::NOTCH, 80, 81, 82, 83];
/// Corners of a shape are as near to the cut line, to this (metres), as its flanks are; a slit is longer.
const FLANKS: f64 = 5e-4;
/// A shape that stands farther from the cut line than one beside it, by this (metres), is a part of that one's notch,
/// as the bar of a T is: no notch is shallower, and no allowance grows by so much from a notch to its double.
const DEEPER: f64 = 1e-3;

/// The notches of one layer that are drawn as `shapes` and not said by `points`; each shape is the lines of it that
/// meet end to end.
pub(super) fn drawn(points: &[Vec2], shapes: &[Path], cut: &Path) -> Vec<Vec2> {
    let drawn: Vec<(Vec2, f64)> = shapes.iter().map(|shape| notch_at(shape, cut)).collect();
    let is_beside = |a: Vec2, b: Vec2| (a - b).norm() <= DOUBLE;
    let is_part = |&(at, off): &(Vec2, f64)| drawn.iter().any(|d| d.1 + DEEPER < off && is_beside(d.0, at));
    // A point says where the notch is that is drawn beside it.
    let is_said = |at: Vec2| points.iter().any(|&p| is_beside(p, at));
    drawn.iter().filter(|d| !is_part(d) && !is_said(d.0)).map(|d| d.0).collect()
}

/// Where a shape stands on the cut line, and how far from it that is: in the middle of its nearest corners. Those are
/// an end of a slit, both ends of two flanks, two corners of a closed shape wherever that begins.
fn notch_at(shape: &Path, cut: &Path) -> (Vec2, f64) {
    let off = |p: Vec2| cut.nearest(p).1;
    let corners: Vec<(Vec2, f64)> =
        shape.joints().iter().map(|&s| shape.point(s)).map(|corner| (corner, off(corner))).collect();
    let least = corners.iter().map(|c| c.1).fold(f64::INFINITY, f64::min);
    let [low, high] = box_of(corners.iter().filter(|c| c.1 <= least + FLANKS).map(|c| c.0));
    let middle = (low + high) / 2.0;
    (middle, off(middle))
}

/// Largest distance from its line of a notch that is marked on the cut line and on the sewing line, metres.
const ON_LINE: f64 = 4e-4;
/// Largest distance along the line by which one of the two marks is off the other, metres.
const BEFORE: f64 = 2e-3;

/// The notches, those once that are marked on the cut line and on the sewing line: on the latter.
pub(super) fn once(notches: Vec<ImportedNotch>, cut: &Path, sewn: Option<&Path>) -> Vec<ImportedNotch> {
    let Some(sewn) = sewn else { return notches };
    let is_on = |p: Vec2, line: &Path| line.nearest(p).1 <= ON_LINE;
    let before = |p: Vec2, q: Vec2| {
        let on_cut = cut.point(cut.nearest(q).0);
        let on_sewn = sewn.point(sewn.nearest(p).0);
        (on_cut - p).norm().min((on_sewn - q).norm()) <= BEFORE
    };
    let inner: Vec<Vec2> = notches
        .iter()
        .filter(|n| n.told.is_none())
        .map(|n| n.at)
        .filter(|p| is_on(*p, sewn) && !is_on(*p, cut))
        .collect();
    let is_again = |n: &ImportedNotch| {
        n.told.is_none() && is_on(n.at, cut) && !is_on(n.at, sewn) && inner.iter().any(|q| before(n.at, *q))
    };
    notches.into_iter().filter(|n| !is_again(n)).collect()
}
