//! One triangle: how far its flat image is from its true shape.
//!
//! The deformation gradient J takes the triangle's own plane to the flat piece; its singular values are the stretches.
//! Symmetric Dirichlet energy (Smith & Schaefer 2015, eq. 3) with an area term:
//! Ψ = (|J|² + |J⁻¹|²)/4 − 1 + a (det J − 1)². It is about (σ₁−1)² + (σ₂−1)² near an isometry and infinite where the
//! triangle has no area.

use nalgebra::Matrix2;

use crate::geometry::{Vec2, Vec3};

/// A triangle's true shape, prepared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element {
    /// Its corners in the flat piece.
    pub(super) corners: [u32; 3],
    /// Gradients of the corners' hat functions in the triangle's own plane, 1/m: J = Σ xₖ gₖᵀ.
    gradients: [Vec2; 3],
    /// Its share in the energy: true area, m².
    pub(super) area: f64,
}

/// A direction of curvature of Ψ: `curvature` times the dyad of `mode` with itself.
struct Mode {
    curvature: f64,
    mode: Matrix2<f64>,
}

impl Element {
    /// From the true corner positions; the triangle must have an area.
    pub(super) fn new(corners: [u32; 3], [a, b, c]: [Vec3; 3]) -> Self {
        let (u, v) = (b - a, c - a);
        let length = u.norm();
        let along = u.dot(&v) / length;
        let height = u.cross(&v).norm() / length;
        Self::from_plane(corners, [Vec2::zeros(), Vec2::new(length, 0.0), Vec2::new(along, height)])
    }

    /// From a shape in its own plane, corners running so that the area is positive.
    pub(super) fn from_plane(corners: [u32; 3], [a, b, c]: [Vec2; 3]) -> Self {
        let double_area = (b - a).perp(&(c - a));
        let turned = |d: Vec2| Vec2::new(-d.y, d.x) / double_area;
        let gradients = [turned(c - b), turned(a - c), turned(b - a)];
        Self { corners, gradients, area: 0.5 * double_area }
    }

    /// J for the given flat positions.
    pub(super) fn jacobian(&self, flat: &[Vec2]) -> Matrix2<f64> {
        let [a, b, c] = self.corners.map(|v| flat[v as usize]);
        let [_, gb, gc] = self.gradients;
        // The gradients sum to zero, so differences to the first corner do.
        (b - a) * gb.transpose() + (c - a) * gc.transpose()
    }

    /// Ψ at J; infinite if the triangle is flipped or without area.
    pub(super) fn density(jacobian: &Matrix2<f64>, area_weight: f64) -> f64 {
        let det = jacobian.determinant();
        if det <= 0.0 {
            return f64::INFINITY;
        }
        // |J|² − 2 det = (σ₁−σ₂)², free of the cancellation of the plain sum near an isometry.
        let [_, f, _, h] = halves(jacobian);
        let spread = 4.0 * (f * f + h * h);
        let excess = (det - 1.0) * (det - 1.0);
        (spread * (1.0 + 1.0 / (det * det)) + 2.0 * excess / det) / 4.0 + area_weight * excess
    }

    /// Derivatives of Ψ by the corner positions (per unit of area).
    pub(super) fn gradient(&self, jacobian: &Matrix2<f64>, area_weight: f64) -> [Vec2; 3] {
        let det = jacobian.determinant();
        let square = jacobian.norm_squared();
        let cofactor = Matrix2::new(jacobian.m22, -jacobian.m21, -jacobian.m12, jacobian.m11);
        let stress = jacobian * (0.5 * (1.0 + 1.0 / (det * det)))
            + cofactor * (2.0 * area_weight * (det - 1.0) - 0.5 * square / (det * det * det));
        self.gradients.map(|g| stress * g)
    }

    /// The nearest positive semidefinite second derivative of Ψ by the positions of the corners, one block for each of
    /// [`CORNER_PAIRS`] (per unit of area); Smith, De Goes & Kim 2019, "Analytic eigensystems for isotropic distortion
    /// energies", section 4.
    pub(super) fn curvature(&self, jacobian: &Matrix2<f64>, area_weight: f64) -> [Matrix2<f64>; 6] {
        let mut blocks = [Matrix2::zeros(); 6];
        for Mode { curvature, mode } in modes(jacobian, area_weight) {
            if curvature > 0.0 {
                let images = self.gradients.map(|g| mode * g);
                for (block, (k, l)) in blocks.iter_mut().zip(CORNER_PAIRS) {
                    *block += images[k] * images[l].transpose() * curvature;
                }
            }
        }
        blocks
    }
}

/// The pairs of corners a block of second derivatives belongs to.
pub(super) const CORNER_PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 0), (2, 0), (2, 1)];

/// The rotation part (e, g) and the reflection part (f, h) of a matrix.
fn halves(m: &Matrix2<f64>) -> [f64; 4] {
    [(m.m11 + m.m22) / 2.0, (m.m11 - m.m22) / 2.0, (m.m21 - m.m12) / 2.0, (m.m21 + m.m12) / 2.0]
}

/// Singular values of a matrix with positive determinant, larger first, and the rotations U, V of J = U Σ Vᵀ.
fn singular(m: &Matrix2<f64>) -> (f64, f64, Matrix2<f64>, Matrix2<f64>) {
    let [e, f, g, h] = halves(m);
    let (q, r) = (e.hypot(g), f.hypot(h));
    let (sum, difference) = (h.atan2(f), g.atan2(e));
    let rotation = |angle: f64| {
        let (s, c) = angle.sin_cos();
        Matrix2::new(c, -s, s, c)
    };
    (q + r, q - r, rotation((sum + difference) / 2.0), rotation((sum - difference) / 2.0))
}

/// Stretches (larger first) of a triangle whose Jacobian has a positive determinant.
pub(super) fn stretches(jacobian: &Matrix2<f64>) -> (f64, f64) {
    let [e, f, g, h] = halves(jacobian);
    let (q, r) = (e.hypot(g), f.hypot(h));
    (q + r, q - r)
}

/// The four eigenmodes of the second derivative of Ψ by J.
fn modes(jacobian: &Matrix2<f64>, area_weight: f64) -> [Mode; 4] {
    let (s, t, u, v) = singular(jacobian);
    let det = s * t;
    let first = |a: f64, b: f64| 0.5 * (a - a.powi(-3)) + 2.0 * area_weight * (det - 1.0) * b;
    let second = |a: f64, b: f64| 0.5 * (1.0 + 3.0 * a.powi(-4)) + 2.0 * area_weight * b * b;
    let (d1, d2, d11, d22) = (first(s, t), first(t, s), second(s, t), second(t, s));
    let d12 = 2.0 * area_weight * (2.0 * det - 1.0);
    // Stretching along both axes: a symmetric 2×2 problem.
    let (mean, half, radius) = ((d11 + d22) / 2.0, (d11 - d22) / 2.0, ((d11 - d22) / 2.0).hypot(d12));
    let angle = 0.5 * d12.atan2(half);
    let (sine, cosine) = angle.sin_cos();
    // (Ψ₁ − Ψ₂)/(σ₁ − σ₂) written out: it has a limit where both stretches agree.
    let flip = 0.5 * (1.0 + (s * s + s * t + t * t) / det.powi(3)) - 2.0 * area_weight * (det - 1.0);
    let twist = (d1 + d2) / (s + t);
    let framed = |a: f64, b: f64, c: f64, d: f64| u * Matrix2::new(a, b, c, d) * v.transpose();
    let root = std::f64::consts::FRAC_1_SQRT_2;
    [
        Mode { curvature: mean + radius, mode: framed(cosine, 0.0, 0.0, sine) },
        Mode { curvature: mean - radius, mode: framed(-sine, 0.0, 0.0, cosine) },
        Mode { curvature: twist, mode: framed(0.0, -root, root, 0.0) },
        Mode { curvature: flip, mode: framed(0.0, root, root, 0.0) },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle() -> (Element, [Vec2; 3]) {
        let rest = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.1), Vec2::new(0.3, 0.9)];
        (Element::from_plane([0, 1, 2], rest), [Vec2::new(0.1, 0.0), Vec2::new(1.3, 0.2), Vec2::new(0.5, 1.2)])
    }

    #[test]
    fn the_gradient_is_that_of_the_density() {
        let (element, flat) = triangle();
        let gradient = element.gradient(&element.jacobian(&flat), 3.0);
        let step = 1e-6;
        for k in 0..3 {
            for axis in 0..2 {
                let value = |d: f64| {
                    let mut moved = flat;
                    moved[k][axis] += d;
                    Element::density(&element.jacobian(&moved), 3.0)
                };
                let numeric = (value(step) - value(-step)) / (2.0 * step);
                assert!((numeric - gradient[k][axis]).abs() < 1e-8, "{numeric} {}", gradient[k][axis]);
            }
        }
    }

    #[test]
    fn where_all_modes_are_stiff_the_curvature_is_that_of_the_gradient() {
        let (element, flat) = triangle();
        let jacobian = element.jacobian(&flat);
        assert!(modes(&jacobian, 0.2).iter().all(|m| m.curvature > 0.0));
        let step = 1e-6;
        for ((k, l), block) in CORNER_PAIRS.into_iter().zip(element.curvature(&jacobian, 0.2)) {
            for axis in 0..2 {
                let gradient = |d: f64| {
                    let mut moved = flat;
                    moved[l][axis] += d;
                    element.gradient(&element.jacobian(&moved), 0.2)[k]
                };
                let numeric = (gradient(step) - gradient(-step)) / (2.0 * step);
                assert!((numeric - block.column(axis)).norm() < 1e-7, "{numeric} {block}");
            }
        }
    }
}
