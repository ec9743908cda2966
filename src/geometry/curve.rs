//! A smooth path in the plane. With `bend` and `path_text` the only user of kurbo.

use kurbo::{
    BezPath, ParamCurve, ParamCurveArclen, ParamCurveDeriv, ParamCurveNearest, PathSeg, Point, Shape, Vec2 as KVec,
};

use super::{Cubic, Vec2};

/// Arc lengths are exact to this many metres (a nanometre): far below any drafting tolerance, still cheap.
pub(super) const LENGTH_ACCURACY: f64 = 1e-9;

/// Nearest points are found to this many metres, so that a point of the path is known as one to [`LENGTH_ACCURACY`].
const NEAREST_ACCURACY: f64 = 1e-12;

/// A connected run of lines and Bézier curves, metres, measured by arc length from its start.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    pub(super) segments: Vec<PathSeg>,
    /// Arc length at the start of each segment, and the total at the end.
    at: Vec<f64>,
}

/// A point of a path and the unit tangent there, along the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Station {
    /// The point.
    pub at: Vec2,
    /// The direction.
    pub tangent: Vec2,
}

/// Most halvings of a segment in [`Path::stations`]. A curve that needs more has no tangent worth following.
const MOST_HALVINGS: usize = 14;

fn point(p: Vec2) -> Point {
    Point::new(p.x, p.y)
}

fn vector(p: Point) -> Vec2 {
    Vec2::new(p.x, p.y)
}

/// Relative accuracy of arcs and lengths, which bounds the work for paths of kilometres: their absolute accuracy would
/// take for ever.
pub(super) const RELATIVE_ACCURACY: f64 = 1e-12;
/// Size beyond which squares may overflow and no length converges, metres. The length of the control polygon then has
/// to do: it tells that the path is too long.
const MEASURABLE: f64 = 1e9;

/// Arc length of a segment, metres.
pub(super) fn arc_length(segment: &PathSeg) -> f64 {
    let c = segment.to_cubic();
    let size = [c.p0, c.p1, c.p2, c.p3].iter().fold(0.0f64, |size, p| size.max(p.x.abs()).max(p.y.abs()));
    if size > MEASURABLE {
        return (c.p1 - c.p0).hypot() + (c.p2 - c.p1).hypot() + (c.p3 - c.p2).hypot();
    }
    segment.arclen(LENGTH_ACCURACY.max(RELATIVE_ACCURACY * size))
}

impl Path {
    pub(super) fn from_segments(segments: Vec<PathSeg>) -> Self {
        let mut at = vec![0.0];
        let mut sum = 0.0;
        for segment in &segments {
            sum += arc_length(segment);
            at.push(sum);
        }
        Self { segments, at }
    }

    /// The straight line from `a` to `b`.
    pub fn line(a: Vec2, b: Vec2) -> Self {
        Self::from_segments(vec![PathSeg::Line(kurbo::Line::new(point(a), point(b)))])
    }

    /// The polyline through `points` (two or more).
    pub fn polyline(points: &[Vec2]) -> Self {
        Self::from_segments(
            points.windows(2).map(|w| PathSeg::Line(kurbo::Line::new(point(w[0]), point(w[1])))).collect(),
        )
    }

    /// Curves end to end (one or more). Those with their handles at their ends are straight lines.
    pub fn cubics(curves: &[Cubic]) -> Self {
        let segment = |&[a, b, c, d]: &Cubic| {
            if a == b && c == d {
                return PathSeg::Line(kurbo::Line::new(point(a), point(d)));
            }
            PathSeg::Cubic(kurbo::CubicBez::new(point(a), point(b), point(c), point(d)))
        };
        Self::from_segments(curves.iter().map(segment).collect())
    }

    /// Total arc length, metres, exact to a nanometre per segment.
    pub fn length(&self) -> f64 {
        self.at[self.segments.len()]
    }

    /// First point.
    pub fn start(&self) -> Vec2 {
        vector(self.segments[0].start())
    }

    /// Last point.
    pub fn end(&self) -> Vec2 {
        vector(self.segments[self.segments.len() - 1].end())
    }

    fn locate(&self, s: f64) -> (usize, f64) {
        let last = self.segments.len() - 1;
        let i = self.at[1..=last].partition_point(|&a| a <= s);
        let local = (s - self.at[i]).clamp(0.0, self.at[i + 1] - self.at[i]);
        (i, self.segments[i].inv_arclen(local, LENGTH_ACCURACY))
    }

    /// The point at arc length `s` (clamped to the path).
    pub fn point(&self, s: f64) -> Vec2 {
        if s <= 0.0 {
            return self.start();
        }
        if s >= self.length() {
            return self.end();
        }
        let (i, t) = self.locate(s);
        vector(self.segments[i].eval(t))
    }

    /// The unit tangent at arc length `s` (clamped), pointing along the path.
    pub fn tangent(&self, s: f64) -> Vec2 {
        let (i, t) = self.locate(s.clamp(0.0, self.length()));
        self.direction(i, t)
    }

    /// The unit tangent of a segment at its parameter `t`.
    fn direction(&self, i: usize, t: f64) -> Vec2 {
        let derivative = |t: f64| -> KVec {
            match self.segments[i] {
                PathSeg::Line(l) => l.p1 - l.p0,
                PathSeg::Quad(q) => q.deriv().eval(t).to_vec2(),
                PathSeg::Cubic(c) => c.deriv().eval(t).to_vec2(),
            }
        };
        // A control point on an end point gives a zero derivative there: look a little inside.
        for t in [t, t.clamp(1e-6, 1.0 - 1e-6), t.clamp(1e-3, 1.0 - 1e-3)] {
            let d = derivative(t);
            if d.hypot() > 1e-12 {
                return Vec2::new(d.x, d.y).normalize();
            }
        }
        (self.end() - self.start()).normalize()
    }

    /// Stations along every segment, its ends included, metres. The chords between them leave the path by at most
    /// `tolerance`. So do the chords between the points `reach` to the left or right of them, from the curves that run
    /// beside the path.
    pub fn stations(&self, reach: f64, tolerance: f64) -> Vec<Vec<Station>> {
        (0..self.segments.len()).map(|i| self.segment_stations(i, reach, tolerance)).collect()
    }

    fn segment_stations(&self, i: usize, reach: f64, tolerance: f64) -> Vec<Station> {
        let station = |t: f64| Station { at: vector(self.segments[i].eval(t)), tangent: self.direction(i, t) };
        let beside = |s: &Station, d: f64| s.at + d * Vec2::new(-s.tangent.y, s.tangent.x);
        // How far the point `s` between `a` and `b` is from their chord, on the path and to both sides of it.
        let off = |a: &Station, s: &Station, b: &Station| {
            let from_chord = |d: f64| {
                let (p, q, x) = (beside(a, d), beside(b, d), beside(s, d));
                (q - p).try_normalize(1e-12).map_or((x - p).norm(), |u| u.perp(&(x - p)).abs())
            };
            [0.0, reach, -reach].map(from_chord).into_iter().fold(0.0, f64::max)
        };
        let mut found = vec![station(0.0)];
        // Open spans of the parameter, the first one last.
        let mut open = vec![(0.0, 1.0, 0)];
        if matches!(self.segments[i], PathSeg::Line(_)) {
            open = vec![(0.0, 1.0, MOST_HALVINGS)];
        }
        while let Some((from, to, halvings)) = open.pop() {
            let (a, b) = (station(from), station(to));
            let at = |share: f64| station(from + (to - from) * share);
            let straight = || [0.25, 0.5, 0.75].iter().all(|&share| off(&a, &at(share), &b) <= tolerance);
            if halvings == MOST_HALVINGS || straight() {
                found.push(b);
            } else {
                let middle = 0.5 * (from + to);
                open.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
            }
        }
        found
    }

    /// The path as cubic Bézier curves: start, two control points and end each. Lines are `None` in between.
    pub fn beziers(&self) -> impl Iterator<Item = (Vec2, Option<[Vec2; 2]>, Vec2)> + '_ {
        self.segments.iter().map(|segment| {
            let controls = match segment {
                PathSeg::Line(_) => None,
                PathSeg::Quad(q) => Some(q.raise()),
                PathSeg::Cubic(c) => Some(*c),
            };
            (vector(segment.start()), controls.map(|c| [vector(c.p1), vector(c.p2)]), vector(segment.end()))
        })
    }

    /// Arc length of the point nearest to `p` (the first of several), and its distance from `p`.
    pub fn nearest(&self, p: Vec2) -> (f64, f64) {
        let mut best = (0.0, f64::INFINITY);
        for (segment, &start) in self.segments.iter().zip(&self.at) {
            let near = segment.nearest(point(p), NEAREST_ACCURACY);
            let distance = near.distance_sq.sqrt();
            if distance < best.1 {
                best = (start + segment.subsegment(0.0..near.t).arclen(LENGTH_ACCURACY), distance);
            }
        }
        best
    }

    /// The part from arc length `from` to `to` (`from < to`, both clamped). An end within a nanometre of a
    /// joint between segments is moved to the joint, because a shorter segment has no direction.
    pub fn part(&self, from: f64, to: f64) -> Self {
        let joint = |s: f64| self.at.iter().copied().find(|at| (at - s).abs() <= LENGTH_ACCURACY).unwrap_or(s);
        let (from, to) = (joint(from.clamp(0.0, self.length())), joint(to.clamp(0.0, self.length())));
        let (first, t0) = self.locate(from);
        let (last, t1) = self.locate(to);
        let mut segments = Vec::new();
        for i in first..=last {
            let a = if i == first { t0 } else { 0.0 };
            let b = if i == last { t1 } else { 1.0 };
            if b > a {
                segments.push(self.segments[i].subsegment(a..b));
            }
        }
        if segments.is_empty() {
            segments.push(PathSeg::Line(kurbo::Line::new(point(self.point(from)), point(self.point(to)))));
        }
        Self::from_segments(segments)
    }

    /// This path, walked from its end.
    pub fn reversed(&self) -> Self {
        Self::from_segments(self.segments.iter().rev().map(PathSeg::reverse).collect())
    }

    /// Every point moved by `p ↦ linear · p + shift`.
    pub fn mapped(&self, linear: nalgebra::Matrix2<f64>, shift: Vec2) -> Self {
        let affine = kurbo::Affine::new([linear.m11, linear.m21, linear.m12, linear.m22, shift.x, shift.y]);
        Self::from_segments(self.segments.iter().map(|s| affine * *s).collect())
    }

    /// This path and then `next`, which starts where this one ends.
    pub fn joined(&self, next: &Self) -> Self {
        Self::from_segments(self.segments.iter().chain(&next.segments).copied().collect())
    }

    /// Whether it is one straight line.
    pub fn is_straight(&self) -> bool {
        (self.end() - self.start()).norm() > self.length() - 1e-7
    }

    /// Arc lengths of the joints between its segments, both ends included.
    pub fn joints(&self) -> &[f64] {
        &self.at
    }

    /// Points along the path whose chords leave it by at most `tolerance` (metres), ends included.
    pub fn sampled(&self, tolerance: f64) -> Vec<Vec2> {
        let mut points = Vec::new();
        let bez = BezPath::from_path_segments(self.segments.iter().copied());
        kurbo::flatten(bez.iter(), tolerance, |el| {
            if let kurbo::PathEl::MoveTo(p) | kurbo::PathEl::LineTo(p) = el {
                points.push(vector(p));
            }
        });
        // Where segments meet, the point comes twice.
        points.dedup_by(|b, a| (*b - *a).norm() < LENGTH_ACCURACY);
        points
    }

    /// Twice the signed area between the path and the origin (Green's theorem on the curve itself): the sum over a
    /// closed outline's edges is twice its area, positive when it runs clockwise on screen (y down).
    pub fn double_area(&self) -> f64 {
        2.0 * BezPath::from_path_segments(self.segments.iter().copied()).area()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn parts_and_reversal_keep_length() {
        let p = Path::parse(Vec2::zeros(), "C 0 50, 50 100, 100 100 L 200 100", 1e-3).expect("path");
        let l = p.length();
        let q = p.part(0.02, 0.15);
        assert_relative_eq!(q.length(), 0.13, epsilon = 1e-8);
        assert_relative_eq!(q.start(), p.point(0.02), epsilon = 1e-9);
        assert_relative_eq!(p.reversed().point(0.03), p.point(l - 0.03), epsilon = 1e-8);
    }

    #[test]
    fn a_part_that_ends_beside_a_joint_ends_in_it() {
        let p = Path::parse(Vec2::zeros(), "A 70 70 0 0 1 140 0 A 70 70 0 0 1 0 0", 1e-3).expect("path");
        let count = p.beziers().count();
        for aside in [0.0, 4e-10, -4e-10] {
            let middle = p.length() / 2.0 + aside;
            let (one, other) = (p.part(0.0, middle), p.part(middle, p.length()));
            assert_eq!((one.beziers().count(), other.beziers().count()), (count / 2, count / 2), "{aside}");
            assert_eq!(one.end(), other.start());
        }
    }

    #[test]
    fn the_nearest_point_is_found_on_any_segment() {
        let p = Path::parse(Vec2::zeros(), "L 100 0 C 150 0, 200 50, 200 100", 1e-3).expect("path");
        for s in [0.03, 0.1, 0.17] {
            let normal = Vec2::new(-p.tangent(s).y, p.tangent(s).x);
            let (at, distance) = p.nearest(p.point(s) + 0.005 * normal);
            assert_relative_eq!(at, s, epsilon = 1e-6);
            assert_relative_eq!(distance, 0.005, epsilon = 1e-6);
        }
    }

    #[test]
    fn the_area_of_a_closed_outline_is_the_sum_over_its_edges() {
        let c = [Vec2::new(1.0, 1.0), Vec2::new(3.0, 1.0), Vec2::new(3.0, 2.0), Vec2::new(1.0, 2.0)];
        let sum: f64 = (0..4).map(|i| Path::line(c[i], c[(i + 1) % 4]).double_area()).sum();
        assert_relative_eq!(sum / 2.0, 2.0, epsilon = 1e-12);
    }
}
