//! The linear system of an implicit step: every force linearised at the present position, one 3n×3n matrix.

use std::sync::Arc;

use super::energy::{Energy, fill};
use super::force::{Forces, free_forces};
use super::friction::Grip;
use super::model::Cloth;
use super::touching::{Pushing, Touching, opening, presses};
use crate::geometry::{Vec3, sorted_pair};
use crate::linear::{Cholesky, CholeskyError, PatternError, SymmetricMatrix, SymmetricPattern};

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
    /// Whether a node is one of [`Cloth::held`].
    is_held: Vec<bool>,
    made: Option<Made>,
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
        // Most of what energies couple are edges.
        let others = cloth.elastic.pairs().filter(|pair| cloth.edges.binary_search(&sorted_pair(*pair)).is_err());
        let graph = cloth.edges.iter().chain(pulls).chain(touching).copied().chain(others).filter(is_free);
        let pattern = Arc::new(SymmetricPattern::blocks(n, graph.map(|[a, b]| (a as usize, b as usize)))?);
        Ok(Self {
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
        let pattern = self.matrix.pattern().clone();
        let coupled = |i: u32, j: u32| pattern.block_slot(i as usize, j as usize).is_some();
        let contacts = touching.bound(|node| self.is_held[node as usize], coupled);
        let stitches = forces.stitches();
        let all = (cloth.elastic.bound(x), (contacts, stitches.bound(x)));
        fill(&mut self.matrix, |node| cloth.mass[node] / (dt * dt), &all);
    }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::bending::Bending;
    use crate::dynamics::contact_law::{ContactLaw, Hardening};
    use crate::dynamics::elasticity::Elasticity;
    use crate::dynamics::elements::Elements;
    use crate::dynamics::energy::Elastic;
    use crate::dynamics::membrane::Membrane;
    use crate::dynamics::spring::Spring;
    use crate::dynamics::stretch::{Stretch, StretchLaw};

    /// Two nodes of 1 g with a spring of 10 mm between them.
    fn spring() -> Cloth {
        let spring = Spring { ends: [0, 1], stretch: Stretch { rest: 0.01, width: 0.01, law: 0 } };
        let elements = Elements { springs: vec![spring], ..Elements::default() };
        Cloth {
            node_of: vec![0, 1],
            mass: vec![1e-3; 2],
            elastic: Elasticity {
                bending: Bending::new(2, &[]),
                membrane: Membrane::new(2, elements, vec![StretchLaw::linear(500.0)]),
                ..Elasticity::default()
            },
            edges: vec![[0, 1]],
            half_thickness: vec![0.0; 2],
            friction: vec![0.0; 2],
            ..Cloth::default()
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
        let unloaded = [Vec3::zeros(), Vec3::x() * 0.01];
        let foreseen = cloth.elastic.foresee(&unloaded, &unloaded).loads;
        cloth.elastic.follow(&x, foreseen);
        let fresh = step(&mut Stepper::new(&cloth, &[], &[]).expect("a stepper"), &cloth);
        assert!(fresh > 1.01 * drawn, "{fresh} against {drawn}: the test would see nothing");
        assert_eq!(step(&mut stepper, &cloth), drawn);
        stepper.forget();
        assert_eq!(step(&mut stepper, &cloth), fresh);
    }
}
