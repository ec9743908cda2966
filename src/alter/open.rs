//! Pieces cut open: slashed and spread, or a dart's intake turned to another place.

use super::sheet::{AlteredPiece, EdgeDart, EdgeMark, length_in};
use super::{Fault, name};
use crate::geometry::{Path, Vec2, encloses};
use crate::pattern::{DartFile, DartShape, GarmentFile, Located, Problem, Quantity};

/// Lengths below this are none, metres.
const NONE: f64 = 1e-9;
/// Largest distance of a curve from the chords that replace it where it is asked what lies inside, metres.
const CHORD: f64 = 1e-5;

/// A motion that keeps lengths: `p ↦ turn · p + shift`.
#[derive(Clone, Copy, Debug)]
struct RigidMotion {
    turn: nalgebra::Matrix2<f64>,
    shift: Vec2,
}

impl RigidMotion {
    const STILL: Self = Self { turn: nalgebra::Matrix2::new(1.0, 0.0, 0.0, 1.0), shift: Vec2::new(0.0, 0.0) };

    /// Turned about a point, and then shifted.
    fn about(point: Vec2, angle: f64, shift: Vec2) -> Self {
        let turn = *nalgebra::Rotation2::new(angle).matrix();
        Self { turn, shift: point - turn * point + shift }
    }

    fn point(&self, p: Vec2) -> Vec2 {
        self.turn * p + self.shift
    }

    fn is_still(&self) -> bool {
        *self == Self::STILL
    }

    /// This motion as it is seen from a piece of cloth that makes `other`.
    fn seen_from(&self, other: &Self) -> Self {
        let back = other.turn.transpose();
        Self { turn: back * self.turn, shift: back * (self.shift - other.shift) }
    }
}

impl PartialEq for RigidMotion {
    fn eq(&self, other: &Self) -> bool {
        self.turn == other.turn && self.shift == other.shift
    }
}

/// A part of the outline: of an edge as it was (from … to), or a line that closes an opening.
#[derive(Clone, Debug)]
pub(super) struct Bit {
    pub(super) edge: usize,
    pub(super) was: Option<[f64; 2]>,
    pub(super) path: Path,
}

/// The outline clockwise from one place to another.
pub(super) fn chain(sheet: &AlteredPiece, from: EdgeMark, to: EdgeMark) -> Vec<Bit> {
    let bit = |edge: usize, a: f64, b: f64| {
        (b - a > NONE).then(|| Bit { edge, was: Some([a, b]), path: sheet.edges[edge].part(a, b) })
    };
    if from.edge == to.edge && from.at < to.at {
        return bit(from.edge, from.at, to.at).into_iter().collect();
    }
    let length = |edge: usize| sheet.edges[edge].length();
    let count = sheet.edges.len();
    let mut bits: Vec<Bit> = bit(from.edge, from.at, length(from.edge)).into_iter().collect();
    let mut edge = (from.edge + 1) % count;
    while edge != to.edge {
        bits.extend(bit(edge, 0.0, length(edge)));
        edge = (edge + 1) % count;
    }
    bits.extend(bit(to.edge, 0.0, to.at));
    bits
}

/// One of the two parts of the cloth, and what it does.
pub(super) struct Half {
    pub(super) bits: Vec<Bit>,
    motion: RigidMotion,
    /// Its rim, the cut included.
    rim: Vec<[Vec2; 2]>,
}

impl Half {
    pub(super) fn new(bits: Vec<Bit>, cut: &[Vec2]) -> Self {
        let mut points: Vec<Vec2> = bits.iter().flat_map(|b| b.path.sampled(CHORD)).collect();
        points.extend(cut);
        let rim = (0..points.len()).map(|i| [points[i], points[(i + 1) % points.len()]]).collect();
        Self { bits, motion: RigidMotion::STILL, rim }
    }

    pub(super) fn contains(&self, p: Vec2) -> bool {
        encloses(self.rim.iter().copied(), p)
    }

    pub(super) fn has(&self, edge: usize) -> bool {
        self.bits.iter().any(|b| b.edge == edge)
    }

    pub(super) fn length(&self) -> f64 {
        self.bits.iter().map(|b| b.path.length()).sum()
    }

    fn moved(&self) -> Vec<Bit> {
        let still = self.motion.is_still();
        let path = |b: &Bit| if still { b.path.clone() } else { b.path.mapped(self.motion.turn, self.motion.shift) };
        self.bits.iter().map(|b| Bit { path: path(b), ..b.clone() }).collect()
    }
}

/// The two parts put together again. `at_end` is the edge that the opening between the end of the first part and the
/// start of the second belongs to, `at_start` that of the other opening.
struct Reunion<'s> {
    sheet: &'s mut AlteredPiece,
    halves: [Half; 2],
    at_end: usize,
    at_start: usize,
}

/// A stretch that was let into an edge: from here to there.
struct LetIn {
    edge: usize,
    at: [f64; 2],
}

impl Reunion<'_> {
    /// Rebuilds the outline with all that lies on it. Gives the openings at the end and the start of the first part.
    fn carry_out(self) -> Result<[Option<LetIn>; 2], Fault> {
        let Self { sheet, halves, at_end, at_start } = self;
        let [first, second] = [0, 1].map(|i| halves[i].moved());
        let (ends, starts) = (|bits: &[Bit]| bits[bits.len() - 1].path.end(), |bits: &[Bit]| bits[0].path.start());
        let gap = |edge: usize, from: Vec2, to: Vec2| {
            let wide = (to - from).norm() > NONE;
            wide.then(|| Bit { edge, was: None, path: Path::line(from, to) })
        };
        let openings = [gap(at_end, ends(&first), starts(&second)), gap(at_start, ends(&second), starts(&first))];
        let (end_index, start_index) = (first.len(), first.len() + usize::from(openings[0].is_some()) + second.len());
        let has = [openings[0].is_some(), openings[1].is_some()];
        let [one, other] = openings;
        let ring: Vec<Bit> = first.into_iter().chain(one).chain(second).chain(other).collect();
        let offsets = rebuild(sheet, &ring);
        carry_marks(sheet, &ring, &offsets)?;
        carry_points(sheet, &halves)?;
        let mouth = |i: usize| {
            let (edge, from) = (ring[i].edge, offsets[i]);
            LetIn { edge, at: [from, from + ring[i].path.length()] }
        };
        Ok([has[0].then(|| mouth(end_index)), has[1].then(|| mouth(start_index))])
    }
}

/// Makes the edges of the bits of a ring. Gives the place of each bit on its edge.
fn rebuild(sheet: &mut AlteredPiece, ring: &[Bit]) -> Vec<f64> {
    let count = ring.len();
    let begins = |i: &usize| ring[*i].edge == 0 && ring[(i + count - 1) % count].edge != 0;
    let from_start = |i: &usize| ring[*i].edge == 0 && ring[*i].was.is_some_and(|w| w[0] == 0.0);
    let first = (0..count).find(begins).or_else(|| (0..count).find(from_start)).unwrap_or(0);
    let mut offsets = vec![0.0; count];
    let mut edges: Vec<Option<Path>> = vec![None; sheet.edges.len()];
    for i in (0..count).map(|i| (i + first) % count) {
        let bit = &ring[i];
        let before = edges[bit.edge].take();
        offsets[i] = before.as_ref().map_or(0.0, Path::length);
        edges[bit.edge] = Some(before.map_or_else(|| bit.path.clone(), |b| b.joined(&bit.path)));
    }
    for (i, path) in edges.into_iter().enumerate() {
        // An edge of one bit that has not moved stays as it is, to the last digit.
        let same = path.as_ref().is_some_and(|p| p.length() == sheet.edges[i].length() && *p == sheet.edges[i]);
        if let Some(path) = path.filter(|_| !same) {
            sheet.edges[i] = path;
        }
    }
    offsets
}

fn carry_marks(sheet: &mut AlteredPiece, ring: &[Bit], offsets: &[f64]) -> Result<(), Fault> {
    for i in 0..sheet.marks.len() {
        let Some(mark) = sheet.marks[i] else { continue };
        let holds =
            |b: &Bit| b.edge == mark.edge && b.was.is_some_and(|[a, e]| (a - NONE..=e + NONE).contains(&mark.at));
        let Some(bit) = ring.iter().position(holds) else {
            let reason = format!("a mark on '{}' lies in the part that is taken out", sheet.names[mark.edge]);
            return Err((sheet.at, Problem::AlterShape { piece: sheet.piece.clone(), reason }));
        };
        let from = ring[bit].was.map_or(0.0, |w| w[0]);
        sheet.marks[i] = Some(EdgeMark { edge: mark.edge, at: offsets[bit] + mark.at - from });
    }
    Ok(())
}

fn carry_points(sheet: &mut AlteredPiece, halves: &[Half; 2]) -> Result<(), Fault> {
    let of = |p: Vec2| &halves[usize::from(!halves[0].contains(p))].motion;
    let grain = sheet.grain_points;
    for point in sheet.points.iter_mut().skip(grain) {
        *point = of(*point).point(*point);
    }
    for run in &mut sheet.runs {
        let points = run.sampled(CHORD);
        let motion = *of(points[0]);
        if points.iter().any(|p| *of(*p) != motion) {
            let reason = "a hole or a line lies across the cut; cut elsewhere, or leave it out first".to_owned();
            return Err((sheet.at, Problem::AlterShape { piece: sheet.piece.clone(), reason }));
        }
        if !motion.is_still() {
            *run = run.mapped(motion.turn, motion.shift);
        }
    }
    Ok(())
}

/// That no dart is cut through, but for one.
pub(super) fn darts_whole(
    sheet: &AlteredPiece,
    wedges: &[EdgeDart],
    but: Option<usize>,
    cuts: &[EdgeMark],
    half: &Half,
) -> Result<(), Fault> {
    for wedge in wedges.iter().filter(|w| Some(w.dart) != but) {
        let through = cuts.iter().any(|c| c.edge == wedge.edge && wedge.mouth[0] < c.at && c.at < wedge.mouth[1]);
        let middle = 0.5 * (wedge.mouth[0] + wedge.mouth[1]);
        let on =
            half.bits.iter().any(|b| b.edge == wedge.edge && b.was.is_some_and(|w| (w[0]..=w[1]).contains(&middle)));
        if through || on != half.contains(wedge.tip) {
            let reason = format!("the cut goes through a dart on '{}'", sheet.names[wedge.edge]);
            return Err((sheet.at, Problem::AlterShape { piece: sheet.piece.clone(), reason }));
        }
    }
    Ok(())
}

/// Slashes a piece between two points of its outline and opens it.
pub(super) fn spread(
    file: &mut GarmentFile,
    ends: [&Located<String>; 2],
    by: &Located<Quantity>,
    to_by: Option<&Located<Quantity>>,
) -> Result<(), Fault> {
    let (index, from) = name::point(file, ends[0])?;
    let (other, to) = name::point(file, ends[1])?;
    if index != other {
        let [one, other] = [index, other].map(|i| file.pieces[i].name.value.clone());
        return Err((ends[1].at, Problem::AlterTwoPieces { what: "spread", one, other }));
    }
    let mut sheet = AlteredPiece::read(file, index)?;
    if let Some(end) = [from, to].iter().zip(ends).find(|(m, _)| sheet.fold == Some(m.edge)) {
        let reason = "a slash from it would part the fold; spread elsewhere, or parallel to it by 'move'".to_owned();
        let (piece, edge) = (sheet.piece.clone(), sheet.names[end.0.edge].clone());
        return Err((end.1.at, Problem::AlterFold { piece, edge, reason }));
    }
    let [p, q] = [from, to].map(|m| sheet.edges[m.edge].point(m.at));
    let long = (p - q).norm();
    let (by_m, to_m) = (by.value.value(sheet.unit), to_by.map_or(0.0, |q| q.value.value(sheet.unit)));
    if (by_m - to_m).abs() >= long {
        let what = format!("what '{}' is opened by", sheet.piece);
        let expected = format!("less than the {:.1} mm of its slash, from one end to the other", long * 1e3);
        return Err((by.at, Problem::AlterAmount { what, expected, found: by_m * 1e3 }));
    }
    let mut halves = [Half::new(chain(&sheet, from, to), &[]), Half::new(chain(&sheet, to, from), &[])];
    if halves.iter().any(|h| h.bits.is_empty()) {
        return Err((ends[1].at, Problem::AlterPoint(ends[1].value.clone())));
    }
    darts_whole(&sheet, &sheet.wedges(&file.pieces[index]), None, &[from, to], &halves[0])?;
    let along = (p - q) / long;
    let open = Vec2::new(-along.y, along.x);
    // Each half turns by half the angle: the chord of the opening is then as wide as asked for.
    let angle = ((by_m - to_m) / (2.0 * long)).asin();
    let motions =
        [RigidMotion::about(q, angle, open * (to_m / 2.0)), RigidMotion::about(q, -angle, open * (-to_m / 2.0))];
    halves[0].motion = motions[0];
    halves[1].motion = motions[1];
    if let Some(fold) = sheet.fold {
        let fixed = usize::from(!halves[0].has(fold));
        halves[1 - fixed].motion = motions[1 - fixed].seen_from(&motions[fixed]);
        halves[fixed].motion = RigidMotion::STILL;
    }
    Reunion { sheet: &mut sheet, halves, at_end: to.edge, at_start: from.edge }.carry_out()?;
    sheet.write(file, index)
}

/// Turns a dart's intake, or a part of it, to another place of the outline, about the dart's tip.
pub(super) fn pivot(
    file: &mut GarmentFile,
    dart: &Located<String>,
    to: &Located<String>,
    share: Option<&Located<Quantity>>,
    new_name: Option<&Located<String>>,
) -> Result<(), Fault> {
    let (index, number) = name::dart(file, dart)?;
    let (other, place) = name::point(file, to)?;
    if index != other {
        let [one, other] = [index, other].map(|i| file.pieces[i].name.value.clone());
        return Err((to.at, Problem::AlterTwoPieces { what: "pivot", one, other }));
    }
    let part = share.map_or(1.0, |s| if s.value.is_percent() { s.value.number / 100.0 } else { s.value.number });
    if let Some(share) = share.filter(|_| !(0.0 < part && part <= 1.0)) {
        let (what, found) = ("share".to_owned(), format!("{part}"));
        return Err((share.at, Problem::OutOfRange { what, expected: "above 0 and at most 100 %", found }));
    }
    let mut sheet = AlteredPiece::read(file, index)?;
    let wedges = sheet.wedges(&file.pieces[index]);
    let Some(wedge) = wedges.iter().find(|w| w.dart == number).cloned() else {
        let reason = format!("'{}' is a fish-eye dart; a dart on an edge can be moved", dart.value);
        return Err((dart.at, Problem::AlterShape { piece: sheet.piece.clone(), reason }));
    };
    let turning = DartTurning { wedge, place, part };
    let [opened, left] = turning.carry_out(&mut sheet, &wedges, [dart, to])?;
    let marked = |sheet: &AlteredPiece, mouth: &LetIn| new_dart(sheet, mouth, turning.wedge.tip);
    let old = file.pieces[index].darts[number].clone();
    let opened = opened.map(|mouth| (marked(&sheet, &mouth), sheet.names[mouth.edge].clone()));
    let left = left.filter(|_| part < 1.0).map(|mouth| (marked(&sheet, &mouth), sheet.names[mouth.edge].clone()));
    sheet.write(file, index)?;
    let unit = file.unit();
    let written = |(mouth, edge): ([f64; 3], String), name: Option<Located<String>>| {
        let q = |x: f64| Located::new(length_in(x, None, unit), to.at);
        let [at, intake, length] = mouth.map(q);
        let shape = DartShape::Edge { edge: Located::new(edge, to.at), at, length: Some(length), tip: None };
        DartFile { name, intake, shape }
    };
    let darts = &mut file.pieces[index].darts;
    let name = new_name.cloned().or_else(|| old.name.clone().filter(|_| part == 1.0));
    let fresh = opened.map(|mouth| written(mouth, name));
    match left {
        None => {
            darts.splice(number..=number, fresh);
        }
        Some(mouth) => {
            darts[number] = written(mouth, old.name);
            darts.extend(fresh);
        }
    }
    Ok(())
}

/// Middle of the mouth, intake and length of a dart with a straight mouth.
fn new_dart(sheet: &AlteredPiece, mouth: &LetIn, tip: Vec2) -> [f64; 3] {
    let [from, to] = mouth.at;
    let [one, other] = mouth.at.map(|s| sheet.edges[mouth.edge].point(s));
    [(from + to) / 2.0, to - from, ((one + other) / 2.0 - tip).norm()]
}

/// A dart, the place its intake is turned to, and the part that is turned.
struct DartTurning {
    wedge: EdgeDart,
    place: EdgeMark,
    part: f64,
}

impl DartTurning {
    /// Gives the mouths at the new place and the old one.
    fn carry_out(
        &self,
        sheet: &mut AlteredPiece,
        wedges: &[EdgeDart],
        spots: [&Located<String>; 2],
    ) -> Result<[Option<LetIn>; 2], Fault> {
        let EdgeDart { edge, mouth, tip, dart } = self.wedge;
        let refuse = |reason: String| (spots[1].at, Problem::AlterShape { piece: sheet.piece.clone(), reason });
        if self.place.edge == edge && (mouth[0]..=mouth[1]).contains(&self.place.at) {
            return Err(refuse(format!("'{}' lies in the mouth of the dart itself", spots[1].value)));
        }
        if sheet.fold == Some(self.place.edge) {
            let (piece, edge) = (sheet.piece.clone(), sheet.names[self.place.edge].clone());
            let reason = "a dart there would bend the fold".to_owned();
            return Err((spots[1].at, Problem::AlterFold { piece, edge, reason }));
        }
        let [one, other] = mouth.map(|at| EdgeMark { edge, at });
        let cut = [tip];
        let mut halves =
            [Half::new(chain(sheet, other, self.place), &cut), Half::new(chain(sheet, self.place, one), &cut)];
        if halves.iter().any(|h| h.bits.is_empty()) {
            return Err(refuse(format!("'{}' is where the dart is", spots[1].value)));
        }
        darts_whole(sheet, wedges, Some(dart), &[self.place], &halves[0])?;
        let [from, to] = [mouth[1], mouth[0]].map(|s| sheet.edges[edge].point(s) - tip);
        let angle = from.perp(&to).atan2(from.dot(&to)) * self.part;
        let grain = (sheet.grain_points == 2).then(|| (sheet.points[0] + sheet.points[1]) / 2.0);
        let fixed = match (sheet.fold, grain) {
            (Some(fold), _) => usize::from(!halves[0].has(fold)),
            (None, Some(middle)) => usize::from(!halves[0].contains(middle)),
            (None, None) => usize::from(halves[0].length() < halves[1].length()),
        };
        let turned = 1 - fixed;
        halves[turned].motion = RigidMotion::about(tip, if turned == 0 { angle } else { -angle }, Vec2::zeros());
        // The dart's own mark is written anew.
        sheet.forget_dart(dart);
        Reunion { sheet, halves, at_end: self.place.edge, at_start: edge }.carry_out()
    }
}
