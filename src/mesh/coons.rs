//! Structured meshes of four-sided pieces: transfinite (Coons) interpolation between opposite sides.

use super::MeshMethod;
use super::fill::Fill;
use super::frame::PieceFrame;
use super::lines::LinePlan;
use super::links::{ChainStretch, EdgeTable, LinkedChains};
use super::shape::{quality, quality_of_degrees};
use crate::geometry::{Vec2, shares_along};
use crate::pattern::{EdgeId, Piece};

/// Ratio of length to width from which [`MeshMethod::Auto`] treats a four-sided piece as a band.
const BAND: f64 = 5.0;
/// Least angle of a structured mesh with [`MeshMethod::Auto`], degrees. Below it the grid does better.
const LEAST_ANGLE: f64 = 25.0;
/// Least angle of a structured mesh that was asked for, or of a piece narrower than the spacing, degrees. A grid would
/// have no inner particle there either.
const LEAST_ANGLE_ASKED: f64 = 10.0;
/// Largest distance of a row from a line that it replaces, metres. The width of a thread is ten times as much.
const ON_LINE: f64 = 1e-5;

/// Whether a piece is to be meshed in structured columns, if its sides can be sampled alike.
pub(super) fn wanted(piece: &Piece, method: MeshMethod) -> bool {
    match method {
        MeshMethod::Auto => ends_of_band(piece).is_some(),
        MeshMethod::Grid => false,
        MeshMethod::Coons => piece.loops.len() == 1 && piece.loops[0].len() == 4,
    }
}

/// The two short edges of a band.
pub(super) fn ends_of_band(piece: &Piece) -> Option<[usize; 2]> {
    let [ring] = piece.loops.as_slice() else { return None };
    let [a, b, c, d] = ring.as_slice() else { return None };
    let [along, across] = [[a, c], [b, d]].map(|pair| pair.map(|e| e.path.length()).iter().sum::<f64>());
    let is_band = along.max(across) >= BAND * along.min(across);
    is_band.then_some(if along < across { [0, 2] } else { [1, 3] })
}

/// Links that sample the opposite sides of a four-sided piece alike.
pub(super) fn links(piece: &Piece, number: usize, edges: &EdgeTable) -> Vec<LinkedChains> {
    let stretch = |index: usize, forward: bool| {
        let edge = edges.number(EdgeId { piece: number, ring: 0, index })?;
        let (from, to) = if forward { (0.0, edges.lengths[edge]) } else { (edges.lengths[edge], 0.0) };
        Some(ChainStretch { edge, from, to, start: 0.0 })
    };
    let link =
        |a: usize, b: usize| Some(LinkedChains::proportional(&piece.name, stretch(a, true)?, stretch(b, false)?));
    [link(0, 2), link(1, 3)].into_iter().flatten().collect()
}

/// Meshes a four-sided frame in rows and columns, or `None` when opposite sides differ in number, a line does not
/// follow a row or column, or the result would be badly shaped.
pub(super) fn fill(frame: &PieceFrame, plan: &LinePlan, method: MeshMethod, is_narrow: bool) -> Option<Fill> {
    let sheet = CoonsGrid::new(frame)?;
    let points = sheet.points(frame)?;
    let lines = plan.lines.iter().map(|line| {
        let chain =
            sheet.chain_between(line.stops.first()?.rim.map(|_| line.path.start())?, line.path.end(), &points)?;
        let follows = chain.iter().all(|&v| line.path.nearest(points[v as usize]).1 <= ON_LINE);
        follows.then_some(chain)
    });
    let lines: Vec<_> = lines.collect::<Option<_>>()?;
    let triangles = sheet.triangles();
    let corners = |t: &[u32; 3]| t.map(|v| points[v as usize]);
    let worst = triangles.iter().map(corners).map(|[a, b, c]| quality(a, b, c)).fold(1.0, f64::min);
    let least = if method == MeshMethod::Coons || is_narrow { LEAST_ANGLE_ASKED } else { LEAST_ANGLE };
    (worst >= quality_of_degrees(least)).then_some(Fill { points, triangles, lines })
}

/// Vertex numbers in rows and columns. The outline runs along row 0, the last column, the last row and column 0.
struct CoonsGrid {
    columns: usize,
    rows: usize,
    vertex: Vec<u32>,
    total: usize,
}

impl CoonsGrid {
    fn new(frame: &PieceFrame) -> Option<Self> {
        let [bottom, right, top, left] = frame.edges.as_slice() else { return None };
        if bottom.len() != top.len() || right.len() != left.len() {
            return None;
        }
        let (columns, rows) = (bottom.len(), right.len());
        let mut total = frame.rim;
        let mut vertex = Vec::with_capacity(columns * rows);
        for j in 0..rows {
            for i in 0..columns {
                vertex.push(match (i, j) {
                    (i, 0) => bottom[i],
                    (i, j) if i + 1 == columns => right[j],
                    (i, j) if j + 1 == rows => top[columns - 1 - i],
                    (0, j) => left[rows - 1 - j],
                    _ => {
                        total += 1;
                        total as u32 - 1
                    }
                });
            }
        }
        Some(Self { columns, rows, vertex, total })
    }

    fn at(&self, i: usize, j: usize) -> u32 {
        self.vertex[j * self.columns + i]
    }

    fn row(&self, j: usize) -> Vec<u32> {
        (0..self.columns).map(|i| self.at(i, j)).collect()
    }

    fn column(&self, i: usize) -> Vec<u32> {
        (0..self.rows).map(|j| self.at(i, j)).collect()
    }

    /// Coons' interpolation of the inner vertices between the rim's. `None` where a side has no length.
    fn points(&self, frame: &PieceFrame) -> Option<Vec<Vec2>> {
        let rim = |v: u32| frame.points[v as usize];
        let (last_i, last_j) = (self.columns - 1, self.rows - 1);
        let across = shares(&self.row(0), &self.row(last_j), frame)?;
        let along = shares(&self.column(0), &self.column(last_i), frame)?;
        let mut points = frame.points.clone();
        points.resize(self.total, Vec2::zeros());
        for j in 1..last_j {
            for i in 1..last_i {
                let (x, y) = (across[i], along[j]);
                let rows = rim(self.at(i, 0)) * (1.0 - y) + rim(self.at(i, last_j)) * y;
                let columns = rim(self.at(0, j)) * (1.0 - x) + rim(self.at(last_i, j)) * x;
                let corners = (rim(self.at(0, 0)) * (1.0 - x) + rim(self.at(last_i, 0)) * x) * (1.0 - y)
                    + (rim(self.at(0, last_j)) * (1.0 - x) + rim(self.at(last_i, last_j)) * x) * y;
                points[self.at(i, j) as usize] = rows + columns - corners;
            }
        }
        Some(points)
    }

    /// Two triangles a cell, diagonals alternating, but from the corner in the four corner cells.
    fn triangles(&self) -> Vec<[u32; 3]> {
        let (columns, rows) = (self.columns - 1, self.rows - 1);
        let mut out = Vec::with_capacity(2 * columns * rows);
        for j in 0..rows {
            for i in 0..columns {
                let (first_i, last_i) = (i == 0, i + 1 == columns);
                let (first_j, last_j) = (j == 0, j + 1 == rows);
                let rising = if (first_i && first_j) || (last_i && last_j) {
                    true
                } else if (last_i && first_j) || (first_i && last_j) {
                    false
                } else {
                    (i + j).is_multiple_of(2)
                };
                let [a, b, c, d] = [self.at(i, j), self.at(i + 1, j), self.at(i + 1, j + 1), self.at(i, j + 1)];
                out.extend(if rising { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
            }
        }
        out
    }

    /// The row or column whose ends are nearest to the two points, within a line's tolerance.
    fn chain_between(&self, from: Vec2, to: Vec2, points: &[Vec2]) -> Option<Vec<u32>> {
        let rows = (0..self.rows).map(|j| self.row(j));
        let columns = (0..self.columns).map(|i| self.column(i));
        let near = |v: Option<&u32>, p: Vec2| v.is_some_and(|&v| (points[v as usize] - p).norm() <= ON_LINE);
        rows.chain(columns).find_map(|mut chain| {
            if near(chain.first(), to) && near(chain.last(), from) {
                chain.reverse();
            }
            (near(chain.first(), from) && near(chain.last(), to)).then_some(chain)
        })
    }
}

/// Mean share of the way along two opposite sides at each of their particles. `None` where one has no length.
fn shares(a: &[u32], b: &[u32], frame: &PieceFrame) -> Option<Vec<f64>> {
    let way = |side: &[u32]| shares_along(side.iter().map(|&v| frame.points[v as usize]));
    Some(way(a)?.into_iter().zip(way(b)?).map(|(x, y)| 0.5 * (x + y)).collect())
}
