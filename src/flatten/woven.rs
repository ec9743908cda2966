//! How far the threads of a woven cloth are from their lengths.
//!
//! In the flat piece warp and weft run straight; J⁻¹ takes them back to the surface, where their stretch is
//! t = |J⁻¹ d|. Threads hardly stretch while the angle between them changes easily, so only t counts (after Pietroni
//! et al. 2022, "Computational pattern making from 3D garment models", section 4), until the weave locks:
//! Ψ = Σ ln² t + k max(0, |tan γ| − tan γ₀)², where γ is the shear. Near t = 1 the logarithm is the strain; it has no
//! end where threads shrink to nothing, and the tangent none where warp and weft come to lie on each other, so that
//! neither happens on a surface that cannot be woven over.

use nalgebra::Matrix2;

use super::element::CurvatureMode;
use crate::geometry::Vec2;

/// Tangent of the shear at which threads that cross begin to jam: half a degree short of the 30° beyond which cloth
/// wrinkles, and [`JAMMED`] is stiff enough to stop it within that half.
const LOCKED: f64 = 0.565_772_78;
/// Stiffness of jammed threads against that of stretched ones, k.
const JAMMED: f64 = 13.0;

/// Least stiffness along a thread's length of a square completed ([`modes`]): that of a thread that is shorter than
/// 0.4 of its length on the surface would be none.
const LEAST: f64 = 0.2;

/// J in the coordinates in which Ψ is simple. With p and q, warp and weft turned by a quarter, J = p aᵀ + q bᵀ. Then
/// the warp is stretched by 1/(|b| sin φ) and the weft by 1/(|a| sin φ), where φ is the angle from a to b, and the
/// tangent of the shear is cot φ.
struct Woven {
    /// The directions p and q, across the warp and across the weft.
    across: [Vec2; 2],
    /// The vectors a and b that J is made of with p and q.
    images: [Vec2; 2],
    /// Squares of the lengths of a and b.
    squares: [f64; 2],
    /// Strains of warp and weft, as logarithms of their stretches t.
    strains: [f64; 2],
    /// Tangent of the shear, which is cot φ.
    tangent: f64,
}

impl Woven {
    /// Of a J with det J > 0.
    #[inline]
    fn new(jacobian: &Matrix2<f64>, warp: Vec2) -> Self {
        let across = [Vec2::new(-warp.y, warp.x), -warp];
        let images = across.map(|d| jacobian.transpose() * d);
        let squares = images.map(|image| image.norm_squared());
        let det = images[0].perp(&images[1]);
        let strains = squares.map(|square| 0.5 * (square / (det * det)).ln());
        Self { across, images, squares, strains, tangent: images[0].dot(&images[1]) / det }
    }

    /// Derivatives of ln |a| and of ln |b| by J.
    fn longer(&self) -> [Matrix2<f64>; 2] {
        [0, 1].map(|k| self.across[k] * self.images[k].transpose() / self.squares[k])
    }

    /// Derivatives of the directions of a and b by J.
    fn turned(&self) -> [Matrix2<f64>; 2] {
        let turn = |d: Vec2| Vec2::new(-d.y, d.x);
        [0, 1].map(|k| self.across[k] * turn(self.images[k]).transpose() / self.squares[k])
    }

    #[inline]
    fn density(&self) -> f64 {
        let [warp, weft] = self.strains;
        warp * warp + weft * weft + JAMMED * jam(self.tangent).powi(2)
    }

    /// Derivatives of Ψ by ln |a|, ln |b| and φ.
    fn slopes(&self) -> [f64; 3] {
        let [warp, weft] = self.strains;
        let c = self.tangent;
        let jammed = 2.0 * JAMMED * jam(c) * c.signum() * (1.0 + c * c);
        [-2.0 * weft, -2.0 * warp, -2.0 * (warp + weft) * c - jammed]
    }

    fn stress(&self) -> Matrix2<f64> {
        let [by_a, by_b, by_angle] = self.slopes();
        let (longer, turned) = (self.longer(), self.turned());
        longer[0] * by_a + longer[1] * by_b + (turned[1] - turned[0]) * by_angle
    }

    /// Second derivative of Ψ by φ.
    fn bend(&self) -> f64 {
        let c = self.tangent;
        let (square, over) = (1.0 + c * c, jam(c));
        let jammed = if over > 0.0 { square * square + 2.0 * over * c.abs() * square } else { 0.0 };
        4.0 * c * c + 2.0 * (self.strains[0] + self.strains[1]) * square + 2.0 * JAMMED * jammed
    }

    /// The second derivative as a sum of squares. With u, v the changes of length (as shares) and direction of a and b
    /// it is
    /// 2 u₁² + 2 u₂² + Ψ_φφ w² + 4 c (u₁ + u₂) w + Ψ_α (v₁² − u₁²) + Ψ_β (v₂² − u₂²) + 2 Ψ_φ (u₁ v₁ − u₂ v₂)
    /// with w = v₂ − v₁. Both squares of lengths are completed; the eigenmodes of what is left of v are the others.
    fn modes(&self) -> [CurvatureMode; 4] {
        let [by_a, by_b, by_angle] = self.slopes();
        let c = 2.0 * self.tangent;
        let stiff = [by_a, by_b].map(|by| (2.0 - by).max(LEAST));
        let mixed = [Vec2::new(by_angle - c, c), Vec2::new(-c, c - by_angle)];
        let bend = self.bend();
        let left = Matrix2::new(bend + by_a, -bend, -bend, bend + by_b)
            - mixed[0] * mixed[0].transpose() / stiff[0]
            - mixed[1] * mixed[1].transpose() / stiff[1];
        let (longer, directions) = (self.longer(), self.turned());
        let turned = |share: Vec2| directions[0] * share.x + directions[1] * share.y;
        let along = |k: usize| CurvatureMode { curvature: stiff[k], mode: longer[k] + turned(mixed[k] / stiff[k]) };
        let (mean, half, radius) = {
            let half = (left.m11 - left.m22) / 2.0;
            ((left.m11 + left.m22) / 2.0, half, half.hypot(left.m12))
        };
        let (sine, cosine) = (0.5 * left.m12.atan2(half)).sin_cos();
        [
            along(0),
            along(1),
            CurvatureMode { curvature: mean + radius, mode: turned(Vec2::new(cosine, sine)) },
            CurvatureMode { curvature: mean - radius, mode: turned(Vec2::new(-sine, cosine)) },
        ]
    }
}

/// How far beyond the lock a tangent of shear is.
fn jam(tangent: f64) -> f64 {
    (tangent.abs() - LOCKED).max(0.0)
}

/// Strains of warp and weft on the surface of a triangle and its shear, radians (det J > 0).
pub(super) fn measured(jacobian: &Matrix2<f64>, warp: Vec2) -> [f64; 3] {
    let woven = Woven::new(jacobian, warp);
    let [a, b] = woven.strains.map(f64::exp_m1);
    [a, b, woven.tangent.atan()]
}

/// Ψ at J (det J > 0).
pub(super) fn density(jacobian: &Matrix2<f64>, warp: Vec2) -> f64 {
    Woven::new(jacobian, warp).density()
}

/// The derivative of Ψ by J.
pub(super) fn stress(jacobian: &Matrix2<f64>, warp: Vec2) -> Matrix2<f64> {
    Woven::new(jacobian, warp).stress()
}

/// The second derivative of Ψ at J (det J > 0), as a sum of four squares, of which only those of turning threads may be
/// negative.
pub(super) fn modes(jacobian: &Matrix2<f64>, warp: Vec2) -> [CurvatureMode; 4] {
    Woven::new(jacobian, warp).modes()
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
