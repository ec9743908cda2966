//! Seams that were found so far, and which ends of other edges they bring together.

use std::f64::consts::PI;

use super::Outline;
use super::corner::{is_fold, turn_before};
use super::matches::Match;
use super::run::EdgeRun;
use crate::digitize::edges::CORNER;
use crate::geometry::Vec2;

/// Where two seams meet in a point of two pieces, the angles of these make about a full turn (radians, 290 to 430
/// degrees); else the corner would be closed to a bag's.
const ROUND: std::ops::RangeInclusive<f64> = 290.0 / 180.0 * PI..=430.0 / 180.0 * PI;
/// A run that rises or falls by more than this share of its length along the grain has an upper and a lower end.
const UPRIGHT: f64 = 0.3;

/// A run that is as wide as its piece, but for this share, goes from side to side.
const FROM_SIDE: f64 = 0.9;
/// Most corners that meet in a point of a garment.
const MOST_CORNERS: usize = 10;

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
    /// Pieces and numbers of edges that are the center of a pair.
    pub(super) centers: Vec<(usize, usize)>,
    /// Ends of edges that chains join.
    pub(super) joined: Vec<[EdgeEnd; 2]>,
    /// Up in the drawing.
    up: Vec2,
}

impl<'o> SeamsFound<'o> {
    pub(super) fn new(outlines: &'o [Outline]) -> Self {
        Self { outlines, seams: Vec::new(), centers: Vec::new(), joined: Vec::new(), up: up(outlines) }
    }

    /// The part of a run's direction outwards that is up in the drawing: 1 of an upper edge, -1 of a lower one.
    pub(super) fn facing(&self, run: &EdgeRun) -> f64 {
        run.along().map_or(0.0, |along| Vec2::new(along.y, -along.x).dot(&self.up))
    }

    /// Whether a run goes from side to side of its piece.
    pub(super) fn is_across(&self, run: &EdgeRun) -> bool {
        let across = Vec2::new(-self.up.y, self.up.x);
        (run.path.end() - run.path.start()).dot(&across).abs() >= FROM_SIDE * self.extent(run.piece, across)
    }

    /// Whether a piece is no higher than this share of its width.
    pub(super) fn is_low(&self, piece: usize, share: f64) -> bool {
        let across = Vec2::new(-self.up.y, self.up.x);
        self.extent(piece, self.up) <= share * self.extent(piece, across)
    }

    /// Extent of a piece's corners along a direction.
    fn extent(&self, piece: usize, along: Vec2) -> f64 {
        let corners = self.outlines[piece].edges.iter().map(|edge| edge.path.start().dot(&along));
        let (low, high) = corners.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    }

    /// Whether a seam has an edge of a run, also one down the center.
    pub(super) fn has(&self, run: &EdgeRun) -> bool {
        self.is_center(run) || self.seams.iter().any(|seam| seam.a.meets(run) || seam.b.meets(run))
    }

    /// Adds seams between the halves of a pair.
    pub(super) fn add_centers(&mut self, runs: &[EdgeRun]) {
        self.centers.extend(runs.iter().flat_map(|run| run.edges.iter().map(|&edge| (run.piece, edge))));
    }

    /// Whether a run is the center of a pair.
    pub(super) fn is_center(&self, run: &EdgeRun) -> bool {
        self.centers.contains(&(run.piece, run.edges[0]))
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

    /// The ends of edges that a seam joins, where it starts and where it ends.
    fn joints(seam: &Match) -> [[EdgeEnd; 2]; 2] {
        [false, true].map(|end| [run_end(&seam.a, end), run_end(&seam.b, end != seam.opposed)])
    }

    /// The end of an edge that shares its corner with another end.
    fn neighbour(&self, end: EdgeEnd) -> EdgeEnd {
        let count = self.outlines[end.piece].edges.len();
        let edge = if end.at_end { (end.edge + 1) % count } else { (end.edge + count - 1) % count };
        EdgeEnd { edge, at_end: !end.at_end, ..end }
    }

    /// The end of an edge that this one is sewn to.
    fn mate(&self, end: EdgeEnd) -> Option<EdgeEnd> {
        let pairs = self.seams.iter().flat_map(Self::joints).chain(self.joined.iter().copied());
        let other = |[a, b]: [EdgeEnd; 2]| if a == end { Some(b) } else { (b == end).then_some(a) };
        pairs.filter_map(other).next()
    }

    /// The angles of all corners that meet in one point, where a seam that joins these two ends is the last one there;
    /// `None` where it is not.
    fn round(&self, from: EdgeEnd, to: EdgeEnd) -> Option<f64> {
        let (mut at, mut angle) = (self.neighbour(from), self.angle(from));
        for _ in 0..MOST_CORNERS {
            let mate = self.mate(at)?;
            angle += self.angle(mate);
            at = self.neighbour(mate);
            if at == to {
                return Some(angle);
            }
        }
        None
    }

    /// Whether a further seam that joins these two ends closes the point there as cloth lies, or else as the corner of
    /// a bag: hems, above all, follow side seams. `None` where it closes no point.
    pub(super) fn closes(&self, [a, b]: [EdgeEnd; 2]) -> Option<bool> {
        self.round(a, b).map(|angle| ROUND.contains(&angle))
    }

    /// Whether a further seam would close a corner as of a bag.
    pub(super) fn makes_bag(&self, seam: &Match) -> bool {
        Self::joints(seam).into_iter().any(|ends| self.closes(ends) == Some(false))
    }

    /// The number of a seam's ends at which it is the last that was missing.
    pub(super) fn closed_by(&self, seam: &Match) -> usize {
        Self::joints(seam).into_iter().filter(|ends| self.closes(*ends) == Some(true)).count()
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

/// The end of the edge that a run starts or ends with.
pub(super) fn run_end(run: &EdgeRun, at_end: bool) -> EdgeEnd {
    let edge = if at_end { run.edges[run.edges.len() - 1] } else { run.edges[0] };
    EdgeEnd { piece: run.piece, edge, at_end }
}

/// Up in a drawing: along the grain of most of its outlines' length, in one that lies to the right.
fn up(outlines: &[Outline]) -> Vec2 {
    let lying = |outline: &Outline| {
        let length: f64 = outline.edges.iter().map(|edge| edge.path.length()).sum();
        outline.warp.map_or(-length, |warp| if warp.x.abs() > warp.y.abs() { length } else { -length })
    };
    if outlines.iter().map(lying).sum::<f64>() > 0.0 { Vec2::x() } else { -Vec2::y() }
}
