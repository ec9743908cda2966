//! Contact: cloth with the body and cloth with cloth (F6, F14). The only user of parry.
//!
//! Detection finds every pair of primitives closer than a *reach* and turns it into a [`Contact`]: a direction and the
//! weights of the nodes that take part, both turned with the pair as it moves. Between two detections no node moves
//! further than [`Bounds::allowance`], so a pair that was not found cannot meet; a pair that was found is kept apart by a
//! plane between its two sides ([`Bounds`]). Cloth that starts without a crossing therefore ends without one. The
//! exceptions: pairs left out on purpose (neighbours in the cloth, both sides of a seam that is being closed); a node over
//! a hollow of the body, which is held to the plane of the last detection only; and, while seams are closed in long
//! steps, edges and vertices of the body further off than they are looked for.

mod body;
mod bounds;
mod cloth;
mod grid;
mod narrow;
mod swept;
mod tangle;

pub use body::{Collider, Nearest};
pub use bounds::Bounds;
pub use cloth::{ClothDetector, Neighbourhood};
pub use narrow::{closest_on_segments, closest_on_triangle};
pub use swept::{Hit, swept_point_triangle};
pub use tangle::Tangle;

use crate::geometry::Vec3;

/// An edge that encloses less than this angle (sine) with one of the body has no point where it meets it: its ends push.
const PARALLEL: f64 = 1e-2;

/// What the nodes of a contact are above of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Under {
    /// Cloth: the nodes after the first [`Contact::above`].
    Cloth,
    /// The plane through the point of the body's surface that was nearest to a node.
    Plane,
    /// A vertex of the body, under a triangle.
    Vertex {
        /// Its number.
        number: u32,
        /// Where it is.
        at: Vec3,
    },
    /// A convex edge of the body, under an edge.
    Edge {
        /// Its number.
        number: u32,
        /// Its ends.
        ends: [Vec3; 2],
    },
}

impl Under {
    /// The corners of the body's feature.
    fn points(&self) -> &[Vec3] {
        match self {
            Self::Cloth | Self::Plane => &[],
            Self::Vertex { at, .. } => std::slice::from_ref(at),
            Self::Edge { ends, .. } => ends,
        }
    }
}

/// A pair of primitives near each other, as one number: gap = normal · Σ wᵢ xᵢ − offset, metres.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Nodes that take part; the first [`Contact::count`] are meant.
    pub nodes: [u32; 4],
    /// Their weights: +1 in sum on the side the normal points to, −1 on the other (or 0 if that side is the body).
    pub weights: [f64; 4],
    /// How many of the four are used.
    pub count: u8,
    /// Unit direction that opens the gap.
    pub normal: Vec3,
    /// Position of the body's surface along the normal; 0 between cloth and cloth.
    pub offset: f64,
    /// What is on the other side.
    pub under: Under,
    /// How many of the nodes, counted from the first, are on the side the normal points to.
    pub above: u8,
    /// Whether it pushes; a pair of edges that are nearest at an end of one is only kept apart.
    pub pushes: bool,
}

impl Contact {
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
            pushes: true,
        }
    }

    /// The first `count` of `nodes` above a vertex or an edge of the body, from which `outward` leads away; turned to
    /// where their closest points are. `None` where they meet in a point.
    pub(crate) fn on_feature(nodes: [u32; 4], count: u8, under: Under, outward: Vec3, x: &[Vec3]) -> Option<Self> {
        let (weights, normal) = ([0.0; 4], outward);
        let mut out = Self { nodes, weights, count, normal, offset: 0.0, under, above: count, pushes: true };
        out.refresh(x).then_some(out)
    }

    /// Two primitives of the cloth at positions `x`: a vertex and a triangle if one node is `above`, two edges if two
    /// are. `None` where they meet in a point.
    pub(crate) fn within_cloth(nodes: [u32; 4], above: u8, x: &[Vec3]) -> Option<Self> {
        let (weights, normal) = ([0.0; 4], Vec3::zeros());
        let under = Under::Cloth;
        let mut out = Self { nodes, weights, count: 4, normal, offset: 0.0, under, above, pushes: true };
        out.refresh(x).then_some(out)
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

    /// Turns a pair of primitives to where its closest points are now; the plane under a node stays. A pair whose closest
    /// point is an end of an edge, or on the rim of a triangle over a vertex of the body, pushes no more: that is the
    /// business of others. Returns `false`, and changes nothing, where the two meet in a point.
    pub fn refresh(&mut self, x: &[Vec3]) -> bool {
        let at = |k: usize| x[self.nodes[k] as usize];
        let inner = |s: f64| s > 0.0 && s < 1.0;
        let (weights, away, pushes) = match self.under {
            Under::Plane => return true,
            Under::Cloth if self.above == 1 => {
                let w = closest_on_triangle(at(0), at(1), at(2), at(3));
                let away = at(0) - (at(1) * w[0] + at(2) * w[1] + at(3) * w[2]);
                ([1.0, -w[0], -w[1], -w[2]], away, true)
            }
            Under::Cloth => {
                let (a, b, c, d) = (at(0), at(1), at(2), at(3));
                let (s, t) = closest_on_segments(a, b, c, d);
                let away = a + (b - a) * s - c - (d - c) * t;
                ([1.0 - s, s, t - 1.0, -t], away, inner(s) && inner(t))
            }
            Under::Vertex { at: p, .. } => {
                let [k, l, m] = closest_on_triangle(p, at(0), at(1), at(2));
                let away = at(0) * k + at(1) * l + at(2) * m - p;
                ([k, l, m, 0.0], away, k > 0.0 && l > 0.0 && m > 0.0)
            }
            Under::Edge { ends: [p, q], .. } => {
                let (s, t) = closest_on_segments(at(0), at(1), p, q);
                let (along, body) = (at(1) - at(0), q - p);
                let away = at(0) + along * s - p - body * t;
                let cross = along.cross(&body).norm() > PARALLEL * along.norm() * body.norm();
                ([1.0 - s, s, 0.0, 0.0], away, cross && inner(s) && inner(t))
            }
        };
        let distance = away.norm();
        if distance == 0.0 {
            return false;
        }
        // The body has an inside, from which cloth must come back the way it went.
        let inside = self.is_on_body() && away.dot(&self.normal) < 0.0;
        (self.weights, self.pushes) = (weights, pushes);
        self.normal = away / if inside { -distance } else { distance };
        self.offset = match self.under {
            Under::Vertex { at, .. } | Under::Edge { ends: [at, _], .. } => self.normal.dot(&at),
            Under::Cloth | Under::Plane => self.offset,
        };
        true
    }

    /// Its nodes and their weights.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.nodes.iter().zip(&self.weights).take(self.count as usize).map(|(&n, &w)| (n as usize, w))
    }
}
