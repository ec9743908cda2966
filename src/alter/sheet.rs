//! A piece while it is altered: its curves in metres, with all that lies on them.

use super::Fault;
use super::laying::cut_of;
use crate::geometry::{Path, Vec2};
use crate::pattern::{
    ClosureFile, CutKind, DartFile, DartShape, GarmentFile, Located, PieceFile, Problem, Quantity, Spot, Unit,
};

/// Positions that changed by less than this stay as they are written, metres.
const SAME: f64 = 1e-9;
/// Distance by which an outline may miss its start, metres: rounding of the file's numbers.
const CLOSURE: f64 = 5e-5;
/// A fish-eye dart whose middle line is further from upright than this is turned, metres.
const UPRIGHT: f64 = 1e-7;
/// Digits after the point that are written.
const DECIMALS: f64 = 1e6;

/// A position on an edge: a notch, the middle of a dart's mouth, the place of a pleat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EdgeMark {
    /// Index of the edge.
    pub(super) edge: usize,
    /// Arc length from its start.
    pub(super) at: f64,
}

/// Dart on an edge.
#[derive(Clone, Debug)]
pub(super) struct EdgeDart {
    /// Index in the piece's list.
    pub(super) dart: usize,
    pub(super) edge: usize,
    pub(super) mouth: [f64; 2],
    pub(super) tip: Vec2,
}

/// The piece.
#[derive(Clone, Debug)]
pub(super) struct AlteredPiece {
    pub(super) unit: Unit,
    pub(super) piece: String,
    pub(super) at: Spot,
    pub(super) names: Vec<String>,
    pub(super) edges: Vec<Path>,
    pub(super) fold: Option<usize>,
    /// In the order of [`each_mark`].
    pub(super) marks: Vec<Option<EdgeMark>>,
    /// In the order of [`each_point`].
    pub(super) points: Vec<Vec2>,
    /// How many of them are the grain's.
    pub(super) grain_points: usize,
    /// Number of notches, which come before the darts in `marks`.
    notches: usize,
    /// Indices of the darts on edges, in their order.
    wedges: Vec<usize>,
    /// Holes, then lines.
    pub(super) runs: Vec<Path>,
    before: Vec<Path>,
    before_runs: Vec<Path>,
}

/// Every position along an edge that the piece states, with its edge's name.
fn each_mark(piece: &mut PieceFile, mut visit: impl FnMut(&str, &mut Quantity)) {
    for (edge, list) in &mut piece.notches {
        list.iter_mut().for_each(|notch| visit(&edge.value, &mut notch.value.at));
    }
    for dart in &mut piece.darts {
        if let DartShape::Edge { edge, at, .. } = &mut dart.shape {
            visit(&edge.value, &mut at.value);
        }
    }
    for pleat in &mut piece.pleats {
        pleat.at.iter_mut().for_each(|at| visit(&pleat.edge.value, &mut at.value));
    }
}

/// Every free point of the piece: grain, tips of darts, three points of each fish-eye dart, points of closures.
fn each_point(
    unit: Unit,
    piece: &mut PieceFile,
    closures: &mut [ClosureFile],
    mut visit: impl FnMut(Vec2) -> Vec2,
) -> Result<(), Fault> {
    let scale = unit.factor();
    let mut moved = |p: &mut [f64; 2]| {
        let old = Vec2::from(*p) * scale;
        let new = visit(old);
        if (new - old).norm() > SAME {
            *p = [rounded(new.x / scale), rounded(new.y / scale)];
        }
    };
    if let Some(grain) = &mut piece.grain {
        grain.value.iter_mut().for_each(&mut moved);
    }
    for dart in &mut piece.darts {
        if let DartShape::Edge { tip: Some(tip), .. } = &mut dart.shape {
            moved(&mut tip.value);
        }
    }
    for (of, points) in
        closures.iter_mut().flat_map(|c| [(c.on.clone(), &mut c.at), (c.meets.clone(), &mut c.meets_at)])
    {
        if of.is_some_and(|of| of.value.split('.').next() == Some(piece.name.value.as_str())) {
            points.iter_mut().for_each(|p| moved(&mut p.value));
        }
    }
    for dart in &mut piece.darts {
        eye(dart, unit, &piece.name.value, &mut visit)?;
    }
    Ok(())
}

fn eye(dart: &mut DartFile, unit: Unit, piece: &str, visit: &mut impl FnMut(Vec2) -> Vec2) -> Result<(), Fault> {
    let DartShape::FishEye { at, up, down } = &mut dart.shape else { return Ok(()) };
    let scale = unit.factor();
    let middle = Vec2::from(at.value) * scale;
    let [above, below] = [&up, &down].map(|q| Vec2::new(0.0, q.value.value(unit)));
    let [top, new, bottom] = [middle - above, middle, middle + below].map(visit);
    if (top.x - new.x).abs() > UPRIGHT || (bottom.x - new.x).abs() > UPRIGHT {
        let reason = "a fish-eye dart in the part that turns would no longer be upright".to_owned();
        return Err((at.at, Problem::AlterShape { piece: piece.to_owned(), reason }));
    }
    if (new - middle).norm() > SAME {
        at.value = [rounded(new.x / scale), rounded(new.y / scale)];
    }
    for (q, long) in [(up, new.y - top.y), (down, bottom.y - new.y)] {
        if (q.value.value(unit) - long).abs() > SAME {
            q.value = length_in(long, q.value.unit, unit);
        }
    }
    Ok(())
}

/// As many digits as are written.
pub(super) fn rounded(x: f64) -> f64 {
    let r = (x * DECIMALS).round() / DECIMALS;
    if r == 0.0 { 0.0 } else { r }
}

/// A length as a quantity of the file, in the unit that was written where that is one of length.
pub(super) fn length_in(metres: f64, written: Option<Unit>, unit: Unit) -> Quantity {
    let own = written.filter(|u| *u != Unit::Percent);
    Quantity { number: rounded(metres / own.unwrap_or(unit).factor()), unit: own }
}

impl AlteredPiece {
    /// Reads a piece of the file.
    pub(super) fn read(file: &GarmentFile, index: usize) -> Result<Self, Fault> {
        let (unit, mut piece) = (file.unit(), file.pieces[index].clone());
        let name = piece.name.value.clone();
        let Some(outline) = &piece.outline else { return Err((piece.name.at, Problem::NoOutline(name))) };
        let names: Vec<String> = outline.edges.iter().map(|e| e.0.value.clone()).collect();
        let edges = edges(&name, outline.start.value, &outline.edges, unit)?;
        if edges.is_empty() {
            return Err((outline.start.at, Problem::NoOutline(name)));
        }
        let at = outline.start.at;
        if edges.iter().map(Path::double_area).sum::<f64>() <= 0.0 {
            let reason = "it is drawn counter-clockwise; draw its outline clockwise on screen (y points down)".into();
            return Err((at, Problem::AlterShape { piece: name, reason }));
        }
        let gap = (edges[edges.len() - 1].end() - edges[0].start()).norm();
        if gap > CLOSURE {
            return Err((at, Problem::AlterShape { piece: name, reason: "its outline does not close".to_owned() }));
        }
        let fold = match piece.cut.as_ref().map(|c| &c.value) {
            Some(CutKind::Fold(edge)) => names.iter().position(|n| n == edge),
            _ => None,
        };
        let mut marks = Vec::new();
        each_mark(&mut piece, |edge, at| {
            let edge = names.iter().position(|n| n == edge);
            marks.push(edge.map(|edge| EdgeMark { edge, at: position(*at, edges[edge].length(), unit) }));
        });
        let whole = |text: &Located<String>| {
            Path::parse_absolute(&text.value, unit.factor())
                .map_err(|e| (text.at, Problem::AlterShape { piece: name.clone(), reason: e.to_string() }))
        };
        let holes = piece.holes.iter().map(|h| whole(&h.1));
        let runs: Vec<Path> = holes.chain(piece.lines.iter().map(|l| whole(&l.path))).collect::<Result<_, _>>()?;
        let mut points = Vec::new();
        each_point(unit, &mut piece, &mut file.closures.clone(), |p| {
            points.push(p);
            p
        })?;
        let (before, before_runs) = (edges.clone(), runs.clone());
        let grain_points = if piece.grain.is_some() { 2 } else { 0 };
        let notches = piece.notches.iter().map(|n| n.1.len()).sum();
        let on_edge = |i: &usize| matches!(piece.darts[*i].shape, DartShape::Edge { .. });
        let wedges = (0..piece.darts.len()).filter(on_edge).collect();
        Ok(Self {
            unit,
            piece: name,
            at,
            names,
            edges,
            fold,
            marks,
            points,
            grain_points,
            notches,
            wedges,
            runs,
            before,
            before_runs,
        })
    }

    /// Finds the fold of a piece that is on the fold because another one is, which it is like.
    pub(super) fn fold_by_like(&mut self, file: &GarmentFile, index: usize) {
        if let (CutKind::Fold(edge), _) = cut_of(file, index) {
            self.fold = self.names.iter().position(|n| *n == edge);
        }
    }

    /// Writes it back, leaving every statement as it is that has not changed.
    pub(super) fn write(mut self, file: &mut GarmentFile, index: usize) -> Result<(), Fault> {
        let unit = self.unit;
        self.close();
        self.check()?;
        let piece = &mut file.pieces[index];
        let scale = 1.0 / unit.factor();
        if let Some(outline) = &mut piece.outline {
            let start = self.edges[0].start();
            if start != self.before[0].start() {
                outline.start.value = [rounded(start.x * scale), rounded(start.y * scale)];
            }
            let changed = |i: usize| self.edges[i] != self.before[i];
            for i in (0..self.edges.len()).filter(|&i| changed(i)) {
                outline.edges[i].1.value = self.edges[i].to_svg(scale, false);
            }
        }
        let lengths: Vec<f64> = self.before.iter().map(Path::length).collect();
        let mut marks = self.marks.iter();
        each_mark(piece, |_, at| {
            let Some(Some(mark)) = marks.next() else { return };
            if (position(*at, lengths[mark.edge], unit) - mark.at).abs() > SAME {
                *at = length_in(mark.at, at.unit, unit);
            }
        });
        let mut points = self.points.iter();
        each_point(unit, piece, &mut file.closures, |p| points.next().copied().unwrap_or(p))?;
        let holes = piece.holes.len();
        for (i, run) in self.runs.iter().enumerate().filter(|(i, run)| **run != self.before_runs[*i]) {
            let text = run.to_svg(scale, true);
            match i < holes {
                true => piece.holes[i].1.value = format!("{text} Z"),
                false => piece.lines[i - holes].path.value = text,
            }
        }
        Ok(())
    }

    /// Lets the outline end where it starts, to the last digit.
    fn close(&mut self) {
        let last = self.edges.len() - 1;
        let start = self.edges[0].start();
        if self.edges[last] != self.before[last] && self.edges[last].end() != start {
            let (path, end) = (&self.edges[last], self.edges[last].end());
            let length = path.length();
            let by = |s: f64| (start - end) * (s / length);
            let slope = (start - end) / length;
            self.edges[last] = path.shifted(&[], &[], |s| crate::geometry::Shift { by: by(s), slope }).0;
        }
    }

    /// Whether the outline is one, still.
    fn check(&self) -> Result<(), Fault> {
        if let Some((near, [one, other])) = crate::pattern::loop_crossing(&self.edges) {
            let near = format!("({:.1}, {:.1})", near.x / self.unit.factor(), near.y / self.unit.factor());
            let edges = format!("'{}' and '{}'", self.names[one], self.names[other]);
            return Err((self.at, Problem::AlterCrosses { piece: self.piece.clone(), near, edges }));
        }
        Ok(())
    }

    /// `piece.edge` for messages.
    pub(super) fn shown(&self, edge: usize) -> String {
        format!("{}.{}", self.piece, self.names[edge])
    }

    /// A position on an edge, metres from its start.
    pub(super) fn place(&self, edge: usize, at: &Located<Quantity>) -> Result<f64, Fault> {
        let length = self.edges[edge].length();
        let s = position(at.value, length, self.unit);
        if !(-CLOSURE..=length + CLOSURE).contains(&s) {
            let (at_mm, length) = (s * 1e3, length * 1e3);
            return Err((at.at, Problem::AlterOff { edge: self.shown(edge), at: at_mm, length }));
        }
        Ok(s.clamp(0.0, length))
    }

    /// Positions of the marks on an edge, sorted.
    pub(super) fn marks_on(&self, edge: usize) -> Vec<f64> {
        let mut at: Vec<f64> = self.marks.iter().flatten().filter(|m| m.edge == edge).map(|m| m.at).collect();
        at.sort_by(f64::total_cmp);
        at
    }

    /// Lets go of a dart's position, which is written anew.
    pub(super) fn forget_dart(&mut self, dart: usize) {
        if let Some(k) = self.wedges.iter().position(|&d| d == dart) {
            self.marks[self.notches + k] = None;
        }
    }

    /// Darts on edges, with their mouths and tips.
    pub(super) fn wedges(&self, piece: &PieceFile) -> Vec<EdgeDart> {
        let mut found = Vec::new();
        for (dart, written) in piece.darts.iter().enumerate() {
            let DartShape::Edge { edge, at, length, tip } = &written.shape else { continue };
            let Some(edge) = self.names.iter().position(|n| *n == edge.value) else { continue };
            let path = &self.edges[edge];
            let (middle, half) =
                (position(at.value, path.length(), self.unit), 0.5 * written.intake.value.value(self.unit));
            let mouth = [middle - half, middle + half];
            let [one, other] = mouth.map(|s| path.point(s));
            let across = (other - one).try_normalize(0.0).unwrap_or_else(Vec2::x);
            let deep = length.as_ref().map_or(0.0, |l| l.value.value(self.unit));
            let square = (one + other) / 2.0 + Vec2::new(-across.y, across.x) * deep;
            let tip = tip.as_ref().map_or(square, |t| Vec2::from(t.value) * self.unit.factor());
            found.push(EdgeDart { dart, edge, mouth, tip });
        }
        found
    }
}

fn edges(
    piece: &str,
    start: [f64; 2],
    written: &[(Located<String>, Located<String>)],
    unit: Unit,
) -> Result<Vec<Path>, Fault> {
    let scale = unit.factor();
    let mut at = Vec2::from(start);
    let mut edges = Vec::new();
    for (name, commands) in written {
        let path = Path::parse(at, &commands.value, scale).map_err(|e| {
            let (piece, edge) = (piece.to_owned(), name.value.clone());
            (commands.at, Problem::BadPath { piece, edge, reason: e.to_string() })
        })?;
        at = path.end() / scale;
        edges.push(path);
    }
    Ok(edges)
}

/// A position along an edge of this length: percent counts of the whole edge.
fn position(q: Quantity, length: f64, unit: Unit) -> f64 {
    if q.is_percent() { q.value(unit) * length } else { q.value(unit) }
}
