//! Springs: what wants to have a length.

use std::ops::Range;

use nalgebra::Matrix2;

use super::element::Taken;
use crate::geometry::Vec2;

/// The energy of a length: with e = length/target − 1 it is weight · e² + pull · e.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elastic {
    /// Wanted length, metres.
    pub(super) target: f64,
    /// Its weight in the energy, m².
    pub(super) weight: f64,
    /// The force it has besides, m²: that which holds the line at its very length, once it is found.
    pub(super) pull: f64,
}

impl Elastic {
    /// Share by which a length is too long.
    fn excess(&self, length: f64) -> f64 {
        length / self.target - 1.0
    }

    pub(super) fn energy(&self, length: f64) -> f64 {
        let excess = self.excess(length);
        (self.weight * excess + self.pull) * excess
    }

    /// Derivative of its energy by the length, m.
    pub(super) fn tension(&self, length: f64) -> f64 {
        (2.0 * self.weight * self.excess(length) + self.pull) / self.target
    }

    /// Second derivative of its energy by the length.
    pub(super) fn stiffness(&self) -> f64 {
        2.0 * self.weight / (self.target * self.target)
    }

    /// Lets it keep the force it has as its own.
    pub(super) fn hold(&mut self, length: f64) {
        self.pull = self.tension(length) * self.target;
    }
}

/// A spring that wants a line to have a length.
#[derive(Clone, Copy, Debug)]
pub(super) struct LengthSpring<const N: usize = 3> {
    /// The vertices that the line depends on.
    pub(super) nodes: [u32; N],
    /// The line is the sum of the nodes' positions times these, which sum to zero.
    pub(super) shares: [f64; N],
    /// The energy of its length.
    pub(super) elastic: Elastic,
}

/// Springs of which only the lengths' sum is held.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    /// Which of the free springs.
    pub(super) springs: Range<usize>,
    /// The energy of the sum of their lengths.
    pub(super) elastic: Elastic,
}

/// The springs of an energy.
#[derive(Default)]
pub(super) struct Springs<const N: usize = 3> {
    /// Those that get exactly their lengths.
    pub(super) held: Vec<LengthSpring<N>>,
    /// Those that do not.
    pub(super) free: Vec<LengthSpring<N>>,
    /// Those of the latter whose lengths together are exact.
    pub(super) chains: Vec<Chain>,
}

impl LengthSpring {
    /// Between two vertices.
    pub(super) fn between([a, b]: [u32; 2], target: f64, weight: f64) -> Self {
        let elastic = Elastic { target, weight, pull: 0.0 };
        Self { nodes: [a, b, b], shares: [-1.0, 1.0, 0.0], elastic }
    }
}

impl<const N: usize> LengthSpring<N> {
    pub(super) fn along(&self, flat: &[Vec2]) -> Vec2 {
        let first = flat[self.nodes[0] as usize];
        // The shares sum to zero, so differences to the first node do.
        self.nodes[1..].iter().zip(&self.shares[1..]).map(|(&v, share)| (flat[v as usize] - first) * *share).sum()
    }

    pub(super) fn length(&self, flat: &[Vec2]) -> f64 {
        self.along(flat).norm()
    }

    /// Its second derivative by the line, along which `pulled` is another tension.
    pub(super) fn curvature(&self, flat: &[Vec2], pulled: f64, taken: Taken) -> Matrix2<f64> {
        let along = self.along(flat);
        let length = along.norm();
        let stiffness = self.elastic.stiffness();
        if length <= 0.0 {
            return Matrix2::identity() * stiffness;
        }
        let n = along / length;
        let dyad = n * n.transpose();
        // A compressed spring pushes sideways: that part is negative.
        let across = taken.of((self.elastic.tension(length) + pulled) / length);
        dyad * stiffness + (Matrix2::identity() - dyad) * across
    }
}
