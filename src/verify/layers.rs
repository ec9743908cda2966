//! The layers of cloth that lie on one another.

use super::bvh::{Aabb, Bvh};
use crate::geometry::{TriMesh, Vec3};

/// A line this near to the plane of a triangle (cosine to its normal) does not meet it: it runs along that layer.
const ALONG: f64 = 1e-3;

/// A triangle of the surface that a line meets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Layer {
    /// Its index.
    pub triangle: u32,
    /// Position along the line, metres. Negative behind its start.
    pub at: f64,
    /// Cosine of the angle between the line and the triangle's normal.
    pub facing: f64,
}

/// A surface that is asked for its layers.
pub struct Layers<'a> {
    surface: &'a TriMesh,
    tree: Bvh,
}

impl<'a> Layers<'a> {
    /// Prepares `surface`.
    pub fn new(surface: &'a TriMesh) -> Self {
        Self { surface, tree: Bvh::new(surface) }
    }

    /// The triangles that the line through `from` along the unit `way` meets within `reach` (metres) of `from`, before
    /// or behind it. Those that `skip` takes are left out. In the order of their indices.
    pub fn near(&self, from: Vec3, way: Vec3, reach: f64, skip: impl Fn(u32) -> bool) -> Vec<Layer> {
        let bounds = Aabb::of(&[from - way * reach, from + way * reach]);
        let mut found = Vec::new();
        self.tree.visit_box(&bounds, |triangle| {
            let layer = meet(self.surface.corners(triangle as usize), from, way)
                .map(|(at, facing)| Layer { triangle, at, facing })
                .filter(|layer| layer.at.abs() <= reach && !skip(triangle));
            found.extend(layer);
        });
        found.sort_by_key(|layer| layer.triangle);
        found
    }
}

/// Position along the line through `from` with direction `way` where it meets a triangle, and the cosine of its angle
/// to the normal.
fn meet([a, b, c]: [Vec3; 3], from: Vec3, way: Vec3) -> Option<(f64, f64)> {
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    let facing = normal.dot(&way);
    if facing.abs() < ALONG {
        return None;
    }
    let at = normal.dot(&(a - from)) / facing;
    let p = from + way * at;
    let within = [(a, b), (b, c), (c, a)].into_iter().all(|(s, e)| normal.dot(&(e - s).cross(&(p - s))) >= 0.0);
    within.then_some((at, facing))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_meets_the_layers_before_and_behind_its_start() {
        let corners = |z: f64| [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, z));
        let vertices = [-0.004, 0.003, 0.2].into_iter().flat_map(corners).collect();
        // The second one is turned over.
        let surface = TriMesh { vertices, triangles: vec![[0, 1, 2], [3, 5, 4], [6, 7, 8]] };
        let layers = Layers::new(&surface);
        let from = Vec3::new(0.2, 0.3, 0.0);
        let seen = |skipped: u32| layers.near(from, Vec3::z(), 0.01, |t| t == skipped);
        let found: Vec<(u32, f64)> = seen(9).iter().map(|layer| (layer.triangle, layer.facing)).collect();
        assert_eq!(found, [(0, 1.0), (1, -1.0)]);
        approx::assert_relative_eq!(seen(1)[0].at, -0.004, epsilon = 1e-12);
        assert!(layers.near(Vec3::new(0.7, 0.7, 0.0), Vec3::z(), 0.01, |_| false).is_empty(), "beside it");
    }
}
