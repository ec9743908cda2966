//! Cloth that already crosses itself: found exactly, so that it can be led apart.

use super::cloth::ClothDetector;
use crate::geometry::{Vec3, pierces};

/// An edge of the cloth that passes through one of its triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tangle {
    /// The edge's nodes.
    pub edge: [u32; 2],
    /// The triangle's nodes.
    pub triangle: [u32; 3],
}

impl ClothDetector {
    /// Every edge–triangle crossing at positions `x`. Primitives that share a node are left out.
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
