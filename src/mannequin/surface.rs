//! The zero surface of a function that is symmetric in x, as quads: surface nets, followed from cell to cell.

use std::collections::HashMap;

use crate::geometry::Vec3;

/// Half of a closed quad mesh: x ≥ 0, the vertices of the cut at exactly x = 0.
pub(super) struct HalfSurface {
    /// Positions.
    pub(super) vertices: Vec<Vec3>,
    /// Corners, counter-clockwise from outside.
    pub(super) quads: Vec<[u32; 4]>,
}

type Cell = [i32; 3];

/// A grid of cubes of side `h`; the plane x = 0 halves the first column of cells, so that the two halves share vertices.
struct Grid<F> {
    function: F,
    h: f64,
    nodes: HashMap<Cell, f64>,
}

impl<F: Fn(Vec3) -> f64> Grid<F> {
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

    fn is_crossed(&mut self, cell: Cell) -> bool {
        let values = self.corners(cell);
        self.crossing(cell, &values).is_some()
    }

    /// The middle of the points where the surface crosses the cell's edges; `None` in a cell it does not cross.
    fn crossing(&self, cell: Cell, values: &[f64; 8]) -> Option<Vec3> {
        let (mut sum, mut count) = (Vec3::zeros(), 0.0);
        for c in 0..8 {
            for axis in 0..3 {
                let d = c | 1 << axis;
                if d != c && (values[c] < 0.0) != (values[d] < 0.0) {
                    let t = values[c] / (values[c] - values[d]);
                    sum += self.position(corner(cell, c)).lerp(&self.position(corner(cell, d)), t);
                    count += 1.0;
                }
            }
        }
        (count > 0.0).then(|| sum / count)
    }
}

fn corner(cell: Cell, c: usize) -> Cell {
    std::array::from_fn(|axis| cell[axis] + (c >> axis & 1) as i32)
}

fn step(cell: Cell, axis: usize, by: i32) -> Cell {
    let mut next = cell;
    next[axis] += by;
    next
}

/// Whether the surface passes through the face of a cell on `side` (0 low, 1 high) of `axis`.
fn face_is_crossed(values: &[f64; 8], axis: usize, side: usize) -> bool {
    let mut inside = (0..8).filter(|c| c >> axis & 1 == side).map(|c| values[c] < 0.0);
    let first = inside.next();
    inside.any(|i| Some(i) != first)
}

/// Follows the surface of one connected body outward from `inside`, a point in it on the plane x = 0, in cubes of side
/// `h`. Only cells that the surface crosses are looked at. The result is closed once mirrored; where two sheets run
/// through one cell it may be non-manifold, which the caller checks.
pub(super) fn surface_nets(function: impl Fn(Vec3) -> f64, inside: Vec3, h: f64) -> HalfSurface {
    let mut grid = Grid { function, h, nodes: HashMap::new() };
    let mut cell = grid.cell_of(inside);
    while !grid.is_crossed(cell) {
        cell = step(cell, 2, 1);
    }
    let (cells, vertices) = follow(&mut grid, cell);
    let quads = connect(&mut grid, &cells);
    HalfSurface { vertices, quads }
}

/// Every crossed cell reachable from `start`, in the order found, with its vertex.
fn follow<F: Fn(Vec3) -> f64>(grid: &mut Grid<F>, start: Cell) -> (HashMap<Cell, u32>, Vec<Vec3>) {
    let mut ids = HashMap::from([(start, 0)]);
    let mut queue = vec![start];
    let mut vertices = Vec::new();
    let mut next = 0;
    while next < queue.len() {
        let cell = queue[next];
        next += 1;
        let values = grid.corners(cell);
        let mut vertex = grid.crossing(cell, &values).unwrap_or_else(|| grid.position(cell));
        if cell[0] == 0 {
            vertex.x = 0.0;
        }
        vertices.push(vertex);
        for axis in 0..3 {
            for side in 0..2 {
                let neighbour = step(cell, axis, 2 * side as i32 - 1);
                if neighbour[0] >= 0 && face_is_crossed(&values, axis, side) && !ids.contains_key(&neighbour) {
                    ids.insert(neighbour, queue.len() as u32);
                    queue.push(neighbour);
                }
            }
        }
    }
    (ids, vertices)
}

/// A quad round every grid edge that the surface crosses, once per edge, for x > 0.
fn connect<F: Fn(Vec3) -> f64>(grid: &mut Grid<F>, cells: &HashMap<Cell, u32>) -> Vec<[u32; 4]> {
    let mut owned: Vec<(u32, Cell)> = cells.iter().map(|(&c, &id)| (id, c)).collect();
    owned.sort_unstable();
    let mut quads = Vec::new();
    for (_, cell) in owned {
        if cell[0] == 0 {
            continue;
        }
        let inside = grid.value(cell) < 0.0;
        for axis in 0..3 {
            if (grid.value(step(cell, axis, 1)) < 0.0) == inside {
                continue;
            }
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            let round = [step(step(cell, b, -1), c, -1), step(cell, c, -1), cell, step(cell, b, -1)];
            let Some(mut quad) = corners_of(cells, round) else { continue };
            if !inside {
                quad.reverse();
            }
            quads.push(quad);
        }
    }
    quads
}

fn corners_of(cells: &HashMap<Cell, u32>, round: [Cell; 4]) -> Option<[u32; 4]> {
    Some([*cells.get(&round[0])?, *cells.get(&round[1])?, *cells.get(&round[2])?, *cells.get(&round[3])?])
}
