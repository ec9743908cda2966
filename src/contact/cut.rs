//! Places where the body passes through cloth although all particles are outside it, and the direction off the body.

use parry3d_f64::query::{Ray, RayCast};

use super::Collider;
use super::body::{from_parry, to_parry};
use crate::geometry::{Vec3, pierces};

impl Collider {
    /// Whether the body's surface is between two points.
    pub fn is_in_the_way(&self, from: Vec3, to: Vec3) -> bool {
        self.mesh.intersects_local_ray(&Ray::new(to_parry(from), to_parry(to - from)), 1.0)
    }

    /// Unit direction off the body for a segment that passes through it. It bisects the outward normals where the
    /// segment enters and leaves, and is square to the segment. For a wedge it leads over the edge. `None` if nothing
    /// is in the way, or if the two faces are opposite to each other.
    pub fn way_off(&self, from: Vec3, to: Vec3) -> Option<Vec3> {
        let outward = self.facing(from, to)? + self.facing(to, from)?;
        let along = (to - from).try_normalize(0.0)?;
        (outward - along * along.dot(&outward)).try_normalize(0.0)
    }

    /// Unit normal, on the side of `from`, of the first face on the way `to` another point.
    fn facing(&self, from: Vec3, to: Vec3) -> Option<Vec3> {
        let ray = Ray::new(to_parry(from), to_parry(to - from));
        let normal = from_parry(self.mesh.cast_local_ray_and_get_normal(&ray, 1.0, false)?.normal);
        Some(if normal.dot(&(to - from)) > 0.0 { -normal } else { normal })
    }

    /// Unit outward direction of the body's convex edges that pass through a triangle. `None` if none does.
    pub fn poking(&self, corners: [Vec3; 3]) -> Option<Vec3> {
        let [a, b, c] = corners;
        let mut outward = Vec3::zeros();
        self.edge_grid.query(a.inf(&b).inf(&c), a.sup(&b).sup(&c), |e| {
            let edge = &self.edges[e as usize];
            let [p, q] = edge.ends.corners;
            if pierces(p, q, corners) {
                outward += edge.outward;
            }
        });
        outward.try_normalize(0.0)
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::geometry::TriMesh;
    use approx::assert_relative_eq;

    /// A spike along z, 20 mm wide at z = 0 and with its tip at z = 40 mm.
    pub(crate) fn spike() -> Collider {
        let base = [[-0.01, -0.01], [0.01, -0.01], [0.01, 0.01], [-0.01, 0.01]];
        let mut vertices: Vec<Vec3> = base.iter().map(|[x, y]| Vec3::new(*x, *y, 0.0)).collect();
        vertices.push(Vec3::new(0.0, 0.0, 0.04));
        let triangles = vec![[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        Collider::new(&TriMesh { vertices, triangles }).expect("collider")
    }

    #[test]
    fn the_way_off_a_spike_is_over_its_tip() {
        let body = spike();
        let [left, right] = [-0.05, 0.05].map(|x| Vec3::new(x, 0.001, 0.03));
        assert!(body.is_in_the_way(left, right));
        let way = body.way_off(left, right).expect("it is cut");
        assert_relative_eq!(way, Vec3::z(), epsilon = 1e-6);
        let up = Vec3::z() * 0.011;
        assert!(!body.is_in_the_way(left + up, right + up) && body.way_off(left + up, right + up).is_none());
        // Level is square to what leans.
        let leaning = right + Vec3::z() * 0.004;
        let way = body.way_off(left, leaning).expect("it is cut");
        assert!(way.z > 0.9 && way.dot(&(leaning - left)).abs() < 1e-12, "{way:?}");
    }

    #[test]
    fn a_spike_pokes_through_a_triangle_whose_edges_it_does_not_cut() {
        let body = spike();
        let at = |z: f64| [[-0.05, -0.04], [0.05, -0.04], [0.0, 0.06]].map(|[x, y]| Vec3::new(x, y, z));
        let [a, b, c] = at(0.03);
        assert!(![(a, b), (b, c), (c, a)].iter().any(|&(p, q)| body.is_in_the_way(p, q)));
        assert_relative_eq!(body.poking([a, b, c]).expect("it is poked"), Vec3::z(), epsilon = 1e-6);
        assert!(body.poking(at(0.041)).is_none());
    }
}
