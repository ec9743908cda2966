//! The fixed part of a piece's mesh: particles on its rim and on the lines that bend or gather it.

use super::breaks::Breaks;
use super::error::MeshError;
use super::lines::LinePlan;
use super::links::EdgeTable;
use super::sampling::Sampling;
use crate::geometry::Vec2;
use crate::pattern::{EdgeId, Piece, SHORTEST_EDGE, written_edge};

/// Largest gap between neighbouring edges, metres. The pattern stage closes outlines exactly, so a larger gap is a
/// mistake in a garment built by hand.
const CLOSED: f64 = 1e-6;

/// Particles and springs of a piece that no later step may move, part or remove.
#[derive(Default)]
pub(super) struct PieceFrame {
    /// Positions. Rim first (outline, then holes), then lines.
    pub(super) points: Vec<Vec2>,
    /// Number of rim particles.
    pub(super) rim: usize,
    /// Directed rim springs, the cloth on their left hand in a frame with y up (positive side).
    pub(super) rim_springs: Vec<[u32; 2]>,
    /// Springs along lines.
    pub(super) line_springs: Vec<[u32; 2]>,
    /// Particles of every edge, in ring order, both ends included.
    pub(super) edges: Vec<Vec<u32>>,
    /// Particles of every planned line.
    pub(super) lines: Vec<Vec<u32>>,
    /// Evenly sampled straight stretches, for the lattice to line up with.
    pub(super) straights: Vec<Straight>,
}

/// An evenly sampled straight stretch of the frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Straight {
    /// One end.
    pub(super) from: Vec2,
    /// The other.
    pub(super) to: Vec2,
    /// Springs between them.
    pub(super) springs: usize,
}

impl PieceFrame {
    /// Samples the rim of `piece`, number `number` in the garment.
    pub(super) fn of_rim(
        piece: &Piece,
        number: usize,
        table: &EdgeTable,
        breaks: &Breaks,
        sampling: &Sampling,
    ) -> Result<Self, MeshError> {
        let mut frame = Self::default();
        for (ring, edges) in piece.loops.iter().enumerate() {
            let first = frame.points.len() as u32;
            for (index, edge) in edges.iter().enumerate() {
                let Some(e) = table.number(EdgeId { piece: number, ring, index }) else { continue };
                check_edge(piece, ring, index)?;
                let start = frame.points.len() as u32;
                let at = &sampling.at[e];
                frame.points.extend(at[..at.len() - 1].iter().map(|&s| edge.path.point(s)));
                let mut particles: Vec<u32> = (start..frame.points.len() as u32).collect();
                particles.push(if index + 1 == edges.len() { first } else { frame.points.len() as u32 });
                frame.rim_springs.extend(particles.windows(2).map(|w| [w[0], w[1]]));
                frame.edges.push(particles);
                if edge.path.is_straight() {
                    let straight = |(k, w): (usize, &[f64])| Straight {
                        from: edge.path.point(w[0]),
                        to: edge.path.point(w[1]),
                        springs: sampling.springs(e, k),
                    };
                    frame.straights.extend(breaks.of(e).windows(2).enumerate().map(straight));
                }
            }
        }
        frame.rim = frame.points.len();
        Ok(frame)
    }

    /// Adds the particles of the lines. `rim_place` turns an edge number and arc length into places in
    /// [`PieceFrame::edges`].
    pub(super) fn add_lines(&mut self, plan: &LinePlan, rim_place: impl Fn(usize, f64) -> (usize, usize)) {
        let knots: Vec<u32> = plan.knots.iter().map(|&p| self.add(p)).collect();
        for line in &plan.lines {
            let mut chain: Vec<u32> = Vec::new();
            for (k, stop) in line.stops.iter().enumerate() {
                if k > 0 {
                    let (low, high) = (line.stops[k - 1].at, stop.at);
                    let n = line.springs[k - 1];
                    for j in 1..n {
                        chain.push(self.add(line.path.point(low + (high - low) * j as f64 / n as f64)));
                    }
                }
                chain.push(match stop.rim {
                    Some((edge, s)) => {
                        let (chain, k) = rim_place(edge, s);
                        self.edges[chain][k]
                    }
                    None => stop.knot.map_or_else(|| self.add(line.path.point(stop.at)), |knot| knots[knot]),
                });
            }
            if line.path.is_straight() {
                self.straights.extend(line.stops.windows(2).zip(&line.springs).map(|(w, &springs)| Straight {
                    from: line.path.point(w[0].at),
                    to: line.path.point(w[1].at),
                    springs,
                }));
            }
            self.line_springs.extend(chain.windows(2).map(|w| [w[0], w[1]]));
            self.lines.push(chain);
        }
    }

    fn add(&mut self, p: Vec2) -> u32 {
        self.points.push(p);
        self.points.len() as u32 - 1
    }

    /// All springs of the frame.
    pub(super) fn springs(&self) -> impl Iterator<Item = [u32; 2]> {
        self.rim_springs.iter().chain(&self.line_springs).copied()
    }
}

/// An edge must have length and start where the one before it ends.
fn check_edge(piece: &Piece, ring: usize, index: usize) -> Result<(), MeshError> {
    let edges = &piece.loops[ring];
    let edge = &edges[index];
    let length = edge.path.length();
    // Written so that a NaN fails too.
    let long_enough = length > SHORTEST_EDGE;
    if !long_enough {
        return Err(MeshError::ShortEdge { piece: piece.name.clone(), edge: written_edge(&edge.name), length });
    }
    let before = &edges[(index + edges.len() - 1) % edges.len()];
    let gap = (edge.path.start() - before.path.end()).norm();
    if gap > CLOSED {
        return Err(MeshError::Open { piece: piece.name.clone(), edge: written_edge(&edge.name), gap });
    }
    Ok(())
}
