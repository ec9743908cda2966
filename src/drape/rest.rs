//! From sewn to at rest.

use crate::contact::Collider;
use crate::dynamics::{ContactTime, Cut, GRIP, Reach, StepError, World};
use crate::fabric::GRAVITY;
use crate::geometry::Vec3;
use crate::sew::{NEAREST_LOOK, Stitching, drape_reach, lead_off, sewn_world};

/// How a garment is draped.
#[derive(Clone, Copy, Debug)]
pub struct DrapeOptions {
    /// Steps after which draping ends, at rest or not.
    pub max_steps: usize,
    /// How far it is taken.
    pub until: Until,
    /// Whether it begins near its rest already, as coarser cloth has come to hang.
    pub near: bool,
}

/// How far a garment is draped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// Until it rests, tested by as many steps again.
    Rest,
    /// Until only long waves are left, which finer cloth has to go through anyway: a start for it.
    Near,
}

impl Default for DrapeOptions {
    fn default() -> Self {
        Self { max_steps: 800, until: Until::Rest, near: false }
    }
}

/// Why draping stopped.
#[derive(Debug, thiserror::Error)]
pub enum DrapeError {
    /// A step could not be made.
    #[error("draping stopped: {0}")]
    Step(#[from] StepError),
    /// Its forces drive the garment apart: what it has come to is no shape of cloth.
    #[error(
        "draping diverged: the energy of the garment rose from {from:.2} J to {to:.2} J, and {force:.0} N are out of \
         balance at one particle of '{piece}'"
    )]
    Diverged {
        /// The piece with the largest unbalanced force.
        piece: String,
        /// Energy of the sewn garment, J.
        from: f64,
        /// Energy it came to, by the same law of contact, J.
        to: f64,
        /// Largest unbalanced force, N.
        force: f64,
    },
}

/// A garment at rest.
#[derive(Clone, Debug)]
pub struct Draped {
    /// Position of every class of [`Stitching`].
    pub nodes: Vec<Vec3>,
    /// Steps made.
    pub steps: usize,
    /// Steps that tests of its rest made besides, no more than twice those that were allowed.
    pub tested: usize,
    /// Whether it is at rest: unbalanced force within a particle's weight, drift within bounds.
    pub converged: bool,
    /// Elastic, contact and gravity energy, J.
    pub energy: f64,
    /// Root mean square and largest motion, metres, over as many steps again at half the step size.
    pub drift: [f64; 2],
    /// Root mean square of the unbalanced force over a particle's weight.
    pub residual: f64,
    /// What contact cost of the time it took.
    pub contact: ContactTime,
}

/// Step length near rest, s. A garment hangs like a pendulum of a second or two; in shorter steps inertia would hide
/// how far it still has to go.
const STEP: f64 = 1.0;
/// Steps between two looks at how far the garment still moves.
const STRETCH: usize = 5;
/// A garment that falls no further than this, metres RMS, in so many steps is near its rest: what is left are long
/// waves, which need the true stiffness. With that from the first, a cuff that was sewn folded under stays so.
const NEAR_REST: f64 = 1.5e-3;
/// Steps after which it is taken to be near.
const LONGEST_FALL: usize = 80;
/// A garment has settled when it moves less than this, metres RMS, in so many steps.
const SETTLED: f64 = 0.12e-3;
/// How far a Newton step is trusted to change an edge: at first, at least and at most, in grid spacings. Springs that
/// are turned further are drawn out by more than the next step takes back.
const TRUST: [f64; 3] = [0.125, 0.01, 0.2];
/// At rest a garment drifts by no more than this over as many steps again, metres (RMS),
pub const DRIFT: f64 = 0.3e-3;
/// and its forces are out of balance by no more than so many particle weights (RMS).
pub const RESIDUAL: f64 = 1.0;
/// Steps so short that as many as are left move the garment by no more than this share of what it may go need not be
/// made, once so many in a row were: a single short one may be one that could not be made longer.
const STILL: f64 = 1.0 / 3.0;
const IN_A_ROW: usize = 3;
/// Where a stretch moved less than this share of the nodes, these go on alone.
const PART: f64 = 0.5;
/// A node has moved that went further than this, metres, and than this share of the way of the one that went furthest:
/// what creeps as a whole while a fold in it runs is left for later.
const MOVES: f64 = 0.1e-3;
const SHARE: f64 = 0.05;
/// With them go those that so many edges lead to from them, until all of them move the garment by less than this share
/// of what one does that has settled, for at most so many stretches.
const RINGS: usize = 3;
const CALMER: f64 = 0.5;
const STRETCHES: usize = 20;
/// While there are steps left a test that says nothing after so many, twice as many the next time, is given up: steps
/// of all the nodes take away what is left more slowly than those of the nodes that move.
const SHORT_TEST: usize = 12;
/// Tests of rest take no more than this many times the steps that draping may: one test as long as the longest fall,
/// and as much for those before it. A garment that creeps fails one after the other, the later the slower it creeps.
const TESTS: usize = 2;
/// A garment whose nodes went so far in one stretch is looked at this many times as far around in the next: further
/// finds more than pays, less needs too many looks (one is due when a node has gone a third of that).
const LOOK: f64 = 2.0;

/// One that falls freely (fewer contacts are known than it has nodes) is looked at as far around as it falls in a
/// stretch (RMS), up to this many cells: in large cells a look costs less than the steps it saves. Layers that lie on
/// one another would find each other many times over.
const CELLS: f64 = 0.4;

/// A drape goes down: a garment that ends by more above how it was sewn than it would gain by being lifted so far,
/// metres, has been driven apart.
const LIFTED: f64 = 1.0;

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
    world.grip(GRIP);
    let thick = world.cloth.thickest();
    let spacing = cut.mesh.spacing;
    let look = [thick + NEAREST_LOOK, drape_reach(spacing, thick)];
    let near = options.near;
    let (last, trust) = (world.x.clone(), TRUST[0] * spacing);
    let hardens = options.until == Until::Rest;
    let mut fall = Fall { last, world, steps: 0, tested: 0, near, hardens, trust, look, spacing };
    let (drift, residual, converged) = match options.until {
        Until::Rest => fall.come_to_rest(options.max_steps, progress)?,
        Until::Near => {
            fall.settle(options.max_steps, NEAR_REST, progress)?;
            ([f64::INFINITY; 2], fall.world.residual_in_weights(), false)
        }
    };
    progress(1.0);
    let Fall { world, steps, tested, .. } = fall;
    let (energy, contact) = (world.energy(), world.contact_time());
    Ok(Draped { energy, nodes: world.x, steps, tested, converged, drift, residual, contact })
}

/// Whether a garment that was sewn at `sewn` (positions as in [`Draped::nodes`]) and did not come to rest has at least
/// fallen.
///
/// # Errors
/// [`DrapeError::Diverged`] when its energy has risen instead, [`DrapeError::Step`] as [`drape`].
pub fn check_fall(
    cut: &Cut,
    body: &Collider,
    stitching: &Stitching,
    sewn: Vec<Vec3>,
    draped: &Draped,
) -> Result<(), DrapeError> {
    if draped.converged {
        return Ok(());
    }
    let mut world = sewn_world(cut, body, stitching, sewn)?;
    world.gravity = 1.0;
    let from = world.energy();
    world.x.clone_from(&draped.nodes);
    // By the same law of contact: where limbs leave cloth less room than it is thick, what hardens stores joules.
    world.displaced()?;
    let to = world.energy();
    let mass: f64 = world.cloth.mass.iter().sum();
    if to <= from + mass * GRAVITY * LIFTED {
        return Ok(());
    }
    let forces = world.unbalanced();
    let size = |particle: usize| forces[world.cloth.node_of[particle] as usize].norm();
    let largest = (0..world.cloth.node_of.len()).max_by(|&a, &b| size(a).total_cmp(&size(b))).unwrap_or_default();
    let piece = cut.mesh.piece_of(largest as u32).map(|piece| cut.garment.pieces[piece].name.clone());
    Err(DrapeError::Diverged { piece: piece.unwrap_or_default(), from, to, force: size(largest) })
}

/// A garment on its way down.
struct Fall<'a> {
    world: World<'a>,
    /// Positions before the last step.
    last: Vec<Vec3>,
    steps: usize,
    /// Steps of tests.
    tested: usize,
    /// Whether it is near its rest, and stays so.
    near: bool,
    /// Whether its contacts are still to harden there.
    hardens: bool,
    /// How far a Newton step is trusted, metres.
    trust: f64,
    /// How far around the cloth is looked at, at least and at most, metres.
    look: [f64; 2],
    /// Of the grid, metres.
    spacing: f64,
}

impl Fall<'_> {
    /// Steps until the garment rests, or `most` are made, or [`TESTS`] times as many for tests. Returns its drift, its
    /// residual force, and whether it rests.
    fn come_to_rest(&mut self, most: usize, progress: &mut dyn FnMut(f64)) -> Result<([f64; 2], f64, bool), StepError> {
        let mut patience = SHORT_TEST;
        loop {
            self.settle(most, SETTLED, progress)?;
            let out_of_steps = self.steps >= most;
            // A garment that is out of balance, or drifts, falls on, while there are steps left.
            if self.world.residual_in_weights() > RESIDUAL && !out_of_steps {
                continue;
            }
            let longest = if out_of_steps { TESTS * most } else { (self.tested + patience).min(TESTS * most) };
            patience *= 2;
            let drift = self.drift(longest)?;
            let residual = self.world.residual_in_weights();
            let rests = drift[0] <= DRIFT && residual <= RESIDUAL;
            if rests || out_of_steps || self.tested >= TESTS * most {
                return Ok((drift, residual, rests));
            }
        }
    }

    /// Steps until a stretch of them moves the garment less than `settled` metres RMS, or `most` are made in all.
    fn settle(&mut self, most: usize, settled: f64, progress: &mut dyn FnMut(f64)) -> Result<(), StepError> {
        let mut is_settled = false;
        while !is_settled && self.steps < most {
            let before = self.world.x.clone();
            let is_still = self.stretch(settled, most)?;
            let [moved, most_moved] = motion(&before, &self.world.x);
            is_settled = is_still || moved <= settled;
            self.world.look_within(self.reach(moved, most_moved))?;
            self.near |= moved < NEAR_REST || self.steps >= LONGEST_FALL;
            // Not before: what was pressed hard while it was sewn would be thrown off, or held by its friction, and
            // what the body cuts has to come out, and is led off it.
            if self.hardens && self.near {
                if self.world.is_cut() {
                    lead_off(&mut self.world)?;
                } else {
                    self.world.harden();
                    self.hardens = false;
                }
            }
            if self.near && !self.hardens && !is_settled {
                self.settle_moving(before, settled, most)?;
            }
            progress((self.steps as f64 / most as f64).max(settled / moved).min(0.9));
        }
        Ok(())
    }

    /// A stretch of steps. Returns whether it ended early: where the garment is so still that a whole stretch of such
    /// steps would hardly be a share of `settled` metres. No more than `most` are made in all.
    fn stretch(&mut self, settled: f64, most: usize) -> Result<bool, StepError> {
        let mut still = Still::default();
        for _ in self.steps..most.min(self.steps + STRETCH) {
            let from = self.world.x.clone();
            if self.near {
                self.step(STEP)?;
            } else {
                self.fall()?;
            }
            self.steps += 1;
            if still.after(STRETCH as f64 * motion(&from, &self.world.x)[0], settled) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Steps of the nodes alone that moved since the garment was at `before`, while the others are held where they are:
    /// of fewer and fewer, until what they move is settled. Does nothing where it is not in part of the garment that it
    /// moves.
    fn settle_moving(&mut self, mut before: Vec<Vec3>, settled: f64, most: usize) -> Result<(), StepError> {
        let mut resting = Vec::new();
        for _ in 0..STRETCHES {
            if let Some(moving) = self.moving(&before) {
                resting.push(self.world.hold_all_but(&moving)?);
            } else if resting.is_empty() {
                break;
            }
            before.clone_from(&self.world.x);
            let is_still = self.stretch(CALMER * settled, most)?;
            if is_still || motion(&before, &self.world.x)[0] <= CALMER * settled || self.steps >= most {
                break;
            }
        }
        resting.into_iter().rev().try_for_each(|resting| self.world.release(resting))
    }

    /// The nodes that have moved since `before`, and those near them; none where they are most of those that could.
    fn moving(&self, before: &[Vec3]) -> Option<Vec<bool>> {
        let cloth = &self.world.cloth;
        let moves = MOVES.max(SHARE * motion(before, &self.world.x)[1]);
        let mut moving: Vec<bool> = before.iter().zip(&self.world.x).map(|(a, b)| (a - b).norm() > moves).collect();
        for _ in 0..RINGS {
            moving = cloth.with_neighbours(&moving);
        }
        cloth.held.iter().for_each(|&n| moving[n as usize] = false);
        let (count, free) = (moving.iter().filter(|m| **m).count(), moving.len() - cloth.held.len());
        (count > 0 && (count as f64) < PART * free as f64).then_some(moving)
    }

    /// How far to look around after a stretch in which the garment went `moved` metres RMS, and the node that went
    /// furthest `most_moved`.
    fn reach(&self, moved: f64, most_moved: f64) -> Reach {
        let [nearest, widest] = self.look;
        let near = (LOOK * most_moved).clamp(nearest, widest);
        let falling = moved.min(CELLS * self.spacing);
        let is_free = self.world.contacts_found() < self.world.x.len();
        if is_free && falling > near { Reach::new(falling).with_features() } else { Reach::new(near) }
    }

    fn fall(&mut self) -> Result<(), StepError> {
        let now = self.world.x.clone();
        self.world.fall(&self.last)?;
        self.last = now;
        Ok(())
    }

    /// A step with the true stiffness.
    fn step(&mut self, dt: f64) -> Result<(), StepError> {
        let [_, least, most] = TRUST.map(|share| share * self.spacing);
        self.trust = self.world.newton(dt, self.trust)?.trust(self.trust).clamp(least, most);
        Ok(())
    }

    /// As many steps again as were made, at half the step size: how far the garment goes, metres, root mean square and
    /// largest. Where it hardly moves any more, has gone too far already, or tests have made `most` steps, those that
    /// are left count as if each went as far as the last, all the same way.
    fn drift(&mut self, most: usize) -> Result<[f64; 2], StepError> {
        let before = self.world.x.clone();
        let (mut left_out, mut still) = ([0.0; 2], Still::default());
        for left in (0..self.steps).rev() {
            let from = self.world.x.clone();
            self.step(0.5 * STEP)?;
            self.tested += 1;
            let still_to_go = motion(&from, &self.world.x).map(|way| way * left as f64);
            let is_decided = still.after(still_to_go[0], DRIFT) || motion(&before, &self.world.x)[0] > DRIFT;
            if is_decided || self.tested >= most {
                left_out = still_to_go;
                break;
            }
        }
        let [mean, largest] = motion(&before, &self.world.x);
        Ok([mean + left_out[0], largest + left_out[1]])
    }
}

/// Counts steps in a row after which there is hardly any way left to go.
#[derive(Default)]
struct Still(usize);

impl Still {
    /// Whether there were enough, the last one with `left` metres to go of which `bound` may be.
    fn after(&mut self, left: f64, bound: f64) -> bool {
        self.0 = if left <= STILL * bound { self.0 + 1 } else { 0 };
        self.0 >= IN_A_ROW
    }
}

/// Root mean square and largest distance between two states, metres.
fn motion(a: &[Vec3], b: &[Vec3]) -> [f64; 2] {
    let squares = || a.iter().zip(b).map(|(p, q)| (p - q).norm_squared());
    let mean = squares().sum::<f64>() / a.len().max(1) as f64;
    [mean.sqrt(), squares().fold(0.0, f64::max).sqrt()]
}
