//! Energies of a few nodes each: the elements that the cloth is made of.
//!
//! An element says of itself what a step needs to know: its energy, its forces, its true stiffness and a bound of that.
//! [`super::membrane`] evaluates elements that every node has many of, [`super::scattered`] those that are few.

use super::stretch::StretchLaw;
use crate::geometry::{Mat3, Vec3};

/// An energy of a few nodes.
///
/// `N` is the length of its arrays: an element of fewer nodes leaves the last entries zero. `laws` are those of the
/// cloth, for elements that resist by one of them.
pub(super) trait Element<const N: usize>: Copy + Send + Sync {
    /// The true stiffness at one position, in as few numbers as describe it.
    type Tangent: Send + Sync;
    /// A positive semidefinite bound of it, in as few numbers as describe it.
    type Bound: Send + Sync;

    /// Its nodes, at most `N`, all different.
    fn nodes(&self) -> &[u32];

    /// Energy at `x`, J.
    fn energy(&self, laws: &[StretchLaw], x: &[Vec3]) -> f64;

    /// Forces on its nodes at `x`, N.
    fn forces(&self, laws: &[StretchLaw], x: &[Vec3]) -> [Vec3; N];

    /// The true stiffness at `x`. Its geometric part uses the `load` that the last step predicted, if there is one.
    fn tangent(&self, laws: &[StretchLaw], x: &[Vec3], load: Option<f64>) -> Self::Tangent;

    /// Row of the node number `corner` of the element: calls `add` with the number of each of its nodes and the block
    /// by which a displacement of that node is resisted, N/m.
    fn add_row(&self, tangent: &Self::Tangent, corner: usize, add: impl FnMut(usize, Mat3));

    /// The bound of a stiffness.
    fn bound(tangent: &Self::Tangent) -> Self::Bound;

    /// Block of a bound for the nodes number `i` (rows) and `j` (columns) of the element, N/m.
    fn bound_block(&self, bound: &Self::Bound, i: usize, j: usize) -> Mat3;

    /// Prediction of the linear model of a step from `x` to `to`. An element whose stiffness uses no predicted load
    /// predicts none.
    fn foresee(&self, laws: &[StretchLaw], _x: &[Vec3], to: &[Vec3]) -> ElementForeseen {
        ElementForeseen { load: 0.0, beyond: 0.0, energy: self.energy(laws, to) }
    }

    /// Resistance of its nodes to the displacements `p` of all nodes, N.
    fn resist(&self, tangent: &Self::Tangent, p: &[Vec3]) -> [Vec3; N] {
        let mut out = [Vec3::zeros(); N];
        for (corner, out) in out.iter_mut().enumerate().take(self.nodes().len()) {
            self.add_row(tangent, corner, |k, block| *out += block * p[self.nodes()[k] as usize]);
        }
        out
    }

    /// Updates its memory after its nodes moved to `x`.
    fn follow(&mut self, _x: &[Vec3]) {}
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

/// Pairs of the nodes of an element.
pub(super) fn pairs(nodes: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    (1..nodes.len()).flat_map(move |j| (0..j).map(move |i| [nodes[i], nodes[j]]))
}

/// Whether any of these `nodes` is free to move.
pub(super) fn moves(nodes: &[u32], is_held: &[bool]) -> bool {
    nodes.iter().any(|&n| !is_held[n as usize])
}

/// The span with `weights` of the sides from the first of the `nodes` to the others, for positions or displacements.
pub(super) fn span(nodes: [u32; 3], weights: [f64; 2], x: &[Vec3]) -> Vec3 {
    let [a, b, c] = nodes.map(|n| x[n as usize]);
    (b - a) * weights[0] + (c - a) * weights[1]
}

/// Weight of each node in a span with these `weights` of the sides.
pub(super) fn shares([b, c]: [f64; 2]) -> [f64; 3] {
    [-b - c, b, c]
}
