//! The body prepared for contact: its faces, convex edges and vertices.

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::{TriMesh as ParryMesh, TriMeshFlags};

use super::Feature;
use super::grid::Grid;
use crate::geometry::{Topology, TriMesh, Vec3};

/// Cosine of the angle between the faces of a body edge (0.001°) above which the edge counts as flat within rounding.
/// Every other convex edge makes contacts. Without these, a tight band of long cloth edges cuts a slightly bent face,
/// and is pushed out by one node and then the other without coming to rest.
const SHARP_EDGE: f64 = 1.0 - 1.5e-10;

/// A convex edge of the body.
pub(super) struct BodyEdge {
    pub(super) ends: Feature<2>,
    /// The third corners of its two faces.
    pub(super) beside: [u32; 2],
    /// Unit bisector of the normals of its two faces.
    pub(super) outward: Vec3,
}

/// A closed body prepared for contact. Built once, never moved.
pub struct Collider {
    pub(super) mesh: ParryMesh,
    pub(super) vertices: Vec<Feature<1>>,
    pub(super) normals: Vec<Vec3>,
    /// Vertices that share a face with each vertex.
    pub(super) neighbours: Vec<Vec<u32>>,
    pub(super) edges: Vec<BodyEdge>,
    pub(super) faces: Vec<Feature<3>>,
    pub(super) vertex_grid: Grid,
    pub(super) edge_grid: Grid,
    pub(super) face_grid: Grid,
    /// Height of the floor, metres.
    floor: Option<f64>,
}

/// The closest point of the body's surface.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// The closest point.
    pub point: Vec3,
    /// Unit outward direction there.
    pub normal: Vec3,
    /// Signed distance, negative inside.
    pub distance: f64,
}

pub(super) fn to_parry(v: Vec3) -> Vector {
    v.into()
}

pub(super) fn from_parry(v: Vector) -> Vec3 {
    v.into()
}

impl Collider {
    /// Prepares a closed, oriented mesh (`crate::io` has checked that it is one). `None` if parry refuses it.
    pub fn new(body: &TriMesh) -> Option<Self> {
        let flags = TriMeshFlags::ORIENTED | TriMeshFlags::MERGE_DUPLICATE_VERTICES;
        let vertices: Vec<_> = body.vertices.iter().map(|&v| to_parry(v)).collect();
        let mesh = ParryMesh::with_flags(vertices, body.triangles.clone(), flags).ok()?;
        let edges = convex_edges(body);
        let point_boxes: Vec<_> = body.vertices.iter().map(|&v| (v, v)).collect();
        let edge_boxes: Vec<_> = edges
            .iter()
            .map(|e| {
                let [a, b] = e.ends.corners;
                (a.inf(&b), a.sup(&b))
            })
            .collect();
        let faces: Vec<_> =
            (0..body.triangles.len()).map(|t| Feature { number: t as u32, corners: body.corners(t) }).collect();
        let face_boxes: Vec<_> = faces
            .iter()
            .map(|f| {
                let [a, b, c] = f.corners;
                (a.inf(&b).inf(&c), a.sup(&b).sup(&c))
            })
            .collect();
        // Cells about the size of a body triangle.
        let mean_area = body.area() / body.triangles.len().max(1) as f64;
        let cell = (2.0 * mean_area).sqrt().max(1e-4);
        Some(Self {
            mesh,
            vertex_grid: Grid::new(&point_boxes, cell),
            edge_grid: Grid::new(&edge_boxes, cell),
            face_grid: Grid::new(&face_boxes, cell),
            vertices: body.vertices.iter().zip(0..).map(|(&v, number)| Feature { number, corners: [v] }).collect(),
            normals: body.vertex_normals(),
            neighbours: neighbours(body),
            edges,
            faces,
            floor: None,
        })
    }

    /// Adds a floor at height `floor`, metres, on which cloth comes to lie.
    #[must_use]
    pub fn on_floor(mut self, floor: Option<f64>) -> Self {
        self.floor = floor;
        self
    }

    /// Height of the floor, metres.
    pub fn floor(&self) -> Option<f64> {
        self.floor
    }

    /// The closest point of the surface or the floor, if it is within `reach` of `p`.
    pub fn nearest(&self, p: Vec3, reach: f64) -> Option<Nearest> {
        let skin = self.nearest_skin(p, reach);
        let Some(floor) = self.floor.filter(|floor| p.y - floor < reach) else { return skin };
        let distance = p.y - floor;
        match skin {
            Some(skin) if skin.distance <= distance => Some(skin),
            _ => Some(Nearest { point: Vec3::new(p.x, floor, p.z), normal: Vec3::y(), distance }),
        }
    }

    /// The closest point of the surface, if it is within `reach` of `p`.
    pub(super) fn nearest_skin(&self, p: Vec3, reach: f64) -> Option<Nearest> {
        let (projection, (triangle, _)) =
            self.mesh.project_local_point_and_get_location_with_max_dist(to_parry(p), false, reach)?;
        let point = from_parry(projection.point);
        let away = p - point;
        let distance = away.norm();
        let sign = if projection.is_inside { -1.0 } else { 1.0 };
        // Within a nanometre of the surface the direction is rounding: use the triangle's own normal.
        let normal = if distance > 1e-9 {
            away * (sign / distance)
        } else {
            self.mesh.triangle(triangle).normal().map_or_else(Vec3::y, from_parry)
        };
        Some(Nearest { point, normal, distance: sign * distance })
    }
}

/// Vertices that share a face with each vertex of a closed mesh.
fn neighbours(body: &TriMesh) -> Vec<Vec<u32>> {
    let mut out = vec![Vec::new(); body.vertices.len()];
    for t in &body.triangles {
        for k in 0..3 {
            out[t[k] as usize].push(t[(k + 1) % 3]);
        }
    }
    out
}

/// Edges where the body is convex and not flat.
fn convex_edges(body: &TriMesh) -> Vec<BodyEdge> {
    let normals: Vec<Vec3> =
        (0..body.triangles.len()).map(|t| body.double_normal(t).try_normalize(0.0).unwrap_or_default()).collect();
    let mut out = Vec::new();
    for edge in Topology::new(&body.triangles).edges {
        let [Some(s), Some(t)] = edge.triangles else { continue };
        let (n, m) = (normals[s as usize], normals[t as usize]);
        let apex = |t: u32| body.triangles[t as usize].into_iter().find(|v| !edge.ends.contains(v));
        let (Some(left), Some(right)) = (apex(s), apex(t)) else { continue };
        let below = n.dot(&(body.vertices[right as usize] - body.vertices[edge.ends[0] as usize]));
        if n.dot(&m) < SHARP_EDGE && below < 0.0 {
            let outward = (n + m).try_normalize(0.0).unwrap_or_default();
            let corners = edge.ends.map(|v| body.vertices[v as usize]);
            let ends = Feature { number: out.len() as u32, corners };
            out.push(BodyEdge { ends, beside: [left, right], outward });
        }
    }
    out
}

#[cfg(test)]
pub(super) mod tests {
    use approx::assert_relative_eq;

    use super::*;

    /// A cube of a metre with a corner at the origin.
    pub(in crate::contact) fn cube() -> TriMesh {
        let vertices = (0..8).map(|i| Vec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2))).collect();
        let triangles = vec![
            [0, 2, 1],
            [1, 2, 3],
            [4, 5, 6],
            [5, 7, 6],
            [0, 1, 4],
            [1, 5, 4],
            [2, 6, 3],
            [3, 6, 7],
            [0, 4, 2],
            [2, 4, 6],
            [1, 3, 5],
            [3, 7, 5],
        ];
        TriMesh { vertices, triangles }
    }

    #[test]
    fn distance_is_negative_inside_and_the_normal_points_out() {
        let body = Collider::new(&cube()).expect("collider");
        let inside = body.nearest(Vec3::new(0.5, 0.9, 0.5), 1.0).expect("near");
        assert_relative_eq!(inside.distance, -0.1, epsilon = 1e-12);
        assert_relative_eq!(inside.normal, Vec3::y(), epsilon = 1e-12);
        let outside = body.nearest(Vec3::new(0.5, 1.2, 0.5), 1.0).expect("near");
        assert_relative_eq!(outside.distance, 0.2, epsilon = 1e-12);
        assert!(body.nearest(Vec3::new(0.5, 3.0, 0.5), 1.0).is_none());
    }

    #[test]
    fn the_floor_is_met_where_it_is_nearer_than_the_skin() {
        let body = Collider::new(&cube()).expect("collider").on_floor(Some(-0.5));
        let over = body.nearest(Vec3::new(3.0, -0.4, 3.0), 1.0).expect("near");
        assert_relative_eq!(over.distance, 0.1, epsilon = 1e-12);
        assert_relative_eq!(over.point, Vec3::new(3.0, -0.5, 3.0), epsilon = 1e-12);
        let beside = body.nearest(Vec3::new(0.5, -0.1, 0.5), 1.0).expect("near");
        assert_relative_eq!(beside.normal, -Vec3::y(), epsilon = 1e-12);
        assert_relative_eq!(
            body.nearest(Vec3::new(3.0, -0.7, 3.0), 1.0).expect("near").distance,
            -0.2,
            epsilon = 1e-12
        );
    }

    #[test]
    fn only_the_cubes_twelve_edges_are_convex() {
        assert_eq!(convex_edges(&cube()).len(), 12);
    }

    #[test]
    fn a_ridge_of_a_tenth_of_a_degree_is_an_edge() {
        let mut roof = cube();
        // Two opposite corners of the top lowered: its diagonal is 2 x 0.62 mm / 0.71 m = 0.1 degree sharp.
        roof.vertices[4].z -= 0.62e-3;
        roof.vertices[7].z -= 0.62e-3;
        assert_eq!(convex_edges(&roof).len(), 13);
    }
}
