//! The zero surface of a function that is symmetric in x, as quads: dual surface nets, followed from cell to cell.

use std::collections::HashMap;

use super::cell::{CellPatches, corner, edge_index, face_is_crossed};
use crate::geometry::Vec3;

/// Half of a closed quad mesh: x ≥ 0, the vertices of the cut at exactly x = 0.
pub(super) struct HalfSurface {
    /// Positions.
    pub(super) vertices: Vec<Vec3>,
    /// Corners, counter-clockwise from outside.
    pub(super) quads: Vec<[u32; 4]>,
}

/// A cell or a node of the grid, by its lowest corner.
type Cell = [i32; 3];

/// A grid of cubes of side `h`. The plane x = 0 halves the first column of cells,
/// so that the two halves share vertices.
struct CubeGrid<F> {
    function: F,
    h: f64,
    nodes: HashMap<Cell, f64>,
}

impl<F: Fn(Vec3) -> f64> CubeGrid<F> {
    fn position(&self, node: Cell) -> Vec3 {
        Vec3::new(f64::from(node[0]) - 0.5, f64::from(node[1]), f64::from(node[2])) * self.h
    }

    fn cell_of(&self, p: Vec3) -> Cell {
        [(p.x / self.h + 0.5).floor() as i32, (p.y / self.h).floor() as i32, (p.z / self.h).floor() as i32]
    }

    fn value(&mut self, node: Cell) -> f64 {
        if let Some(&v) = self.nodes.get(&node) {
            return v;
        }
        let v = (self.function)(self.position(node));
        self.nodes.insert(node, v);
        v
    }

    fn corners(&mut self, cell: Cell) -> [f64; 8] {
        std::array::from_fn(|c| self.value(corner(cell, c)))
    }
}

/// A crossed cell: its first vertex, and how the surface runs through it.
struct Crossed {
    first: u32,
    crossing: CellPatches,
}

/// The crossed cells in the order they were found, and their vertices.
struct Net {
    index: HashMap<Cell, usize>,
    cells: Vec<(Cell, Crossed)>,
    vertices: Vec<Vec3>,
}

fn step(cell: Cell, axis: usize, by: i32) -> Cell {
    let mut next = cell;
    next[axis] += by;
    next
}

/// Follows the surface of one connected body outward from `inside`, a point in it on the plane x = 0, in cubes of side
/// `h`. Only cells that the surface crosses are looked at. The result is closed once mirrored.
pub(super) fn surface_nets(function: impl Fn(Vec3) -> f64, inside: Vec3, h: f64) -> HalfSurface {
    let mut grid = CubeGrid { function, h, nodes: HashMap::new() };
    let mut start = grid.cell_of(inside);
    while CellPatches::new(&grid.corners(start)).patches == 0 {
        start = step(start, 2, 1);
    }
    let net = follow(&mut grid, start);
    let quads = connect(&mut grid, &net);
    HalfSurface { vertices: net.vertices, quads }
}

/// Every crossed cell reachable from `start`, each with a vertex per patch of surface in it.
fn follow<F: Fn(Vec3) -> f64>(grid: &mut CubeGrid<F>, start: Cell) -> Net {
    let mut net = Net { index: HashMap::from([(start, 0)]), cells: Vec::new(), vertices: Vec::new() };
    let mut queue = vec![start];
    while let Some(&cell) = queue.get(net.cells.len()) {
        let values = grid.corners(cell);
        let crossing = CellPatches::new(&values);
        let first = net.vertices.len() as u32;
        for middle in crossing.middles(&values) {
            let mut p = grid.position(cell) + middle * grid.h;
            if cell[0] == 0 {
                p.x = 0.0;
            }
            net.vertices.push(p);
        }
        net.cells.push((cell, Crossed { first, crossing }));
        for (axis, side) in [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)] {
            let neighbour = step(cell, axis, 2 * side as i32 - 1);
            if neighbour[0] >= 0 && face_is_crossed(&values, axis, side) && !net.index.contains_key(&neighbour) {
                net.index.insert(neighbour, queue.len());
                queue.push(neighbour);
            }
        }
    }
    net
}

/// A quad round every grid edge that the surface crosses, once per edge, for x > 0.
fn connect<F: Fn(Vec3) -> f64>(grid: &mut CubeGrid<F>, net: &Net) -> Vec<[u32; 4]> {
    let mut quads = Vec::new();
    for &(cell, _) in net.cells.iter().filter(|c| c.0[0] > 0) {
        let inside = grid.value(cell) < 0.0;
        for axis in 0..3 {
            if (grid.value(step(cell, axis, 1)) < 0.0) == inside {
                continue;
            }
            let Some(mut quad) = quad_round(net, cell, axis) else { continue };
            if !inside {
                quad.reverse();
            }
            quads.push(quad);
        }
    }
    quads
}

/// The vertices of the four cells round the grid edge that leaves the lowest corner of `cell` along `axis`, counter-
/// clockwise about the axis.
fn quad_round(net: &Net, cell: Cell, axis: usize) -> Option<[u32; 4]> {
    let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
    let vertex = |db: usize, dc: usize| {
        let at = step(step(cell, b, -(db as i32)), c, -(dc as i32));
        let (_, found) = &net.cells[*net.index.get(&at)?];
        Some(found.first + u32::from(found.crossing.patch_of[edge_index(db << b | dc << c, axis)]?))
    };
    Some([vertex(1, 1)?, vertex(0, 1)?, vertex(0, 0)?, vertex(1, 0)?])
}
