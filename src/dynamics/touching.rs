//! The stiffness of contacts that push, and the nodes that they push on.

use super::step::Pushing;
use crate::contact::Contact;
use crate::geometry::{Mat3, Vec3};
use crate::linear::BlockColumn;
use crate::parallel::{self, MEDIUM};

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

    /// Resistance of every contact against the displacements `p` of the nodes, N.
    pub(super) fn resist(&self, p: &[Vec3]) -> Vec<Vec3> {
        parallel::map(self.touches.len(), MEDIUM, |k| {
            let Touch { parts, stiffness } = &self.touches[k];
            stiffness * parts.iter().fold(Vec3::zeros(), |way, (n, w)| way + p[*n as usize] * *w)
        })
    }

    /// How each contact enters a matrix that couples only some nodes: with all its blocks, w wᵀ ⊗ K, if each pair of
    /// its nodes that are not held is `coupled`, otherwise by the bound (Σ|w|) diag(|w|) ⊗ K.
    pub(super) fn pressed(
        &self,
        is_held: impl Fn(u32) -> bool + Sync,
        coupled: impl Fn(u32, u32) -> bool + Sync,
    ) -> Vec<Pressed> {
        parallel::map(self.touches.len(), MEDIUM, |k| {
            let free = || self.touches[k].parts.iter().filter(|(n, w)| *w != 0.0 && !is_held(*n));
            let mut pairs = free().enumerate().flat_map(|(i, a)| free().skip(i + 1).map(move |b| (a.0, b.0)));
            if pairs.all(|(a, b)| coupled(a, b)) {
                Pressed::Whole
            } else {
                Pressed::Bound(free().map(|p| p.1.abs()).sum())
            }
        })
    }

    /// Adds the blocks of a node's contacts to its column.
    pub(super) fn fill(&self, pressed: &[Pressed], node: usize, column: &mut BlockColumn<f32>) {
        for (k, w) in self.at(node) {
            let Touch { parts, stiffness } = &self.touches[*k as usize];
            match pressed[*k as usize] {
                Pressed::Bound(whole) => column.add_diagonal(&(stiffness * (whole * w.abs()))),
                Pressed::Whole => {
                    column.add_diagonal(&(stiffness * (w * w)));
                    let later = parts.iter().filter(|(n, other)| *n as usize > node && *other != 0.0);
                    later.for_each(|(n, other)| column.add_below(*n, &(stiffness * (w * other))));
                }
            }
        }
    }

    fn at(&self, node: usize) -> &[(u32, f64)] {
        &self.at[self.starts[node] as usize..self.starts[node + 1] as usize]
    }

    /// The share of these `resistances` that a node has, N.
    pub(super) fn gather(&self, resistances: &[Vec3], node: usize) -> Vec3 {
        self.at(node).iter().fold(Vec3::zeros(), |sum, (k, w)| sum + resistances[*k as usize] * *w)
    }
}

/// How a contact enters the matrix of a step.
#[derive(Clone, Copy)]
pub(super) enum Pressed {
    /// With all its blocks.
    Whole,
    /// By diagonal blocks that bound them, from the sum of its weights.
    Bound(f64),
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
