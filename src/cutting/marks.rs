//! Notches, grain, folds, pleats and drill marks.

use super::room::Room;
use super::{Mark, MarkKind, NotchMark};
use crate::geometry::{Path, Vec2};
use crate::pattern::{CutKind, DrawnEdge, DrawnPiece, NotchKind};

/// Least length of a notch's mark, metres: shorter ones are overlooked when cutting.
const NOTCH: f64 = 0.006;
/// A grain line shorter than this (metres) cannot be laid along a thread. One is worked out instead.
const SHORTEST_GRAIN: f64 = 0.020;
/// Share of the piece's height that a worked-out grain line takes.
const GRAIN_SHARE: f64 = 0.5;
/// Depth of a fold's bent arrow, and how far from the fold's ends it stands at most, metres.
const BENT: (f64, f64) = (0.020, 0.040);
/// Length of a pleat's lines from the edge, metres.
const PLEAT: f64 = 0.040;
/// Length of the barbs of arrows, metres.
const BARB: f64 = 0.004;
/// Length of the barbs of the grain's arrow, metres.
const GRAIN_BARB: f64 = 0.006;

/// Notches from the sewing lines of a drawing out to where its cloth, of which `room` is, ends, `width` metres off
/// where nothing else is drawn: over the mouth of a dart the cut line is raised.
pub(super) fn notches(drawing: &DrawnPiece, room: &Room, width: impl Fn(usize, usize) -> f64) -> Vec<NotchMark> {
    let mut marks = Vec::new();
    let mut add = |edge: (usize, usize), at: f64, kind: NotchKind| {
        let DrawnEdge { name, path, .. } = drawing.edge(edge);
        let (sewn, t) = (path.point(at), path.tangent(at));
        let out = Vec2::new(t.y, -t.x);
        let to_cut = room.way_off(sewn, out).unwrap_or_else(|| width(edge.0, edge.1));
        let inside = sewn - out * (NOTCH - to_cut).max(0.0);
        marks.push(NotchMark { at: sewn + out * to_cut, sewn, inside, kind, edge: name.clone() });
    };
    for notch in &drawing.notches {
        let length = drawing.edge(notch.edge).path.length();
        NotchKind::marks(notch.at, notch.double, length).for_each(|(at, kind)| add(notch.edge, at, kind));
    }
    for fold in &drawing.folds {
        add(fold.edge, fold.from, NotchKind::Pleat);
        add(fold.edge, fold.to, NotchKind::Pleat);
    }
    for dart in &drawing.darts {
        // The mouth of a dart is snipped where its legs leave the edge.
        let [one, other] = dart.legs;
        let count = drawing.rings[0].len();
        let (before, after) = ((one + count - 1) % count, (other + 1) % count);
        add((0, before), drawing.rings[0][before].path.length(), NotchKind::Dart);
        add((0, after), 0.0, NotchKind::Dart);
    }
    marks
}

/// The file's grain arrow, or one through the middle of the piece. On the cloth, of which `room` is, wherever the file
/// has drawn it.
pub(super) fn grain(drawing: &DrawnPiece, room: &Room) -> [Vec2; 2] {
    room.arrow(grain_as_drawn(drawing))
}

/// The double arrow of a grain line, drawn without lifting the pen.
pub fn grain_arrow([tail, head]: [Vec2; 2]) -> [Vec2; 8] {
    let ([a, b], [c, d]) = (barbs([head, tail], GRAIN_BARB), barbs([tail, head], GRAIN_BARB));
    [b, tail, a, tail, head, c, head, d]
}

/// An arrow with its two barbs, `size` long and as wide, drawn without lifting the pen.
pub fn arrow([tail, head]: [Vec2; 2], size: f64) -> [Vec2; 5] {
    let [a, b] = barbs([tail, head], size);
    [tail, head, a, head, b]
}

/// The tips of the barbs at the head of an arrow.
fn barbs([tail, head]: [Vec2; 2], size: f64) -> [Vec2; 2] {
    let along = (head - tail).try_normalize(0.0).unwrap_or_else(Vec2::y);
    let across = Vec2::new(-along.y, along.x);
    [0.5, -0.5].map(|side| head + (across * side - along) * size)
}

fn grain_as_drawn(drawing: &DrawnPiece) -> [Vec2; 2] {
    if let Some([tail, head]) = drawing.grain
        && (head - tail).norm() >= SHORTEST_GRAIN
    {
        return [tail, head];
    }
    let points: Vec<Vec2> = drawing.rings[0].iter().flat_map(|e| e.path.sampled(1e-4)).collect();
    let middle = points.iter().sum::<Vec2>() / points.len().max(1) as f64;
    let reach = points.iter().map(|p| drawing.warp.dot(&(p - middle)).abs()).fold(0.0, f64::max);
    let half = drawing.warp * (GRAIN_SHARE * reach).max(SHORTEST_GRAIN / 2.0);
    [middle - half, middle + half]
}

/// Arrows and inner lines.
pub(super) fn marks(drawing: &DrawnPiece, fold: Option<[Vec2; 2]>) -> Vec<Mark> {
    let mut marks: Vec<Mark> = drawing
        .lines
        .iter()
        .map(|l| Mark { kind: MarkKind::Line, name: l.name.clone(), path: l.path.clone(), line: Some(l.kind.clone()) })
        .collect();
    for fold in &drawing.folds {
        marks.extend(pleat(drawing, fold.edge, fold.from, fold.to));
    }
    if let (Some(fold), CutKind::Fold(name)) = (fold, &drawing.cut) {
        let path = bent_arrow(fold);
        marks.push(Mark { kind: MarkKind::Fold, name: name.clone(), path, line: None });
    }
    marks
}

/// The two lines of a fold of a pleat, from the edge inwards, and the arrow from where the cloth is folded to where the
/// fold comes to lie.
fn pleat(drawing: &DrawnPiece, edge: (usize, usize), from: f64, to: f64) -> Vec<Mark> {
    let path = &drawing.edge(edge).path;
    let inward = |at: f64| {
        let t = path.tangent(at);
        Vec2::new(-t.y, t.x)
    };
    let [one, other] = [from, to].map(|at| [path.point(at), path.point(at) + inward(at) * PLEAT]);
    let middle = |ends: [Vec2; 2]| (ends[0] + ends[1]) / 2.0;
    let arrow = Path::polyline(&arrow([middle(one), middle(other)], BARB));
    let mark = |kind, path: Path| Mark { kind, name: drawing.edge(edge).name.clone(), path, line: None };
    vec![
        mark(MarkKind::PleatFold, Path::line(one[0], one[1])),
        mark(MarkKind::PleatPlace, Path::line(other[0], other[1])),
        mark(MarkKind::PleatArrow, arrow),
    ]
}

/// Along the fold, both ends bent to it and barbed. The cloth lies to the right of `from → to`.
fn bent_arrow([from, to]: [Vec2; 2]) -> Path {
    let length = (to - from).norm();
    let along = (to - from).try_normalize(0.0).unwrap_or_else(Vec2::y);
    let inward = Vec2::new(-along.y, along.x) * BENT.0;
    let clear = along * (length / 5.0).min(BENT.1);
    let (one, other) = (from + clear, to - clear);
    let [[a, b], [c, d]] = [one, other].map(|at| barbs([at + inward, at], BARB));
    Path::polyline(&[a, one, b, one, one + inward, other + inward, other, c, other, d])
}

/// Tips of darts, ends and middle of fish-eyes, buttons.
pub(super) fn drills(drawing: &DrawnPiece) -> Vec<(String, Vec2)> {
    let tip = |d: &crate::pattern::Dart| ("dart".to_owned(), drawing.rings[0][d.legs[0]].path.end());
    let mut drills: Vec<(String, Vec2)> = drawing.darts.iter().map(tip).collect();
    for &ring in &drawing.fish_eyes {
        drills.extend(drawing.rings[ring].iter().map(|e| ("dart".to_owned(), e.path.start())));
    }
    drills.extend(drawing.points.iter().cloned());
    drills
}
