//! Paths cut and bent exactly: the result is made of Bézier curves again.

use kurbo::common::solve_cubic;
use kurbo::{ParamCurve, ParamCurveArclen, ParamCurveDeriv, PathSeg, Vec2 as KVec};

use super::Vec2;
use super::curve::{LENGTH_ACCURACY, Path};

/// Control points of a cubic this near to its chord, as a share of its length, make it a straight line.
const STRAIGHT: f64 = 1e-12;

/// A shift of the points of a path, and its change per metre of arc length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shift {
    /// The shift.
    pub by: Vec2,
    /// Its slope.
    pub slope: Vec2,
}

impl Path {
    /// Arc lengths at which the path crosses or touches the line of points `p` with `normal · p = offset`. A segment
    /// that lies on the line has none.
    pub fn crossings(&self, normal: Vec2, offset: f64) -> Vec<f64> {
        let mut found = Vec::new();
        for (segment, start) in self.segments.iter().zip(self.joints()) {
            let c = cubic(segment);
            let [a, b, c, d] = [c.p0, c.p1, c.p2, c.p3].map(|p| normal.x * p.x + normal.y * p.y - offset);
            let roots = solve_cubic(a, 3.0 * (b - a), 3.0 * (a - 2.0 * b + c), d - a + 3.0 * (b - c));
            let inside = roots.into_iter().filter(|t| (0.0..=1.0).contains(t));
            found.extend(inside.map(|t| start + segment.subsegment(0.0..t).arclen(LENGTH_ACCURACY)));
        }
        found.sort_by(f64::total_cmp);
        found
    }

    /// The path with every point shifted, and the arc lengths on it of the points that were at `marks`. Each part
    /// between joints and `knots` gets the cubic that has the shift and its slope at both ends, so that the shifts
    /// there are exact and tangents go over into one another.
    pub fn shifted(&self, knots: &[f64], marks: &[f64], shift: impl Fn(f64) -> Shift) -> (Self, Vec<f64>) {
        let mut cuts: Vec<f64> = self.joints().iter().chain(knots).copied().collect();
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|b, a| (*b - *a).abs() <= LENGTH_ACCURACY);
        // Between neighbouring cuts lies one segment.
        let old: Vec<PathSeg> = cuts.windows(2).map(|w| self.part(w[0], w[1]).segments[0]).collect();
        let new = old.iter().zip(cuts.windows(2)).map(|(s, w)| shifted_segment(s, [shift(w[0]), shift(w[1])]));
        let path = Self::from_segments(new.collect());
        let place = |s: &f64| {
            let i = cuts[1..old.len()].partition_point(|c| c <= s);
            let within = (s - cuts[i]).clamp(0.0, old[i].arclen(LENGTH_ACCURACY));
            let t = old[i].inv_arclen(within, LENGTH_ACCURACY);
            path.joints()[i] + path.segments[i].subsegment(0.0..t).arclen(LENGTH_ACCURACY)
        };
        let moved = marks.iter().map(place).collect();
        (path, moved)
    }
}

/// A segment as a cubic with the same parameter. (kurbo's own of a line stands still at both ends.)
fn cubic(segment: &PathSeg) -> kurbo::CubicBez {
    match segment {
        PathSeg::Line(l) => kurbo::CubicBez::new(l.p0, l.p0.lerp(l.p1, 1.0 / 3.0), l.p0.lerp(l.p1, 2.0 / 3.0), l.p1),
        other => other.to_cubic(),
    }
}

fn shifted_segment(segment: &PathSeg, [from, to]: [Shift; 2]) -> PathSeg {
    let mut c = cubic(segment);
    let speed = |t: f64| c.deriv().eval(t).to_vec2().hypot();
    let v = |x: Vec2| KVec::new(x.x, x.y);
    let (first, last) = (from.slope * (speed(0.0) / 3.0), to.slope * (speed(1.0) / 3.0));
    c.p0 += v(from.by);
    c.p1 += v(from.by + first);
    c.p2 += v(to.by - last);
    c.p3 += v(to.by);
    let chord = c.p3 - c.p0;
    let size = chord.hypot2();
    let straight = |p: kurbo::Point| (p - c.p0).cross(chord).abs() <= STRAIGHT * size;
    if matches!(segment, PathSeg::Line(_)) && straight(c.p1) && straight(c.p2) {
        return PathSeg::Line(kurbo::Line::new(c.p0, c.p3));
    }
    PathSeg::Cubic(c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_line_crosses_a_circle_where_it_should() {
        let circle = Path::parse(Vec2::new(100.0, 0.0), "A 100 100 0 0 1 -100 0", 1e-3).expect("path");
        let at = circle.crossings(Vec2::y(), 0.05);
        assert_eq!(at.len(), 2);
        for (s, angle) in at.iter().zip([30.0f64, 150.0]) {
            assert_relative_eq!(*s, 0.1 * angle.to_radians(), epsilon = 1e-8);
        }
    }

    #[test]
    fn a_slanted_line_is_crossed_and_bent_evenly() {
        let line = Path::line(Vec2::zeros(), Vec2::new(0.3, 0.4));
        assert_relative_eq!(line.crossings(Vec2::y(), 0.1)[0], 0.125, epsilon = 1e-9);
        let slope = Vec2::new(0.0, 0.1);
        let (leaning, _) = line.shifted(&[], &[], |s| Shift { by: slope * s, slope });
        assert_eq!(leaning.beziers().count(), 1);
        assert_relative_eq!(leaning.point(leaning.length() / 2.0), Vec2::new(0.15, 0.225), epsilon = 1e-9);
    }

    #[test]
    fn an_even_shift_moves_a_path_as_it_is() {
        let path = Path::parse(Vec2::zeros(), "C 0 50, 50 100, 100 100 L 200 100", 1e-3).expect("path");
        let by = Vec2::new(0.01, -0.02);
        let (moved, at) = path.shifted(&[0.1], &[0.05, 0.2], |_| Shift { by, slope: Vec2::zeros() });
        assert_relative_eq!(moved.length(), path.length(), epsilon = 1e-8);
        assert_relative_eq!(at[0], 0.05, epsilon = 1e-8);
        assert_relative_eq!(moved.point(at[1]), path.point(0.2) + by, epsilon = 1e-8);
    }
}
