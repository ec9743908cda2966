//! How far the threads of a woven cloth are from their lengths.
//!
//! In the flat piece warp and weft run straight; J⁻¹ takes them back to the surface, where their stretch is
//! t = |J⁻¹ d|. Threads hardly stretch while the angle between them changes easily, so only t counts (after Pietroni
//! et al. 2022, "Computational pattern making from 3D garment models", section 4), until the weave locks:
//! Ψ = Σ ln² t + k max(0, |tan γ| − tan γ₀)², where γ is the shear. Near t = 1 the logarithm is the strain; it has no
//! end where threads shrink to nothing, and the tangent none where warp and weft come to lie on each other, so that
//! neither happens on a surface that cannot be woven over.

use nalgebra::{Matrix2, Matrix4, SymmetricEigen};

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

/// The second derivative of Ψ at J (det J > 0), as its four eigenmodes.
pub(super) fn modes(jacobian: &Matrix2<f64>, warp: Vec2) -> [Mode; 4] {
    let curved = Curved::new(jacobian, warp);
    let unit = |k: usize| {
        let mut m = Matrix2::zeros();
        m[k] = 1.0;
        m
    };
    let own = [0, 1, 2, 3].map(|k| curved.along(&unit(k)));
    let hessian = Matrix4::from_fn(|k, l| match k == l {
        true => own[k],
        false => (curved.along(&(unit(k) + unit(l))) - own[k] - own[l]) / 2.0,
    });
    let eigen = SymmetricEigen::new(hessian);
    [0, 1, 2, 3].map(|k| {
        let mode = Matrix2::from_iterator(eigen.eigenvectors.column(k).iter().copied());
        Mode { curvature: eigen.eigenvalues[k], mode }
    })
}

/// Ψ near a J: what its second derivative along any direction is made of.
struct Curved {
    inverse: Matrix2<f64>,
    det: f64,
    cofactor: Matrix2<f64>,
    /// Of warp and weft: the quarter-turned direction, its image by Jᵀ, ln t and its derivative.
    threads: [(Vec2, Vec2, f64, Matrix2<f64>); 2],
    /// Tangent of the shear.
    tangent: f64,
}

impl Curved {
    fn new(jacobian: &Matrix2<f64>, warp: Vec2) -> Self {
        let threads = threads(warp).map(|d| {
            let across = Vec2::new(-d.y, d.x);
            let (stretch, derivative) = stretch(jacobian, d);
            (across, jacobian.transpose() * across, stretch.ln(), derivative)
        });
        let det = jacobian.determinant();
        let inverse = cofactor(jacobian).transpose() / det;
        // The images of the quarter-turned threads: their angle is that of the threads on the surface.
        let tangent = threads[0].1.dot(&threads[1].1) / det;
        Self { inverse, det, cofactor: cofactor(jacobian), threads, tangent }
    }

    /// The second derivative of Ψ along `by`, twice the same direction.
    fn along(&self, by: &Matrix2<f64>) -> f64 {
        let turned = self.inverse * by;
        // Of −ln det J.
        let of_det = (turned * turned).trace();
        let mut sum = 0.0;
        for (across, image, log, derivative) in &self.threads {
            let change = by.transpose() * across;
            let square = image.norm_squared();
            let bend = change.norm_squared() / square - 2.0 * (image.dot(&change) / square).powi(2) + of_det;
            sum += 2.0 * derivative.dot(by).powi(2) + 2.0 * log * bend;
        }
        sum + self.jam_along(by)
    }

    /// The same of jammed threads.
    fn jam_along(&self, by: &Matrix2<f64>) -> f64 {
        let over = jam(self.tangent);
        if over == 0.0 {
            return 0.0;
        }
        let [(p, a, ..), (q, b, ..)] = &self.threads;
        let (da, db) = (by.transpose() * p, by.transpose() * q);
        let (first, second) = (da.dot(b) + a.dot(&db), 2.0 * da.dot(&db));
        let (ddet, dddet) = (self.cofactor.dot(by), 2.0 * by.determinant());
        let slope = (first - self.tangent * ddet) / self.det;
        let bend = (second - 2.0 * slope * ddet - self.tangent * dddet) / self.det;
        2.0 * JAMMED * (slope * slope + over * self.tangent.signum() * bend)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_modes_are_the_derivative_of_the_stress() {
        // Stretched and sheared a little, and beyond where the weave locks.
        for jacobian in [Matrix2::new(1.2, 0.3, -0.1, 0.8), Matrix2::new(1.0, -0.9, 0.2, 1.3)] {
            let warp = Vec2::new(0.6, 0.8);
            for k in 0..4 {
                let moved = |by: f64| {
                    let mut out: Matrix2<f64> = jacobian;
                    out[k] += by;
                    stress(&out, warp)
                };
                let numeric = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                let sum: Matrix2<f64> = modes(&jacobian, warp).iter().map(|m| m.mode * (m.mode[k] * m.curvature)).sum();
                assert!((numeric - sum).norm() < 1e-6 * (1.0 + sum.norm()), "{numeric} {sum}");
            }
        }
    }

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
