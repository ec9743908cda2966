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

use super::model::{Cloth, Element};
use super::part::those;
use super::shear::ShearTangent;
use super::springs::{SHORTEST, Stretch, StretchLaw, StretchTangent};
use crate::geometry::{Vec2, Vec3};
use crate::parallel::{self, MEDIUM};

/// Loads predicted by a step. An empty list means the loads at the present position.
#[derive(Clone, Debug, Default)]
pub(super) struct Loads {
    /// Of every element: N/m of springs and threads, N·m per radian of shears.
    of_elements: Vec<f64>,
}

impl Loads {
    /// The loads of the selected elements.
    pub(super) fn of(&self, elements: &[bool]) -> Self {
        Self { of_elements: those(&self.of_elements, elements) }
    }

    /// The load of an element.
    fn get(&self, element: usize) -> Option<f64> {
        self.of_elements.get(element).copied()
    }
}

/// Prediction of a step.
#[derive(Default)]
pub(super) struct Foreseen {
    /// The loads.
    pub(super) loads: Loads,
    /// Energy of the cloth beyond that of the linear model, J.
    pub(super) beyond: f64,
    /// Energy of all elements at the end of the step, J.
    pub(super) elements: f64,
}

/// Prediction for one element.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementForeseen {
    /// The load that the linear model predicts: N/m, or N·m per radian.
    pub(super) load: f64,
    /// Energy at the end of the step beyond that of the linear model, J.
    pub(super) beyond: f64,
    /// Energy at the end of the step, J.
    pub(super) energy: f64,
}

/// Tangent stiffness of an element.
#[derive(Clone, Copy, Debug)]
pub(super) enum ElementTangent {
    /// Of a spring or thread.
    Stretch(StretchTangent),
    /// Of a shear.
    Shear(ShearTangent),
}

impl Cloth {
    /// Prediction of the linear model of a step from `x` to `to`, for springs and shear.
    pub(super) fn foresee(&self, x: &[Vec3], to: &[Vec3]) -> Foreseen {
        let mut of_elements = vec![0.0; self.elements()];
        let [beyond, elements] = <[f64; 2]>::from(parallel::for_each_sum(&mut of_elements, MEDIUM, |number, load| {
            let one = match self.element(number) {
                Element::Spring(s) => s.stretch.foresee(self.law(&s.stretch), s.span(x), s.span(to)),
                Element::Thread(t) => t.stretch.foresee(self.law(&t.stretch), t.span(x), t.span(to)),
                Element::Shear(s) => s.foresee(x, to),
            };
            *load = one.load;
            Vec2::new(one.beyond, one.energy)
        }));
        Foreseen { loads: Loads { of_elements }, beyond, elements }
    }

    /// Tangent stiffness of an element at `x`. Its geometric part uses the load predicted by the last step, if there is
    /// one.
    pub(super) fn tangent(&self, number: usize, x: &[Vec3]) -> ElementTangent {
        let load = self.foreseen.get(number);
        match self.element(number) {
            Element::Spring(s) => ElementTangent::Stretch(s.stretch.tangent(self.law(&s.stretch), s.span(x), load)),
            Element::Thread(t) => ElementTangent::Stretch(t.stretch.tangent(self.law(&t.stretch), t.span(x), load)),
            Element::Shear(s) => ElementTangent::Shear(s.tangent(x, load)),
        }
    }
}

impl Stretch {
    /// Prediction of the linear model when the vector between the ends changes from `before` to `after`.
    fn foresee(&self, law: &StretchLaw, before: Vec3, after: Vec3) -> ElementForeseen {
        let length = before.norm().max(SHORTEST);
        let linear = (length + before.dot(&(after - before)) / length) / self.rest - 1.0;
        let exact = after.norm() / self.rest - 1.0;
        let (load, energy) = (law.load(linear), law.energy(exact));
        let beyond = energy - law.energy(linear) - load * (exact - linear);
        let volume = self.width * self.rest;
        ElementForeseen { load, beyond: beyond * volume, energy: energy * volume }
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
        let ElementForeseen { load, beyond, energy } = spring.foresee(&law, before, Vec3::x() * 0.0103);
        assert_relative_eq!(energy, spring.energy(&law, Vec3::x() * 0.0103), max_relative = 1e-12);
        assert_relative_eq!(load, 15.0, epsilon = 1e-9);
        assert_relative_eq!(beyond, 0.0, epsilon = 1e-15);
        // Turned by 1 mm across itself it is longer by √(10.1² + 1) − 10.1 mm.
        let ElementForeseen { load, beyond, .. } = spring.foresee(&law, before, before + Vec3::y() * 1e-3);
        assert_relative_eq!(load, 5.0, epsilon = 1e-9);
        let strain = (10.1f64.hypot(1.0) - 10.1) / 10.0;
        assert_relative_eq!(beyond, 0.5 * 500.0 * strain * strain * 0.02 * 0.01, max_relative = 1e-9);
        let tangent = spring.tangent(&law, before, Some(3.0));
        assert_relative_eq!(tangent.across, 3.0 * 0.02 / 0.0101, max_relative = 1e-12);
    }
}
