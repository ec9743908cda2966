//! Tells marks on a piece of a DXF file from marks beside it, with the notes on the rest.

use std::cell::Cell;

use crate::digitize::{Drawing, InnerLine, bridged, parts_within};
use crate::geometry::{MM, Path, Vec2, box_of, distance_to_segment, encloses, sides_of};

/// Marks so near to the outline (metres) are on the piece.
pub(super) const ON_RIM: f64 = 5e-4;
/// Chords that stand for curves where only inside and outside is asked.
const COARSE: f64 = 1e-4;
/// Square centimetres in a square metre.
const CM2: f64 = 1e4;

/// A line ends on the mirror line to this (metres).
const ON_MIRROR: f64 = 1e-3;

/// An outline of which is asked what lies in it.
pub(super) struct Rim {
    points: Vec<Vec2>,
    bounds: [Vec2; 2],
}

impl Rim {
    pub(super) fn new(outline: &Path) -> Self {
        let points = outline.sampled(COARSE);
        Self { bounds: box_of(points.iter().copied()), points }
    }

    /// How far a point is from what it goes round, metres; nought within.
    pub(super) fn off(&self, p: Vec2) -> f64 {
        if encloses(sides_of(&self.points), p) {
            return 0.0;
        }
        sides_of(&self.points).map(|side| distance_to_segment(p, side)).fold(f64::INFINITY, f64::min)
    }

    /// Whether a point is in it or on it.
    pub(super) fn holds(&self, p: Vec2) -> bool {
        let [low, high] = self.bounds;
        let beyond = (0..2).any(|k| p[k] < low[k] - ON_RIM || p[k] > high[k] + ON_RIM);
        !beyond && self.off(p) <= ON_RIM
    }
}

/// The notes on a piece while it is read.
pub(super) struct Saying<'n> {
    pub(super) name: &'n str,
    /// Whether it has been said that ends were joined.
    pub(super) said: Cell<bool>,
}

impl Saying<'_> {
    /// The runs, joined where they nearly meet.
    pub(super) fn bridged<T: Clone>(&self, runs: Vec<Vec<(T, Path)>>, drawing: &mut Drawing) -> Vec<Vec<(T, Path)>> {
        let bridged = bridged(runs);
        let widest = bridged.gaps.iter().map(|(_, gap)| *gap).fold(0.0, f64::max);
        if widest > 0.0 && !self.said.replace(true) {
            let name = self.name;
            let widest = MM * widest;
            drawing.notes.push(format!(
                "ends of the outline of '{name}' that do not quite meet, up to {widest:.2} mm apart, are joined"
            ));
        }
        bridged.runs
    }

    /// The run with its last side, which a half piece has on its mirror line; `None` of another that is not closed.
    pub(super) fn closed<T>(
        &self,
        run: Vec<(T, Path)>,
        side: T,
        mirror: Option<[Vec2; 2]>,
        what: &str,
        drawing: &mut Drawing,
    ) -> Option<Vec<(T, Path)>> {
        let Some(ends) = closing(&run) else { return Some(run) };
        if mirror.is_some_and(|mirror| ends.iter().all(|p| is_on(*p, mirror))) {
            return Some(closed_by(run, side));
        }
        let gap = (ends[0] - ends[1]).norm();
        let area = closed_by(run, side).iter().map(|(_, path)| path.double_area()).sum::<f64>().abs() / 2.0;
        self.gapes(what, ((ends[0] + ends[1]) / 2.0, gap), area, drawing);
        None
    }

    /// Says that a line is not closed, so that the piece is left out.
    pub(super) fn gapes(&self, what: &str, (at, gap): (Vec2, f64), area: f64, drawing: &mut Drawing) {
        drawing.lost += area;
        drawing.faults.push(format!(
            "the {what} of '{}' is not closed: two of its ends near ({:.1}, {:.1}) mm are {:.2} mm apart; the piece is \
             left out, {:.2} cm² if it were closed there; make its ends meet",
            self.name,
            MM * at.x,
            -MM * at.y,
            MM * gap,
            CM2 * area
        ));
    }

    /// Says that these lines on the layer of boundaries are left out.
    pub(super) fn left_out(&self, lines: &[Path], drawing: &mut Drawing) {
        let is_ring = |line: &&Path| (line.start() - line.end()).norm() < 1e-8;
        let area: f64 = lines.iter().filter(is_ring).map(|line| line.double_area().abs() / 2.0).sum();
        drawing.lost += area;
        if !lines.is_empty() {
            let count = counted(lines.len(), "further line", "further lines");
            let area = CM2 * area;
            let name = self.name;
            drawing.left_out.push(format!(
                "left out: {count} on the layer of boundaries of '{name}', {area:.2} cm²; a piece has one"
            ));
        }
    }

    /// The parts of lines that are on the piece; those that are told lie where toile drew them.
    pub(super) fn clipped(&self, lines: Vec<InnerLine>, rim: &Rim, drawing: &mut Drawing) -> Vec<InnerLine> {
        let (mut kept, mut shortened, mut gone) = (Vec::new(), 0, 0);
        for line in lines {
            if line.kind.is_some() {
                kept.push(line);
                continue;
            }
            let parts = parts_within(&line.path, |p| rim.off(p));
            match parts.as_slice() {
                [] => gone += 1,
                [whole] if *whole == line.path => {}
                _ => shortened += 1,
            }
            kept.extend(parts.into_iter().map(|path| InnerLine { path, ..line.clone() }));
        }
        let name = self.name;
        if shortened > 0 {
            let lines = counted(shortened, "line", "lines");
            drawing.left_out.push(format!("left out: the parts of {lines} of '{name}' that lie beyond its outline"));
        }
        if gone > 0 {
            let lines = counted(gone, "line", "lines");
            drawing.left_out.push(format!("left out: {lines} of '{name}' beyond its outline"));
        }
        kept
    }

    /// The drill holes that are on the piece.
    pub(super) fn on_piece(&self, points: Vec<Vec2>, rim: &Rim, drawing: &mut Drawing) -> Vec<Vec2> {
        let count = points.len();
        let kept: Vec<Vec2> = points.into_iter().filter(|p| rim.holds(*p)).collect();
        if kept.len() < count {
            let holes = counted(count - kept.len(), "drill hole", "drill holes");
            drawing.left_out.push(format!("left out: {holes} of '{}' beyond its outline", self.name));
        }
        kept
    }
}

fn counted(count: usize, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}

/// Start and end of a run, if they are apart.
pub(super) fn closing<T>(run: &[(T, Path)]) -> Option<[Vec2; 2]> {
    let ends = [run.last()?.1.end(), run.first()?.1.start()];
    ((ends[0] - ends[1]).norm() > 1e-8).then_some(ends)
}

/// Whether a point is on the line that the mirror line is a part of.
pub(super) fn is_on(p: Vec2, [from, to]: [Vec2; 2]) -> bool {
    (to - from).try_normalize(0.0).is_some_and(|along| along.perp(&(p - from)).abs() <= ON_MIRROR)
}

/// The run with a straight last side.
pub(super) fn closed_by<T>(mut run: Vec<(T, Path)>, side: T) -> Vec<(T, Path)> {
    let (Some(start), Some(end)) = (run.first().map(|r| r.1.start()), run.last().map(|r| r.1.end())) else {
        return run;
    };
    if (start - end).norm() > 1e-8 {
        run.push((side, Path::line(end, start)));
    }
    run
}
