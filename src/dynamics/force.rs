//! The forces on the cloth at given positions, and their energies.

use super::contact_law::ContactLaw;
use super::friction::{Friction, Grip, Hold};
use super::links::Links;
use super::model::Cloth;
use crate::contact::Contact;
use crate::fabric::GRAVITY;
use crate::geometry::Vec3;
use crate::parallel::{self, MEDIUM};

/// A stitch being closed (F5): both nodes pull each other with stiffness × min(gap, cap).
#[derive(Clone, Copy, Debug)]
pub struct Pull {
    /// The two nodes.
    pub ends: [u32; 2],
    /// N/m.
    pub stiffness: f64,
    /// Gap beyond which the force grows no more, metres.
    pub cap: f64,
}

impl Pull {
    /// Force over gap at `x`, N/m.
    pub(super) fn stiffness_at(&self, x: &[Vec3]) -> f64 {
        let gap = (x[self.ends[1] as usize] - x[self.ends[0] as usize]).norm();
        self.stiffness * (self.cap / gap.max(1e-12)).min(1.0)
    }
}

/// External forces: everything that acts on the cloth besides its own elasticity.
#[derive(Clone, Copy)]
pub struct Forces<'a> {
    /// Share of gravity, 0 … 1.
    pub gravity: f64,
    /// Contacts found at the last detection.
    pub contacts: &'a [Contact<'a>],
    /// Law of the contacts.
    pub law: ContactLaw,
    /// Stitches that are open.
    pub pulls: &'a [Pull],
    /// Friction of the contacts.
    pub friction: Option<&'a Friction>,
}

impl Forces<'_> {
    /// Normal force of one of the contacts, N.
    pub fn load(&self, cloth: &Cloth, x: &[Vec3], contact: &Contact) -> f64 {
        self.law.load(cloth, x, contact)
    }

    /// The friction spring of contact number `k` under `load` N. `None` where there is no friction or it is open.
    pub(super) fn hold(&self, cloth: &Cloth, x: &[Vec3], k: usize, load: f64) -> Option<Hold> {
        self.friction?.hold(k, &self.contacts[k], x, load, &cloth.friction)
    }

    /// Energy of elasticity, contact, weight and stored friction, J. Sliding friction has no energy of its own. It is
    /// modelled as a constant force at the normal forces `loads` (one per contact).
    pub(super) fn energy(&self, cloth: &Cloth, x: &[Vec3], loads: &[f64]) -> f64 {
        self.energy_with(cloth, x, loads, cloth.energy_of_elements(x))
    }

    /// The same where the energy of springs, threads and shears is known to be `elements`, J.
    pub(super) fn energy_with(&self, cloth: &Cloth, x: &[Vec3], loads: &[f64], elements: f64) -> f64 {
        let weight: f64 = cloth.mass.iter().zip(x).map(|(m, x)| m * x.y).sum::<f64>() * GRAVITY * self.gravity;
        let touching = parallel::sum(self.contacts.len(), MEDIUM, |k| {
            let hold = self.hold(cloth, x, k, loads[k]);
            self.law.energy(cloth, x, &self.contacts[k]) + hold.map_or(0.0, |hold| hold.energy(Vec3::zeros()))
        });
        elements + cloth.energy_of_folds(x) + touching + weight
    }

    /// The present normal force of every contact, N.
    pub(super) fn loads(&self, cloth: &Cloth, x: &[Vec3]) -> Vec<f64> {
        parallel::map(self.contacts.len(), MEDIUM, |k| self.load(cloth, x, &self.contacts[k]))
    }
}

/// All forces on the nodes at `x`, N.
pub(crate) fn cloth_forces(cloth: &Cloth, links: &Links, x: &[Vec3], forces: &Forces) -> Vec<Vec3> {
    let mut out = free_forces(cloth, links, x, forces);
    let pushes = parallel::map(forces.contacts.len(), MEDIUM, |k| {
        let load = forces.law.load(cloth, x, &forces.contacts[k]);
        (load > 0.0).then(|| (load, forces.hold(cloth, x, k, load).map(|hold| hold.grip())))
    });
    for (contact, push_of) in forces.contacts.iter().zip(pushes) {
        if let Some((load, grip)) = push_of {
            push(&mut out, contact, load, grip);
        }
    }
    out
}

/// Adds the normal force of a contact and its friction.
pub(super) fn push(out: &mut [Vec3], contact: &Contact, load: f64, grip: Option<Grip>) {
    let force = contact.normal * load + grip.map_or_else(Vec3::zeros, |g| g.force);
    for (i, w) in contact.parts() {
        out[i] += force * w;
    }
}

/// The forces without contact, N. `links` are those of `cloth`.
pub(super) fn free_forces(cloth: &Cloth, links: &Links, x: &[Vec3], forces: &Forces) -> Vec<Vec3> {
    let first = |i: usize| -cloth.bending.gradient(x, i) - Vec3::y() * (cloth.mass[i] * GRAVITY * forces.gravity);
    let mut out = links.forces(cloth, x, first);
    for crease in &cloth.creases {
        for (n, f) in crease.nodes.iter().zip(crease.forces(x)) {
            out[*n as usize] += f;
        }
    }
    for pull in forces.pulls {
        let f = (x[pull.ends[1] as usize] - x[pull.ends[0] as usize]) * pull.stiffness_at(x);
        out[pull.ends[0] as usize] += f;
        out[pull.ends[1] as usize] -= f;
    }
    out
}
