//! How far a triangle's flat image is from its true shape, the same in all directions.
//!
//! The Jacobian J takes the triangle's own plane to the flat piece; its singular values are the stretches. Symmetric
//! Dirichlet energy (Smith & Schaefer 2015, eq. 3), squared strain (Liu et al. 2008, eq. 3 with the best rotation) and
//! an area term: Ψ = d ((|J|² + |J⁻¹|²)/4 − 1) + s ((σ₁−1)² + (σ₂−1)²) + a (det J − 1)². The first is like the second
//! near an isometry and infinite where the triangle has no area.

use nalgebra::Matrix2;

use super::element::CurvatureMode;

/// The weights of the terms.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TermWeights {
    /// Of the symmetric Dirichlet energy; positive, for it is the wall before a flip.
    pub(super) dirichlet: f64,
    /// Of the squared strain.
    pub(super) strain: f64,
    /// Of the squared change of area.
    pub(super) area: f64,
}

/// Ψ at J; infinite if the triangle is flipped or without area.
pub(super) fn density(jacobian: &Matrix2<f64>, weights: &TermWeights) -> f64 {
    let det = jacobian.determinant();
    if det <= 0.0 {
        return f64::INFINITY;
    }
    // |J|² − 2 det = (σ₁−σ₂)², free of the cancellation of the plain sum near an isometry.
    let [e, f, g, h] = halves(jacobian);
    let spread = 4.0 * (f * f + h * h);
    let excess = (det - 1.0) * (det - 1.0);
    let dirichlet = (spread * (1.0 + 1.0 / (det * det)) + 2.0 * excess / det) / 4.0;
    let strain = 2.0 * ((e * e + g * g).sqrt() - 1.0).powi(2) + 0.5 * spread;
    weights.dirichlet * dirichlet + weights.strain * strain + weights.area * excess
}

/// The derivative of Ψ by J.
pub(super) fn stress(jacobian: &Matrix2<f64>, weights: &TermWeights) -> Matrix2<f64> {
    let det = jacobian.determinant();
    let square = jacobian.norm_squared();
    let [e, _, g, _] = halves(jacobian);
    let rotation = Matrix2::new(e, -g, g, e) / (e * e + g * g).sqrt();
    let along = 0.5 * weights.dirichlet * (1.0 + 1.0 / (det * det)) + 2.0 * weights.strain;
    let across = 2.0 * weights.area * (det - 1.0) - 0.5 * weights.dirichlet * square / (det * det * det);
    jacobian * along + cofactor(jacobian) * across - rotation * (2.0 * weights.strain)
}

/// The derivative of the determinant.
pub(super) fn cofactor(m: &Matrix2<f64>) -> Matrix2<f64> {
    Matrix2::new(m.m22, -m.m21, -m.m12, m.m11)
}

/// The rotation part (e, g) and the reflection part (f, h) of a matrix.
fn halves(m: &Matrix2<f64>) -> [f64; 4] {
    [(m.m11 + m.m22) / 2.0, (m.m11 - m.m22) / 2.0, (m.m21 - m.m12) / 2.0, (m.m21 + m.m12) / 2.0]
}

/// Singular values of a matrix with positive determinant, larger first, and the rotations U, V of J = U Σ Vᵀ.
fn singular(m: &Matrix2<f64>) -> (f64, f64, Matrix2<f64>, Matrix2<f64>) {
    let [e, f, g, h] = halves(m);
    let (q, r) = ((e * e + g * g).sqrt(), (f * f + h * h).sqrt());
    // (e, g) is q times the unit vector at the difference of U's and V's angles, (f, h) r times that at their sum.
    let difference = [e / q, g / q];
    let sum = if r > 0.0 { [f / r, h / r] } else { [1.0, 0.0] };
    let [c, s] = half_angle(sum);
    let rotation = |[c, s]: [f64; 2]| Matrix2::new(c, -s, s, c);
    let [dc, ds] = half_angle(difference);
    (q + r, q - r, rotation([c * dc - s * ds, s * dc + c * ds]), rotation([c * dc + s * ds, s * dc - c * ds]))
}

/// Cosine and sine of half the angle, between −½π and ½π, whose cosine and sine are given. A whole turn more or less of
/// the angle would turn U and V both by half a turn, which U Σ Vᵀ does not show.
fn half_angle([cosine, sine]: [f64; 2]) -> [f64; 2] {
    let half = ((1.0 + cosine.abs()) / 2.0).sqrt();
    let other = sine.abs() / (2.0 * half);
    let (c, s) = if cosine >= 0.0 { (half, other) } else { (other, half) };
    [c, s.copysign(sine)]
}

/// Stretches (larger first) of a triangle whose Jacobian has a positive determinant.
pub(super) fn stretches(jacobian: &Matrix2<f64>) -> (f64, f64) {
    let [e, f, g, h] = halves(jacobian);
    let (q, r) = (e.hypot(g), f.hypot(h));
    (q + r, q - r)
}

/// The four eigenmodes of the second derivative of Ψ by J; Smith, De Goes & Kim 2019, "Analytic eigensystems for
/// isotropic distortion energies", section 4.
pub(super) fn modes(jacobian: &Matrix2<f64>, weights: &TermWeights) -> [CurvatureMode; 4] {
    let (s, t, u, v) = singular(jacobian);
    let det = s * t;
    let (wall, strain, area) = (0.5 * weights.dirichlet, 2.0 * weights.strain, 2.0 * weights.area);
    let first = |a: f64, b: f64| wall * (a - a.powi(-3)) + strain * (a - 1.0) + area * (det - 1.0) * b;
    let second = |a: f64, b: f64| wall * (1.0 + 3.0 * a.powi(-4)) + strain + area * b * b;
    let (d1, d2, d11, d22) = (first(s, t), first(t, s), second(s, t), second(t, s));
    let d12 = area * (2.0 * det - 1.0);
    // Stretching along both axes: a symmetric 2×2 problem.
    let (mean, half, radius) = ((d11 + d22) / 2.0, (d11 - d22) / 2.0, ((d11 - d22) / 2.0).hypot(d12));
    let angle = 0.5 * d12.atan2(half);
    let (sine, cosine) = angle.sin_cos();
    // (Ψ₁ − Ψ₂)/(σ₁ − σ₂) written out: it has a limit where both stretches agree.
    let flip = wall * (1.0 + (s * s + s * t + t * t) / det.powi(3)) + strain - area * (det - 1.0);
    let twist = (d1 + d2) / (s + t);
    let framed = |a: f64, b: f64, c: f64, d: f64| u * Matrix2::new(a, b, c, d) * v.transpose();
    let root = std::f64::consts::FRAC_1_SQRT_2;
    [
        CurvatureMode { curvature: mean + radius, mode: framed(cosine, 0.0, 0.0, sine) },
        CurvatureMode { curvature: mean - radius, mode: framed(-sine, 0.0, 0.0, cosine) },
        CurvatureMode { curvature: twist, mode: framed(0.0, -root, root, 0.0) },
        CurvatureMode { curvature: flip, mode: framed(0.0, root, root, 0.0) },
    ]
}
