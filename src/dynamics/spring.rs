//! Springs between two nodes, and other elements that resist the extension of one span.

use super::element::{Element, ElementForeseen};
use super::stretch::{SHORTEST, Stretch, StretchLaw, StretchTangent};
use crate::geometry::{Mat3, Vec3};

/// A spring between two nodes.
#[derive(Clone, Copy, Debug)]
pub struct Spring {
    /// Its nodes.
    pub ends: [u32; 2],
    /// Its resistance.
    pub stretch: Stretch,
}

/// An element that resists the extension of one span between its nodes.
pub(super) trait Stretched: Copy + Send + Sync {
    /// Its nodes.
    fn nodes(&self) -> &[u32];

    /// Weight of each node in the span.
    fn shares(&self) -> [f64; 3];

    /// The span, for positions or displacements of the nodes.
    fn span(&self, x: &[Vec3]) -> Vec3;

    /// Its resistance.
    fn stretch(&self) -> &Stretch;

    /// Its law.
    fn law<'a>(&self, laws: &'a [StretchLaw]) -> &'a StretchLaw {
        &laws[self.stretch().law as usize]
    }
}

impl Stretched for Spring {
    fn nodes(&self) -> &[u32] {
        &self.ends
    }

    fn shares(&self) -> [f64; 3] {
        [-1.0, 1.0, 0.0]
    }

    fn span(&self, x: &[Vec3]) -> Vec3 {
        x[self.ends[1] as usize] - x[self.ends[0] as usize]
    }

    fn stretch(&self) -> &Stretch {
        &self.stretch
    }
}

impl<S: Stretched> Element<3> for S {
    type Tangent = StretchTangent;
    /// Per displacement of the span.
    type Bound = Mat3;

    fn nodes(&self) -> &[u32] {
        Stretched::nodes(self)
    }

    fn energy(&self, laws: &[StretchLaw], x: &[Vec3]) -> f64 {
        self.stretch().energy(self.law(laws), self.span(x))
    }

    fn forces(&self, laws: &[StretchLaw], x: &[Vec3]) -> [Vec3; 3] {
        let f = self.stretch().pull(self.law(laws), self.span(x));
        self.shares().map(|share| f * -share)
    }

    fn tangent(&self, laws: &[StretchLaw], x: &[Vec3], load: Option<f64>) -> StretchTangent {
        self.stretch().tangent(self.law(laws), self.span(x), load)
    }

    fn add_row(&self, tangent: &StretchTangent, corner: usize, add: impl FnMut(usize, Mat3)) {
        tangent.add_row(&self.shares()[..Stretched::nodes(self).len()], corner, add);
    }

    fn bound(tangent: &StretchTangent) -> Mat3 {
        tangent.bound()
    }

    fn bound_block(&self, bound: &Mat3, i: usize, j: usize) -> Mat3 {
        let shares = self.shares();
        bound * (shares[i] * shares[j])
    }

    fn foresee(&self, laws: &[StretchLaw], x: &[Vec3], to: &[Vec3]) -> ElementForeseen {
        self.stretch().foresee(self.law(laws), self.span(x), self.span(to))
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
