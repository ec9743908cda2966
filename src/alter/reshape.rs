//! Pieces given another shape: every point of the cloth is shifted as a field over the cut pieces says.

use super::course::{between, carried, fitted, tilted};
use super::laying::{Laying, layings};
use super::sheet::{AlteredPiece, EdgeDart, EdgeMark, length_in, rounded};
use super::shift::EdgeShift;
use super::{Fault, even, name};
use crate::geometry::{Path, Vec2};
use crate::pattern::{DartShape, Findings, GarmentFile, Located, Quantity, Unit};

/// A piece of which no point is shifted further stays as it is, metres: half a pencil line, and what two drapes of one
/// pattern differ by.
const QUIET: f64 = 2.5e-4;
/// A point of a line or hole no further from an edge lies on it, metres.
const ON_EDGE: f64 = 5e-5;
/// Distance of the points at which the shift of a piece is looked at, metres.
const STEP: f64 = 0.02;

/// The shift, metres, of the cloth at a point of a cut piece that is named.
pub type Given<'a> = &'a dyn Fn(&str, Vec2) -> Vec2;

/// A file whose pieces have been given another shape.
#[derive(Clone, Debug)]
pub struct Reshaped {
    /// The file.
    pub file: GarmentFile,
    /// Largest difference of the shifts of the pieces that are cut from one drawing, metres. The drawing takes their
    /// mean.
    pub uneven: f64,
    /// Largest change of the difference of a seam's two sides, metres.
    pub seams: f64,
}

/// Gives the pieces of a file another shape. Edges stay curves of few points, shifted smoothly, and what lies on them
/// and inside goes along. Then corners are moved by the least amounts that give both sides of each seam the difference
/// (or ratio) of lengths that they had. `None` after an error, which is reported.
pub fn reshape(file: &GarmentFile, given: Given, findings: &mut Findings) -> Option<Reshaped> {
    match reshaped(file, given) {
        Ok(done) => Some(done),
        Err((at, problem)) => {
            findings.error(at, problem);
            None
        }
    }
}

fn reshaped(file: &GarmentFile, given: Given) -> Result<Reshaped, Fault> {
    let mut own = file.clone();
    let (mut shapes, mut uneven) = (Vec::new(), 0.0f64);
    for index in 0..own.pieces.len() {
        let name = own.pieces[index].name.clone();
        name::piece(&mut own, &name)?;
    }
    for index in 0..own.pieces.len() {
        let (shape, apart) = ShiftedPiece::new(&own, index, given)?;
        uneven = uneven.max(apart);
        shapes.push(shape);
    }
    if shapes.iter().all(ShiftedPiece::is_still) {
        return Ok(Reshaped { file: file.clone(), uneven, seams: 0.0 });
    }
    let (file, seams) = even::evened(&own, &shapes)?;
    Ok(Reshaped { file, uneven, seams })
}

/// A stretch of an edge: all of it, what is left of it beside darts, or the mouth of a dart.
#[derive(Clone, Debug)]
struct EdgeStretch {
    from: f64,
    to: f64,
    field: EdgeShift,
    /// Index among the wedges.
    mouth: Option<usize>,
}

/// A piece and how it is shifted.
pub(super) struct ShiftedPiece {
    index: usize,
    sheet: AlteredPiece,
    wedges: Vec<EdgeDart>,
    edges: Vec<Vec<EdgeStretch>>,
    /// Shifts of the wedges' tips.
    tips: Vec<Vec2>,
    /// Shifts of the sheet's points.
    points: Vec<Vec2>,
    /// Fish-eye darts by their indices, with their top, left, bottom and right corners, shifted.
    eyes: Vec<(usize, [Vec2; 4])>,
    /// Shifts along holes and lines.
    runs: Vec<EdgeShift>,
}

/// The shift of a drawing: the mean of those of the pieces cut from it.
struct Mean<'a> {
    layings: &'a [Laying],
    given: Given<'a>,
}

impl Mean<'_> {
    fn each(&self, p: Vec2) -> impl Iterator<Item = Vec2> + '_ {
        self.layings.iter().map(move |laying| laying.back((self.given)(&laying.piece, laying.point(p))))
    }

    fn at(&self, p: Vec2) -> Vec2 {
        self.each(p).sum::<Vec2>() / self.layings.len() as f64
    }

    /// How far the shift of one piece is from the mean.
    fn apart(&self, p: Vec2) -> f64 {
        let mean = self.at(p);
        self.each(p).map(|by| (by - mean).norm()).fold(0.0, f64::max)
    }
}

impl ShiftedPiece {
    /// The shape of the piece with this index, and how far the pieces that are cut from it differ.
    fn new(file: &GarmentFile, index: usize, given: Given) -> Result<(Self, f64), Fault> {
        let mut sheet = AlteredPiece::read(file, index)?;
        sheet.fold_by_like(file, index);
        let layings = layings(file, index, sheet.fold.map(|f| &sheet.edges[f]));
        let mean = Mean { layings: &layings, given };
        let wedges = sheet.wedges(&file.pieces[index]);
        let looked: Vec<Vec2> = sheet.edges.iter().flat_map(spots).chain(wedges.iter().map(|w| w.tip)).collect();
        let still = looked.iter().all(|p| mean.at(*p).norm() <= QUIET);
        let apart = looked.iter().map(|p| mean.apart(*p)).fold(0.0, f64::max);
        let by = |p: Vec2| if still { Vec2::zeros() } else { mean.at(p) };
        let edges = (0..sheet.edges.len()).map(|e| stretches(&sheet, &wedges, e, &by)).collect();
        let count = |p: &&crate::pattern::DartFile| matches!(p.shape, DartShape::FishEye { .. });
        let eyes = file.pieces[index].darts.iter().filter(count).count();
        let loose = sheet.grain_points..sheet.points.len() - 3 * eyes;
        let shift = |(i, p): (usize, &Vec2)| if loose.contains(&i) { by(*p) } else { Vec2::zeros() };
        let points = sheet.points.iter().enumerate().map(shift).collect();
        let tips = wedges.iter().map(|w| by(w.tip)).collect();
        let runs = sheet.runs.iter().map(|run| fitted(run.length(), |s| by(run.point(s)))).collect();
        let eyes = if still { Vec::new() } else { eyes_of(file, index, sheet.unit, &by) };
        Ok((Self { index, sheet, wedges, edges, tips, points, eyes, runs }, apart))
    }

    /// Whether it keeps its shape.
    pub(super) fn is_still(&self) -> bool {
        self.edges.iter().flatten().all(|stretch| stretch.field.is_still())
    }

    /// Number of its corners. Corner `k` is the start of edge `k`.
    pub(super) fn corners(&self) -> usize {
        self.sheet.edges.len()
    }

    /// Directions in which a corner may be moved: along the fold only, at its ends.
    pub(super) fn directions(&self, corner: usize) -> Vec<Vec2> {
        let count = self.corners();
        match self.sheet.fold {
            Some(fold) if corner == fold || corner == (fold + 1) % count => {
                let axis = &self.sheet.edges[fold];
                vec![(axis.end() - axis.start()).try_normalize(0.0).unwrap_or_else(Vec2::y)]
            }
            _ => vec![Vec2::x(), Vec2::y()],
        }
    }

    /// Writes the piece into its file as it is shifted, its corners moved by `tilt` besides.
    pub(super) fn write(&self, file: &mut GarmentFile, tilt: &[Vec2]) -> Result<(), Fault> {
        let still = self.is_still() && tilt.iter().all(|by| *by == Vec2::zeros());
        if still {
            return Ok(());
        }
        let mut sheet = self.sheet.clone();
        let mut mouths = vec![[0.0; 2]; self.wedges.len()];
        for edge in 0..sheet.edges.len() {
            self.bend(&mut sheet, edge, tilt, &mut mouths);
        }
        let own = |p: &mut Vec2, by: &Vec2| *p += by;
        sheet.points.iter_mut().zip(&self.points).for_each(|(p, by)| own(p, by));
        for (i, field) in self.runs.iter().enumerate() {
            let run = self.sheet.runs[i].clone();
            let ends = [run.start(), run.end()].map(|p| self.beside(&sheet, p));
            let [first, last] = [0.0, run.length()].map(|s| field.at(s).by);
            let field = tilted(
                field,
                [ends[0].map_or_else(Vec2::zeros, |p| p - first), ends[1].map_or_else(Vec2::zeros, |p| p - last)],
            );
            sheet.runs[i] = if field.is_still() { run } else { carried(&field, &run, &[]).0 };
        }
        self.wedges.iter().for_each(|wedge| sheet.forget_dart(wedge.dart));
        let new = sheet.edges.clone();
        sheet.write(file, self.index)?;
        for (k, wedge) in self.wedges.iter().enumerate() {
            self.write_wedge(file, wedge, &new[wedge.edge], mouths[k], self.tips[k]);
        }
        self.eyes.iter().for_each(|(dart, corners)| self.write_eye(file, *dart, *corners));
        Ok(())
    }

    /// Shifts an edge with its marks, and says where the mouths of its darts have come to lie.
    fn bend(&self, sheet: &mut AlteredPiece, edge: usize, tilt: &[Vec2], mouths: &mut [[f64; 2]]) {
        let old = &self.sheet.edges[edge];
        let (length, ends) = (old.length(), [tilt[edge], tilt[(edge + 1) % tilt.len()]]);
        let marks = self.sheet.marks_on(edge);
        let (mut moved, mut whole): (Vec<f64>, Option<Path>) = (vec![0.0; marks.len()], None);
        let mut still = true;
        for stretch in &self.edges[edge] {
            let lean = |s: f64| ends[0] + (ends[1] - ends[0]) * (s / length);
            let field = tilted(&stretch.field, [lean(stretch.from), lean(stretch.to)]);
            still &= field.is_still();
            let within: Vec<usize> = (0..marks.len()).filter(|&i| stretch.holds(marks[i], length)).collect();
            let inner: Vec<f64> = within.iter().map(|&i| marks[i] - stretch.from).collect();
            let (path, at) = carried(&field, &old.part(stretch.from, stretch.to), &inner);
            let before = whole.as_ref().map_or(0.0, Path::length);
            within.iter().zip(at).for_each(|(&i, s)| moved[i] = before + s);
            if let Some(k) = stretch.mouth {
                mouths[k] = [before, before + path.length()];
            }
            whole = Some(whole.map_or_else(|| path.clone(), |w| w.joined(&path)));
        }
        let wedges = || self.wedges.iter().enumerate().filter(|(_, w)| w.edge == edge);
        let Some(path) = whole.filter(|_| !still) else {
            wedges().for_each(|(k, w)| mouths[k] = w.mouth);
            return;
        };
        for mark in sheet.marks.iter_mut().flatten().filter(|m: &&mut EdgeMark| m.edge == edge) {
            if let Some(i) = marks.iter().position(|m| *m == mark.at) {
                mark.at = moved[i];
            }
        }
        let straight = old.is_straight() && path.is_straight();
        sheet.edges[edge] = if straight { Path::line(path.start(), path.end()) } else { path };
    }

    /// The shift of a point of the drawing that lies on an edge, as the edge has been shifted. `None` beside the edges.
    fn beside(&self, new: &AlteredPiece, p: Vec2) -> Option<Vec2> {
        let near = |e: &usize| self.sheet.edges[*e].nearest(p).1;
        let edge = (0..self.corners()).min_by(|a, b| near(a).total_cmp(&near(b)))?;
        let (s, far) = self.sheet.edges[edge].nearest(p);
        let share = s / self.sheet.edges[edge].length();
        let on = |edge: &Path| edge.point(share * edge.length());
        // Places of the shifted edge by their share of its length are exact at the corners, and near enough between.
        (far <= ON_EDGE).then(|| on(&new.edges[edge]) - on(&self.sheet.edges[edge]))
    }

    fn write_wedge(&self, file: &mut GarmentFile, wedge: &EdgeDart, edge: &Path, mouth: [f64; 2], tip: Vec2) {
        let unit = self.sheet.unit;
        let [one, other] = mouth.map(|s| edge.point(s));
        let middle = (one + other) / 2.0;
        let across = (other - one).try_normalize(0.0).unwrap_or_else(Vec2::x);
        let square = Vec2::new(-across.y, across.x);
        // Square over the middle both legs are equally long.
        let deep = (wedge.tip + tip - middle).dot(&square);
        let dart = &mut file.pieces[self.index].darts[wedge.dart];
        set_length(&mut dart.intake, mouth[1] - mouth[0], unit);
        let DartShape::Edge { at, length, tip, .. } = &mut dart.shape else { return };
        set_length(at, (mouth[0] + mouth[1]) / 2.0, unit);
        if let Some(tip) = tip {
            let p = (middle + square * deep) / unit.factor();
            tip.value = [rounded(p.x), rounded(p.y)];
        } else if let Some(length) = length {
            set_length(length, deep, unit);
        }
    }

    fn write_eye(&self, file: &mut GarmentFile, dart: usize, [top, left, bottom, right]: [Vec2; 4]) {
        let unit = self.sheet.unit;
        let dart = &mut file.pieces[self.index].darts[dart];
        let DartShape::FishEye { at, up, down } = &mut dart.shape else { return };
        let middle = Vec2::new((top.x + left.x + bottom.x + right.x) / 4.0, (left.y + right.y) / 2.0);
        let shown = middle / unit.factor();
        at.value = [rounded(shown.x), rounded(shown.y)];
        set_length(&mut dart.intake, (right - left).norm(), unit);
        set_length(up, middle.y - top.y, unit);
        set_length(down, bottom.y - middle.y, unit);
    }
}

impl EdgeStretch {
    /// Whether a place of its edge, which is so long, lies on it.
    fn holds(&self, s: f64, length: f64) -> bool {
        self.from <= s && (s < self.to || self.to >= length)
    }
}

/// Writes a length, in the unit that it was written in.
fn set_length(q: &mut Located<Quantity>, metres: f64, unit: Unit) {
    q.value = length_in(metres, q.value.unit, unit);
}

/// Points along a path, its ends included.
fn spots(path: &Path) -> Vec<Vec2> {
    let count = (path.length() / STEP).ceil().max(1.0) as usize;
    (0..=count).map(|i| path.point(path.length() * i as f64 / count as f64)).collect()
}

/// The stretches of an edge, each with its shift. That of the fold is even, for it stays straight.
fn stretches(sheet: &AlteredPiece, wedges: &[EdgeDart], edge: usize, by: &dyn Fn(Vec2) -> Vec2) -> Vec<EdgeStretch> {
    let path = &sheet.edges[edge];
    let length = path.length();
    let at = |s: f64| by(path.point(s));
    let mut mouths: Vec<usize> = (0..wedges.len()).filter(|&k| wedges[k].edge == edge).collect();
    mouths.sort_by(|&a, &b| wedges[a].mouth[0].total_cmp(&wedges[b].mouth[0]));
    let open = |from: f64, to: f64| {
        let ends = [at(from), at(to)];
        let straight = sheet.fold == Some(edge);
        let field = if straight { between(to - from, ends) } else { fitted(to - from, |s| at(from + s)) };
        EdgeStretch { from, to, field, mouth: None }
    };
    let (mut out, mut from) = (Vec::new(), 0.0);
    for k in mouths {
        let [start, end] = wedges[k].mouth;
        out.push(open(from, start));
        out.push(EdgeStretch {
            from: start,
            to: end,
            field: between(end - start, [at(start), at(end)]),
            mouth: Some(k),
        });
        from = end;
    }
    out.push(open(from, length));
    out
}

/// The fish-eye darts of a piece with their corners, shifted.
fn eyes_of(file: &GarmentFile, index: usize, unit: Unit, by: &dyn Fn(Vec2) -> Vec2) -> Vec<(usize, [Vec2; 4])> {
    let mut eyes = Vec::new();
    for (number, dart) in file.pieces[index].darts.iter().enumerate() {
        let DartShape::FishEye { at, up, down } = &dart.shape else { continue };
        let middle = Vec2::from(at.value) * unit.factor();
        let [half, up, down] = [dart.intake.value.value(unit) / 2.0, up.value.value(unit), down.value.value(unit)];
        let corners = [Vec2::new(0.0, -up), Vec2::new(-half, 0.0), Vec2::new(0.0, down), Vec2::new(half, 0.0)];
        eyes.push((number, corners.map(|c| middle + c + by(middle + c))));
    }
    eyes
}
