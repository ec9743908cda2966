//! How far the threads of a woven cloth are from their lengths.
//!
//! In the flat piece warp and weft run straight; J⁻¹ takes them back to the surface, where their stretch is
//! t = |J⁻¹ d|. Threads hardly stretch while the angle between them changes easily, so only t counts (after Pietroni
//! et al. 2022, "Computational pattern making from 3D garment models", section 4), until the weave locks:
//! Ψ = Σ ln² t + k max(0, |tan γ| − tan γ₀)², where γ is the shear. Near t = 1 the logarithm is the strain; it has no
//! end where threads shrink to nothing, and the tangent none where warp and weft come to lie on each other, so that
//! neither happens on a surface that cannot be woven over.

use nalgebra::Matrix2;

use super::distortion::cofactor;
use super::element::Mode;
use crate::geometry::Vec2;

/// Tangent of the shear at which threads that cross begin to jam: half a degree short of the 30° beyond which cloth
/// wrinkles, and [`JAMMED`] is stiff enough to stop it within that half.
const LOCKED: f64 = 0.565_772_78;
/// Stiffness of jammed threads against that of stretched ones, k.
const JAMMED: f64 = 13.0;

/// The stretch t of a thread along the unit vector `thread`, and the derivative of ln t by J (det J > 0).
fn stretch(jacobian: &Matrix2<f64>, thread: Vec2) -> (f64, Matrix2<f64>) {
    let det = jacobian.determinant();
    // J⁻¹ = adj J / det J, and adj J · d is the quarter-turned Jᵀ of the quarter-turned d.
    let across = Vec2::new(-thread.y, thread.x);
    let image = jacobian.transpose() * across;
    let derivative = across * image.transpose() / image.norm_squared() - cofactor(jacobian) / det;
    (image.norm() / det, derivative)
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

/// The tangent of the shear whose sine is given, and its derivative by the sine.
fn tangent(sine: f64) -> (f64, f64) {
    let cosine = (1.0 - sine * sine).sqrt();
    (sine / cosine, cosine.powi(-3))
}

/// How far beyond the lock a tangent of shear is.
fn jam(tangent: f64) -> f64 {
    (tangent.abs() - LOCKED).max(0.0)
}

/// Strains of warp and weft on the surface of a triangle and its shear, radians (det J > 0).
pub(super) fn measured(jacobian: &Matrix2<f64>, warp: Vec2) -> [f64; 3] {
    let [a, b] = threads(warp).map(|d| stretch(jacobian, d).0 - 1.0);
    [a, b, shear(jacobian, warp).0.asin()]
}

/// Ψ at J (det J > 0).
pub(super) fn density(jacobian: &Matrix2<f64>, warp: Vec2) -> f64 {
    let stretched: f64 = threads(warp).into_iter().map(|d| stretch(jacobian, d).0.ln().powi(2)).sum();
    stretched + JAMMED * jam(tangent(shear(jacobian, warp).0).0).powi(2)
}

/// The derivative of Ψ by J.
pub(super) fn stress(jacobian: &Matrix2<f64>, warp: Vec2) -> Matrix2<f64> {
    let [a, b] = threads(warp).map(|d| {
        let (stretch, derivative) = stretch(jacobian, d);
        derivative * (2.0 * stretch.ln())
    });
    let (sine, derivative) = shear(jacobian, warp);
    let (tangent, slope) = tangent(sine);
    a + b + derivative * (2.0 * JAMMED * jam(tangent) * tangent.signum() * slope)
}

/// The second derivative of Ψ without the part that strain and shear themselves contribute (Gauss–Newton).
pub(super) fn modes(jacobian: &Matrix2<f64>, warp: Vec2) -> [Mode; 3] {
    let [a, b] = threads(warp).map(|d| Mode { curvature: 2.0, mode: stretch(jacobian, d).1 });
    let (sine, derivative) = shear(jacobian, warp);
    let (tangent, slope) = tangent(sine);
    let stiffness = if jam(tangent) > 0.0 { 2.0 * JAMMED } else { 0.0 };
    [a, b, Mode { curvature: stiffness, mode: derivative * slope }]
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
        assert!((LOCKED - 29.5f64.to_radians().tan()).abs() < 1e-8);
    }
}
