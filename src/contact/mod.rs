//! Contact: cloth with the body and cloth with cloth (F6, F14). The only user of parry.
//!
//! The broad phase finds every pair of primitives closer than a *reach* and makes a [`Contact`] of it: a direction and
//! the weights of its nodes, both updated as the pair moves.
//!
//! **Guarantee.** Cloth that starts without a crossing ends without one.
//! - A pair that was not found cannot meet. No node goes further than about half the reach ([`Bounds::allowance`],
//!   [`Bounds::allowances_after_all`]) from where it was last searched, and near the body no further than the search
//!   radius for its features.
//! - A pair that was found is kept apart along a direction between its two sides ([`Bounds`]).
//!
//! **Exceptions.**
//! - Pairs that are left out on purpose: those within one smooth sheet, both sides of a seam that jams in the last
//!   phase, and features of the body that a neighbour hides.
//! - While seams are closed in long steps: edges, vertices and faces of hollows of the body further off than about
//!   three millimetres.

mod body;
mod bounds;
mod cloth;
mod cloth_search;
mod cut;
mod features;
mod grid;
mod hollow;
mod kept_apart;
mod narrow;
mod neighbourhood;
mod patches;
mod skin;
mod swept;
mod tangle;

pub use body::{Collider, Nearest};
pub use bounds::Bounds;
pub use cloth::ClothDetector;
#[cfg(test)]
pub(crate) use cut::tests::spike;
use narrow::{closest_on_lines, on_plane};
pub use narrow::{closest_on_segments, closest_on_triangle, nearest_on_surface};
pub use neighbourhood::Neighbourhood;
pub use skin::Skin;
pub use swept::{Hit, swept_point_triangle};
pub use tangle::Tangle;

use crate::geometry::Vec3;

/// Share of an edge or triangle, on either side of its end, over which a contact fades into its neighbour. Without the
/// fade an edge that lies across a vertex of the body would be pushed by one, two or three contacts in turn, and never
/// rest.
const BLEND: f64 = 0.1;
/// Cosine of the angle (75°) between contact direction and upright direction at which a contact beyond an end has faded
/// to nothing.
const SIDEWAYS: f64 = 0.25;
/// Sine of the angle between two edges below which their contact fades. Nearly parallel edges have no definite closest
/// points, and contacts of their ends take over.
const PARALLEL: f64 = 0.02;

/// A vertex, an edge or a face of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Feature<const N: usize> {
    /// Its number among those of its kind.
    pub number: u32,
    /// Its corners.
    pub corners: [Vec3; N],
}

/// The lower side of a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Under<'b> {
    /// Cloth: the nodes after the first [`Contact::above`].
    Cloth,
    /// The plane through the point of the body's surface that was nearest to a node.
    Plane,
    /// A face of a hollow of the body, beside the one nearest to a node.
    Face {
        /// The face.
        face: &'b Feature<3>,
        /// Share of its force, 0 … 1. In a sharp hollow it pushes beside the nearest face, in a shallow one not until
        /// it is the nearest.
        push: f64,
    },
    /// A vertex of the body, under a triangle.
    Vertex(&'b Feature<1>),
    /// A convex edge of the body, under an edge.
    Edge(&'b Feature<2>),
}

impl Under<'_> {
    /// The number of the body's face, vertex or edge.
    pub(crate) fn number(&self) -> Option<u32> {
        match self {
            Self::Cloth | Self::Plane => None,
            Self::Face { face, .. } => Some(face.number),
            Self::Vertex(vertex) => Some(vertex.number),
            Self::Edge(edge) => Some(edge.number),
        }
    }

    /// The corners of the body's feature.
    fn points(&self) -> &[Vec3] {
        match self {
            Self::Cloth | Self::Plane => &[],
            Self::Face { face, .. } => &face.corners,
            Self::Vertex(vertex) => &vertex.corners,
            Self::Edge(edge) => &edge.corners,
        }
    }
}

/// A pair of primitives near each other, reduced to its gap = normal · Σ wᵢ xᵢ − offset, metres.
///
/// A garment has a hundred thousand of them, and each search moves them in memory. So they refer to the corners of the
/// body instead of holding them.
#[derive(Clone, Copy, Debug)]
pub struct Contact<'b> {
    /// Nodes that take part. Only the first [`Contact::count`] are used.
    pub nodes: [u32; 4],
    /// Their weights: +1 in sum on the side the normal points to, −1 on the other (or 0 if that side is the body).
    pub weights: [f64; 4],
    /// Number of nodes in use, 1 to 4.
    pub count: u8,
    /// Unit direction that opens the gap.
    pub normal: Vec3,
    /// Position of the body's surface along the normal. 0 between cloth and cloth.
    pub offset: f64,
    /// The other side.
    pub under: Under<'b>,
    /// Number of nodes, counted from the first, on the side that the normal points to.
    pub above: u8,
    /// Share of the contact force, 0 … 1. It falls to 0 as the closest point passes the end of an edge, where a
    /// neighbour takes over. At 0 the pair is only kept apart.
    pub share: f64,
}

impl<'b> Contact<'b> {
    /// A node and the body's surface, of unit direction `normal` at `point`.
    pub(crate) fn on_body(node: u32, normal: Vec3, point: Vec3) -> Self {
        Self {
            nodes: [node, 0, 0, 0],
            weights: [1.0, 0.0, 0.0, 0.0],
            count: 1,
            normal,
            offset: normal.dot(&point),
            under: Under::Plane,
            above: 1,
            share: 1.0,
        }
    }

    /// The first `count` of `nodes` above a vertex, an edge or a hollow's face of the body, whose outward direction is
    /// `outward`. `None` if they touch, or are not within `reach`.
    pub(crate) fn on_feature(
        nodes: [u32; 4],
        count: u8,
        under: Under<'b>,
        outward: Vec3,
        x: &[Vec3],
        reach: f64,
    ) -> Option<Self> {
        let (weights, normal) = ([0.0; 4], outward);
        let mut out = Self { nodes, weights, count, normal, offset: 0.0, under, above: count, share: 1.0 };
        out.refresh_within(x, reach).then_some(out)
    }

    /// Two primitives of the cloth at positions `x`: a vertex and a triangle if one node is `above`, two edges if two
    /// are. `None` if they touch, or are not within `reach`.
    pub(crate) fn within_cloth(nodes: [u32; 4], above: u8, x: &[Vec3], reach: f64) -> Option<Self> {
        let (weights, normal) = ([0.0; 4], Vec3::zeros());
        let under = Under::Cloth;
        let mut out = Self { nodes, weights, count: 4, normal, offset: 0.0, under, above, share: 1.0 };
        out.refresh_within(x, reach).then_some(out)
    }

    /// Whether the other side is the body.
    pub fn is_on_body(&self) -> bool {
        self.under != Under::Cloth
    }

    /// The gap at positions `x`, metres.
    pub fn gap(&self, x: &[Vec3]) -> f64 {
        let mut sum = -self.offset;
        for (&node, &w) in self.nodes.iter().zip(&self.weights).take(self.count as usize) {
            sum += w * self.normal.dot(&x[node as usize]);
        }
        sum
    }

    /// Updates direction and weights to the present closest points. A plane under a node stays.
    ///
    /// A pair whose closest point is beyond the end of an edge, or beyond the rim of a triangle over a vertex of the
    /// body, no longer pushes, because a neighbouring pair does. Returns `false`, and changes nothing, if the two
    /// touch.
    pub fn refresh(&mut self, x: &[Vec3]) -> bool {
        self.refresh_within(x, f64::INFINITY)
    }

    /// As [`Contact::refresh`], but also returns `false` and changes nothing if the pair is not within `reach`.
    fn refresh_within(&mut self, x: &[Vec3], reach: f64) -> bool {
        let Some((weights, away)) = self.closest_points(x) else { return true };
        let distance = away.norm();
        if distance == 0.0 || distance >= reach {
            return false;
        }
        // Cloth inside the body must come back the way it went in.
        let inside = self.is_on_body() && away.dot(&self.normal) < 0.0;
        (self.weights, self.share) = (weights, self.share_at(x, away));
        self.normal = away / if inside { -distance } else { distance };
        if self.is_on_body() {
            self.offset = self.normal.dot(&(self.closest(x) - away));
        }
        true
    }

    /// Weights of the closest points of a pair of primitives, and the vector from the lower to the upper one. `None`
    /// over a plane.
    fn closest_points(&self, x: &[Vec3]) -> Option<([f64; 4], Vec3)> {
        let at = |k: usize| x[self.nodes[k] as usize];
        Some(match self.under {
            Under::Plane => return None,
            Under::Cloth if self.above == 1 => {
                let w = closest_on_triangle(at(0), at(1), at(2), at(3));
                ([1.0, -w[0], -w[1], -w[2]], at(0) - (at(1) * w[0] + at(2) * w[1] + at(3) * w[2]))
            }
            Under::Cloth => {
                let (a, b, c, d) = (at(0), at(1), at(2), at(3));
                let (s, t) = closest_on_segments(a, b, c, d);
                ([1.0 - s, s, t - 1.0, -t], a + (b - a) * s - c - (d - c) * t)
            }
            Under::Face { face: &Feature { corners: [p, q, r], .. }, .. } => {
                let [k, l, m] = closest_on_triangle(at(0), p, q, r);
                ([1.0, 0.0, 0.0, 0.0], at(0) - (p * k + q * l + r * m))
            }
            Under::Vertex(&Feature { corners: [p], .. }) => {
                let [k, l, m] = closest_on_triangle(p, at(0), at(1), at(2));
                ([k, l, m, 0.0], at(0) * k + at(1) * l + at(2) * m - p)
            }
            Under::Edge(&Feature { corners: [p, q], .. }) => {
                let (a, b) = (at(0), at(1));
                let (s, t) = closest_on_segments(a, b, p, q);
                ([1.0 - s, s, 0.0, 0.0], a + (b - a) * s - p - (q - p) * t)
            }
        })
    }

    /// The share of a pair whose closest points are `away` from each other.
    fn share_at(&self, x: &[Vec3], away: Vec3) -> f64 {
        let at = |k: usize| x[self.nodes[k] as usize];
        match self.under {
            Under::Plane => 1.0,
            Under::Cloth if self.above == 1 => 1.0,
            Under::Cloth => share_of_edges(at(0), at(1), at(2), at(3), away.norm()),
            Under::Face { face: &Feature { corners: [p, q, r], .. }, push } => {
                push * upright((q - p).cross(&(r - p)).normalize().dot(&away) / away.norm())
            }
            Under::Vertex(vertex) => share_of_triangle(vertex.corners[0], at(0), at(1), at(2), away.norm()),
            Under::Edge(&Feature { corners: [p, q], .. }) => share_of_edges(at(0), at(1), p, q, away.norm()),
        }
    }

    /// Reverses the direction: the cloth then counts as being on the other side.
    pub(crate) fn turn_over(&mut self) {
        (self.normal, self.offset) = (-self.normal, -self.offset);
    }

    /// The point of the cloth over the body that is closest to it.
    fn closest(&self, x: &[Vec3]) -> Vec3 {
        self.parts().map(|(n, w)| x[n] * w).sum()
    }

    /// Its nodes and their weights.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.nodes.iter().zip(&self.weights).take(self.count as usize).map(|(&n, &w)| (n as usize, w))
    }
}

/// Remaining share of a contact whose closest point lies at parameter `s` of an edge of `long` metres (ends at 0 and
/// 1), at a distance of `apart` metres.
fn left(s: f64, long: f64, apart: f64) -> f64 {
    let inner = s.min(1.0 - s);
    let faded = ((inner + BLEND) / (2.0 * BLEND)).clamp(0.0, 1.0);
    let sine = (-inner * long / apart).clamp(0.0, 1.0);
    faded * faded * (3.0 - 2.0 * faded) * upright((1.0 - sine * sine).sqrt())
}

/// Remaining share of a contact whose direction has this `cosine` with the upright direction.
fn upright(cosine: f64) -> f64 {
    ((cosine - SIDEWAYS) / (1.0 - SIDEWAYS)).max(0.0)
}

/// Share of the contact of two edges.
fn share_of_edges(a: Vec3, b: Vec3, c: Vec3, d: Vec3, apart: f64) -> f64 {
    let (first, second) = (b - a, d - c);
    let (long, wide) = (first.norm(), second.norm());
    let sine = first.cross(&second).norm() / (long * wide);
    // Parallel edges, or an edge without length.
    if sine.is_nan() || sine == 0.0 {
        return 0.0;
    }
    let (s, t) = closest_on_lines(a, b, c, d);
    // Lines that are parallel within rounding may have closest points that are not finite.
    (left(s, long, apart) * left(t, wide, apart) * (sine / PARALLEL).min(1.0)).max(0.0)
}

/// Share of the contact of a triangle and the point `p`.
fn share_of_triangle(p: Vec3, a: Vec3, b: Vec3, c: Vec3, apart: f64) -> f64 {
    let double_area = (b - a).cross(&(c - a)).norm();
    let sides = [(c - b).norm(), (a - c).norm(), (b - a).norm()];
    let foot = on_plane(p, a, b, c);
    // A triangle without area has no foot, and no share.
    (0..3).map(|k| left(foot[k], double_area / sides[k], apart)).product::<f64>().max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_that_are_parallel_but_for_rounding_have_a_share() {
        for k in 1..2000 {
            let k = f64::from(k);
            let d = Vec3::new(k.cos(), k.sin(), 0.3 * (2.0 * k).sin());
            let apart = Vec3::z() * 0.01;
            let share = share_of_edges(Vec3::zeros(), d, apart, apart + d * (0.1 * k), 0.01);
            assert!((0.0..=1e-6).contains(&share), "{k}: {share}");
        }
    }

    #[test]
    fn the_gap_over_a_feature_is_the_distance_from_it_also_over_its_ends() {
        let number = |k: u32| (43_758.5 * (12.9898 * f64::from(k)).sin()).fract();
        let point = |k: u32| Vec3::new(number(k), number(k + 1), number(k + 2));
        for trial in 0..500 {
            let x: Vec<Vec3> = (0..3).map(|i| point(100 * trial + 3 * i)).collect();
            let [p, q] = [20, 30].map(|k| point(100 * trial + k));
            let up = Vec3::y();
            let feature = Feature { number: 0, corners: [p, q] };
            let edge = Contact::on_feature([0, 1, 0, 0], 2, Under::Edge(&feature), up, &x, 9.0).expect("apart");
            // No pair of points of the two is nearer, and one is as near.
            let sampled = (0..=100 * 100)
                .map(|k| (f64::from(k / 100) / 100.0, f64::from(k % 101) / 100.0))
                .map(|(s, t)| (x[0].lerp(&x[1], s) - p.lerp(&q, t)).norm())
                .fold(f64::INFINITY, f64::min);
            let gap = edge.gap(&x).abs();
            assert!(gap <= sampled + 1e-12 && gap > sampled - 0.03, "{trial}: a gap of {gap}, {sampled} apart");
            let feature = Feature { number: 0, corners: [p] };
            let corner = Contact::on_feature([0, 1, 2, 0], 3, Under::Vertex(&feature), up, &x, 9.0).expect("apart");
            let [k, l, m] = closest_on_triangle(p, x[0], x[1], x[2]);
            let expected = (x[0] * k + x[1] * l + x[2] * m - p).norm();
            assert!((corner.gap(&x).abs() - expected).abs() < 1e-12, "{trial}");
        }
    }
}
