//! One triangle: its true shape, and what moving its corners does to its Jacobian.

use nalgebra::Matrix2;

use crate::geometry::{Vec2, Vec3};

/// A triangle's true shape, prepared.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatElement {
    /// Its corners in the flat piece.
    pub(super) corners: [u32; 3],
    /// Gradients of the corners' hat functions in the triangle's own plane, 1/m: J = Σ xₖ gₖᵀ.
    pub(super) gradients: [Vec2; 3],
    /// Its share in the energy: true area, m².
    pub(super) area: f64,
}

/// A direction of curvature of an energy density: `curvature` times the dyad of `mode` with itself.
pub(super) struct CurvatureMode {
    pub(super) curvature: f64,
    pub(super) mode: Matrix2<f64>,
}

/// How much of a second derivative is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Taken {
    /// Of every triangle and spring the positive part, so that all together are positive for certain. Where the
    /// negative parts weigh as much, this is far too stiff.
    Positive,
    /// All of it, which is the true one.
    All,
}

impl Taken {
    /// A curvature as far as it is taken.
    pub(super) fn of(self, curvature: f64) -> f64 {
        if self == Self::All { curvature } else { curvature.max(0.0) }
    }
}

/// The pairs of corners a block of second derivatives belongs to.
pub(super) const CORNER_PAIRS: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (1, 0), (2, 0), (2, 1)];

impl FlatElement {
    /// From the true corner positions; the triangle must have an area.
    pub(super) fn new(corners: [u32; 3], [a, b, c]: [Vec3; 3]) -> Self {
        let (u, v) = (b - a, c - a);
        let length = u.norm();
        let along = u.dot(&v) / length;
        let height = u.cross(&v).norm() / length;
        Self::from_plane(corners, [Vec2::zeros(), Vec2::new(length, 0.0), Vec2::new(along, height)])
    }

    /// From a shape in its own plane, corners running so that the area is positive.
    pub(super) fn from_plane(corners: [u32; 3], [a, b, c]: [Vec2; 3]) -> Self {
        let double_area = (b - a).perp(&(c - a));
        let turned = |d: Vec2| Vec2::new(-d.y, d.x) / double_area;
        let gradients = [turned(c - b), turned(a - c), turned(b - a)];
        Self { corners, gradients, area: 0.5 * double_area }
    }

    /// J for the given flat positions.
    pub(super) fn jacobian(&self, flat: &[Vec2]) -> Matrix2<f64> {
        let [a, b, c] = self.corners.map(|v| flat[v as usize]);
        let [_, gb, gc] = self.gradients;
        // The gradients sum to zero, so differences to the first corner do.
        (b - a) * gb.transpose() + (c - a) * gc.transpose()
    }

    /// Derivatives of a density by the corner positions, from its derivative by J.
    pub(super) fn forces(&self, stress: &Matrix2<f64>) -> [Vec2; 3] {
        self.gradients.map(|g| stress * g)
    }

    /// Adds a mode's second derivatives by the corner positions, one block for each of [`CORNER_PAIRS`]. Without modes
    /// of negative curvature what remains is the nearest positive semidefinite matrix.
    pub(super) fn add_mode(&self, mode: &CurvatureMode, taken: Taken, blocks: &mut [Matrix2<f64>; 6]) {
        let curvature = taken.of(mode.curvature);
        if curvature != 0.0 {
            let images = self.gradients.map(|g| mode.mode * g);
            for (block, (k, l)) in blocks.iter_mut().zip(CORNER_PAIRS) {
                *block += images[k] * images[l].transpose() * curvature;
            }
        }
    }
}
