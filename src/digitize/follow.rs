//! Whether one closed line follows another all round, as a sewing line follows its cut line.

use super::lozenge::Lozenge;
use crate::geometry::{Path, box_of, distance_to_segment, encloses, sides_of};

/// Places of either line that are looked at.
const LOOKS: usize = 96;
/// Widest allowance, metres: the widest hem.
const WIDEST: f64 = 0.065;
/// Number of examined places of a cut line, of [`LOOKS`], that are not at corners: nine of ten.
const BUT_CORNERS: usize = LOOKS * 9 / 10;
/// Widest allowance along most of an outline, metres: an inch, and a little for the drawing.
const USUAL: f64 = 0.026;
/// At a sharp corner the cut line is so many allowances from the sewing line, and this (metres) besides.
const AT_CORNERS: (f64, f64) = (4.0, 2e-3);
/// A line that takes less than this share of the area within another follows it only at one distance.
const SHARE: f64 = 0.5;
/// One distance: the greatest is no more than so many times the usual one, and this (metres) besides.
const EVEN: (f64, f64) = (1.6, 1e-3);
/// As far beyond its cut line as this (metres) a sewing line may be drawn.
const BEYOND: f64 = 1e-3;
/// Chords that stand for curves.
const COARSE: f64 = 1e-4;

/// Whether `inner` runs along `outer` all round within it, no farther than allowances are wide. Into darts it may go
/// without it.
pub(crate) fn follows(inner: &Path, outer: &Path) -> bool {
    let share = (inner.double_area() / outer.double_area()).abs();
    if !(share > 0.0 && share <= 1.0 && lies_near(inner, outer)) {
        return false;
    }
    let widths = distances(outer, inner);
    let (usual, widest, at_corners) = (widths[LOOKS / 2], widths[BUT_CORNERS], widths[LOOKS - 1]);
    if usual > USUAL || widest > WIDEST || at_corners > AT_CORNERS.0 * widest + AT_CORNERS.1 {
        return false;
    }
    let back = distances(inner, outer);
    let even = share >= SHARE || back[LOOKS - 1] <= EVEN.0 * usual + EVEN.1 && Lozenge::of(inner).is_none();
    even && back[LOOKS / 2] <= USUAL && is_within(inner, outer)
}

/// Whether the box round `inner` is as far within that round `outer` as an allowance may be wide.
fn lies_near(inner: &Path, outer: &Path) -> bool {
    let [[low, high], [least, most]] = [inner, outer].map(|path| box_of(path.sampled(COARSE)));
    let far = AT_CORNERS.0 * WIDEST + AT_CORNERS.1;
    (0..2).all(|k| [low[k] - least[k], most[k] - high[k]].iter().all(|d| (-BEYOND..=far).contains(d)))
}

/// Distances of points of a line from another, sorted.
fn distances(line: &Path, from: &Path) -> Vec<f64> {
    let points = from.sampled(COARSE);
    let place = |k: usize| line.point(line.length() * (k as f64 + 0.5) / LOOKS as f64);
    let off =
        |k: usize| sides_of(&points).map(|side| distance_to_segment(place(k), side)).fold(f64::INFINITY, f64::min);
    let mut all: Vec<f64> = (0..LOOKS).map(off).collect();
    all.sort_by(f64::total_cmp);
    all
}

/// Whether no place of `inner` is outside `outer`, but for where they share a side.
fn is_within(inner: &Path, outer: &Path) -> bool {
    let points = outer.sampled(COARSE);
    let place = |k: usize| inner.point(inner.length() * (k as f64 + 0.5) / LOOKS as f64);
    (0..LOOKS)
        .map(place)
        .all(|p| encloses(sides_of(&points), p) || sides_of(&points).any(|side| distance_to_segment(p, side) <= BEYOND))
}

/// Unevenness with which one line follows the other, without corners, metres.
pub(super) fn unevenness(inner: &Path, outer: &Path) -> f64 {
    let widths = distances(outer, inner);
    widths[BUT_CORNERS] - widths[LOOKS - 1 - BUT_CORNERS]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ring(text: &str) -> Path {
        Path::parse_absolute(text, 1e-3).expect("a path")
    }

    #[test]
    fn a_sewing_line_follows_its_cut_line_and_a_dart_or_a_pocket_does_not() {
        let panel = ring("M 0 0 L 213 0 L 287 121 L 260 578 L 0 578 Z");
        let dart = ring("M 151 174 L 140 333 L 151 416 L 163 333 Z");
        let seam = ring("M 0 10 L 208 10 L 276 121 L 250 538 L 0 538 Z");
        assert!(!follows(&dart, &panel) && follows(&seam, &panel) && !follows(&panel, &seam));
        let pocket = ring("M 60 140 L 190 140 L 190 300 L 60 300 Z");
        assert!(!follows(&pocket, &panel));
        // Over a dart the cut line passes its mouth. A fish-eye in a strap is as far from its sides everywhere.
        let darted = ring("M 10 10 H 190 V 290 H 110 L 100 190 L 90 290 H 10 Z");
        assert!(follows(&darted, &ring("M 0 0 H 200 V 300 H 0 Z")));
        assert!(!follows(&ring("M 30 20 L 40 100 L 30 180 L 20 100 Z"), &ring("M 0 0 H 60 V 200 H 0 Z")));
        // A narrow band, of which its cut line takes more than twice the area, and a box at the end of a strap.
        let (cut, band) = (ring("M 0 0 H 320 V 40 H 0 Z"), ring("M 10 10 H 310 V 30 H 10 Z"));
        assert!(follows(&band, &cut));
        let (strap, stitches) = (ring("M 0 0 H 57.75 V 200 H 0 Z"), ring("M 0 0 V 28.88 H 28.88 V 0 Z"));
        assert!(!follows(&stitches, &strap));
    }
}
