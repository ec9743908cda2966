//! Exact geometric predicates.

use super::Vec3;

/// Whether `d` lies above (1.0) or below (−1.0) the plane through `a b c`, from above which these run clockwise, or on
/// it (0.0): exact for any coordinates (adaptive predicates: Shewchuk 1997).
fn side(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> f64 {
    let [a, b, c, d] = [a, b, c, d].map(|p| robust::Coord3D { x: p.x, y: p.y, z: p.z });
    let volume = robust::orient3d(a, b, c, d);
    if volume == 0.0 { 0.0 } else { volume.signum() }
}

/// Whether segment `p q` passes through the inside of triangle `a b c`. Touching does not count.
///
/// Exact. Flat cloth has edges and triangles that lie in one plane within rounding, and none of them may count as
/// crossing.
pub(crate) fn pierces(p: Vec3, q: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    if side(a, b, c, p) * side(a, b, c, q) >= 0.0 {
        return false;
    }
    let first = side(p, q, a, b);
    first != 0.0 && first == side(p, q, b, c) && first == side(p, q, c, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_through_the_inside_pierces_and_one_beside_does_not() {
        let triangle = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
        assert!(pierces(at(0.2, 0.2, -1.0), at(0.3, 0.3, 1.0), triangle));
        assert!(pierces(at(0.3, 0.3, 1.0), at(0.2, 0.2, -1.0), triangle));
        assert!(!pierces(at(0.8, 0.8, -1.0), at(0.8, 0.8, 1.0), triangle));
        assert!(!pierces(at(0.2, 0.2, 0.5), at(0.3, 0.3, 1.0), triangle));
        assert!(!pierces(at(0.2, 0.2, 0.0), at(0.3, 0.3, 1.0), triangle), "an end that touches");
        assert!(!pierces(at(0.5, 0.5, -1.0), at(0.5, 0.5, 1.0), triangle), "through a side");
    }

    /// A grid in a plane that no axis is square to: what is beside one another stays so, whatever rounding does.
    #[test]
    fn nothing_in_a_plane_pierces() {
        let (u, v) = (Vec3::new(0.36, 0.48, -0.8), Vec3::new(0.8, -0.6, 0.0));
        let at = |i: i32, j: i32| Vec3::new(0.1, 0.7, -0.3) + u * (0.01 * f64::from(i)) + v * (0.01 * f64::from(j));
        let off = (at(3, 7) - at(0, 0)).cross(&(at(9, 2) - at(0, 0))).dot(&(at(5, 5) - at(0, 0)));
        assert!(off != 0.0, "rounding leaves nothing to decide");
        for i in 0..40 {
            for j in 0..40 {
                let triangle = [at(20, 20), at(21, 20), at(21, 21)];
                let apart = !(20..=21).contains(&i) || !(20..=21).contains(&j);
                assert!(!apart || !pierces(at(i, j), at(i + 1, j + 1), triangle), "{i} {j}");
            }
        }
    }
}
