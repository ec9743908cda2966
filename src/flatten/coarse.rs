//! The first part of the way down, with few unknowns.
//!
//! A regular grid of triangles lies over the flat start, and the piece moves with its nodes. The distortion by the
//! grid's triangles is measured on some of the piece's own triangles in each, so a rim that runs across the grid and a
//! surface that is curved inside its cells are seen as they are. The long waves of the way, which take an iteration on
//! the piece itself the most steps, are found here for a small part of their price.

use std::collections::HashMap;

use nalgebra::Matrix2;

use super::element::FlatElement;
use super::energy::FlatEnergy;
use super::relax::{self, EnergyDescent, Goal};
use super::spring::{LengthSpring, Springs};
use crate::geometry::Vec2;

/// Cells of the grid over a piece, about.
const CELLS: f64 = 4000.0;
/// The same over a woven piece. Threads that only turn cost next to nothing, so that with smaller cells they do so from
/// cell to cell and the piece has the more to undo: a front of 19,881 vertices takes 3.9 s from 1,000 cells, 5.5 s from
/// 2,000, 6.6 s from 4,000 and 9.2 s from 500.
const WOVEN_CELLS: f64 = 1000.0;
/// A piece of fewer vertices than this many per cell goes down by itself as fast.
const VERTICES_PER_CELL: f64 = 3.0;
/// Triangles of the piece that are looked at in each triangle of the grid, at most.
const SAMPLES: usize = 4;
/// The grid's own errors are larger than what is left to win then.
const GOAL: Goal = Goal { tolerance: 1e-2, max_iterations: 50, holds: 0, exact: 0.0 };

/// Moves `flat`, which must have no flipped triangle, towards a minimum of `energy`;
/// leaves it where that does not help.
pub(super) fn approach(energy: &FlatEnergy, flat: &mut [Vec2]) {
    let cells = if energy.law.warp.is_some() { WOVEN_CELLS } else { CELLS };
    if (flat.len() as f64) < cells * VERTICES_PER_CELL {
        return;
    }
    let grid = CoarseGrid::new(energy, flat, cells);
    let (elements, springs) = (grid.elements(energy, flat), grid.springs(energy, flat));
    let mut coarse = FlatEnergy::new(grid.nodes.len(), elements, springs, energy.law);
    let mut moved = grid.nodes.clone();
    let descent = EnergyDescent::new(&coarse);
    if descent.and_then(|mut d| d.down(&mut coarse, &mut moved, &GOAL, None)).is_err() {
        return;
    }
    let shift: Vec<Vec2> = moved.iter().zip(&grid.nodes).map(|(to, from)| to - from).collect();
    let slopes = grid.slopes(&shift);
    let moves = flat.iter().zip(&grid.cell_of_vertex).map(|(p, &c)| grid.smooth(c, *p, &shift, &slopes));
    let direction: Vec<Vec2> = moves.collect();
    relax::go(energy, flat, &direction);
}

/// A triangle of the grid: column, row, and whether it is the upper one of its square.
type Cell = (i32, i32, bool);

struct CoarseGrid {
    low: Vec2,
    size: f64,
    /// Positions.
    nodes: Vec<Vec2>,
    /// Nodes of the triangles that have triangles of the piece in them, and these.
    cells: Vec<([u32; 3], Cell, Vec<u32>)>,
    /// The cell a vertex moves with: its own, or one beside it.
    cell_of_vertex: Vec<u32>,
}

impl CoarseGrid {
    fn new(energy: &FlatEnergy, flat: &[Vec2], cells: f64) -> Self {
        let low = flat.iter().fold(Vec2::repeat(f64::INFINITY), |low, p| low.inf(p));
        let area: f64 = energy.elements.iter().map(|e| e.area * e.jacobian(flat).determinant()).sum();
        let mut grid =
            Self { low, size: (area / cells).sqrt(), nodes: Vec::new(), cells: Vec::new(), cell_of_vertex: Vec::new() };
        let mut number: HashMap<Cell, u32> = HashMap::new();
        let mut node: HashMap<(i32, i32), u32> = HashMap::new();
        let mut beside = vec![0; flat.len()];
        for (t, e) in (0..).zip(&energy.elements) {
            let cell = grid.cell(e.corners.iter().map(|&v| flat[v as usize]).sum::<Vec2>() / 3.0);
            let k = *number.entry(cell).or_insert_with(|| {
                let nodes = corners(cell).map(|at| {
                    *node.entry(at).or_insert_with(|| {
                        grid.nodes.push(low + Vec2::new(f64::from(at.0), f64::from(at.1)) * grid.size);
                        grid.nodes.len() as u32 - 1
                    })
                });
                grid.cells.push((nodes, cell, Vec::new()));
                grid.cells.len() as u32 - 1
            });
            grid.cells[k as usize].2.push(t);
            e.corners.iter().for_each(|&v| beside[v as usize] = k);
        }
        let own = flat.iter().zip(beside).map(|(p, k)| number.get(&grid.cell(*p)).copied().unwrap_or(k));
        grid.cell_of_vertex = own.collect();
        grid
    }

    fn cell(&self, p: Vec2) -> Cell {
        let at = (p - self.low) / self.size;
        let (i, j) = (at.x.floor(), at.y.floor());
        (i as i32, j as i32, at.y - j > at.x - i)
    }

    /// Gradients of a cell's functions, 1/m.
    fn gradients(&self, upper: bool) -> [Vec2; 3] {
        let [x, y] = [Vec2::x(), Vec2::y()].map(|d| d / self.size);
        if upper { [-y, x, y - x] } else { [-x, x - y, y] }
    }

    /// Mean slope, of the cells round every node, of the field with these values at the nodes.
    fn slopes(&self, values: &[Vec2]) -> Vec<Matrix2<f64>> {
        let mut sums = vec![(Matrix2::zeros(), 0.0); values.len()];
        for (nodes, (_, _, upper), _) in &self.cells {
            let gradients = nodes.iter().zip(self.gradients(*upper)).map(|(&n, g)| values[n as usize] * g.transpose());
            let slope: Matrix2<f64> = gradients.sum();
            for &n in nodes {
                sums[n as usize].0 += slope;
                sums[n as usize].1 += 1.0;
            }
        }
        sums.into_iter().map(|(sum, count)| sum / count).collect()
    }

    /// The field with these values and slopes at the nodes. Half of each node's slope beside linear interpolation has
    /// no kinks where the field is a quadratic one: kinks would flip thin triangles.
    fn smooth(&self, cell: u32, p: Vec2, values: &[Vec2], slopes: &[Matrix2<f64>]) -> Vec2 {
        let (nodes, (_, _, upper), _) = &self.cells[cell as usize];
        let from = nodes.map(|n| p - self.nodes[n as usize]);
        let at = |k: usize| values[nodes[k] as usize] + slopes[nodes[k] as usize] * from[k] * 0.5;
        let [_, b, c] = self.gradients(*upper).map(|g| g.dot(&from[0]));
        at(0) * (1.0 - b - c) + at(1) * b + at(2) * c
    }

    /// Of every cell a few of the piece's triangles, with the weight of all in it.
    fn elements(&self, energy: &FlatEnergy, flat: &[Vec2]) -> Vec<FlatElement> {
        let mut out = Vec::with_capacity(SAMPLES * self.cells.len());
        for (nodes, (_, _, upper), inside) in &self.cells {
            let chosen = inside.iter().step_by(inside.len().div_ceil(SAMPLES)).map(|&t| energy.elements[t as usize]);
            let all: f64 = inside.iter().map(|&t| energy.elements[t as usize].area).sum();
            let looked_at: f64 = chosen.clone().map(|e| e.area).sum();
            out.extend(chosen.map(|e| {
                let jacobian = e.jacobian(flat).transpose();
                let gradients = self.gradients(*upper).map(|g| jacobian * g);
                FlatElement { corners: *nodes, gradients, area: e.area * all / looked_at }
            }));
        }
        out
    }

    /// The springs, as they turn and stretch with the cell of their first vertex.
    fn springs(&self, energy: &FlatEnergy, flat: &[Vec2]) -> Springs {
        let coarse = |s: &LengthSpring| {
            let (nodes, (_, _, upper), _) = &self.cells[self.cell_of_vertex[s.nodes[0] as usize] as usize];
            let along = s.along(flat);
            LengthSpring { nodes: *nodes, shares: self.gradients(*upper).map(|g| g.dot(&along)), ..*s }
        };
        let (held, free) = energy.springs.split_at(energy.held().len());
        Springs {
            held: held.iter().map(coarse).collect(),
            free: free.iter().map(coarse).collect(),
            chains: energy.chains.clone(),
        }
    }
}

/// A cell's nodes, by column and row, in the direction of the piece's triangles.
fn corners((i, j, upper): Cell) -> [(i32, i32); 3] {
    let far = (i + 1, j + 1);
    if upper { [(i, j), far, (i, j + 1)] } else { [(i, j), (i + 1, j), far] }
}
