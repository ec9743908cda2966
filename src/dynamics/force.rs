//! The forces on the cloth at given positions, and their energies.

use rayon::prelude::*;

use super::contact_law::ContactLaw;
use super::friction::{Friction, Grip, Hold};
use super::model::Cloth;
use crate::contact::Contact;
use crate::fabric::GRAVITY;
use crate::geometry::Vec3;

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
        let weight: f64 = cloth.mass.iter().zip(x).map(|(m, x)| m * x.y).sum::<f64>() * GRAVITY * self.gravity;
        let pressed: f64 = self.contacts.iter().map(|c| self.law.energy(cloth, x, c)).sum();
        let gripped = self.friction.map_or(0.0, |f| f.energy(x, self.contacts, loads, &cloth.friction));
        cloth.elastic_energy(x) + pressed + weight + gripped
    }
}

/// All forces on the nodes at `x`, N.
pub(crate) fn cloth_forces(cloth: &Cloth, x: &[Vec3], forces: &Forces) -> Vec<Vec3> {
    let mut out = free_forces(cloth, x, forces);
    for k in 0..forces.contacts.len() {
        let load = forces.law.load(cloth, x, &forces.contacts[k]);
        if load > 0.0 {
            let grip = forces.hold(cloth, x, k, load).map(|hold| hold.grip());
            push(&mut out, &forces.contacts[k], load, grip);
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
    let mut out: Vec<Vec3> = (0..x.len())
        .into_par_iter()
        .with_min_len(super::ONE_THREAD)
        .map(|i| -cloth.bending.gradient(x, i) - Vec3::y() * (cloth.mass[i] * GRAVITY * forces.gravity))
        .collect();
    for s in &cloth.springs {
        let f = s.stretch.pull(&cloth.laws[s.stretch.law as usize], s.span(x));
        out[s.ends[0] as usize] += f;
        out[s.ends[1] as usize] -= f;
    }
    for t in &cloth.threads {
        let f = t.stretch.pull(&cloth.laws[t.stretch.law as usize], t.span(x));
        for (n, share) in t.nodes.iter().zip(t.shares()) {
            out[*n as usize] -= f * share;
        }
    }
    for shear in &cloth.shears {
        for (n, f) in shear.nodes.iter().zip(shear.forces(x)) {
            out[*n as usize] += f;
        }
    }
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
