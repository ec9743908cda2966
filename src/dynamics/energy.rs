//! The interface of every energy that acts on the cloth: springs and bending as well as weight and stitches.
//!
//! A step asks four things of an energy: its value, its forces, its true stiffness, and a positive definite bound of
//! the stiffness that can be factored. Energies of many elements *gather*: every node adds up what its elements exert,
//! nodes side by side. Energies of few elements *scatter*: one thread goes through them afterwards and adds to their
//! nodes. Two energies together are an energy again, so that one pass over the nodes serves all of them. Every call is
//! resolved when the program is built.
//!
//! Contact and friction are no [`Energy`]: which contacts push, stick or slide is found in the rounds of a step, and
//! friction has an energy only at given normal forces. The stiffness of one such choice is a [`Stiffness`] and has a
//! [`Bound`] like any other ([`super::touching`]).

use crate::geometry::{Mat3, Vec3};
use crate::linear::{BlockColumn, SymmetricMatrix};
use crate::parallel::{self, MEDIUM};

/// An energy over the nodes of the cloth.
pub(super) trait Energy {
    /// Its value at `x`, J.
    fn energy(&self, x: &[Vec3]) -> f64;

    /// Its forces at `x`: minus the gradient of the energy.
    fn forces<'a>(&'a self, x: &'a [Vec3]) -> impl Exerted + 'a;

    /// Its true stiffness at `x`: minus the gradient of the forces.
    fn stiffness<'a>(&'a self, x: &'a [Vec3]) -> impl Stiffness + 'a;

    /// A positive semidefinite bound of the stiffness at `x`.
    fn bound<'a>(&'a self, x: &'a [Vec3]) -> impl Bound + 'a;

    /// Pairs of nodes between which the bound has a block.
    fn pairs(&self) -> impl Iterator<Item = [u32; 2]>;
}

/// An energy of the cloth itself, which can have a memory and can be restricted to a part of the cloth.
pub(super) trait Elastic: Energy + Sized {
    /// Loads as a step predicts them.
    type Loads: Default;

    /// Prediction of the linear model of a step from `x` to `to`. Most energies predict no loads.
    fn foresee(&self, _x: &[Vec3], to: &[Vec3]) -> Foreseen<Self::Loads> {
        Foreseen { loads: Self::Loads::default(), beyond: 0.0, energy: self.energy(to) }
    }

    /// Updates the memory after the cloth moved to `x`. `foreseen` are the loads that the step predicted (default:
    /// none).
    fn follow(&mut self, _x: &[Vec3], _foreseen: Self::Loads) {}

    /// The energy without what acts between held nodes only.
    fn around(&self, is_held: &[bool]) -> Self;

    /// Takes the memory of a `part` back that is the energy around the nodes of `is_held`.
    fn take_back(&mut self, _part: &Self, _is_held: &[bool]) {}
}

/// Prediction of a step.
#[derive(Default)]
pub(super) struct Foreseen<Loads> {
    /// The loads.
    pub(super) loads: Loads,
    /// Energy at the end of the step beyond that of the linear model, J.
    pub(super) beyond: f64,
    /// Energy at the end of the step, J.
    pub(super) energy: f64,
}

/// Forces on the nodes, or the resistance of a stiffness to displacements, N.
pub(super) trait Exerted: Sync {
    /// `sum` and what acts on a `node`.
    fn gather(&self, _node: usize, sum: Vec3) -> Vec3 {
        sum
    }

    /// Adds to every node what has not been gathered.
    fn scatter(&self, _out: &mut [Vec3]) {}
}

/// A stiffness at one position.
pub(super) trait Stiffness: Sync {
    /// Its resistance to the displacements `p` of the nodes.
    fn times<'a>(&'a self, p: &'a [Vec3]) -> impl Exerted + 'a;
}

/// A positive semidefinite bound of a stiffness, N/m.
pub(super) trait Bound: Sync {
    /// The part of a node's diagonal block that is the same in all directions.
    fn isotropic(&self, _node: usize) -> f64 {
        0.0
    }

    /// Adds the blocks of a node's column, besides the isotropic part.
    fn gather(&self, _node: usize, _column: &mut BlockColumn<f32>) {}

    /// Adds the blocks that have not been gathered.
    fn scatter(&self, _matrix: &mut SymmetricMatrix<f32>) {}
}

/// All that is `exerted` on each of `count` nodes, added to the `first` on it, N.
pub(super) fn on_nodes(count: usize, first: impl Fn(usize) -> Vec3 + Sync, exerted: &impl Exerted) -> Vec<Vec3> {
    let mut out = parallel::map(count, MEDIUM, |node| exerted.gather(node, first(node)));
    exerted.scatter(&mut out);
    out
}

/// Fills a `matrix` with the `bound` and the isotropic part `first` of every node, N/m.
pub(super) fn fill(matrix: &mut SymmetricMatrix<f32>, first: impl Fn(usize) -> f64 + Sync, bound: &impl Bound) {
    matrix.refill(|node, mut column| {
        column.add_diagonal(&(Mat3::identity() * (first(node) + bound.isotropic(node))));
        bound.gather(node, &mut column);
    });
    bound.scatter(matrix);
}

/// No energy, no forces, no stiffness.
impl Exerted for () {}

impl Stiffness for () {
    fn times<'a>(&'a self, _p: &'a [Vec3]) -> impl Exerted + 'a {}
}

impl Bound for () {}

impl<T: Stiffness> Stiffness for &T {
    fn times<'a>(&'a self, p: &'a [Vec3]) -> impl Exerted + 'a {
        (**self).times(p)
    }
}

impl<T: Bound> Bound for &T {
    fn isotropic(&self, node: usize) -> f64 {
        (**self).isotropic(node)
    }

    fn gather(&self, node: usize, column: &mut BlockColumn<f32>) {
        (**self).gather(node, column);
    }

    fn scatter(&self, matrix: &mut SymmetricMatrix<f32>) {
        (**self).scatter(matrix);
    }
}

impl<T: Exerted> Exerted for Option<T> {
    fn gather(&self, node: usize, sum: Vec3) -> Vec3 {
        self.as_ref().map_or(sum, |exerted| exerted.gather(node, sum))
    }

    fn scatter(&self, out: &mut [Vec3]) {
        self.iter().for_each(|exerted| exerted.scatter(out));
    }
}

impl<A: Exerted, B: Exerted> Exerted for (A, B) {
    fn gather(&self, node: usize, sum: Vec3) -> Vec3 {
        self.1.gather(node, self.0.gather(node, sum))
    }

    fn scatter(&self, out: &mut [Vec3]) {
        self.0.scatter(out);
        self.1.scatter(out);
    }
}

impl<A: Stiffness, B: Stiffness> Stiffness for (A, B) {
    fn times<'a>(&'a self, p: &'a [Vec3]) -> impl Exerted + 'a {
        (self.0.times(p), self.1.times(p))
    }
}

impl<A: Bound, B: Bound> Bound for (A, B) {
    fn isotropic(&self, node: usize) -> f64 {
        self.0.isotropic(node) + self.1.isotropic(node)
    }

    fn gather(&self, node: usize, column: &mut BlockColumn<f32>) {
        self.0.gather(node, column);
        self.1.gather(node, column);
    }

    fn scatter(&self, matrix: &mut SymmetricMatrix<f32>) {
        self.0.scatter(matrix);
        self.1.scatter(matrix);
    }
}
