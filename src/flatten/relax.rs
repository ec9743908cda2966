//! Minimising the energy without ever flipping a triangle.
//!
//! L-BFGS (Nocedal 1980) whose first guess of the inverse second derivative is a sparse Cholesky factor of the true
//! one, made positive (projected Newton, Teran et al. 2005), taken anew every few steps: one factor serves several
//! steps, and it knows the stiff springs of the rim. A step is never longer than to the first flip (Smith & Schaefer
//! 2015, section 3.3).

use super::energy::{Curvature, Energy, Real};
use super::{FlattenError, Mode, Options};
use crate::geometry::{Vec2, Vec3};
use crate::linear::{Cholesky, Ordering, nested_dissection};

/// Steps that one factorisation serves: a factor costs about as much as six steps, and later ones are worth less.
const STEPS_PER_FACTOR: usize = 10;
/// A step cut shorter than this says that the curvature has changed.
const SHORT: f64 = 0.1;
/// Share of the way to the first flip that a step may go.
const SHY_OF_FLIP: f64 = 0.9;
/// Sufficient decrease (Armijo): this share of what the slope promises.
const SUFFICIENT: f64 = 1e-4;
/// Halvings before a line search gives up; 2⁻⁴⁰ is below any resolution of the positions that matters.
const HALVINGS: usize = 40;
/// Ties that are tried one after another where a factor fails, in those it has at first.
const TIES: [f64; 4] = [1e2, 1e4, 1e6, 1e8];
/// Energy below which nothing can be gained: it is a mean square strain, and this one is 10⁻⁸ squared.
const ENERGY_FLOOR: f64 = 1e-16;

/// The rim is as long as it should be when its edges are off by less than this share in the mean, for then no part of it
/// is off by more than this share of the whole: of a rim of two metres by a micrometre where only the rim counts, by less
/// than a hundredth of a millimetre otherwise, which nobody can cut.
const RIM_EXACT: [f64; 2] = [5e-7, 4e-6];
/// How often the forces that hold the rim are found anew. Each time the errors left are fifty to a hundred times
/// smaller, where the lengths can be had at all.
const HOLDS: usize = 12;

/// How a relaxation ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outcome {
    pub(super) energy: f64,
    pub(super) iterations: usize,
    pub(super) converged: bool,
}

/// Moves `flat`, which must have no flipped triangle, to a minimum of `energy`. Converged when the next step promises
/// to win less than `options.tolerance` of the energy and, where `options.mode` keeps the rim, its edges have their
/// lengths; the forces that hold them are then those in `energy`.
pub(super) fn relax(energy: &mut Energy, flat: &mut [Vec2], options: &Options) -> Result<Outcome, FlattenError> {
    let mut curvature = Curvature::new(energy)?;
    let order = Ordering::Given(nested_dissection(&lifted(flat), &energy.couplings()));
    let mut factor = Cholesky::new(curvature.pattern().clone(), &order).map_err(|_| FlattenError::Breakdown)?;
    let mut memory = Memory::default();
    let mut gradient = vec![Vec2::zeros(); flat.len()];
    let mut value = energy.value(flat);
    energy.gradient(flat, &mut gradient);
    let mut stale = true;
    let mut holds = if options.mode.keeps_rim() { HOLDS } else { 0 };
    let mut held = false;
    let exact = if options.mode == Mode::Boundary { RIM_EXACT[0] } else { RIM_EXACT[1] };
    for iterations in 0..options.max_iterations {
        let fresh = stale || memory.pairs.len() >= STEPS_PER_FACTOR;
        if fresh {
            renew(&mut factor, &mut curvature, energy, flat)?;
            memory.pairs.clear();
        }
        let direction = memory.direction(&gradient, &factor);
        let slope = dot(&direction, &gradient);
        let settled = -slope <= (options.tolerance * value.abs()).max(ENERGY_FLOOR);
        if settled && (holds == 0 || energy.slack(flat) <= exact) {
            return Ok(Outcome { energy: value, iterations, converged: true });
        }
        // Forces are found from lengths, so every time they have changed the lengths must answer first.
        if settled && !std::mem::replace(&mut held, true) {
            // What is left of the way is short: one factor at its beginning serves to its end.
            stale = holds == HOLDS;
            holds -= 1;
            energy.hold(flat);
            value = energy.value(flat);
            energy.gradient(flat, &mut gradient);
            continue;
        }
        held = false;
        let Some((step, lower)) = search(energy, flat, &direction, slope, value) else {
            if fresh {
                // The factor is that of this very place: rounding hides what is left to win.
                return Ok(Outcome { energy: value, iterations, converged: settled });
            }
            stale = true;
            continue;
        };
        stale = step < SHORT;
        value = lower;
        advance(flat, &direction, step);
        let before = std::mem::replace(&mut gradient, vec![Vec2::zeros(); flat.len()]);
        energy.gradient(flat, &mut gradient);
        memory.remember(&direction, step, &before, &gradient);
    }
    Ok(Outcome { energy: value, iterations: options.max_iterations, converged: false })
}

fn lifted(flat: &[Vec2]) -> Vec<Vec3> {
    flat.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect()
}

/// Factors the curvature at `flat`, tied down more and more where it is not positive to rounding.
fn renew(
    factor: &mut Cholesky<Real>,
    curvature: &mut Curvature,
    energy: &Energy,
    flat: &[Vec2],
) -> Result<(), FlattenError> {
    let mut made = factor.factor(curvature.update(energy, flat));
    for times in TIES {
        made = made.or_else(|_| factor.factor(curvature.tie(times)));
    }
    made.map_err(|_| FlattenError::Breakdown)
}

/// Backtracks from the full step, or from just before the first flip, to a lower energy; the step and that energy.
fn search(energy: &Energy, flat: &[Vec2], direction: &[Vec2], slope: f64, value: f64) -> Option<(f64, f64)> {
    let mut step = (SHY_OF_FLIP * first_flip(energy, flat, direction)).min(1.0);
    let mut trial = vec![Vec2::zeros(); flat.len()];
    for _ in 0..HALVINGS {
        trial.copy_from_slice(flat);
        advance(&mut trial, direction, step);
        let lower = energy.value(&trial);
        if lower <= value + SUFFICIENT * step * slope {
            return Some((step, lower));
        }
        step *= 0.5;
    }
    None
}

/// The smallest positive step at which some triangle loses its area.
fn first_flip(energy: &Energy, flat: &[Vec2], direction: &[Vec2]) -> f64 {
    let corner = |field: &[Vec2], corners: [u32; 3]| corners.map(|v| field[v as usize]);
    let mut first = f64::INFINITY;
    for e in &energy.elements {
        let [a, b, c] = corner(flat, e.corners);
        let [p, q, r] = corner(direction, e.corners);
        let (u, v, du, dv) = (b - a, c - a, q - p, r - p);
        // Area along the step: quadratic · s² + linear · s + constant.
        let (constant, linear, quadratic) = (u.perp(&v), u.perp(&dv) + du.perp(&v), du.perp(&dv));
        first = first.min(smallest_positive_root(quadratic, linear, constant));
    }
    first
}

/// The smallest positive root of q s² + l s + c with c > 0; infinite if there is none.
fn smallest_positive_root(q: f64, l: f64, c: f64) -> f64 {
    let discriminant = l * l - 4.0 * q * c;
    if discriminant < 0.0 {
        return f64::INFINITY;
    }
    // The form 2c / (−l ± √) has no cancellation for the root wanted, and q may be zero.
    let root = discriminant.sqrt();
    let positive = |d: f64| if d > 0.0 { 2.0 * c / d } else { f64::INFINITY };
    positive(-l + root).min(positive(-l - root))
}

fn advance(flat: &mut [Vec2], direction: &[Vec2], step: f64) {
    for (p, d) in flat.iter_mut().zip(direction) {
        *p += d * step;
    }
}

fn dot(a: &[Vec2], b: &[Vec2]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

/// The last steps and what they did to the gradient.
#[derive(Default)]
struct Memory {
    pairs: Vec<Pair>,
}

struct Pair {
    step: Vec<Vec2>,
    change: Vec<Vec2>,
    /// 1 / (step · change).
    weight: f64,
}

impl Memory {
    fn remember(&mut self, direction: &[Vec2], step: f64, before: &[Vec2], after: &[Vec2]) {
        let step: Vec<Vec2> = direction.iter().map(|d| d * step).collect();
        let change: Vec<Vec2> = after.iter().zip(before).map(|(a, b)| a - b).collect();
        let curvature = dot(&step, &change);
        // Only steps along which the energy curves upwards keep the guess positive definite.
        if curvature > f64::EPSILON * dot(&step, &step).sqrt() * dot(&change, &change).sqrt() {
            self.pairs.push(Pair { step, change, weight: 1.0 / curvature });
        }
    }

    /// Minus the guessed inverse curvature times the gradient (two-loop recursion).
    fn direction(&self, gradient: &[Vec2], factor: &Cholesky<Real>) -> Vec<Vec2> {
        let mut d: Vec<Vec2> = gradient.iter().map(|g| -g).collect();
        let mut shares = Vec::with_capacity(self.pairs.len());
        for pair in self.pairs.iter().rev() {
            let share = pair.weight * dot(&pair.step, &d);
            advance(&mut d, &pair.change, -share);
            shares.push(share);
        }
        let mut flat: Vec<f64> = d.iter().flat_map(|v| [v.x, v.y]).collect();
        factor.solve_f64(&mut flat);
        for (d, xy) in d.iter_mut().zip(flat.chunks_exact(2)) {
            *d = Vec2::new(xy[0], xy[1]);
        }
        for (pair, share) in self.pairs.iter().zip(shares.into_iter().rev()) {
            let correction = share - pair.weight * dot(&pair.change, &d);
            advance(&mut d, &pair.step, correction);
        }
        d
    }
}

#[cfg(test)]
mod tests {
    use super::smallest_positive_root as root;

    #[test]
    fn the_first_flip_is_found() {
        assert_eq!(root(0.0, 0.0, 1.0), f64::INFINITY);
        assert_eq!(root(0.0, -2.0, 1.0), 0.5);
        assert_eq!(root(0.0, 2.0, 1.0), f64::INFINITY);
        assert_eq!(root(1.0, -3.0, 2.0), 1.0);
        assert_eq!(root(-1.0, 0.0, 4.0), 2.0);
        assert_eq!(root(1.0, 0.0, 4.0), f64::INFINITY);
    }
}
