//! A piece as drawn, in metres, before it is cut once, twice or on the fold: its outline, open darts, spread pleats and
//! holes.

use std::collections::HashSet;

use super::crossing::{chords, contains, first_crossing};
use super::dart;
use super::diagnostic::{Findings, Located, Spot};
use super::file::{AllowanceFile, PieceFile, PlaceFile};
use super::line;
use super::outline::{CLOSURE, ended_at, outline, whole_path};
use super::place_word::PlaceWord;
use super::pleat;
use super::problem::Problem;
use super::region::Region;
use super::value::{CutKind, Quantity, Side, Unit};
use super::{Edge, Line, Place, SeamKind};
use crate::geometry::{Path, Vec2, Vec3, box_of};
use crate::input::nearest;

/// Least area of a hole, m². A smaller one is a line or a point.
const SMALLEST_HOLE: f64 = 1e-6;

/// Distance from the end of an edge within which a range reaches it, metres: rounding of the file's numbers.
const SNAP: f64 = 5e-4;

/// A stretch of a drawn edge: `(ring, index)`, walked from `from` to `to`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DrawnStretch {
    pub(super) edge: (usize, usize),
    pub(super) from: f64,
    pub(super) to: f64,
}

/// A part of a named edge that is there to be sewn: positions `from..to` of the drawn edge lie on `edge` at
/// `position - offset`.
#[derive(Clone, Copy, Debug)]
pub(super) struct SewnPart {
    pub(super) edge: (usize, usize),
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) offset: f64,
}

/// Meaning of a name in the file: an edge as drawn, without the mouths of darts and the cloth that pleats take up.
#[derive(Clone, Debug)]
pub(super) struct NamedEdge {
    pub(super) name: String,
    /// Length as drawn.
    pub(super) length: f64,
    pub(super) parts: Vec<SewnPart>,
}

impl NamedEdge {
    fn whole(name: String, edge: (usize, usize), length: f64) -> Self {
        Self { name, length, parts: vec![SewnPart { edge, from: 0.0, to: length, offset: 0.0 }] }
    }

    /// The stretches of the drawn range `from..to`, in drawn order.
    pub(super) fn stretches(&self, from: f64, to: f64) -> Vec<DrawnStretch> {
        let clip = |p: &SewnPart| {
            let (a, b) = (p.from.max(from), p.to.min(to));
            (b > a).then_some(DrawnStretch { edge: p.edge, from: a - p.offset, to: b - p.offset })
        };
        self.parts.iter().filter_map(clip).collect()
    }

    /// A range of it as written in a `reference` that `user` makes, in metres from its start. Ends that miss the edge's
    /// own by a rounding are those.
    ///
    /// # Errors
    /// Where it leaves the edge or runs backwards.
    pub(super) fn range(
        &self,
        range: [Quantity; 2],
        unit: Unit,
        reference: &str,
        user: impl FnOnce() -> String,
    ) -> Result<[f64; 2], Problem> {
        let [from, to] = range.map(|q| position(q, self.length, unit));
        if from < -SNAP || to > self.length + SNAP {
            let (user, reference, length) = (user(), reference.to_owned(), self.length * 1e3);
            return Err(Problem::RangeBeyond { user, reference, length });
        }
        let from = if from < SNAP { 0.0 } else { from };
        let to = if to > self.length - SNAP { self.length } else { to };
        if from < to { Ok([from, to]) } else { Err(Problem::BackwardsRange(reference.to_owned())) }
    }
}

/// A seam that a dart or a pleat makes in its own piece.
#[derive(Clone, Debug)]
pub(super) struct OwnSeam {
    pub(super) name: String,
    pub(super) a: DrawnStretch,
    pub(super) b: DrawnStretch,
    pub(super) kind: SeamKind,
}

/// A drawn piece.
#[derive(Clone, Debug)]
pub(super) struct Draft {
    pub(super) name: String,
    pub(super) at: Spot,
    pub(super) cut: CutKind,
    /// Index of the fold edge in the outline.
    pub(super) fold: Option<usize>,
    pub(super) drawn: Side,
    pub(super) fabric: Option<Located<String>>,
    pub(super) layer: i32,
    pub(super) warp: Vec2,
    pub(super) place: Option<Place>,
    pub(super) rings: Vec<Vec<Edge>>,
    pub(super) named: Vec<NamedEdge>,
    pub(super) lines: Vec<Line>,
    /// Edge, position on it, double.
    pub(super) notches: Vec<((usize, usize), f64, bool)>,
    pub(super) own_seams: Vec<OwnSeam>,
}

impl Draft {
    /// The edge called `name`.
    pub(super) fn find(&self, name: &str) -> Option<&NamedEdge> {
        self.named.iter().find(|n| n.name == name)
    }

    /// The error for an edge that is not there.
    pub(super) fn unknown_edge(&self, name: &str) -> Problem {
        let names: Vec<&str> = self.named.iter().map(|n| n.name.as_str()).collect();
        unknown_edge(&self.name, name, &names)
    }

    /// Length of an edge of its rings.
    pub(super) fn length(&self, (ring, index): (usize, usize)) -> f64 {
        self.rings[ring][index].path.length()
    }
}

/// The error for an edge that is not among those of its piece.
pub(super) fn unknown_edge(piece: &str, edge: &str, names: &[&str]) -> Problem {
    Problem::UnknownEdge {
        name: format!("{piece}.{edge}"),
        nearest: nearest(edge, names.iter().copied()).map(str::to_owned),
        known: format!("{piece} has: {}", names.join(", ")),
    }
}

/// A point of the drawing for messages, millimetres.
pub(super) fn shown(p: Vec2) -> String {
    let n = |x: f64| (x * 1e4).round() / 10.0 + 0.0;
    format!("({}, {})", n(p.x), n(p.y))
}

/// Draws a piece. `None` when its outline cannot be used. Everything found is reported.
pub(super) fn draft(piece: &PieceFile, unit: Unit, findings: &mut Findings) -> Option<Draft> {
    let name = piece.name.value.clone();
    let Some(outline_file) = &piece.outline else {
        findings.error(piece.name.at, Problem::NoOutline(name));
        return None;
    };
    let before = findings.errors();
    let warp = warp(piece, findings);
    let outline = outline(&name, outline_file, unit, findings)?;
    let mut drawn = Draft {
        name,
        at: piece.name.at,
        cut: piece.cut.as_ref().map_or(CutKind::One, |c| c.value.clone()),
        fold: None,
        drawn: piece.drawn.as_ref().map_or(Side::Left, |d| d.value),
        fabric: piece.fabric.clone(),
        layer: piece.layer.as_ref().map_or(0, |l| l.value),
        warp,
        place: piece.place.as_ref().map(|p| place(&p.value, unit)),
        rings: vec![Vec::new()],
        named: Vec::new(),
        lines: Vec::new(),
        notches: Vec::new(),
        own_seams: Vec::new(),
    };
    dart::open_outline(&mut drawn, &outline, piece, unit, findings);
    let whole = [outline];
    holes(&mut drawn, piece, unit, findings);
    dart::cut_fish_eyes(&mut drawn, piece, unit, findings);
    pleat::lay(&mut drawn, piece, unit, findings);
    fold(&mut drawn, piece, findings);
    line::lines(&mut drawn, &Region::new(&whole), piece, unit, findings);
    allowances(&drawn, piece, findings);
    notches(&mut drawn, piece, unit, findings);
    check_names(&drawn, findings);
    check_crossings(&drawn, piece, findings);
    (findings.errors() == before).then_some(drawn)
}

/// Edges of darts and holes may not bear the name of another edge.
fn check_names(drawn: &Draft, findings: &mut Findings) {
    let mut seen = HashSet::new();
    for edge in drawn.rings.iter().flatten().filter(|e| !seen.insert(&e.name)) {
        findings.error(drawn.at, Problem::EdgeTwice { piece: drawn.name.clone(), edge: edge.name.clone() });
    }
}

fn warp(piece: &PieceFile, findings: &mut Findings) -> Vec2 {
    let Some(grain) = &piece.grain else {
        findings.warn(piece.name.at, Problem::NoGrain(piece.name.value.clone()));
        return Vec2::y();
    };
    let [tail, head] = grain.value.map(Vec2::from);
    (head - tail).try_normalize(1e-9).unwrap_or_else(|| {
        findings.error(grain.at, Problem::ZeroGrain(piece.name.value.clone()));
        Vec2::y()
    })
}

fn place(place: &PlaceFile, unit: Unit) -> Place {
    match place {
        PlaceFile::Words(words) => {
            // What is no word has been told of.
            Place::Around { words: words.to_lowercase().split_whitespace().filter_map(PlaceWord::parse).collect() }
        }
        PlaceFile::At { at, turn } => {
            Place::At { at: Vec3::from(*at) * unit.factor(), turn: turn.map_or(Vec3::zeros(), Vec3::from) }
        }
    }
}

impl Draft {
    /// Adds a ring of which every edge can be sewn under its own name.
    pub(super) fn add_ring(&mut self, ring: Vec<Edge>) {
        let number = self.rings.len();
        for (i, edge) in ring.iter().enumerate() {
            self.named.push(NamedEdge::whole(edge.name.clone(), (number, i), edge.path.length()));
        }
        self.rings.push(ring);
    }

    /// Adds an edge to the outline under its own name and returns where it stands.
    pub(super) fn add_outline_edge(&mut self, name: String, path: Path) -> (usize, usize) {
        let at = (0, self.rings[0].len());
        self.named.push(NamedEdge::whole(name.clone(), at, path.length()));
        self.rings[0].push(Edge { name, path, against: false });
        at
    }
}

fn holes(drawn: &mut Draft, piece: &PieceFile, unit: Unit, findings: &mut Findings) {
    // The boxes of those before: of hundreds few are near any.
    let around = |ring: &Vec<Edge>| box_of(ring.iter().flat_map(|edge| chords(&edge.path)).flatten());
    let mut boxes: Vec<[Vec2; 2]> = drawn.rings[1..].iter().map(around).collect();
    for (name, text) in &piece.holes {
        let (piece, edge) = (drawn.name.clone(), name.value.clone());
        let path = match whole_path(&text.value, unit.factor()) {
            Ok(path) => path,
            Err(reason) => {
                findings.error(text.at, Problem::BadPath { piece, edge, reason });
                continue;
            }
        };
        let gap = (path.end() - path.start()).norm();
        if gap > CLOSURE {
            let (last, start) = (shown(path.end()), shown(path.start()));
            findings.error(text.at, Problem::NotClosed { piece, last, start, gap: gap * 1e3 });
            continue;
        }
        if !contains(&drawn.rings[0], path.start()) {
            findings.error(text.at, Problem::HoleOutside { piece, hole: edge });
            continue;
        }
        if 0.5 * path.double_area().abs() < SMALLEST_HOLE {
            findings.error(text.at, Problem::HoleNoArea { piece, hole: edge });
            continue;
        }
        let path = ended_at(&path, path.start());
        let path = if path.double_area() > 0.0 { path.reversed() } else { path };
        let ring = vec![Edge { name: edge, path, against: false }];
        let own = around(&ring);
        let is_in = |[low, high]: [Vec2; 2], p: Vec2| low.inf(&p) == low && high.sup(&p) == high;
        let within = |(other, around): &(&Vec<Edge>, &[Vec2; 2])| {
            let [start, begin] = [ring[0].path.start(), other[0].path.start()];
            is_in(**around, start) && contains(other, start) || is_in(own, begin) && contains(&ring, begin)
        };
        if let Some((other, _)) = drawn.rings[1..].iter().zip(&boxes).find(within) {
            let (hole, other) = (ring[0].name.clone(), other[0].name.clone());
            findings.error(text.at, Problem::HoleInHole { piece, hole, other });
            continue;
        }
        drawn.add_ring(ring);
        boxes.push(own);
    }
}

fn fold(drawn: &mut Draft, piece: &PieceFile, findings: &mut Findings) {
    let (CutKind::Fold(edge), Some(cut)) = (drawn.cut.clone(), &piece.cut) else { return };
    let Some(named) = drawn.find(&edge) else {
        findings.error(cut.at, drawn.unknown_edge(&edge));
        return;
    };
    let (at, parts) = (named.parts[0].edge, named.parts.len());
    let path = &drawn.rings[at.0][at.1].path;
    if parts > 1 || at.0 != 0 {
        findings.error(cut.at, Problem::ShapedFold(edge));
    } else if !path.is_straight() {
        findings.error(cut.at, Problem::CurvedFold(edge));
    } else if beyond_fold(drawn, path) {
        findings.error(cut.at, Problem::BeyondFold(drawn.name.clone()));
    } else {
        drawn.fold = Some(at.1);
    }
}

/// Whether the outline leaves the side of its fold on which the piece lies.
fn beyond_fold(drawn: &Draft, fold: &Path) -> bool {
    let along = (fold.end() - fold.start()).normalize();
    drawn.rings[0]
        .iter()
        .flat_map(|e| e.path.sampled(super::crossing::CHORD_ERROR))
        .any(|p| along.perp(&(p - fold.start())) < -CLOSURE)
}

/// Allowances by edge must name edges.
fn allowances(drawn: &Draft, piece: &PieceFile, findings: &mut Findings) {
    let Some(AllowanceFile::Edges(edges)) = &piece.allowance else { return };
    for (name, _) in edges.iter().filter(|(name, _)| drawn.find(&name.value).is_none()) {
        findings.error(name.at, drawn.unknown_edge(&name.value));
    }
}

fn notches(drawn: &mut Draft, piece: &PieceFile, unit: Unit, findings: &mut Findings) {
    for (edge, list) in &piece.notches {
        let Some(named) = drawn.find(&edge.value).cloned() else {
            findings.error(edge.at, drawn.unknown_edge(&edge.value));
            continue;
        };
        for notch in list {
            let at = position(notch.value.at, named.length, unit);
            let part = named.parts.iter().find(|p| (p.from - 1e-9..=p.to + 1e-9).contains(&at));
            match part {
                Some(p) => drawn.notches.push((p.edge, at - p.offset, notch.value.double)),
                None => {
                    let edge = format!("{}.{}", drawn.name, edge.value);
                    findings.error(notch.at, Problem::NotchOff { edge, at: at * 1e3, length: named.length * 1e3 });
                }
            }
        }
    }
}

/// A distance along an edge of this length: percent counts of the whole edge.
pub(super) fn position(q: Quantity, length: f64, unit: Unit) -> f64 {
    if q.is_percent() { q.value(unit) * length } else { q.value(unit) }
}

/// Place of the statement that makes the edge `name`: in the outline, as a hole or as a dart.
pub(super) fn spot_of(name: &str, piece: &PieceFile) -> Spot {
    let edge = piece.outline.iter().flat_map(|o| &o.edges).find(|e| e.0.value == name).map(|e| e.0.at);
    let hole = || piece.holes.iter().find(|h| h.0.value == name).map(|h| h.0.at);
    let stem = name.split('.').next().unwrap_or(name);
    let dart = || {
        let named = |d: &&super::file::DartFile| d.name.as_ref().is_some_and(|n| n.value == stem);
        let found = piece.darts.iter().find(named).or_else(|| piece.darts.first().filter(|_| stem.starts_with("dart")));
        found.map(|d| d.name.as_ref().map_or(d.intake.at, |n| n.at))
    };
    edge.or_else(hole).or_else(dart).unwrap_or(piece.name.at)
}

fn check_crossings(drawn: &Draft, piece: &PieceFile, findings: &mut Findings) {
    let Some((point, edges)) = first_crossing(&drawn.rings) else { return };
    let name = |(ring, index): (usize, usize)| drawn.rings[ring][index].name.clone();
    let (mut one, mut other) = (name(edges[0]), name(edges[1]));
    // The order of the file, whichever the sweep met first.
    if edges[1] < edges[0] {
        std::mem::swap(&mut one, &mut other);
    }
    let at = spot_of(&other, piece);
    let edges = if one == other { format!("two stretches of {one}") } else { format!("{one} and {other}") };
    findings.error(at, Problem::Crosses { piece: drawn.name.clone(), near: shown(point), edges });
}
