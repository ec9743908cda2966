//! Minimising the energy without ever flipping a triangle.
//!
//! L-BFGS (Nocedal 1980) whose first guess of the inverse second derivative is a sparse Cholesky factor of the true
//! one, made positive (projected Newton, Teran et al. 2005), taken anew every few steps: one factor serves several
//! steps, and it knows the stiff springs of the rim. A step is never longer than to the first flip (Smith & Schaefer
//! 2015, section 3.3).

use super::energy::FlatEnergy;
use super::inverse::Inverse;
use super::overlap::{RIM_EXACT, rim_crossings};
use super::zone::Zone;
use super::{FlattenError, FlattenOptions, Mode};
use crate::geometry::Vec2;
use crate::linear::{Memory, advance, dot};

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
/// A step that wins more than this share of what its slope promises, where half is expected, is lengthened: the
/// curvature along it is less than was thought.
const WINS: f64 = 0.7;
/// The tolerance of the woven mode against that of the others. A weave's energy is hardly more than the mean square
/// strain of its threads, so that with 10⁻³ of it they are within 0.05 % of their least strain.
const WOVEN_TOLERANCE: f64 = 100.0;
/// Energy below which nothing can be gained: it is a mean square strain, and this one is that of 3·10⁻⁹. With 10⁻⁸ the
/// edges of a developable sheet were off by 1.7·10⁻⁶ on the bias, where weave hardly resists.
const ENERGY_FLOOR: f64 = 1e-17;

/// How often the forces that hold the rim are found anew. Each time the errors left are fifty to a hundred times
/// smaller, where the lengths can be had at all.
const HOLDS: usize = 12;

/// How a relaxation ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Relaxed {
    pub(super) energy: f64,
    pub(super) iterations: usize,
    pub(super) converged: bool,
}

/// When to stop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Goal {
    /// Settled when the next step promises to win less than this share of the energy.
    pub(super) tolerance: f64,
    pub(super) max_iterations: usize,
    /// How often the forces that hold the springs may be found anew.
    pub(super) holds: usize,
    /// The mean share by which held springs may be off: with this they need no other forces.
    pub(super) exact: f64,
}

impl Goal {
    /// `held` says whether there are springs to be held.
    pub(super) fn of(options: &FlattenOptions, held: bool) -> Self {
        Self {
            tolerance: if options.mode == Mode::Woven { WOVEN_TOLERANCE } else { 1.0 } * options.tolerance,
            max_iterations: options.max_iterations,
            holds: if held { HOLDS } else { 0 },
            exact: if options.mode == Mode::Boundary { RIM_EXACT[0] } else { RIM_EXACT[1] },
        }
    }
}

/// A way down an energy, prepared for its couplings.
pub(super) struct EnergyDescent {
    inverse: Inverse,
    /// Rims that no step may bring to lie on each other.
    apart: Vec<Vec<u32>>,
}

impl EnergyDescent {
    pub(super) fn new<const N: usize>(energy: &FlatEnergy<N>) -> Result<Self, FlattenError> {
        Ok(Self { inverse: Inverse::new(energy)?, apart: Vec::new() })
    }

    /// The same way, on which the piece never lies on itself; it ends where it would have to.
    pub(super) fn keeping_apart(self, rims: &[Vec<u32>]) -> Self {
        Self { apart: rims.to_vec(), ..self }
    }

    /// Moves `flat`, which must have no flipped triangle, to a minimum of `energy`. Converged when the goal is met; the
    /// forces that hold the springs are then those in `energy`. On the long way to the first minimum `zone` settles
    /// before every step.
    pub(super) fn down<const N: usize>(
        &mut self,
        energy: &mut FlatEnergy<N>,
        flat: &mut [Vec2],
        goal: &Goal,
        mut zone: Option<&mut Zone>,
    ) -> Result<Relaxed, FlattenError> {
        let mut memory = Memory::<2>::default();
        let mut gradient = vec![Vec2::zeros(); flat.len()];
        let mut value = energy.value(flat);
        energy.gradient(flat, &mut gradient);
        let mut stale = true;
        let mut holds = goal.holds;
        let mut held = false;
        for iterations in 0..goal.max_iterations {
            let zone = zone.as_deref_mut().filter(|_| holds == goal.holds);
            if zone.is_some_and(|zone| zone.settle(flat)) {
                value = energy.value(flat);
                energy.gradient(flat, &mut gradient);
                memory.keep(0);
            }
            let fresh = stale || memory.len() >= STEPS_PER_FACTOR;
            if fresh {
                self.renew(energy, flat)?;
                memory.keep(0);
            }
            let direction = memory.direction(&gradient, |nodes| apply(&self.inverse, nodes, energy.free));
            let slope = dot(&direction, &gradient);
            let settled = -slope <= (goal.tolerance * value.abs()).max(ENERGY_FLOOR);
            let exact = || goal.holds == 0 || energy.slack(flat) <= goal.exact;
            if settled && (holds == 0 || exact()) {
                return Ok(Relaxed { energy: value, iterations, converged: exact() });
            }
            // Forces are found from lengths, so every time they have changed the lengths must answer first.
            if settled && !std::mem::replace(&mut held, true) {
                // What is left of the way is short: one factor at its beginning serves to its end.
                stale = holds == goal.holds;
                holds -= 1;
                energy.hold(flat);
                value = energy.value(flat);
                energy.gradient(flat, &mut gradient);
                continue;
            }
            held = false;
            let Some((step, lower)) = self.step(energy, flat, &direction, slope, value) else {
                if fresh {
                    // The factor is that of this very place: rounding hides what is left to win.
                    return Ok(Relaxed { energy: value, iterations, converged: settled && exact() });
                }
                stale = true;
                continue;
            };
            stale = is_newton(energy) || step < SHORT;
            value = lower;
            advance(flat, &direction, step);
            let before = std::mem::replace(&mut gradient, vec![Vec2::zeros(); flat.len()]);
            energy.gradient(flat, &mut gradient);
            let change = gradient.iter().zip(&before).map(|(after, before)| after - before).collect();
            memory.remember(direction.iter().map(|d| d * step).collect(), change);
        }
        Ok(Relaxed { energy: value, iterations: goal.max_iterations, converged: false })
    }

    /// Takes the curvature anew.
    fn renew<const N: usize>(&mut self, energy: &mut FlatEnergy<N>, flat: &[Vec2]) -> Result<(), FlattenError> {
        if energy.note_pushes(flat) {
            self.inverse = Inverse::new(energy)?;
        }
        self.inverse.renew(energy, flat)
    }

    /// How far to go along a direction, and the energy there.
    fn step<const N: usize>(
        &self,
        energy: &FlatEnergy<N>,
        flat: &[Vec2],
        direction: &[Vec2],
        slope: f64,
        value: f64,
    ) -> Option<(f64, f64)> {
        let (step, lower) = search(energy, flat, direction, slope, value, &self.apart)?;
        Some(match is_newton(energy) {
            true => lengthened(energy, flat, direction, slope, [step, value, lower], &self.apart),
            false => (step, lower),
        })
    }
}

/// Whether every step has a factor of its own. Threads that turn bend the way of a weave, so that what earlier steps
/// tell leads astray. So a weave needs a fifth as many steps, and a third of the time.
fn is_newton<const N: usize>(energy: &FlatEnergy<N>) -> bool {
    energy.law.warp.is_some()
}

/// Goes along `direction` as far as the energy falls and nothing flips, if only so far as not at all.
pub(super) fn go(energy: &FlatEnergy, flat: &mut [Vec2], direction: &[Vec2]) {
    if let Some((step, _)) = search(energy, flat, direction, 0.0, energy.value(flat), &[]) {
        advance(flat, direction, step);
    }
}

/// Backtracks from the full step, or from just before the first flip, to a lower energy with the rims `apart`; the step
/// and that energy.
fn search<const N: usize>(
    energy: &FlatEnergy<N>,
    flat: &[Vec2],
    direction: &[Vec2],
    slope: f64,
    value: f64,
    apart: &[Vec<u32>],
) -> Option<(f64, f64)> {
    let mut step = (SHY_OF_FLIP * first_flip(energy, flat, direction)).min(1.0);
    let mut trial = vec![Vec2::zeros(); flat.len()];
    for _ in 0..HALVINGS {
        trial.copy_from_slice(flat);
        advance(&mut trial, direction, step);
        let lower = energy.value(&trial);
        if lower <= value + SUFFICIENT * step * slope && rim_crossings(&trial, apart) == 0 {
            return Some((step, lower));
        }
        step *= 0.5;
    }
    None
}

/// A step to a lower energy, doubled as long as the energy falls further; the step and that energy. Of a step, the
/// energy before it and after it.
fn lengthened<const N: usize>(
    energy: &FlatEnergy<N>,
    flat: &[Vec2],
    direction: &[Vec2],
    slope: f64,
    [mut step, value, mut lower]: [f64; 3],
    apart: &[Vec<u32>],
) -> (f64, f64) {
    if value - lower <= -WINS * step * slope {
        return (step, lower);
    }
    let most = SHY_OF_FLIP * first_flip(energy, flat, direction);
    let mut trial = vec![Vec2::zeros(); flat.len()];
    while 2.0 * step < most {
        trial.copy_from_slice(flat);
        advance(&mut trial, direction, 2.0 * step);
        let further = energy.value(&trial);
        if further >= lower || rim_crossings(&trial, apart) > 0 {
            break;
        }
        (step, lower) = (2.0 * step, further);
    }
    (step, lower)
}

/// The smallest positive step at which some triangle loses its area.
fn first_flip<const N: usize>(energy: &FlatEnergy<N>, flat: &[Vec2], direction: &[Vec2]) -> f64 {
    let mut first = f64::INFINITY;
    for e in energy.elements.iter() {
        let (at, by) = (e.jacobian(flat), e.jacobian(direction));
        // det J along the step: quadratic · s² + linear · s + constant.
        let linear = at.m11 * by.m22 + by.m11 * at.m22 - at.m12 * by.m21 - by.m12 * at.m21;
        first = first.min(smallest_positive_root(by.determinant(), linear, at.determinant()));
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

/// Applies the inverse of the curvature to the nodes that are free: what stays where it is has no row.
fn apply(inverse: &Inverse, nodes: &mut [Vec2], free: usize) {
    let mut flat: Vec<f64> = nodes.iter().flat_map(|v| [v.x, v.y]).collect();
    inverse.apply(&mut flat[..2 * free]);
    nodes.iter_mut().zip(flat.chunks_exact(2)).for_each(|(v, xy)| *v = Vec2::new(xy[0], xy[1]));
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
