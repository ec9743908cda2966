//! Contacts of cloth with vertices and convex edges of the body.

use super::body::{BodyEdge, Collider};
use super::{Contact, Feature, Under};
use crate::geometry::Vec3;

/// Sine of the slope by which a neighbour may rise over a body edge or vertex that still makes a contact. A contact
/// requires that no neighbour reaches higher along its direction. The margin keeps contacts from coming and going where
/// a face begins.
const LEVEL: f64 = 0.1;

/// Cosine of the angle (78°) to the outward direction of a body feature within which cloth counts as outside, whatever
/// lies beside the feature. In a cleft, the opposite side rises higher than the plane of the feature.
const FACING: f64 = 0.2;

/// Least share of a contact that cloth inside the body makes with a feature over it. Next to an end two neighbours
/// share the force, and both count.
const MEETS: f64 = 0.25;

impl Collider {
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

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::contact::body::tests::cube;
    use crate::geometry::TriMesh;

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
}
