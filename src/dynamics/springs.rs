//! Springs with the fabric's measured, piecewise-linear load–extension curve (F3, F4).

use std::f64::consts::FRAC_PI_2;

use crate::fabric::{Fabric, TensileCurve};
use crate::geometry::Vec3;

/// The springs along a thread leave at most this share of its softest stretch to the diagonals.
const MOST_TRELLIS: f64 = 0.5;

/// Load per width against strain in one direction of the cloth: linear between knots, the last slope goes on, and
/// compression keeps the first slope (cloth buckles out of its plane long before its threads shorten).
#[derive(Clone, Debug, PartialEq)]
pub struct StretchLaw {
    /// (strain, N/m), rising; (0, 0) is the first, or the second after (−1, 0) where compression meets no resistance.
    knots: Vec<(f64, f64)>,
}

impl StretchLaw {
    /// One slope, N/m, in both directions.
    pub fn linear(stiffness: f64) -> Self {
        Self { knots: vec![(0.0, 0.0), (1.0, stiffness)] }
    }

    /// The law of `fabric` at `angle` (radians) from its warp. Loads add their strains: warp and weft threads by their
    /// curves, cos⁴ and sin⁴, and the trellis between them by the shear stiffness, sin² cos² (the compliance of an
    /// orthotropic sheet without lateral contraction).
    pub fn of(fabric: &Fabric, angle: f64) -> Self {
        let (c2, s2) = (angle.cos().powi(2), angle.sin().powi(2));
        let mut loads: Vec<f64> =
            fabric.warp.points.iter().chain(&fabric.weft.points).map(|p| p.1).filter(|&f| f > 0.0).collect();
        loads.sort_by(f64::total_cmp);
        loads.dedup();
        let strain =
            |f: f64| c2 * c2 * fabric.warp.strain(f) + s2 * s2 * fabric.weft.strain(f) + c2 * s2 * f / fabric.shear;
        let knots = std::iter::once((0.0, 0.0)).chain(loads.into_iter().map(|f| (strain(f), f))).collect();
        Self { knots }
    }

    /// The law of a spring at `step` of `steps` from warp to weft in a grid whose cells have one diagonal each. There the
    /// trellis is the diagonals' business alone, 4 G at 45°; drawn along the threads they pull too, as much as G, which
    /// the springs along the threads leave to them.
    pub(super) fn in_grid(fabric: &Fabric, step: usize, steps: usize) -> Self {
        let without_trellis = |curve: &TensileCurve| {
            let slopes = curve.points.windows(2).map(|w| (w[1].1 - w[0].1) / (w[1].0 - w[0].0));
            let trellis = fabric.shear.min(MOST_TRELLIS * slopes.fold(f64::INFINITY, f64::min));
            Self { knots: curve.points.iter().map(|(strain, load)| (*strain, load - trellis * strain)).collect() }
        };
        match 2 * step {
            0 => without_trellis(&fabric.warp),
            twice if twice == steps => Self::linear(4.0 * fabric.shear),
            twice if twice == 2 * steps => without_trellis(&fabric.weft),
            _ => Self::of(fabric, FRAC_PI_2 * step as f64 / steps as f64),
        }
    }

    /// The same law without resistance to compression.
    pub(super) fn slack(&self) -> Self {
        let extension = self.knots.iter().filter(|k| k.0 >= 0.0).copied();
        Self { knots: std::iter::once((-1.0, 0.0)).chain(extension).collect() }
    }

    fn segment(&self, strain: f64) -> (f64, f64, f64) {
        let last = self.knots.len() - 1;
        let i = self.knots[1..last].partition_point(|k| k.0 <= strain);
        let (a, b) = (self.knots[i], self.knots[i + 1]);
        (a.0, a.1, (b.1 - a.1) / (b.0 - a.0))
    }

    /// Load, N/m, negative in compression.
    pub fn load(&self, strain: f64) -> f64 {
        let (e, f, slope) = self.segment(strain);
        f + slope * (strain - e)
    }

    /// Slope of the load, N/m.
    pub fn slope(&self, strain: f64) -> f64 {
        self.segment(strain).2
    }

    /// Work per area up to a strain, J/m².
    pub fn energy(&self, strain: f64) -> f64 {
        let (e, f, slope) = self.segment(strain);
        let below: f64 = self
            .knots
            .windows(2)
            .take_while(|w| w[1].0 <= e)
            .map(|w| 0.5 * (w[0].1 + w[1].1) * (w[1].0 - w[0].0))
            .sum();
        let d = strain - e;
        below + f * d + 0.5 * slope * d * d
    }
}

/// A spring between two nodes.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// Its nodes.
    pub ends: [u32; 2],
    /// Rest length, metres.
    pub rest: f64,
    /// Width of cloth it stands for, metres.
    pub width: f64,
    /// Index of its [`StretchLaw`].
    pub law: u32,
}

/// A spring's stiffness at one position: `along` its direction t and `across` it, k = along · t tᵀ + across · (1 − t tᵀ).
#[derive(Clone, Copy, Debug)]
pub(super) struct SpringTangent {
    /// Unit direction from the first to the second end.
    pub(super) direction: Vec3,
    /// N/m.
    pub(super) along: f64,
    /// N/m; negative in compression.
    pub(super) across: f64,
}

impl Spring {
    /// The tangent at positions `x`.
    pub(super) fn tangent(&self, law: &StretchLaw, x: &[Vec3]) -> SpringTangent {
        let d = x[self.ends[1] as usize] - x[self.ends[0] as usize];
        let length = d.norm().max(SHORTEST);
        let strain = length / self.rest - 1.0;
        SpringTangent {
            direction: d / length,
            along: law.slope(strain) * self.width / self.rest,
            across: law.load(strain) * self.width / length,
        }
    }
}

/// A spring is never taken for shorter than this, metres.
pub(super) const SHORTEST: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn load_and_energy_belong_together() {
        let law = StretchLaw { knots: vec![(0.0, 0.0), (0.01, 5.0), (0.02, 40.0), (0.03, 100.0)] };
        assert_relative_eq!(law.load(0.015), 22.5, epsilon = 1e-9);
        assert_relative_eq!(law.load(-0.01), -5.0, epsilon = 1e-9);
        assert_relative_eq!(law.load(0.04), 160.0, epsilon = 1e-9);
        let slack = law.slack();
        assert_relative_eq!(slack.load(-0.3), 0.0);
        assert_relative_eq!(slack.energy(-0.3), 0.0);
        for (law, e) in [&law, &slack].into_iter().flat_map(|l| [-0.02, 0.004, 0.013, 0.025, 0.07].map(|e| (l, e))) {
            let h = 1e-7;
            assert_relative_eq!((law.energy(e + h) - law.energy(e - h)) / (2.0 * h), law.load(e), max_relative = 1e-6);
            assert_relative_eq!((law.load(e + h) - law.load(e - h)) / (2.0 * h), law.slope(e), max_relative = 1e-6);
        }
    }
}
