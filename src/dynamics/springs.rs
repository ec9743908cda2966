//! Springs with the fabric's measured, piecewise-linear load–extension curve (F3, F4).

use std::f64::consts::FRAC_PI_2;

use crate::fabric::{Fabric, TensileCurve};
use crate::geometry::{Vec3, bisect};

/// The springs along a thread keep at least this share of its stretch, however little it is beside the trellis.
const LEAST_THREAD: f64 = 0.1;
/// Strain over which what the diagonals hold is as good as straight.
const STRAIGHT: f64 = 0.02;
/// The most parts a segment of a curve is cut into.
const MOST_PARTS: f64 = 64.0;
/// Bisections: as many as a double has bits.
const HALVINGS: usize = 53;

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

    /// The law of a spring at `step` of `steps` from warp to weft in a grid whose cells have one diagonal each. There
    /// the trellis is the diagonals' business alone, 4 G at 45°; drawn along the threads they pull too, and the springs
    /// along the threads leave that to them ([`trellis_load`]).
    pub(super) fn in_grid(fabric: &Fabric, step: usize, steps: usize) -> Self {
        let [warp, weft] = thread_stiffness(fabric);
        let without = |curve: &TensileCurve, across: f64| {
            let held = |strain: f64| trellis_load(fabric.shear, across, strain);
            let mut knots = vec![(0.0, 0.0)];
            for pair in curve.points.windows(2) {
                let [from, to] = [pair[0], pair[1]];
                let parts = ((to.0 - from.0) / STRAIGHT).ceil().clamp(1.0, MOST_PARTS);
                let (step, rise) = ((to.0 - from.0) / parts, (to.1 - from.1) / parts);
                for part in 1..=parts as usize {
                    let (strain, load) = (from.0 + step * part as f64, from.1 + rise * part as f64);
                    let least = knots[knots.len() - 1].1 + LEAST_THREAD * rise;
                    knots.push((strain, (load - held(strain)).max(least)));
                }
            }
            Self { knots }
        };
        match 2 * step {
            0 => without(&fabric.warp, weft),
            twice if twice == steps => Self::linear(4.0 * fabric.shear),
            twice if twice == 2 * steps => without(&fabric.weft, warp),
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

/// First slopes (N/m) of the springs along warp and weft, so that cloth drawn out a little along one thread and free to
/// contract along the other has the slope of its curve. The diagonals hold G of the sum of both strains and the sheet
/// contracts until the threads across, of stiffness s, press as much: along the pull G s / (s + G) is left. Where the
/// diagonals alone are stiffer than the curve, the threads keep [`LEAST_THREAD`].
fn thread_stiffness(fabric: &Fabric) -> [f64; 2] {
    let (shear, [warp, weft]) = (fabric.shear, [&fabric.warp, &fabric.weft].map(|c| c.slope(0.0)));
    let held = |across: f64| shear * across / (across + shear);
    let of_warp = |of_weft: f64| (warp - held(of_weft)).max(LEAST_THREAD * warp);
    let of_weft = bisect([LEAST_THREAD * weft, weft], HALVINGS, |of_weft| of_weft + held(of_warp(of_weft)) - weft);
    [of_warp(of_weft), of_weft]
}

/// What the diagonals of a grid of shear stiffness `shear` hold (N/m) when cloth is drawn out by `strain` along one
/// thread and free to contract across, where its springs have the slope `across`: with the stretches λ and μ of both, a
/// diagonal is √((λ² + μ²)/2) of its length d, holds 4 G (d − 1), and the forces across are in balance.
fn trellis_load(shear: f64, across: f64, strain: f64) -> f64 {
    let along = 1.0 + strain;
    let pull = |contracted: f64| {
        let diagonal = (0.5 * (along * along + contracted * contracted)).sqrt();
        2.0 * shear * (diagonal - 1.0) / diagonal
    };
    let unbalanced = |contracted: f64| across * (contracted - 1.0) + pull(contracted) * contracted;
    along * pull(bisect([0.0, 1.0], HALVINGS, unbalanced))
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

/// A spring's stiffness at one position: `along` its direction t and `across` it,
/// k = along · t tᵀ + across · (1 − t tᵀ).
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
    /// The tangent at positions `x`, across the spring by the `load` (N/m) given instead of its own.
    pub(super) fn tangent(&self, law: &StretchLaw, x: &[Vec3], load: Option<f64>) -> SpringTangent {
        let d = x[self.ends[1] as usize] - x[self.ends[0] as usize];
        let length = d.norm().max(SHORTEST);
        let strain = length / self.rest - 1.0;
        SpringTangent {
            direction: d / length,
            along: law.slope(strain) * self.width / self.rest,
            across: load.unwrap_or_else(|| law.load(strain)) * self.width / length,
        }
    }
}

/// A spring is never taken for shorter than this, metres.
pub(super) const SHORTEST: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Sheets that are drawn out along a thread and contract across give the fabric's curve back, stiff ones and soft
    /// ones, also those whose diagonals are stiffer than their threads.
    #[test]
    fn threads_and_trellis_together_are_the_curve() {
        let shipped = |name: &str| crate::fabric::load(name).expect("shipped");
        let made = |emt: f64, shear: f64| {
            let curve = TensileCurve::kawabata(emt, 0.6);
            Fabric { warp: curve.clone(), weft: curve, shear, ..shipped("rib") }
        };
        let mut fabrics: Vec<Fabric> = ["cotton_poplin", "jersey", "rib", "nylon_spandex_knit"].map(shipped).to_vec();
        fabrics.extend([made(0.5, 10.0), made(0.5, 30.0), made(0.5, 60.0), made(1.0, 20.0)]);
        for fabric in fabrics {
            let [warp, diagonal, weft] = [0, 1, 2].map(|step| StretchLaw::in_grid(&fabric, step, 2));
            for (curve, along, across) in [(&fabric.warp, &warp, &weft), (&fabric.weft, &weft, &warp)] {
                for &(strain, load) in &curve.points[1..] {
                    // Work per area of a cell, and the stretch across at which it is least.
                    let work = |e: f64, c: f64| {
                        let d = (0.5 * ((1.0 + e).powi(2) + (1.0 + c).powi(2))).sqrt() - 1.0;
                        along.energy(e) + across.energy(c) + diagonal.energy(d)
                    };
                    let least = |e: f64| {
                        let (mut low, mut high) = (-1.0, 0.1);
                        for _ in 0..200 {
                            let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
                            if work(e, a) < work(e, b) { high = b } else { low = a }
                        }
                        work(e, low)
                    };
                    let h = 1e-5;
                    let found = (least(strain) - least(strain - h)) / h;
                    assert_relative_eq!(found, load, max_relative = 0.02);
                }
            }
        }
    }

    /// Whatever a file says, laws rise, are finite and have no more knots than they need.
    #[test]
    fn laws_of_strange_fabrics_rise() {
        let poplin = crate::fabric::load("cotton_poplin").expect("shipped");
        for (emt, shear) in [(0.5, 150.0), (0.9, 1e6), (1e-4, 1e-3), (1e12, 30.0), (9.0, 1e4)] {
            let curve = TensileCurve::kawabata(emt, 0.4);
            let fabric = Fabric { warp: curve.clone(), shear, ..poplin.clone() };
            for step in 0..=2 {
                let law = StretchLaw::in_grid(&fabric, step, 2);
                assert!(law.knots.len() < 500, "{} knots", law.knots.len());
                assert!(law.knots.windows(2).all(|w| w[0].0 < w[1].0 && w[0].1 < w[1].1 && w[1].1.is_finite()));
            }
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
