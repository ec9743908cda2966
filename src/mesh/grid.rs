//! The regular core of a piece: lattice points well inside it, and the square cells between them.

use std::ops::RangeInclusive;

use super::frame::PieceFrame;
use super::lattice::Lattice;
use super::spans::Spans;
use crate::geometry::{Vec2, box_of, distance_to_segment, sorted_pair};

/// Least distance of a lattice point from the frame, in spacings. Any point of a cell's side is within half a step of
/// an end of that side, so that no frame spring can pass between two kept neighbours.
const CLEARANCE: f64 = 0.58;
/// Distance within which a frame particle replaces a lattice point, in cells.
const COINCIDES: f64 = 0.02;
/// Length of a frame spring, in spacings, below which its particle replaces no lattice point: the spring could enter
/// the cell beside the particle.
const SHORT: f64 = 0.6;
/// Distance within which lattice points beside a frame spring are examined, in cells: the corners of every cell that it
/// crosses.
const REACH: f64 = 1.0;
/// No vertex.
const NONE: u32 = u32::MAX;

/// The square cells of a piece and the vertices they use.
pub(super) struct Core {
    /// Frame particles, then lattice points.
    pub(super) points: Vec<Vec2>,
    /// Whether a vertex is a corner of a cell.
    pub(super) in_cell: Vec<bool>,
    /// Two triangles a cell, diagonals alternating.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Directed sides of the cells, each cell on the positive side, sorted.
    pub(super) sides: Vec<[u32; 2]>,
}

impl Core {
    /// Lays the core into a frame.
    pub(super) fn lay(frame: &PieceFrame, lattice: &Lattice, spacing: f64) -> Self {
        let mut raster = Raster::new(frame, lattice);
        raster.clear_near(frame, lattice, spacing);
        let mut points = frame.points.clone();
        raster.number(lattice, &mut points);
        raster.seat_frame(frame, spacing);
        raster.block_crossed(frame);
        raster.cells(frame, points)
    }
}

/// Lattice points in or beside a piece, with their state.
struct Raster {
    /// Column and row of the corner that the others are counted from.
    low: [i64; 2],
    /// Columns and rows.
    size: [usize; 2],
    /// Frame particles in cells from the corner.
    frame: Vec<Vec2>,
    /// The points there are.
    points: Spans,
    /// Vertex at each lattice point.
    vertex: Vec<u32>,
    /// Whether a frame spring runs through the cell whose low corner is the lattice point.
    crossed: Vec<bool>,
}

impl Raster {
    fn new(frame: &PieceFrame, lattice: &Lattice) -> Self {
        let cells: Vec<Vec2> = frame.points.iter().map(|&p| lattice.cells(p)).collect();
        let [min, max] = box_of(cells.iter().copied());
        let low = [min.x.floor() as i64 - 1, min.y.floor() as i64 - 1];
        let size = [(max.x.ceil() as i64 + 2 - low[0]) as usize, (max.y.ceil() as i64 + 2 - low[1]) as usize];
        let corner = Vec2::new(low[0] as f64, low[1] as f64);
        let cells: Vec<Vec2> = cells.into_iter().map(|c| c - corner).collect();
        let inside = inside(&cells, &frame.rim_springs, size[1]);
        let beside = frame.springs().flat_map(|[a, b]| {
            let [columns, rows] = around(cells[a as usize], cells[b as usize], REACH, size);
            rows.map(move |j| (j, columns.clone()))
        });
        let points = Spans::new(size[1], inside.iter().cloned().chain(beside).collect());
        let (vertex, crossed) = (vec![NONE; points.len()], vec![false; points.len()]);
        let mut raster = Self { low, size, frame: cells, points, vertex, crossed };
        // A placeholder until they are numbered.
        for (j, columns) in inside {
            columns.for_each(|i| raster.set(i, j, 0));
        }
        raster
    }

    /// Vertex at a lattice point.
    fn vertex(&self, i: usize, j: usize) -> u32 {
        self.points.number(i, j).map_or(NONE, |at| self.vertex[at])
    }

    fn set(&mut self, i: usize, j: usize, vertex: u32) {
        if let Some(at) = self.points.number(i, j) {
            self.vertex[at] = vertex;
        }
    }

    /// Drops lattice points near the frame.
    fn clear_near(&mut self, frame: &PieceFrame, lattice: &Lattice, spacing: f64) {
        let clearance = CLEARANCE * spacing;
        let scale = Vec2::new(lattice.step[0], lattice.step[1]);
        for [a, b] in frame.springs() {
            let (p, q) = (self.frame[a as usize], self.frame[b as usize]);
            for (i, j) in self.around(p, q, CLEARANCE * 1.2) {
                let at = Vec2::new(i as f64, j as f64);
                let (d, e) = ((q - p).component_mul(&scale), (at - p).component_mul(&scale));
                if distance_to_segment(e, [Vec2::zeros(), d]) < clearance {
                    self.set(i, j, NONE);
                }
            }
        }
    }

    /// Lattice points of the box around a segment, widened by `margin` cells.
    fn around(&self, p: Vec2, q: Vec2, margin: f64) -> impl Iterator<Item = (usize, usize)> + use<> {
        let [columns, rows] = around(p, q, margin, self.size);
        rows.flat_map(move |j| columns.clone().map(move |i| (i, j)))
    }

    /// Numbers the kept lattice points, row by row, and appends their positions.
    fn number(&mut self, lattice: &Lattice, points: &mut Vec<Vec2>) {
        for (vertex, (i, j)) in self.vertex.iter_mut().zip(self.points.places()).filter(|(v, _)| **v != NONE) {
            *vertex = points.len() as u32;
            points.push(lattice.point(self.low[0] + i as i64, self.low[1] + j as i64));
        }
    }

    /// Replaces lattice points by frame particles that lie on them.
    fn seat_frame(&mut self, frame: &PieceFrame, spacing: f64) {
        let mut shortest = vec![f64::INFINITY; frame.points.len()];
        for [a, b] in frame.springs() {
            let length = (frame.points[a as usize] - frame.points[b as usize]).norm();
            for v in [a, b] {
                shortest[v as usize] = shortest[v as usize].min(length);
            }
        }
        for (v, &short) in shortest.iter().enumerate() {
            let c = self.frame[v];
            let near = Vec2::new(c.x.round(), c.y.round());
            if (c - near).amax() < COINCIDES && short > SHORT * spacing {
                let (i, j) = (near.x as usize, near.y as usize);
                // Both lips of a slit may lie there: then neither takes it.
                let taken = (self.vertex(i, j) as usize) < self.frame.len();
                self.set(i, j, if taken { NONE } else { v as u32 });
            }
        }
    }

    /// Marks the cells that a frame spring runs through.
    fn block_crossed(&mut self, frame: &PieceFrame) {
        for [a, b] in frame.springs() {
            let (p, q) = (self.frame[a as usize], self.frame[b as usize]);
            for (i, j) in self.around(p, q, REACH) {
                // Shrunk a little more than frame particles may be off their lattice points.
                let low = Vec2::new(i as f64, j as f64).add_scalar(1.5 * COINCIDES);
                if segment_enters(p, q, low, 1.0 - 3.0 * COINCIDES)
                    && let Some(at) = self.points.number(i, j)
                {
                    self.crossed[at] = true;
                }
            }
        }
    }

    /// Cells with all four corners, at least one of them off the frame, and no frame spring inside.
    fn cells(&self, frame: &PieceFrame, points: Vec<Vec2>) -> Core {
        let fixed = frame.points.len() as u32;
        let mut springs: Vec<[u32; 2]> = frame.springs().map(sorted_pair).collect();
        springs.sort_unstable();
        let mut core = Core { in_cell: vec![false; points.len()], points, triangles: Vec::new(), sides: Vec::new() };
        for ((i, j), crossed) in self.points.places().zip(&self.crossed) {
            let corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| self.vertex(i, j));
            if *crossed || corners.contains(&NONE) || corners.iter().all(|&v| v < fixed) {
                continue;
            }
            let sides = [0, 1, 2, 3].map(|k| [corners[k], corners[(k + 1) % 4]]);
            // A side between two frame particles must itself be a spring of the frame.
            let bad =
                |&[a, b]: &[u32; 2]| a < fixed && b < fixed && springs.binary_search(&sorted_pair([a, b])).is_err();
            if sides.iter().any(bad) {
                continue;
            }
            let even = (self.low[0] + i as i64 + self.low[1] + j as i64).rem_euclid(2) == 0;
            core.push(corners, sides, even);
        }
        core.sides.sort_unstable();
        core
    }
}

impl Core {
    fn push(&mut self, [a, b, c, d]: [u32; 4], sides: [[u32; 2]; 4], even: bool) {
        for v in [a, b, c, d] {
            self.in_cell[v as usize] = true;
        }
        self.sides.extend(sides);
        self.triangles.extend(if even { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
    }
}

/// The stretches of `height` rows inside the rim: between every second crossing.
fn inside(cells: &[Vec2], rim: &[[u32; 2]], height: usize) -> Vec<(usize, RangeInclusive<usize>)> {
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); height];
    for &[a, b] in rim {
        let (p, q) = (cells[a as usize], cells[b as usize]);
        let (p, q) = if p.y <= q.y { (p, q) } else { (q, p) };
        // Rows in (p.y, q.y]: a row through a particle counts exactly one of its two springs on each side.
        let rows = p.y.floor() as usize + 1..q.y.floor() as usize + 1;
        for (j, xs) in rows.clone().zip(&mut crossings[rows]) {
            xs.push(p.x + (q.x - p.x) * (j as f64 - p.y) / (q.y - p.y));
        }
    }
    let mut stretches = Vec::new();
    for (j, xs) in crossings.iter_mut().enumerate() {
        xs.sort_by(f64::total_cmp);
        stretches.extend(xs.chunks_exact(2).map(|pair| (j, pair[0].ceil() as usize..=pair[1].floor() as usize)));
    }
    stretches
}

/// Columns and rows of the box around a segment, widened by `margin` cells.
fn around(p: Vec2, q: Vec2, margin: f64, size: [usize; 2]) -> [RangeInclusive<usize>; 2] {
    let range = |a: f64, b: f64, size: usize| {
        let low = (a.min(b) - margin).ceil().max(0.0) as usize;
        let high = (a.max(b) + margin).floor().min(size as f64 - 1.0) as usize;
        low..=high
    };
    [range(p.x, q.x, size[0]), range(p.y, q.y, size[1])]
}

/// Whether a segment enters the square with this low corner and size (slabs).
fn segment_enters(p: Vec2, q: Vec2, low: Vec2, size: f64) -> bool {
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    for k in 0..2 {
        let (start, d) = (p[k] - low[k], q[k] - p[k]);
        if d == 0.0 {
            if start < 0.0 || start > size {
                return false;
            }
            continue;
        }
        let (a, b) = (-start / d, (size - start) / d);
        t0 = t0.max(a.min(b));
        t1 = t1.min(a.max(b));
    }
    t0 <= t1
}
