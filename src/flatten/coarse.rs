//! The first part of the way down, with few unknowns.
//!
//! A square grid lies over the flat start, and the piece moves with it, smoothly: the shift of a place is a biquadratic
//! spline of the grid's nodes. The distortion is measured on some of the piece's own triangles in each square, so a rim
//! that runs across the grid and a surface that is curved inside its squares are seen as they are. The long waves of
//! the way, which take an iteration on the piece itself the most steps, are found here for a small part of their price.

use std::collections::HashMap;

use nalgebra::Matrix2;

use super::element::FlatElement;
use super::energy::FlatEnergy;
use super::relax::{self, EnergyDescent, Goal};
use super::spring::{LengthSpring, Springs};
use crate::geometry::Vec2;

/// Nodes that a place follows: three by three.
const NODES: usize = 9;
/// Squares of the grid over a piece, about. With 2,000 a woven front of 19,881 vertices takes a quarter longer; with
/// 500 it comes to rest at an energy that is 2 % higher.
const SQUARES: f64 = 1000.0;
/// A piece of fewer vertices than this many per square goes down by itself as fast.
const VERTICES_PER_SQUARE: f64 = 3.0;
/// Triangles of the piece that are looked at in each square, at most.
const SAMPLES: usize = 16;
/// Where the piece does not cover a square, cloth like that beside it is thought, of this weight against the piece's.
const BARE: f64 = 0.05;
/// Where in the square it is thought.
const BEYOND: [[f64; 2]; 4] = [[0.25, 0.25], [0.75, 0.25], [0.25, 0.75], [0.75, 0.75]];
/// Converged when the next step would win less than this share: the grid's own errors are larger than what is left.
const TOLERANCE: f64 = 1e-2;
/// The same of a weave, which rests a while on a ridge before its threads have turned to one side or the other: with
/// 10⁻² the grid stops there, at six times the energy, and the piece itself has to come down for the most part.
const WOVEN_TOLERANCE: f64 = 1e-3;

/// Moves `flat`, which must have no flipped triangle, towards a minimum of `energy`;
/// leaves it where that does not help.
pub(super) fn approach(energy: &FlatEnergy, flat: &mut [Vec2]) {
    if (flat.len() as f64) < SQUARES * VERTICES_PER_SQUARE {
        return;
    }
    let tolerance = if energy.law.warp.is_some() { WOVEN_TOLERANCE } else { TOLERANCE };
    let goal = Goal { tolerance, max_iterations: 50, holds: 0, exact: 0.0 };
    let grid = CoarseGrid::new(energy, flat);
    let (elements, springs) = (grid.elements(energy, flat), grid.springs(energy, flat));
    let mut coarse = FlatEnergy::new(grid.nodes.len(), elements, springs, energy.law);
    let mut moved = grid.nodes.clone();
    let descent = EnergyDescent::new(&coarse);
    if descent.and_then(|mut d| d.down(&mut coarse, &mut moved, &goal, None)).is_err() {
        return;
    }
    let shift: Vec<Vec2> = moved.iter().zip(&grid.nodes).map(|(to, from)| to - from).collect();
    let moves = flat.iter().zip(&grid.square_of_vertex).map(|(p, &s)| grid.place(s, *p).shift(&shift));
    let direction: Vec<Vec2> = moves.collect();
    relax::go(energy, flat, &direction);
}

/// Column and row of a square of the grid.
type Square = (i32, i32);

struct CoarseGrid {
    low: Vec2,
    size: f64,
    /// Positions.
    nodes: Vec<Vec2>,
    /// Those in which the piece has triangles or vertices.
    squares: Vec<GridSquare>,
    /// The square of every vertex.
    square_of_vertex: Vec<u32>,
}

struct GridSquare {
    at: Square,
    nodes: [u32; NODES],
    /// A triangle in it or beside it.
    beside: u32,
    /// The triangles in it.
    inside: Vec<u32>,
}

/// The nodes that a place moves with.
struct Place {
    nodes: [u32; NODES],
    /// The share that each node's shift has in it.
    shares: [f64; NODES],
    /// Gradients of these shares, 1/m.
    gradients: [Vec2; NODES],
}

impl Place {
    fn shift(&self, shift: &[Vec2]) -> Vec2 {
        self.nodes.iter().zip(self.shares).map(|(&n, share)| shift[n as usize] * share).sum()
    }
}

impl CoarseGrid {
    fn new(energy: &FlatEnergy, flat: &[Vec2]) -> Self {
        let low = flat.iter().fold(Vec2::repeat(f64::INFINITY), |low, p| low.inf(p));
        let area: f64 = energy.elements.iter().map(|e| e.area * e.jacobian(flat).determinant()).sum();
        let (nodes, size) = (Vec::new(), (area / SQUARES).sqrt());
        let mut grid = Self { low, size, nodes, squares: Vec::new(), square_of_vertex: vec![0; flat.len()] };
        let (mut number, mut node) = (HashMap::new(), HashMap::new());
        for (t, e) in (0..).zip(energy.elements.iter()) {
            let k = grid.number(middle(e, flat), t, &mut number, &mut node);
            grid.squares[k as usize].inside.push(t);
            for v in e.corners.map(|v| v as usize) {
                grid.square_of_vertex[v] = grid.number(flat[v], t, &mut number, &mut node);
            }
        }
        grid
    }

    /// The number of the square of a place beside triangle `t`, which is added if it is new.
    fn number(
        &mut self,
        place: Vec2,
        t: u32,
        number: &mut HashMap<Square, u32>,
        node: &mut HashMap<Square, u32>,
    ) -> u32 {
        let at = self.square(place);
        *number.entry(at).or_insert_with(|| {
            let nodes = corners(at).map(|at| {
                *node.entry(at).or_insert_with(|| {
                    // With the nodes in the middles of squares the spline gives every place its own position.
                    let middle = Vec2::new(f64::from(at.0), f64::from(at.1)) - Vec2::repeat(0.5);
                    self.nodes.push(self.low + middle * self.size);
                    self.nodes.len() as u32 - 1
                })
            });
            self.squares.push(GridSquare { at, nodes, beside: t, inside: Vec::new() });
            self.squares.len() as u32 - 1
        })
    }

    fn square(&self, p: Vec2) -> Square {
        let at = (p - self.low) / self.size;
        (at.x.floor() as i32, at.y.floor() as i32)
    }

    /// A place that moves with a square.
    fn place(&self, square: u32, p: Vec2) -> Place {
        let GridSquare { at: (i, j), nodes, .. } = &self.squares[square as usize];
        let at = (p - self.low) / self.size - Vec2::new(f64::from(*i), f64::from(*j));
        let [(x, dx), (y, dy)] = [at.x, at.y].map(quadratics);
        let mut place = Place { nodes: *nodes, shares: [0.0; NODES], gradients: [Vec2::zeros(); NODES] };
        for k in 0..NODES {
            let (a, b) = (k % 3, k / 3);
            place.shares[k] = x[a] * y[b];
            place.gradients[k] = Vec2::new(dx[a] * y[b], x[a] * dy[b]) / self.size;
        }
        place
    }

    /// Of every square a few of the piece's triangles, with the weight of all in it, and where the piece does not cover
    /// it a little cloth like that beside it: nodes that hang on a few triangles would go wherever these want them.
    fn elements(&self, energy: &FlatEnergy, flat: &[Vec2]) -> Vec<FlatElement<NODES>> {
        let mut out = Vec::with_capacity((SAMPLES + BEYOND.len()) * self.squares.len());
        for (s, square) in (0..).zip(&self.squares) {
            let inside = || square.inside.iter().map(|&t| &energy.elements[t as usize]);
            let chosen = inside().step_by(inside().len().div_ceil(SAMPLES) | 1);
            let all: f64 = inside().map(|e| e.area).sum();
            let looked_at: f64 = chosen.clone().map(|e| e.area).sum();
            out.extend(chosen.map(|e| self.element(s, middle(e, flat), &e.jacobian(flat), e.area * all / looked_at)));
            let like = energy.elements[square.beside as usize].jacobian(flat);
            let bare = self.size * self.size / like.determinant() - all;
            if bare > 0.0 {
                let ((i, j), area) = (square.at, BARE * bare / BEYOND.len() as f64);
                out.extend(BEYOND.map(|[x, y]| {
                    let at = self.low + Vec2::new(f64::from(i) + x, f64::from(j) + y) * self.size;
                    self.element(s, at, &like, area)
                }));
            }
        }
        out
    }

    /// A triangle with this J at a place in a square, as the grid moves it.
    fn element(&self, square: u32, at: Vec2, jacobian: &Matrix2<f64>, area: f64) -> FlatElement<NODES> {
        let place = self.place(square, at);
        FlatElement { corners: place.nodes, gradients: place.gradients.map(|g| jacobian.transpose() * g), area }
    }

    /// The springs, as they turn and stretch with the square of their first vertex.
    fn springs(&self, energy: &FlatEnergy, flat: &[Vec2]) -> Springs<NODES> {
        let coarse = |s: &LengthSpring| {
            let along = s.along(flat);
            let first = s.nodes[0] as usize;
            let place = self.place(self.square_of_vertex[first], flat[first] + along * 0.5);
            let shares = place.gradients.map(|g| g.dot(&along));
            LengthSpring { nodes: place.nodes, shares, elastic: s.elastic }
        };
        let (held, free) = energy.springs.split_at(energy.held().len());
        Springs {
            held: held.iter().map(coarse).collect(),
            free: free.iter().map(coarse).collect(),
            chains: energy.chains.clone(),
        }
    }
}

/// The middle of a triangle.
fn middle(e: &FlatElement, flat: &[Vec2]) -> Vec2 {
    e.corners.iter().map(|&v| flat[v as usize]).sum::<Vec2>() / 3.0
}

/// The three quadratic B-splines of a stretch of length 1, and their slopes.
fn quadratics(s: f64) -> ([f64; 3], [f64; 3]) {
    let rest = 1.0 - s;
    ([0.5 * rest * rest, 0.5 + s * rest, 0.5 * s * s], [-rest, rest - s, s])
}

/// The nodes of a square, by column and row.
fn corners((i, j): Square) -> [(i32, i32); NODES] {
    std::array::from_fn(|k| (i + k as i32 % 3, j + k as i32 / 3))
}
