//! The published alternation with one factor (L11): fix the directions of the edges, solve for the positions.
//!
//! With directions d_e fixed, Σ w ‖(v_b − v_a) − L_M d_e‖² takes the place of E_L. It is never below E_L and equal to
//! it where the d_e are the edges' own directions, so its minimum lies no higher: the alternation goes downhill.
//! Everything is quadratic with one constant scalar matrix for x, y and z, K = ω_R (recovery) + ω_S (graph Laplacian) +
//! ω_B AᵀA. As both functions have the same gradient at v, the minimum is v − K⁻¹ ½∇E(v). Of a cloth curved at rest K
//! leaves out that A_M turns with the cloth. The gradient has it, and the energy is checked after every step.
//!
//! Taken alone, that step creeps where K is much stiffer than the cloth. So it is taken from a point extrapolated from
//! the last two (Nesterov 1983, with the restart of O'Donoghue & Candès 2015): where that would raise the energy, the
//! plain step is taken instead and the momentum forgotten.

use std::sync::Arc;

use super::descent::{Clock, SolveOptions, SolverReport, SolverRun, factored, hold, largest_motion, timed};
use super::problem::RecoveryProblem;
use super::recovery::Recovery;
use super::{GeometricCloth, GeometricError};
use crate::geometry::Vec3;
use crate::linear::{Cholesky, SymmetricMatrix, SymmetricPattern};

/// The alternation, prepared for one cloth, its recovery term and one set of held vertices.
#[derive(Debug)]
pub struct Alternating<'a> {
    problem: RecoveryProblem<'a>,
    factor: Cholesky<f64>,
}

impl<'a> Alternating<'a> {
    /// Builds and factors K with the vertices `held` eliminated.
    ///
    /// # Errors
    /// [`GeometricError`] for a vertex that does not exist, a target that is not finite, or a cloth too large for its
    /// system.
    pub fn new(cloth: &'a GeometricCloth, held: &[u32], recovery: Recovery) -> Result<Self, GeometricError> {
        let problem = RecoveryProblem::new(cloth, held, recovery)?;
        let matrix = assemble(&problem)?;
        let mut factor = Cholesky::new(matrix.pattern().clone())?;
        factored(&mut factor, &matrix, 1)?;
        Ok(Self { problem, factor })
    }

    /// Goes downhill from `x`, in which the held vertices are where they are to stay.
    ///
    /// # Errors
    /// [`GeometricError`] for numbers of vertices that do not agree or positions that are not finite.
    pub fn solve(&self, x: &mut Vec<Vec3>, options: SolveOptions) -> Result<SolverReport, GeometricError> {
        let mut run = SolverRun::new(&self.problem, options, x)?;
        let mut clock = Clock::default();
        let mut before = x.clone();
        let mut momentum = Momentum::default();
        while run.goes_on() {
            let share = momentum.next();
            let mut from: Vec<Vec3> = x.iter().zip(&before).map(|(x, b)| x + (x - b) * share).collect();
            let mut to = self.step(&from, &mut clock);
            let mut total = self.problem.energy(&to);
            if total > run.last_energy() {
                momentum = Momentum::default();
                from.clone_from(x);
                to = self.step(&from, &mut clock);
                total = self.problem.energy(&to);
            }
            if total > run.last_energy() {
                run.exhausted();
                break;
            }
            run.record(total, largest_motion(x, &to), largest_motion(&from, &to));
            before = std::mem::replace(x, to);
        }
        Ok(run.report(x, &clock))
    }

    /// Positions of least energy for the edge directions at `x`.
    fn step(&self, x: &[Vec3], clock: &mut Clock) -> Vec<Vec3> {
        let problem = &self.problem;
        let gradient = timed(&mut clock.linearise, || problem.half_gradient(x, &problem.recovery));
        let step = timed(&mut clock.solve, || {
            let mut columns: Vec<f64> = (0..3).flat_map(|k| gradient.iter().map(move |g| g[k])).collect();
            self.factor.solve(&mut columns);
            columns
        });
        let n = x.len();
        (0..n).map(|i| x[i] - Vec3::new(step[i], step[n + i], step[2 * n + i])).collect()
    }
}

/// Nesterov's sequence of extrapolations, 0 at first and growing towards 1.
struct Momentum(f64);

impl Default for Momentum {
    fn default() -> Self {
        Self(1.0)
    }
}

impl Momentum {
    fn next(&mut self) -> f64 {
        let last = self.0;
        self.0 = 0.5 * (1.0 + (1.0 + 4.0 * last * last).sqrt());
        (last - 1.0) / self.0
    }
}

/// K, with the rows of held vertices as those of the identity.
fn assemble(problem: &RecoveryProblem) -> Result<SymmetricMatrix<f64>, GeometricError> {
    let (GeometricCloth { stencils, weights }, handles) = (problem.cloth, &problem.handles);
    let n = stencils.points.len();
    let mut entries = problem.recovery.entries(stencils, weights.recovery);
    for e in &stencils.edges {
        let ([a, b], w) = (e.ends, weights.stretch * e.weight);
        entries.extend([(a, a, w), (b, b, w), (a, b, -w)]);
    }
    entries.extend(stencils.bend_entries(weights.bend));
    let diagonal: f64 = entries.iter().filter(|e| e.0 == e.1).map(|e| e.2).sum();
    entries.retain(|e| !handles.holds(e.0) && !handles.holds(e.1));
    let held = hold(diagonal, n);
    entries.extend((0..n as u32).map(|i| (i, i, if handles.holds(i) { 1.0 } else { held })));
    let pattern = Arc::new(SymmetricPattern::scalar(n, entries.iter().map(|e| (e.0 as usize, e.1 as usize)))?);
    let mut matrix = SymmetricMatrix::zeros(pattern.clone());
    for (i, j, value) in entries {
        // Every entry is part of the pattern it was built from.
        if let Some(slot) = pattern.slot(i as usize, j as usize) {
            matrix.add(slot, value);
        }
    }
    Ok(matrix)
}
