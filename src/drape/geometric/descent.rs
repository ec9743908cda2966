//! Shared by both solvers: options, checks and the record of iterations.

use std::time::{Duration, Instant};

use super::GeometricError;
use super::energy::Energies;
use super::problem::RecoveryProblem;
use crate::geometry::Vec3;
use crate::linear::{Cholesky, NotPositiveDefinite, SymmetricMatrix};

/// Regularisation added to the diagonal of every system, as a share of its mean. A vertex that no term holds would make
/// the matrix singular: nothing resists a motion across a flat sheet that does not bend. The minimum does not change,
/// and steps get shorter by at most this share of the stiffest direction.
const HOLD: f64 = 1e-10;

/// When a solver stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolveOptions {
    /// Iterations after which it stops, converged or not.
    pub max_iterations: usize,
    /// Converged when an iteration would move no vertex further, metres.
    pub tolerance: f64,
}

impl Default for SolveOptions {
    /// A hundredth of a millimetre, finer than any measurement of a cloth.
    fn default() -> Self {
        Self { max_iterations: 2000, tolerance: 1e-5 }
    }
}

/// Outcome of a solver run.
#[derive(Clone, Debug, PartialEq)]
pub struct SolverReport {
    /// Iterations made.
    pub iterations: usize,
    /// Whether the tolerance was met, or no step lowers the energy any more in 64-bit numbers.
    pub converged: bool,
    /// The energy reached.
    pub energy: Energies,
    /// The total energy at the start and after every iteration. It never rises.
    pub history: Vec<f64>,
    /// Largest motion in the last iteration, metres.
    pub motion: f64,
    /// Seconds spent on gradients and matrices, all iterations together.
    pub linearise_seconds: f64,
    /// Seconds spent on factors and triangular solves, all iterations together.
    pub solve_seconds: f64,
}

/// One run of a solver.
pub(super) struct SolverRun<'a> {
    problem: &'a RecoveryProblem<'a>,
    options: SolveOptions,
    history: Vec<f64>,
    motion: f64,
    converged: bool,
}

/// Time by kind of work.
#[derive(Default)]
pub(super) struct Clock {
    pub(super) linearise: Duration,
    pub(super) solve: Duration,
}

impl<'a> SolverRun<'a> {
    pub(super) fn new(problem: &'a RecoveryProblem, options: SolveOptions, x: &[Vec3]) -> Result<Self, GeometricError> {
        problem.check_start(x)?;
        Ok(Self { problem, options, history: vec![problem.energy(x)], motion: f64::INFINITY, converged: false })
    }

    /// The energy at the last position that was taken.
    pub(super) fn last_energy(&self) -> f64 {
        self.history.last().copied().unwrap_or(f64::INFINITY)
    }

    /// Records an iteration that ended at energy `total` after a largest motion of `motion` metres. `left` is the
    /// length of the step that the solver proposed.
    pub(super) fn record(&mut self, total: f64, motion: f64, left: f64) {
        self.converged = motion.max(left) <= self.options.tolerance || total >= self.last_energy();
        self.history.push(total);
        self.motion = motion;
    }

    /// Ends the run where rounding hides any further descent.
    pub(super) fn exhausted(&mut self) {
        self.converged = true;
    }

    pub(super) fn goes_on(&self) -> bool {
        !self.converged && self.history.len() <= self.options.max_iterations
    }

    pub(super) fn report(self, x: &[Vec3], clock: &Clock) -> SolverReport {
        SolverReport {
            iterations: self.history.len() - 1,
            converged: self.converged,
            energy: self.problem.cloth.energy(x, &self.problem.recovery),
            motion: if self.motion.is_finite() { self.motion } else { 0.0 },
            history: self.history,
            linearise_seconds: clock.linearise.as_secs_f64(),
            solve_seconds: clock.solve.as_secs_f64(),
        }
    }
}

/// Runs `work` and adds its time to `total`.
pub(super) fn timed<T>(total: &mut Duration, work: impl FnOnce() -> T) -> T {
    let started = Instant::now();
    let out = work();
    *total += started.elapsed();
    out
}

/// Largest distance between two lists of positions.
pub(super) fn largest_motion(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm_squared()).fold(0.0, f64::max).sqrt()
}

/// The value that [`HOLD`] adds to a diagonal with this sum over `vertices`.
pub(super) fn hold(diagonal: f64, vertices: usize) -> f64 {
    HOLD * diagonal / vertices.max(1) as f64
}

/// Factors a system of `width` rows per vertex.
pub(super) fn factored(
    factor: &mut Cholesky<f64>,
    matrix: &SymmetricMatrix<f64>,
    width: usize,
) -> Result<(), GeometricError> {
    factor.factor(matrix).map_err(|NotPositiveDefinite { dof }| GeometricError::Singular(dof / width))
}
