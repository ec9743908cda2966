//! The energy density of a triangle: the densities of a mode, weighted.

use nalgebra::Matrix2;

use super::distortion::TermWeights;
use super::element::{Hessian, Taken};
use super::{distortion, woven};
use crate::geometry::Vec2;

/// The terms of a triangle's energy density.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Law {
    /// The isotropic term.
    pub(super) weights: TermWeights,
    /// Flat warp direction, where threads count (with weight 1).
    pub(super) warp: Option<Vec2>,
}

impl Law {
    /// Energy per area; infinite at and beyond a flip.
    pub(super) fn density(&self, jacobian: &Matrix2<f64>) -> f64 {
        let distortion = distortion::density(jacobian, &self.weights);
        match self.warp {
            Some(warp) if distortion.is_finite() => distortion + woven::density(jacobian, warp),
            _ => distortion,
        }
    }

    /// Its derivative by J.
    pub(super) fn stress(&self, jacobian: &Matrix2<f64>) -> Matrix2<f64> {
        let distortion = distortion::stress(jacobian, &self.weights);
        self.warp.map_or(distortion, |warp| distortion + woven::stress(jacobian, warp))
    }

    /// Its second derivative by J, as far as it is taken.
    pub(super) fn curvature(&self, jacobian: &Matrix2<f64>, taken: Taken) -> Hessian {
        let mut sum = Hessian::default();
        distortion::modes(jacobian, &self.weights).iter().for_each(|mode| sum.add(mode, taken));
        if let Some(warp) = self.warp {
            woven::modes(jacobian, warp).iter().for_each(|mode| sum.add(mode, taken));
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 1e-6;
    const LAWS: [Law; 2] = [
        Law { weights: TermWeights { dirichlet: 1.0, strain: 0.7, area: 0.2 }, warp: None },
        Law { weights: TermWeights { dirichlet: 0.1, strain: 0.0, area: 0.3 }, warp: Some(Vec2::new(0.6, 0.8)) },
    ];

    fn moved(jacobian: &Matrix2<f64>, k: usize, by: f64) -> Matrix2<f64> {
        let mut out = *jacobian;
        out[k] += by;
        out
    }

    #[test]
    fn the_stress_is_the_derivative_of_the_density() {
        // The second is sheared beyond where a weave locks.
        for jacobian in [Matrix2::new(1.2, 0.3, -0.1, 0.9), Matrix2::new(1.0, -0.9, 0.2, 1.3)] {
            for law in LAWS {
                for k in 0..4 {
                    let value = |by: f64| law.density(&moved(&jacobian, k, by));
                    let numeric = (value(STEP) - value(-STEP)) / (2.0 * STEP);
                    assert!((numeric - law.stress(&jacobian)[k]).abs() < 1e-8);
                }
            }
        }
    }

    #[test]
    fn where_all_modes_are_stiff_they_are_the_derivative_of_the_stress() {
        let (jacobian, law) = (Matrix2::new(1.2, 0.3, -0.1, 0.9), LAWS[0]);
        for k in 0..4 {
            assert!(distortion::modes(&jacobian, &law.weights).iter().all(|mode| mode.curvature > 0.0));
            let expected = Matrix2::from_column_slice(&law.curvature(&jacobian, Taken::Positive).0[k]);
            let stress = |by: f64| law.stress(&moved(&jacobian, k, by));
            let numeric = (stress(STEP) - stress(-STEP)) / (2.0 * STEP);
            assert!((numeric - expected).norm() < 1e-7, "{numeric} {expected}");
        }
    }

    #[test]
    fn threads_on_the_grain_cost_nothing_when_sheared() {
        // By 26°: the weave is not locked.
        let sheared: Matrix2<f64> = Matrix2::new(1.0, 0.44, 0.0, f64::sqrt(1.0 - 0.44 * 0.44));
        let warp = Vec2::new(1.0, 0.0);
        // Columns of J⁻¹ are the threads on the surface: make them of unit length.
        let jacobian = sheared.try_inverse().unwrap_or_default();
        assert!(woven::density(&jacobian, warp) < 1e-20);
        assert_eq!(LAWS[1].density(&Matrix2::new(1.0, 0.0, 0.0, -1.0)), f64::INFINITY);
    }
}
