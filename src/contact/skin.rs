//! A part of a body's surface, open or closed.

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::TriMesh as ParryMesh;

use crate::geometry::Vec3;

/// Triangles prepared for distance queries.
pub struct Skin(ParryMesh);

impl Skin {
    /// The `triangles` over `vertices`. `None` where there are none, or parry refuses them.
    pub fn new(vertices: &[Vec3], triangles: Vec<[u32; 3]>) -> Option<Self> {
        let vertices = vertices.iter().map(|&v| Vector::from(v)).collect();
        ParryMesh::new(vertices, triangles).ok().map(Self)
    }

    /// Unsigned distance of `p` from the triangles, metres, if it is no more than `reach`.
    pub fn distance(&self, p: Vec3, reach: f64) -> Option<f64> {
        let p = Vector::from(p);
        let (projection, _) = self.0.project_local_point_and_get_location_with_max_dist(p, false, reach)?;
        Some((Vec3::from(projection.point) - Vec3::from(p)).norm())
    }

    /// The corners of the triangle that is nearest to `p`.
    pub fn nearest(&self, p: Vec3) -> [u32; 3] {
        let (_, (triangle, _)) = self.0.project_local_point_and_get_location(Vector::from(p), false);
        self.0.indices()[triangle as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_is_to_the_triangles_and_not_to_their_corners() {
        let skin = Skin::new(&[Vec3::zeros(), Vec3::x(), Vec3::y()], vec![[0, 1, 2]]).expect("a triangle");
        for side in [0.1, -0.1] {
            let far = skin.distance(Vec3::new(0.3, 0.3, side), 1.0).expect("near");
            assert!((far - 0.1).abs() < 1e-12, "{far}");
        }
        assert!(skin.distance(Vec3::z() * 2.0, 1.0).is_none());
        assert!(Skin::new(&[Vec3::zeros()], Vec::new()).is_none());
    }

    #[test]
    fn the_nearest_is_a_triangle_and_not_the_one_with_the_nearest_corner() {
        let wide = [[-9.0, -9.0], [9.0, -9.0], [0.0, 9.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
        let small = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, -1.0));
        let vertices = [wide, small].concat();
        let skin = Skin::new(&vertices, vec![[3, 4, 5], [0, 1, 2]]).expect("two triangles");
        assert_eq!(skin.nearest(Vec3::new(0.1, 0.1, 0.1)), [0, 1, 2]);
        assert_eq!(skin.nearest(Vec3::new(0.1, 0.1, -0.9)), [3, 4, 5]);
    }
}
