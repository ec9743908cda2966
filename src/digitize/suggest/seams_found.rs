//! Seams that were found so far, and which ends of other edges they bring together.

use std::f64::consts::PI;

use super::Outline;
use super::corner::{is_fold, turn_before};
use super::matches::Match;
use super::over_darts::over_darts;
use super::run::{EdgeRun, parts};
use crate::digitize::edges::CORNER;
use crate::geometry::Vec2;

/// Where two seams meet in a point of two pieces, the angles of these make about a full turn (radians, 290 to 430
/// degrees); else the corner would be closed to a bag's.
const ROUND: std::ops::RangeInclusive<f64> = 290.0 / 180.0 * PI..=430.0 / 180.0 * PI;
/// A run that rises or falls by more than this share of its length along the grain has an upper and a lower end.
const UPRIGHT: f64 = 0.3;

/// An edge is an upper or a lower one whose direction outwards is up or down to this: the cosine of 15 degrees.
const LEVEL: f64 = 0.966;
/// A run that is as wide as its piece, but for this share, goes from side to side.
const FROM_SIDE: f64 = 0.9;
/// Parts of a symmetric piece differ from their mirror images by no more than this (metres).
const SYMMETRIC: f64 = 5e-4;
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
    pub(super) up: Vec2,
    /// The parts of each outline from corner to corner, without the legs of darts, clockwise.
    parts: Vec<Vec<Vec<usize>>>,
    /// Of each piece that is its own mirror image the numbers of the parts that those of `parts` are the images of.
    images: Vec<Option<Vec<usize>>>,
}

impl<'o> SeamsFound<'o> {
    pub(super) fn new(outlines: &'o [Outline]) -> Self {
        let parts: Vec<Vec<Vec<usize>>> = outlines.iter().map(sewn_parts).collect();
        let images = outlines.iter().zip(&parts).map(|(outline, parts)| images(outline, parts)).collect();
        let (seams, centers, joined) = (Vec::new(), Vec::new(), Vec::new());
        Self { outlines, seams, centers, joined, up: up(outlines), parts, images }
    }

    /// Whether a piece is its own mirror image.
    pub(super) fn is_symmetric(&self, piece: usize) -> bool {
        self.images[piece].is_some()
    }

    /// The edges of a piece that is cut once and is its own mirror image, each with its image.
    pub(super) fn edge_images(&self, piece: usize) -> Vec<(usize, usize)> {
        let (Some(images), true) = (&self.images[piece], self.outlines[piece].single) else { return Vec::new() };
        let parts = &self.parts[piece];
        let of = |(k, image): (usize, &usize)| {
            let backward = parts[*image].iter().rev().copied();
            parts[k].iter().copied().zip(backward).collect::<Vec<_>>()
        };
        images.iter().enumerate().flat_map(of).collect()
    }

    /// Whether a seam of a whole piece with one of which there is a left and a right is sewn on its other side, too, to
    /// this run.
    fn has_image(&self, run: &EdgeRun) -> bool {
        let own = self.edge_images(run.piece);
        let image = |edge: &usize| own.iter().find(|(own, _)| own == edge).map(|(_, image)| *image);
        let meets = |side: &EdgeRun, other: &EdgeRun| {
            side.piece == run.piece
                && self.outlines[other.piece].mirrored
                && side.edges.iter().filter_map(image).any(|edge| run.edges.contains(&edge))
        };
        self.seams.iter().any(|seam| meets(&seam.a, &seam.b) || meets(&seam.b, &seam.a))
    }

    /// Whether a seam joins the same side of two pieces that are each other's mirror image: the left and the right of
    /// one. Nothing but a straight center is sewn so.
    pub(super) fn is_of_twins(&self, seam: &Match) -> bool {
        let [a, b] = [seam.a.piece, seam.b.piece];
        let lengths = |piece: usize| -> Vec<f64> {
            let own = |part: &Vec<usize>| {
                part.iter().map(|&edge| self.outlines[piece].edges[edge].path.length()).sum::<f64>()
            };
            self.parts[piece].iter().map(own).collect()
        };
        let place = |run: &EdgeRun| self.parts[run.piece].iter().position(|part| part.contains(&run.edges[0]));
        let (Some(i), Some(k)) = (place(&seam.a), place(&seam.b)) else { return false };
        let (one, other) = (lengths(a), lengths(b));
        let count = one.len();
        let same = |step: usize| (one[(i + step) % count] - other[(k + count - step) % count]).abs() <= SYMMETRIC;
        a != b && count == other.len() && !self.is_symmetric(a) && (0..count).all(same)
    }

    /// Whether both sides of a seam come as many corners after those of a seam that is found, as sides come after
    /// shoulders in front and behind.
    pub(super) fn is_in_step(&self, seam: &Match) -> bool {
        let place = |run: &EdgeRun| self.parts[run.piece].iter().position(|part| part.contains(&run.edges[0]));
        let steps = |from: &EdgeRun, to: &EdgeRun| {
            let count = self.parts[from.piece].len();
            Some((place(to)? + count - place(from)?) % count)
        };
        let after = |[a, b]: [&EdgeRun; 2]| {
            let count = self.parts[b.piece].len();
            let [one, other] = [steps(a, &seam.a), steps(b, &seam.b)];
            // Of two left ones, as of two right ones, both run the same way round.
            one.zip(other).is_some_and(|(one, other)| {
                let backward = (count - other) % count;
                let before = (self.parts[a.piece].len() - one) % self.parts[a.piece].len();
                if seam.opposed { one == backward || other == before } else { one == other || before == backward }
            })
        };
        let pieces = [seam.a.piece, seam.b.piece];
        let alike = self.seams.iter().filter(|own| own.opposed == seam.opposed);
        alike.into_iter().any(|own| match [own.a.piece, own.b.piece] {
            own_pieces if own_pieces == pieces => after([&own.a, &own.b]),
            [a, b] if [b, a] == pieces => after([&own.b, &own.a]),
            _ => false,
        })
    }

    /// The part of a run's direction outwards that is up in the drawing: 1 of an upper edge, -1 of a lower one.
    pub(super) fn facing(&self, run: &EdgeRun) -> f64 {
        run.along().map_or(0.0, |along| Vec2::new(along.y, -along.x).dot(&self.up))
    }

    /// Whether a seam is between an upper edge of one piece and a lower one of another.
    pub(super) fn is_level(&self, seam: &Match) -> bool {
        let [a, b] = [&seam.a, &seam.b].map(|run| self.facing(run));
        seam.a.piece != seam.b.piece && a.abs().min(b.abs()) >= LEVEL && a * b < 0.0
    }

    /// Whether both of these are upper edges from side to side, or both are lower ones.
    pub(super) fn is_same_level(&self, seam: &Match) -> bool {
        let [a, b] = [&seam.a, &seam.b].map(|run| self.facing(run));
        let across = self.is_across(&seam.a) && self.is_across(&seam.b);
        across && seam.a.piece != seam.b.piece && a.abs().min(b.abs()) >= LEVEL && a * b > 0.0
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

    /// The smaller and the larger extent of a piece, metres.
    pub(super) fn sizes(&self, piece: usize) -> [f64; 2] {
        let [wide, high] = [self.extent(piece, Vec2::x()), self.extent(piece, Vec2::y())];
        [wide.min(high), wide.max(high)]
    }

    /// Extent of a piece's corners along a direction.
    fn extent(&self, piece: usize, along: Vec2) -> f64 {
        let corners = self.outlines[piece].edges.iter().map(|edge| edge.path.start().dot(&along));
        let (low, high) = corners.fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    }

    /// Whether a seam has an edge of a run, also one down the center.
    pub(super) fn has(&self, run: &EdgeRun) -> bool {
        self.is_center(run)
            || self.seams.iter().any(|seam| seam.a.meets(run) || seam.b.meets(run))
            || self.has_image(run)
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

/// The parts of an outline from corner to corner, without the legs of darts.
fn sewn_parts(outline: &Outline) -> Vec<Vec<usize>> {
    let whole = parts(outline);
    let joined = over_darts(outline, whole.clone());
    // Legs stand where they were, and are in no part that goes on over them.
    let goes_over = |part: &Vec<usize>, edge: usize| {
        let ends = [part[0], part[part.len() - 1]];
        let count = outline.edges.len();
        let along = |k: usize| (k + count - ends[0]) % count;
        !part.contains(&edge) && along(edge) < along(ends[1])
    };
    let mut parts: Vec<Vec<usize>> =
        joined.iter().filter(|part| !joined.iter().any(|other| goes_over(other, part[0]))).cloned().collect();
    parts.sort();
    parts
}

/// The numbers of the parts that those of an outline are the mirror images of, if it is its own: from some part on they
/// are as long as each other both ways.
fn images(outline: &Outline, parts: &[Vec<usize>]) -> Option<Vec<usize>> {
    let lengths: Vec<f64> =
        parts.iter().map(|part| part.iter().map(|&edge| outline.edges[edge].path.length()).sum()).collect();
    let count = lengths.len();
    let same = |a: usize, b: usize| {
        (lengths[a % count] - lengths[b % count]).abs() <= SYMMETRIC && parts[a % count].len() == parts[b % count].len()
    };
    // The axis goes through the middle of a part or of a corner; the one along the warp is the wearer's.
    let axes = (0..count).filter(|sum| (0..count).all(|k| same(k, sum + count - k)));
    let upright = |sum: &usize| {
        let warp = outline.warp.unwrap_or(Vec2::y());
        let middle = |k: usize| {
            let edges = &parts[k % count];
            let ends = [&outline.edges[edges[0]].path, &outline.edges[edges[edges.len() - 1]].path];
            (ends[0].start() + ends[1].end()) / 2.0
        };
        // From a part to its image the way goes across the warp.
        (0..count).map(|k| (middle(k) - middle(sum + count - k)).dot(&warp).abs()).sum::<f64>()
    };
    let axis = axes.min_by(|a, b| upright(a).total_cmp(&upright(b)))?;
    Some((0..count).map(|k| (axis + count - k) % count).collect())
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
