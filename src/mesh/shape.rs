//! Angles of flat triangles.

use crate::geometry::Vec2;

/// Smallest angle of all triangles, radians (π when there are none).
pub(super) fn smallest_angle(points: &[Vec2], triangles: &[[u32; 3]]) -> f64 {
    let angles = |t: &[u32; 3]| {
        let p = t.map(|v| points[v as usize]);
        let angle = |k: usize| (p[(k + 1) % 3] - p[k]).angle(&(p[(k + 2) % 3] - p[k]));
        angle(0).min(angle(1)).min(angle(2))
    };
    triangles.iter().map(angles).fold(std::f64::consts::PI, f64::min)
}
