//! Known answers for strips by the theory of elastic lines, as numbers.
//!
//! All of them are initial value problems walked from the free end, with t = 1 there less the share of the length
//! that has been walked from it: t = 0 at the free end, 1 in the clamp.

use std::f64::consts::FRAC_PI_2;

use crate::geometry::bisect;

/// Steps of an integration from one end to the other. Halving them changes no figure in its sixth digit.
const STEPS: usize = 4000;
/// Bisections: more than a double has bits.
const BISECTIONS: usize = 60;

/// Solves y'' = f(t, y) from y(0) = `from`, y'(0) = 0 to t = 1 (Runge–Kutta, fourth order). `see` gets every (t, y).
fn walk(from: f64, f: impl Fn(f64, f64) -> f64, mut see: impl FnMut(f64, f64)) -> f64 {
    let h = 1.0 / STEPS as f64;
    let (mut y, mut v) = (from, 0.0);
    see(0.0, y);
    for k in 0..STEPS {
        let t = k as f64 * h;
        let (a1, v1) = (f(t, y), v);
        let (a2, v2) = (f(t + 0.5 * h, y + 0.5 * h * v1), v + 0.5 * h * a1);
        let (a3, v3) = (f(t + 0.5 * h, y + 0.5 * h * v2), v + 0.5 * h * a2);
        let (a4, v4) = (f(t + h, y + h * v3), v + h * a3);
        y += h * (v1 + 2.0 * v2 + 2.0 * v3 + v4) / 6.0;
        v += h * (a1 + 2.0 * a2 + 2.0 * a3 + a4) / 6.0;
        see(t + h, y);
    }
    y
}

/// Zero of `f`, which passes from negative to positive between `low` and `high`.
pub(super) fn root(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    bisect([low, high], BISECTIONS, f)
}

/// A strip clamped level at one end, under its own weight, Γ = σ g L³/B (Peirce 1930; the elastica θ'' = −Γ (1−s) cos
/// θ, θ(0) = 0, θ'(1) = 0). Returns how far its end is out and down, as shares of its length.
pub(super) fn cantilever(gamma: f64) -> [f64; 2] {
    // φ = π/2 − θ, the angle from the plumb line: φ'' = Γ t sin φ, φ = π/2 in the clamp. It grows from the free end by
    // a factor, so the angle there is found by its logarithm.
    let bend = |t: f64, phi: f64| gamma * t * phi.sin();
    let end = root(-40.0, FRAC_PI_2.ln(), |log| walk(log.exp(), bend, |_, _| {}) - FRAC_PI_2).exp();
    let (mut out, mut down) = (0.0, 0.0);
    walk(end, bend, |t, phi| {
        // Trapezoids: half of the first and of the last.
        let share = if t == 0.0 || t > 1.0 - 0.5 / STEPS as f64 { 0.5 } else { 1.0 } / STEPS as f64;
        out += share * phi.sin();
        down += share * phi.cos();
    });
    [out, down]
}

/// Γ at which the line from the clamp to the end of a cantilever falls by `angle` (radians).
pub(super) fn gamma_of_chord(angle: f64) -> f64 {
    root(0.1, 100.0, |gamma| {
        let [out, down] = cantilever(gamma);
        down / out - angle.tan()
    })
}

/// The smallest λ for which y'' + λ tⁿ y = 0, y'(0) = 0, has y(1) = 0.
fn critical(n: i32, above: f64) -> f64 {
    // Below it y(1) is positive.
    root(0.0, above, |lambda| -walk(1.0, |t, y| -lambda * t.powi(n) * y, |_, _| {}))
}

/// Γ at which a strip that stands on its clamp falls (Greenhill 1881).
pub(super) fn standing() -> f64 {
    critical(1, 12.0)
}

/// Γ at which a narrow strip on edge, clamped level at one end, gives way sideways (Prandtl 1899, under its own
/// weight): σ g w L³/√(EI·GJ) = 12.85 with EI = B w and GJ = 2 B w for a sheet that does not contract
/// sideways as it bends.
pub(super) fn on_edge() -> f64 {
    // The moment is q t²/2: y'' + (q L³)²/(4 EI GJ) t⁴ y = 0.
    2.0 * critical(4, 60.0).sqrt() * 2f64.sqrt()
}

/// A chain of length 1 between two ends on one level, `span` apart, whose length is 1 before its weight stretches it:
/// `strain` by the tension in weights. Returns (sag, level pull in weights).
pub(super) fn catenary(span: f64, strain: impl Fn(f64) -> f64) -> [f64; 2] {
    let hang = |pull: f64| {
        let (mut out, mut down) = (0.0, 0.0);
        let h = 0.5 / STEPS as f64;
        for k in 0..STEPS {
            let s = (k as f64 + 0.5) * h;
            let tension = pull.hypot(s);
            let length = h * (1.0 + strain(tension));
            out += length * pull / tension;
            down += length * s / tension;
        }
        [2.0 * out, down]
    };
    let pull = root(1e-6, 1e3, |pull| hang(pull)[0] - span);
    [hang(pull)[1], pull]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_master_curve_is_the_published_one() {
        for (gamma, ratio) in
            [(1.0, 0.1246), (2.0, 0.2467), (4.0, 0.4777), (8.0, 0.8843), (16.0, 1.563), (32.0, 2.674), (100.0, 5.888)]
        {
            let [out, down] = cantilever(gamma);
            assert_relative_eq!(down / out, ratio, max_relative = 6e-4);
        }
        let [out, down] = cantilever(8.0);
        assert_relative_eq!(out, 0.7244, epsilon = 6e-5);
        assert_relative_eq!(down, 0.6406, epsilon = 6e-5);
        assert_relative_eq!(cantilever(1e-3)[1], 1e-3 / 8.0, max_relative = 1e-5);
    }

    #[test]
    fn critical_loads_are_those_of_the_handbooks() {
        assert_relative_eq!(gamma_of_chord(41.5f64.to_radians()), 8.004, max_relative = 1e-4);
        assert_relative_eq!(standing(), 7.8373, max_relative = 1e-5);
        assert_relative_eq!(on_edge(), 12.854 * 2f64.sqrt(), max_relative = 1e-4);
    }

    #[test]
    fn chains_hang_as_the_hyperbolic_cosine() {
        for (over, sag, pull) in [
            (1.05, 0.1393, 0.9196),
            (1.1, 0.2003, 0.6550),
            (1.2, 0.2923, 0.4695),
            (1.5, 0.5026, 0.3082),
            (2.0, 0.7964, 0.2296),
        ] {
            // The table counts in spans, the function in lengths.
            let found = catenary(1.0 / over, |_| 0.0);
            assert_relative_eq!(found[0] * over, sag, epsilon = 6e-5);
            assert_relative_eq!(found[1] * over, pull, epsilon = 6e-5);
        }
    }
}
