//! The energy (7) and its gradient.

use super::Weights;
use super::stencils::Stencils;
use crate::geometry::Vec3;

/// Edges shorter than this have no direction, metres; far below any real edge and far above rounding.
const SHORTEST: f64 = 1e-12;

/// What the recovery term draws the vertices towards.
#[derive(Clone, Debug, PartialEq)]
pub enum Aim {
    /// (4): fixed targets tᵢ, metres. In the paper's own experiments they are the initial mesh.
    Targets(Vec<Vec3>),
    /// Gravity: tᵢ is where the vertex is, moved by this much (metres) in every iteration. E_P is then implicit Euler's
    /// own variational form and the solver falls to rest, where the other two terms hold the pull 2 ω_R pᵢ · drop on
    /// every vertex of weight pᵢ. In place of E_P the energy has that pull's potential, −2 Σ pᵢ drop · vᵢ.
    Falling(Vec3),
}

/// The terms of (7).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energies {
    /// E_P (or the potential in its place, see [`Aim::Falling`]), without ω.
    pub recovery: f64,
    /// E_L, without ω.
    pub stretch: f64,
    /// E_A, without ω.
    pub bend: f64,
    /// ω_R E_P + ω_S E_L + ω_B E_A.
    pub total: f64,
}

/// Unit direction and length of an edge vector; no direction where it has no length.
pub(super) fn direction(edge: Vec3) -> (Vec3, f64) {
    let length = edge.norm();
    if length > SHORTEST { (edge / length, length) } else { (Vec3::zeros(), length) }
}

/// A(e) of a hinge.
fn fold(nodes: [u32; 4], coefficients: [f64; 4], x: &[Vec3]) -> Vec3 {
    nodes.iter().zip(&coefficients).fold(Vec3::zeros(), |sum, (&n, &c)| sum + x[n as usize] * c)
}

pub(super) fn energies(stencils: &Stencils, weights: &Weights, x: &[Vec3], aim: &Aim) -> Energies {
    let recovery = match aim {
        Aim::Targets(t) => stencils.points.iter().zip(x).zip(t).map(|((p, v), t)| p * (v - t).norm_squared()).sum(),
        Aim::Falling(drop) => -2.0 * stencils.points.iter().zip(x).map(|(p, v)| p * drop.dot(v)).sum::<f64>(),
    };
    let stretch = stencils.edges.iter().map(|e| {
        let [a, b] = e.ends.map(|v| x[v as usize]);
        e.weight * ((b - a).norm() - e.rest).powi(2)
    });
    let bend = stencils.hinges.iter().map(|h| h.weight * fold(h.nodes, h.coefficients, x).norm_squared());
    let (stretch, bend) = (stretch.sum(), bend.sum());
    let total = weights.recovery * recovery + weights.stretch * stretch + weights.bend * bend;
    Energies { recovery, stretch, bend, total }
}

/// Half the gradient of the total, into `out`: Aᵀ(A X − b) of the least squares.
pub(super) fn half_gradient(stencils: &Stencils, weights: &Weights, x: &[Vec3], aim: &Aim, out: &mut [Vec3]) {
    for (i, (p, g)) in stencils.points.iter().zip(out.iter_mut()).enumerate() {
        let away = match aim {
            Aim::Targets(t) => x[i] - t[i],
            Aim::Falling(drop) => -*drop,
        };
        *g = away * (weights.recovery * p);
    }
    for e in &stencils.edges {
        let [a, b] = e.ends.map(|v| v as usize);
        let (along, length) = direction(x[b] - x[a]);
        let pull = along * (weights.stretch * e.weight * (length - e.rest));
        out[a] -= pull;
        out[b] += pull;
    }
    for h in &stencils.hinges {
        let pull = fold(h.nodes, h.coefficients, x) * (weights.bend * h.weight);
        for (&n, &c) in h.nodes.iter().zip(&h.coefficients) {
            out[n as usize] += pull * c;
        }
    }
}
