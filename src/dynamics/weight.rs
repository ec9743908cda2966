//! Weight of the cloth.

use super::energy::{Bound, Energy, Exerted, Stiffness};
use crate::fabric::GRAVITY;
use crate::geometry::Vec3;

/// A share of gravity on every node.
pub(super) struct Weight<'a> {
    /// Node masses, kg.
    pub(super) mass: &'a [f64],
    /// Share of gravity.
    pub(super) share: f64,
}

impl Exerted for Weight<'_> {
    fn gather(&self, node: usize, sum: Vec3) -> Vec3 {
        sum - Vec3::y() * (self.mass[node] * GRAVITY * self.share)
    }
}

impl Energy for Weight<'_> {
    fn energy(&self, x: &[Vec3]) -> f64 {
        self.mass.iter().zip(x).map(|(m, x)| m * x.y).sum::<f64>() * GRAVITY * self.share
    }

    fn forces<'a>(&'a self, _x: &'a [Vec3]) -> impl Exerted + 'a {
        Self { ..*self }
    }

    fn stiffness<'a>(&'a self, _x: &'a [Vec3]) -> impl Stiffness + 'a {}

    fn bound<'a>(&'a self, _x: &'a [Vec3]) -> impl Bound + 'a {}

    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        std::iter::empty()
    }
}
