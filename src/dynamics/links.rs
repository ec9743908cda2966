//! The springs, threads and shears that meet at each node, and the stiffness matrix that they add up to.
//!
//! Elements are evaluated side by side, and then every node gathers from its own. So no two threads write to one place,
//! and a node's sum has the order of the elements.

use super::foreseen::ElementTangent;
use super::model::{Cloth, Element};
use super::thread::shares;
use crate::geometry::{Mat3, Vec3};
use crate::parallel::{self, MEDIUM};

/// An element at one of its nodes.
#[derive(Clone, Copy, Debug)]
struct ElementAtNode {
    element: u32,
    /// Which of the element's nodes it is.
    corner: u8,
    /// Place of each of the element's nodes among the columns of the row.
    slots: [u16; 3],
}

/// The elements at every node of a cloth. They hold as long as its springs, threads and shears stay the same.
#[derive(Debug)]
pub(super) struct Links {
    /// Start of every node's links, and their total.
    starts: Vec<u32>,
    /// Rising by elements.
    links: Vec<ElementAtNode>,
    /// Start of every row of the stiffness matrix in `columns`, and their total.
    rows: Vec<u32>,
    /// The nodes that each node is coupled to by elements, itself included, rising.
    columns: Vec<u32>,
}

/// Stiffness of all elements: a symmetric matrix of 3×3 blocks in the places of [`Links`], N/m.
pub(super) struct Stiffness(Vec<Mat3>);

impl Links {
    /// The links of `cloth`.
    pub(super) fn new(cloth: &Cloth) -> Self {
        let nodes = cloth.mass.len();
        let mut starts = vec![0u32; nodes + 1];
        let all = || (0..cloth.elements()).map(|element| (element, cloth.element(element).nodes()));
        for (_, of_element) in all() {
            of_element.iter().for_each(|&n| starts[n as usize + 1] += 1);
        }
        for n in 0..nodes {
            starts[n + 1] += starts[n];
        }
        let mut next = starts.clone();
        let mut links = vec![ElementAtNode { element: 0, corner: 0, slots: [0; 3] }; starts[nodes] as usize];
        for (element, of_element) in all() {
            for (corner, &n) in of_element.iter().enumerate() {
                let at = &mut next[n as usize];
                (links[*at as usize].element, links[*at as usize].corner) = (element as u32, corner as u8);
                *at += 1;
            }
        }
        let mut out = Self { starts, links, rows: vec![0], columns: Vec::new() };
        (0..nodes).for_each(|node| out.add_row(cloth, node));
        out
    }

    /// Adds the row of a node to the matrix, and the places of its elements' nodes in it.
    fn add_row(&mut self, cloth: &Cloth, node: usize) {
        let own = &mut self.links[self.starts[node] as usize..self.starts[node + 1] as usize];
        let of = |link: &ElementAtNode| -> &[u32] { cloth.element(link.element as usize).nodes() };
        let mut row: Vec<u32> = own.iter().flat_map(of).copied().collect();
        row.sort_unstable();
        row.dedup();
        for link in own {
            for (k, node) in of(link).iter().enumerate() {
                link.slots[k] = row.partition_point(|n| n < node) as u16;
            }
        }
        self.columns.extend(row);
        self.rows.push(self.columns.len() as u32);
    }

    fn links(&self, node: usize) -> &[ElementAtNode] {
        &self.links[self.starts[node] as usize..self.starts[node + 1] as usize]
    }

    /// The elements at a node, rising, each with the number of the node among its own.
    pub(super) fn at(&self, node: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.links(node).iter().map(|link| (link.element as usize, link.corner as usize))
    }

    /// Adds the forces of springs, threads and shears at `x` to the `first` on each node, N.
    pub(super) fn forces(&self, cloth: &Cloth, x: &[Vec3], first: impl Fn(usize) -> Vec3 + Sync) -> Vec<Vec3> {
        let forces = parallel::map(cloth.elements(), MEDIUM, |number| force(cloth, x, number));
        let add = |sum: Vec3, link: &ElementAtNode| sum + forces[link.element as usize][link.corner as usize];
        parallel::map(x.len(), MEDIUM, |node| self.links(node).iter().fold(first(node), add))
    }

    /// The true stiffness of springs, threads and shears at `x`.
    pub(super) fn stiffness(&self, cloth: &Cloth, x: &[Vec3]) -> Stiffness {
        let tangents = parallel::map(cloth.elements(), MEDIUM, |number| cloth.tangent(number, x));
        let mut blocks = vec![Mat3::zeros(); self.columns.len()];
        parallel::for_each_row(&mut blocks, &self.rows, MEDIUM, |node, row| {
            for link in self.links(node) {
                let (number, corner) = (link.element as usize, link.corner as usize);
                let mut add = |k: usize, block: Mat3| row[link.slots[k] as usize] += block;
                match (cloth.element(number), &tangents[number]) {
                    (Element::Thread(thread), ElementTangent::Stretch(tangent)) => {
                        let (block, shares) = (tangent.matrix(), thread.shares());
                        (0..3).for_each(|k| add(k, block * (shares[corner] * shares[k])));
                    }
                    (_, ElementTangent::Stretch(tangent)) => {
                        let block = tangent.matrix();
                        add(corner, block);
                        add(1 - corner, -block);
                    }
                    (Element::Shear(shear), ElementTangent::Shear(tangent)) => {
                        let of_legs = shear.legs.map(shares);
                        let legs = tangent.row(of_legs.map(|shares| shares[corner]));
                        (0..3).for_each(|k| add(k, legs[0] * of_legs[0][k] + legs[1] * of_legs[1][k]));
                    }
                    _ => {}
                }
            }
        });
        Stiffness(blocks)
    }

    /// Row `node` of the stiffness times `p`.
    pub(super) fn times(&self, stiffness: &Stiffness, p: &[Vec3], node: usize) -> Vec3 {
        let row = self.rows[node] as usize..self.rows[node + 1] as usize;
        let blocks = self.columns[row.clone()].iter().zip(&stiffness.0[row]);
        blocks.fold(Vec3::zeros(), |sum, (&column, block)| sum + block * p[column as usize])
    }
}

/// Forces of an element on its nodes at `x`, N.
fn force(cloth: &Cloth, x: &[Vec3], number: usize) -> [Vec3; 3] {
    match cloth.element(number) {
        Element::Spring(spring) => {
            let f = spring.stretch.pull(cloth.law(&spring.stretch), spring.span(x));
            [f, -f, Vec3::zeros()]
        }
        Element::Thread(thread) => {
            let f = thread.stretch.pull(cloth.law(&thread.stretch), thread.span(x));
            thread.shares().map(|share| f * -share)
        }
        Element::Shear(shear) => shear.forces(x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::bending::Bending;
    use crate::dynamics::foreseen::Loads;
    use crate::dynamics::shear::Shear;
    use crate::dynamics::springs::{Spring, Stretch, StretchLaw};
    use crate::dynamics::thread::Thread;

    /// Four nodes with a spring of each sign, a thread and a shear askew to the sides of its triangle.
    fn cloth() -> Cloth {
        let stretch = |rest: f64| Stretch { rest, width: 0.01, law: 0 };
        let spring = |ends, rest| Spring { ends, stretch: stretch(rest) };
        let (nodes, weights) = ([0, 1, 2], [0.9, 0.3]);
        Cloth {
            node_of: (0..4).collect(),
            mass: vec![1e-3; 4],
            triangles: Vec::new(),
            flat: Vec::new(),
            piece: Vec::new(),
            springs: vec![spring([3, 0], 0.009), spring([1, 2], 0.02)],
            laws: vec![StretchLaw::linear(500.0)],
            threads: vec![Thread { nodes, weights, stretch: stretch(0.0112) }],
            shears: vec![Shear { nodes, legs: [weights, [-0.2, 1.1]], rest: 0.1, stiffness: 2e-3 }],
            bending: Bending::new(4, &[]),
            creases: Vec::new(),
            edges: vec![[0, 1], [0, 2], [0, 3], [1, 2]],
            half_thickness: vec![0.0; 4],
            friction: vec![0.0; 4],
            bending_bound: vec![0.0; 4],
            held: Vec::new(),
            foreseen: Loads::default(),
        }
    }

    #[test]
    fn the_stiffness_is_the_slope_of_the_forces() {
        let (cloth, links) = (cloth(), Links::new(&cloth()));
        let x = [[0.0, 0.0, 0.0], [0.011, 0.001, 0.0], [0.002, 0.012, 0.003], [-0.004, 0.002, -0.009]].map(Vec3::from);
        let p = [[0.3, -0.5, 0.2], [-0.1, 0.7, 0.4], [0.6, 0.1, -0.8], [-0.2, 0.3, 0.9]].map(Vec3::from);
        let stiffness = links.stiffness(&cloth, &x);
        let forces = |way: f64| {
            let to: Vec<Vec3> = x.iter().zip(&p).map(|(x, p)| x + p * way).collect();
            links.forces(&cloth, &to, |_| Vec3::zeros())
        };
        let (before, after) = (forces(-1e-8), forces(1e-8));
        for node in 0..4 {
            let slope = (before[node] - after[node]) / 2e-8;
            let found = links.times(&stiffness, &p, node);
            assert!((found - slope).norm() < 1e-5 * slope.norm(), "{node}: {found:?}, and not {slope:?}");
        }
        let sum: Vec3 = forces(0.0).iter().sum();
        assert!(sum.norm() < 1e-12, "elements push on nothing but their nodes");
    }
}
