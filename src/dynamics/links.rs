//! The elements that meet at each node, and the nodes that they couple it to.
//!
//! Elements are evaluated side by side, and then every node gathers from its own. So no two threads write to one place,
//! and a node's sum has the order of the elements.

use super::elements::Elements;

/// An element at one of its nodes.
#[derive(Clone, Copy, Debug)]
pub(super) struct ElementAtNode {
    /// Its number.
    pub(super) element: u32,
    /// Which of the element's nodes it is.
    pub(super) corner: u8,
    /// Place of each of the element's nodes among the columns of the row.
    pub(super) slots: [u16; 3],
}

/// The elements at every node of a cloth.
#[derive(Debug, Default)]
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

impl Links {
    /// The links of `elements` between so many `nodes`.
    pub(super) fn new(nodes: usize, elements: &Elements) -> Self {
        let mut starts = vec![0u32; nodes + 1];
        let all = || (0..elements.len()).map(|number| (number, elements.get(number).nodes()));
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
        (0..nodes).for_each(|node| out.add_row(elements, node));
        out
    }

    /// Adds the row of a node to the matrix, and the places of its elements' nodes in it.
    fn add_row(&mut self, elements: &Elements, node: usize) {
        let own = &mut self.links[self.starts[node] as usize..self.starts[node + 1] as usize];
        let of = |link: &ElementAtNode| elements.get(link.element as usize).nodes();
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

    /// Number of nodes.
    pub(super) fn nodes(&self) -> usize {
        self.rows.len() - 1
    }

    /// The elements at a node, rising.
    pub(super) fn at(&self, node: usize) -> &[ElementAtNode] {
        &self.links[self.starts[node] as usize..self.starts[node + 1] as usize]
    }

    /// Start of every row of the stiffness matrix among its blocks, and their total.
    pub(super) fn rows(&self) -> &[u32] {
        &self.rows
    }

    /// The columns of the stiffness matrix: for each of its blocks, row by row, the node that is coupled.
    pub(super) fn columns(&self) -> &[u32] {
        &self.columns
    }
}
