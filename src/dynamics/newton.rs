//! A Newton step with the cloth's true stiffness, for the last millimetres to rest.
//!
//! The majorant of [`Stepper`] is safe but holds long waves back: it bounds bending edge by edge, and counts the load of
//! a compressed spring as if it stiffened it. The true stiffness has neither fault; conjugate gradients solve it, with
//! the majorant's factor as preconditioner (Steihaug 1983: stopped where the curvature turns negative or the step gets
//! longer than the model can be trusted).

use rayon::prelude::*;

use super::force::{Forces, Press, free_forces};
use super::model::Cloth;
use super::springs::SpringTangent;
use super::step::{Reuse, StepError, Stepper, contact_forces, opening, presses};
use crate::geometry::{Mat3, Vec3};

/// Most conjugate gradient iterations of a step; more would cost more than a new factor.
const ITERATIONS: usize = 16;
/// A preconditioner need not be new: an older factor costs iterations, about one for every contact it does not know.
const OLD: Reuse = Reuse { moved: 1e-3, contacts: 8 };
/// They end when the preconditioned residual has fallen to this share (squared).
const SOLVED: f64 = 1e-4;

/// A proposed step.
pub(super) struct Proposal {
    /// Where to go.
    pub(super) d: Vec<Vec3>,
    /// By how much the model says the energy will fall, J.
    pub(super) gain: f64,
}

/// What the true stiffness is made of at one position.
struct Tangent<'a> {
    cloth: &'a Cloth,
    dt: f64,
    forces: &'a Forces<'a>,
    presses: &'a [Press],
    springs: Vec<SpringTangent>,
    /// [`super::crease::Crease::root`] of every crease.
    creases: Vec<[Vec3; 4]>,
    /// Numbers of the contacts that push, and the stiffness of their friction, N/m.
    grips: Vec<(usize, Mat3)>,
}

impl Stepper {
    /// A step from `x` that changes no edge by more than `radius` metres.
    ///
    /// # Errors
    /// [`StepError::Singular`] when a number is not finite.
    pub(super) fn newton(
        &mut self,
        cloth: &Cloth,
        x: &[Vec3],
        dt: f64,
        forces: &Forces,
        radius: f64,
    ) -> Result<Proposal, StepError> {
        let free = free_forces(cloth, x, forces);
        let presses = presses(cloth, x, forces);
        let active: Vec<bool> = presses.iter().map(|p| p.load > 0.0).collect();
        let tangent = Tangent::new(cloth, x, dt, forces, &presses);
        self.prepare(cloth, x, dt, forces, &presses, &active, OLD)?;
        let rhs = contact_forces(&free, cloth, x, forces, &presses, &active);
        let d = self.truncated(&tangent, &rhs, radius)?;
        // A contact that the step closes is not in its stiffness: to solve again with it costs more than the next step.
        Ok(Proposal { gain: tangent.gain(&free, &d), d })
    }

    /// Conjugate gradients on the tangent, from zero.
    fn truncated(&self, tangent: &Tangent, rhs: &[Vec3], radius: f64) -> Result<Vec<Vec3>, StepError> {
        let mut d = vec![Vec3::zeros(); rhs.len()];
        let mut r = rhs.to_vec();
        let mut z = self.apply_inverse(&r)?;
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let solved = SOLVED * rz;
        for _ in 0..ITERATIONS {
            if rz <= solved {
                break;
            }
            let ap = tangent.apply(&p);
            let curvature = dot(&p, &ap);
            if curvature <= 0.0 {
                let part = ((radius - tangent.change(&d)) / tangent.change(&p)).max(0.0);
                d.iter_mut().zip(&p).for_each(|(d, p)| *d += p * part);
                break;
            }
            let share = rz / curvature;
            let next: Vec<Vec3> = d.iter().zip(&p).map(|(d, p)| d + p * share).collect();
            let (from, to) = (tangent.change(&d), tangent.change(&next));
            if to > radius {
                let part = share * ((radius - from) / (to - from)).clamp(0.0, 1.0);
                d.iter_mut().zip(&p).for_each(|(d, p)| *d += p * part);
                break;
            }
            d = next;
            r.iter_mut().zip(&ap).for_each(|(r, ap)| *r -= ap * share);
            z = self.apply_inverse(&r)?;
            let new = dot(&r, &z);
            let again = new / rz;
            rz = new;
            p.iter_mut().zip(&z).for_each(|(p, z)| *p = z + *p * again);
        }
        Ok(d)
    }
}

impl<'a> Tangent<'a> {
    fn new(cloth: &'a Cloth, x: &'a [Vec3], dt: f64, forces: &'a Forces<'a>, presses: &'a [Press]) -> Self {
        let springs = cloth.springs.iter().map(|s| s.tangent(&cloth.laws[s.law as usize], x)).collect();
        let creases = cloth.creases.iter().map(|c| c.root(x)).collect();
        let grip = |k: usize| {
            let grip = forces.friction?.grip(k, &forces.contacts[k], x, presses[k].load, &cloth.friction)?;
            Some(grip.stiffness)
        };
        let pushing = (0..presses.len()).filter(|&k| presses[k].load > 0.0);
        let grips = pushing.map(|k| (k, grip(k).unwrap_or_else(Mat3::zeros))).collect();
        Self { cloth, dt, forces, presses, springs, creases, grips }
    }

    /// (M/Δt² + true stiffness) p, with the contacts that push.
    fn apply(&self, p: &[Vec3]) -> Vec<Vec3> {
        let mut out = self.apply_free(p);
        for (k, grip) in &self.grips {
            let (contact, press) = (&self.forces.contacts[*k], &self.presses[*k]);
            let way: Vec3 = contact.parts().map(|(i, w)| p[i] * w).sum();
            let back = contact.normal * (press.slope * contact.normal.dot(&way)) + grip * way;
            for (i, w) in contact.parts() {
                out[i] += back * w;
            }
        }
        out
    }

    fn apply_free(&self, p: &[Vec3]) -> Vec<Vec3> {
        let (cloth, inertia) = (self.cloth, 1.0 / (self.dt * self.dt));
        let mut out: Vec<Vec3> = (0..p.len())
            .into_par_iter()
            .with_min_len(super::ONE_THREAD)
            .map(|i| cloth.bending.gradient(p, i) + p[i] * (cloth.mass[i] * inertia))
            .collect();
        for (s, SpringTangent { direction: t, along, across }) in cloth.springs.iter().zip(&self.springs) {
            let e = p[s.ends[1] as usize] - p[s.ends[0] as usize];
            let f = t * ((along - across) * t.dot(&e)) + e * *across;
            out[s.ends[0] as usize] -= f;
            out[s.ends[1] as usize] += f;
        }
        for (crease, root) in cloth.creases.iter().zip(&self.creases) {
            let turned: f64 = crease.nodes.iter().zip(root).map(|(&n, g)| g.dot(&p[n as usize])).sum();
            for (n, g) in crease.nodes.iter().zip(root) {
                out[*n as usize] += g * turned;
            }
        }
        out
    }

    /// The most that a step changes an edge, metres. A node's own way does not matter: a garment that sways as a whole
    /// turns no spring.
    fn change(&self, d: &[Vec3]) -> f64 {
        let square = |e: &[u32; 2]| (d[e[0] as usize] - d[e[1] as usize]).norm_squared();
        self.cloth.edges.iter().map(square).fold(0.0, f64::max).sqrt()
    }

    /// Decrease of the energy's model along `d`: quadratic, but every contact pushes only while it touches.
    fn gain(&self, free: &[Vec3], d: &[Vec3]) -> f64 {
        let smooth = dot(free, d) - 0.5 * dot(d, &self.apply_free(d));
        let contact = self.forces.contacts.iter().zip(self.presses).map(|(contact, press)| {
            let after = (press.load - press.slope * opening(contact, d)).max(0.0);
            (press.load.max(0.0).powi(2) - after * after) / (2.0 * press.slope)
        });
        smooth + contact.sum::<f64>()
    }
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
