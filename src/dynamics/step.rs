//! The linear system of an implicit step: every force linearised at the present position, one 3n×3n matrix.

use std::sync::Arc;

use super::contact_law::Press;
use super::force::{Forces, free_forces, push};
use super::foreseen::ElementTangent;
use super::friction::Grip;
use super::links::Links;
use super::model::{Cloth, Element};
use super::thread::shares;
use super::touching::Touching;
use crate::contact::Contact;
use crate::geometry::{Mat3, Vec3};
use crate::linear::{Cholesky, CholeskyError, PatternError, SymmetricMatrix, SymmetricPattern};
use crate::parallel::{self, MEDIUM};

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
    pub(super) links: Arc<Links>,
    matrix: SymmetricMatrix<f32>,
    pub(super) factor: Cholesky<f32>,
    /// Bound of bending at every node: [`Cloth::bending_bound`] of its edges, N/m.
    bending: Vec<f64>,
    /// Start of every node's edges to later nodes in [`Cloth::edges`], and their total.
    edges: Vec<u32>,
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
        let apart = |&[a, b]: &[u32; 2]| is_free(&[a, b]) && pattern.block_slot(a as usize, b as usize).is_none();
        for nodes in (0..cloth.elements()).map(|k| cloth.element(k).nodes()) {
            let pairs = (1..nodes.len()).flat_map(|j| (0..j).map(move |i| [nodes[i], nodes[j]]));
            if let Some([a, b]) = pairs.clone().find(apart) {
                return Err(StepError::Uncoupled { a: a as usize, b: b as usize });
            }
        }
        let (mut bending, mut edges) = (vec![0.0; n], vec![0u32; n + 1]);
        for ([a, b], bound) in cloth.edges.iter().map(|e| e.map(|n| n as usize)).zip(&cloth.bending_bound) {
            bending[a] += bound;
            bending[b] += bound;
            edges[a + 1] += 1;
        }
        (0..n).for_each(|i| edges[i + 1] += edges[i]);
        Ok(Self {
            links: Arc::new(Links::new(cloth)),
            bending,
            edges,
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
        let mut free = free_forces(cloth, &self.links, x, forces);
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
            let touching = Touching::new(forces.contacts, &pushing, x.len());
            self.prepare(cloth, x, dt, forces, (&pushing, &touching), SAME)?;
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
        (contacts, touching): (&Pushing, &Touching),
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
        self.assemble(cloth, x, dt, forces, touching);
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

    fn assemble(&mut self, cloth: &Cloth, x: &[Vec3], dt: f64, forces: &Forces, touching: &Touching) {
        let bounds = parallel::map(cloth.elements(), MEDIUM, |number| StiffnessBound::new(&cloth.tangent(number, x)));
        let pattern = self.matrix.pattern().clone();
        let coupled = |i: u32, j: u32| pattern.block_slot(i as usize, j as usize).is_some();
        let pressed = touching.pressed(|node| self.is_held[node as usize], coupled);
        let (links, bending, edges) = (&self.links, &self.bending, &self.edges);
        self.matrix.refill(|node, mut column| {
            column.add_diagonal(&(Mat3::identity() * (cloth.mass[node] / (dt * dt) + bending[node])));
            for k in edges[node] as usize..edges[node + 1] as usize {
                column.add_below(cloth.edges[k][1], &(Mat3::identity() * -cloth.bending_bound[k]));
            }
            for (number, corner) in links.at(node) {
                let element = cloth.element(number);
                for (k, &other) in element.nodes().iter().enumerate() {
                    if k == corner {
                        column.add_diagonal(&bounds[number].block(element, k, k));
                    } else if other as usize > node {
                        column.add_below(other, &bounds[number].block(element, k, corner));
                    }
                }
            }
            touching.fill(&pressed, node, &mut column);
        });
        self.add_creases(cloth, x);
        for pull in forces.pulls {
            let ([a, b], k) = (pull.ends.map(|n| n as usize), Mat3::identity() * pull.stiffness_at(x));
            self.add(a, a, &k);
            self.add(b, b, &k);
            self.add(a, b, &-k);
        }
    }

    fn add_creases(&mut self, cloth: &Cloth, x: &[Vec3]) {
        for crease in &cloth.creases {
            let (root, nodes) = (crease.root(x), crease.nodes.map(|n| n as usize));
            for i in 0..4 {
                for j in 0..=i {
                    self.add(nodes[i], nodes[j], &(root[i] * root[j].transpose()));
                }
            }
        }
    }

    /// Adds a block of two nodes. The pattern has it unless one of them is held.
    fn add(&mut self, i: usize, j: usize, block: &Mat3) {
        if let Some(slot) = self.matrix.pattern().block_slot(i, j) {
            self.matrix.add_block(slot, block);
        }
    }
}

/// Positive semidefinite bound of an element's stiffness.
enum StiffnessBound {
    /// Of a spring or thread: per displacement of one end.
    Stretch(Mat3),
    /// Of a shear: [`super::shear::ShearTangent::bound`].
    Shear([Vec3; 2], [f64; 2]),
}

impl StiffnessBound {
    fn new(tangent: &ElementTangent) -> Self {
        match tangent {
            ElementTangent::Stretch(tangent) => Self::Stretch(tangent.bound()),
            ElementTangent::Shear(tangent) => {
                let (root, drawn) = tangent.bound();
                Self::Shear(root, drawn)
            }
        }
    }

    /// The block of nodes number `i` (rows) and `j` (columns) of the element.
    fn block(&self, element: Element, i: usize, j: usize) -> Mat3 {
        match (self, element) {
            (Self::Stretch(stiffness), Element::Thread(thread)) => {
                let shares = thread.shares();
                stiffness * (shares[i] * shares[j])
            }
            (Self::Stretch(stiffness), _) => stiffness * if i == j { 1.0 } else { -1.0 },
            (Self::Shear(root, drawn), Element::Shear(shear)) => {
                let (root, [one, other]) = (shear.at_nodes(*root), shear.legs.map(shares));
                let drawn = drawn[0] * one[i] * one[j] + drawn[1] * other[i] * other[j];
                root[i] * root[j].transpose() + Mat3::identity() * drawn
            }
            (Self::Shear(..), _) => Mat3::zeros(),
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
    parallel::map(forces.contacts.len(), MEDIUM, |k| forces.law.press(cloth, x, &forces.contacts[k]))
}

/// Growth of a contact's gap by the step `d`, metres.
pub(super) fn opening(contact: &Contact, d: &[Vec3]) -> f64 {
    contact.parts().map(|(i, w)| w * contact.normal.dot(&d[i])).sum()
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
