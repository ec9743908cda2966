//! Putting a flat piece where it belongs, without changing it.

use crate::geometry::Vec2;

/// Moves the centre of the points to the origin.
pub(super) fn centre(points: &mut [Vec2]) {
    let middle = mean(points);
    for p in points {
        *p -= middle;
    }
}

/// Turns and shifts the points so that they lie as close as possible (least squares) to `target`, never mirrored.
pub(super) fn onto(points: &mut [Vec2], target: &[Vec2]) {
    let (from, to) = (mean(points), mean(target));
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (p, q) in points.iter().zip(target) {
        let (p, q) = (p - from, q - to);
        cosine += p.dot(&q);
        sine += p.perp(&q);
    }
    let length = f64::hypot(cosine, sine);
    let (cosine, sine) = if length > 0.0 { (cosine / length, sine / length) } else { (1.0, 0.0) };
    for p in points {
        let d = *p - from;
        *p = to + Vec2::new(cosine * d.x - sine * d.y, sine * d.x + cosine * d.y);
    }
}

fn mean(points: &[Vec2]) -> Vec2 {
    points.iter().sum::<Vec2>() / points.len().max(1) as f64
}
