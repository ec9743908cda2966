//! From sewn to at rest.

use std::sync::Arc;

use crate::contact::Collider;
use crate::dynamics::{Friction, StepError, World};
use crate::fabric::Fabric;
use crate::geometry::Vec3;
use crate::mesh::ClothMesh;
use crate::pattern::Garment;
use crate::sew::{Stitching, sewn_world};

/// How a garment is draped.
#[derive(Clone, Copy, Debug)]
pub struct DrapeOptions {
    /// Steps after which draping ends, at rest or not.
    pub max_steps: usize,
}

impl Default for DrapeOptions {
    fn default() -> Self {
        Self { max_steps: 400 }
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
#[allow(clippy::too_many_arguments)]
pub fn drape(
    garment: &Garment,
    mesh: &ClothMesh,
    fabrics: &[Arc<Fabric>],
    body: &Collider,
    stitching: &Stitching,
    nodes: Vec<Vec3>,
    options: &DrapeOptions,
    progress: &mut dyn FnMut(f64),
) -> Result<Draped, DrapeError> {
    let mut world = sewn_world(garment, mesh, fabrics, body, stitching, nodes)?;
    world.gravity = 1.0;
    world.friction = Some(Friction::new(world.x.len(), GRIP));
    let mut fall = Fall { last: world.x.clone(), world, steps: 0 };
    let mut falling = true; let mm: f64 = std::env::var("MOM").map_or(MOMENTUM, |s| s.parse().unwrap_or(0.9)); let dt: f64 = std::env::var("DT").map_or(STEP, |s| s.parse().unwrap_or(0.1));
    while falling && fall.steps < options.max_steps {
        let before = fall.world.x.clone();
        for k in 0..STRETCH {
            // The last quarter of a stretch goes without momentum, so that what is measured has died down.
            fall.step(dt, if k < STRETCH * 3 / 4 { mm } else { 0.0 })?;
        }
        let [rms, _] = motion(&before, &fall.world.x);
        trace(&mut fall.world, fall.steps, rms);
        progress((fall.steps as f64 / options.max_steps as f64).max(SETTLED / rms).min(0.9));
        falling = rms > SETTLED;
    }
    let before = fall.world.x.clone();
    let again = fall.steps;
    for _ in 0..(if std::env::var("NODRIFT").is_ok() { 0 } else { again }) {
        fall.step(0.5 * STEP, 0.0)?;
    }
    progress(1.0);
    let drift = motion(&before, &fall.world.x);
    let residual = fall.world.residual_in_weights();
    trace(&mut fall.world, fall.steps, drift[0]);
    let converged = drift[0] <= DRIFT && residual <= RESIDUAL;
    Ok(Draped {
        energy: fall.world.energy(),
        nodes: fall.world.x,
        steps: fall.steps,
        converged,
        drift,
        residual,
    })
}

fn trace(world: &mut World, steps: usize, rms: f64) {
    if std::env::var("TOILE_TRACE").is_ok() {
        eprintln!("drape {steps}: moved {:.3} mm rms, residual {:.2}, tangles {}, contacts {}", 1e3 * rms, world.residual_in_weights(), world.tangles().len(), world.contacts().len());
    }
}

/// A garment on its way down.
struct Fall<'a> {
    world: World<'a>,
    /// Positions before the last step.
    last: Vec<Vec3>,
    steps: usize,
}

impl Fall<'_> {
    fn step(&mut self, dt: f64, momentum: f64) -> Result<(), StepError> {
        let now = self.world.x.clone();
        self.world.relax(dt, momentum, LOOK_AHEAD, &self.last, &[])?;
        self.last = now;
        self.steps += 1;
        Ok(())
    }
}

/// Root mean square and largest distance between two states, metres.
fn motion(a: &[Vec3], b: &[Vec3]) -> [f64; 2] {
    let squares = || a.iter().zip(b).map(|(p, q)| (p - q).norm_squared());
    let mean = squares().sum::<f64>() / a.len().max(1) as f64;
    [mean.sqrt(), squares().fold(0.0, f64::max).sqrt()]
}
