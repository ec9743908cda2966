//! The forces on the cloth at given positions, and their energies.

use super::contact_law::ContactLaw;
use super::energy::{Energy, on_nodes};
use super::friction::{Friction, Grip, Hold};
use super::model::Cloth;
use super::pull::Pull;
use super::scattered::Scattered;
use super::weight::Weight;
use crate::contact::Contact;
use crate::geometry::Vec3;
use crate::parallel::{self, MEDIUM};

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

    /// The weight of `cloth`.
    pub(super) fn weight<'a>(&self, cloth: &'a Cloth) -> Weight<'a> {
        Weight { mass: &cloth.mass, share: self.gravity }
    }

    /// The stitches that are open, as an energy.
    pub(super) fn stitches(&self) -> Scattered<'_, Pull> {
        Scattered(self.pulls.into())
    }

    /// Energy of elasticity, contact, weight and stored friction, J. Sliding friction has no energy of its own. It is
    /// modelled as a constant force at the normal forces `loads` (one per contact).
    pub(super) fn energy(&self, cloth: &Cloth, x: &[Vec3], loads: &[f64]) -> f64 {
        self.energy_with(cloth, x, loads, cloth.elastic_energy(x))
    }

    /// The same where the energy of the cloth's own elasticity is known to be `elastic`, J.
    pub(super) fn energy_with(&self, cloth: &Cloth, x: &[Vec3], loads: &[f64], elastic: f64) -> f64 {
        let touching = parallel::sum(self.contacts.len(), MEDIUM, |k| {
            let hold = self.hold(cloth, x, k, loads[k]);
            self.law.energy(cloth, x, &self.contacts[k]) + hold.map_or(0.0, |hold| hold.energy(Vec3::zeros()))
        });
        elastic + touching + self.weight(cloth).energy(x)
    }

    /// The present normal force of every contact, N.
    pub(super) fn loads(&self, cloth: &Cloth, x: &[Vec3]) -> Vec<f64> {
        parallel::map(self.contacts.len(), MEDIUM, |k| self.load(cloth, x, &self.contacts[k]))
    }
}

/// All forces on the nodes at `x`, N.
pub(crate) fn cloth_forces(cloth: &Cloth, x: &[Vec3], forces: &Forces) -> Vec<Vec3> {
    let pushes = parallel::map(forces.contacts.len(), MEDIUM, |k| {
        let load = forces.law.load(cloth, x, &forces.contacts[k]);
        (load > 0.0).then(|| (load, forces.hold(cloth, x, k, load).map(|hold| hold.grip())))
    });
    let mut out = free_forces(cloth, x, forces);
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

/// The forces without contact, N.
pub(super) fn free_forces(cloth: &Cloth, x: &[Vec3], forces: &Forces) -> Vec<Vec3> {
    let (weight, stitches) = (forces.weight(cloth), forces.stitches());
    let all = (weight.forces(x), (cloth.elastic.forces(x), stitches.forces(x)));
    on_nodes(x.len(), |_| Vec3::zeros(), &all)
}
