//! Springs: what wants to have a length.

use nalgebra::Matrix2;

use crate::geometry::Vec2;

/// A spring that wants a line to have a length: with e = length/target − 1 its energy is weight · e² + pull · e.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spring {
    /// What the line depends on.
    pub(super) nodes: [u32; 3],
    /// The line is the sum of the nodes' positions times these, which sum to zero.
    pub(super) shares: [f64; 3],
    /// Wanted length, metres.
    pub(super) target: f64,
    /// Its weight in the energy, m².
    pub(super) weight: f64,
    /// The force it has besides, m²: that which holds the line at its very length, once it is found.
    pub(super) pull: f64,
}

/// The springs of an energy.
#[derive(Default)]
pub(super) struct Springs {
    /// Those that get exactly their lengths.
    pub(super) held: Vec<Spring>,
    /// Those that do not.
    pub(super) free: Vec<Spring>,
}

impl Spring {
    /// Between two vertices.
    pub(super) fn between([a, b]: [u32; 2], target: f64, weight: f64) -> Self {
        Self { nodes: [a, b, b], shares: [-1.0, 1.0, 0.0], target, weight, pull: 0.0 }
    }

    pub(super) fn along(&self, flat: &[Vec2]) -> Vec2 {
        let [a, b, c] = self.nodes.map(|v| flat[v as usize]);
        // The shares sum to zero, so differences to the first node do.
        (b - a) * self.shares[1] + (c - a) * self.shares[2]
    }

    pub(super) fn length(&self, flat: &[Vec2]) -> f64 {
        self.along(flat).norm()
    }

    /// Share by which it is too long.
    fn excess(&self, length: f64) -> f64 {
        length / self.target - 1.0
    }

    pub(super) fn energy(&self, flat: &[Vec2]) -> f64 {
        let excess = self.excess(self.length(flat));
        (self.weight * excess + self.pull) * excess
    }

    /// Derivative of its energy by its length, m.
    pub(super) fn tension(&self, length: f64) -> f64 {
        (2.0 * self.weight * self.excess(length) + self.pull) / self.target
    }

    /// Lets it keep the force it has as its own.
    pub(super) fn hold(&mut self, flat: &[Vec2]) {
        self.pull = self.tension(self.length(flat)) * self.target;
    }

    /// The positive semidefinite part of its second derivative by the line.
    pub(super) fn curvature(&self, flat: &[Vec2]) -> Matrix2<f64> {
        let along = self.along(flat);
        let length = along.norm();
        let stiffness = 2.0 * self.weight / (self.target * self.target);
        if length <= 0.0 {
            return Matrix2::identity() * stiffness;
        }
        let n = along / length;
        let dyad = n * n.transpose();
        // A compressed spring pushes sideways: that part is negative and left out.
        let across = (self.tension(length) / length).max(0.0);
        dyad * stiffness + (Matrix2::identity() - dyad) * across
    }
}
