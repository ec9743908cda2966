//! Contact: cloth with the body and cloth with cloth (F6, F14). The only user of parry.
//!
//! Detection finds every pair of primitives closer than a *reach* and turns it into a [`Contact`]: a frozen direction
//! and the weights of the nodes that take part. Between two detections no node moves further than
//! [`Bounds::allowance`], so a pair that was not found cannot meet; a pair that was found is kept apart by a plane
//! between its two sides ([`Bounds`]). Cloth that starts without a crossing therefore ends without one; the exceptions
//! are pairs left out on purpose (neighbours in the cloth, both sides of a seam that is being closed).

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
}

impl Contact {
    /// Offset of a pair of edges that must stay apart but does not push: a metre of gap.
    const SILENT: f64 = -1.0;

    /// A contact of nothing with nothing.
    pub(crate) fn none() -> Self {
        Self { nodes: [0; 4], weights: [0.0; 4], count: 0, normal: Vec3::zeros(), offset: 0.0, body: true, above: 0 }
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
        let (away, inner) = if self.above == 1 {
            let w = closest_on_triangle(a, b, c, d);
            self.weights = [1.0, -w[0], -w[1], -w[2]];
            (a - (b * w[0] + c * w[1] + d * w[2]), true)
        } else {
            let (s, t) = closest_on_segments(a, b, c, d);
            self.weights = [1.0 - s, s, t - 1.0, -t];
            (a + (b - a) * s - c - (d - c) * t, s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0)
        };
        let distance = away.norm();
        if distance > 0.0 {
            self.normal = away / distance;
        }
        self.offset = if inner { 0.0 } else { Self::SILENT };
    }

    /// Its nodes and their weights.
    pub fn parts(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.nodes.iter().zip(&self.weights).take(self.count as usize).map(|(&n, &w)| (n as usize, w))
    }
}
