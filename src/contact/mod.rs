//! Contact: cloth with the body and cloth with cloth (F6, F14). The only user of parry.
//!
//! Detection finds every pair of primitives closer than a *reach* and turns it into a [`Contact`]: a frozen direction
//! and the weights of the nodes that take part. Between two detections no node moves further than
//! [`Bounds::allowance`], so a pair that was not found cannot meet; a pair that was found is kept apart by a plane
//! between its two sides ([`Bounds`]). Cloth that starts without a crossing therefore ends without one; the exceptions
//! are pairs left out on purpose (neighbours in the cloth, both sides of a seam that is being closed), and edges and
//! faces of the cloth against the body, which only the penalty holds off.

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
    /// Whether the other side is the body.
    pub body: bool,
    /// How many of the nodes, counted from the first, are on the side the normal points to.
    pub above: u8,
    /// Which vertex or edge of the body it meets, from 1; 0 where that is the nearest point, or a layer.
    pub feature: u32,
    /// Whether it pushes; a pair of cloth edges that are nearest at an end of one is only kept apart.
    pub pushes: bool,
}

impl Contact {
    /// A node and the body's surface, of unit direction `normal` at `point`.
    pub(crate) fn on_body(node: u32, normal: Vec3, point: Vec3) -> Self {
        Self::with_body([node, 0, 0, 0], [1.0, 0.0, 0.0, 0.0], 1, normal, (0, point))
    }

    /// The first `count` of `nodes`, a point of the cloth by their `weights`, and a feature of the body with a point of it.
    pub(crate) fn with_body(
        nodes: [u32; 4],
        weights: [f64; 4],
        count: u8,
        normal: Vec3,
        (feature, point): (u32, Vec3),
    ) -> Self {
        let offset = normal.dot(&point);
        Self { nodes, weights, count, normal, offset, body: true, above: count, feature, pushes: true }
    }

    /// Two primitives of the cloth at positions `x`: a vertex and a triangle if one node is `above`, two edges if two
    /// are. `None` where they meet in a point.
    pub(crate) fn within_cloth(nodes: [u32; 4], above: u8, x: &[Vec3]) -> Option<Self> {
        let weights = [0.0; 4];
        let (normal, offset) = (Vec3::zeros(), 0.0);
        let mut out = Self { nodes, weights, count: 4, normal, offset, body: false, above, feature: 0, pushes: true };
        out.refresh(x);
        (out.normal != Vec3::zeros()).then_some(out)
    }

    /// The gap at positions `x`, metres.
    pub fn gap(&self, x: &[Vec3]) -> f64 {
        let mut sum = -self.offset;
        for (&node, &w) in self.nodes.iter().zip(&self.weights).take(self.count as usize) {
            sum += w * self.normal.dot(&x[node as usize]);
        }
        sum
    }

    /// Turns a pair of cloth primitives to where its closest points are now. A pair of edges whose closest point is an
    /// end of one pushes no more: that is a vertex's business.
    pub fn refresh(&mut self, x: &[Vec3]) {
        if self.body {
            return;
        }
        let [a, b, c, d] = self.nodes.map(|n| x[n as usize]);
        let away = if self.above == 1 {
            let w = closest_on_triangle(a, b, c, d);
            self.weights = [1.0, -w[0], -w[1], -w[2]];
            a - (b * w[0] + c * w[1] + d * w[2])
        } else {
            let (s, t) = closest_on_segments(a, b, c, d);
            self.weights = [1.0 - s, s, t - 1.0, -t];
            self.pushes = s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0;
            a + (b - a) * s - c - (d - c) * t
        };
        let distance = away.norm();
        if distance > 0.0 {
            self.normal = away / distance;
        }
    }

    /// Its nodes and their weights.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.nodes.iter().zip(&self.weights).take(self.count as usize).map(|(&n, &w)| (n as usize, w))
    }
}
