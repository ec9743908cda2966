//! Known answers of the plane: a strip cut on the bias, drawn out a little between two jaws.
//!
//! The trellis gives the *mean* rotation of the threads. Threads that do not stretch cross the strip from one free side
//! to the other, and share the motion of the jaws, but not equally. A thread near a jaw's corner crosses cloth that
//! only one thread system shears, and so turns more easily than a thread in the middle. With a shear stiffness that
//! does not grow with the angle, the middle turns by 15 % less than the trellis if threads do not stretch, and by more
//! if they do. The known answer is the state of least energy, found here by Ritz's method in polynomials, without a
//! mesh.

use nalgebra::{DMatrix, DVector};

/// Polynomials across the strip and along it. Half as many of each change the shear in the middle by less than 2 %.
pub(super) const ORDERS: [usize; 2] = [14, 30];

/// A strip whose threads run at 45° to its length.
pub(super) struct BiasStrip {
    /// Width and length, metres.
    pub(super) size: [f64; 2],
    /// Stiffness in warp, in weft and in shear, N/m.
    pub(super) stiffness: [f64; 3],
    /// Polynomials across and along it.
    pub(super) orders: [usize; 2],
}

/// Values and slopes of Legendre's polynomials 0 to `count` − 1 at `t` in −1…1.
fn legendre(count: usize, t: f64) -> Vec<[f64; 2]> {
    let mut out = vec![[1.0, 0.0], [t, 1.0]];
    for n in 1..count {
        let ([p, _], [before, slope]) = (out[n], out[n - 1]);
        let (n, m) = (n as f64, 2.0 * n as f64 + 1.0);
        out.push([(m * t * p - n * before) / (n + 1.0), slope + m * p]);
    }
    out.truncate(count);
    out
}

/// Points and weights of Gauss' quadrature on −1…1, exact for polynomials below degree 2 `count`.
fn gauss(count: usize) -> Vec<[f64; 2]> {
    let root = |k: usize| {
        let mut t = (std::f64::consts::PI * (k as f64 + 0.75) / (count as f64 + 0.5)).cos();
        // Newton's method from Tricomi's guess has a double's digits after four steps.
        for _ in 0..6 {
            let [p, slope] = legendre(count + 1, t)[count];
            t -= p / slope;
        }
        let slope = legendre(count + 1, t)[count][1];
        [t, 2.0 / ((1.0 - t * t) * slope * slope)]
    };
    (0..count).map(root).collect()
}

impl BiasStrip {
    /// Warp and weft strain and shear at `[x, y]` in −1…1 of a displacement by each of the trial functions: those of
    /// the sideways one, then those of the lengthwise one. All vanish in the jaws and turn into themselves when the
    /// strip is turned by half.
    fn strains(&self, [x, y]: [f64; 2]) -> Vec<[f64; 3]> {
        let (across, along) = (legendre(self.orders[0], x), legendre(self.orders[1], y));
        let mut slopes = Vec::new();
        for (i, [a, da]) in across.iter().enumerate() {
            for [b, db] in along.iter().skip(1 - i % 2).step_by(2) {
                let jaws = 1.0 - y * y;
                slopes.push([da * jaws * b * 2.0 / self.size[0], a * (jaws * db - 2.0 * y * b) * 2.0 / self.size[1]]);
            }
        }
        let sideways = slopes.iter().map(|&[dx, dy]| thread_strains([dx, dy], [0.0, 0.0]));
        let lengthwise = slopes.iter().map(|&d| thread_strains([0.0, 0.0], d));
        sideways.chain(lengthwise).collect()
    }

    /// Mean shear (radians) where |x| + |y| ≤ `reach` (metres from the middle), when the jaws part by one metre.
    ///
    /// `None` for stiffnesses that are no positive numbers.
    pub(super) fn shear_in_the_middle(&self, reach: f64) -> Option<f64> {
        let uniform = thread_strains([0.0, 0.0], [0.0, 1.0 / self.size[1]]);
        let weights = self.least_energy(uniform)?;
        // The diamond |x| + |y| ≤ reach is a square in s = x + y and t = x − y.
        let half = self.size.map(|s| 0.5 * s);
        let points = gauss(8);
        let mut mean = 0.0;
        for [s, ws] in &points {
            for [t, wt] in &points {
                let at = [0.5 * (s + t) * reach / half[0], 0.5 * (s - t) * reach / half[1]];
                let bent: f64 = self.strains(at).iter().zip(weights.iter()).map(|(e, w)| e[2] * w).sum();
                mean += 0.25 * ws * wt * (uniform[2] + bent);
            }
        }
        Some(mean)
    }

    /// By how much of each trial function the energy of `uniform` strains is least.
    fn least_energy(&self, uniform: [f64; 3]) -> Option<DVector<f64>> {
        let [columns, rows] = self.orders.map(|n| gauss(n + 4));
        let count = self.strains([0.0, 0.0]).len();
        let (mut matrix, mut load) = (DMatrix::zeros(count, count), DVector::zeros(count));
        for [x, wx] in &columns {
            for [y, wy] in &rows {
                let strains = self.strains([*x, *y]);
                for k in 0..3 {
                    let b = DVector::from_iterator(count, strains.iter().map(|e| e[k]));
                    let weight = wx * wy * self.stiffness[k];
                    matrix.ger(weight, &b, &b, 1.0);
                    load.axpy(-weight * uniform[k], &b, 1.0);
                }
            }
        }
        Some(matrix.cholesky()?.solve(&load))
    }
}

/// Strain of both threads and the angle they close by, by the slopes of a displacement sideways and lengthwise.
fn thread_strains([px, py]: [f64; 2], [qx, qy]: [f64; 2]) -> [f64; 3] {
    let along = |turn: f64| 0.5 * (px + qy + turn * (py + qx));
    [along(1.0), along(-1.0), qy - px]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn gauss_integrates_polynomials() {
        let points = gauss(12);
        for n in 0..24 {
            let sum: f64 = points.iter().map(|[t, w]| w * t.powi(n)).sum();
            let exact = if n % 2 == 0 { 2.0 / (f64::from(n) + 1.0) } else { 0.0 };
            assert_relative_eq!(sum, exact, epsilon = 1e-13);
        }
    }

    #[test]
    fn slopes_of_legendre_are_differences() {
        for t in [-0.9, -0.2, 0.4, 0.99] {
            let [low, middle, high] = [t - 1e-6, t, t + 1e-6].map(|t| legendre(12, t));
            for n in 0..12 {
                assert_relative_eq!(middle[n][1], (high[n][0] - low[n][0]) / 2e-6, epsilon = 1e-6, max_relative = 1e-6);
            }
        }
    }

    /// A strip of one stiffness in all directions (warp = weft = s, shear = s/2: it does not contract sideways) is
    /// strained evenly from jaw to jaw.
    #[test]
    fn an_isotropic_strip_is_drawn_out_evenly() {
        let strip = BiasStrip { size: [0.1, 0.6], stiffness: [100.0, 100.0, 50.0], orders: ORDERS };
        let shear = strip.shear_in_the_middle(0.02).expect("positive");
        assert_relative_eq!(shear, 1.0 / 0.6, max_relative = 1e-9);
    }

    /// Half as many polynomials again tell nothing new, of stiff threads and of unequal ones.
    #[test]
    fn there_are_polynomials_enough() {
        for stiffness in [[60.0, 60.0, 1.0], [20.0, 100.0, 1.0]] {
            let shear = |orders| BiasStrip { size: [0.1, 0.3], stiffness, orders }.shear_in_the_middle(0.04);
            let [used, more] = [ORDERS, [21, 45]].map(|orders| shear(orders).expect("positive"));
            assert_relative_eq!(used, more, max_relative = 0.02);
        }
    }

    /// Threads that give next to nothing: the closed form. With a(v), b(u) the ways of the threads and lengths in
    /// widths over √2, the free threads of a strip of 3 : 1 have 2 p(v) + ∫ p over the threads crossed = const, p = a′,
    /// whose answer is A cos(v/2) + B sin(v/2) with B/A = −(1 − sin ½)/cos ½ for v from 0 to the middle, 1.
    #[test]
    fn threads_that_give_little_turn_as_the_closed_form_says() {
        let (sin, cos) = 0.5f64.sin_cos();
        let share = (1.0 - sin) / cos;
        let integral = |from: f64| 2.0 * (sin - (0.5 * from).sin()) + 2.0 * share * (cos - (0.5 * from).cos());
        // Over |x| + |y| ≤ 0.4 widths v runs from 0.6 to 1 (and back).
        let exact = integral(0.6) / 0.4 / integral(0.0);
        assert_relative_eq!(exact, 0.847, epsilon = 1e-3);
        // Threads that give a little turn by less, and by the less the more they give.
        let ratio = |stiffness: f64| {
            let strip = BiasStrip { size: [0.1, 0.3], stiffness: [stiffness, stiffness, 1.0], orders: ORDERS };
            strip.shear_in_the_middle(0.04).expect("positive") * 0.5 * (0.3 - 0.1)
        };
        let [soft, stiff] = [ratio(60.0), ratio(300.0)];
        assert!(soft < stiff && stiff < exact, "{soft}, {stiff}, {exact}");
        assert_relative_eq!(stiff, exact, max_relative = 0.05);
    }
}
