//! Energies of elements that are few, such as creases and open stitches: one thread adds them to their nodes.

use std::borrow::Cow;

use super::element::{Element, moves, pairs};
use super::energy::{Bound, Elastic, Energy, Exerted, Stiffness};
use crate::geometry::Vec3;
use crate::linear::SymmetricMatrix;

/// Elements of one kind, of at most four nodes.
#[derive(Clone, Debug)]
pub(super) struct Scattered<'a, E: Clone>(pub(super) Cow<'a, [E]>);

impl<E: Clone> Default for Scattered<'_, E> {
    fn default() -> Self {
        Self(Cow::Borrowed(&[]))
    }
}

/// Forces of elements at `x`.
struct ScatteredForces<'a, E> {
    elements: &'a [E],
    x: &'a [Vec3],
}

/// Stiffness of elements at one position.
struct ScatteredStiffness<'a, E: Element<4>> {
    elements: &'a [E],
    tangents: Vec<E::Tangent>,
}

/// Resistance of a stiffness to displacements.
struct ScatteredResistance<'a, E: Element<4>> {
    of: &'a ScatteredStiffness<'a, E>,
    p: &'a [Vec3],
}

/// Adds what an element exerts to its nodes.
fn add(out: &mut [Vec3], nodes: &[u32], exerted: [Vec3; 4]) {
    nodes.iter().zip(exerted).for_each(|(&node, f)| out[node as usize] += f);
}

impl<E: Element<4>> Exerted for ScatteredForces<'_, E> {
    fn scatter(&self, out: &mut [Vec3]) {
        self.elements.iter().for_each(|e| add(out, e.nodes(), e.forces(&[], self.x)));
    }
}

impl<E: Element<4>> Stiffness for ScatteredStiffness<'_, E> {
    fn times<'a>(&'a self, p: &'a [Vec3]) -> impl Exerted + 'a {
        ScatteredResistance { of: self, p }
    }
}

impl<E: Element<4>> Exerted for ScatteredResistance<'_, E> {
    fn scatter(&self, out: &mut [Vec3]) {
        let ScatteredStiffness { elements, tangents } = self.of;
        elements.iter().zip(tangents).for_each(|(e, tangent)| add(out, e.nodes(), e.resist(tangent, self.p)));
    }
}

impl<E: Element<4>> Bound for ScatteredStiffness<'_, E> {
    /// Blocks of held nodes are not in the pattern and are left out.
    fn scatter(&self, matrix: &mut SymmetricMatrix<f32>) {
        for (element, tangent) in self.elements.iter().zip(&self.tangents) {
            let (nodes, bound) = (element.nodes(), E::bound(tangent));
            for i in 0..nodes.len() {
                for j in 0..=i {
                    if let Some(slot) = matrix.pattern().block_slot(nodes[i] as usize, nodes[j] as usize) {
                        matrix.add_block(slot, &element.bound_block(&bound, i, j));
                    }
                }
            }
        }
    }
}

impl<E: Element<4>> Scattered<'_, E> {
    fn tangents(&self, x: &[Vec3]) -> ScatteredStiffness<'_, E> {
        ScatteredStiffness { elements: &self.0, tangents: self.0.iter().map(|e| e.tangent(&[], x, None)).collect() }
    }
}

impl<E: Element<4>> Energy for Scattered<'_, E> {
    fn energy(&self, x: &[Vec3]) -> f64 {
        self.0.iter().map(|e| e.energy(&[], x)).sum()
    }

    fn forces<'a>(&'a self, x: &'a [Vec3]) -> impl Exerted + 'a {
        ScatteredForces { elements: &self.0, x }
    }

    fn stiffness<'a>(&'a self, x: &'a [Vec3]) -> impl Stiffness + 'a {
        self.tangents(x)
    }

    fn bound<'a>(&'a self, x: &'a [Vec3]) -> impl Bound + 'a {
        self.tangents(x)
    }

    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        self.0.iter().flat_map(|e| pairs(e.nodes()))
    }
}

impl<E: Element<4>> Elastic for Scattered<'static, E> {
    type Loads = ();

    fn follow(&mut self, x: &[Vec3], (): ()) {
        self.0.to_mut().iter_mut().for_each(|e| e.follow(x));
    }

    fn around(&self, is_held: &[bool]) -> Self {
        Self(self.0.iter().filter(|e| moves(e.nodes(), is_held)).copied().collect())
    }

    fn take_back(&mut self, part: &Self, is_held: &[bool]) {
        let moved = self.0.to_mut().iter_mut().filter(|e| moves(e.nodes(), is_held));
        moved.zip(part.0.iter()).for_each(|(whole, part)| *whole = *part);
    }
}
