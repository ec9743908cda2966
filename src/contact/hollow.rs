//! Contacts of a node with the faces of a hollow of the body.

use super::body::{Collider, Nearest};
use super::narrow::closest_on_triangle;
use super::{Contact, Feature, Under};
use crate::geometry::Vec3;

/// Cosine of the angle (37°) between two faces of a hollow below which only the nearest face pushes.
const SHALLOW: f64 = 0.8;
/// Cosine of the angle (66°) between two faces of a hollow above which both push. When the faces of a sharp hollow
/// pushed one at a time, cloth wedged in an armpit was thrown from one to the other for ever.
const SHARP: f64 = 0.4;

/// Height over a node's contact plane up to which another face counts as the same plane, metres.
const RISES: f64 = 1e-9;

impl Collider {
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
}

/// Share of the force of a face of a hollow beside the nearest one, by the cosine of the angle between the two.
fn share_in_hollow(cosine: f64) -> f64 {
    let sharp = ((SHALLOW - cosine) / (SHALLOW - SHARP)).clamp(0.0, 1.0);
    sharp * sharp * (3.0 - 2.0 * sharp)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::contact::Bounds;
    use crate::contact::body::tests::cube;
    use crate::geometry::TriMesh;

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
