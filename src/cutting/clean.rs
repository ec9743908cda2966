//! Contours that do not cross themselves. The only user of i_overlay.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use crate::geometry::Vec2;

/// Distance within which neighbouring points are one, metres: a tenth of the error of the chords.
const SAME: f64 = 2e-7;

type Contour = Vec<[f64; 2]>;

/// The area inside `raw` (clockwise on screen, perhaps with loops where it turned in on itself) or inside `sewn`: the
/// outer contour, then those of the bays that it closes round.
pub(super) fn grown(raw: &[Vec2], sewn: &[Vec2]) -> Vec<Vec<Vec2>> {
    overlay(plain(raw), plain(sewn))
}

/// The area that is left inside a hole's `raw` contour (counter-clockwise on screen).
pub(super) fn shrunk(raw: &[Vec2]) -> Vec<Vec<Vec2>> {
    let turned: Vec<Vec2> = raw.iter().rev().copied().collect();
    overlay(plain(&turned), Vec::new())
}

/// Loops that run the wrong way are where two allowances overlap in a bend: the positive fill rule drops them.
fn overlay(one: Contour, other: Contour) -> Vec<Vec<Vec2>> {
    let shapes = [one].overlay(&[other], OverlayRule::Union, FillRule::Positive);
    let mut contours: Vec<Vec<Vec2>> = shapes.into_iter().flatten().map(|c| tidy(&c)).collect();
    contours.retain(|c| c.len() > 2);
    contours.sort_by(|a, b| double_area(b).abs().total_cmp(&double_area(a).abs()));
    contours
}

/// Twice the area a contour encloses, positive clockwise on screen.
pub(super) fn double_area(contour: &[Vec2]) -> f64 {
    let next = contour.iter().cycle().skip(1);
    contour.iter().zip(next).map(|(a, b)| a.perp(b)).sum()
}

fn plain(points: &[Vec2]) -> Contour {
    points.iter().map(|p| [p.x, p.y]).collect()
}

fn tidy(contour: &[[f64; 2]]) -> Vec<Vec2> {
    let mut points: Vec<Vec2> = contour.iter().map(|&p| Vec2::from(p)).collect();
    points.dedup_by(|b, a| (*b - *a).norm() < SAME);
    while points.len() > 1 && (points[0] - points[points.len() - 1]).norm() < SAME {
        points.pop();
    }
    points
}
