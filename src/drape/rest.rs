//! Drapes a sewn garment until it is at rest.

use crate::contact::Collider;
use crate::dynamics::{ContactTime, Cut, GRIP, Reach, StepError, World};
use crate::fabric::GRAVITY;
use crate::geometry::Vec3;
use crate::sew::{NEAREST_LOOK, Stitching, drape_reach, lead_off, sewn_world};

/// Options of draping.
#[derive(Clone, Copy, Debug)]
pub struct DrapeOptions {
    /// Steps after which draping ends, at rest or not.
    pub max_steps: usize,
    /// When draping ends.
    pub until: Until,
    /// Whether the start is near rest already, because it was carried over from a draped coarser mesh.
    pub near: bool,
}

/// End of draping.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Until {
    /// Until it rests, tested by as many steps again.
    Rest,
    /// Until only long waves are left. This is enough as a start for a finer mesh, which settles long waves anyway.
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
    /// The energy rose instead of falling: the forces drive the garment apart.
    #[error(
        "draping diverged: the energy of the garment rose from {from:.2} J to {to:.2} J, and {force:.0} N are out of \
         balance at one particle of '{piece}'"
    )]
    Diverged {
        /// The piece with the largest unbalanced force.
        piece: String,
        /// Energy of the sewn garment, J.
        from: f64,
        /// Final energy by the same contact law, J.
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
    /// Further steps made by tests of rest, at most twice the allowed steps.
    pub tested: usize,
    /// Whether it is at rest: unbalanced force within a particle's weight, drift within bounds.
    pub converged: bool,
    /// Elastic, contact and gravity energy, J.
    pub energy: f64,
    /// Root mean square and largest motion over as many steps again at half the step size, metres.
    pub drift: [f64; 2],
    /// Root mean square of the unbalanced force over a particle's weight.
    pub residual: f64,
    /// Forces of the body on every class, N: the normal forces, and friction.
    pub body_forces: [Vec<Vec3>; 2],
    /// Wall-clock time spent on contact.
    pub contact: ContactTime,
}

/// Time step near rest, s. A garment swings like a pendulum with a period of a second or two. In shorter steps inertia
/// would hide how far it still has to go.
const STEP: f64 = 1.0;
/// Steps in one stretch. After each stretch the motion is measured, and contact reach and active set are chosen anew.
const STRETCH: usize = 5;
/// Motion per stretch, RMS, below which a garment is near rest, metres. Only long waves are left then, which need
/// Newton steps with the true stiffness. With Newton steps from the start, a cuff that was sewn folded under stays so.
const NEAR_REST: f64 = 1.5e-3;
/// Steps after which a garment counts as near rest, however far it still moves.
const LONGEST_FALL: usize = 80;
/// Motion per stretch, RMS, below which a garment has settled, metres.
const SETTLED: f64 = 0.12e-3;
/// Trust region of a Newton step: the largest change of an edge at first, at least and at most, in grid spacings.
/// Springs that rotate further are lengthened by more than the next step takes back.
const TRUST: [f64; 3] = [0.125, 0.01, 0.2];
/// Largest drift at rest: RMS motion over as many steps again at half the step size, metres.
pub const DRIFT: f64 = 0.3e-3;
/// Largest unbalanced force at rest, RMS, in particle weights.
pub const RESIDUAL: f64 = 1.0;
/// A step is short if, repeated for all steps that are left, it would move the garment by less than this share of the
/// allowed motion.
const STILL: f64 = 1.0 / 3.0;
/// Short steps in a row that end a stretch or a test of rest early. A single short step may be one that the line search
/// cut.
const IN_A_ROW: usize = 3;
/// Partial solves: if a stretch moved less than this share of the free nodes, only these are stepped further.
const PART: f64 = 0.5;
/// Motion in a stretch above which a node has moved, metres.
const MOVES: f64 = 0.1e-3;
/// Share of the largest motion above which a node has moved. It leaves slow creep of the whole for later while a fold
/// runs through it.
const SHARE: f64 = 0.05;
/// Edge rings round the moving nodes that are freed with them.
const RINGS: usize = 3;
/// A partial solve stops when a stretch moves the garment by less than this share of the motion at which it has
/// settled.
const CALMER: f64 = 0.5;
/// Largest number of stretches of partial solves in a row.
const STRETCHES: usize = 20;
/// Steps after which an undecided test of rest is given up, and twice as many in each further test. Steps of all nodes
/// remove the remaining motion more slowly than partial solves do.
const SHORT_TEST: usize = 12;
/// Bound on the steps of all tests of rest, in multiples of the allowed draping steps: one full test, and as much for
/// the tests before it. A creeping garment fails test after test, each longer than the last.
const TESTS: usize = 2;
/// Contact reach over the largest motion of a node in the previous stretch. A larger reach finds more contacts than
/// pay, a smaller one needs too many searches (one is due when a node has gone a third of the reach).
const LOOK: f64 = 2.0;

/// Largest contact reach of freely falling cloth, in grid spacings. Cloth falls freely while fewer contacts are known
/// than it has nodes. Its reach is then the RMS motion of a stretch, because on coarse meshes a search costs less than
/// the steps that it saves. Stacked layers would find each other many times over.
const CELLS: f64 = 0.4;

/// Rise of energy that counts as divergence, as a height through which the garment's weight would be lifted, metres. A
/// drape normally ends below the energy of the sewn garment.
const LIFTED: f64 = 1.0;

/// Drapes a sewn garment.
///
/// Rest is tested, not taken from a low speed: after the garment has settled, as many steps again at half the step size
/// are made. Their motion is reported as drift.
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
    let (last, trust) = (world.x().to_vec(), TRUST[0] * spacing);
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
    let (energy, contact, body_forces) = (world.energy(), world.contact_time(), world.body_forces());
    Ok(Draped { energy, nodes: world.into_x(), steps, tested, converged, drift, residual, body_forces, contact })
}

/// Checks that a drape that did not come to rest has at least lowered the energy of the garment `sewn` (positions as in
/// [`Draped::nodes`]).
///
/// # Errors
/// [`DrapeError::Diverged`] if its energy has risen, [`DrapeError::Step`] as [`drape`].
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
    // By the same contact law: hardened contacts store joules where limbs leave less room than the cloth is thick.
    world.displace(draped.nodes.clone())?;
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

/// A drape under way.
struct Fall<'a> {
    world: World<'a>,
    /// Positions before the last step.
    last: Vec<Vec3>,
    steps: usize,
    /// Steps of tests of rest.
    tested: usize,
    /// Whether the garment is near rest. Once true it stays true.
    near: bool,
    /// Whether contacts have yet to harden near rest.
    hardens: bool,
    /// Trust region of the next Newton step, metres.
    trust: f64,
    /// Least and largest contact reach, metres.
    look: [f64; 2],
    /// Grid spacing, metres.
    spacing: f64,
}

impl Fall<'_> {
    /// Steps until the garment rests, until `most` steps are made, or until tests have made [`TESTS`] times as many.
    /// Returns the drift, the residual force, and whether the garment rests.
    fn come_to_rest(&mut self, most: usize, progress: &mut dyn FnMut(f64)) -> Result<([f64; 2], f64, bool), StepError> {
        let mut patience = SHORT_TEST;
        loop {
            self.settle(most, SETTLED, progress)?;
            let out_of_steps = self.steps >= most;
            // A garment out of balance falls on while there are steps left.
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

    /// Steps until a stretch moves the garment by less than `settled` metres RMS, or `most` steps are made in all.
    fn settle(&mut self, most: usize, settled: f64, progress: &mut dyn FnMut(f64)) -> Result<(), StepError> {
        let mut is_settled = false;
        while !is_settled && self.steps < most {
            let before = self.world.x().to_vec();
            let is_still = self.stretch(settled, most)?;
            let [moved, most_moved] = motion(&before, self.world.x());
            is_settled = is_still || moved <= settled;
            self.world.look_within(self.reach(moved, most_moved))?;
            self.near |= moved < NEAR_REST || self.steps >= LONGEST_FALL;
            // Contacts harden near rest only. Earlier, cloth pressed hard by sewing would be thrown off or held by its
            // friction. Cloth that the body cuts is first led off it.
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

    /// Makes a stretch of steps, at most `most` steps in all. Returns whether it ended early because whole stretches of
    /// such steps would move the garment by far less than `settled` metres.
    fn stretch(&mut self, settled: f64, most: usize) -> Result<bool, StepError> {
        let mut still = Still::default();
        for _ in self.steps..most.min(self.steps + STRETCH) {
            let from = self.world.x().to_vec();
            if self.near {
                self.step(STEP)?;
            } else {
                self.fall()?;
            }
            self.steps += 1;
            if still.after(STRETCH as f64 * motion(&from, self.world.x())[0], settled) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Partial solves: steps of the nodes alone that moved since `before`, while the others are held. The active set
    /// shrinks until its motion has settled. Does nothing if most of the garment moves.
    fn settle_moving(&mut self, mut before: Vec<Vec3>, settled: f64, most: usize) -> Result<(), StepError> {
        let mut resting = Vec::new();
        for _ in 0..STRETCHES {
            if let Some(moving) = self.moving(&before) {
                resting.push(self.world.hold_all_but(&moving)?);
            } else if resting.is_empty() {
                break;
            }
            before.clear();
            before.extend_from_slice(self.world.x());
            let is_still = self.stretch(CALMER * settled, most)?;
            if is_still || motion(&before, self.world.x())[0] <= CALMER * settled || self.steps >= most {
                break;
            }
        }
        resting.into_iter().rev().try_for_each(|resting| self.world.release(resting))
    }

    /// The active set: nodes that have moved since `before` and [`RINGS`] rings round them. `None` if it is empty or
    /// has more than the share [`PART`] of the free nodes.
    fn moving(&self, before: &[Vec3]) -> Option<Vec<bool>> {
        let cloth = &self.world.cloth;
        let moves = MOVES.max(SHARE * motion(before, self.world.x())[1]);
        let mut moving: Vec<bool> = before.iter().zip(self.world.x()).map(|(a, b)| (a - b).norm() > moves).collect();
        for _ in 0..RINGS {
            moving = cloth.with_neighbours(&moving);
        }
        cloth.held.iter().for_each(|&n| moving[n as usize] = false);
        let (count, free) = (moving.iter().filter(|m| **m).count(), moving.len() - cloth.held.len());
        (count > 0 && (count as f64) < PART * free as f64).then_some(moving)
    }

    /// Contact reach after a stretch with motions of `moved` (RMS) and `most_moved` (largest), metres.
    fn reach(&self, moved: f64, most_moved: f64) -> Reach {
        let [nearest, widest] = self.look;
        let near = (LOOK * most_moved).clamp(nearest, widest);
        let falling = moved.min(CELLS * self.spacing);
        let is_free = self.world.contacts_found() < self.world.x().len();
        if is_free && falling > near { Reach::new(falling).with_features() } else { Reach::new(near) }
    }

    fn fall(&mut self) -> Result<(), StepError> {
        let now = self.world.x().to_vec();
        self.world.fall(&self.last)?;
        self.last = now;
        Ok(())
    }

    /// A Newton step.
    fn step(&mut self, dt: f64) -> Result<(), StepError> {
        let [_, least, most] = TRUST.map(|share| share * self.spacing);
        self.trust = self.world.newton(dt, self.trust)?.trust(self.trust).clamp(least, most);
        Ok(())
    }

    /// Measures the drift: RMS and largest motion over as many steps again as were made, at half the step size, metres.
    ///
    /// The test ends early if the garment hardly moves any more, has gone too far already, or tests have made `most`
    /// steps. The remaining steps then count as if each went as far as the last one, in the same direction.
    fn drift(&mut self, most: usize) -> Result<[f64; 2], StepError> {
        let before = self.world.x().to_vec();
        let (mut left_out, mut still) = ([0.0; 2], Still::default());
        for left in (0..self.steps).rev() {
            let from = self.world.x().to_vec();
            self.step(0.5 * STEP)?;
            self.tested += 1;
            let still_to_go = motion(&from, self.world.x()).map(|way| way * left as f64);
            let is_decided = still.after(still_to_go[0], DRIFT) || motion(&before, self.world.x())[0] > DRIFT;
            if is_decided || self.tested >= most {
                left_out = still_to_go;
                break;
            }
        }
        let [mean, largest] = motion(&before, self.world.x());
        Ok([mean + left_out[0], largest + left_out[1]])
    }
}

/// Counts short steps in a row.
#[derive(Default)]
struct Still(usize);

impl Still {
    /// Counts a step that leaves `left` metres to go, of `bound` metres allowed. Returns whether there were enough
    /// short steps in a row.
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
