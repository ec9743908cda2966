//! Points on the rims of pieces, which of them sewing brings together, and the openings that remain.

use std::collections::HashMap;

use super::fasten::{Bridge, Fastening, RimSpot, Step, fastenings, patches, worn_rims};
use super::free::{SLIVER, free_spans};
use super::{EdgeId, Garment, Piece, Seam, Span};
use crate::geometry::DisjointSets;

/// Distance within which points of one rim are one point, metres. Sides of a seam may differ by 2 mm by default.
const SAME: f64 = 1e-3;

/// A point of a rim: ring of a piece, metres from the ring's start.
#[derive(Clone, Copy, Debug)]
pub(super) struct RimPoint {
    piece: usize,
    ring: usize,
    at: f64,
}

/// Lengths of all rings, for turning edge positions into rim positions.
pub(super) struct Rims {
    /// `[piece][ring]`: arc length at the start of every edge, and the total.
    starts: Vec<Vec<Vec<f64>>>,
}

impl Rims {
    pub(super) fn new(pieces: &[Piece]) -> Self {
        let ring = |edges: &Vec<super::Edge>| {
            let mut at = vec![0.0];
            let mut sum = 0.0;
            for edge in edges {
                sum += edge.path.length();
                at.push(sum);
            }
            at
        };
        Self { starts: pieces.iter().map(|p| p.loops.iter().map(ring).collect()).collect() }
    }

    fn total(&self, piece: usize, ring: usize) -> f64 {
        self.starts[piece][ring].last().copied().unwrap_or(0.0)
    }

    pub(super) fn point(&self, edge: EdgeId, at: f64) -> RimPoint {
        let total = self.total(edge.piece, edge.ring);
        let at = (self.starts[edge.piece][edge.ring][edge.index] + at) % total;
        RimPoint { piece: edge.piece, ring: edge.ring, at }
    }

    /// Whether two points are (nearly) the same point of one rim.
    pub(super) fn same(&self, a: RimPoint, b: RimPoint) -> bool {
        let apart = (a.at - b.at).abs();
        (a.piece, a.ring) == (b.piece, b.ring) && apart.min(self.total(a.piece, a.ring) - apart) < SAME
    }

    /// The edge before and the edge after a corner.
    pub(super) fn edges_at(&self, pieces: &[Piece], p: RimPoint) -> Vec<EdgeId> {
        let edges = &pieces[p.piece].loops[p.ring];
        (0..edges.len())
            .map(|index| EdgeId { piece: p.piece, ring: p.ring, index })
            .filter(|&e| {
                let length = edges[e.index].path.length();
                self.same(self.point(e, 0.0), p) || self.same(self.point(e, length), p)
            })
            .collect()
    }
}

/// Sets of rim points that sewing joins, among those met so far.
#[derive(Clone, Default)]
pub(super) struct Identities {
    /// The points of each rim that were met, by piece and ring, with their numbers in `sets`.
    points: HashMap<(usize, usize), Vec<(RimPoint, u32)>>,
    sets: DisjointSets,
}

impl Identities {
    fn known(&self, rims: &Rims, p: RimPoint) -> Option<u32> {
        let of_rim = self.points.get(&(p.piece, p.ring))?;
        of_rim.iter().find(|(q, _)| rims.same(p, *q)).map(|&(_, node)| node)
    }

    fn node(&mut self, rims: &Rims, p: RimPoint) -> u32 {
        self.known(rims, p).unwrap_or_else(|| {
            let node = self.sets.add();
            self.points.entry((p.piece, p.ring)).or_default().push((p, node));
            node
        })
    }

    fn class(&mut self, rims: &Rims, p: RimPoint) -> u32 {
        let node = self.node(rims, p);
        self.sets.root(node)
    }

    pub(super) fn join(&mut self, rims: &Rims, p: RimPoint, q: RimPoint) {
        let (p, q) = (self.node(rims, p), self.node(rims, q));
        self.sets.join(p, q);
    }

    /// Whether the two points are one, as drawn or as sewn.
    pub(super) fn one(&self, rims: &Rims, p: RimPoint, q: RimPoint) -> bool {
        let both = self.known(rims, p).zip(self.known(rims, q));
        rims.same(p, q) || both.is_some_and(|(p, q)| self.sets.same(p, q))
    }

    /// Joins the points that a seam brings together: its ends, and every joint of one chain with the point across.
    pub(super) fn add_seam(&mut self, rims: &Rims, a: &[Span], b: &[Span], marks: &[(f64, f64)]) {
        for &(on_a, on_b) in marks {
            for p in at_length(rims, a, on_a) {
                for q in at_length(rims, b, on_b) {
                    self.join(rims, p, q);
                }
            }
        }
    }
}

/// The rim points at this length of a chain: two where it goes from one span to the next.
fn at_length(rims: &Rims, chain: &[Span], at: f64) -> Vec<RimPoint> {
    let mut points = Vec::new();
    let mut done = 0.0;
    for span in chain {
        let along = at - done;
        if (-1e-9..=span.length() + 1e-9).contains(&along) {
            let position = span.from + (span.to - span.from) * along / span.length();
            points.push(rims.point(span.edge, position));
        }
        done += span.length();
    }
    points
}

/// An opening of the sewn garment.
#[derive(Clone, Debug, PartialEq)]
pub struct Opening {
    /// Its free stretches, each from its smaller to its larger position.
    pub spans: Vec<Span>,
    /// Length of the rim, metres.
    pub length: f64,
}

/// The openings of the sewn garment, from seams and closures alone: every stretch of rim that no seam takes, joined
/// where seams or corners join them, without stretches that closures close.
pub fn openings(garment: &Garment) -> Vec<Opening> {
    let fastened = fastenings(garment);
    let rims = free_rims(garment, &fastened);
    let left =
        if fastened.is_empty() { rims.into_iter().map(|r| r.spans).collect() } else { worn_spans(rims, &fastened) };
    let patches = patches(garment);
    let patch = |spans: &[Span]| spans.iter().all(|s| patches.contains(&s.edge.piece));
    let spans = left.into_iter().filter(|spans: &Vec<Span>| !patch(spans));
    spans.map(|spans| Opening { length: spans.iter().map(Span::length).sum(), spans }).collect()
}

/// The openings that are left when `fastened` are closed. A rim whose stretches have no one order (three layers meet in
/// a point of it) stays as it is, whatever is fastened there: which of its ways a closure cuts off cannot be told.
fn worn_spans(rims: Vec<FreeRim>, fastened: &[Fastening]) -> Vec<Vec<Span>> {
    let (mut rings, mut unordered) = (Vec::new(), Vec::new());
    for rim in rims {
        match rim.ordered() {
            Some(ring) => rings.push(ring),
            None => unordered.push(rim.spans),
        }
    }
    let steps: Vec<Vec<Step<EdgeId>>> =
        rings.iter().map(|ring| ring.iter().map(|s| Step { along: s.edge, length: s.length() }).collect()).collect();
    let bridge = |f: &Fastening| {
        let [a, b] = f.ends.each_ref().map(|spot| corner(&rings, spot));
        Some(Bridge { corners: [a?, b?], along: f.ends.map(|e| e.edge), reach: f.reach, row: f.row })
    };
    let bridges: Vec<Bridge<EdgeId>> = fastened.iter().filter_map(bridge).collect();
    let kept = worn_rims(&steps, &bridges);
    let worn = kept.into_iter().map(|steps| steps.into_iter().map(|[r, k]| rings[r][k]).collect());
    worn.chain(unordered).collect()
}

/// The ring, and the corner of it, nearest to a spot where something is fastened.
fn corner(rings: &[Vec<Span>], spot: &RimSpot) -> Option<[usize; 2]> {
    let apart = |s: &Span, at: f64| if s.edge == spot.edge { (at - spot.at).abs() } else { f64::INFINITY };
    let ends = rings.iter().enumerate().flat_map(|(r, ring)| {
        let both =
            move |(k, s): (usize, &Span)| [(apart(s, s.from), [r, k]), (apart(s, s.to), [r, (k + 1) % ring.len()])];
        ring.iter().enumerate().flat_map(both)
    });
    ends.filter(|e| e.0 <= SLIVER).min_by(|a, b| a.0.total_cmp(&b.0)).map(|e| e.1)
}

/// The stretches no seam takes that are joined to one rim, and the points (by number) at which each begins and ends.
struct FreeRim {
    spans: Vec<Span>,
    ends: Vec<[u32; 2]>,
}

impl FreeRim {
    /// The stretches as they follow each other round the rim. None where they do not make one ring.
    fn ordered(&self) -> Option<Vec<Span>> {
        let (first, count) = (*self.ends.first()?, self.spans.len());
        let mut left: Vec<usize> = (1..count).collect();
        let mut ring = vec![self.spans[0]];
        let mut at = first[1];
        while !left.is_empty() {
            // Round a piece that is sewn right side to wrong side, the way is back along its edges.
            let next = |from: usize| left.iter().position(|&k| self.ends[k][from] == at).map(|i| (i, from));
            let (i, from) = next(0).or_else(|| next(1))?;
            let k = left.remove(i);
            let Span { edge, from: low, to: high } = self.spans[k];
            ring.push(if from == 0 { self.spans[k] } else { Span { edge, from: high, to: low } });
            at = self.ends[k][1 - from];
        }
        (at == first[0]).then_some(ring)
    }
}

/// The free stretches by the rims they are joined to.
fn free_rims(garment: &Garment, fastened: &[Fastening]) -> Vec<FreeRim> {
    let rims = Rims::new(&garment.pieces);
    let mut one = Identities::default();
    for seam in &garment.seams {
        one.add_seam(&rims, &seam.a, &seam.b, &joint_marks(seam));
    }
    let divided: Vec<(EdgeId, f64)> = fastened.iter().flat_map(|f| f.ends).map(|end| (end.edge, end.at)).collect();
    let free = free_spans(garment, &divided);
    let ends_of = |s: &Span| [s.from, s.to].map(|at| rims.point(s.edge, at));
    let ends: Vec<[u32; 2]> = free.iter().map(|s| ends_of(s).map(|p| one.class(&rims, p))).collect();
    for span in &free {
        let [from, to] = ends_of(span);
        one.join(&rims, from, to);
    }
    let mut found: Vec<(u32, FreeRim)> = Vec::new();
    for (span, ends) in free.into_iter().zip(ends) {
        let class = one.class(&rims, rims.point(span.edge, span.from));
        let i = found.iter().position(|(c, _)| *c == class).unwrap_or_else(|| {
            found.push((class, FreeRim { spans: Vec::new(), ends: Vec::new() }));
            found.len() - 1
        });
        found[i].1.spans.push(span);
        found[i].1.ends.push(ends);
    }
    found.into_iter().map(|(_, rim)| rim).collect()
}

/// The seam's marks and, in proportion between them, every joint of either chain.
pub(super) fn joint_marks(seam: &Seam) -> Vec<(f64, f64)> {
    let mut all = seam.marks.clone();
    let across = |at: f64, from: fn(&(f64, f64)) -> f64, to: fn(&(f64, f64)) -> f64| {
        let pair = seam.marks.windows(2).find(|w| at <= from(&w[1]))?;
        let share = (at - from(&pair[0])) / (from(&pair[1]) - from(&pair[0]));
        Some(to(&pair[0]) + share * (to(&pair[1]) - to(&pair[0])))
    };
    for at in joints(&seam.a) {
        all.extend(across(at, |m| m.0, |m| m.1).map(|b| (at, b)));
    }
    for at in joints(&seam.b) {
        all.extend(across(at, |m| m.1, |m| m.0).map(|a| (a, at)));
    }
    all
}

/// Lengths along a chain at which it goes from one span to the next.
pub(super) fn joints(chain: &[Span]) -> Vec<f64> {
    let mut sum = 0.0;
    let ends = chain.iter().map(|s| {
        sum += s.length();
        sum
    });
    ends.take(chain.len().saturating_sub(1)).collect()
}
