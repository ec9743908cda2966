//! Links: which stretch of which edge must be sampled like which other.
//!
//! A seam is a link. So is the pair of opposite sides of a band that is meshed in straight columns.

use super::error::{MeshError, SeamFault};
use crate::pattern::{EdgeId, Garment, Seam, Span, edge_name};

/// Distance within which places on an edge are one place, metres: a hundredth of a millimetre is far below anything
/// that can be cut or sewn, and far above the accuracy of arc lengths.
pub(super) const SAME_PLACE: f64 = 1e-5;

/// All edges of a garment in one list, with their lengths.
pub(super) struct EdgeTable {
    /// Every edge once, by piece, ring and index.
    pub(super) ids: Vec<EdgeId>,
    /// Arc lengths, metres.
    pub(super) lengths: Vec<f64>,
    /// Number of the first edge of every ring of every piece.
    first: Vec<Vec<usize>>,
}

impl EdgeTable {
    /// Lists the edges.
    pub(super) fn new(garment: &Garment) -> Self {
        let mut table = Self { ids: Vec::new(), lengths: Vec::new(), first: Vec::new() };
        for (piece, p) in garment.pieces.iter().enumerate() {
            let mut first = Vec::new();
            for (ring, edges) in p.loops.iter().enumerate() {
                first.push(table.ids.len());
                for (index, edge) in edges.iter().enumerate() {
                    table.ids.push(EdgeId { piece, ring, index });
                    table.lengths.push(edge.path.length());
                }
            }
            table.first.push(first);
        }
        table
    }

    /// Number of an edge, or `None` if it is not in the garment.
    pub(super) fn number(&self, id: EdgeId) -> Option<usize> {
        let n = self.first.get(id.piece)?.get(id.ring)? + id.index;
        (self.ids.get(n) == Some(&id)).then_some(n)
    }
}

/// A stretch of an edge within a chain.
#[derive(Clone, Copy, Debug)]
pub(super) struct ChainStretch {
    /// Edge number.
    pub(super) edge: usize,
    /// Arc length on the edge where the walk begins.
    pub(super) from: f64,
    /// Arc length on the edge where it ends. Less than `from` when it walks against the edge.
    pub(super) to: f64,
    /// Arc length along the chain where this stretch begins.
    pub(super) start: f64,
}

impl ChainStretch {
    fn length(&self) -> f64 {
        (self.to - self.from).abs()
    }

    /// Chain position of arc length `s` of the edge, if the stretch covers it.
    pub(super) fn station(&self, s: f64) -> Option<f64> {
        let (low, high) = (self.from.min(self.to), self.from.max(self.to));
        let covered = s >= low - SAME_PLACE && s <= high + SAME_PLACE;
        covered.then(|| self.start + (s.clamp(low, high) - self.from).abs())
    }

    /// Arc length of the edge at chain position `u`, if the stretch covers it.
    fn place(&self, u: f64) -> Option<f64> {
        let along = u - self.start;
        let covered = along >= -SAME_PLACE && along <= self.length() + SAME_PLACE;
        let along = along.clamp(0.0, self.length());
        covered.then_some(if self.to >= self.from { self.from + along } else { self.from - along })
    }
}

/// Two chains that get particles at matching places.
pub(super) struct LinkedChains {
    /// The seam's name. For a band, the piece's.
    pub(super) name: String,
    /// The two chains.
    pub(super) chains: [Vec<ChainStretch>; 2],
    /// Matched chain positions, rising, ends included.
    marks: Vec<[f64; 2]>,
}

impl LinkedChains {
    /// A link in plain proportion, for spans that are known to be good.
    pub(super) fn proportional(name: &str, a: ChainStretch, b: ChainStretch) -> Self {
        let marks = vec![[0.0, 0.0], [a.length(), b.length()]];
        Self { name: name.to_owned(), chains: [vec![a], vec![b]], marks }
    }

    /// Reads a seam.
    pub(super) fn of_seam(seam: &Seam, garment: &Garment, edges: &EdgeTable) -> Result<Self, MeshError> {
        let fail = |fault| MeshError::Seam { seam: seam.name.clone(), fault };
        let a = chain(&seam.a, garment, edges).map_err(fail)?;
        let b = chain(&seam.b, garment, edges).map_err(fail)?;
        let lengths = [seam.length_a(), seam.length_b()];
        if lengths.iter().any(|&l| l <= SAME_PLACE) {
            return Err(fail(SeamFault::NoLength));
        }
        let marks: Vec<_> = seam.marks.iter().map(|&(x, y)| [x, y]).collect();
        if !marks_rise(&marks, lengths) {
            return Err(fail(SeamFault::Marks(lengths[0], lengths[1])));
        }
        Ok(Self { name: seam.name.clone(), chains: [a, b], marks })
    }

    /// The position on the other chain that belongs to position `u` of chain `side`.
    pub(super) fn across(&self, side: usize, u: f64) -> f64 {
        let k = self.marks.partition_point(|m| m[side] <= u).clamp(1, self.marks.len() - 1);
        let (low, high) = (self.marks[k - 1], self.marks[k]);
        let share = ((u - low[side]) / (high[side] - low[side])).clamp(0.0, 1.0);
        low[1 - side] + share * (high[1 - side] - low[1 - side])
    }

    /// Edge places at position `u` of chain `side`: two at a joint of the chain.
    pub(super) fn places(&self, side: usize, u: f64) -> impl Iterator<Item = (usize, f64)> {
        self.chains[side].iter().filter_map(move |c| c.place(u).map(|s| (c.edge, s)))
    }

    /// Edge places where the link itself asks for particles: ends of its stretches, and its marks on both sides.
    pub(super) fn seeds(&self) -> Vec<(usize, f64)> {
        let mut seeds = Vec::new();
        for side in 0..2 {
            seeds.extend(self.chains[side].iter().flat_map(|c| [(c.edge, c.from), (c.edge, c.to)]));
            for mark in &self.marks {
                seeds.extend(self.places(side, mark[side]));
            }
        }
        seeds
    }
}

fn chain(spans: &[Span], garment: &Garment, edges: &EdgeTable) -> Result<Vec<ChainStretch>, SeamFault> {
    let mut start = 0.0;
    let mut out = Vec::with_capacity(spans.len());
    for span in spans {
        let EdgeId { piece, ring, index } = span.edge;
        let edge = edges.number(span.edge).ok_or(SeamFault::NoSuchEdge { piece, ring, index })?;
        let length = edges.lengths[edge];
        // Written so that a NaN fails too.
        let inside = |s: f64| s >= -SAME_PLACE && s <= length + SAME_PLACE;
        if !(inside(span.from) && inside(span.to)) {
            let edge = edge_name(&garment.pieces, span.edge);
            return Err(SeamFault::PastTheEnd { edge, from: span.from, to: span.to, length });
        }
        out.push(ChainStretch { edge, from: span.from.clamp(0.0, length), to: span.to.clamp(0.0, length), start });
        start += span.length();
    }
    Ok(out)
}

fn marks_rise(marks: &[[f64; 2]], lengths: [f64; 2]) -> bool {
    let near = |m: &[f64; 2], to: [f64; 2]| (0..2).all(|k| (m[k] - to[k]).abs() <= SAME_PLACE);
    marks.len() >= 2
        && near(&marks[0], [0.0, 0.0])
        && near(&marks[marks.len() - 1], lengths)
        && marks.windows(2).all(|w| (0..2).all(|k| w[1][k] > w[0][k]))
}
