//! Cloth, body and contact together, advanced step by step.

use super::contact_law::{ContactLaw, Hardening};
use super::cost::ContactTime;
use super::elasticity::Loads;
use super::energy::Elastic;
use super::force::{Forces, cloth_forces};
use super::friction::Friction;
use super::model::Cloth;
use super::proximity::{Proximity, Reach};
use super::pull::Pull;
use super::step::{StepError, Stepper};
use crate::contact::{Collider, Neighbourhood, Tangle};
use crate::fabric::GRAVITY;
use crate::geometry::Vec3;

/// Gap below which the matrix couples two layers, metres: layers that are pressed together move together.
const COUPLED: f64 = 1.5e-3;
/// Gap at which a pair of layers without a coupling makes the matrix pattern be built anew, metres. It is less than
/// [`COUPLED`], so that the pattern is seldom rebuilt.
const TOUCHING: f64 = 0.7e-3;
/// Time step of falling, s. It is long because inertia only delays rest: the step is a Newton step on the energy.
const FALL: f64 = 0.1;
/// Share of the last motion by which falling cloth is extrapolated before a step.
const MOMENTUM: f64 = 0.9;
/// Largest extrapolation of falling cloth, metres.
const LOOK_AHEAD: f64 = 4e-3;
/// Rounds of the active set: how often a step is solved to find the contacts that push at its end.
pub(super) const ROUNDS: usize = 2;
/// Most stages, each with its own contacts, in which cloth is carried to given positions.
const CARRIES: usize = 10;

/// Outcome of a given motion.
struct Way {
    /// Share of the motion that there was room for.
    share: f64,
    /// Largest motion, metres.
    moved: f64,
}

/// A garment in motion.
pub struct World<'a> {
    /// The cloth.
    pub cloth: Cloth,
    /// Node positions.
    pub(super) x: Vec<Vec3>,
    /// Node velocities, which inertia keeps, m/s.
    pub velocity: Vec<Vec3>,
    /// Friction of the contacts. None while sewing.
    pub(super) friction: Option<Friction>,
    /// Decrease of the energy in every Newton step since the last search for contacts, J.
    pub(super) gains: Vec<f64>,
    /// The last Newton step of every node as proposed, before it was shortened, metres.
    pub(super) wished: Vec<Vec3>,
    /// Share of gravity.
    pub gravity: f64,
    pub(super) law: ContactLaw,
    pub(super) proximity: Proximity<'a>,
    pub(super) stepper: Stepper,
    /// Couplings between layers in `stepper`. `None` while seams are being closed: layers then slide past each other
    /// too fast for couplings to pay.
    pub(super) touching: Option<Vec<[u32; 2]>>,
}

impl<'a> World<'a> {
    /// Prepares a garment at `x` (one position per node) with stitches between `pulls`.
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn new(
        mut cloth: Cloth,
        x: Vec<Vec3>,
        pulls: &[[u32; 2]],
        body: &'a Collider,
        hood: Neighbourhood,
        law: ContactLaw,
        reach: Reach,
    ) -> Result<Self, StepError> {
        cloth.elastic.follow(&x, Loads::default());
        Ok(Self {
            velocity: vec![Vec3::zeros(); x.len()],
            friction: None,
            gains: Vec::new(),
            wished: vec![Vec3::zeros(); x.len()],
            gravity: 0.0,
            law,
            proximity: Proximity::new(&cloth, &x, body, hood, reach, &law),
            stepper: Stepper::new(&cloth, pulls, &[])?,
            touching: pulls.is_empty().then(Vec::new),
            cloth,
            x,
        })
    }

    /// One step of `dt` seconds that keeps the share `keep` of the velocity. Returns the largest motion, metres.
    ///
    /// # Errors
    /// As [`Stepper::solve`].
    pub fn advance(&mut self, dt: f64, keep: f64, pulls: &[Pull]) -> Result<f64, StepError> {
        let inertia: Vec<Vec3> = self.velocity.iter().map(|v| v * keep).collect();
        let forces = forces(self.gravity, &self.proximity, self.law, pulls, self.friction.as_ref());
        let d = self.stepper.solve(&self.cloth, &self.x, &inertia, dt, &forces, 1)?;
        Ok(self.go(&d, dt)?.moved)
    }

    /// A step without inertia from an extrapolated position: the present one plus a share of the motion since `last`.
    /// Cloth comes to rest much faster so than in real time. Returns the largest motion, metres.
    ///
    /// # Errors
    /// As [`Stepper::solve`].
    pub fn fall(&mut self, last: &[Vec3]) -> Result<f64, StepError> {
        // Extrapolation pays only while the forces point along the last motion (O'Donoghue and Candès 2015).
        let uphill = || {
            let f = self.unbalanced();
            f.iter().zip(self.x.iter().zip(last)).map(|(f, (x, l))| f.dot(&(x - l))).sum::<f64>() < 0.0
        };
        let momentum = if uphill() { 0.0 } else { MOMENTUM };
        let ahead: Vec<Vec3> = self
            .x
            .iter()
            .zip(last)
            .map(|(x, l)| {
                let d = (x - l) * momentum;
                let length = d.norm();
                x + if length > LOOK_AHEAD { d * (LOOK_AHEAD / length) } else { d }
            })
            .collect();
        let ahead = self.clamped(&ahead);
        let still = vec![Vec3::zeros(); ahead.len()];
        let forces = forces(self.gravity, &self.proximity, self.law, &[], self.friction.as_ref());
        let d = self.stepper.solve(&self.cloth, &ahead, &still, FALL, &forces, ROUNDS)?;
        let target: Vec<Vec3> = ahead.iter().zip(&d).map(|(x, d)| x + d).collect();
        let target = self.clamped(&target);
        self.move_to(target, FALL, true, Loads::default())
    }

    /// The positions nearest to `target` that the bounds allow.
    fn clamped(&mut self, target: &[Vec3]) -> Vec<Vec3> {
        loop {
            let mut to = target.to_vec();
            self.proximity.clamp(&self.x, &mut to);
            if self.cover(&to) {
                return to;
            }
        }
    }

    /// Adds the contacts that matter on the way to `target`. Returns whether all were there already.
    pub(super) fn cover(&mut self, target: &[Vec3]) -> bool {
        let covered = self.proximity.covers(&self.x, target);
        if !covered && let Some(friction) = &mut self.friction {
            friction.detected(self.proximity.near());
        }
        covered
    }

    /// Moves the nodes to `target` in `dt` seconds. `foresaw` are the loads that the step predicted (empty: none). With
    /// `drag` the memory of friction follows. Returns the largest motion, metres.
    pub(super) fn move_to(&mut self, target: Vec<Vec3>, dt: f64, drag: bool, foresaw: Loads) -> Result<f64, StepError> {
        let mut largest = 0.0f64;
        for ((x, t), v) in self.x.iter().zip(&target).zip(&mut self.velocity) {
            let d = t - x;
            *v = d / dt;
            largest = largest.max(d.norm_squared());
        }
        let last = std::mem::replace(&mut self.x, target);
        self.cloth.elastic.follow(&self.x, foresaw);
        if drag || self.proximity.bounds.is_due(&self.x) {
            self.drag_friction();
        }
        if self.proximity.follow(&self.cloth, &last, &self.x) {
            self.contacts_changed()?;
        } else if let Some(friction) = &mut self.friction {
            friction.detected(self.proximity.near());
        }
        Ok(largest.sqrt())
    }

    /// Updates the memory of friction: how far every contact has been dragged.
    fn drag_friction(&mut self) {
        if let Some(friction) = &mut self.friction {
            let (cloth, law, x) = (&self.cloth, self.law, &self.x);
            friction.update(x, self.proximity.near(), &cloth.friction, |c| law.load(cloth, x, c));
        }
    }

    /// Searches for contacts, now and from now on within `reach`.
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn look_within(&mut self, reach: Reach) -> Result<(), StepError> {
        self.proximity.reach = reach;
        self.detect()
    }

    /// Moves the nodes towards `target`, as far as contacts allow.
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn carry(&mut self, target: &[Vec3]) -> Result<(), StepError> {
        for _ in 0..CARRIES {
            let way: Vec<Vec3> = target.iter().zip(&self.x).map(|(to, x)| to - x).collect();
            if self.go(&way, FALL)?.share == 1.0 {
                break;
            }
        }
        Ok(())
    }

    /// Makes the share of the motion `d` (one per node) in `dt` seconds that the nodes' room allows, clamped by the
    /// bounds.
    fn go(&mut self, d: &[Vec3], dt: f64) -> Result<Way, StepError> {
        let share = self.proximity.bounds.share(&self.x, d);
        let target: Vec<Vec3> = self.x.iter().zip(d).map(|(x, d)| x + d * share).collect();
        let target = self.clamped(&target);
        Ok(Way { share, moved: self.move_to(target, dt, true, Loads::default())? })
    }

    /// Searches for contacts (the broad phase). Between two searches a node slides on the plane where it met the body.
    /// On a curved body the error of that plane is the distance by which the surface bends away.
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn detect(&mut self) -> Result<(), StepError> {
        self.drag_friction();
        self.proximity.detect(&self.cloth, &self.x);
        self.contacts_changed()
    }

    /// Node positions.
    pub fn x(&self) -> &[Vec3] {
        &self.x
    }

    /// The node positions, when nothing moves any more.
    pub fn into_x(self) -> Vec<Vec3> {
        self.x
    }

    /// Puts the nodes at `x`, one position per node. That gives no velocity, drags no contact along, and turns no fold
    /// by more than half a turn.
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn displace(&mut self, x: Vec<Vec3>) -> Result<(), StepError> {
        self.x = x;
        self.velocity.fill(Vec3::zeros());
        self.cloth.elastic.follow(&self.x, Loads::default());
        if let Some(friction) = &mut self.friction {
            friction.displaced(&self.x);
        }
        self.detect()
    }

    /// Moves the `nodes` by `way`, metres, as a hand that holds them: contacts follow, and friction drags.
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn shift(&mut self, nodes: &[usize], way: Vec3) -> Result<(), StepError> {
        let mut target = self.x.clone();
        nodes.iter().for_each(|&node| target[node] += way);
        self.move_to(target, FALL, false, Loads::default()).map(|_| ())
    }

    /// Switches friction on, with at least this tangential `stiffness` per contact, N/m.
    pub fn grip(&mut self, stiffness: f64) {
        self.friction = Some(Friction::new(&self.x, self.proximity.near(), stiffness));
    }

    /// Switches to fast hardening of contacts ([`Hardening::Fast`]) from the next step on.
    pub fn harden(&mut self) {
        self.law.hardening = Hardening::Fast;
        self.stepper.forget();
        // Its energy is another one now.
        self.gains.clear();
    }

    /// Passes new contacts on: to friction, and to the matrix pattern if layers have come near each other.
    fn contacts_changed(&mut self) -> Result<(), StepError> {
        // Its energy is another one now.
        self.gains.clear();
        if let Some(friction) = &mut self.friction {
            friction.detected(self.proximity.near());
        }
        let Some(known) = &mut self.touching else { return Ok(()) };
        let touching = self.proximity.touching(&self.x, TOUCHING);
        if touching.iter().any(|t| known.binary_search(t).is_err()) {
            *known = self.proximity.touching(&self.x, COUPLED);
            self.stepper = Stepper::new(&self.cloth, &[], known)?;
        }
        Ok(())
    }

    /// Elastic energy, contact energy and weight × height, J.
    pub fn energy(&self) -> f64 {
        self.forces(&[]).energy(&self.cloth, &self.x, &vec![0.0; self.proximity.near().len()])
    }

    pub(super) fn forces<'b>(&'b self, pulls: &'b [Pull]) -> Forces<'b> {
        forces(self.gravity, &self.proximity, self.law, pulls, self.friction.as_ref())
    }

    /// Sum of all forces on every node, N. At a free node it is the unbalanced force, at a held node the reversed
    /// reaction.
    pub fn unbalanced(&self) -> Vec<Vec3> {
        cloth_forces(&self.cloth, &self.x, &self.forces(&[]))
    }

    /// Forces of the body on every node, N: the normal forces, and friction.
    pub fn body_forces(&self) -> [Vec<Vec3>; 2] {
        let forces = self.forces(&[]);
        let [mut normal, mut friction] = [(); 2].map(|()| vec![Vec3::zeros(); self.x.len()]);
        for (k, contact) in forces.contacts.iter().enumerate().filter(|(_, contact)| contact.is_on_body()) {
            let load = forces.load(&self.cloth, &self.x, contact);
            if load <= 0.0 {
                continue;
            }
            let grip = forces.hold(&self.cloth, &self.x, k, load).map_or_else(Vec3::zeros, |hold| hold.grip().force);
            for (node, weight) in contact.parts() {
                normal[node] += contact.normal * (load * weight);
                friction[node] += grip * weight;
            }
        }
        [normal, friction]
    }

    /// Root mean square of the unbalanced force, in mean particle weights.
    pub fn residual_in_weights(&self) -> f64 {
        let mut r = self.unbalanced();
        self.cloth.held.iter().for_each(|&n| r[n as usize] = Vec3::zeros());
        let mean_mass = self.cloth.mass.iter().sum::<f64>() / self.cloth.mass.len().max(1) as f64;
        let rms = (r.iter().map(Vec3::norm_squared).sum::<f64>() / r.len().max(1) as f64).sqrt();
        rms / (mean_mass * GRAVITY)
    }

    /// Number of known contacts with body and cloth, within the reach of the searches that found them.
    pub fn contacts_found(&self) -> usize {
        self.proximity.found()
    }

    /// Wall-clock time spent on contact up to now.
    pub fn contact_time(&self) -> ContactTime {
        self.proximity.time
    }

    /// Places where the cloth passes through itself.
    pub fn tangles(&mut self) -> Vec<Tangle> {
        self.proximity.tangles(&self.x)
    }

    /// Places where the cloth would pass through itself with its nodes at `x`.
    pub fn tangles_at(&mut self, x: &[Vec3]) -> Vec<Tangle> {
        self.proximity.tangles(x)
    }

    /// Sets the nodes that may pass through one another. An empty list means none.
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn set_passing(&mut self, passing: Vec<bool>) -> Result<(), StepError> {
        self.proximity.set_passing(passing);
        self.detect()
    }
}

/// The forces, built from parts of the world so that the stepper can be borrowed mutably beside them.
pub(super) fn forces<'b>(
    gravity: f64,
    proximity: &'b Proximity,
    law: ContactLaw,
    pulls: &'b [Pull],
    friction: Option<&'b Friction>,
) -> Forces<'b> {
    Forces { gravity, contacts: proximity.near(), law, pulls, friction }
}
