//! Coulomb friction against the body with stored anchors.

use crate::contact::Contact;
use crate::geometry::Vec3;

/// Where every node sticks to the body: a tangential spring from the anchor holds up to μ times the normal force; beyond
/// that the anchor is dragged along. Anchors that are stored (not set anew every step) are what lets a garment rest.
#[derive(Clone, Debug)]
pub struct Friction {
    /// Tangential stiffness, N/m.
    stiffness: f64,
    anchors: Vec<Option<Vec3>>,
}

/// The friction on one node in one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grip {
    /// Force on the node, N.
    pub(super) force: Vec3,
    /// Stiffness across the normal, N/m.
    pub(super) stiffness: f64,
}

impl Friction {
    /// No node touches yet.
    pub fn new(nodes: usize, stiffness: f64) -> Self {
        Self { stiffness, anchors: vec![None; nodes] }
    }

    /// The node that a contact grips, and how, for the normal force `load` and the nodes' coefficients `mu`; `None` for
    /// contacts that grip nothing: within the cloth, of faces and edges (their nodes have their own), and open ones.
    pub(super) fn grip(&self, contact: &Contact, x: &[Vec3], load: f64, mu: &[f64]) -> Option<(usize, Grip)> {
        if !contact.body || contact.count != 1 || load <= 0.0 {
            return None;
        }
        let i = contact.nodes[0] as usize;
        let Some(anchor) = self.anchors[i] else {
            return Some((i, Grip { force: Vec3::zeros(), stiffness: self.stiffness }));
        };
        let slip = tangential(x[i] - anchor, contact.normal);
        let pull = self.stiffness * slip.norm();
        let share = if pull > mu[i] * load { mu[i] * load / pull } else { 1.0 };
        Some((i, Grip { force: slip * (-self.stiffness * share), stiffness: self.stiffness * share }))
    }

    /// Energy of the anchors' springs, J, for the given normal forces (one per contact): a quadratic while the node
    /// sticks, a constant force beyond.
    pub(super) fn energy(&self, x: &[Vec3], contacts: &[Contact], loads: &[f64], mu: &[f64]) -> f64 {
        let held = contacts.iter().zip(loads).filter(|(c, load)| c.body && c.count == 1 && **load > 0.0);
        held.map(|(contact, load)| {
            let i = contact.nodes[0] as usize;
            let Some(anchor) = self.anchors[i] else { return 0.0 };
            let slip = tangential(x[i] - anchor, contact.normal).norm();
            let stuck = slip.min(mu[i] * load / self.stiffness);
            self.stiffness * stuck * (slip - 0.5 * stuck)
        })
        .sum()
    }

    /// Takes the anchors along after a step: a node that touches for the first time gets one, one that slipped drags
    /// it, one that left loses it. `load(contact)` is the normal force.
    pub fn update(&mut self, x: &[Vec3], contacts: &[Contact], mu: &[f64], load: impl Fn(&Contact) -> f64) {
        let mut touching = vec![false; self.anchors.len()];
        for contact in contacts.iter().filter(|c| c.body && c.count == 1) {
            let i = contact.nodes[0] as usize;
            let normal_force = load(contact);
            if normal_force <= 0.0 {
                continue;
            }
            touching[i] = true;
            let anchor = self.anchors[i].get_or_insert(x[i]);
            let slip = tangential(x[i] - *anchor, contact.normal);
            let (pull, most) = (self.stiffness * slip.norm(), mu[i] * normal_force);
            if pull > most {
                *anchor += slip * (1.0 - most / pull);
            }
        }
        for (anchor, touches) in self.anchors.iter_mut().zip(touching) {
            if !touches {
                *anchor = None;
            }
        }
    }
}

fn tangential(v: Vec3, n: Vec3) -> Vec3 {
    v - n * n.dot(&v)
}
