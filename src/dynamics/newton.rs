//! A Newton step with the true stiffness, for cloth that is near rest.
//!
//! The majorant of [`Stepper`] is safe but slows long waves: it bounds bending edge by edge, and treats the load of a
//! compressed spring as stiffening. The true stiffness has neither fault. Preconditioned conjugate gradients solve it,
//! with the majorant's factor as preconditioner (Steihaug 1983: the iteration stops at negative curvature or at the
//! trust region).
//!
//! Contacts that begin or cease to push, to hold or to slide are kinks in the energy. A step that takes them on their
//! wrong side need not lower the energy: garments swung to and fro on their friction.

use super::energy::{Energy, Exerted, Stiffness, on_nodes};
use super::force::{Forces, free_forces};
use super::friction::{Grip, Hold};
use super::model::Cloth;
use super::step::{Reuse, StepError, Stepper};
use super::touching::{Pushing, Touching, opening, presses};
use crate::contact::Contact;
use crate::geometry::Vec3;
use crate::parallel::{self, LIGHT, MEDIUM};

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

/// The true stiffness of the cloth at one position, without contacts.
struct ClothStiffness<'a, S> {
    cloth: &'a Cloth,
    /// One over the square of the time step, 1/s².
    inertia: f64,
    stiffness: S,
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
        let holds = parallel::map(presses.len(), MEDIUM, |k| forces.hold(cloth, x, k, presses[k].load));
        let tangent = ClothStiffness { cloth, inertia: 1.0 / (dt * dt), stiffness: cloth.elastic.stiffness(x) };
        let mut step = Proposal::none(x.len());
        let mut active: Vec<bool> = presses.iter().map(|p| p.load > 0.0).collect();
        let mut grips: Vec<Option<Grip>> = holds.iter().map(|hold| Some(hold.as_ref()?.grip())).collect();
        for round in 1..=ROUNDS {
            let pushing = Pushing { presses: &presses, active: &active, grips: &grips };
            let touching = Touching::new(forces.contacts, &pushing, x.len());
            if round == 1 {
                self.prepare(cloth, x, dt, forces, (&pushing, &touching), OLD)?;
            }
            let next = self.truncated(&tangent, &touching, &pushing.forces(&free, forces), &step, radius)?;
            let model = Model { tangent: &tangent, contacts: forces.contacts, free: &free, holds: &holds, pushing };
            let (to, misjudged) = model.best_on_the_way(&step, next);
            (active, grips) = model.after(&to.d);
            if to.gain >= step.gain {
                step = to;
                if misjudged <= MISJUDGED * step.gain {
                    break;
                }
            }
        }
        Ok(step)
    }

    /// Conjugate gradients on the tangent with the contacts `touching`, starting from the step `from`.
    fn truncated(
        &self,
        tangent: &ClothStiffness<impl Stiffness>,
        touching: &Touching,
        rhs: &[Vec3],
        from: &Proposal,
        radius: f64,
    ) -> Result<Vec<Vec3>, StepError> {
        let mut d = from.d.clone();
        let pushed_back = touching.times(&from.d);
        let mut r = parallel::map(d.len(), LIGHT, |i| rhs[i] - pushed_back.gather(i, from.resisted[i]));
        let mut z = self.apply_inverse(&r)?;
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let solved = SOLVED * rz;
        for _ in 0..ITERATIONS {
            if rz <= solved {
                break;
            }
            let ap = tangent.apply(&p, Some(touching));
            let curvature = dot(&p, &ap);
            if curvature <= 0.0 {
                let part = ((radius - tangent.change(&d)) / tangent.change(&p)).max(0.0);
                advance(&mut d, &p, part);
                break;
            }
            let share = rz / curvature;
            let next = on_the_way(&d, &p, share);
            if let Some(to) = tangent.change_beyond(&next, radius) {
                let from = tangent.change(&d);
                advance(&mut d, &p, share * ((radius - from) / (to - from)).clamp(0.0, 1.0));
                break;
            }
            d = next;
            advance(&mut r, &ap, -share);
            z = self.apply_inverse(&r)?;
            let new = dot(&r, &z);
            let again = new / rz;
            rz = new;
            parallel::for_each(&mut p, LIGHT, |i, p| *p = z[i] + *p * again);
        }
        Ok(d)
    }
}

impl<S: Stiffness> ClothStiffness<'_, S> {
    /// (M/Δt² + true stiffness) p, with the contacts `touching`.
    fn apply(&self, p: &[Vec3], touching: Option<&Touching>) -> Vec<Vec3> {
        let all = (self.stiffness.times(p), touching.map(|t| t.times(p)));
        on_nodes(p.len(), |i| p[i] * (self.cloth.mass[i] * self.inertia), &all)
    }

    /// Largest change of an edge by the step `d`, metres. The motion of single nodes does not matter: a garment that
    /// sways as a whole turns no spring.
    fn change(&self, d: &[Vec3]) -> f64 {
        let edges = &self.cloth.edges;
        let square = |k: usize| (d[edges[k][0] as usize] - d[edges[k][1] as usize]).norm_squared();
        parallel::largest(edges.len(), LIGHT, square).sqrt()
    }

    /// [`ClothStiffness::change`] if it is more than `radius`. No edge changes by more than its two nodes move.
    fn change_beyond(&self, d: &[Vec3], radius: f64) -> Option<f64> {
        let longest = parallel::largest(d.len(), LIGHT, |i| d[i].norm_squared()).sqrt();
        if 2.0 * longest <= radius {
            return None;
        }
        Some(self.change(d)).filter(|change| *change > radius)
    }
}

/// Points after the share of a way.
fn on_the_way(from: &[Vec3], way: &[Vec3], share: f64) -> Vec<Vec3> {
    parallel::map(from.len(), LIGHT, |i| from[i] + way[i] * share)
}

/// Moves points by the share of a way.
fn advance(points: &mut [Vec3], way: &[Vec3], share: f64) {
    parallel::for_each(points, LIGHT, |i, point| *point += way[i] * share);
}

/// Displacement of a contact by the step `d`, metres.
fn way(contact: &Contact, d: &[Vec3]) -> Vec3 {
    contact.parts().map(|(i, w)| d[i] * w).sum()
}

/// Model of the energy near one position: quadratic without contact, and piecewise for every contact.
struct Model<'a, S> {
    tangent: &'a ClothStiffness<'a, S>,
    contacts: &'a [Contact<'a>],
    /// Forces without contact, N.
    free: &'a [Vec3],
    holds: &'a [Option<Hold>],
    /// The contacts with which the step was solved.
    pushing: Pushing<'a>,
}

/// Change of the energy by a step, J.
#[derive(Clone, Copy)]
struct EnergyChange {
    /// Decrease in the piecewise model: a contact pushes only while it touches, and slides only beyond its friction
    /// limit.
    gain: f64,
    /// Error of the step's linear model of contact and friction, summed over all contacts.
    misjudged: f64,
}

impl<S: Stiffness> Model<'_, S> {
    /// The step of lowest energy on the way from `from` to `to`, which is halved again and again, and its misjudged
    /// energy. If none lowers the energy, it is the shortest one tried.
    fn best_on_the_way(&self, from: &Proposal, to: Vec<Vec3>) -> (Proposal, f64) {
        let way = on_the_way(&to, &from.d, -1.0);
        let resisted = self.tangent.apply(&way, None);
        let at = |share: f64| {
            let d = on_the_way(&from.d, &way, share);
            let resisted = on_the_way(&from.resisted, &resisted, share);
            let EnergyChange { gain, misjudged } = self.judge(&d, &resisted);
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
    fn judge(&self, d: &[Vec3], resisted: &[Vec3]) -> EnergyChange {
        let without = dot(self.free, d) - 0.5 * dot(d, resisted);
        let of_contacts = parallel::map(self.contacts.len(), MEDIUM, |k| self.judge_contact(k, d));
        of_contacts.into_iter().fold(EnergyChange { gain: without, misjudged: 0.0 }, |sum, one| EnergyChange {
            gain: sum.gain + one.gain,
            misjudged: sum.misjudged + one.misjudged,
        })
    }

    /// The part of contact number `k` in the judgement of the step `d`.
    fn judge_contact(&self, k: usize, d: &[Vec3]) -> EnergyChange {
        let (contact, press) = (&self.contacts[k], &self.pushing.presses[k]);
        let after = press.after(opening(contact, d));
        let energy = |load: f64| load.max(0.0).powi(2) / (2.0 * press.slope);
        let mut out = EnergyChange { gain: energy(press.load) - energy(after), misjudged: 0.0 };
        if self.pushing.active[k] != (after > 0.0) {
            out.misjudged += energy(after.abs());
        }
        if let (Some(hold), Some(grip)) = (&self.holds[k], &self.pushing.grips[k]) {
            let way = way(contact, d);
            out.gain += hold.energy(Vec3::zeros()) - hold.energy(way);
            let error = grip.force - grip.stiffness * way - hold.force(way);
            out.misjudged += 0.5 * error.norm() * way.norm();
        }
        out
    }

    /// Which contacts push after the step `d`, and their friction then.
    fn after(&self, d: &[Vec3]) -> (Vec<bool>, Vec<Option<Grip>>) {
        let one = |k: usize| {
            let (contact, press) = (&self.contacts[k], &self.pushing.presses[k]);
            let grip = self.holds[k].as_ref().map(|hold| hold.grip_after(way(contact, d)));
            (press.after(opening(contact, d)) > 0.0, grip)
        };
        parallel::map(self.contacts.len(), MEDIUM, one).into_iter().unzip()
    }
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    parallel::sum(a.len(), LIGHT, |i| a[i].dot(&b[i]))
}
