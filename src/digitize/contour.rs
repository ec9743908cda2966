//! A closed line of a drawing, and how it lies to others.

use super::chain::is_closed;
use super::{Role, Stroke};
use crate::geometry::{Path, Vec2, box_of, distance_to_segment, encloses, sides_of};

/// As near to an outline as this (metres) a notch must end.
pub(super) const NEAR: f64 = 1.5e-3;
/// Places of a contour that are looked at.
const LOOKS: usize = 15;
/// Chords that stand for curves where only inside and outside is asked.
pub(super) const COARSE: f64 = 1e-4;
/// Two contours are one line where their areas differ by less than a strip so wide (metres) along it.
const STRIP: f64 = 1e-5;

/// A closed line and the corners it goes through.
pub(super) struct Contour {
    pub(super) edges: Vec<(Option<String>, Path)>,
    pub(super) whole: Path,
    pub(super) points: Vec<Vec2>,
    /// Least and greatest coordinates.
    pub(super) bounds: [Vec2; 2],
    pub(super) role: Role,
    pub(super) name: Option<String>,
    /// Its own name, where it is in a group that has one.
    pub(super) own: Option<String>,
    /// Whether it is filled and no pen runs along it.
    pub(super) filled: bool,
    /// Whether it was drawn edge by edge, or marked as an outline, as toile's own cut-outs are.
    pub(super) of_edges: bool,
}

impl Contour {
    pub(super) fn new(edges: Vec<(Option<String>, Path)>, role: Role, name: Option<String>) -> Option<Self> {
        let mut paths = edges.iter().map(|e| e.1.clone());
        let first = paths.next()?;
        let whole = paths.fold(first, |whole, next| whole.joined(&next));
        let points = whole.sampled(COARSE);
        let bounds = box_of(points.iter().copied());
        let of_edges = role == Role::Edge;
        Some(Self { points, bounds, whole, edges, role, name, own: None, filled: false, of_edges })
    }

    /// The outline that edges make, if they close and go round something.
    pub(super) fn of_edges(edges: Vec<(Option<String>, Path)>, name: Option<String>) -> Option<Self> {
        let closed = is_closed(&edges);
        Self::new(edges, Role::Unknown, name).filter(|contour| closed && contour.area() > 0.0)
    }

    /// Whether most of it lies in `other`. Outlines may share a side, on which no point decides. Without allowance, the
    /// sewing line lies in the cut line that is drawn over it.
    pub(super) fn lies_in(&self, other: &Self) -> bool {
        let middle = (self.bounds[0] + self.bounds[1]) / 2.0;
        let beyond = (0..2).any(|k| middle[k] < other.bounds[0][k] || middle[k] > other.bounds[1][k]);
        let wider = other.area() - self.area();
        let alike = wider.abs() <= STRIP * other.whole.length();
        let over = self.role != Role::Cut && other.role == Role::Cut;
        if beyond || wider <= 0.0 && !alike || alike && !over {
            return false;
        }
        let telling: Vec<Vec2> = self.looks().filter(|&p| other.off(p) > COARSE).collect();
        if alike {
            telling.is_empty()
        } else {
            2 * telling.iter().filter(|&&p| other.holds(p)).count() >= telling.len()
        }
    }

    /// Whether it is no outline but drawn over the rim of one: that of its group, which is told to be one.
    pub(super) fn is_drawn_on(&self, other: &Self) -> bool {
        let told = self.role == Role::Unknown && matches!(other.role, Role::Sew | Role::Cut);
        let over = (0..2).all(|k| self.bounds[0][k] < other.bounds[1][k] && self.bounds[1][k] > other.bounds[0][k]);
        told && over && self.name.is_some() && self.name == other.name && self.area() < other.area()
    }

    /// Whether it is the same line as another.
    pub(super) fn is_again(&self, other: &Self) -> bool {
        let apart = (self.bounds[0] - other.bounds[0]).amax().max((self.bounds[1] - other.bounds[1]).amax());
        if apart > COARSE {
            return false;
        }
        let near = |a: &Self, b: &Self| a.looks().all(|p| b.off(p) <= COARSE);
        let wider = (self.area() - other.area()).abs();
        wider <= STRIP * self.whole.length() && near(self, other) && near(other, self)
    }

    /// Places all round it.
    fn looks(&self) -> impl Iterator<Item = Vec2> {
        (0..LOOKS).map(|k| self.whole.point(self.whole.length() * (k as f64 + 0.5) / LOOKS as f64))
    }

    /// Distance of a point from its line.
    pub(super) fn off(&self, p: Vec2) -> f64 {
        sides_of(&self.points).map(|side| distance_to_segment(p, side)).fold(f64::INFINITY, f64::min)
    }

    /// Whether the middle of a line lies in it or on it.
    pub(super) fn owns(&self, line: &Stroke) -> bool {
        let middle = half_way(line);
        self.holds(middle) || self.whole.nearest(middle).1 <= NEAR
    }

    /// Whether a point lies in it, or on it within rounding.
    pub(super) fn covers(&self, p: Vec2) -> bool {
        self.holds(p) || self.off(p) <= COARSE
    }

    /// The first of the drawing's strokes, given by their middles, that runs along it.
    pub(super) fn first_drawn(&self, middles: &[Vec2]) -> Option<usize> {
        let is_beside = |p: &Vec2| (0..2).all(|k| p[k] >= self.bounds[0][k] - NEAR && p[k] <= self.bounds[1][k] + NEAR);
        middles.iter().position(|p| is_beside(p) && self.off(*p) <= NEAR)
    }

    pub(super) fn area(&self) -> f64 {
        self.whole.double_area().abs() / 2.0
    }

    pub(super) fn holds(&self, p: Vec2) -> bool {
        encloses(sides_of(&self.points), p)
    }
}

/// The point half way along a stroke.
pub(super) fn half_way(stroke: &Stroke) -> Vec2 {
    stroke.path.point(stroke.path.length() / 2.0)
}
