//! The body prepared for contact: its faces, convex edges and vertices.

use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQueryWithLocation;
use parry3d_f64::shape::{TriMesh as ParryMesh, TriMeshFlags};

use super::grid::Grid;
use super::narrow::closest_on_triangle;
use super::{Contact, Feature, Under};
use crate::geometry::{Topology, TriMesh, Vec3};

/// Cosine of the angle between the faces of a body edge (0.001°) above which the edge counts as flat within rounding.
/// Every other convex edge makes contacts. Without these, a tight band of long cloth edges cuts a slightly bent face,
/// and is pushed out by one node and then the other without coming to rest.
const SHARP_EDGE: f64 = 1.0 - 1.5e-10;
/// Sine of the slope by which a neighbour may rise over a body edge or vertex that still makes a contact. A contact
/// requires that no neighbour reaches higher along its direction. The margin keeps contacts from coming and going where
/// a face begins.
const LEVEL: f64 = 0.1;

/// Cosine of the angle (78°) to the outward direction of a body feature within which cloth counts as outside, whatever
/// lies beside the feature. In a cleft, the opposite side rises higher than the plane of the feature.
const FACING: f64 = 0.2;

/// Cosine of the angle (37°) between two faces of a hollow below which only the nearest face pushes.
const SHALLOW: f64 = 0.8;
/// Cosine of the angle (66°) between two faces of a hollow above which both push. When the faces of a sharp hollow
/// pushed one at a time, cloth wedged in an armpit was thrown from one to the other for ever.
const SHARP: f64 = 0.4;

/// Height over a node's contact plane up to which another face counts as the same plane, metres.
const RISES: f64 = 1e-9;
/// Least share of a contact that cloth inside the body makes with a feature over it. Next to an end two neighbours
/// share the force, and both count.
const MEETS: f64 = 0.25;

/// A convex edge of the body.
pub(super) struct BodyEdge {
    pub(super) ends: Feature<2>,
    /// The third corners of its two faces.
    beside: [u32; 2],
    /// Unit bisector of the normals of its two faces.
    pub(super) outward: Vec3,
}

/// A closed body prepared for contact. Built once, never moved.
pub struct Collider {
    pub(super) mesh: ParryMesh,
    vertices: Vec<Feature<1>>,
    normals: Vec<Vec3>,
    /// Vertices that share a face with each vertex.
    neighbours: Vec<Vec<u32>>,
    pub(super) edges: Vec<BodyEdge>,
    faces: Vec<Feature<3>>,
    vertex_grid: Grid,
    pub(super) edge_grid: Grid,
    face_grid: Grid,
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

    fn nearest_skin(&self, p: Vec3, reach: f64) -> Option<Nearest> {
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

    /// Contacts of a `node` outside the body with faces of a hollow: faces within `reach` that rise over the plane
    /// through the point `nearest` to the node. That plane alone would let the node run into the next face. Of the
    /// faces that stand steeply on nearer ones the nearest pushes, and the others only keep the node off.
    pub fn faces_of_hollow<'b>(
        &'b self,
        x: &[Vec3],
        node: u32,
        nearest: &Nearest,
        reach: f64,
        out: &mut Vec<Contact<'b>>,
    ) {
        let p = x[node as usize];
        let mut faces = Vec::new();
        self.face_grid.query(p.add_scalar(-reach), p.add_scalar(reach), |t| {
            let face @ Feature { corners: [a, b, c], .. } = &self.faces[t as usize];
            let rises = |q: Vec3| nearest.normal.dot(&(q - nearest.point)) > RISES;
            if ![a, b, c].into_iter().any(|q| rises(*q)) {
                return;
            }
            let [k, l, m] = closest_on_triangle(p, *a, *b, *c);
            let away = p - (a * k + b * l + c * m);
            if away.norm() <= reach {
                faces.push((away.norm(), face, away));
            }
        });
        faces.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.number.cmp(&b.1.number)));
        let mut pushing = vec![nearest.normal];
        for (_, face, away) in faces {
            let [a, b, c] = face.corners;
            let normal = (b - a).cross(&(c - a)).normalize();
            let beside = |n: &Vec3| share_in_hollow(n.dot(&normal));
            // A face that faces away keeps the node off as well: the node may come round its edge.
            let facing = normal.dot(&away) > 0.0;
            let push = if facing { pushing.iter().map(beside).fold(1.0, f64::min) } else { 0.0 };
            if push > 0.0 {
                pushing.push(normal);
            }
            let under = Under::Face { face, push };
            out.extend(Contact::on_feature([node, 0, 0, 0], 1, under, away, x, f64::INFINITY));
        }
    }

    /// Adds the contacts of body vertices with the cloth triangle of nodes `tri`, within `reach`. Returns whether any
    /// were left out because neighbours hide them. A slight turn may bring these out.
    pub fn vertices_near_triangle<'b>(
        &'b self,
        x: &[Vec3],
        tri: [u32; 3],
        reach: f64,
        out: &mut Vec<Contact<'b>>,
    ) -> bool {
        let mut hidden = false;
        let [a, b, c] = tri.map(|n| x[n as usize]);
        let low = a.inf(&b).inf(&c).add_scalar(-reach);
        let high = a.sup(&b).sup(&c).add_scalar(reach);
        self.vertex_grid.query(low, high, |v| {
            let vertex @ Feature { corners: [at], .. } = &self.vertices[v as usize];
            let outward = self.normals[v as usize];
            if [a, b, c].iter().all(|x| outward.dot(&(x - at)) > reach) {
                return;
            }
            let under = Under::Vertex(vertex);
            let nodes = [tri[0], tri[1], tri[2], 0];
            hidden |= self.meet(nodes, 3, under, outward, &self.neighbours[v as usize], x, reach, out);
        });
        hidden
    }

    /// Adds the contacts of the body's convex edges with the cloth edge `ends`, within `reach`. Returns whether any
    /// were left out because neighbours hide them.
    pub fn edges_near_edge<'b>(&'b self, x: &[Vec3], ends: [u32; 2], reach: f64, out: &mut Vec<Contact<'b>>) -> bool {
        let mut hidden = false;
        let [a, b] = ends.map(|n| x[n as usize]);
        let (low, high) = (a.inf(&b).add_scalar(-reach), a.sup(&b).add_scalar(reach));
        self.edge_grid.query(low, high, |e| {
            let BodyEdge { ends: edge @ Feature { corners: [p, q], .. }, beside, outward } = &self.edges[e as usize];
            let highest = outward.dot(p).max(outward.dot(q));
            if outward.dot(&a).min(outward.dot(&b)) - highest > reach {
                return;
            }
            let under = Under::Edge(edge);
            hidden |= self.meet([ends[0], ends[1], 0, 0], 2, under, *outward, beside, x, reach, out);
        });
        hidden
    }

    /// Adds the contact of cloth with a feature of the body within `reach`, unless a neighbour `beside` the feature is
    /// met first. Returns whether it was left out.
    #[expect(clippy::too_many_arguments, reason = "two primitives and where they may meet")]
    fn meet<'b>(
        &self,
        nodes: [u32; 4],
        count: u8,
        under: Under<'b>,
        outward: Vec3,
        beside: &[u32],
        x: &[Vec3],
        reach: f64,
        out: &mut Vec<Contact<'b>>,
    ) -> bool {
        let Some(mut contact) = Contact::on_feature(nodes, count, under, outward, x, reach) else { return false };
        let mut gap = contact.gap(x);
        // In a cleft cloth may be under a feature and outside all the same.
        if gap < 0.0 && !self.holds(contact.closest(x), reach) {
            contact.turn_over();
            gap = -gap;
        }
        let faces = gap > 0.0 && contact.normal.dot(&outward) > FACING;
        let pushes = contact.share >= MEETS || gap > 0.0;
        let at = contact.closest(x) - contact.normal * gap;
        let met = pushes && (faces || self.is_highest(at, contact.normal, beside));
        if met {
            out.push(contact);
        }
        !met
    }

    /// Whether `p`, not further than `reach` from the surface, is inside the body.
    fn holds(&self, p: Vec3, reach: f64) -> bool {
        self.nearest_skin(p, reach).is_some_and(|nearest| nearest.distance < 0.0)
    }

    /// Whether the body's vertices `around` lie no higher than `p` along `normal`. Only then does cloth from that
    /// direction meet the feature at `p` rather than a face beside it.
    fn is_highest(&self, p: Vec3, normal: Vec3, around: &[u32]) -> bool {
        around.iter().all(|&v| {
            let d = self.vertices[v as usize].corners[0] - p;
            normal.dot(&d) <= LEVEL * d.norm()
        })
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

/// Share of the force of a face of a hollow beside the nearest one, by the cosine of the angle between the two.
fn share_in_hollow(cosine: f64) -> f64 {
    let sharp = ((SHALLOW - cosine) / (SHALLOW - SHARP)).clamp(0.0, 1.0);
    sharp * sharp * (3.0 - 2.0 * sharp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Bounds;
    use approx::assert_relative_eq;

    fn cube() -> TriMesh {
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

    #[test]
    fn a_corner_under_a_triangle_is_found() {
        let body = Collider::new(&cube()).expect("collider");
        let x = [Vec3::new(0.8, 1.01, 1.3), Vec3::new(1.3, 1.01, 1.3), Vec3::new(1.0, 1.01, 0.7)];
        let mut out = Vec::new();
        body.vertices_near_triangle(&x, [0, 1, 2], 0.05, &mut out);
        assert_eq!(out.len(), 1);
        assert_relative_eq!(out[0].gap(&x), 0.01, epsilon = 1e-12);
    }

    #[test]
    fn an_edge_is_met_from_over_it_and_not_from_beside() {
        let body = Collider::new(&cube()).expect("collider");
        let contacts = |x: [Vec3; 2]| {
            let mut out = Vec::new();
            body.edges_near_edge(&x, [0, 1], 0.05, &mut out);
            out.iter().map(|c| c.gap(&x)).collect::<Vec<_>>()
        };
        // Over the edge x = y = 1, at 45°, 10 mm off it.
        let off = 1.0 + 0.01 / 2f64.sqrt();
        let over = contacts([Vec3::new(off - 0.1, off + 0.1, 0.4), Vec3::new(off + 0.1, off - 0.1, 0.6)]);
        assert_eq!(over.len(), 1, "{over:?}");
        assert_relative_eq!(over[0], 0.01, epsilon = 1e-3);
        // Before the face x = 1, its middle 10 mm off it and 30 mm below the edge: that face's business. Taken for the
        // edge's it would lie 32 mm under it.
        let before = contacts([Vec3::new(1.0024, 0.9675, 0.499), Vec3::new(1.0176, 0.9725, 0.501)]);
        assert!(before.iter().all(|gap| *gap > 0.0), "{before:?}");
    }

    #[test]
    fn an_edge_slides_over_a_corner_of_the_body_without_a_jolt() {
        // Two triangles with a common edge above the tip of a blunt pyramid: what pushes is handed from one triangle to
        // the other, and from one of the tip's edges to the next.
        let tip = Vec3::y() * 0.2;
        let vertices = vec![Vec3::x(), -Vec3::x(), tip, -tip, Vec3::z(), -Vec3::z()];
        let upper = [[2, 4, 0], [2, 1, 4], [2, 5, 1], [2, 0, 5]];
        let triangles = upper.into_iter().flat_map(|[a, b, c]| [[a, b, c], [3, c, b]]).collect();
        let body = Collider::new(&TriMesh { vertices, triangles }).expect("collider");
        let push = |shift: f64| {
            let x = [[-0.3, 0.21, 0.11], [0.3, 0.21, 0.08], [0.02, 0.2, 0.5], [0.04, 0.2, -0.3]]
                .map(|[x, y, z]| Vec3::new(x, y, z - shift));
            let mut found = Vec::new();
            body.edges_near_edge(&x, [0, 1], 0.1, &mut found);
            body.vertices_near_triangle(&x, [0, 1, 2], 0.1, &mut found);
            body.vertices_near_triangle(&x, [0, 3, 1], 0.1, &mut found);
            found.iter().map(|c| c.normal * (c.share * (0.1 - c.gap(&x)))).sum::<Vec3>()
        };
        let mut last = push(0.0);
        for step in 1..=2000 {
            let now = push(1e-4 * f64::from(step));
            assert!((now - last).norm() < 0.01, "step {step}: from {last:?} to {now:?}");
            assert!(now.y > 0.02, "step {step}: nothing holds the cloth");
            last = now;
        }
    }

    #[test]
    fn a_node_in_a_hollow_is_kept_out_of_every_face_of_it() {
        // The cube with a pit in its upper face.
        let TriMesh { mut vertices, mut triangles } = cube();
        vertices.push(Vec3::new(0.5, 0.5, 0.6));
        triangles.retain(|t| t.iter().any(|&v| v < 4));
        triangles.extend([[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]]);
        let body = Collider::new(&TriMesh { vertices, triangles }).expect("collider");
        let planes = |p: Vec3| {
            let nearest = body.nearest(p, 0.2).expect("near");
            let mut out = vec![Contact::on_body(0, nearest.normal, nearest.point)];
            body.faces_of_hollow(&[p], 0, &nearest, 0.2, &mut out);
            out
        };
        let from = [Vec3::new(0.53, 0.5, 0.66)];
        let pit = planes(from[0]);
        assert_eq!(pit.len(), 4, "the face it is nearest to and the three others: {pit:?}");
        assert!(pit.iter().all(|c| c.gap(&from) > 0.0));
        let mut to = [Vec3::new(0.45, 0.5, 0.62)];
        assert!(body.nearest(to[0], 1.0).expect("near").distance < 0.0);
        Bounds::new(&from, 1.0, 1e-3).clamp(&pit.iter().collect::<Vec<_>>(), &from, &mut to);
        assert!(body.nearest(to[0], 1.0).expect("near").distance > 0.0, "{to:?}");
        // Over the rim of the cube nothing rises.
        assert_eq!(planes(Vec3::new(1.02, 0.5, 0.9)).len(), 1);
    }

    /// From y = −1 to 1 along y, with this profile (x, z), counter-clockwise and seen whole from its first point.
    fn prism<const N: usize>(profile: [[f64; 2]; N]) -> TriMesh {
        let n = N as u32;
        let vertices = [1.0, -1.0].iter().flat_map(|y| profile.map(|[x, z]| Vec3::new(x, *y, z))).collect();
        let sides = (0..n).flat_map(|k| {
            let next = (k + 1) % n;
            [[k, next + n, k + n], [k, next, next + n]]
        });
        let caps = (1..n - 1).flat_map(|k| [[0, k + 1, k], [n, k + n, k + 1 + n]]);
        TriMesh { vertices, triangles: sides.chain(caps).collect() }
    }

    /// Force direction on a node at (x, 0, z) from the sides of a groove, `steep` radians from level, that keep it 10
    /// mm off.
    fn pushed_in_groove(steep: f64, x: f64, z: f64) -> Vec3 {
        // A block 2 wide and 1 high with a groove along y in its upper face.
        let rise = 0.5 * steep.tan();
        let profile =
            [[0.0, -1.0], [1.0, -1.0], [1.0, rise], [0.5, rise], [0.0, 0.0], [-0.5, rise], [-1.0, rise], [-1.0, -1.0]];
        let body = Collider::new(&prism(profile)).expect("collider");
        let at = [Vec3::new(x, 0.13, z)];
        let nearest = body.nearest(at[0], 0.1).expect("near");
        let mut found = vec![Contact::on_body(0, nearest.normal, nearest.point)];
        body.faces_of_hollow(&at, 0, &nearest, 0.1, &mut found);
        found.iter().map(|c| c.normal * (c.share * (0.01 - c.gap(&at)).max(0.0))).sum()
    }

    #[test]
    fn both_sides_of_a_sharp_groove_push_and_of_a_shallow_one_the_nearest() {
        let (sharp, shallow) = (50f64.to_radians(), 10f64.to_radians());
        // 5 mm over the bottom, on one side of the middle and on the other: no jolt between.
        let [left, right] = [-1e-8, 1e-8].map(|x| pushed_in_groove(sharp, x, 5e-3));
        assert!((left - right).norm() < 1e-4 * left.norm(), "{left:?} {right:?}");
        // As far from either side as it is from the bottom along their normals.
        assert_relative_eq!(left.z, 2.0 * (0.01 - 5e-3 * sharp.cos()) * sharp.cos(), epsilon = 1e-6);
        assert_relative_eq!(left.x, 0.0, epsilon = 1e-6);
        let one = pushed_in_groove(shallow, 1e-8, 5e-3);
        assert_relative_eq!(one.norm(), 0.01 - 5e-3 * shallow.cos(), epsilon = 1e-6);
    }

    #[test]
    fn cloth_beside_a_blade_is_not_pushed_through_it() {
        // A blade 20° sharp with its edge along z on top.
        let w = 0.2 * 10f64.to_radians().tan();
        let vertices =
            [1.0, -1.0].iter().flat_map(|&z| [[0.0, 0.0], [-w, -0.2], [w, -0.2]].map(|[x, y]| Vec3::new(x, y, z)));
        let triangles = vec![[0, 1, 2], [3, 5, 4], [0, 2, 5], [0, 5, 3], [2, 1, 4], [2, 4, 5], [1, 0, 3], [1, 3, 4]];
        let blade = TriMesh { vertices: vertices.collect(), triangles };
        let body = Collider::new(&blade).expect("collider");
        assert!(body.holds(Vec3::new(0.0, -0.1, 0.0), 0.1));
        let mut seen = 0;
        for lower in [-1e-4, 0.0, 1e-4, 2e-4] {
            // A cloth edge beside the upper end of its right side, nearest to its edge a little lower than that.
            let nearest = Vec3::new(1e-3, -lower, 0.0);
            let along = Vec3::new(lower / 1e-3, 1.0, 1.5).normalize() * 3e-3;
            let x = [nearest - along, nearest + along];
            let mut found = Vec::new();
            let hidden = body.edges_near_edge(&x, [0, 1], 0.01, &mut found);
            assert!(hidden || !found.is_empty());
            seen += found.len();
            assert!(found.iter().all(|c| c.gap(&x) > 0.0 && c.normal.x > 0.0), "{lower}: {found:?}");
        }
        assert!(seen > 0, "its edge is never met");
    }

    #[test]
    fn a_face_of_a_hollow_bars_the_way_through_it_and_not_past_it() {
        let corners = [Vec3::new(0.0, 0.0, -1.0), Vec3::new(0.0, 0.0, 1.0), Vec3::new(-1.0, 0.0, 0.0)];
        let mut x = [Vec3::new(-0.02, 0.01, 0.0)];
        let face = Feature { number: 0, corners };
        let under = Under::Face { face: &face, push: 0.0 };
        let mut face = Contact::on_feature([0; 4], 1, under, Vec3::y(), &x, 1.0).expect("apart");
        let bounds = Bounds::new(&x, 1.0, 1e-3);
        let mut through = [Vec3::new(-0.2, -0.01, 0.0)];
        bounds.clamp(&[&face], &x, &mut through);
        assert!(through[0].y > 0.0, "{through:?}");
        // Beyond the face's edge, and then lower than the face.
        for _ in 0..12 {
            let wish = [x[0] + Vec3::new(0.01, -0.00125, 0.0)];
            let mut to = wish;
            bounds.clamp(&[&face], &x, &mut to);
            assert_eq!(to, wish);
            x = to;
            assert!(face.refresh(&x));
        }
        assert!(x[0].y < 0.0);
    }

    #[test]
    fn both_sides_of_a_ridge_bar_the_way_of_a_node_beside_it() {
        // A slab with a ridge along y.
        let profile =
            [[0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.1, 0.0], [0.0, 0.2], [-0.1, 0.0], [-1.0, 0.0], [-1.0, -1.0]];
        let body = prism(profile);
        let volume: f64 = (0..body.triangles.len()).map(|t| body.double_normal(t).dot(&body.corners(t)[0])).sum();
        assert!(volume > 0.0, "inside out");
        let body = Collider::new(&body).expect("collider");
        let x = [Vec3::new(-0.12, 0.3, 0.01)];
        let nearest = body.nearest(x[0], 1.0).expect("near");
        assert_relative_eq!(nearest.normal, Vec3::z(), epsilon = 1e-9);
        let mut found = Vec::new();
        body.faces_of_hollow(&x, 0, &nearest, 0.4, &mut found);
        let beyond =
            |c: &Contact| matches!(c.under, Under::Face { face, .. } if face.corners.iter().any(|p| p.x > 0.05));
        assert!(found.iter().any(beyond), "{found:?}");
        assert!(found.iter().all(|c| c.gap(&x) > 0.0));
        // The side that the node sees pushes, the one beyond only bars the way.
        assert!(found.iter().all(|c| if beyond(c) { c.share == 0.0 } else { c.normal.x < 0.0 }), "{found:?}");
        assert_eq!(found.iter().filter(|c| c.share > 0.0).count(), 1, "{found:?}");
    }
}
