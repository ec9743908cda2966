//! Loads of springs and shear as predicted by the linear model of the last Newton step.
//!
//! A linear step that rotates a spring also lengthens it: a transverse displacement d of a spring of length l adds
//! d²/2l. In stiff cloth this second-order error gives loads far above the weight. They would shrink the trust region,
//! and falsify the transverse stiffness of the next step. Yet the next step removes them, because they are in its stiff
//! linear part.
//!
//! So loads are variables of their own, as in mixed formulations (Hellinger–Reissner): the transverse stiffness uses
//! the predicted load, and energy beyond it is not counted against the step (Magisano, Leonetti and Garcea 2017). Shear
//! is treated alike, because the angle between threads that rotate out of their plane has an error of the same kind.
//! Cloth comes to rest in half the conjugate gradient iterations.

use super::model::Cloth;
use super::part::those;
use super::shear::ShearTangent;
use super::springs::{SHORTEST, Stretch, StretchLaw, StretchTangent};
use crate::geometry::Vec3;

/// Loads predicted by a step. Empty lists mean the loads at the present position.
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
    /// The loads of the selected springs, threads and shears.
    pub(super) fn of(&self, springs: &[bool], threads: &[bool], shears: &[bool]) -> Self {
        Self {
            springs: those(&self.springs, springs),
            threads: those(&self.threads, threads),
            shears: those(&self.shears, shears),
        }
    }
}

/// Prediction of a step.
#[derive(Default)]
pub(super) struct Foreseen {
    /// The loads.
    pub(super) loads: Loads,
    /// Energy of the cloth beyond that of the linear model, J.
    pub(super) beyond: f64,
}

impl Cloth {
    /// Prediction of the linear model of a step from `x` to `to`, for springs and shear.
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

    /// Tangent stiffness of spring number `k` at `x`. Its transverse part uses the load predicted by the last step, if
    /// there is one.
    pub(super) fn spring_tangent(&self, k: usize, x: &[Vec3]) -> StretchTangent {
        let spring = &self.springs[k];
        self.tangent_of(&spring.stretch, spring.span(x), self.foreseen.springs.get(k))
    }

    /// Tangent stiffness of thread number `k` at `x`, as for springs.
    pub(super) fn thread_tangent(&self, k: usize, x: &[Vec3]) -> StretchTangent {
        let thread = &self.threads[k];
        self.tangent_of(&thread.stretch, thread.span(x), self.foreseen.threads.get(k))
    }

    fn tangent_of(&self, stretch: &Stretch, span: Vec3, foreseen: Option<&f64>) -> StretchTangent {
        stretch.tangent(&self.laws[stretch.law as usize], span, foreseen.copied())
    }

    /// Tangent stiffness of shear number `k` at `x`, as for springs.
    pub(super) fn shear_tangent(&self, k: usize, x: &[Vec3]) -> ShearTangent {
        self.shears[k].tangent(x, self.foreseen.shears.get(k).copied())
    }
}

impl Stretch {
    /// The load (N/m) that the linear model predicts when the vector between the ends changes from `before` to `after`,
    /// and the energy at `after` beyond that of the linear model, J.
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
