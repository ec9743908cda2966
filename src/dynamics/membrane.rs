//! Stretch and shear within the plane of the cloth.
//!
//! # Loads as predicted by the linear model of the last Newton step
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

use std::sync::Arc;

use super::element::{moves, pairs};
use super::elements::{AnyBound, AnyTangent, Elements, those};
use super::energy::{Bound, Elastic, Energy, Exerted, Foreseen, Stiffness};
use super::links::Links;
use super::stretch::StretchLaw;
use crate::geometry::{Mat3, Vec2, Vec3};
use crate::linear::BlockColumn;
use crate::parallel::{self, MEDIUM};

/// The elements of the cloth that resist stretch and shear, with their laws.
#[derive(Clone, Debug, Default)]
pub struct Membrane {
    elements: Elements,
    laws: Vec<StretchLaw>,
    /// The elements at every node.
    links: Arc<Links>,
    /// Load of every element as the last step predicted it: N/m of springs and threads, N·m per radian of shears. Empty
    /// = the loads at the present position.
    loads: Vec<f64>,
}

/// Forces of every element.
struct MembraneForces<'a> {
    links: &'a Links,
    forces: Vec<[Vec3; 3]>,
}

/// True stiffness: a symmetric matrix of 3×3 blocks in the places of [`Links`], N/m.
struct MembraneStiffness<'a> {
    links: &'a Links,
    blocks: Vec<Mat3>,
}

/// A [`MembraneStiffness`] times displacements.
struct MembraneResistance<'a> {
    matrix: &'a MembraneStiffness<'a>,
    p: &'a [Vec3],
}

/// Bound of the stiffness of every element.
struct MembraneBound<'a> {
    membrane: &'a Membrane,
    bounds: Vec<AnyBound>,
}

impl Exerted for MembraneForces<'_> {
    fn gather(&self, node: usize, sum: Vec3) -> Vec3 {
        self.links.at(node).iter().fold(sum, |sum, l| sum + self.forces[l.element as usize][l.corner as usize])
    }
}

impl Stiffness for MembraneStiffness<'_> {
    fn times<'a>(&'a self, p: &'a [Vec3]) -> impl Exerted + 'a {
        MembraneResistance { matrix: self, p }
    }
}

impl Exerted for MembraneResistance<'_> {
    fn gather(&self, node: usize, sum: Vec3) -> Vec3 {
        let MembraneStiffness { links, blocks } = self.matrix;
        let row = links.rows()[node] as usize..links.rows()[node + 1] as usize;
        let row = links.columns()[row.clone()].iter().zip(&blocks[row]);
        sum + row.fold(Vec3::zeros(), |sum, (&column, block)| sum + block * self.p[column as usize])
    }
}

impl Bound for MembraneBound<'_> {
    fn gather(&self, node: usize, column: &mut BlockColumn<f32>) {
        for link in self.membrane.links.at(node) {
            let (number, corner) = (link.element as usize, link.corner as usize);
            let (element, bound) = (self.membrane.elements.get(number), &self.bounds[number]);
            for (k, &other) in element.nodes().iter().enumerate() {
                if k == corner {
                    column.add_diagonal(&element.bound_block(bound, k, k));
                } else if other as usize > node {
                    column.add_below(other, &element.bound_block(bound, k, corner));
                }
            }
        }
    }
}

impl Membrane {
    /// A membrane of `elements` between so many `nodes`.
    pub fn new(nodes: usize, elements: Elements, laws: Vec<StretchLaw>) -> Self {
        let links = Arc::new(Links::new(nodes, &elements));
        Self { elements, laws, links, loads: Vec::new() }
    }

    /// Its elements.
    pub fn elements(&self) -> &Elements {
        &self.elements
    }

    /// Laws of springs and threads.
    pub fn laws(&self) -> &[StretchLaw] {
        &self.laws
    }

    fn tangent(&self, number: usize, x: &[Vec3]) -> AnyTangent {
        self.elements.get(number).tangent(&self.laws, x, self.loads.get(number).copied())
    }
}

impl Energy for Membrane {
    fn energy(&self, x: &[Vec3]) -> f64 {
        parallel::sum(self.elements.len(), MEDIUM, |number| self.elements.get(number).energy(&self.laws, x))
    }

    fn forces<'a>(&'a self, x: &'a [Vec3]) -> impl Exerted + 'a {
        let of_element = |number| self.elements.get(number).forces(&self.laws, x);
        MembraneForces { links: &self.links, forces: parallel::map(self.elements.len(), MEDIUM, of_element) }
    }

    fn stiffness<'a>(&'a self, x: &'a [Vec3]) -> impl Stiffness + 'a {
        let tangents = parallel::map(self.elements.len(), MEDIUM, |number| self.tangent(number, x));
        let mut blocks = vec![Mat3::zeros(); self.links.columns().len()];
        parallel::for_each_row(&mut blocks, self.links.rows(), MEDIUM, |node, row| {
            for link in self.links.at(node) {
                let number = link.element as usize;
                let add = |k: usize, block: Mat3| row[link.slots[k] as usize] += block;
                self.elements.get(number).add_row(&tangents[number], link.corner as usize, add);
            }
        });
        MembraneStiffness { links: &self.links, blocks }
    }

    fn bound<'a>(&'a self, x: &'a [Vec3]) -> impl Bound + 'a {
        let bounds = parallel::map(self.elements.len(), MEDIUM, |number| self.tangent(number, x).bound());
        MembraneBound { membrane: self, bounds }
    }

    fn pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        (0..self.elements.len()).flat_map(|number| pairs(self.elements.get(number).nodes()))
    }
}

impl Elastic for Membrane {
    type Loads = Vec<f64>;

    fn foresee(&self, x: &[Vec3], to: &[Vec3]) -> Foreseen<Vec<f64>> {
        let mut loads = vec![0.0; self.elements.len()];
        let [beyond, energy] = <[f64; 2]>::from(parallel::for_each_sum(&mut loads, MEDIUM, |number, load| {
            let one = self.elements.get(number).foresee(&self.laws, x, to);
            *load = one.load;
            Vec2::new(one.beyond, one.energy)
        }));
        Foreseen { loads, beyond, energy }
    }

    fn follow(&mut self, _x: &[Vec3], foreseen: Vec<f64>) {
        self.loads = foreseen;
    }

    fn around(&self, is_held: &[bool]) -> Self {
        let all = 0..self.elements.len();
        let wanted: Vec<bool> = all.map(|number| moves(self.elements.get(number).nodes(), is_held)).collect();
        let loads = those(&self.loads, &wanted);
        Self { loads, ..Self::new(self.links.nodes(), self.elements.those(&wanted), self.laws.clone()) }
    }
}
