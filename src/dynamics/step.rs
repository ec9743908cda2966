//! One implicit step: linearise every force at the present position, solve one 3n×3n system.

use std::sync::Arc;

use rayon::prelude::*;

use super::GRAVITY;
use super::friction::Friction;
use super::model::Cloth;
use crate::contact::Contact;
use crate::geometry::{Mat3, Vec3};
use crate::linear::{
    BlockSlot, Cholesky, CholeskyError, NotPositiveDefinite, Ordering, PatternError, SymmetricMatrix, SymmetricPattern,
    nested_dissection,
};

/// Penalty contact (F6): force `stiffness` × (distance kept − gap) while the gap is smaller.
#[derive(Clone, Copy, Debug)]
pub struct ContactLaw {
    /// N/m per contact.
    pub stiffness: f64,
    /// Distance kept from the body beyond half the cloth's thickness, metres.
    pub body_clearance: f64,
    /// The same where a vertex or edge of the body meets a face or edge of the cloth. Few of these carry what many nodes
    /// would, so they are pressed deeper, and must not be pressed through.
    pub face_clearance: f64,
    /// Distance kept between two layers of cloth, metres; `None` = the two half thicknesses.
    pub cloth_gap: Option<f64>,
}

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

/// What acts on the cloth besides its own elasticity.
#[derive(Clone, Copy)]
pub struct Forces<'a> {
    /// Share of gravity, 0 … 1.
    pub gravity: f64,
    /// Contacts found at the last detection.
    pub contacts: &'a [Contact],
    /// Their law.
    pub law: ContactLaw,
    /// Stitches that are open.
    pub pulls: &'a [Pull],
    /// Friction against the body.
    pub friction: Option<&'a Friction>,
}

/// Why a step cannot be made.
#[derive(Clone, Debug, thiserror::Error)]
pub enum StepError {
    /// The system's pattern cannot be built.
    #[error(transparent)]
    Pattern(#[from] PatternError),
    /// Its factor cannot be analysed.
    #[error(transparent)]
    Analysis(#[from] CholeskyError),
    /// The matrix is not positive definite: some position or force is not finite.
    #[error("the step's matrix is singular near particle {node}: a position or a force is not finite")]
    Singular {
        /// The node.
        node: usize,
    },
}

/// The linear system of a cloth, analysed once, filled and factored for every step.
pub struct Stepper {
    matrix: SymmetricMatrix<f32>,
    factor: Cholesky<f32>,
    diagonal: Vec<BlockSlot>,
    springs: Vec<BlockSlot>,
    edges: Vec<BlockSlot>,
    pulls: Vec<Option<BlockSlot>>,
}

impl Stepper {
    /// Prepares the system of `cloth` with stitches between `pulls`; `x` guides the elimination order.
    ///
    /// # Errors
    /// A cloth too large for 32-bit indices.
    pub fn new(cloth: &Cloth, pulls: &[[u32; 2]], x: &[Vec3]) -> Result<Self, StepError> {
        let n = cloth.mass.len();
        let pair = |e: &[u32; 2]| (e[0] as usize, e[1] as usize);
        let pattern = Arc::new(SymmetricPattern::blocks(n, cloth.edges.iter().chain(pulls).map(pair))?);
        let graph: Vec<[u32; 2]> = cloth.edges.iter().chain(pulls).copied().collect();
        let order = Ordering::Given(nested_dissection(x, &graph));
        let slot = |a: usize, b: usize| pattern.block_slot(a, b);
        let missing = || StepError::Singular { node: 0 };
        let find = |e: [u32; 2]| slot(e[0] as usize, e[1] as usize).ok_or_else(missing);
        Ok(Self {
            diagonal: (0..n).map(|i| slot(i, i).ok_or_else(missing)).collect::<Result<_, _>>()?,
            springs: cloth.springs.iter().map(|s| find(s.ends)).collect::<Result<_, _>>()?,
            edges: cloth.edges.iter().map(|e| find(*e)).collect::<Result<_, _>>()?,
            pulls: pulls.iter().map(|e| slot(e[0] as usize, e[1] as usize)).collect(),
            matrix: SymmetricMatrix::zeros(pattern.clone()),
            factor: Cholesky::new(pattern, &order)?,
        })
    }

    /// The step d with (M/Δt² + H) d = f(x) + M v/Δt, where H majorises the stiffness at `x` (compressed springs lose
    /// their negative part, bending is bounded edge by edge) and `velocity` is what inertia keeps.
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
    ) -> Result<Vec<Vec3>, StepError> {
        let mut rhs = cloth_forces(cloth, x, forces);
        for ((f, v), m) in rhs.iter_mut().zip(velocity).zip(&cloth.mass) {
            *f += v * (m / dt);
        }
        self.assemble(cloth, x, dt, forces);
        self.factor
            .factor(&self.matrix)
            .map_err(|NotPositiveDefinite { dof }| StepError::Singular { node: dof / 3 })?;
        let mut flat: Vec<f32> = rhs.iter().flat_map(|v| [v.x as f32, v.y as f32, v.z as f32]).collect();
        self.factor.solve(&mut flat);
        let d: Vec<Vec3> = flat.chunks_exact(3).map(|c| Vec3::new(c[0].into(), c[1].into(), c[2].into())).collect();
        match d.iter().position(|v| !v.iter().all(|c| c.is_finite())) {
            Some(node) => Err(StepError::Singular { node }),
            None => Ok(d),
        }
    }

    fn assemble(&mut self, cloth: &Cloth, x: &[Vec3], dt: f64, forces: &Forces) {
        self.matrix.clear();
        let blocks: Vec<Mat3> = cloth
            .springs
            .par_iter()
            .with_min_len(1024)
            .map(|s| {
                let d = x[s.ends[1] as usize] - x[s.ends[0] as usize];
                let length = d.norm().max(1e-9);
                let t = d / length;
                let law = &cloth.laws[s.law as usize];
                let strain = length / s.rest - 1.0;
                let along = law.slope(strain) * s.width / s.rest;
                // A compressed spring would buckle within one step: the absolute value lets it, but gently.
                let across = (law.load(strain) * s.width / length).abs();
                Mat3::identity() * across + t * t.transpose() * (along - across).max(0.0)
            })
            .collect();
        for ((s, slot), k) in cloth.springs.iter().zip(&self.springs).zip(&blocks) {
            couple(&mut self.matrix, &self.diagonal, s.ends, *slot, k);
        }
        for ((e, slot), w) in cloth.edges.iter().zip(&self.edges).zip(&cloth.bending_bound) {
            couple(&mut self.matrix, &self.diagonal, *e, *slot, &(Mat3::identity() * *w));
        }
        for (pull, slot) in forces.pulls.iter().zip(&self.pulls) {
            let gap = (x[pull.ends[1] as usize] - x[pull.ends[0] as usize]).norm();
            let k = Mat3::identity() * (pull.stiffness * (pull.cap / gap.max(1e-12)).min(1.0));
            if let Some(slot) = slot {
                couple(&mut self.matrix, &self.diagonal, pull.ends, *slot, &k);
            }
        }
        for (i, m) in cloth.mass.iter().enumerate() {
            self.matrix.add_block(self.diagonal[i], &(Mat3::identity() * (m / (dt * dt))));
        }
        for contact in forces.contacts {
            self.add_contact(cloth, x, contact, forces);
        }
    }

    fn add_contact(&mut self, cloth: &Cloth, x: &[Vec3], contact: &Contact, forces: &Forces) {
        let load = contact_load(cloth, x, contact, &forces.law);
        if load <= 0.0 {
            return;
        }
        let nn = contact.normal * contact.normal.transpose();
        let k = forces.law.stiffness;
        if contact.body {
            // The body's faces and edges touch nodes of one triangle: their coupling is part of the pattern.
            for (a, (i, wi)) in contact.parts().enumerate() {
                self.matrix.add_block(self.diagonal[i], &(nn * (k * wi * wi)));
                for (j, wj) in contact.parts().skip(a + 1) {
                    if let Some(slot) = self.matrix.pattern().block_slot(i, j) {
                        self.matrix.add_block(slot, &(nn * (k * wi * wj)));
                    }
                }
            }
            if let (Some(friction), 1) = (forces.friction, contact.count) {
                let i = contact.nodes[0] as usize;
                let grip = friction.grip(contact, x[i], load, cloth.friction[i]);
                self.matrix.add_block(self.diagonal[i], &((Mat3::identity() - nn) * grip.stiffness));
            }
        } else {
            // Couplings across sheets are not: w wᵀ ≤ (Σ|w|) diag(|w|), and Σ|w| = 2.
            for (i, w) in contact.parts() {
                self.matrix.add_block(self.diagonal[i], &(nn * (2.0 * k * w.abs())));
            }
        }
    }
}

fn couple(matrix: &mut SymmetricMatrix<f32>, diagonal: &[BlockSlot], ends: [u32; 2], slot: BlockSlot, k: &Mat3) {
    matrix.add_block(diagonal[ends[0] as usize], k);
    matrix.add_block(diagonal[ends[1] as usize], k);
    matrix.add_block(slot, &(-k));
}

/// Distance at which a contact begins to push, metres.
fn kept_distance(cloth: &Cloth, contact: &Contact, law: &ContactLaw) -> f64 {
    let first = cloth.half_thickness[contact.nodes[0] as usize];
    if contact.body {
        return first + if contact.count == 1 { law.body_clearance } else { law.face_clearance };
    }
    law.cloth_gap.unwrap_or_else(|| first + cloth.half_thickness[contact.nodes[contact.count as usize - 1] as usize])
}

/// Normal force of a contact, N (0 when it does not touch).
pub(super) fn contact_load(cloth: &Cloth, x: &[Vec3], contact: &Contact, law: &ContactLaw) -> f64 {
    law.stiffness * (kept_distance(cloth, contact, law) - contact.gap(x)).max(0.0)
}

impl Forces<'_> {
    /// Normal force of one of the contacts, N.
    pub fn load(&self, cloth: &Cloth, x: &[Vec3], contact: &Contact) -> f64 {
        contact_load(cloth, x, contact, &self.law)
    }
}

/// All forces on the nodes at `x`, N.
pub(crate) fn cloth_forces(cloth: &Cloth, x: &[Vec3], forces: &Forces) -> Vec<Vec3> {
    let mut out: Vec<Vec3> = (0..x.len())
        .into_par_iter()
        .with_min_len(512)
        .map(|i| -cloth.bending.gradient(x, i) - Vec3::y() * (cloth.mass[i] * GRAVITY * forces.gravity))
        .collect();
    for s in &cloth.springs {
        let d = x[s.ends[1] as usize] - x[s.ends[0] as usize];
        let length = d.norm().max(1e-9);
        let f = d * (cloth.laws[s.law as usize].load(length / s.rest - 1.0) * s.width / length);
        out[s.ends[0] as usize] += f;
        out[s.ends[1] as usize] -= f;
    }
    for pull in forces.pulls {
        let d = x[pull.ends[1] as usize] - x[pull.ends[0] as usize];
        let gap = d.norm();
        let f = d * (pull.stiffness * (pull.cap / gap.max(1e-12)).min(1.0));
        out[pull.ends[0] as usize] += f;
        out[pull.ends[1] as usize] -= f;
    }
    for contact in forces.contacts {
        let load = contact_load(cloth, x, contact, &forces.law);
        if load <= 0.0 {
            continue;
        }
        for (i, w) in contact.parts() {
            out[i] += contact.normal * (load * w);
        }
        if let (Some(friction), true, 1) = (forces.friction, contact.body, contact.count) {
            let i = contact.nodes[0] as usize;
            out[i] += friction.grip(contact, x[i], load, cloth.friction[i]).force;
        }
    }
    out
}
