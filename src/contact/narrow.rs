//! Closest points between points, segments and triangles.

use crate::geometry::{TriMesh, Vec3};

/// Whether two boxes (low and high corner of each) have nothing in common.
pub(super) fn apart(low: Vec3, high: Vec3, other_low: Vec3, other_high: Vec3) -> bool {
    (0..3).any(|k| other_high[k] < low[k] || other_low[k] > high[k])
}

/// The triangle of a surface nearest to a point, the weights of its corners at the nearest place, and the distance,
/// metres. Every triangle is tried.
pub fn nearest_on_surface(surface: &TriMesh, p: Vec3) -> (usize, [f64; 3], f64) {
    let mut best = (0, [1.0, 0.0, 0.0], f64::INFINITY);
    for t in 0..surface.triangles.len() {
        let [a, b, c] = surface.corners(t);
        let weights = closest_on_triangle(p, a, b, c);
        let far = (a * weights[0] + b * weights[1] + c * weights[2] - p).norm();
        if far < best.2 {
            best = (t, weights, far);
        }
    }
    best
}

/// Barycentric coordinates of the point of triangle `abc` closest to `p` (Ericson, *Real-Time Collision Detection*,
/// 5.1.5: by Voronoi regions, so that an obtuse triangle is right too).
pub fn closest_on_triangle(p: Vec3, a: Vec3, b: Vec3, c: Vec3) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let sum = va + vb + vc;
    [va / sum, vb / sum, vc / sum]
}

/// Parameters (s, t) of the closest points of segments `p0 p1` and `q0 q1` (Ericson 5.1.9).
pub fn closest_on_segments(p0: Vec3, p1: Vec3, q0: Vec3, q1: Vec3) -> (f64, f64) {
    let (d1, d2, r) = (p1 - p0, q1 - q0, p0 - q0);
    let (a, e, f) = (d1.norm_squared(), d2.norm_squared(), d2.dot(&r));
    if a == 0.0 && e == 0.0 {
        return (0.0, 0.0);
    }
    if a == 0.0 {
        return (0.0, (f / e).clamp(0.0, 1.0));
    }
    let c = d1.dot(&r);
    if e == 0.0 {
        return ((-c / a).clamp(0.0, 1.0), 0.0);
    }
    let b = d1.dot(&d2);
    let determinant = a * e - b * b;
    // Parallel segments: any point of the overlap will do. Start from p0.
    let s = if determinant > 1e-12 * a * e { ((b * f - c * e) / determinant).clamp(0.0, 1.0) } else { 0.0 };
    let t = (b * s + f) / e;
    if t < 0.0 {
        ((-c / a).clamp(0.0, 1.0), 0.0)
    } else if t > 1.0 {
        (((b - c) / a).clamp(0.0, 1.0), 1.0)
    } else {
        (s, t)
    }
}

/// Parameters (s, t) of the closest points of the lines through `p0 p1` and `q0 q1`, which must not be parallel.
pub(super) fn closest_on_lines(p0: Vec3, p1: Vec3, q0: Vec3, q1: Vec3) -> (f64, f64) {
    let (d1, d2, r) = (p1 - p0, q1 - q0, p0 - q0);
    let (a, b, c, e, f) = (d1.norm_squared(), d1.dot(&d2), d1.dot(&r), d2.norm_squared(), d2.dot(&r));
    let determinant = a * e - b * b;
    ((b * f - c * e) / determinant, (a * f - b * c) / determinant)
}

/// Barycentric coordinates of the foot of `p` in the plane of triangle `abc`, also beyond its rim. They are
/// not numbers if the triangle has no area.
pub(super) fn on_plane(p: Vec3, a: Vec3, b: Vec3, c: Vec3) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (bb, bc, cc, pb, pc) = (ab.norm_squared(), ab.dot(&ac), ac.norm_squared(), ap.dot(&ab), ap.dot(&ac));
    let determinant = bb * cc - bc * bc;
    let (v, w) = ((cc * pb - bc * pc) / determinant, (bb * pc - bc * pb) / determinant);
    [1.0 - v - w, v, w]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    fn vec3() -> impl Strategy<Value = Vec3> {
        (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(|(x, y, z): (f64, f64, f64)| Vec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn no_sampled_point_of_the_triangle_is_nearer(p in vec3(), a in vec3(), b in vec3(), c in vec3()) {
            let w = closest_on_triangle(p, a, b, c);
            prop_assert!((w.iter().sum::<f64>() - 1.0).abs() < 1e-9 && w.iter().all(|&x| x >= -1e-12));
            let best = (a * w[0] + b * w[1] + c * w[2] - p).norm();
            for i in 0..=10 {
                for j in 0..=(10 - i) {
                    let (u, v) = (f64::from(i) / 10.0, f64::from(j) / 10.0);
                    prop_assert!((a * (1.0 - u - v) + b * u + c * v - p).norm() >= best - 1e-9);
                }
            }
        }

        #[test]
        fn no_sampled_pair_on_the_segments_is_nearer(a in vec3(), b in vec3(), c in vec3(), d in vec3()) {
            let (s, t) = closest_on_segments(a, b, c, d);
            let best = (a + (b - a) * s - c - (d - c) * t).norm();
            for i in 0..=10 {
                for j in 0..=10 {
                    let (u, v) = (f64::from(i) / 10.0, f64::from(j) / 10.0);
                    prop_assert!((a + (b - a) * u - c - (d - c) * v).norm() >= best - 1e-9);
                }
            }
        }
    }

    #[test]
    fn a_point_over_the_middle_projects_straight_down() {
        let w = closest_on_triangle(Vec3::new(0.25, 0.25, 3.0), Vec3::zeros(), Vec3::x(), Vec3::y());
        assert_relative_eq!(w[0], 0.5, epsilon = 1e-12);
        assert_relative_eq!(w[1], 0.25, epsilon = 1e-12);
    }
}
