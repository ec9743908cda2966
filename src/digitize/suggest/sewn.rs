//! Seams that were found so far, and which ends of other edges they bring together.

use std::f64::consts::PI;

use super::Outline;
use super::matches::Match;
use super::run::{EdgeRun, is_fold, turn_before};
use crate::digitize::edges::CORNER;

/// Where two seams meet in a point of two pieces, the angles of these make about a full turn (radians, 290 to 430
/// degrees); else the corner would be closed to a bag's.
const ROUND: std::ops::RangeInclusive<f64> = 290.0 / 180.0 * PI..=430.0 / 180.0 * PI;
/// A run that rises or falls by more than this share of its length along the grain has an upper and a lower end.
const UPRIGHT: f64 = 0.3;

/// One end of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct EdgeEnd {
    pub(super) piece: usize,
    pub(super) edge: usize,
    pub(super) at_end: bool,
}

/// The seams found so far.
#[derive(Clone)]
pub(super) struct SeamsFound<'o> {
    outlines: &'o [Outline],
    pub(super) seams: Vec<Match>,
    /// Pieces and numbers of edges that are surely the center of a pair.
    pub(super) centers: Vec<(usize, usize)>,
}

impl<'o> SeamsFound<'o> {
    pub(super) fn new(outlines: &'o [Outline]) -> Self {
        Self { outlines, seams: Vec::new(), centers: Vec::new() }
    }

    /// Whether a seam has an edge of a run.
    pub(super) fn has(&self, run: &EdgeRun) -> bool {
        self.seams.iter().any(|seam| seam.a.meets(run) || seam.b.meets(run))
    }

    /// The end of the edge beside a run that its start, or its end, is shared with.
    pub(super) fn beside(&self, run: &EdgeRun, at_end: bool) -> EdgeEnd {
        let count = self.outlines[run.piece].edges.len();
        let edge =
            if at_end { (run.edges[run.edges.len() - 1] + 1) % count } else { (run.edges[0] + count - 1) % count };
        EdgeEnd { piece: run.piece, edge, at_end: !at_end }
    }

    /// The ends of edges that a seam brings together, where it starts and where it ends.
    pub(super) fn brought(&self, seam: &Match) -> [[EdgeEnd; 2]; 2] {
        [false, true].map(|end| [self.beside(&seam.a, end), self.beside(&seam.b, end != seam.opposed)])
    }

    /// All ends that seams bring together with this one.
    pub(super) fn partners(&self, end: EdgeEnd) -> Vec<EdgeEnd> {
        let pairs = self.seams.iter().flat_map(|seam| self.brought(seam));
        let other = |[a, b]: [EdgeEnd; 2]| match end {
            _ if a == end => Some(b),
            _ if b == end => Some(a),
            _ => None,
        };
        pairs.filter_map(other).filter(|other| *other != end).collect()
    }

    pub(super) fn lies_on_fold(&self, end: EdgeEnd) -> bool {
        is_fold(&self.outlines[end.piece], end.edge)
    }

    /// Whether an edge is in the middle of the wearer: on the fold, or sewn to its mirror image.
    pub(super) fn is_middle(&self, end: EdgeEnd) -> bool {
        self.lies_on_fold(end) || self.centers.contains(&(end.piece, end.edge))
    }

    /// Angle inside a piece where an edge begins or ends.
    fn angle(&self, end: EdgeEnd) -> f64 {
        let outline = &self.outlines[end.piece];
        let vertex = if end.at_end { (end.edge + 1) % outline.edges.len() } else { end.edge };
        PI - turn_before(outline, vertex)
    }

    /// Whether a further seam would close a corner of two pieces as of a bag: hems, above all, follow side seams.
    pub(super) fn makes_bag(&self, seam: &Match) -> bool {
        let with = |run: &EdgeRun, end: EdgeEnd| run.piece == end.piece && run.edges.contains(&end.edge);
        let sews = |a: EdgeEnd, b: EdgeEnd| {
            self.seams.iter().any(|s| (with(&s.a, a) && with(&s.b, b)) || (with(&s.a, b) && with(&s.b, a)))
        };
        let closes = |[a, b]: [EdgeEnd; 2]| a != b && sews(a, b) && !ROUND.contains(&(self.angle(a) + self.angle(b)));
        self.brought(seam).into_iter().any(closes)
    }

    /// How unlike what lies beside the two runs is where a seam brings it together.
    pub(super) fn unlikeness(&self, seam: &Match) -> f64 {
        let beside = |[a, b]: [EdgeEnd; 2]| {
            let [(one, one_ends), (other, other_ends)] = [a, b].map(|end| self.stretch(end));
            let folds = [self.lies_on_fold(a) != self.lies_on_fold(b), one_ends != other_ends];
            let folds = folds.into_iter().filter(|differ| *differ).count() as f64;
            folds + (one / other).ln().abs().min(1.0) + (self.angle(a) - self.angle(b)).abs()
        };
        self.brought(seam).into_iter().map(beside).sum()
    }

    /// Length of the outline from an end of an edge along it to the next corner, and whether a fold begins there.
    fn stretch(&self, end: EdgeEnd) -> (f64, bool) {
        let outline = &self.outlines[end.piece];
        let count = outline.edges.len();
        let (mut edge, mut length) = (end.edge, 0.0);
        for _ in 0..count {
            length += outline.edges[edge].path.length();
            let next = if end.at_end { (edge + count - 1) % count } else { (edge + 1) % count };
            let vertex = if end.at_end { edge } else { next };
            if turn_before(outline, vertex).abs() > CORNER || is_fold(outline, next) {
                return (length, is_fold(outline, next));
            }
            edge = next;
        }
        (length, false)
    }

    /// Whether the upper end of one side meets the lower end of the other.
    pub(super) fn is_upside_down(&self, seam: &Match) -> bool {
        let [a, b] = [&seam.a, &seam.b].map(|run| self.rise(run));
        (a * b > 0.0) == seam.opposed && a.abs().min(b.abs()) > UPRIGHT
    }

    /// By how much of its length a run rises along the grain, pieces being drawn upright.
    fn rise(&self, run: &EdgeRun) -> f64 {
        let Some((warp, along)) = self.outlines[run.piece].warp.zip(run.along()) else { return 0.0 };
        let up = if warp.y.abs() >= warp.x.abs() { -warp * warp.y.signum() } else { warp * warp.x.signum() };
        along.dot(&up)
    }
}
