//! The published explicit scheme: central differences with viscous damping and an adaptive step (F2, F8, F9).
//!
//! Fan et al. 1999 move every particle by (1) μ Ẍ + γ Ẋ = F(X), F being the sum of all forces, and replace (7) Ẍ by
//! (X₊ − 2 X + X₋)/Δt² and (8) Ẋ by (X₊ − X₋)/2Δt. Multiplied by Δt² this is their (9), which leaves the powers of Δt
//! to the reader:
//!
//! ```text
//! μ (X₊ − 2 X + X₋) + γ' (X₊ − X₋) = Δt² F,   γ' = γ Δt / 2
//! ```
//!
//! and, with the forces of time t, (14), whose "μ X" must read 2 μ X:
//!
//! ```text
//! (μ + γ') X₊ = Δt² F(X) + 2 μ X − (μ − γ') X₋
//! ```
//!
//! With the mean velocities V = (X − X₋)/Δt₋ before and V₊ = (X₊ − X)/Δt₊ after, the same equation is
//!
//! ```text
//! (μ + γ Δt₊/2) V₊ = (μ − γ Δt₋/2) V + ½ (Δt₋ + Δt₊) F(X)
//! ```
//!
//! This form loses no digits to differences of large numbers and holds for steps of changing length. It is the one
//! computed here.
//!
//! **The step.** Over a step d = V₊ Δt the forces change by F(X) − F(X₊) ≈ K d. The ratio s = Δt² dᵀ(F(X) − F(X₊)) /
//! dᵀMd is (ω Δt)² for the frequencies ω in d, and the scheme is unstable from s = 4. It also measures energy. The
//! scheme keeps constant the kinetic energy plus the mean of the potentials at both ends, up to s/2 times the kinetic
//! energy. So a bound on s bounds the energy that a step can add. After Desbrun & Gascuel 1996 the step is as large as
//! that allows: it grows slowly while s is small, and it is undone and halved if s, or the motion of any particle, is
//! too large. Every step costs one evaluation of the forces.

mod control;
mod error;

pub use control::{Start, StepControl};
pub use error::ExplicitError;

use super::force::{Forces, cloth_forces};
use super::model::Cloth;
use crate::geometry::Vec3;

/// Largest s of an accepted step (see the module): half the frequency at which the scheme becomes unstable.
const LARGEST_INDEX: f64 = 1.0;
/// Largest s at which the step grows. It is far enough below [`LARGEST_INDEX`] that growth is not followed by halving
/// at once.
const CALM_INDEX: f64 = 0.5;
/// Growth factor per step. Unstable modes that a slightly too large step excites grow slowly, and are seen before they
/// are large.
const GROWTH: f64 = 1.02;
/// Factor of an undone step.
const SHRINK: f64 = 0.5;

/// Bounds of rest. Both are needed: a swing passes its equilibrium at full speed, and turns with none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Root mean square of the force on the particles that are not held, N.
    pub force: f64,
    /// Root mean square of their speed, m/s.
    pub speed: f64,
}

/// Outcome of [`Explicit::settle`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// Steps made.
    pub steps: usize,
    /// Force and speed reached.
    pub reached: Rest,
    /// Whether it is within the bounds that were asked for.
    pub converged: bool,
}

/// Particles moving under a force `F: Fn(&[Vec3]) -> Vec<Vec3>`, newtons from metres.
#[derive(Clone, Debug)]
pub struct Explicit<F> {
    law: F,
    /// Inverse masses, 1/kg. A particle with 0 is held.
    inverse_mass: Vec<f64>,
    damping: f64,
    control: StepControl,
    x: Vec<Vec3>,
    velocity: Vec<Vec3>,
    force: Vec<Vec3>,
    /// Length of the step that led to `x`.
    behind: f64,
    /// Length of the next step.
    ahead: f64,
    time: f64,
    undone: usize,
}

/// A step that was tried.
struct Trial {
    x: Vec<Vec3>,
    velocity: Vec<Vec3>,
    force: Vec<Vec3>,
}

/// Verdict on a trial step.
enum TrialVerdict {
    /// Accepted, with its s (see the module).
    Fine(f64),
    /// Refused because of this particle.
    Bad(usize),
}

impl<F: Fn(&[Vec3]) -> Vec<Vec3>> Explicit<F> {
    /// Particles at rest at `x` with `masses` in kg (infinite: held in place) and viscous damping γ = `damping`, kg/s.
    ///
    /// # Errors
    /// [`ExplicitError`] for anything that is not usable.
    pub fn new(
        x: Vec<Vec3>,
        masses: &[f64],
        damping: f64,
        start: Start,
        control: StepControl,
        law: F,
    ) -> Result<Self, ExplicitError> {
        let count = |what, found| {
            if found == x.len() { Ok(()) } else { Err(ExplicitError::Count { what, found, particles: x.len() }) }
        };
        count("masses", masses.len())?;
        if let Some(particle) = masses.iter().position(|m| m.is_nan() || *m <= 0.0) {
            return Err(ExplicitError::Mass { particle, mass: masses[particle] });
        }
        if !(damping.is_finite() && damping >= 0.0) {
            return Err(ExplicitError::Damping(damping));
        }
        if !control.is_valid() {
            return Err(ExplicitError::Control(control));
        }
        let force = law(&x);
        count("forces", force.len())?;
        if let Some(particle) = (0..x.len()).find(|&i| !is_finite(&x[i]) || !is_finite(&force[i])) {
            return Err(ExplicitError::BadStart { particle });
        }
        let ahead = control.first();
        Ok(Self {
            law,
            inverse_mass: masses.iter().map(|m| m.recip()).collect(),
            damping,
            control,
            velocity: vec![Vec3::zeros(); x.len()],
            x,
            force,
            // Start::Centred is a step of no length before time 0: half the impulse, from rest.
            behind: if start == Start::Published { ahead } else { 0.0 },
            ahead,
            time: 0.0,
            undone: 0,
        })
    }

    /// Makes one step and returns its length, seconds.
    ///
    /// # Errors
    /// [`ExplicitError::Diverged`]. Positions are then those of the last good step.
    pub fn advance(&mut self) -> Result<f64, ExplicitError> {
        loop {
            let step = self.ahead;
            let trial = self.attempt(step);
            match (self.judge(&trial, step), self.control) {
                (TrialVerdict::Fine(_), StepControl::Fixed { .. }) => self.accept(trial, step),
                (TrialVerdict::Fine(index), StepControl::Adaptive { largest, .. }) if index <= LARGEST_INDEX => {
                    self.accept(trial, step);
                    if index < CALM_INDEX {
                        self.ahead = (step * GROWTH).min(largest);
                    }
                }
                (verdict, control) => {
                    self.shrink(&verdict, control)?;
                    continue;
                }
            }
            return Ok(step);
        }
    }

    /// Makes steps until time `end`, seconds. The last one ends there exactly.
    ///
    /// # Errors
    /// As [`Explicit::advance`].
    pub fn run_until(&mut self, end: f64) -> Result<(), ExplicitError> {
        // A remainder below this is rounding of the sum of the steps.
        let rounding = 1e-12 * end.abs();
        while end - self.time > rounding {
            let planned = self.ahead;
            self.ahead = planned.min(end - self.time);
            let cut = self.ahead < planned;
            self.advance()?;
            if cut {
                self.ahead = self.ahead.max(planned);
            }
        }
        Ok(())
    }

    /// Makes steps until the particles rest within `bounds`, `max_steps` at most.
    ///
    /// # Errors
    /// As [`Explicit::advance`].
    pub fn settle(&mut self, bounds: Rest, max_steps: usize) -> Result<Settled, ExplicitError> {
        let mut steps = 0;
        loop {
            let reached = self.unrest();
            let converged = reached.force <= bounds.force && reached.speed <= bounds.speed;
            if converged || steps >= max_steps {
                return Ok(Settled { steps, reached, converged });
            }
            self.advance()?;
            steps += 1;
        }
    }

    /// Force and speed of the particles that are not held.
    pub fn unrest(&self) -> Rest {
        let free: Vec<usize> = (0..self.x.len()).filter(|&i| self.inverse_mass[i] > 0.0).collect();
        let rms = |v: &[Vec3]| {
            let sum: f64 = free.iter().map(|&i| v[i].norm_squared()).sum();
            (sum / free.len().max(1) as f64).sqrt()
        };
        Rest { force: rms(&self.force), speed: rms(&self.velocity) }
    }

    /// Positions, metres.
    pub fn positions(&self) -> &[Vec3] {
        &self.x
    }

    /// Time since the start, seconds.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Steps that were undone and halved.
    pub fn undone(&self) -> usize {
        self.undone
    }

    fn attempt(&self, step: f64) -> Trial {
        let mean = 0.5 * (self.behind + step);
        let moved = self.velocity.iter().zip(&self.force).zip(&self.inverse_mass).map(|((v, f), w)| {
            let (lost, kept) = (1.0 + 0.5 * self.damping * step * w, 1.0 - 0.5 * self.damping * self.behind * w);
            (v * kept + f * (mean * w)) / lost
        });
        let velocity: Vec<Vec3> = moved.collect();
        let x: Vec<Vec3> = self.x.iter().zip(&velocity).map(|(x, v)| x + v * step).collect();
        let force = (self.law)(&x);
        Trial { x, velocity, force }
    }

    fn judge(&self, trial: &Trial, step: f64) -> TrialVerdict {
        let most = self.control.most();
        let (mut softening, mut inertia) = (0.0, 0.0);
        for i in (0..self.x.len()).filter(|&i| self.inverse_mass[i] > 0.0) {
            let way = trial.velocity[i] * step;
            if way.norm() > most || !is_finite(&way) || !is_finite(&trial.force[i]) {
                return TrialVerdict::Bad(i);
            }
            softening += way.dot(&(self.force[i] - trial.force[i]));
            inertia += way.norm_squared() / self.inverse_mass[i];
        }
        TrialVerdict::Fine(if inertia > 0.0 { step * step * softening / inertia } else { 0.0 })
    }

    fn accept(&mut self, trial: Trial, step: f64) {
        (self.x, self.velocity, self.force) = (trial.x, trial.velocity, trial.force);
        self.behind = step;
        self.time += step;
    }

    /// Halves the next step, or ends the run where that is not possible.
    fn shrink(&mut self, verdict: &TrialVerdict, control: StepControl) -> Result<(), ExplicitError> {
        let particle = if let TrialVerdict::Bad(particle) = verdict { *particle } else { self.fastest() };
        let step = self.ahead;
        match control {
            StepControl::Adaptive { smallest, .. } if step * SHRINK >= smallest => {
                self.ahead = step * SHRINK;
                self.undone += 1;
                Ok(())
            }
            _ => Err(ExplicitError::Diverged { time: self.time, step, particle }),
        }
    }

    fn fastest(&self) -> usize {
        let speed = |i: &usize| self.velocity[*i].norm_squared();
        (0..self.x.len()).max_by(|a, b| speed(a).total_cmp(&speed(b))).unwrap_or(0)
    }
}

fn is_finite(v: &Vec3) -> bool {
    v.iter().all(|c| c.is_finite())
}

/// The force law of a cloth: springs and bending with gravity, contact, friction and sewing pulls, N. Contacts are
/// those of `forces`, so the law holds while no node moves further than the search radius of these contacts.
pub fn law_of<'a>(cloth: &'a Cloth, forces: Forces<'a>) -> impl Fn(&[Vec3]) -> Vec<Vec3> + 'a {
    move |x| cloth_forces(cloth, x, &forces)
}

/// A cloth at rest at `x` (one position per node) as [`Explicit`] particles. Nodes in `held` stay where they are.
///
/// # Errors
/// As [`Explicit::new`]. [`ExplicitError::Count`] also for a held node that the cloth does not have.
pub fn explicit_cloth<'a>(
    cloth: &'a Cloth,
    forces: Forces<'a>,
    x: Vec<Vec3>,
    held: &[u32],
    damping: f64,
    control: StepControl,
) -> Result<Explicit<impl Fn(&[Vec3]) -> Vec<Vec3> + 'a>, ExplicitError> {
    let mut masses = cloth.mass.clone();
    if x.len() != masses.len() {
        return Err(ExplicitError::Count { what: "positions", found: x.len(), particles: masses.len() });
    }
    for &node in held {
        let particles = masses.len();
        let mass = masses.get_mut(node as usize);
        *mass.ok_or(ExplicitError::Count { what: "held node numbers", found: node as usize, particles })? =
            f64::INFINITY;
    }
    Explicit::new(x, &masses, damping, Start::default(), control, law_of(cloth, forces))
}
