//! Pieces made longer or shorter across a line.

use super::sheet::AlteredPiece;
use super::{Fault, name};
use crate::geometry::{Path, Vec2};
use crate::pattern::{GarmentFile, Located, Problem, Quantity};

/// The stretch that is made longer, unless another is named, metres.
const USUAL: f64 = 0.1;
/// At least so many times the change, so that slanted edges change their slope little.
const TIMES: f64 = 4.0;
/// Cuts nearer to each other than this are one, metres.
const SAME: f64 = 1e-9;

/// A piece that is made longer or shorter, and by how much.
pub(super) struct LengthenedPiece<'f> {
    pub(super) at: &'f Located<Quantity>,
    pub(super) by: &'f Located<Quantity>,
    /// −1 to shorten.
    pub(super) sign: f64,
    pub(super) over: Option<&'f Located<Quantity>>,
    pub(super) across: bool,
}

/// The plane as it is stretched: nothing before `from`, evenly up to `to`, shifted beyond.
struct PlaneStretch {
    axis: Vec2,
    from: f64,
    to: f64,
    by: f64,
}

impl LengthenedPiece<'_> {
    /// Carries it out on a piece.
    pub(super) fn apply(&self, file: &mut GarmentFile, piece: &Located<String>) -> Result<(), Fault> {
        let index = name::piece(file, piece)?;
        let mut sheet = AlteredPiece::read(file, index)?;
        let stretch = self.stretch(&sheet)?;
        for edge in 0..sheet.edges.len() {
            stretch_edge(&mut sheet, edge, &stretch);
        }
        sheet.points.iter_mut().for_each(|p| *p = stretch.point(*p));
        sheet.runs.iter_mut().for_each(|run| *run = stretch.path(run, &[]).0);
        sheet.write(file, index)
    }

    fn stretch(&self, sheet: &AlteredPiece) -> Result<PlaneStretch, Fault> {
        let axis = if self.across { Vec2::x() } else { Vec2::y() };
        let (from, by) = (self.at.value.value(sheet.unit), self.by.value.value(sheet.unit));
        let along = sheet.edges.iter().flat_map(|e| e.sampled(1e-5)).map(|p| axis.dot(&p));
        let [low, high] = along.fold([f64::MAX, f64::MIN], |[low, high], c| [low.min(c), high.max(c)]);
        let word = if self.across { "x" } else { "y" };
        if !(low <= from && from < high) {
            let what = format!("the line across '{}'", sheet.piece);
            let expected = format!("between {word} = {:.1} and {:.1} mm of its drawing", low * 1e3, high * 1e3);
            return Err((self.at.at, Problem::AlterAmount { what, expected, found: from * 1e3 }));
        }
        let usual = USUAL.max(TIMES * by).min(high - from);
        let over = self.over.map_or(usual, |o| o.value.value(sheet.unit));
        let spot = self.over.map_or(self.by.at, |o| o.at);
        if over > high - from + SAME {
            let what = format!("the stretch of '{}' that changes", sheet.piece);
            let expected = format!("at most {:.1} mm, where the piece ends", (high - from) * 1e3);
            return Err((spot, Problem::AlterAmount { what, expected, found: over * 1e3 }));
        }
        if self.sign < 0.0 && by >= over {
            let what = format!("what is taken out of '{}'", sheet.piece);
            let expected = format!("less than the {:.1} mm it is taken from", over * 1e3);
            return Err((self.by.at, Problem::AlterAmount { what, expected, found: by * 1e3 }));
        }
        Ok(PlaneStretch { axis, from, to: from + over, by: self.sign * by })
    }
}

impl PlaneStretch {
    fn point(&self, p: Vec2) -> Vec2 {
        let c = self.axis.dot(&p);
        let share = ((c - self.from) / (self.to - self.from)).clamp(0.0, 1.0);
        p + self.axis * (self.by * share)
    }

    /// A path, and the places on it of those that were at `marks`.
    fn path(&self, path: &Path, marks: &[f64]) -> (Path, Vec<f64>) {
        let mut cuts = vec![0.0, path.length()];
        cuts.extend(path.crossings(self.axis, self.from));
        cuts.extend(path.crossings(self.axis, self.to));
        cuts.extend(marks);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|b, a| (*b - *a).abs() < SAME);
        let parts: Vec<Path> = cuts.windows(2).map(|w| self.part(&path.part(w[0], w[1]))).collect();
        let mut ends = vec![0.0];
        parts.iter().for_each(|part| ends.push(ends[ends.len() - 1] + part.length()));
        let place = |s: &f64| ends[cuts.partition_point(|c| *c < s - SAME).min(ends.len() - 1)];
        let moved = marks.iter().map(place).collect();
        let whole = parts.into_iter().reduce(|a, b| a.joined(&b)).unwrap_or_else(|| path.clone());
        let straight = path.is_straight() && whole.is_straight();
        (if straight { Path::line(whole.start(), whole.end()) } else { whole }, moved)
    }

    /// A part that lies on one side of either line.
    fn part(&self, part: &Path) -> Path {
        let c = self.axis.dot(&part.point(part.length() / 2.0));
        let factor = self.by / (self.to - self.from);
        if c < self.from {
            return part.clone();
        }
        if c >= self.to {
            return part.mapped(nalgebra::Matrix2::identity(), self.axis * self.by);
        }
        let linear = nalgebra::Matrix2::identity() + self.axis * self.axis.transpose() * factor;
        part.mapped(linear, -self.axis * (factor * self.from))
    }
}

fn stretch_edge(sheet: &mut AlteredPiece, edge: usize, stretch: &PlaneStretch) {
    let path = &sheet.edges[edge];
    let high = path.sampled(1e-5).iter().map(|p| stretch.axis.dot(p)).fold(f64::MIN, f64::max);
    if high <= stretch.from {
        return;
    }
    let marks = sheet.marks_on(edge);
    let (path, moved) = stretch.path(path, &marks);
    for mark in sheet.marks.iter_mut().flatten().filter(|m| m.edge == edge) {
        if let Some(i) = marks.iter().position(|m| *m == mark.at) {
            mark.at = moved[i];
        }
    }
    sheet.edges[edge] = path;
}
