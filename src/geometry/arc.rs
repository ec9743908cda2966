//! Circular arcs as cubic curves.

use super::{Cubic, Path, Vec2};

/// Tangent of a quarter of the angle that one curve turns by at most, a tenth of a right angle: then a curve leaves its
/// arc by less than 1e-9 of the radius. (The error falls with the sixth power of the angle, from 2.7e-4 at a right
/// angle: Goldapp 1991.)
const MOST_BULGE: f64 = 0.04;

/// Arcs through `points` end to end: two or more points, neighbours apart. Each point has the bulge of the arc to the
/// next one: the tangent of a quarter of the angle that the arc turns by, positive counterclockwise on screen (y down),
/// 0 for a straight line. The bulge of the last point is ignored.
pub(crate) fn bulged(points: &[(Vec2, f64)]) -> Path {
    let mut curves = Vec::new();
    for step in points.windows(2) {
        let [(from, bulge), (to, _)] = [step[0], step[1]];
        curve(from, to, bulge, &mut curves);
    }
    Path::cubics(&curves)
}

/// An arc as curves. Halved until each turns by little, which needs no centre and is exact however flat the arc is.
fn curve(from: Vec2, to: Vec2, bulge: f64, curves: &mut Vec<Cubic>) {
    let chord = to - from;
    let aside = Vec2::new(-chord.y, chord.x);
    if bulge == 0.0 {
        curves.push([from, from, to, to]);
    } else if bulge.abs() <= MOST_BULGE {
        // Handles of 4/3 · tan(a quarter of the angle) radii along the tangents.
        let (along, turned) = (chord * (1.0 - bulge * bulge), aside * (2.0 * bulge));
        curves.push([from, from + (along + turned) / 3.0, to - (along - turned) / 3.0, to]);
    } else {
        let middle = from + 0.5 * (chord + bulge * aside);
        let half = bulge / (1.0 + bulge.hypot(1.0));
        curve(from, middle, half, curves);
        curve(middle, to, half, curves);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use std::f64::consts::{FRAC_PI_8, PI};

    #[test]
    fn an_arc_keeps_its_distance_from_the_centre_and_turns_the_way_its_sign_says() {
        let (a, b) = (Vec2::new(-1.0, 0.0), Vec2::new(1.0, 0.0));
        for side in [1.0, -1.0] {
            let half_circle = bulged(&[(a, side), (b, 0.0)]);
            assert_relative_eq!(half_circle.length(), PI, epsilon = 1e-8);
            let middle = half_circle.point(0.5 * PI);
            // Counterclockwise on screen from left to right is below, where y is greater.
            assert_relative_eq!(middle, Vec2::new(0.0, side), epsilon = 1e-8);
            for k in 0..40 {
                assert_relative_eq!(half_circle.point(0.08 * f64::from(k)).norm(), 1.0, epsilon = 1e-9);
            }
        }
    }

    #[test]
    fn a_line_and_an_arc_follow_each_other() {
        let quarter = FRAC_PI_8.tan();
        let points = [(Vec2::zeros(), 0.0), (Vec2::new(1.0, 0.0), quarter), (Vec2::new(2.0, -1.0), 9.0)];
        let path = bulged(&points);
        assert_relative_eq!(path.length(), 1.0 + 0.5 * PI, epsilon = 1e-8);
        assert_relative_eq!(path.tangent(1.0 + 1e-6), Vec2::new(1.0, 0.0), epsilon = 1e-5);
        assert_relative_eq!(path.end(), points[2].0);
    }
}
