//! Notches: which marks are one, and where on which edge they are.

use super::darts::whole_name;
use super::{ImportedNotch, ToldNotch};
use crate::geometry::{Path, Vec2};
use crate::pattern::{DOUBLE_MARKS, NotchKind};

/// Notches past this many are no notches, where the drawing does not tell them.
const MOST_NOTCHES: usize = 400;
/// A notch is on an outline it is no farther from than this (metres): the widest usual allowance.
const REACH: f64 = 0.045;
/// Two notches at most so far apart (metres) are a double one.
pub(crate) const DOUBLE: f64 = 0.011;
/// Of notches in one place, to this (metres), all but the first are drawn once more.
const AGAIN: f64 = 1e-4;
/// Distance within which a notch at a corner is on both edges, metres: rounding of programs.
const ON_BOTH: f64 = 1e-6;
/// As near to each other as this (metres) lie the edges that a point is nearest to if it does not say on which it is.
const SAME: f64 = 1e-9;

/// An edge of an outline, which may have a name.
type Named = (Option<String>, Path);

/// A notch on an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct EdgeNotch {
    /// Metres from the edge's start.
    pub(super) at: f64,
    pub(super) double: bool,
    /// Whether it may be the mouth of a dart or a pleat, which has its notches by itself.
    pub(super) may_be_mouth: bool,
}

/// A notch by its mark, or the two marks of a double one.
struct NotchMarks {
    marks: Vec<DrawnMark>,
    double: bool,
    told: Option<ToldNotch>,
}

struct DrawnMark {
    at: Vec2,
    /// Nearer to the notch than the other mark of a double one.
    at_end: bool,
}

impl NotchMarks {
    fn new(at: Vec2, told: Option<ToldNotch>) -> Self {
        let at_end = told.as_ref().is_some_and(|told| told.kind == NotchKind::DoubleAtEnd);
        let double = told.as_ref().is_some_and(|told| told.kind.is_double());
        Self { marks: vec![DrawnMark { at, at_end }], double, told }
    }

    /// Whether a mark of a double notch may be the second of this one.
    fn lacks(&self, mark: &Self) -> bool {
        let is_near = (self.marks[0].at - mark.marks[0].at).norm() <= DOUBLE;
        self.double && mark.double && self.marks.len() == 1 && is_near && self.edge() == mark.edge()
    }

    /// Name of the edge that it is told to be on.
    fn edge(&self) -> Option<&str> {
        self.told.as_ref().map(|told| told.edge.as_str())
    }

    /// Distance from a line.
    fn off(&self, path: &Path) -> f64 {
        self.marks.iter().map(|mark| path.nearest(mark.at).1).fold(0.0, f64::max)
    }

    /// Position along a line: half way between its marks. If one mark stands at the edge's end, the position follows
    /// from the other mark.
    fn along(&self, path: &Path) -> f64 {
        let along = |mark: &DrawnMark| path.nearest(mark.at).0;
        let half = |from: f64, to: f64| from + DOUBLE_MARKS / 2.0 * (to - from).signum();
        match self.marks.as_slice() {
            [a, b] if a.at_end && !b.at_end => half(along(b), along(a)),
            [a, b] if b.at_end && !a.at_end => half(along(a), along(b)),
            marks => marks.iter().map(along).sum::<f64>() / marks.len() as f64,
        }
    }
}

/// The notches of an outline.
pub(super) struct Notches(Vec<NotchFound>);

/// A notch and the edges that it is nearest to.
struct NotchFound {
    place: NotchMarks,
    /// Distance from these.
    off: f64,
    /// The one of them that it is on, if that is told.
    edge: Option<usize>,
}

impl Notches {
    pub(super) fn new(outline: &[Named], notches: &[ImportedNotch]) -> Self {
        let (told, untold): (Vec<&ImportedNotch>, Vec<&ImportedNotch>) =
            notches.iter().partition(|notch| notch.told.is_some());
        let untold: Vec<Vec2> = untold.into_iter().map(|notch| notch.at).collect();
        let places = singled(&untold).into_iter().chain(paired(&told));
        Self(places.map(|place| NotchFound::new(place, outline)).collect())
    }

    /// Those on the edge of this number, as places along `path`, which is that edge.
    pub(super) fn on(&self, edge: usize, path: &Path) -> Vec<EdgeNotch> {
        let on_edge = |NotchFound { place, .. }: &NotchFound| EdgeNotch {
            at: place.along(path),
            double: place.double,
            may_be_mouth: place.told.as_ref().is_none_or(|told| !told.kind.is_notch()),
        };
        self.0.iter().filter(|found| found.is_on(edge, path)).map(on_edge).collect()
    }
}

impl NotchFound {
    /// Of the edges that a notch is nearest to it is on the one that is told, or on the first.
    fn new(place: NotchMarks, outline: &[Named]) -> Self {
        let away: Vec<f64> = outline.iter().map(|(_, path)| place.off(path)).collect();
        let off = away.iter().copied().fold(f64::INFINITY, f64::min);
        let edge = place.told.as_ref().and_then(|told| {
            let is_told =
                |k: &usize| outline[*k].0.as_deref().is_some_and(|own| whole_name(own) == whole_name(&told.edge));
            let on = || (0..away.len()).filter(|&k| away[k] <= off + ON_BOTH);
            on().find(is_told).or_else(|| on().next())
        });
        Self { place, off, edge }
    }

    fn is_on(&self, edge: usize, path: &Path) -> bool {
        self.off <= REACH && self.edge.map_or_else(|| self.place.off(path) <= self.off + SAME, |own| own == edge)
    }
}

/// Notches of which nothing is told: those side by side are double.
fn singled(notches: &[Vec2]) -> Vec<NotchMarks> {
    let mut out: Vec<(Vec2, bool)> = Vec::new();
    for &p in notches.iter().take(MOST_NOTCHES) {
        match out.iter_mut().find(|(q, _)| (*q - p).norm() <= DOUBLE) {
            Some((q, double)) if (*q - p).norm() > AGAIN => {
                *q = (*q + p) / 2.0;
                *double = true;
            }
            Some(_) => {}
            None => out.push((p, false)),
        }
    }
    out.into_iter().map(|(at, double)| NotchMarks { double, ..NotchMarks::new(at, None) }).collect()
}

/// Notches that are told: the marks of a double one follow each other.
fn paired(notches: &[&ImportedNotch]) -> Vec<NotchMarks> {
    let mut out: Vec<NotchMarks> = Vec::new();
    for notch in notches {
        let mark = NotchMarks::new(notch.at, notch.told.clone());
        match out.iter_mut().find(|place| place.lacks(&mark)) {
            Some(place) => place.marks.extend(mark.marks),
            None => out.push(mark),
        }
    }
    out
}
