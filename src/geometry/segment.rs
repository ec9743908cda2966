//! Straight segments.

use nalgebra::SVector;

/// Distance of a point from a segment.
pub(crate) fn distance_to_segment<const D: usize>(p: SVector<f64, D>, ends: [SVector<f64, D>; 2]) -> f64 {
    nearest_on_segment(p, ends).1
}

/// The share of the way along a segment at which it is nearest to a point, and its distance from that.
pub(crate) fn nearest_on_segment<const D: usize>(p: SVector<f64, D>, [a, b]: [SVector<f64, D>; 2]) -> (f64, f64) {
    let along = b - a;
    let square = along.norm_squared();
    let share = if square > 0.0 { ((p - a).dot(&along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (share, (p - a - along * share).norm())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec2;
    use approx::assert_relative_eq;

    #[test]
    fn the_nearest_point_is_beside_the_segment_or_one_of_its_ends() {
        let ends = [Vec2::new(1.0, 1.0), Vec2::new(5.0, 1.0)];
        assert_relative_eq!(distance_to_segment(Vec2::new(2.0, 4.0), ends), 3.0);
        assert_relative_eq!(distance_to_segment(Vec2::new(-2.0, 5.0), ends), 5.0);
        assert_relative_eq!(distance_to_segment(Vec2::new(8.0, 5.0), ends), 5.0);
        assert_relative_eq!(distance_to_segment(Vec2::new(4.0, 5.0), [ends[0]; 2]), 5.0);
    }
}
