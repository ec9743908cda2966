//! How far the threads of a woven cloth are from their lengths.
//!
//! In the flat piece warp and weft run straight; J⁻¹ takes them back to the surface, where their stretch is
//! t = |J⁻¹ d|. Threads hardly stretch while the angle between them changes easily, so only t counts (after Pietroni
//! et al. 2022, "Computational pattern making from 3D garment models", section 4): Ψ = Σ (t − 1)².

use nalgebra::Matrix2;

use super::distortion::cofactor;
use super::element::Mode;
use crate::geometry::Vec2;

/// t − 1 of a thread along the unit vector `thread`, and its derivative by J (det J > 0).
fn strain(jacobian: &Matrix2<f64>, thread: Vec2) -> (f64, Matrix2<f64>) {
    let det = jacobian.determinant();
    // J⁻¹ = adj J / det J, and adj J · d is the quarter-turned Jᵀ of the quarter-turned d.
    let across = Vec2::new(-thread.y, thread.x);
    let image = jacobian.transpose() * across;
    let length = image.norm();
    let derivative = across * image.transpose() / (length * det) - cofactor(jacobian) * (length / (det * det));
    (length / det - 1.0, derivative)
}

fn threads(warp: Vec2) -> [Vec2; 2] {
    [warp, Vec2::new(-warp.y, warp.x)]
}

/// Ψ at J (det J > 0).
pub(super) fn density(jacobian: &Matrix2<f64>, warp: Vec2) -> f64 {
    threads(warp).into_iter().map(|d| strain(jacobian, d).0.powi(2)).sum()
}

/// The derivative of Ψ by J.
pub(super) fn stress(jacobian: &Matrix2<f64>, warp: Vec2) -> Matrix2<f64> {
    let [a, b] = threads(warp).map(|d| {
        let (strain, derivative) = strain(jacobian, d);
        derivative * (2.0 * strain)
    });
    a + b
}

/// The second derivative of Ψ without the part that the strain itself contributes (Gauss–Newton).
pub(super) fn modes(jacobian: &Matrix2<f64>, warp: Vec2) -> [Mode; 2] {
    threads(warp).map(|d| Mode { curvature: 2.0, mode: strain(jacobian, d).1 })
}
