//! One triangle: its true shape, and what moving its corners does to its Jacobian.

use nalgebra::Matrix2;

use crate::geometry::{Vec2, Vec3};

/// A triangle's true shape, prepared. Its flat image follows `N` points: its own corners, or those of a grid that it is
/// moved by.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatElement<const N: usize = 3> {
    /// The points.
    pub(super) corners: [u32; N],
    /// Gradients of the points' functions in the triangle's own plane, 1/m: J = Σ xₖ gₖᵀ. They sum to zero.
    pub(super) gradients: [Vec2; N],
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

/// The pairs (k, l), l not above k, of `n` points, each of which has a block of second derivatives.
pub(super) fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(|k| (0..=k).map(move |l| (k, l)))
}

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
}

impl<const N: usize> FlatElement<N> {
    /// J for the given flat positions.
    #[inline]
    pub(super) fn jacobian(&self, flat: &[Vec2]) -> Matrix2<f64> {
        let first = flat[self.corners[0] as usize];
        let mut sum = [0.0; 4];
        // The gradients sum to zero, so differences to the first point do.
        for (&v, g) in self.corners[1..].iter().zip(&self.gradients[1..]) {
            let d = flat[v as usize] - first;
            sum[0] += d.x * g.x;
            sum[1] += d.y * g.x;
            sum[2] += d.x * g.y;
            sum[3] += d.y * g.y;
        }
        Matrix2::new(sum[0], sum[2], sum[1], sum[3])
    }

    /// Derivatives of a density by the points, from its derivative by J.
    #[inline]
    pub(super) fn forces(&self, stress: &Matrix2<f64>) -> [Vec2; N] {
        self.gradients.map(|g| stress * g)
    }

    /// Hands out the second derivatives by the points, one block for each of [`pairs`], of a density with this second
    /// derivative by J.
    #[inline]
    pub(super) fn blocks(&self, hessian: &Hessian, mut add: impl FnMut(Matrix2<f64>)) {
        let by_column = |g: &Vec2, s: usize| [0, 1, 2, 3].map(|i| hessian.0[i][s] * g.x + hessian.0[i][s + 2] * g.y);
        let sides = self.gradients.map(|g| [by_column(&g, 0), by_column(&g, 1)]);
        for (k, g) in self.gradients.iter().enumerate() {
            for [x, y] in &sides[..=k] {
                let row = |column: &[f64; 4], r: usize| g.x * column[r] + g.y * column[r + 2];
                add(Matrix2::new(row(x, 0), row(y, 0), row(x, 1), row(y, 1)));
            }
        }
    }
}

/// The second derivative of a density by the four numbers of J, column by column.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Hessian(pub(super) [[f64; 4]; 4]);

impl Hessian {
    /// Adds a direction of curvature, as far as it is taken.
    #[inline]
    pub(super) fn add(&mut self, mode: &CurvatureMode, taken: Taken) {
        let curvature = taken.of(mode.curvature);
        for i in 0..4 {
            for j in 0..4 {
                self.0[i][j] += curvature * mode.mode[i] * mode.mode[j];
            }
        }
    }
}
