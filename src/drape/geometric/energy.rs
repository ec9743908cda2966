//! The energy (7) and its gradient.

use super::Weights;
use super::bend::direction;
use super::recovery::Recovery;
use super::stencils::Stencils;
use crate::geometry::Vec3;

/// The terms of (7).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// E_P (or the potential in its place, see [`Recovery::Falling`]), without ω.
    pub recovery: f64,
    /// E_L, without ω.
    pub stretch: f64,
    /// E_A, without ω.
    pub bend: f64,
    /// ω_R E_P + ω_S E_L + ω_B E_A.
    pub total: f64,
}

pub(super) fn energies(stencils: &Stencils, weights: &Weights, x: &[Vec3], recovery: &Recovery) -> Energies {
    let stretch = stencils.edges.iter().map(|e| {
        let [a, b] = e.ends.map(|v| x[v as usize]);
        e.weight * ((b - a).norm() - e.rest).powi(2)
    });
    let bend = stencils.hinges.iter().map(|h| h.weight * h.miss(x).norm_squared());
    let (recovery, stretch, bend) = (recovery.energy(stencils, x), stretch.sum(), bend.sum());
    let total = weights.recovery * recovery + weights.stretch * stretch + weights.bend * bend;
    Energies { recovery, stretch, bend, total }
}

/// Half the gradient of the total: Aᵀ(A X − b) of the least squares.
pub(super) fn half_gradient(stencils: &Stencils, weights: &Weights, x: &[Vec3], recovery: &Recovery) -> Vec<Vec3> {
    let mut out = vec![Vec3::zeros(); x.len()];
    recovery.add_half_gradient(stencils, weights.recovery, x, &mut out);
    for e in &stencils.edges {
        let [a, b] = e.ends.map(|v| v as usize);
        let (along, length) = direction(x[b] - x[a]);
        let pull = along * (weights.stretch * e.weight * (length - e.rest));
        out[a] -= pull;
        out[b] += pull;
    }
    for h in &stencils.hinges {
        h.add_half_gradient(weights.bend, x, &mut out);
    }
    out
}
