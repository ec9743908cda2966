//! The published solver (steps 1–3 of section 3.3): linearise every length, solve (AᵀA) X = Aᵀb, repeat.
//!
//! That is Gauss–Newton: an edge of direction d adds ω_S d dᵀ to the normal matrix, the other two terms are linear as
//! they stand. (Of a cloth curved at rest A_M is kept where it is in the matrix; its turning is in the gradient only.)
//! The pattern is analysed once and factored anew in every iteration.
//!
//! Two additions are ours. Neither moves the minimum.
//! - An edge longer than at rest also adds the geometric stiffness of its tension, ω_S (1 − L_M/L_T)(1 − d dᵀ).
//!   Gauss–Newton omits it, and then leaps to and fro where nothing else holds a sheet across its plane. The negative
//!   term of shortened edges stays omitted, so that the matrix is positive definite.
//! - Steps in wrinkled cloth are too short because of that. So each step is doubled or halved while that lowers the
//!   energy.

use std::sync::Arc;

use super::bend::direction;
use super::descent::{Clock, SolveOptions, SolverReport, SolverRun, factored, hold, largest_motion, timed};
use super::handles::Handles;
use super::problem::RecoveryProblem;
use super::recovery::Recovery;
use super::stencils::LengthStencil;
use super::{GeometricCloth, GeometricError};
use crate::geometry::{Mat3, Vec3};
use crate::linear::{BlockSlot, Cholesky, SymmetricMatrix, SymmetricPattern};

/// Most halvings of a step. A shorter step is below rounding.
const HALVINGS: usize = 40;
/// Most doublings of a step. The paper's experiments need three. Without a bound, a cloth that nothing holds would fall
/// without end.
const DOUBLINGS: usize = 4;

/// Gauss–Newton, prepared for one cloth, its recovery term and one set of held vertices.
#[derive(Debug)]
pub struct LeastSquares<'a> {
    problem: RecoveryProblem<'a>,
    system: System,
}

/// The normal matrix and its factor.
#[derive(Debug)]
struct System {
    /// Recovery, bend and held rows: the part that does not change.
    constant: SymmetricMatrix<f64>,
    /// Places of every edge whose ends are not both held.
    edges: Vec<EdgeBlock>,
    matrix: SymmetricMatrix<f64>,
    factor: Cholesky<f64>,
}

/// The part of an edge's second derivative that a step uses.
#[derive(Clone, Copy, PartialEq)]
enum Linearised {
    /// ω_S d dᵀ alone, as the paper has it.
    Along,
    /// With the geometric stiffness of stretched edges across their direction.
    WithTension,
}

/// Place of an edge's block. A held end has none.
#[derive(Debug)]
struct EdgeBlock {
    edge: LengthStencil,
    diagonal: [Option<BlockSlot>; 2],
    between: Option<BlockSlot>,
}

impl<'a> LeastSquares<'a> {
    /// Builds and analyses the normal matrix with the vertices `held` eliminated.
    ///
    /// # Errors
    /// As [`super::Alternating::new`].
    pub fn new(cloth: &'a GeometricCloth, held: &[u32], recovery: Recovery) -> Result<Self, GeometricError> {
        let problem = RecoveryProblem::new(cloth, held, recovery)?;
        let system = System::new(&problem)?;
        Ok(Self { problem, system })
    }

    /// Goes downhill from `x`, in which the held vertices are where they are to stay.
    ///
    /// # Errors
    /// As [`super::Alternating::solve`]. [`GeometricError::Singular`] when a matrix has no factor.
    pub fn solve(&mut self, x: &mut Vec<Vec3>, options: SolveOptions) -> Result<SolverReport, GeometricError> {
        let problem = &self.problem;
        let mut run = SolverRun::new(problem, options, x)?;
        let mut clock = Clock::default();
        while run.goes_on() {
            let step = self.system.step(problem, x, &problem.recovery, Linearised::WithTension, &mut clock)?;
            let longest = step.iter().map(Vec3::norm_squared).fold(0.0, f64::max).sqrt();
            let Some((to, total)) = downhill(x, &step, problem, run.last_energy()) else {
                run.exhausted();
                break;
            };
            run.record(total, largest_motion(x, &to), longest);
            *x = to;
        }
        Ok(run.report(x, &clock))
    }

    /// The paper's own loop: the targets of the controls move in `increments` equal parts from where their points are
    /// in `x` to where they are to be, and each part is followed by one full Gauss–Newton step. It uses no tension and
    /// no search along the step, and ends when the drag ends, wherever the energy then is.
    ///
    /// # Errors
    /// As [`LeastSquares::solve`].
    pub fn drag(&mut self, x: &mut [Vec3], increments: usize) -> Result<(), GeometricError> {
        self.problem.check_start(x)?;
        let start = x.to_vec();
        for k in 1..=increments {
            let recovery = self.problem.recovery.part_way(&start, k as f64 / increments as f64);
            let step = self.system.step(&self.problem, x, &recovery, Linearised::Along, &mut Clock::default())?;
            x.iter_mut().zip(&step).for_each(|(x, d)| *x += d);
        }
        Ok(())
    }
}

impl System {
    fn new(problem: &RecoveryProblem) -> Result<Self, GeometricError> {
        let pattern = pattern(problem)?;
        let constant = constant(problem, &pattern);
        let edges = problem.cloth.stencils.edges.iter();
        let edges = edges.map(|e| EdgeBlock::new(e, &problem.handles, &pattern)).collect();
        Ok(Self { matrix: constant.clone(), constant, edges, factor: Cholesky::new(pattern)? })
    }

    /// The full Gauss–Newton step at `x`.
    fn step(
        &mut self,
        problem: &RecoveryProblem,
        x: &[Vec3],
        recovery: &Recovery,
        linearised: Linearised,
        clock: &mut Clock,
    ) -> Result<Vec<Vec3>, GeometricError> {
        let mut rows = timed(&mut clock.linearise, || {
            self.linearise(x, problem.cloth.weights.stretch, linearised);
            let gradient = problem.half_gradient(x, recovery);
            gradient.iter().flat_map(|g| [-g.x, -g.y, -g.z]).collect::<Vec<f64>>()
        });
        timed(&mut clock.solve, || {
            factored(&mut self.factor, &self.matrix, 3)?;
            self.factor.solve(&mut rows);
            Ok::<(), GeometricError>(())
        })?;
        Ok(rows.chunks_exact(3).map(Vec3::from_column_slice).collect())
    }

    fn linearise(&mut self, x: &[Vec3], stretch: f64, linearised: Linearised) {
        self.matrix.clone_from(&self.constant);
        for place in &self.edges {
            let [a, b] = place.edge.ends.map(|v| x[v as usize]);
            let (direction, length) = direction(b - a);
            let mut block = direction * direction.transpose();
            if linearised == Linearised::WithTension {
                let tension = (1.0 - place.edge.rest / length).max(0.0);
                block += (Mat3::identity() - block) * tension;
            }
            block *= stretch * place.edge.weight;
            for slot in place.diagonal.into_iter().flatten() {
                self.matrix.add_block(slot, &block);
            }
            if let Some(slot) = place.between {
                self.matrix.add_block(slot, &(-block));
            }
        }
    }
}

impl EdgeBlock {
    fn new(edge: &LengthStencil, handles: &Handles, pattern: &SymmetricPattern) -> Self {
        let free = edge.ends.map(|v| !handles.holds(v));
        let [a, b] = edge.ends.map(|v| v as usize);
        let slot = |wanted: bool, i, j| if wanted { pattern.block_slot(i, j) } else { None };
        Self {
            edge: *edge,
            diagonal: [slot(free[0], a, a), slot(free[1], b, b)],
            between: slot(free[0] && free[1], a, b),
        }
    }
}

/// The step, doubled or halved for as long as that lowers the energy. None if all of them raise it over `last`.
fn downhill(x: &[Vec3], step: &[Vec3], problem: &RecoveryProblem, last: f64) -> Option<(Vec<Vec3>, f64)> {
    let at = |share: f64| {
        let to: Vec<Vec3> = x.iter().zip(step).map(|(x, d)| x + d * share).collect();
        let total = problem.energy(&to);
        (to, total)
    };
    let falls = |(_, total): &(Vec<Vec3>, f64)| *total <= last;
    let mut best = at(1.0);
    let mut share = 1.0;
    while falls(&best) && share < f64::from(1 << DOUBLINGS) {
        let next = at(2.0 * share);
        if next.1 < best.1 { (share, best) = (2.0 * share, next) } else { break }
    }
    if share > 1.0 {
        return Some(best);
    }
    for _ in 0..HALVINGS {
        share *= 0.5;
        let next = at(share);
        if falls(&best) && next.1 >= best.1 {
            break;
        }
        best = next;
    }
    falls(&best).then_some(best)
}

fn pattern(problem: &RecoveryProblem) -> Result<Arc<SymmetricPattern>, GeometricError> {
    let stencils = &problem.cloth.stencils;
    let pair = |a: u32, b: u32| (a as usize, b as usize);
    let edges = stencils.edges.iter().map(|e| pair(e.ends[0], e.ends[1]));
    // The other five pairs of a hinge are edges.
    let hinges = stencils.hinges.iter().map(|h| pair(h.nodes[2], h.nodes[3]));
    let controls = problem.recovery.entries(stencils, 1.0).into_iter().map(|(a, b, _)| pair(a, b));
    Ok(Arc::new(SymmetricPattern::blocks(stencils.points.len(), edges.chain(hinges).chain(controls))?))
}

fn constant(problem: &RecoveryProblem, pattern: &Arc<SymmetricPattern>) -> SymmetricMatrix<f64> {
    let GeometricCloth { stencils, weights } = problem.cloth;
    let mut entries = problem.recovery.entries(stencils, weights.recovery);
    entries.extend(stencils.bend_entries(weights.bend));
    let of_edges = stencils.edges.iter().map(|e| 2.0 * weights.stretch * e.weight).sum::<f64>();
    let diagonal = of_edges + entries.iter().filter(|e| e.0 == e.1).map(|e| e.2).sum::<f64>();
    let mut matrix = SymmetricMatrix::zeros(pattern.clone());
    let mut add = |i: u32, j: u32, value: f64| {
        if let Some(slot) = pattern.block_slot(i as usize, j as usize) {
            matrix.add_block(slot, &(Mat3::identity() * value));
        }
    };
    let held = |v: u32| problem.handles.holds(v);
    for (i, j, value) in entries.into_iter().filter(|e| !held(e.0) && !held(e.1)) {
        add(i, j, value);
    }
    let hold = hold(diagonal, stencils.points.len());
    for v in 0..stencils.points.len() as u32 {
        add(v, v, if held(v) { 1.0 } else { hold });
    }
    matrix
}
