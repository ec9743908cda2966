//! Ranges of numbers and bounding boxes of points.

use nalgebra::SVector;

/// The smallest and the largest of numbers. Without numbers they are ∞ and −∞.
pub(crate) fn range_of(numbers: impl IntoIterator<Item = f64>) -> [f64; 2] {
    let none = [f64::INFINITY, f64::NEG_INFINITY];
    numbers.into_iter().fold(none, |[low, high], x| [low.min(x), high.max(x)])
}

/// Corners of the bounding box of points, the low corner first. Without points they are at ∞ and −∞.
pub(crate) fn box_of<const D: usize>(points: impl IntoIterator<Item = SVector<f64, D>>) -> [SVector<f64, D>; 2] {
    let none = [SVector::repeat(f64::INFINITY), SVector::repeat(f64::NEG_INFINITY)];
    points.into_iter().fold(none, |[low, high], p| [low.inf(&p), high.sup(&p)])
}

/// As [`box_of`], but at the origin without points.
pub(crate) fn box_or_origin<const D: usize>(points: impl IntoIterator<Item = SVector<f64, D>>) -> [SVector<f64, D>; 2] {
    let mut points = points.into_iter().peekable();
    if points.peek().is_some() { box_of(points) } else { [SVector::zeros(); 2] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec2;

    #[test]
    fn what_reaches_nowhere_has_no_extent() {
        assert_eq!(range_of([2.0, -1.0, 0.5]), [-1.0, 2.0]);
        assert_eq!(box_of([Vec2::new(1.0, -2.0), Vec2::new(0.0, 3.0)]), [Vec2::new(0.0, -2.0), Vec2::new(1.0, 3.0)]);
        assert_eq!(range_of([]), [f64::INFINITY, f64::NEG_INFINITY]);
        assert_eq!(box_or_origin::<2>([]), [Vec2::zeros(); 2]);
        assert_eq!(box_or_origin([Vec2::new(1.0, -2.0)]), [Vec2::new(1.0, -2.0); 2]);
        let [low, high] = box_of::<2>([]);
        assert!(low.x > high.x && low.y > high.y);
    }
}
