//! A Newton step with the true stiffness, for cloth that is near rest.
//!
//! The majorant of [`Stepper`] is safe but slows long waves: it bounds bending edge by edge, and treats the load of a
//! compressed spring as stiffening. The true stiffness has neither fault. Preconditioned conjugate gradients solve it,
//! with the majorant's factor as preconditioner (Steihaug 1983: the iteration stops at negative curvature or at the
//! trust region).
//!
//! Contacts that begin or cease to push, to hold or to slide are kinks in the energy. A step that takes them on their
//! wrong side need not lower the energy: garments swung to and fro on their friction.

use rayon::prelude::*;

use super::contact_law::Press;
use super::force::{Forces, free_forces};
use super::friction::{Grip, Hold};
use super::model::Cloth;
use super::shear::ShearTangent;
use super::springs::StretchTangent;
use super::step::{Pushing, Reuse, StepError, Stepper, opening, presses};
use crate::contact::Contact;
use crate::geometry::{Mat3, Vec3};

/// Most conjugate gradient iterations of a step. More would cost more than a new factor.
const ITERATIONS: usize = 16;
/// Reuse of an older factor as preconditioner. It costs about one iteration for every contact that it does not know.
const OLD: Reuse = Reuse { moved: 1e-3, contacts: 8 };
/// Most rounds of the active set: the first uses the contacts that push and slide at the start, each further one those
/// that the round before ended with (a semismooth Newton method; Qi and Sun 1993).
const ROUNDS: usize = 4;
/// Least share of the way from one round's step to the next that is tried.
const SHORTEST_WAY: f64 = 0.1;
/// Error of the predicted energy of contact and friction, as a share of the step's gain, above which a further round is
/// made.
const MISJUDGED: f64 = 0.3;
/// Convergence of conjugate gradients: the squared preconditioned residual falls to this share.
const SOLVED: f64 = 1e-4;

/// A proposed step.
pub(super) struct Proposal {
    /// Displacement of every node, metres.
    pub(super) d: Vec<Vec3>,
    /// Resistance of the cloth without contact, its stiffness times `d`, N.
    resisted: Vec<Vec3>,
    /// Predicted decrease of the energy, J.
    pub(super) gain: f64,
}

impl Proposal {
    /// The zero step.
    fn none(nodes: usize) -> Self {
        Self { d: vec![Vec3::zeros(); nodes], resisted: vec![Vec3::zeros(); nodes], gain: 0.0 }
    }
}

/// The parts of the true stiffness at one position.
struct Tangent<'a> {
    cloth: &'a Cloth,
    dt: f64,
    forces: &'a Forces<'a>,
    presses: &'a [Press],
    springs: Vec<StretchTangent>,
    threads: Vec<StretchTangent>,
    shears: Vec<ShearTangent>,
    /// [`super::crease::Crease::root`] of every crease.
    creases: Vec<[Vec3; 4]>,
    /// Numbers of the active contacts, with the stiffness of their friction, N/m.
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
        let holds: Vec<Option<Hold>> =
            presses.iter().enumerate().map(|(k, p)| forces.hold(cloth, x, k, p.load)).collect();
        let mut step = Proposal::none(x.len());
        let mut active: Vec<bool> = presses.iter().map(|p| p.load > 0.0).collect();
        let mut grips: Vec<Option<Grip>> = holds.iter().map(|hold| Some(hold.as_ref()?.grip())).collect();
        for round in 1..=ROUNDS {
            let pushing = Pushing { presses: &presses, active: &active, grips: &grips };
            if round == 1 {
                self.prepare(cloth, x, dt, forces, &pushing, OLD)?;
            }
            let tangent = Tangent::new(cloth, x, dt, forces, &pushing);
            let next = self.truncated(&tangent, &pushing.forces(&free, forces), &step, radius)?;
            let model = Model { tangent, free: &free, holds: &holds, pushing };
            let (to, misjudged) = model.best_on_the_way(&step, next);
            let after = |k: usize| Some(holds[k].as_ref()?.grip_after(way(&forces.contacts[k], &to.d)));
            grips = (0..holds.len()).map(after).collect();
            active = presses.iter().zip(forces.contacts).map(|(p, c)| p.after(opening(c, &to.d)) > 0.0).collect();
            if to.gain >= step.gain {
                step = to;
                if misjudged <= MISJUDGED * step.gain {
                    break;
                }
            }
        }
        Ok(step)
    }

    /// Conjugate gradients on the tangent, starting from the step `from`.
    fn truncated(&self, tangent: &Tangent, rhs: &[Vec3], from: &Proposal, radius: f64) -> Result<Vec<Vec3>, StepError> {
        let mut d = from.d.clone();
        let resisted = tangent.with_contacts(from.resisted.clone(), &d);
        let mut r: Vec<Vec3> = rhs.iter().zip(resisted).map(|(r, a)| r - a).collect();
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
    fn new(cloth: &'a Cloth, x: &'a [Vec3], dt: f64, forces: &'a Forces<'a>, pushing: &Pushing<'a>) -> Self {
        let springs = (0..cloth.springs.len()).map(|k| cloth.spring_tangent(k, x)).collect();
        let threads = (0..cloth.threads.len()).map(|k| cloth.thread_tangent(k, x)).collect();
        let shears = (0..cloth.shears.len()).map(|k| cloth.shear_tangent(k, x)).collect();
        let creases = cloth.creases.iter().map(|c| c.root(x)).collect();
        let grips =
            pushing.numbers().map(|k| (k, pushing.grips[k].map_or_else(Mat3::zeros, |g| g.stiffness))).collect();
        Self { cloth, dt, forces, presses: pushing.presses, springs, threads, shears, creases, grips }
    }

    /// (M/Δt² + true stiffness) p, with the active contacts.
    fn apply(&self, p: &[Vec3]) -> Vec<Vec3> {
        self.with_contacts(self.apply_free(p), p)
    }

    /// Adds the resistance of the active contacts against `p` to the cloth's own, `out`.
    fn with_contacts(&self, mut out: Vec<Vec3>, p: &[Vec3]) -> Vec<Vec3> {
        for (k, grip) in &self.grips {
            let (contact, press) = (&self.forces.contacts[*k], &self.presses[*k]);
            let way = way(contact, p);
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
        for (s, tangent) in cloth.springs.iter().zip(&self.springs) {
            let f = tangent.apply(s.span(p));
            out[s.ends[0] as usize] -= f;
            out[s.ends[1] as usize] += f;
        }
        for (t, tangent) in cloth.threads.iter().zip(&self.threads) {
            let f = tangent.apply(t.span(p));
            for (n, share) in t.nodes.iter().zip(t.shares()) {
                out[*n as usize] += f * share;
            }
        }
        for (shear, tangent) in cloth.shears.iter().zip(&self.shears) {
            for (n, f) in shear.nodes.iter().zip(shear.at_nodes(tangent.apply(shear.legs(p)))) {
                out[*n as usize] += f;
            }
        }
        for (crease, root) in cloth.creases.iter().zip(&self.creases) {
            let turned: f64 = crease.nodes.iter().zip(root).map(|(&n, g)| g.dot(&p[n as usize])).sum();
            for (n, g) in crease.nodes.iter().zip(root) {
                out[*n as usize] += g * turned;
            }
        }
        out
    }

    /// Largest change of an edge by the step `d`, metres. The motion of single nodes does not matter: a garment that
    /// sways as a whole turns no spring.
    fn change(&self, d: &[Vec3]) -> f64 {
        let square = |e: &[u32; 2]| (d[e[0] as usize] - d[e[1] as usize]).norm_squared();
        self.cloth.edges.iter().map(square).fold(0.0, f64::max).sqrt()
    }
}

/// Displacement of a contact by the step `d`, metres.
fn way(contact: &Contact, d: &[Vec3]) -> Vec3 {
    contact.parts().map(|(i, w)| d[i] * w).sum()
}

/// Model of the energy near one position: quadratic without contact, and piecewise for every contact.
struct Model<'a> {
    tangent: Tangent<'a>,
    /// Forces without contact, N.
    free: &'a [Vec3],
    holds: &'a [Option<Hold>],
    /// The contacts with which the step was solved.
    pushing: Pushing<'a>,
}

/// Change of the energy by a step, J.
#[derive(Clone, Copy)]
struct Judged {
    /// Decrease in the piecewise model: a contact pushes only while it touches, and slides only beyond its friction
    /// limit.
    gain: f64,
    /// Error of the step's linear model of contact and friction, summed over all contacts.
    misjudged: f64,
}

impl Model<'_> {
    /// The step of lowest energy on the way from `from` to `to`, which is halved again and again, and its misjudged
    /// energy. If none lowers the energy, it is the shortest one tried.
    fn best_on_the_way(&self, from: &Proposal, to: Vec<Vec3>) -> (Proposal, f64) {
        let way: Vec<Vec3> = to.iter().zip(&from.d).map(|(b, a)| b - a).collect();
        let resisted = self.tangent.apply_free(&way);
        let at = |share: f64| {
            let on = |from: &[Vec3], way: &[Vec3]| from.iter().zip(way).map(|(a, w)| a + w * share).collect();
            let (d, resisted): (Vec<Vec3>, Vec<Vec3>) = (on(&from.d, &way), on(&from.resisted, &resisted));
            let Judged { gain, misjudged } = self.judge(&d, &resisted);
            (Proposal { d, resisted, gain }, misjudged)
        };
        let (mut best, mut share) = (at(1.0), 1.0);
        while share > SHORTEST_WAY {
            share *= 0.5;
            let half = at(share);
            if best.0.gain >= half.0.gain && best.0.gain > from.gain {
                break;
            }
            best = half;
        }
        best
    }

    /// Judges the step `d`, where `resisted` is the resistance of the cloth.
    fn judge(&self, d: &[Vec3], resisted: &[Vec3]) -> Judged {
        let mut out = Judged { gain: dot(self.free, d) - 0.5 * dot(d, resisted), misjudged: 0.0 };
        let Pushing { presses, active, grips } = self.pushing;
        for (k, (contact, press)) in self.tangent.forces.contacts.iter().zip(presses).enumerate() {
            let after = press.after(opening(contact, d));
            let energy = |load: f64| load.max(0.0).powi(2) / (2.0 * press.slope);
            out.gain += energy(press.load) - energy(after);
            if active[k] != (after > 0.0) {
                out.misjudged += energy(after.abs());
            }
            if let (Some(hold), Some(grip)) = (&self.holds[k], &grips[k]) {
                let way = way(contact, d);
                out.gain += hold.energy(Vec3::zeros()) - hold.energy(way);
                let error = grip.force - grip.stiffness * way - hold.force(way);
                out.misjudged += 0.5 * error.norm() * way.norm();
            }
        }
        out
    }
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}
