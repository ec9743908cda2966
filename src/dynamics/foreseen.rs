//! Loads of springs and of shear as the last Newton step foresaw them.
//!
//! A step that carries the ends of a spring of length l apart by d across it draws it out by d²/2l, which its linear
//! model does not know. Stiff cloth answers to that error of the second order with loads far above its weight: they
//! make the trust in the step shrink, and as stiffness across the spring they falsify the next. Yet the next step takes
//! them away again, for they are in the stiff, linear part of it. So, as in mixed formulations (Hellinger–Reissner),
//! loads go their own way: the stiffness across a spring is that of the load which the step foresaw, and what the
//! springs hold beyond it is not counted against the step (Magisano, Leonetti and Garcea 2017). The angle between two
//! threads that turn out of their plane has an error of the same kind, and its load goes the same way. Cloth comes to
//! rest in half the conjugate gradient iterations.

use super::model::Cloth;
use super::part::those;
use super::shear::ShearTangent;
use super::springs::{SHORTEST, Stretch, StretchLaw, StretchTangent};
use crate::geometry::Vec3;

/// Loads as a step foresaw them; none: as they are.
#[derive(Clone, Debug, Default)]
pub(super) struct Loads {
    /// Of every spring, N/m.
    springs: Vec<f64>,
    /// Of every [`Thread`](super::Thread), N/m.
    threads: Vec<f64>,
    /// Of every [`Shear`](super::Shear), N·m per radian.
    shears: Vec<f64>,
}

impl Loads {
    /// Those of the springs, threads and shears that are wanted.
    pub(super) fn of(&self, springs: &[bool], threads: &[bool], shears: &[bool]) -> Self {
        Self {
            springs: those(&self.springs, springs),
            threads: those(&self.threads, threads),
            shears: those(&self.shears, shears),
        }
    }
}

/// What a step foresees.
#[derive(Default)]
pub(super) struct Foreseen {
    /// The loads.
    pub(super) loads: Loads,
    /// Energy that the cloth holds beyond what those loads say, J.
    pub(super) beyond: f64,
}

impl Cloth {
    /// What the linear model of a step from `x` to `to` says of springs and shear.
    pub(super) fn foresee(&self, x: &[Vec3], to: &[Vec3]) -> Foreseen {
        let mut beyond = 0.0;
        let mut stretch = |stretch: &Stretch, [before, after]: [Vec3; 2]| {
            let (load, more) = stretch.foresee(&self.laws[stretch.law as usize], before, after);
            beyond += more;
            load
        };
        let springs = self.springs.iter().map(|s| stretch(&s.stretch, [x, to].map(|x| s.span(x)))).collect();
        let threads = self.threads.iter().map(|t| stretch(&t.stretch, [x, to].map(|x| t.span(x)))).collect();
        let shears = self.shears.iter().map(|s| {
            let (load, more) = s.foresee(x, to);
            beyond += more;
            load
        });
        let shears = shears.collect();
        Foreseen { loads: Loads { springs, threads, shears }, beyond }
    }

    /// Stiffness of spring number `k` at `x`: across it by the load that the last step foresaw, if one did.
    pub(super) fn spring_tangent(&self, k: usize, x: &[Vec3]) -> StretchTangent {
        let spring = &self.springs[k];
        self.tangent_of(&spring.stretch, spring.span(x), self.foreseen.springs.get(k))
    }

    /// The same of thread number `k`.
    pub(super) fn thread_tangent(&self, k: usize, x: &[Vec3]) -> StretchTangent {
        let thread = &self.threads[k];
        self.tangent_of(&thread.stretch, thread.span(x), self.foreseen.threads.get(k))
    }

    fn tangent_of(&self, stretch: &Stretch, span: Vec3, foreseen: Option<&f64>) -> StretchTangent {
        stretch.tangent(&self.laws[stretch.law as usize], span, foreseen.copied())
    }

    /// The same of shear number `k`.
    pub(super) fn shear_tangent(&self, k: usize, x: &[Vec3]) -> ShearTangent {
        self.shears[k].tangent(x, self.foreseen.shears.get(k).copied())
    }
}

impl Stretch {
    /// The load (N/m) that the linear model of a step foresees, whose ends are apart by `before` and then by `after`,
    /// and the energy (J) that it holds there beyond what that load says.
    fn foresee(&self, law: &StretchLaw, before: Vec3, after: Vec3) -> (f64, f64) {
        let length = before.norm().max(SHORTEST);
        let linear = (length + before.dot(&(after - before)) / length) / self.rest - 1.0;
        let exact = after.norm() / self.rest - 1.0;
        let load = law.load(linear);
        let beyond = law.energy(exact) - law.energy(linear) - load * (exact - linear);
        (load, beyond * self.width * self.rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_step_foresees_what_draws_a_spring_out_and_not_what_turns_it() {
        let spring = Stretch { rest: 0.01, width: 0.02, law: 0 };
        let law = StretchLaw::linear(500.0);
        let before = Vec3::x() * 0.0101;
        let (load, beyond) = spring.foresee(&law, before, Vec3::x() * 0.0103);
        assert_relative_eq!(load, 15.0, epsilon = 1e-9);
        assert_relative_eq!(beyond, 0.0, epsilon = 1e-15);
        // Turned by 1 mm across itself it is longer by √(10.1² + 1) − 10.1 mm.
        let (load, beyond) = spring.foresee(&law, before, before + Vec3::y() * 1e-3);
        assert_relative_eq!(load, 5.0, epsilon = 1e-9);
        let strain = (10.1f64.hypot(1.0) - 10.1) / 10.0;
        assert_relative_eq!(beyond, 0.5 * 500.0 * strain * strain * 0.02 * 0.01, max_relative = 1e-9);
        let tangent = spring.tangent(&law, before, Some(3.0));
        assert_relative_eq!(tangent.across, 3.0 * 0.02 / 0.0101, max_relative = 1e-12);
    }
}
