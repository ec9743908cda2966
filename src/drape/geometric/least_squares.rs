//! The published solver (steps 1–3 of section 3.3): linearise every length, solve (AᵀA) X = Aᵀb, repeat.
//!
//! That is Gauss–Newton: an edge of direction d adds ω_S d dᵀ to the normal matrix, the other two terms are linear as
//! they stand. The pattern is analysed once and factored anew in every iteration.
//!
//! Two things are ours, and neither moves the minimum. An edge longer than at rest also adds what its tension resists
//! across d, ω_S (1 − L_M/L_T)(1 − d dᵀ): Gauss–Newton leaves that out, and where nothing else holds a sheet across its
//! plane it leaps to and fro. What a shortened edge takes away is left out still, so that the matrix has a factor;
//! steps in wrinkled cloth are too short for it. So each is doubled or halved for as long as that lowers the energy.

use std::sync::Arc;

use super::descent::{Clock, Report, Run, SolveOptions, factored, hold, largest_motion, timed};
use super::energy::{Aim, direction};
use super::handles::Handles;
use super::stencils::{Length, Stencils};
use super::{GeometricCloth, GeometricError, Weights};
use crate::geometry::{Mat3, Vec3};
use crate::linear::{BlockSlot, Cholesky, SymmetricMatrix, SymmetricPattern};

/// A step is halved no more often: what is left is rounding.
const HALVINGS: usize = 40;
/// A step is doubled no more often: the papers' experiments ask for three, and a cloth that nothing holds falls without
/// end.
const DOUBLINGS: usize = 4;

/// Gauss–Newton, prepared for one cloth and one set of held vertices.
#[derive(Debug)]
pub struct LeastSquares<'a> {
    cloth: &'a GeometricCloth,
    handles: Handles,
    /// Recovery, bend and held rows: what does not change.
    constant: SymmetricMatrix<f64>,
    /// Places of every edge whose ends are not both held.
    edges: Vec<Place>,
    factor: Cholesky<f64>,
}

/// Where an edge's block goes; a held end has no place.
#[derive(Debug)]
struct Place {
    edge: Length,
    diagonal: [Option<BlockSlot>; 2],
    between: Option<BlockSlot>,
}

impl<'a> LeastSquares<'a> {
    /// Builds and analyses the normal matrix with the vertices `held` eliminated.
    ///
    /// # Errors
    /// As [`super::Alternating::new`].
    pub fn new(cloth: &'a GeometricCloth, held: &[u32]) -> Result<Self, GeometricError> {
        let handles = Handles::new(cloth.vertices(), held)?;
        let pattern = pattern(&cloth.stencils)?;
        let constant = constant(&cloth.stencils, &cloth.weights, &handles, &pattern);
        let edges = cloth.stencils.edges.iter().map(|e| Place::new(e, &handles, &pattern)).collect();
        let factor = Cholesky::new(pattern)?;
        Ok(Self { cloth, handles, constant, edges, factor })
    }

    /// Goes downhill from `x`, in which the held vertices are where they are to stay.
    ///
    /// # Errors
    /// As [`super::Alternating::solve`]; [`GeometricError::Singular`] when a matrix has no factor.
    pub fn solve(&mut self, x: &mut Vec<Vec3>, aim: &Aim, options: SolveOptions) -> Result<Report, GeometricError> {
        let handles = self.handles.clone();
        let mut run = Run::new(self.cloth, &handles, aim, options, x)?;
        let mut matrix = self.constant.clone();
        let mut clock = Clock::default();
        while run.goes_on() {
            let step = self.step(x, &run, &mut matrix, &mut clock)?;
            let longest = step.iter().map(Vec3::norm_squared).fold(0.0, f64::max).sqrt();
            let Some((to, total)) = downhill(x, &step, &run) else {
                run.exhausted();
                break;
            };
            run.record(total, largest_motion(x, &to), longest);
            *x = to;
        }
        Ok(run.report(x, &clock))
    }

    /// The full Gauss–Newton step at `x`.
    fn step(
        &mut self,
        x: &[Vec3],
        run: &Run,
        matrix: &mut SymmetricMatrix<f64>,
        clock: &mut Clock,
    ) -> Result<Vec<Vec3>, GeometricError> {
        let mut rows = timed(&mut clock.linearise, || {
            self.linearise(x, matrix);
            run.half_gradient(x).iter().flat_map(|g| [-g.x, -g.y, -g.z]).collect::<Vec<f64>>()
        });
        timed(&mut clock.solve, || {
            factored(&mut self.factor, matrix, 3)?;
            self.factor.solve(&mut rows);
            Ok::<(), GeometricError>(())
        })?;
        Ok(rows.chunks_exact(3).map(Vec3::from_column_slice).collect())
    }

    fn linearise(&self, x: &[Vec3], matrix: &mut SymmetricMatrix<f64>) {
        matrix.clone_from(&self.constant);
        for place in &self.edges {
            let [a, b] = place.edge.ends.map(|v| x[v as usize]);
            let (direction, length) = direction(b - a);
            let along = direction * direction.transpose();
            let tension = (1.0 - place.edge.rest / length).max(0.0);
            let block =
                (along + (Mat3::identity() - along) * tension) * (self.cloth.weights.stretch * place.edge.weight);
            for slot in place.diagonal.into_iter().flatten() {
                matrix.add_block(slot, &block);
            }
            if let Some(slot) = place.between {
                matrix.add_block(slot, &(-block));
            }
        }
    }
}

impl Place {
    fn new(edge: &Length, handles: &Handles, pattern: &SymmetricPattern) -> Self {
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

/// The step, doubled or halved for as long as that lowers the energy; none if all of them raise it.
fn downhill(x: &[Vec3], step: &[Vec3], run: &Run) -> Option<(Vec<Vec3>, f64)> {
    let at = |share: f64| {
        let to: Vec<Vec3> = x.iter().zip(step).map(|(x, d)| x + d * share).collect();
        let total = run.energy(&to);
        (to, total)
    };
    let falls = |(_, total): &(Vec<Vec3>, f64)| *total <= run.last_energy();
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

fn pattern(stencils: &Stencils) -> Result<Arc<SymmetricPattern>, GeometricError> {
    let pair = |a: u32, b: u32| (a as usize, b as usize);
    let edges = stencils.edges.iter().map(|e| pair(e.ends[0], e.ends[1]));
    // The other five pairs of a hinge are edges.
    let hinges = stencils.hinges.iter().map(|h| pair(h.nodes[2], h.nodes[3]));
    Ok(Arc::new(SymmetricPattern::blocks(stencils.points.len(), edges.chain(hinges))?))
}

fn constant(
    stencils: &Stencils,
    weights: &Weights,
    handles: &Handles,
    pattern: &Arc<SymmetricPattern>,
) -> SymmetricMatrix<f64> {
    let mut matrix = SymmetricMatrix::zeros(pattern.clone());
    let mut add = |i: u32, j: u32, value: f64| {
        if let Some(slot) = pattern.block_slot(i as usize, j as usize) {
            matrix.add_block(slot, &(Mat3::identity() * value));
        }
    };
    let free = |v: u32| !handles.holds(v);
    let mut diagonal = 0.0;
    for h in &stencils.hinges {
        for i in 0..4 {
            let own = weights.bend * h.weight * h.coefficients[i];
            diagonal += own * h.coefficients[i];
            for j in i..4 {
                if free(h.nodes[i]) && free(h.nodes[j]) {
                    add(h.nodes[i], h.nodes[j], own * h.coefficients[j]);
                }
            }
        }
    }
    diagonal += stencils.edges.iter().map(|e| 2.0 * weights.stretch * e.weight).sum::<f64>();
    diagonal += stencils.points.iter().map(|p| weights.recovery * p).sum::<f64>();
    let held = hold(diagonal, stencils.points.len());
    for (v, p) in (0u32..).zip(&stencils.points) {
        add(v, v, if free(v) { weights.recovery * p + held } else { 1.0 });
    }
    matrix
}
