//! The interference test of the paper (F14, equation 15): does a moving point cross a triangle that stands still?

use nalgebra::Matrix3;

use crate::geometry::Vec3;

/// Where a moving point meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Share of the way, 0 ≤ t ≤ 1.
    pub t: f64,
    /// Coordinates along p0→p1 and p0→p2: u, v ≥ 0 and u + v ≤ 1.
    pub uv: [f64; 2],
}

/// Solves p + (p' − p) t = p0 + (p1 − p0) u + (p2 − p0) v and keeps the solution with 0 ≤ t ≤ 1, u, v ≥ 0, u + v ≤ 1.
/// A point that moves within the triangle's plane has no crossing.
pub fn swept_point_triangle(p: Vec3, to: Vec3, [p0, p1, p2]: [Vec3; 3]) -> Option<Hit> {
    let matrix = Matrix3::from_columns(&[to - p, p0 - p1, p0 - p2]);
    let solution = matrix.lu().solve(&(p0 - p))?;
    let (t, u, v) = (solution.x, solution.y, solution.z);
    ((0.0..=1.0).contains(&t) && u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some(Hit { t, uv: [u, v] })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const TRIANGLE: [Vec3; 3] = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];

    #[test]
    fn a_point_that_crosses_is_caught_where_it_crosses() {
        let hit = swept_point_triangle(Vec3::new(0.2, 0.3, 1.0), Vec3::new(0.2, 0.3, -3.0), TRIANGLE).expect("hit");
        assert_relative_eq!(hit.t, 0.25, epsilon = 1e-12);
        assert_relative_eq!(hit.uv[0], 0.2, epsilon = 1e-12);
        assert_relative_eq!(hit.uv[1], 0.3, epsilon = 1e-12);
    }

    #[test]
    fn a_point_that_stops_short_or_passes_beside_is_not() {
        assert_eq!(swept_point_triangle(Vec3::new(0.2, 0.3, 1.0), Vec3::new(0.2, 0.3, 0.01), TRIANGLE), None);
        assert_eq!(swept_point_triangle(Vec3::new(0.8, 0.8, 1.0), Vec3::new(0.8, 0.8, -1.0), TRIANGLE), None);
        assert_eq!(swept_point_triangle(Vec3::new(0.2, 0.3, 0.0), Vec3::new(0.3, 0.3, 0.0), TRIANGLE), None);
    }
}
