//! Resistance to extension by the fabric's measured, piecewise-linear load–extension curve (F3, F4).

use crate::fabric::Fabric;
use crate::geometry::{Mat3, Vec3};

/// Relative difference of loads below which they count as one knot: unit conversion changes the last digit.
const SAME: f64 = 1e-9;

/// Load per width against strain in one direction of the cloth. It is linear between knots, and the last slope
/// continues. Compression has the first slope, because cloth buckles out of its plane long before its threads shorten.
#[derive(Clone, Debug, PartialEq)]
pub struct StretchLaw {
    /// (strain, N/m), rising. The first is (0, 0), or (−1, 0) followed by (0, 0) if compression meets no resistance.
    knots: Vec<(f64, f64)>,
}

impl StretchLaw {
    /// One slope, N/m, in both directions.
    pub fn linear(stiffness: f64) -> Self {
        Self { knots: vec![(0.0, 0.0), (1.0, stiffness)] }
    }

    /// The law of `fabric` at `angle` (radians) from its warp. For a given load the strains add up: those of warp and
    /// weft by their curves with cos⁴ and sin⁴, and that of shear with sin² cos². This is the compliance of an
    /// orthotropic sheet without lateral contraction.
    pub fn of(fabric: &Fabric, angle: f64) -> Self {
        let (c2, s2) = (angle.cos().powi(2), angle.sin().powi(2));
        let mut loads: Vec<f64> =
            fabric.warp.points.iter().chain(&fabric.weft.points).map(|p| p.1).filter(|&f| f > 0.0).collect();
        loads.sort_by(f64::total_cmp);
        // A load of one curve in newtons and the same of the other in grams-force differ in their last digit.
        loads.dedup_by(|next, load| *next <= *load * (1.0 + SAME));
        let strain =
            |f: f64| c2 * c2 * fabric.warp.strain(f) + s2 * s2 * fabric.weft.strain(f) + c2 * s2 * f / fabric.shear;
        let knots = std::iter::once((0.0, 0.0)).chain(loads.into_iter().map(|f| (strain(f), f))).collect();
        Self { knots }
    }

    /// This law without resistance to compression.
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

/// Extension of cloth in one direction.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    /// Rest length, metres.
    pub rest: f64,
    /// Width of the cloth that it represents, metres.
    pub width: f64,
    /// Index of its [`StretchLaw`].
    pub law: u32,
}

/// Tangent stiffness of a spring: k = along · t tᵀ + across · (1 − t tᵀ), where t is its direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct StretchTangent {
    /// Unit direction from the first to the second end.
    pub(super) direction: Vec3,
    /// N/m.
    pub(super) along: f64,
    /// N/m. Negative in compression.
    pub(super) across: f64,
}

impl StretchTangent {
    /// Resisting force at one end per displacement of it.
    pub(super) fn matrix(&self) -> Mat3 {
        let Self { direction, along, across } = self;
        Mat3::identity() * *across + direction * direction.transpose() * (along - across)
    }

    /// Positive semidefinite bound. The absolute value of the transverse stiffness lets compressed cloth buckle, but
    /// gently: with the negative value it would buckle within one step.
    pub(super) fn bound(&self) -> Mat3 {
        let across = self.across.abs();
        Mat3::identity() * across + self.direction * self.direction.transpose() * (self.along - across).max(0.0)
    }

    /// Row of the node number `corner` in the stiffness of an element whose nodes have these `shares` of its span:
    /// calls `add` with the number of each node and its block.
    pub(super) fn add_row(&self, shares: &[f64], corner: usize, mut add: impl FnMut(usize, Mat3)) {
        let block = self.matrix();
        shares.iter().enumerate().for_each(|(k, share)| add(k, block * (shares[corner] * share)));
    }
}

impl Stretch {
    /// Energy when its ends are apart by `d`, J.
    pub(super) fn energy(&self, law: &StretchLaw, d: Vec3) -> f64 {
        law.energy(d.norm() / self.rest - 1.0) * self.width * self.rest
    }

    /// Force on its first end, towards the second one at distance `d`, N.
    pub(super) fn pull(&self, law: &StretchLaw, d: Vec3) -> Vec3 {
        let length = d.norm().max(SHORTEST);
        d * (law.load(length / self.rest - 1.0) * self.width / length)
    }

    /// Tangent stiffness when its ends are apart by `d`. The transverse stiffness uses `load` (N/m) if given, otherwise
    /// the load at this length.
    pub(super) fn tangent(&self, law: &StretchLaw, d: Vec3, load: Option<f64>) -> StretchTangent {
        let length = d.norm().max(SHORTEST);
        let strain = length / self.rest - 1.0;
        StretchTangent {
            direction: d / length,
            along: law.slope(strain) * self.width / self.rest,
            across: load.unwrap_or_else(|| law.load(strain)) * self.width / length,
        }
    }
}

/// Least length in the tangent of a spring, metres: it keeps the direction finite.
pub(super) const SHORTEST: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::TensileCurve;
    use approx::assert_relative_eq;
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

    /// Along a thread the law is that thread's curve. Between them it is softer than both where the trellis is.
    #[test]
    fn laws_along_threads_are_the_curves() {
        for name in ["cotton_poplin", "rib"] {
            let fabric = crate::fabric::load(name).expect("shipped");
            for (curve, angle) in [(&fabric.warp, 0.0), (&fabric.weft, FRAC_PI_2)] {
                let law = StretchLaw::of(&fabric, angle);
                for strain in [0.001, 0.02, 0.1, 0.5, 2.0] {
                    assert_relative_eq!(law.load(strain), curve.load(strain), max_relative = 1e-9);
                    assert_relative_eq!(law.energy(strain), curve.energy(strain), max_relative = 1e-9);
                }
            }
            let bias = StretchLaw::of(&fabric, FRAC_PI_4).slope(0.0);
            let compliance = 0.25 * (1.0 / fabric.warp.slope(0.0) + 1.0 / fabric.weft.slope(0.0) + 1.0 / fabric.shear);
            assert_relative_eq!(1.0 / bias, compliance, max_relative = 1e-9);
        }
    }

    /// Laws rise and are finite for any fabric file.
    #[test]
    fn laws_of_strange_fabrics_rise() {
        let poplin = crate::fabric::load("cotton_poplin").expect("shipped");
        for (emt, shear) in [(0.5, 150.0), (0.9, 1e6), (1e-4, 1e-3), (1e12, 30.0), (9.0, 1e4)] {
            let curve = TensileCurve::kawabata(emt, 0.4);
            let fabric = Fabric { warp: curve.clone(), shear, ..poplin.clone() };
            for angle in [0.0, 0.3, FRAC_PI_4, FRAC_PI_2] {
                let law = StretchLaw::of(&fabric, angle);
                assert!(law.knots.windows(2).all(|w| w[0].0 < w[1].0 && w[0].1 < w[1].1 && w[1].1.is_finite()));
            }
        }
    }

    #[test]
    fn the_same_load_in_two_units_is_one_knot() {
        let curve = |load: f64| TensileCurve { points: vec![(0.0, 0.0), (0.013, load), (0.02, 300.0)] };
        let (warp, weft) = (curve(98.0665), curve(98.0665 * (1.0 + f64::EPSILON)));
        let fabric = Fabric { warp, weft, ..crate::fabric::load("rib").expect("shipped") };
        for step in 0..=18 {
            let law = StretchLaw::of(&fabric, FRAC_PI_2 * f64::from(step) / 18.0);
            assert_eq!(law.knots.len(), 3);
        }
    }

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
