//! How far the threads of a woven cloth are from their lengths.
//!
//! In the flat piece warp and weft run straight; J⁻¹ takes them back to the surface, where their stretch is
//! t = |J⁻¹ d|. Threads hardly stretch while the angle between them changes easily, so only t counts (after Pietroni
//! et al. 2022, "Computational pattern making from 3D garment models", section 4), until the weave locks:
//! Ψ = Σ (t − 1)² + k max(0, |s| − s₀)², where s is the sine of the shear.

use nalgebra::Matrix2;

use super::distortion::cofactor;
use super::element::Mode;
use crate::geometry::Vec2;

/// Sine of the shear at which threads that cross begin to jam: half a degree short of the 30° beyond which cloth
/// wrinkles, and [`JAMMED`] is stiff enough to stop it within that half.
const LOCKED: f64 = 0.492_423_56;
/// Stiffness of jammed threads against that of stretched ones, k.
const JAMMED: f64 = 30.0;

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

/// Sine of the shear, the cosine of the threads' angle on the surface, and its derivative by J (det J > 0).
fn shear(jacobian: &Matrix2<f64>, warp: Vec2) -> (f64, Matrix2<f64>) {
    let [warp, weft] = threads(warp);
    // J⁻¹ d is along the quarter-turned Jᵀ of the quarter-turned d: turned together, both angles are the same.
    let (a, b) = (jacobian.transpose() * weft, -(jacobian.transpose() * warp));
    let (along, across) = (a.norm(), b.norm());
    let (a, b) = (a / along, b / across);
    let sine = a.dot(&b);
    (sine, weft * ((b - a * sine) / along).transpose() - warp * ((a - b * sine) / across).transpose())
}

/// How far beyond the lock a sine of shear is.
fn jam(sine: f64) -> f64 {
    (sine.abs() - LOCKED).max(0.0)
}

/// Strains of warp and weft on the surface of a triangle and its shear, radians (det J > 0).
pub(super) fn measured(jacobian: &Matrix2<f64>, warp: Vec2) -> [f64; 3] {
    let [a, b] = threads(warp).map(|d| strain(jacobian, d).0);
    [a, b, shear(jacobian, warp).0.asin()]
}

/// Ψ at J (det J > 0).
pub(super) fn density(jacobian: &Matrix2<f64>, warp: Vec2) -> f64 {
    let stretched: f64 = threads(warp).into_iter().map(|d| strain(jacobian, d).0.powi(2)).sum();
    stretched + JAMMED * jam(shear(jacobian, warp).0).powi(2)
}

/// The derivative of Ψ by J.
pub(super) fn stress(jacobian: &Matrix2<f64>, warp: Vec2) -> Matrix2<f64> {
    let [a, b] = threads(warp).map(|d| {
        let (strain, derivative) = strain(jacobian, d);
        derivative * (2.0 * strain)
    });
    let (sine, derivative) = shear(jacobian, warp);
    a + b + derivative * (2.0 * JAMMED * jam(sine) * sine.signum())
}

/// The second derivative of Ψ without the part that strain and shear themselves contribute (Gauss–Newton).
pub(super) fn modes(jacobian: &Matrix2<f64>, warp: Vec2) -> [Mode; 3] {
    let [a, b] = threads(warp).map(|d| Mode { curvature: 2.0, mode: strain(jacobian, d).1 });
    let (sine, derivative) = shear(jacobian, warp);
    let stiffness = if jam(sine) > 0.0 { 2.0 * JAMMED } else { 0.0 };
    [a, b, Mode { curvature: stiffness, mode: derivative }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shear_is_that_of_the_threads_on_the_surface() {
        // Threads of unit length on the surface, 65° apart: their shear is 25°.
        let angle = 65f64.to_radians();
        let on_surface = Matrix2::new(1.0, angle.cos(), 0.0, angle.sin());
        let jacobian = on_surface.try_inverse().unwrap_or_default();
        let [warp, weft, shear] = measured(&jacobian, Vec2::x());
        assert!(warp.abs() < 1e-12 && weft.abs() < 1e-12, "{warp} {weft}");
        assert!((shear.abs().to_degrees() - 25.0).abs() < 1e-9, "{shear}");
        assert!((LOCKED - 29.5f64.to_radians().sin()).abs() < 1e-8);
    }
}
