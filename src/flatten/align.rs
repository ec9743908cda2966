//! Putting a flat piece where it belongs, without changing it.

use crate::geometry::{TriMesh, Vec2};

/// Mean slope (upward metres per metre) below which a surface counts as level.
const NO_DIRECTION: f64 = 1e-6;

/// Moves the centre of the points to the origin.
pub(super) fn centre(points: &mut [Vec2]) {
    let middle = mean(points);
    for p in points {
        *p -= middle;
    }
}

/// Moves the centre of the points to the origin and turns them so that the surface's mean upward direction (space's
/// y) is up on a screen (−y). A surface without one, such as a level one, is not turned.
pub(super) fn upright(flat: &mut [Vec2], surface: &TriMesh) {
    let middle = mean(flat);
    let mut up = Vec2::zeros();
    for t in &surface.triangles {
        let [a, b, c] = t.map(|v| flat[v as usize]);
        let heights = t.map(|v| surface.vertices[v as usize].y);
        // Gradient of the height over the flat triangle, times its area.
        for (height, side) in heights.into_iter().zip([c - b, a - c, b - a]) {
            up += Vec2::new(-side.y, side.x) * (0.5 * height);
        }
    }
    let extent = surface.area() * NO_DIRECTION;
    let up = if up.norm() > extent { up.normalize() } else { -Vec2::y() };
    for p in flat {
        let d = *p - middle;
        *p = Vec2::new(-up.y * d.x + up.x * d.y, -up.x * d.x - up.y * d.y);
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
