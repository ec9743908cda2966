//! Polylines and polygons in the plane.

use super::Vec2;

/// Share of the length of a polyline at each of its points, 0 … 1. `None` if it has no length.
pub(crate) fn shares_along(points: impl IntoIterator<Item = Vec2>) -> Option<Vec<f64>> {
    let mut last = None;
    let mut whole = 0.0;
    let walk = |p: Vec2| {
        whole += last.replace(p).map_or(0.0, |before: Vec2| (p - before).norm());
        whole
    };
    let walked: Vec<f64> = points.into_iter().map(walk).collect();
    (whole > 0.0).then(|| walked.into_iter().map(|way| way / whole).collect())
}

/// The right-turning chain over points sorted by x, then y (or the other way round): one half of their convex hull,
/// clockwise where y is up, with both ends.
pub(crate) fn half_hull(points: impl Iterator<Item = Vec2>) -> Vec<Vec2> {
    let mut hull: Vec<Vec2> = Vec::new();
    for p in points {
        while let [.., a, b] = hull[..] {
            if (b - a).perp(&(p - a)) < 0.0 {
                break;
            }
            hull.pop();
        }
        hull.push(p);
    }
    hull
}

/// The sides of a polygon.
pub(crate) fn sides_of(points: &[Vec2]) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| [*a, *b])
}

/// Whether `p` lies inside the shape with these sides, in any order, by the even–odd rule. A point on a side that two
/// shapes share is inside exactly one of them.
pub(crate) fn encloses(sides: impl IntoIterator<Item = [Vec2; 2]>, p: Vec2) -> bool {
    // By a ray from `p` to the right. An end at its height counts as above it.
    let crossed =
        |[a, b]: &[Vec2; 2]| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x);
    sides.into_iter().filter(crossed).count() % 2 == 1
}

/// The mirror image of `p` in the line through `on` along the unit vector `along`.
pub(crate) fn mirrored(p: Vec2, on: Vec2, along: Vec2) -> Vec2 {
    on + 2.0 * along * along.dot(&(p - on)) - (p - on)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

    #[test]
    fn points_within_are_told_from_those_outside_and_in_holes() {
        let outer = SQUARE.map(Vec2::from);
        let hole = SQUARE.map(|p| 0.25 * Vec2::from(p) + Vec2::new(0.5, 0.5));
        let holds = |x: f64, y: f64| encloses(sides_of(&outer).chain(sides_of(&hole)), Vec2::new(x, y));
        assert!(holds(0.2, 0.2) && holds(1.5, 1.0) && !holds(0.7, 0.7));
        assert!(!holds(-0.1, 1.0) && !holds(2.1, 2.0) && !holds(1.0, 3.0));
        let beside = outer.map(|p| p + Vec2::new(2.0, 0.0));
        let shared = Vec2::new(2.0, 1.0);
        assert!(encloses(sides_of(&outer), shared) != encloses(sides_of(&beside), shared));
        assert!(!encloses(sides_of(&[]), shared));
    }

    #[test]
    fn shares_go_from_nothing_to_the_whole() {
        let shares = shares_along(SQUARE[..3].iter().map(|p| Vec2::from(*p)));
        assert_eq!(shares, Some(vec![0.0, 0.5, 1.0]));
        assert_eq!(shares_along([Vec2::x(); 3]), None);
        assert_eq!(shares_along([]), None);
    }

    #[test]
    fn a_mirror_image_is_as_far_behind_the_line() {
        let along = Vec2::new(0.6, 0.8);
        let image = mirrored(Vec2::new(1.0, 0.0), Vec2::zeros(), along);
        assert_relative_eq!(image, Vec2::new(-0.28, 0.96), epsilon = 1e-12);
        assert_relative_eq!(mirrored(image, 2.0 * along, along), Vec2::new(1.0, 0.0), epsilon = 1e-12);
    }
}
