//! A block in another size: its points move by their grade rules, and what lies between two of them along a line by
//! what lies between.

use nalgebra::Matrix2;

use super::dxf_block::Block;
use super::dxf_rules::RuleTable;
use super::dxf_write::layer;
use crate::geometry::{Path, Shift, Vec2};

/// The text of a rule stands at its point, but for rounding (metres).
const AT: f64 = 1e-4;
/// More graded points than this are no piece, and every one is looked for on every line.
pub(super) const MOST_GRADED: usize = 2_000;
/// Layer of the grade reference line.
const REFERENCE: u32 = 5;
/// A corner of a sewing line that is so much farther from a point of the boundary than the line itself is beside it.
const CORNER: f64 = 1.5;
/// A notch or drill hole without a rule that is no farther from the boundary (metres) moves with it.
const NEAR: f64 = 2e-3;

/// A point of the drawing and its way to the other size, metres, y down.
struct Graded {
    at: Vec2,
    by: Vec2,
}

/// The graded points, sorted from left to right.
struct GradedPoints(Vec<Graded>);

impl GradedPoints {
    /// The way of the point that is here.
    fn way(&self, here: Vec2) -> Option<Vec2> {
        let first = self.0.partition_point(|g| g.at.x < here.x - AT);
        let near = self.0[first..].iter().take_while(|g| g.at.x <= here.x + AT);
        near.filter(|g| (g.at - here).norm() <= AT).map(|g| g.by).next()
    }
}

/// The ways of the points of a line, at arc lengths that rise.
struct Along {
    knots: Vec<(f64, Vec2)>,
}

impl Along {
    /// The ways of a line's own graded points.
    fn of(path: &Path, points: &GradedPoints) -> Option<Self> {
        let at = path.beziers().map(|b| b.0).chain([path.end()]);
        let own = path.joints().iter().zip(at).filter_map(|(s, p)| Some((*s, points.way(p)?)));
        Self::through(path, own.collect())
    }

    /// The ways of a line that runs along others: each of their graded points moves the point beside it.
    fn beside(path: &Path, others: &[(Path, Self)]) -> Option<Self> {
        let corners: Vec<(f64, Vec2)> =
            path.joints().iter().copied().zip(path.beziers().map(|b| b.0).chain([path.end()])).collect();
        let mut own: Vec<(f64, Vec2)> = Vec::new();
        for (other, along) in others {
            for (s, way) in along.inner() {
                let p = other.point(s);
                let foot = path.nearest(p);
                let far = |corner: &(f64, Vec2)| (corner.1 - p).norm();
                let corner = corners.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
                let at_corner = far(corner) <= CORNER * foot.1;
                own.push((if at_corner { corner.0 } else { foot.0 }, way));
            }
        }
        own.sort_by(|a, b| a.0.total_cmp(&b.0));
        own.dedup_by(|b, a| b.0 - a.0 <= AT);
        Self::through(path, own)
    }

    /// Ways at arc lengths that rise, carried on round a closed line and beyond the ends of an open one.
    fn through(path: &Path, own: Vec<(f64, Vec2)>) -> Option<Self> {
        let (first, last) = (*own.first()?, *own.last()?);
        let length = path.length();
        let (before, after) = if (path.start() - path.end()).norm() < AT {
            ((last.0 - length, last.1), (first.0 + length, first.1))
        } else {
            ((f64::NEG_INFINITY, first.1), (f64::INFINITY, last.1))
        };
        Some(Self { knots: [vec![before], own, vec![after]].concat() })
    }

    /// The knots on the line itself.
    fn inner(&self) -> impl Iterator<Item = (f64, Vec2)> + '_ {
        self.knots[1..self.knots.len() - 1].iter().copied()
    }

    /// The shift at an arc length that lies in the stretch before the knot of this number.
    fn shift(&self, s: f64, knot: usize) -> Shift {
        let ((from, a), (to, b)) = (self.knots[knot - 1], self.knots[knot]);
        let span = to - from;
        if !span.is_finite() || span <= 0.0 {
            return Shift { by: if from.is_finite() { a } else { b }, slope: Vec2::zeros() };
        }
        let slope = (b - a) / span;
        Shift { by: a + slope * (s - from), slope }
    }

    /// The number of the knot at the end of the stretch in which an arc length lies.
    fn stretch(&self, s: f64) -> usize {
        self.knots.partition_point(|knot| knot.0 <= s).clamp(1, self.knots.len() - 1)
    }

    fn way(&self, s: f64) -> Vec2 {
        self.shift(s, self.stretch(s)).by
    }

    /// The line in the other size.
    fn moved(&self, path: &Path) -> Path {
        let length = path.length();
        let inner = self.inner().map(|knot| knot.0).filter(|s| *s > 0.0 && *s < length);
        let mut cuts: Vec<f64> = [0.0].into_iter().chain(inner).chain([length]).collect();
        cuts.dedup();
        let part = |w: &[f64]| {
            let knot = self.stretch(0.5 * (w[0] + w[1]));
            path.part(w[0], w[1]).shifted(&[], &[], |s| self.shift(w[0] + s, knot)).0
        };
        in_one(cuts.windows(2).map(part).collect()).unwrap_or_else(|| path.clone())
    }
}

/// Lines that follow each other as one. Neighbours are joined first, for each joining copies all that is joined.
fn in_one(mut parts: Vec<Path>) -> Option<Path> {
    while parts.len() > 1 {
        parts = parts.chunks(2).map(|two| two[1..].iter().fold(two[0].clone(), |a, b| a.joined(b))).collect();
    }
    parts.pop()
}

/// A block in another size, and what is to be said of it.
pub(super) struct InSize<'a> {
    pub(super) block: Block<'a>,
    /// Whether a point of it has a rule.
    pub(super) graded: bool,
    /// Rules that its points name and the table has not.
    pub(super) missing: Vec<u32>,
}

impl<'a> Block<'a> {
    /// The number of its texts that name a grade rule.
    pub(super) fn rules(&self) -> usize {
        self.texts.iter().filter(|text| rule_of(&text.words).is_some()).count()
    }

    /// The block in the size `to` of the table, drawn in the size `from`; `linear` is how it is inserted.
    pub(super) fn in_size(mut self, table: &RuleTable, [from, to]: [usize; 2], linear: Matrix2<f64>) -> InSize<'a> {
        let [axis, left] = self.reference(linear);
        let (mut points, mut missing) = (Vec::new(), Vec::new());
        for text in &self.texts {
            let Some((rule, at)) = rule_of(&text.words).zip(text.at) else { continue };
            match table.way(rule, from, to) {
                Some(way) => points.push(Graded { at, by: axis * way.x + left * way.y }),
                None => missing.push(rule),
            }
        }
        points.sort_by(|a, b| a.at.x.total_cmp(&b.at.x));
        missing.sort_unstable();
        missing.dedup();
        let points = GradedPoints(points);
        let graded = !points.0.is_empty();
        if graded {
            self.moved(&points);
        }
        InSize { block: self, graded, missing }
    }

    /// The directions that rules count along, as they are inserted: that of the grade reference line to the right, or
    /// of the x axis without one, and that to its left.
    fn reference(&self, linear: Matrix2<f64>) -> [Vec2; 2] {
        let back = linear.try_inverse().unwrap_or_else(Matrix2::identity);
        let along = self.ends_on(REFERENCE).and_then(|[a, b]| (back * (b - a)).try_normalize(AT));
        let along = along.unwrap_or_else(Vec2::x);
        let along = if along.x < 0.0 || (along.x == 0.0 && along.y > 0.0) { -along } else { along };
        [along, Vec2::new(along.y, -along.x)].map(|way| (linear * way).normalize())
    }

    fn moved(&mut self, points: &GradedPoints) {
        let rims = self.lines.iter().filter(|line| line.0 == layer::BOUNDARY);
        let rims: Vec<(Path, Along)> = rims.filter_map(|l| Some((l.1.clone(), Along::of(&l.1, points)?))).collect();
        let on_rim = |p: Vec2| {
            let near = rims.iter().map(|(rim, along)| (rim.nearest(p), along));
            let near = near.min_by(|a, b| a.0.1.total_cmp(&b.0.1))?;
            (near.0.1 <= NEAR).then(|| near.1.way(near.0.0))
        };
        for (on, path) in &mut self.lines {
            // A sewing line without rules of its own follows the boundary.
            let followed = || if *on == layer::SEW { Along::beside(path, &rims) } else { None };
            if let Some(along) = Along::of(path, points).or_else(followed) {
                *path = along.moved(path);
            }
        }
        let way = |p: Vec2| points.way(p).or_else(|| on_rim(p)).unwrap_or_else(Vec2::zeros);
        self.points.iter_mut().for_each(|point| point.at += way(point.at));
        self.slits.iter_mut().for_each(|at| *at += way(*at));
    }
}

/// The rule that a text names: `# 12`.
pub(super) fn rule_of(words: &str) -> Option<u32> {
    words.trim().strip_prefix('#')?.trim().parse().ok()
}
