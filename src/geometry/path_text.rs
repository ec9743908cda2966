//! Paths as texts: SVG path commands in and out, and SVG transforms.

use kurbo::{BezPath, ParamCurve, PathSeg, Point, Vec2 as KVec};

use super::Vec2;
use super::curve::{LENGTH_ACCURACY, Path, RELATIVE_ACCURACY, arc_length};

/// Why a path could not be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PathError {
    /// A letter that is no path command, or a command without its numbers.
    #[error("cannot read the path '{0}': expected commands L C Q A (or M Z) with numbers")]
    Syntax(String),
    /// A coordinate is infinite or not a number.
    #[error("the path '{0}' holds a number that is not finite")]
    NotFinite(String),
    /// A path with no length.
    #[error("the path '{0}' has no length")]
    Empty(String),
}

/// Largest distance of an arc from the cubics that replace it, in file units (a nanometre in millimetres).
const ARC_ACCURACY: f64 = 1e-6;

/// An SVG path, of one connected run or (`many`) of several. `None` when the text is no such path. (kurbo's and
/// svgtypes' own conversions of arcs are off by up to 0.1 units; this one is not.)
fn bezier_path(text: &str, many: bool) -> Option<BezPath> {
    let mut pen = Pen::default();
    for command in svgtypes::PathParser::from(text) {
        let command = command.ok()?;
        if matches!(command, svgtypes::PathSegment::MoveTo { .. }) && !many && !pen.bez.elements().is_empty() {
            return None;
        }
        pen.draw(command);
    }
    Some(pen.bez)
}

/// The part of a path that has been drawn, and the state that the next command needs.
#[derive(Default)]
struct Pen {
    bez: BezPath,
    at: Point,
    /// Where the run began.
    first: Point,
    /// The last control point, if the last command was a cubic or a quadratic: the smooth commands mirror it.
    cubic: Option<Point>,
    quad: Option<Point>,
}

impl Pen {
    fn draw(&mut self, command: svgtypes::PathSegment) {
        use svgtypes::PathSegment as S;
        let at = self.at;
        let p = |abs: bool, x: f64, y: f64| if abs { Point::new(x, y) } else { at + KVec::new(x, y) };
        let mirrored = |control: Option<Point>| control.map_or(at, |c| at + (at - c));
        let (cubic, quad) = (self.cubic.take(), self.quad.take());
        match command {
            S::MoveTo { abs, x, y } => self.move_to(p(abs, x, y)),
            S::LineTo { abs, x, y } => self.line_to(p(abs, x, y)),
            S::HorizontalLineTo { abs, x } => self.line_to(Point::new(p(abs, x, 0.0).x, at.y)),
            S::VerticalLineTo { abs, y } => self.line_to(Point::new(at.x, p(abs, 0.0, y).y)),
            S::CurveTo { abs, x1, y1, x2, y2, x, y } => self.curve_to(p(abs, x1, y1), p(abs, x2, y2), p(abs, x, y)),
            S::SmoothCurveTo { abs, x2, y2, x, y } => self.curve_to(mirrored(cubic), p(abs, x2, y2), p(abs, x, y)),
            S::Quadratic { abs, x1, y1, x, y } => self.quad_to(p(abs, x1, y1), p(abs, x, y)),
            S::SmoothQuadratic { abs, x, y } => self.quad_to(mirrored(quad), p(abs, x, y)),
            S::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                let (radii, x_rotation) = (KVec::new(rx, ry), x_axis_rotation.to_radians());
                self.arc_to(kurbo::SvgArc { from: at, to: p(abs, x, y), radii, x_rotation, large_arc, sweep });
            }
            S::ClosePath { .. } => {
                self.bez.close_path();
                self.at = self.first;
            }
        }
    }

    fn move_to(&mut self, to: Point) {
        self.bez.move_to(to);
        (self.at, self.first) = (to, to);
    }

    fn line_to(&mut self, to: Point) {
        self.bez.line_to(to);
        self.at = to;
    }

    fn curve_to(&mut self, c1: Point, c2: Point, to: Point) {
        self.bez.curve_to(c1, c2, to);
        (self.at, self.cubic) = (to, Some(c2));
    }

    fn quad_to(&mut self, c: Point, to: Point) {
        self.bez.quad_to(c, to);
        (self.at, self.quad) = (to, Some(c));
    }

    /// An arc, or the line that stands for one without radii.
    fn arc_to(&mut self, arc: kurbo::SvgArc) {
        match kurbo::Arc::from_svg_arc(&arc) {
            // If the chord is below rounding beside the radii, the arc is its chord.
            Some(curved) if curved.sweep_angle.abs() > 0.0 => {
                let accuracy = ARC_ACCURACY.max(RELATIVE_ACCURACY * curved.radii.x.max(curved.radii.y));
                curved.to_cubic_beziers(accuracy, |a, b, c| self.bez.curve_to(a, b, c));
                // Its computed end is a rounding of the radius beside the one it was given, where the next edge begins.
                if let Some(kurbo::PathEl::CurveTo(_, _, end)) = self.bez.elements_mut().last_mut() {
                    *end = arc.to;
                }
            }
            _ => self.bez.line_to(arc.to),
        }
        self.at = arc.to;
    }
}

impl Path {
    /// Reads SVG path commands (absolute or relative, without the leading `M`) that go on from `start`. The numbers
    /// and `start` are multiplied by `unit` (metres per file unit).
    ///
    /// # Errors
    /// [`PathError`] when the text is no path, holds a number that is not finite, or has no length.
    pub fn parse(start: Vec2, commands: &str, unit: f64) -> Result<Self, PathError> {
        let text = format!("M {} {} {commands}", start.x, start.y);
        Self::parse_absolute(&text, unit)
    }

    /// Reads a whole SVG path that begins with its own `M`. Numbers are multiplied by `unit`.
    ///
    /// # Errors
    /// As [`Path::parse`].
    pub fn parse_absolute(text: &str, unit: f64) -> Result<Self, PathError> {
        let bez = bezier_path(text, false).ok_or_else(|| PathError::Syntax(text.to_owned()))?;
        let bez = kurbo::Affine::scale(unit) * bez;
        if !bez.is_finite() {
            return Err(PathError::NotFinite(text.to_owned()));
        }
        let segments: Vec<_> = bez.segments().filter(|s| arc_length(s) > LENGTH_ACCURACY).collect();
        if segments.is_empty() {
            return Err(PathError::Empty(text.to_owned()));
        }
        Ok(Self::from_segments(segments))
    }

    /// Reads every connected run of an SVG path, without scaling. Runs without length are left out. Commands that
    /// follow a `Z` without an `M` continue from the start of the closed run.
    ///
    /// # Errors
    /// [`PathError`] when the text is no path or holds a number that is not finite.
    pub fn parse_many(text: &str) -> Result<Vec<Self>, PathError> {
        let bez = bezier_path(text, true).ok_or_else(|| PathError::Syntax(text.to_owned()))?;
        if !bez.is_finite() {
            return Err(PathError::NotFinite(text.to_owned()));
        }
        let mut runs: Vec<Vec<PathSeg>> = Vec::new();
        let mut end: Option<Point> = None;
        // Parts too short to count may lie between two segments of a run.
        let near = |a: Point, b: Point| a.distance(b) <= LENGTH_ACCURACY;
        for segment in bez.segments().filter(|s| arc_length(s) > LENGTH_ACCURACY) {
            match runs.last_mut() {
                Some(run) if end.is_some_and(|end| near(end, segment.start())) => run.push(segment),
                _ => runs.push(vec![segment]),
            }
            end = Some(segment.end());
        }
        Ok(runs.into_iter().map(Self::from_segments).collect())
    }

    /// SVG commands for the path, numbers multiplied by `scale`, with a leading `M` if `with_move`.
    pub fn to_svg(&self, scale: f64, with_move: bool) -> String {
        use std::fmt::Write as _;
        let n = |p: Point| format!("{} {}", round(p.x * scale), round(p.y * scale));
        let mut out = String::new();
        if with_move {
            let _ = write!(out, "M {} ", n(self.segments[0].start()));
        }
        for segment in &self.segments {
            let _ = match segment {
                PathSeg::Line(l) => write!(out, "L {} ", n(l.p1)),
                PathSeg::Quad(q) => write!(out, "Q {}, {} ", n(q.p1), n(q.p2)),
                PathSeg::Cubic(c) => write!(out, "C {}, {}, {} ", n(c.p1), n(c.p2), n(c.p3)),
            };
        }
        out.trim_end().to_owned()
    }
}

/// Reads an SVG `transform`: the linear part and the shift. `None` when the text is none or holds a number that is not
/// finite.
pub fn parse_transform(text: &str) -> Option<(nalgebra::Matrix2<f64>, Vec2)> {
    let t: svgtypes::Transform = text.parse().ok()?;
    let numbers = [t.a, t.b, t.c, t.d, t.e, t.f];
    numbers.iter().all(|x| x.is_finite()).then(|| (nalgebra::Matrix2::new(t.a, t.c, t.b, t.d), Vec2::new(t.e, t.f)))
}

/// Six decimals, no negative zero, no trailing zeros.
fn round(x: f64) -> f64 {
    let r = (x * 1e6).round() / 1e6;
    if r == 0.0 { 0.0 } else { r }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn a_quarter_circle_arc_is_measured() {
        let p = Path::parse(Vec2::new(100.0, 0.0), "A 100 100 0 0 1 0 100", 1e-3).expect("path");
        assert_relative_eq!(p.length(), std::f64::consts::PI * 0.05, epsilon = 1e-5);
        assert_relative_eq!(p.point(p.length() / 2.0).norm(), 0.1, epsilon = 1e-5);
    }

    #[test]
    fn an_arc_of_a_radius_that_nothing_has_costs_no_more_than_any() {
        let p = Path::parse(Vec2::zeros(), "A 1e60 1e60 0 0 1 2e60 0", 1.0).expect("path");
        assert!(p.joints().len() < 200, "{}", p.joints().len());
        // Beside its radius this chord is nothing: a line, and the curve before it ends where it did.
        let p = Path::parse(Vec2::zeros(), "C 0 1, 1 2, 2 2 A 1e40 1e40 0 0 1 5 6", 1.0).expect("path");
        assert_eq!((p.joints().len(), p.end()), (3, Vec2::new(5.0, 6.0)));
        assert_relative_eq!(p.part(p.length() - 5.0, p.length()).start(), Vec2::new(2.0, 2.0), epsilon = 1e-6);
    }

    #[test]
    fn a_line_too_short_to_count_does_not_end_a_run() {
        let runs = Path::parse_many("M 0 0 L 100 0 l 1e-12 0 L 100 50 M 200 0 l 10 0").expect("paths");
        assert_eq!(runs.iter().map(Path::length).collect::<Vec<_>>(), [150.0, 10.0]);
    }

    #[test]
    fn an_arc_ends_where_it_was_told_to() {
        for radius in [12.5, 33.3, 70.0] {
            let across = 2.0 * radius;
            let arcs = format!("A {radius} {radius} 0 0 1 {across} 70 A {radius} {radius} 0 0 1 0 70");
            let p = Path::parse(Vec2::new(0.0, 70.0), &arcs, 1.0).expect("path");
            let ends: Vec<Vec2> = p.beziers().map(|(_, _, end)| end).collect();
            assert!(ends.contains(&Vec2::new(across, 70.0)) && p.end() == p.start(), "{ends:?}");
        }
    }
}
