//! From sewn to at rest.

use crate::contact::Collider;
use crate::dynamics::{Cut, Friction, StepError, World};
use crate::geometry::Vec3;
use crate::sew::{Stitching, sewn_world};

/// How a garment is draped.
#[derive(Clone, Copy, Debug)]
pub struct DrapeOptions {
    /// Steps after which draping ends, at rest or not.
    pub max_steps: usize,
}

impl Default for DrapeOptions {
    fn default() -> Self {
        Self { max_steps: 300 }
    }
}

/// Why draping stopped.
#[derive(Debug, thiserror::Error)]
pub enum DrapeError {
    /// A step could not be made.
    #[error("draping stopped: {0}")]
    Step(#[from] StepError),
}

/// A garment at rest.
#[derive(Clone, Debug)]
pub struct Draped {
    /// Position of every class of [`Stitching`].
    pub nodes: Vec<Vec3>,
    /// Steps made.
    pub steps: usize,
    /// Whether it is at rest: unbalanced force within a particle's weight, drift within bounds.
    pub converged: bool,
    /// Elastic, contact and gravity energy, J.
    pub energy: f64,
    /// Root mean square and largest motion, metres, over as many steps again at half the step size.
    pub drift: [f64; 2],
    /// Root mean square of the unbalanced force over a particle's weight.
    pub residual: f64,
}

/// Step length, s: long, for inertia only delays rest; the step is a Newton step on the energy.
const STEP: f64 = 0.1;
/// Share of the last motion by which a step looks ahead, and the most it does so, metres.
const MOMENTUM: f64 = 0.85;
const LOOK_AHEAD: f64 = 4e-3;
/// Tangential stiffness of the grip on the body, N/m: a particle's weight (1 mN at most) moves its anchor microns.
const GRIP: f64 = 300.0;
/// Steps between two looks at how far the garment still moves.
const STRETCH: usize = 20;
/// A garment has settled when it moves less than this, metres RMS, in so many steps.
const SETTLED: f64 = 0.15e-3;
/// At rest: drift (RMS) over as many steps again, metres, and residual force in particle weights.
const DRIFT: f64 = 0.3e-3;
const RESIDUAL: f64 = 1.0;

/// Drapes a sewn garment.
///
/// Rest is not low speed: after the last motion has died down, as many steps again at half the step size are made, and
/// what they move is reported as drift.
///
/// # Errors
/// [`DrapeError::Step`] when a position is not finite.
pub fn drape(
    cut: &Cut,
    body: &Collider,
    stitching: &Stitching,
    nodes: Vec<Vec3>,
    options: &DrapeOptions,
    progress: &mut dyn FnMut(f64),
) -> Result<Draped, DrapeError> {
    let mut world = sewn_world(cut, body, stitching, nodes)?;
    world.gravity = 1.0;
    world.friction = Some(Friction::new(world.x.len(), GRIP));
    let mut fall = Fall { last: world.x.clone(), world, steps: 0 };
    let mut tested = 0;
    let mut drift;
    loop {
        fall.settle(options.max_steps, progress)?;
        // As many steps again, at half the step size; a garment that drifts falls on, while there are steps left.
        let before = fall.world.x.clone();
        for _ in tested..fall.steps {
            fall.world.relax(0.5 * STEP, 0.0, LOOK_AHEAD, &before, &[])?;
        }
        drift = motion(&before, &fall.world.x);
        tested = fall.steps;
        if drift[0] <= DRIFT || fall.steps >= options.max_steps {
            break;
        }
        fall.last.clone_from(&fall.world.x);
    }
    progress(1.0);
    let residual = fall.world.residual_in_weights();
    let converged = drift[0] <= DRIFT && residual <= RESIDUAL;
    Ok(Draped { energy: fall.world.energy(), nodes: fall.world.x, steps: fall.steps, converged, drift, residual })
}

/// A garment on its way down.
struct Fall<'a> {
    world: World<'a>,
    /// Positions before the last step.
    last: Vec<Vec3>,
    steps: usize,
}

impl Fall<'_> {
    /// Steps until a stretch of them moves the garment hardly at all, or `most` are made in all.
    fn settle(&mut self, most: usize, progress: &mut dyn FnMut(f64)) -> Result<(), StepError> {
        let mut moved = f64::INFINITY;
        while moved > SETTLED && self.steps < most {
            let before = self.world.x.clone();
            for k in 0..STRETCH {
                // The last quarter of a stretch goes without momentum, so that what is measured has died down.
                let momentum = if k < STRETCH * 3 / 4 { MOMENTUM } else { 0.0 };
                let now = self.world.x.clone();
                self.world.relax(STEP, momentum, LOOK_AHEAD, &self.last, &[])?;
                self.last = now;
                self.steps += 1;
            }
            [moved, _] = motion(&before, &self.world.x);
            progress((self.steps as f64 / most as f64).max(SETTLED / moved).min(0.9));
        }
        Ok(())
    }
}

/// Root mean square and largest distance between two states, metres.
fn motion(a: &[Vec3], b: &[Vec3]) -> [f64; 2] {
    let squares = || a.iter().zip(b).map(|(p, q)| (p - q).norm_squared());
    let mean = squares().sum::<f64>() / a.len().max(1) as f64;
    [mean.sqrt(), squares().fold(0.0, f64::max).sqrt()]
}
