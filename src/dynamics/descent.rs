//! Newton steps of a garment, each shortened until it lowers the energy.

use std::borrow::Cow;

use super::contact_law::Hardening;
use super::elasticity::Loads;
use super::energy::{Elastic, Energy, Foreseen};
use super::force::Forces;
use super::step::StepError;
use super::world::{ROUNDS, World, forces};
use crate::contact::Contact;
use crate::geometry::Vec3;

/// Line search: a Newton step is halved until the energy falls by this share of the predicted decrease.
const ENOUGH: f64 = 0.05;
/// Most halvings of a Newton step in the line search.
const HALVINGS: usize = 5;
/// Steps in the memory of the non-monotone line search: a step may raise the energy, but not above the largest value of
/// so many steps before. Stiff cloth turns along narrow valleys, where monotone steps are much shorter (Grippo,
/// Lampariello and Lucidi 1986).
const MEMORY: usize = 2;
/// Most halvings of a step with the majorant. Stiffening springs have no majorant, but a short enough step lowers the
/// energy.
const MORE_HALVINGS: usize = 12;
/// Energy differences below this are rounding, J.
const ROUNDING: f64 = 1e-12;

/// Acceptance test of the line search.
struct Demand {
    /// Predicted decrease of the energy, J. The share [`ENOUGH`] of it suffices.
    expected: f64,
    /// Allowed rise of the energy, J.
    allowed: f64,
    /// Most halvings.
    halvings: usize,
    /// Whether springs and shear are judged by the loads that the step's linear model predicts, so that their energy
    /// beyond these loads does not count.
    foresees: bool,
}

/// Outcome of a line search.
struct Descent {
    target: Vec<Vec3>,
    /// Decrease of the energy, J.
    gain: f64,
    halvings: usize,
    /// Share of the step that was taken, before the bounds changed it.
    share: f64,
    /// Loads that the step predicted, if it does.
    foresaw: Loads,
}

/// Outcome of a Newton step.
#[derive(Clone, Copy, Debug)]
pub struct NewtonStep {
    /// Largest motion, metres.
    pub moved: f64,
    /// Whether the line search shortened it.
    pub shortened: bool,
    /// Decrease of the energy over the predicted decrease.
    pub ratio: f64,
}

impl NewtonStep {
    /// Trust region of the next step after one with `radius`, metres. It grows if the model predicted the decrease
    /// well, and shrinks if it did not.
    pub fn trust(&self, radius: f64) -> f64 {
        match self {
            s if s.shortened => 0.5 * radius,
            s if s.ratio < 0.25 => 0.7 * radius,
            s if s.ratio > 0.5 => 1.5 * radius,
            _ => radius,
        }
    }
}

impl<'a> World<'a> {
    /// A Newton step with the true stiffness that changes no edge by more than `radius` metres.
    ///
    /// A non-monotone line search shortens it. If that fails, a step with the majorant takes its place, shortened until
    /// the energy falls. Energy of springs and shear beyond the loads that the step predicted does not count, because
    /// the next step takes it back.
    ///
    /// Friction is measured from the last search for contacts. Steps between two searches are iterations towards one
    /// state of rest. A memory that followed each step would be a ratchet: the errors of steps would drag the garment
    /// along for hundreds of steps.
    ///
    /// # Errors
    /// [`StepError::Singular`] when a number is not finite.
    pub fn newton(&mut self, dt: f64, radius: f64) -> Result<NewtonStep, StepError> {
        self.make_room()?;
        let now = forces(self.gravity, &self.proximity, self.law, &[], self.friction.as_ref());
        let step = self.stepper.newton(&self.cloth, &self.x, dt, &now, radius)?;
        self.wished.clone_from(&step.d);
        let longest = self.proximity.bounds.longest();
        if step.d.iter().any(|d| d.norm() > longest) {
            // Freely falling cloth: the next search covers all of it, so that nodes may go further.
            self.proximity.forget();
        }
        let allowed = self.allowed_rise();
        let demand = Demand { expected: step.gain, allowed, halvings: HALVINGS, foresees: true };
        let down = self.descend(&step.d, &demand);
        if step.gain > 0.0 && down.gain >= -ROUNDING - allowed {
            self.gains.push(down.gain);
            // Predicted decrease for the share that was taken.
            let expected = step.gain * down.share * (2.0 - down.share);
            let ratio = if expected > 0.0 { down.gain / expected } else { 0.0 };
            let shortened = down.halvings > 0;
            let moved = self.move_to(down.target, dt, false, down.foresaw)?;
            return Ok(NewtonStep { moved, shortened, ratio });
        }
        self.gains.clear();
        self.cloth.elastic.follow(&self.x, Loads::default());
        self.stepper.forget();
        let still = vec![Vec3::zeros(); self.x.len()];
        let now = forces(self.gravity, &self.proximity, self.law, &[], self.friction.as_ref());
        let d = self.stepper.solve(&self.cloth, &self.x, &still, dt, &now, ROUNDS)?;
        let down = self.descend(&d, &Demand { expected: 0.0, allowed: 0.0, halvings: MORE_HALVINGS, foresees: false });
        // The bounds may ask for more room than there is. The shortest step then still makes that room.
        Ok(NewtonStep { moved: self.move_to(down.target, dt, false, Loads::default())?, shortened: true, ratio: 0.0 })
    }

    /// Searches for contacts if the last proposed step was longer than the nodes' remaining room.
    fn make_room(&mut self) -> Result<(), StepError> {
        if self.proximity.bounds.is_short_of_room(&self.x, &self.wished) { self.detect() } else { Ok(()) }
    }

    /// Allowed rise: the energy stays below its largest value in the last [`MEMORY`] steps, J.
    fn allowed_rise(&self) -> f64 {
        let mut fallen = 0.0;
        self.gains.iter().rev().take(MEMORY).fold(0.0, |most: f64, gain| {
            fallen += gain;
            most.max(fallen)
        })
    }

    /// Line search: halves the step `d`, clamped by the bounds, until it meets the `demand`.
    fn descend(&mut self, d: &[Vec3], demand: &Demand) -> Descent {
        let share = self.proximity.bounds.share(&self.x, d);
        self.cover(&self.x.iter().zip(d).map(|(x, d)| x + d * share).collect::<Vec<_>>());
        loop {
            let down = self.shortened(d, share, demand);
            if self.cover(&down.target) {
                return down;
            }
        }
    }

    /// [`World::descend`] with the contacts that are known to matter.
    fn shortened(&self, d: &[Vec3], mut share: f64, demand: &Demand) -> Descent {
        let forces = self.forces(&[]);
        let loads = forces.loads(&self.cloth, &self.x);
        let from = forces.energy(&self.cloth, &self.x, &loads);
        let mut halvings = 0;
        loop {
            let mut target: Vec<Vec3> = self.x.iter().zip(d).map(|(x, d)| x + d * share).collect();
            self.proximity.clamp(&self.x, &mut target);
            let Foreseen { loads: foresaw, beyond, energy } = if demand.foresees {
                self.cloth.elastic.foresee(&self.x, &target)
            } else {
                Foreseen { energy: self.cloth.elastic.energy(&target), ..Foreseen::default() }
            };
            let after = Forces { contacts: &self.contacts_after(&target), ..forces };
            let gain = from - after.energy_with(&self.cloth, &target, &loads, energy) + beyond;
            let enough = ENOUGH * share * demand.expected.max(0.0) - demand.allowed;
            if gain > enough || gain.abs() < ROUNDING || halvings >= demand.halvings {
                return Descent { target, gain, halvings, share, foresaw };
            }
            share *= 0.5;
            halvings += 1;
        }
    }

    /// The contacts by which the line search judges a step to `target`.
    ///
    /// Fast hardening contacts turn with the step. On their old planes the corner of a waistband, wedged between two
    /// edges, slid on by millimetres and pressed with a hundred newtons, step after step. Slow ones stay as they are,
    /// because newly stitched cloth settles sooner so.
    fn contacts_after(&self, target: &[Vec3]) -> Cow<'_, [Contact<'a>]> {
        match self.law.hardening {
            Hardening::Fast => self.proximity.near_after(target).into(),
            Hardening::Slow => self.proximity.near().into(),
        }
    }
}
