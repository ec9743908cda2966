//! The cut line of a ring of edges: each edge's sewing line moved out by its own allowance, joined at the corners.

use super::clean::{grown, shrunk};
use super::corner::{CornerWish, Join, cap, join, join_plainly};
use super::run::SmoothRun;
use crate::geometry::{Path, Vec2, mirrored};

/// Chords of cut lines leave the true line by at most this much (metres): a fifth of the hundredth of a millimetre that
/// paper patterns are exact to, so that rounding fits in beside it.
pub(super) const CHORD_ERROR: f64 = 2e-6;

/// An edge and its allowance.
#[derive(Clone, Debug)]
pub(super) struct Border<'a> {
    pub(super) path: &'a Path,
    /// Metres.
    pub(super) width: f64,
    /// Its ending at corners.
    pub(super) wish: CornerWish,
}

/// Transition between an edge and the next.
#[derive(Clone, Copy, Debug)]
pub(super) enum EdgeTransition {
    /// A corner of the piece.
    Corner,
    /// A dart, whose mouth lies between the two edges.
    Dart {
        /// Point where its legs meet.
        tip: Vec2,
        /// Pressed onto the edge before it, or else the one after it.
        onto_first: bool,
    },
}

/// A ring as smooth runs with their joins.
struct RunRing {
    runs: Vec<SmoothRun>,
    joins: Vec<RunJoint>,
}

#[derive(Clone, Copy)]
enum RunJoint {
    /// Within an edge.
    Smooth,
    /// Between two edges, as the first and the second wish it.
    Corner([CornerWish; 2]),
    Dart {
        tip: Vec2,
        onto_first: bool,
    },
}

impl RunJoint {
    /// Its image in a line, with the two edges changed about.
    fn image(self, [on, along]: [Vec2; 2]) -> Self {
        match self {
            Self::Smooth => Self::Smooth,
            Self::Corner([one, other]) => Self::Corner([other, one]),
            Self::Dart { tip, onto_first } => Self::Dart { tip: mirrored(tip, on, along), onto_first: !onto_first },
        }
    }
}

impl RunRing {
    fn new(borders: &[Border], between: &[EdgeTransition]) -> Self {
        let mut ring = Self { runs: Vec::new(), joins: Vec::new() };
        for (i, border) in borders.iter().enumerate() {
            let next = &borders[(i + 1) % borders.len()];
            for stations in border.path.stations(border.width, CHORD_ERROR) {
                ring.runs.push(SmoothRun::new(&stations, border.width));
                ring.joins.push(RunJoint::Smooth);
            }
            if let Some(last) = ring.joins.last_mut() {
                *last = match between[i] {
                    EdgeTransition::Corner => RunJoint::Corner([border.wish, next.wish]),
                    EdgeTransition::Dart { tip, onto_first } => RunJoint::Dart { tip, onto_first },
                };
            }
        }
        ring
    }

    /// The ring of the whole piece whose half has these edges: all but the fold, from its end round to its start.
    fn unfolded(borders: &[Border], between: &[EdgeTransition], axis: [Vec2; 2]) -> Self {
        let mut ring = Self::new(borders, between);
        // An edge meets its own image at the fold: two equal wishes.
        let at_fold = RunJoint::Corner([CornerWish::MITRED; 2]);
        ring.joins.pop();
        let back: Vec<RunJoint> = ring.joins.iter().rev().map(|joint| joint.image(axis)).collect();
        ring.joins.push(at_fold);
        ring.joins.extend(back);
        ring.joins.push(at_fold);
        let images: Vec<SmoothRun> = ring.runs.iter().rev().map(|run| run.image(axis)).collect();
        ring.runs.extend(images);
        ring
    }

    fn sewn(&self) -> Self {
        Self { runs: self.runs.iter().map(SmoothRun::sewn).collect(), joins: self.joins.clone() }
    }

    /// The cut line before the corner that ends run `i`, walked away from it, over the run and the one before that.
    fn line_before(&self, i: usize) -> Vec<Vec2> {
        let count = self.runs.len();
        let (own, before) = (&self.runs[i], (i + count - 1) % count);
        if matches!(self.joins[before], RunJoint::Dart { .. }) || count < 3 {
            return own.moved.iter().rev().copied().collect();
        }
        let further = &self.runs[before];
        let Join { leave, between, enter } = join_plainly(further, own);
        if enter.0 >= (own.moved.len() - 1) as f64 {
            return own.moved.iter().rev().copied().collect();
        }
        let last = own.moved.iter().enumerate().rev().filter(|(k, _)| *k as f64 > enter.0).map(|(_, p)| *p);
        let first = further.moved.iter().enumerate().rev().filter(|(k, _)| (*k as f64) < leave.0).map(|(_, p)| *p);
        last.chain([enter.1]).chain(between.into_iter().rev()).chain([leave.1]).chain(first).collect()
    }

    /// The cut line after that corner, likewise.
    fn line_after(&self, i: usize) -> Vec<Vec2> {
        let count = self.runs.len();
        let next = (i + 1) % count;
        let (own, further) = (&self.runs[next], &self.runs[(i + 2) % count]);
        if matches!(self.joins[next], RunJoint::Dart { .. }) || count < 3 {
            return own.moved.clone();
        }
        let Join { leave, between, enter } = join_plainly(own, further);
        if leave.0 <= 0.0 {
            return own.moved.clone();
        }
        let first = own.moved.iter().enumerate().filter(|(k, _)| (*k as f64) < leave.0).map(|(_, p)| *p);
        let last = further.moved.iter().enumerate().filter(|(k, _)| *k as f64 > enter.0).map(|(_, p)| *p);
        first.chain([leave.1]).chain(between).chain([enter.1]).chain(last).collect()
    }

    /// Its moved runs as one closed contour, which may still cross itself.
    fn contour(&self) -> Vec<Vec2> {
        let count = self.runs.len();
        let joins: Vec<Join> = (0..count)
            .map(|i| {
                let (a, b) = (&self.runs[i], &self.runs[(i + 1) % count]);
                match self.joins[i] {
                    RunJoint::Smooth => join_plainly(a, b),
                    RunJoint::Corner(wishes) => join(a, b, wishes, [&self.line_before(i), &self.line_after(i)]),
                    RunJoint::Dart { tip, onto_first } => cap(a, b, tip, onto_first),
                }
            })
            .collect();
        let mut contour = Vec::new();
        for (i, run) in self.runs.iter().enumerate() {
            let (enter, leave) = (&joins[(i + count - 1) % count].enter, &joins[i].leave);
            contour.push(enter.1);
            let inner = run.moved.iter().enumerate().filter(|&(k, _)| enter.0 < k as f64 && (k as f64) < leave.0);
            contour.extend(inner.map(|(_, p)| *p));
            contour.push(leave.1);
            contour.extend(&joins[i].between);
        }
        contour
    }
}

/// The cut line round an outline (clockwise on screen): closed, never crossing itself, the outline inside it. More than
/// one contour where an allowance closes round a bay of the piece: the outer one first.
pub(super) fn around(borders: &[Border], between: &[EdgeTransition]) -> Vec<Vec<Vec2>> {
    let ring = RunRing::new(borders, between);
    grown(&ring.contour(), &ring.sewn().contour())
}

/// The cut line of the whole piece of which an outline is the half that is drawn. `fold` is the edge on the fold. At
/// the fold's ends the allowances of the two halves meet, which nothing on one half alone tells.
pub(super) fn around_unfolded(borders: &[Border], between: &[EdgeTransition], fold: usize) -> Vec<Vec<Vec2>> {
    let path = borders[fold].path;
    let axis = [path.start(), (path.end() - path.start()).normalize()];
    let open = |count: usize| (1..count).map(move |k| (fold + k) % count);
    let edges: Vec<Border> = open(borders.len()).map(|i| borders[i].clone()).collect();
    let joints: Vec<EdgeTransition> = open(between.len()).map(|i| between[i]).collect();
    let ring = RunRing::unfolded(&edges, &joints, axis);
    grown(&ring.contour(), &ring.sewn().contour())
}

/// The sewing line of an outline with its darts closed and pressed, along which a seam is sewn.
pub(super) fn sewn_mouths(borders: &[Border], between: &[EdgeTransition]) -> Vec<Vec<Vec2>> {
    let ring = RunRing::new(borders, between).sewn();
    let count = ring.runs.len();
    let mut mouths = Vec::new();
    for i in 0..count {
        if let RunJoint::Dart { tip, onto_first } = ring.joins[i] {
            let join = cap(&ring.runs[i], &ring.runs[(i + 1) % count], tip, onto_first);
            let mut points = vec![join.leave.1];
            points.extend(join.between);
            points.push(join.enter.1);
            mouths.push(points);
        }
    }
    mouths
}

/// The cut lines of a hole (counter-clockwise on screen), smaller by its allowance. None if nothing is left to cut out.
pub(super) fn within(borders: &[Border]) -> Vec<Vec<Vec2>> {
    shrunk(&RunRing::new(borders, &vec![EdgeTransition::Corner; borders.len()]).contour())
}
