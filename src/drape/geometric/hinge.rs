//! The hinge of (6): edge ij between the triangles with apexes k and l.
//!
//! A(e) = (μ pᵢ + (1−μ) pⱼ) − (λ pₖ + (1−λ) pₗ), with μ and λ such that A_T − A_M stands on the hinge. Laid flat, the
//! lines ij and kl meet in one point, and μ and λ are its places on them. Then A_M = 0, A_T is how far the two
//! diagonals of the bent hinge pass each other, and ‖A_T‖² is quadratic in the positions: the isometric bending stencil
//! up to a factor per edge.

use crate::geometry::Vec2;

/// Coefficients of pᵢ, pⱼ, pₖ, pₗ in A(e).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hinge {
    /// They sum to zero, and so do the moments of the flat hinge.
    pub(super) coefficients: [f64; 4],
    /// Squared fold angle over ‖A‖² for small angles, 1/m².
    pub(super) angle_per_length: f64,
    /// Area of both triangles, m².
    pub(super) area: f64,
}

/// Apex of a triangle laid flat at its edge: place along the edge from its first end, and height over it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Apex {
    along: f64,
    height: f64,
}

impl Apex {
    /// The apex of triangle `i`, `j`, `apex`, in a frame where the edge ij has its first end at 0.
    pub(super) fn new(i: Vec2, j: Vec2, apex: Vec2) -> Self {
        let edge = j - i;
        let length = edge.norm();
        Self { along: (apex - i).dot(&edge) / length, height: (apex - i).perp(&edge).abs() / length }
    }
}

impl Hinge {
    /// The hinge at an edge of this `length` between two apexes, each measured in its own triangle.
    pub(super) fn new(length: f64, k: Apex, l: Apex) -> Self {
        let heights = k.height + l.height;
        // Line kl crosses the edge where the heights are in balance.
        let lambda = l.height / heights;
        let crossing = lambda * k.along + (1.0 - lambda) * l.along;
        let mu = 1.0 - crossing / length;
        // A fold by θ lifts the crossing of the edge by θ hₖhₗ/(hₖ+hₗ) over the line kl.
        let lift = k.height * l.height / heights;
        Self {
            coefficients: [mu, 1.0 - mu, -lambda, lambda - 1.0],
            angle_per_length: 1.0 / (lift * lift),
            area: 0.5 * length * heights,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec3;
    use approx::assert_relative_eq;

    #[test]
    fn a_flat_hinge_is_zero_and_a_folded_one_measures_its_angle() {
        let [i, j, k, l] = [(0.1, 0.2), (1.3, 0.1), (0.9, 1.1), (0.2, -0.6)].map(|(x, y)| Vec2::new(x, y));
        let hinge = Hinge::new((j - i).norm(), Apex::new(i, j, k), Apex::new(i, j, l));
        let flat = [i, j, k, l];
        let sum = flat.iter().zip(&hinge.coefficients).fold(Vec2::zeros(), |s, (p, c)| s + p * *c);
        assert_relative_eq!(sum.norm(), 0.0, epsilon = 1e-14);
        // Fold the side of k up by a small angle about the edge.
        let angle = 1e-4f64;
        let axis = nalgebra::Unit::new_normalize((j - i).push(0.0));
        let turn = nalgebra::Rotation3::from_axis_angle(&axis, angle);
        let start = i.push(0.0);
        let folded: Vec<Vec3> = flat
            .iter()
            .enumerate()
            .map(|(n, p)| if n == 2 { start + turn * (p.push(0.0) - start) } else { p.push(0.0) })
            .collect();
        let a = folded.iter().zip(&hinge.coefficients).fold(Vec3::zeros(), |s, (p, c)| s + p * *c);
        assert_relative_eq!((hinge.angle_per_length * a.norm_squared()).sqrt(), angle, max_relative = 1e-6);
        assert!(axis.dot(&a).abs() < 1e-7 * angle);
    }
}
