//! Stitches that are being closed (F5).

use super::element::Element;
use super::stretch::{SHORTEST, StretchLaw, StretchTangent};
use crate::geometry::{Mat3, Vec3};

/// Least gap in the stiffness of a pull, metres: it keeps the stiffness finite.
const LEAST_GAP: f64 = 1e-12;

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

impl Pull {
    fn span(&self, x: &[Vec3]) -> Vec3 {
        x[self.ends[1] as usize] - x[self.ends[0] as usize]
    }

    /// Force over gap at `x`, N/m.
    fn stiffness_at(&self, x: &[Vec3]) -> f64 {
        self.stiffness * (self.cap / self.span(x).norm().max(LEAST_GAP)).min(1.0)
    }
}

impl Element<4> for Pull {
    type Tangent = StretchTangent;
    type Bound = Mat3;

    fn nodes(&self) -> &[u32] {
        &self.ends
    }

    fn energy(&self, _laws: &[StretchLaw], x: &[Vec3]) -> f64 {
        let gap = self.span(x).norm();
        let soft = gap.min(self.cap);
        self.stiffness * soft * (gap - 0.5 * soft)
    }

    fn forces(&self, _laws: &[StretchLaw], x: &[Vec3]) -> [Vec3; 4] {
        let f = self.span(x) * self.stiffness_at(x);
        [f, -f, Vec3::zeros(), Vec3::zeros()]
    }

    fn tangent(&self, _laws: &[StretchLaw], x: &[Vec3], _load: Option<f64>) -> StretchTangent {
        let (span, across) = (self.span(x), self.stiffness_at(x));
        let length = span.norm();
        let along = if length > self.cap { 0.0 } else { across };
        StretchTangent { direction: span / length.max(SHORTEST), along, across }
    }

    fn add_row(&self, tangent: &StretchTangent, corner: usize, add: impl FnMut(usize, Mat3)) {
        tangent.add_row(&[-1.0, 1.0], corner, add);
    }

    fn bound(tangent: &StretchTangent) -> Mat3 {
        tangent.bound()
    }

    fn bound_block(&self, bound: &Mat3, i: usize, j: usize) -> Mat3 {
        bound * if i == j { 1.0 } else { -1.0 }
    }
}
