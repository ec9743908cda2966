//! Stitches as the seams of a garment file: mirrored ones written once, those that go on into each other joined.

use super::pieces::FilePiece;
use super::spec::Specification;
use crate::pattern::Side;

/// An edge of a piece, on one of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct StitchedEdge {
    pub(super) piece: usize,
    /// Of the drawing.
    pub(super) edge: usize,
    /// `None` for a piece that is cut once.
    pub(super) side: Option<Side>,
}

/// Two chains of edges sewn together, each as it is walked: the first clockwise, the second the other way (or clockwise
/// as well where the faces are the same).
#[derive(Clone, Debug)]
pub(super) struct Joined {
    pub(super) a: Vec<StitchedEdge>,
    pub(super) b: Vec<StitchedEdge>,
    pub(super) face_same: bool,
    /// Stands for its mirror image too.
    pub(super) both_sides: bool,
}

/// Finds the edges that stitches join.
pub(super) struct StitchedEdges<'a> {
    pub(super) spec: &'a Specification,
    pub(super) pieces: &'a [FilePiece],
    /// Which side a panel is on, by its index.
    pub(super) sides: &'a [Option<Side>],
    /// Length of every edge of every piece's drawing.
    pub(super) lengths: &'a [Vec<f64>],
}

/// Two ratios of lengths are alike within this: seams of one gather are one seam.
const ALIKE: f64 = 0.004;

impl StitchedEdges<'_> {
    /// Where edge `k` of a panel is in the garment file.
    pub(super) fn place(&self, panel: usize, k: usize) -> Option<StitchedEdge> {
        let count = self.spec.panels[panel].edges.len();
        self.pieces.iter().enumerate().find_map(|(piece, p)| {
            let edge = p.edge(panel, k, count)?;
            Some(StitchedEdge { piece, edge, side: p.twin.and(self.sides[panel]) })
        })
    }

    /// All seams, in the order of the stitches.
    pub(super) fn seams(&self) -> Vec<Joined> {
        let mut single: Vec<([StitchedEdge; 2], bool)> = Vec::new();
        for stitch in &self.spec.stitches {
            let [a, b] = stitch.ends.map(|(panel, k)| self.place(panel, k));
            if let (Some(a), Some(b)) = (a, b) {
                single.push(([a, b], stitch.right_wrong));
            }
        }
        let mut out: Vec<Joined> = Vec::new();
        let mut done = vec![false; single.len()];
        for i in 0..single.len() {
            if done[i] {
                continue;
            }
            done[i] = true;
            let (ends, face_same) = single[i];
            let image = ends.map(mirrored);
            let twin = (0..single.len()).find(|&j| !done[j] && single[j].1 == face_same && is(single[j].0, image));
            // Two edges of one side, as on the other; or an edge and its own mirror image.
            let of_pair = ends.iter().all(|e| e.side.is_some());
            let both_sides = of_pair && ((ends[0].side == ends[1].side && twin.is_some()) || is(ends, image));
            if let Some(j) = twin.filter(|_| both_sides) {
                done[j] = true;
            }
            let [a, b] = ends;
            out.push(Joined { a: vec![a], b: vec![b], face_same, both_sides });
        }
        self.run_together(out)
    }

    /// Joins seams that go on into each other on the same two pieces.
    fn run_together(&self, mut seams: Vec<Joined>) -> Vec<Joined> {
        let mut i = 0;
        while i < seams.len() {
            let next =
                (0..seams.len()).filter(|&j| j != i).find_map(|j| Some((j, self.followed(&seams[i], &seams[j])?)));
            match next {
                Some((j, joined)) => {
                    seams[i] = joined;
                    seams.remove(j);
                    if j < i {
                        i -= 1;
                    }
                }
                None => i += 1,
            }
        }
        seams
    }

    /// `one` and then `next` as one seam, if they are.
    fn followed(&self, one: &Joined, next: &Joined) -> Option<Joined> {
        let next_turned = Joined { a: next.b.clone(), b: next.a.clone(), ..next.clone() };
        [next.clone(), next_turned].into_iter().find_map(|next| {
            let alike = one.face_same == next.face_same && one.both_sides == next.both_sides;
            let (end, start) = (one.a.last()?, next.a.first()?);
            let goes_on = self.after(*end) == *start
                && if one.face_same != (self.turned(end) != self.turned(one.b.last()?)) {
                    self.after(*one.b.last()?) == *next.b.first()?
                } else {
                    self.after(*next.b.first()?) == *one.b.last()?
                };
            let darts = end.piece == one.b.last()?.piece;
            let ratio = |s: &Joined| self.length(&s.a) / self.length(&s.b);
            let same_give = (ratio(one) / ratio(&next) - 1.0).abs() < ALIKE;
            (alike && goes_on && !darts && same_give).then(|| Joined {
                a: [&one.a[..], &next.a].concat(),
                b: [&one.b[..], &next.b].concat(),
                ..one.clone()
            })
        })
    }

    /// Whether the place is on the piece of a pair that is not drawn, whose outline runs the other way.
    fn turned(&self, place: &StitchedEdge) -> bool {
        place.side.is_some() && place.side != self.sides[self.pieces[place.piece].panel]
    }

    /// The next edge of the drawing, clockwise.
    fn after(&self, place: StitchedEdge) -> StitchedEdge {
        StitchedEdge { edge: (place.edge + 1) % self.lengths[place.piece].len(), ..place }
    }

    /// Length of a chain, millimetres.
    pub(super) fn length(&self, chain: &[StitchedEdge]) -> f64 {
        chain.iter().map(|p| self.lengths[p.piece][p.edge]).sum()
    }
}

fn mirrored(place: StitchedEdge) -> StitchedEdge {
    StitchedEdge { side: place.side.map(Side::other), ..place }
}

fn is(ends: [StitchedEdge; 2], other: [StitchedEdge; 2]) -> bool {
    ends == other || ends == [other[1], other[0]]
}
