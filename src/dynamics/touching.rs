//! The stiffness of contacts that push, and the nodes that they push on.

use super::contact_law::Press;
use super::energy::{Bound, Exerted, Stiffness};
use super::force::{Forces, push};
use super::friction::Grip;
use super::model::Cloth;
use crate::contact::Contact;
use crate::geometry::{Mat3, Vec3};
use crate::linear::BlockColumn;
use crate::parallel::{self, MEDIUM};

/// Contacts in the linear model of a step.
pub(super) struct Pushing<'a> {
    /// Loads and slopes.
    pub(super) presses: &'a [Press],
    /// The active set: whether a contact pushes at the end of the step.
    pub(super) active: &'a [bool],
    /// Friction.
    pub(super) grips: &'a [Option<Grip>],
}

impl Pushing<'_> {
    /// Numbers of the active contacts.
    pub(super) fn numbers(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.active.len()).filter(|&k| self.active[k])
    }

    /// Nodes of the active contacts, sorted. A contact keeps its nodes, but not its number, from one search to the
    /// next.
    pub(super) fn nodes(&self, contacts: &[Contact]) -> Vec<[u32; 4]> {
        sorted(self.numbers().map(|k| contacts[k].nodes).collect())
    }

    /// Nodes of the active contacts that slide, sorted.
    pub(super) fn sliding(&self, contacts: &[Contact]) -> Vec<[u32; 4]> {
        let slides = |k: &usize| self.grips[*k].is_some_and(|g| g.slides);
        sorted(self.numbers().filter(slides).map(|k| contacts[k].nodes).collect())
    }

    /// `free` plus the loads and friction of the active contacts.
    pub(super) fn forces(&self, free: &[Vec3], forces: &Forces) -> Vec<Vec3> {
        let mut out = free.to_vec();
        for k in self.numbers() {
            push(&mut out, &forces.contacts[k], self.presses[k].load, self.grips[k]);
        }
        out
    }
}

/// A contact in the linear model of a step.
struct Touch {
    /// Its nodes and their weights. The weight of a node that is not in use is 0.
    parts: [(u32, f64); 4],
    /// N/m, against a displacement of the contact.
    stiffness: Mat3,
}

/// The active contacts of a step. Each is evaluated by itself, and then every node gathers from its own.
pub(super) struct Touching {
    touches: Vec<Touch>,
    /// Start of every node's entries in `at`, and their total.
    starts: Vec<u32>,
    /// Number of a touch, and the weight of the node in it.
    at: Vec<(u32, f64)>,
}

impl Touching {
    /// The contacts in `pushing` among `nodes` nodes.
    pub(super) fn new(contacts: &[Contact], pushing: &Pushing, nodes: usize) -> Self {
        let touches: Vec<Touch> = pushing.numbers().map(|k| Touch::new(&contacts[k], pushing, k)).collect();
        let mut starts = vec![0u32; nodes + 1];
        let parts = || touches.iter().zip(0u32..).flat_map(|(t, k)| t.parts.map(|(n, w)| (k, n as usize, w)));
        let used = || parts().filter(|part| part.2 != 0.0);
        used().for_each(|(_, n, _)| starts[n + 1] += 1);
        for n in 0..nodes {
            starts[n + 1] += starts[n];
        }
        let mut at = vec![(0, 0.0); starts[nodes] as usize];
        let mut next = starts.clone();
        for (k, n, w) in used() {
            at[next[n] as usize] = (k, w);
            next[n] += 1;
        }
        Self { touches, starts, at }
    }

    /// How each contact enters a matrix that couples only some nodes: with all its blocks, w wᵀ ⊗ K, if each pair of
    /// its nodes that are not held is `coupled`, otherwise by the bound (Σ|w|) diag(|w|) ⊗ K.
    pub(super) fn bound(
        &self,
        is_held: impl Fn(u32) -> bool + Sync,
        coupled: impl Fn(u32, u32) -> bool + Sync,
    ) -> impl Bound + '_ {
        let pressed = parallel::map(self.touches.len(), MEDIUM, |k| {
            let free = || self.touches[k].parts.iter().filter(|(n, w)| *w != 0.0 && !is_held(*n));
            let mut pairs = free().enumerate().flat_map(|(i, a)| free().skip(i + 1).map(move |b| (a.0, b.0)));
            if pairs.all(|(a, b)| coupled(a, b)) {
                Pressed::Whole
            } else {
                Pressed::Bound(free().map(|p| p.1.abs()).sum())
            }
        });
        PressedBound { touching: self, pressed }
    }

    fn at(&self, node: usize) -> &[(u32, f64)] {
        &self.at[self.starts[node] as usize..self.starts[node + 1] as usize]
    }
}

/// How a contact enters the matrix of a step.
#[derive(Clone, Copy)]
enum Pressed {
    /// With all its blocks.
    Whole,
    /// By diagonal blocks that bound them, from the sum of its weights.
    Bound(f64),
}

/// Bound of the stiffness of contacts.
struct PressedBound<'a> {
    touching: &'a Touching,
    pressed: Vec<Pressed>,
}

impl Bound for PressedBound<'_> {
    fn gather(&self, node: usize, column: &mut BlockColumn<f32>) {
        for (k, w) in self.touching.at(node) {
            let Touch { parts, stiffness } = &self.touching.touches[*k as usize];
            match self.pressed[*k as usize] {
                Pressed::Bound(whole) => column.add_diagonal(&(stiffness * (whole * w.abs()))),
                Pressed::Whole => {
                    column.add_diagonal(&(stiffness * (w * w)));
                    let later = parts.iter().filter(|(n, other)| *n as usize > node && *other != 0.0);
                    later.for_each(|(n, other)| column.add_below(*n, &(stiffness * (w * other))));
                }
            }
        }
    }
}

/// Resistance of every contact to displacements, N.
struct ContactResistance<'a> {
    touching: &'a Touching,
    of_contacts: Vec<Vec3>,
}

impl Exerted for ContactResistance<'_> {
    fn gather(&self, node: usize, sum: Vec3) -> Vec3 {
        let shares = self.touching.at(node).iter().map(|(k, w)| self.of_contacts[*k as usize] * *w);
        sum + shares.fold(Vec3::zeros(), |sum, share| sum + share)
    }
}

impl Stiffness for Touching {
    fn times<'a>(&'a self, p: &'a [Vec3]) -> impl Exerted + 'a {
        let of_contacts = parallel::map(self.touches.len(), MEDIUM, |k| {
            let Touch { parts, stiffness } = &self.touches[k];
            stiffness * parts.iter().fold(Vec3::zeros(), |way, (n, w)| way + p[*n as usize] * *w)
        });
        ContactResistance { touching: self, of_contacts }
    }
}

impl Touch {
    /// Contact number `k`.
    fn new(contact: &Contact, pushing: &Pushing, k: usize) -> Self {
        let mut parts = [(0, 0.0); 4];
        parts.iter_mut().zip(contact.parts()).for_each(|(out, (node, w))| *out = (node as u32, w));
        let normal = contact.normal;
        let grip = pushing.grips[k].map_or_else(Mat3::zeros, |g| g.stiffness);
        Self { parts, stiffness: normal * normal.transpose() * pushing.presses[k].slope + grip }
    }
}

fn sorted(mut nodes: Vec<[u32; 4]>) -> Vec<[u32; 4]> {
    nodes.sort_unstable();
    nodes
}

/// Loads and slopes of all contacts at `x`.
pub(super) fn presses(cloth: &Cloth, x: &[Vec3], forces: &Forces) -> Vec<Press> {
    parallel::map(forces.contacts.len(), MEDIUM, |k| forces.law.press(cloth, x, &forces.contacts[k]))
}

/// Growth of a contact's gap by the step `d`, metres.
pub(super) fn opening(contact: &Contact, d: &[Vec3]) -> f64 {
    contact.parts().map(|(i, w)| w * contact.normal.dot(&d[i])).sum()
}
