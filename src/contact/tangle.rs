//! Cloth that already crosses itself: found exactly, so that it can be led apart.

use super::cloth::ClothDetector;
use crate::geometry::Vec3;

/// An edge of the cloth that passes through one of its triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tangle {
    /// The edge's nodes.
    pub edge: [u32; 2],
    /// The triangle's nodes.
    pub triangle: [u32; 3],
}

/// Whether segment `p q` passes through the inside of triangle `a b c`.
pub(super) fn pierces(p: Vec3, q: Vec3, [a, b, c]: [Vec3; 3]) -> bool {
    let volume = |u: Vec3, v: Vec3, w: Vec3, z: Vec3| (v - u).cross(&(w - u)).dot(&(z - u));
    let (above, below) = (volume(a, b, c, p), volume(a, b, c, q));
    if above * below >= 0.0 {
        return false;
    }
    let (x, y, z) = (volume(p, q, a, b), volume(p, q, b, c), volume(p, q, c, a));
    (x > 0.0 && y > 0.0 && z > 0.0) || (x < 0.0 && y < 0.0 && z < 0.0)
}

impl ClothDetector {
    /// Every edge–triangle crossing at positions `x`; primitives that share a node are left out.
    pub fn tangles(&mut self, x: &[Vec3]) -> Vec<Tangle> {
        let mut out = Vec::new();
        for (edge, triangle) in self.touching(x) {
            let [p, q] = edge.map(|n| x[n as usize]);
            if pierces(p, q, triangle.map(|n| x[n as usize])) {
                out.push(Tangle { edge, triangle });
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_through_the_inside_pierces_and_one_beside_does_not() {
        let triangle = [Vec3::zeros(), Vec3::x(), Vec3::y()];
        let at = |x: f64, y: f64, z: f64| Vec3::new(x, y, z);
        assert!(pierces(at(0.2, 0.2, -1.0), at(0.3, 0.3, 1.0), triangle));
        assert!(!pierces(at(0.8, 0.8, -1.0), at(0.8, 0.8, 1.0), triangle));
        assert!(!pierces(at(0.2, 0.2, 0.5), at(0.3, 0.3, 1.0), triangle));
    }
}
