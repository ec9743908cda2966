//! The linear system of an implicit step: every force linearised at the present position, one 3n×3n matrix.

use std::sync::Arc;

use rayon::prelude::*;

use super::contact_law::Press;
use super::force::{Forces, free_forces, push};
use super::friction::Grip;
use super::model::Cloth;
use super::thread::shares;
use crate::contact::Contact;
use crate::geometry::{Mat3, Vec3};
use crate::linear::{BlockSlot, Cholesky, CholeskyError, PatternError, SymmetricMatrix, SymmetricPattern};

/// Why a step cannot be made.
#[derive(Clone, Debug, thiserror::Error)]
pub enum StepError {
    /// The system's pattern cannot be built.
    #[error(transparent)]
    Pattern(#[from] PatternError),
    /// Its factor cannot be analysed.
    #[error(transparent)]
    Analysis(#[from] CholeskyError),
    /// The matrix is not positive definite, nor with a thousandth more on its diagonal.
    #[error("the step's matrix is singular near particle {node}: what holds it there is not finite, or too stiff")]
    Singular {
        /// The node.
        node: usize,
    },
    /// The matrix pattern lacks a pair of coupled particles: a bug in toile.
    #[error("the step's matrix has no place for particles {a} and {b}, which the cloth couples; please report this")]
    Uncoupled {
        /// The one.
        a: usize,
        /// The other.
        b: usize,
    },
}

/// Error of a predicted gap below which a contact is no reason to solve the step again, metres.
const MISJUDGED: f64 = 1e-4;

/// Limits within which an older factor is used again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reuse {
    /// Largest distance of a node from its position when the factor was made, metres.
    pub(super) moved: f64,
    /// Largest number of contacts that have begun or ceased to push. If it is 0, contacts that began or ceased to slide
    /// count as well.
    pub(super) contacts: usize,
}

/// Reuse for a step that is solved by the factor alone, and must therefore be exact. A motion of a five-hundredth of a
/// cell turns springs by a tenth of a degree.
const SAME: Reuse = Reuse { moved: 2e-5, contacts: 0 };

/// Regularisation of a matrix that is singular to rounding: shares of its diagonal that are added one after another.
/// The first is a few units in the last place of single precision.
const RIDGES: [f64; 4] = [3e-7, 3e-6, 3e-5, 3e-4];

/// The linear system of a cloth, analysed once, filled and factored for every step.
pub struct Stepper {
    matrix: SymmetricMatrix<f32>,
    pub(super) factor: Cholesky<f32>,
    diagonal: Vec<BlockSlot>,
    /// Slot of every spring. `None` if an end is held: the other end then feels a wall.
    springs: Vec<Option<BlockSlot>>,
    /// Slots of every thread, between its nodes 0 and 1, 0 and 2, 1 and 2.
    threads: Vec<[Option<BlockSlot>; 3]>,
    /// Slots of every shear, between its nodes 0 and 1, 0 and 2, 1 and 2.
    shears: Vec<[Option<BlockSlot>; 3]>,
    edges: Vec<Option<BlockSlot>>,
    pulls: Vec<Option<BlockSlot>>,
    /// Whether a node is one of [`Cloth::held`].
    is_held: Vec<bool>,
    made: Option<Made>,
}

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
    fn nodes(&self, contacts: &[Contact]) -> Vec<[u32; 4]> {
        sorted(self.numbers().map(|k| contacts[k].nodes).collect())
    }

    /// Nodes of the active contacts that slide, sorted.
    fn sliding(&self, contacts: &[Contact]) -> Vec<[u32; 4]> {
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

/// The state that a factor was made for.
struct Made {
    x: Vec<Vec3>,
    dt: f64,
    /// Nodes of the contacts that pushed, sorted.
    pushing: Vec<[u32; 4]>,
    sliding: Vec<[u32; 4]>,
}

impl Stepper {
    /// Prepares the system of `cloth` with stitches between `pulls` and contacts that couple the nodes in `touching`
    /// (pairs, smaller first). A contact without couplings is bounded by a diagonal: it slows its nodes, but gives no
    /// wrong solution.
    ///
    /// # Errors
    /// A cloth too large for 32-bit indices.
    pub fn new(cloth: &Cloth, pulls: &[[u32; 2]], touching: &[[u32; 2]]) -> Result<Self, StepError> {
        let n = cloth.mass.len();
        let is_held = cloth.is_held();
        let is_free = |[a, b]: &[u32; 2]| !is_held[*a as usize] && !is_held[*b as usize];
        // The wings of a crease are the only nodes of it without a spring between them.
        let wings = cloth.creases.iter().map(|c| [c.nodes[2], c.nodes[3]]);
        let graph = cloth.edges.iter().chain(pulls).chain(touching).copied().chain(wings).filter(is_free);
        let pattern = Arc::new(SymmetricPattern::blocks(n, graph.map(|[a, b]| (a as usize, b as usize)))?);
        let slot = |[a, b]: [u32; 2]| pattern.block_slot(a as usize, b as usize);
        let find = |pair @ [a, b]: [u32; 2]| match slot(pair) {
            None if is_free(&pair) => Err(StepError::Uncoupled { a: a as usize, b: b as usize }),
            slot => Ok(slot),
        };
        let sides = |[a, b, c]: [u32; 3]| Ok([find([a, b])?, find([a, c])?, find([b, c])?]);
        Ok(Self {
            diagonal: (0..n as u32).filter_map(|i| slot([i, i])).collect(),
            springs: cloth.springs.iter().map(|s| find(s.ends)).collect::<Result<_, _>>()?,
            threads: cloth.threads.iter().map(|t| sides(t.nodes)).collect::<Result<_, StepError>>()?,
            shears: cloth.shears.iter().map(|s| sides(s.nodes)).collect::<Result<_, StepError>>()?,
            edges: cloth.edges.iter().map(|e| find(*e)).collect::<Result<_, _>>()?,
            pulls: pulls.iter().map(|e| slot(*e)).collect(),
            matrix: SymmetricMatrix::zeros(pattern.clone()),
            factor: Cholesky::new(pattern)?,
            is_held,
            made: None,
        })
    }

    /// The step d with (M/Δt² + H) d = f(x) + M v/Δt.
    ///
    /// H is a majorant of the stiffness at `x`: compressed springs lose their negative part, and bending is bounded
    /// edge by edge. v is `velocity`. Contacts that push at the end of the step are found by solving up to `rounds`
    /// times (a primal–dual active set).
    ///
    /// # Errors
    /// [`StepError::Singular`] when a number is not finite.
    pub fn solve(
        &mut self,
        cloth: &Cloth,
        x: &[Vec3],
        velocity: &[Vec3],
        dt: f64,
        forces: &Forces,
        rounds: usize,
    ) -> Result<Vec<Vec3>, StepError> {
        let mut free = free_forces(cloth, x, forces);
        for ((f, v), m) in free.iter_mut().zip(velocity).zip(&cloth.mass) {
            *f += v * (m / dt);
        }
        let presses = presses(cloth, x, forces);
        let grips: Vec<Option<Grip>> =
            presses.iter().enumerate().map(|(k, p)| Some(forces.hold(cloth, x, k, p.load)?.grip())).collect();
        let mut active: Vec<bool> = presses.iter().map(|p| p.load > 0.0).collect();
        let mut round = 1;
        loop {
            let pushing = Pushing { presses: &presses, active: &active, grips: &grips };
            self.prepare(cloth, x, dt, forces, &pushing, SAME)?;
            let d = self.apply_inverse(&pushing.forces(&free, forces))?;
            let mut misjudged = false;
            for ((contact, press), on) in forces.contacts.iter().zip(&presses).zip(&mut active) {
                let left = press.after(opening(contact, &d));
                if (left > 0.0) != *on {
                    misjudged |= left.abs() > MISJUDGED * press.slope;
                    *on = left > 0.0;
                }
            }
            if !misjudged || round >= rounds {
                return Ok(d);
            }
            round += 1;
        }
    }

    /// Solves H d = r for the nodes that are not held.
    pub(super) fn apply_inverse(&self, r: &[Vec3]) -> Result<Vec<Vec3>, StepError> {
        let mut flat: Vec<f32> = r.iter().flat_map(|v| [v.x as f32, v.y as f32, v.z as f32]).collect();
        let hold = |flat: &mut [f32]| {
            flat.chunks_exact_mut(3).zip(&self.is_held).filter(|(_, held)| **held).for_each(|(f, _)| f.fill(0.0));
        };
        hold(&mut flat);
        self.factor.solve(&mut flat);
        hold(&mut flat);
        let d: Vec<Vec3> = flat.chunks_exact(3).map(|c| Vec3::new(c[0].into(), c[1].into(), c[2].into())).collect();
        match d.iter().position(|v| !v.iter().all(|c| c.is_finite())) {
            Some(node) => Err(StepError::Singular { node }),
            None => Ok(d),
        }
    }

    /// Factors M/Δt² + H at `x` for the active contacts, unless an older factor may be used again.
    pub(super) fn prepare(
        &mut self,
        cloth: &Cloth,
        x: &[Vec3],
        dt: f64,
        forces: &Forces,
        contacts: &Pushing,
        reuse: Reuse,
    ) -> Result<(), StepError> {
        let pushing = contacts.nodes(forces.contacts);
        if let Some(made) = &self.made {
            let near = || made.x.iter().zip(x).all(|(a, b)| (a - b).norm_squared() < reuse.moved * reuse.moved);
            let same = || {
                differences(&made.pushing, &pushing) <= reuse.contacts
                    && (reuse.contacts > 0 || made.sliding == contacts.sliding(forces.contacts))
            };
            if forces.pulls.is_empty() && made.dt == dt && near() && same() {
                return Ok(());
            }
        }
        self.made = None;
        self.assemble(cloth, x, dt, forces);
        for k in contacts.numbers() {
            let normal = forces.contacts[k].normal;
            let mut stiffness = normal * normal.transpose() * contacts.presses[k].slope;
            if let Some(grip) = contacts.grips[k] {
                stiffness += grip.stiffness;
            }
            self.add_contact(&forces.contacts[k], &stiffness);
        }
        self.factor()?;
        self.made = Some(Made { x: x.to_vec(), dt, pushing, sliding: contacts.sliding(forces.contacts) });
        Ok(())
    }

    /// Discards the factor. Call it when spring loads or the contact law change, on which the matrix depends beside
    /// positions and contacts.
    pub(super) fn forget(&mut self) {
        self.made = None;
    }

    /// Factors the matrix, with a regularised diagonal if it is singular to single precision.
    ///
    /// Two kinds of matrix are: those of cloth that nothing holds, in a long step (inertia is lost beside stiffness),
    /// and those with a node that contacts press so hard that its springs are lost. Rounding takes a share of each
    /// diagonal entry. Adding a little more than that makes the matrix positive definite, and slows each node in
    /// proportion to its own stiffness only.
    fn factor(&mut self) -> Result<(), StepError> {
        let Err(mut failed) = self.factor.factor(&self.matrix) else { return Ok(()) };
        for ridge in RIDGES {
            self.matrix.strengthen_diagonal(ridge);
            match self.factor.factor(&self.matrix) {
                Ok(()) => return Ok(()),
                Err(again) => failed = again,
            }
        }
        Err(StepError::Singular { node: failed.dof / 3 })
    }

    fn assemble(&mut self, cloth: &Cloth, x: &[Vec3], dt: f64, forces: &Forces) {
        self.matrix.clear();
        let blocks: Vec<Mat3> = (0..cloth.springs.len())
            .into_par_iter()
            .with_min_len(super::ONE_THREAD)
            .map(|k| cloth.spring_tangent(k, x).bound())
            .collect();
        for ((s, slot), k) in cloth.springs.iter().zip(&self.springs).zip(&blocks) {
            couple(&mut self.matrix, &self.diagonal, s.ends, *slot, k);
        }
        self.assemble_threads(cloth, x);
        self.assemble_shears(cloth, x);
        for ((e, slot), w) in cloth.edges.iter().zip(&self.edges).zip(&cloth.bending_bound) {
            couple(&mut self.matrix, &self.diagonal, *e, *slot, &(Mat3::identity() * *w));
        }
        for crease in &cloth.creases {
            let root = crease.root(x);
            let nodes = crease.nodes.map(|n| n as usize);
            for i in 0..4 {
                self.matrix.add_block(self.diagonal[nodes[i]], &(root[i] * root[i].transpose()));
                for j in 0..i {
                    if let Some(slot) = self.matrix.pattern().block_slot(nodes[i], nodes[j]) {
                        self.matrix.add_block(slot, &(root[i] * root[j].transpose()));
                    }
                }
            }
        }
        for (pull, slot) in forces.pulls.iter().zip(&self.pulls) {
            let k = Mat3::identity() * pull.stiffness_at(x);
            couple(&mut self.matrix, &self.diagonal, pull.ends, *slot, &k);
        }
        for (i, m) in cloth.mass.iter().enumerate() {
            self.matrix.add_block(self.diagonal[i], &(Mat3::identity() * (m / (dt * dt))));
        }
    }

    fn assemble_threads(&mut self, cloth: &Cloth, x: &[Vec3]) {
        for (k, (thread, slots)) in cloth.threads.iter().zip(&self.threads).enumerate() {
            let (stiffness, shares) = (cloth.thread_tangent(k, x).bound(), thread.shares());
            couple_three(&mut self.matrix, &self.diagonal, thread.nodes, slots, |i, j| {
                stiffness * (shares[i] * shares[j])
            });
        }
    }

    fn assemble_shears(&mut self, cloth: &Cloth, x: &[Vec3]) {
        for (k, (shear, slots)) in cloth.shears.iter().zip(&self.shears).enumerate() {
            let (root, drawn) = cloth.shear_tangent(k, x).bound();
            let (root, [one, other]) = (shear.at_nodes(root), shear.legs.map(shares));
            couple_three(&mut self.matrix, &self.diagonal, shear.nodes, slots, |i, j| {
                let drawn = drawn[0] * one[i] * one[j] + drawn[1] * other[i] * other[j];
                root[i] * root[j].transpose() + Mat3::identity() * drawn
            });
        }
    }

    /// Adds w wᵀ ⊗ K of the nodes that are not held if the pattern has all its blocks, otherwise its bound
    /// (Σ|w|) diag(|w|) ⊗ K.
    fn add_contact(&mut self, contact: &Contact, stiffness: &Mat3) {
        let parts = || contact.parts().filter(|&(i, w)| w != 0.0 && !self.is_held[i]);
        let mut blocks: [Option<(BlockSlot, f64)>; 6] = [None; 6];
        let mut count = 0;
        let mut complete = true;
        for (a, (i, wi)) in parts().enumerate() {
            for (j, wj) in parts().skip(a + 1) {
                let slot = self.matrix.pattern().block_slot(i, j);
                complete &= slot.is_some();
                blocks[count] = slot.map(|slot| (slot, wi * wj));
                count += 1;
            }
        }
        let whole: f64 = parts().map(|p| p.1.abs()).sum();
        for (i, w) in parts() {
            let w = if complete { w * w } else { whole * w.abs() };
            self.matrix.add_block(self.diagonal[i], &(stiffness * w));
        }
        for (slot, w) in blocks.into_iter().flatten().filter(|_| complete) {
            self.matrix.add_block(slot, &(stiffness * w));
        }
    }
}

fn sorted(mut nodes: Vec<[u32; 4]>) -> Vec<[u32; 4]> {
    nodes.sort_unstable();
    nodes
}

/// Entries of two sorted lists that the other does not have.
fn differences(a: &[[u32; 4]], b: &[[u32; 4]]) -> usize {
    let (mut i, mut j, mut common) = (0, 0, 0);
    while i < a.len() && j < b.len() {
        match a[i].cmp(&b[j]) {
            std::cmp::Ordering::Less => i += 1,
            std::cmp::Ordering::Greater => j += 1,
            std::cmp::Ordering::Equal => (i, j, common) = (i + 1, j + 1, common + 1),
        }
    }
    a.len() + b.len() - 2 * common
}

/// Loads and slopes of all contacts at `x`.
pub(super) fn presses(cloth: &Cloth, x: &[Vec3], forces: &Forces) -> Vec<Press> {
    forces.contacts.iter().map(|c| forces.law.press(cloth, x, c)).collect()
}

/// Growth of a contact's gap by the step `d`, metres.
pub(super) fn opening(contact: &Contact, d: &[Vec3]) -> f64 {
    contact.parts().map(|(i, w)| w * contact.normal.dot(&d[i])).sum()
}

/// Adds the blocks of three nodes, `block(i, j)` for the i-th and the j-th. `slots` are those of nodes 0 and 1, 0 and
/// 2, 1 and 2.
fn couple_three(
    matrix: &mut SymmetricMatrix<f32>,
    diagonal: &[BlockSlot],
    nodes: [u32; 3],
    slots: &[Option<BlockSlot>; 3],
    block: impl Fn(usize, usize) -> Mat3,
) {
    for (i, node) in nodes.into_iter().enumerate() {
        matrix.add_block(diagonal[node as usize], &block(i, i));
    }
    for (slot, [i, j]) in slots.iter().zip([[0, 1], [0, 2], [1, 2]]) {
        if let Some(slot) = slot {
            matrix.add_block(*slot, &block(i, j));
        }
    }
}

/// Adds the stiffness `k` between two nodes. They have a slot unless one of them is held.
fn couple(
    matrix: &mut SymmetricMatrix<f32>,
    diagonal: &[BlockSlot],
    ends: [u32; 2],
    slot: Option<BlockSlot>,
    k: &Mat3,
) {
    matrix.add_block(diagonal[ends[0] as usize], k);
    matrix.add_block(diagonal[ends[1] as usize], k);
    if let Some(slot) = slot {
        matrix.add_block(slot, &(-k));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::bending::Bending;
    use crate::dynamics::contact_law::{ContactLaw, Hardening};
    use crate::dynamics::foreseen::Loads;
    use crate::dynamics::springs::{Spring, Stretch, StretchLaw};

    /// Two nodes of 1 g with a spring of 10 mm between them.
    fn spring() -> Cloth {
        Cloth {
            node_of: vec![0, 1],
            mass: vec![1e-3; 2],
            triangles: Vec::new(),
            flat: Vec::new(),
            piece: Vec::new(),
            springs: vec![Spring { ends: [0, 1], stretch: Stretch { rest: 0.01, width: 0.01, law: 0 } }],
            laws: vec![StretchLaw::linear(500.0)],
            threads: Vec::new(),
            shears: Vec::new(),
            bending: Bending::new(2, &[]),
            creases: Vec::new(),
            edges: vec![[0, 1]],
            half_thickness: vec![0.0; 2],
            friction: vec![0.0; 2],
            bending_bound: vec![0.0],
            held: Vec::new(),
            foreseen: Loads::default(),
        }
    }

    #[test]
    fn a_matrix_of_other_loads_is_used_again_until_it_is_forgotten() {
        let (mut cloth, x) = (spring(), [Vec3::zeros(), Vec3::x() * 0.0105]);
        let law = ContactLaw { stiffness: 1.0, hardening: Hardening::Slow, body_clearance: 1e-3, cloth_gap: None };
        let forces = Forces { gravity: 0.0, contacts: &[], law, pulls: &[], friction: None };
        // Across the spring, where its load is the stiffness.
        let across = [Vec3::zeros(), Vec3::y() * 0.1];
        let step = |stepper: &mut Stepper, cloth: &Cloth| {
            stepper.solve(cloth, &x, &across, 0.1, &forces, 1).expect("a step")[1].y
        };
        let mut stepper = Stepper::new(&cloth, &[], &[]).expect("a stepper");
        let drawn = step(&mut stepper, &cloth);
        // As if a step had foreseen no load at all.
        cloth.follow(&x, cloth.foresee(&[Vec3::zeros(), Vec3::x() * 0.01], &[Vec3::zeros(), Vec3::x() * 0.01]).loads);
        let fresh = step(&mut Stepper::new(&cloth, &[], &[]).expect("a stepper"), &cloth);
        assert!(fresh > 1.01 * drawn, "{fresh} against {drawn}: the test would see nothing");
        assert_eq!(step(&mut stepper, &cloth), drawn);
        stepper.forget();
        assert_eq!(step(&mut stepper, &cloth), fresh);
    }
}
