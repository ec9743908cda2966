//! Makes pieces as cut from drawn pieces.
//!
//! A pair is `front.L` and `front.R`. The one that is not drawn is the drawing mirrored at x = 0. A piece on the fold
//! is one piece: the fold edge vanishes, every other edge is there twice, `side.L` and `side.R`. A mirrored outline is
//! walked the other way round, so that it is clockwise again. Its edges keep their names. `cut: 3` makes `tab.1` to
//! `tab.3`.

use nalgebra::Matrix2;

use super::draft::{Draft, DrawnStretch};
use super::place_word::{PlaceMeaning, PlaceWord};
use super::problem::Problem;
use super::value::{CutKind, Side};
use super::{Edge, EdgeId, FoldAxis, Line, Notch, Piece, Place, Span};
use crate::geometry::{Path, Vec2};

/// A drawing as it lies in a cut piece: the whole piece, or one half of a folded one.
#[derive(Clone, Debug)]
pub(super) struct Instance {
    /// Index of the drawing.
    pub(super) draft: usize,
    /// Index of the cut piece.
    pub(super) piece: usize,
    pub(super) side: Option<Side>,
    /// From 1.
    pub(super) copy: Option<usize>,
    /// Whether its edges run against the drawing's.
    pub(super) mirrored: bool,
    /// Drawing to piece: `p ↦ linear · p + shift`.
    linear: Matrix2<f64>,
    shift: Vec2,
    /// Cut edge of every drawn edge. A fold edge has none.
    edges: Vec<Vec<Option<EdgeId>>>,
}

/// Suffix of the name of a piece that is cut more than once: `.L`, `.2`, or nothing.
pub(super) fn suffix(side: Option<Side>, copy: Option<usize>) -> String {
    match (side, copy) {
        (Some(side), _) => side.suffix().to_owned(),
        (None, Some(copy)) => format!(".{copy}"),
        (None, None) => String::new(),
    }
}

impl Instance {
    /// Suffix that distinguishes it from the other pieces of its drawing: `.L`, `.2`, or nothing.
    pub(super) fn suffix(&self) -> String {
        suffix(self.side, self.copy)
    }

    /// A point of the drawing in the cut piece.
    pub(super) fn point(&self, p: Vec2) -> Vec2 {
        self.linear * p + self.shift
    }

    /// Cut edge of an edge of the drawing.
    pub(super) fn edge(&self, (ring, index): (usize, usize)) -> Option<EdgeId> {
        self.edges[ring][index]
    }

    /// A stretch of the drawing on the cut piece, walked the same way as on the drawing.
    pub(super) fn span(&self, draft: &Draft, s: DrawnStretch) -> Option<Span> {
        let edge = self.edge(s.edge)?;
        let length = draft.length(s.edge);
        let turn = |x: f64| if self.mirrored { length - x } else { x };
        Some(Span { edge, from: turn(s.from), to: turn(s.to) })
    }
}

/// Everything that is cut.
#[derive(Debug, Default)]
pub(super) struct Pieces {
    pub(super) pieces: Vec<Piece>,
    pub(super) instances: Vec<Instance>,
}

/// Cuts every drawing.
pub(super) fn cut(drafts: &[Draft], default_fabric: &str) -> Pieces {
    let mut out = Pieces::default();
    for (i, draft) in drafts.iter().enumerate() {
        let fabric = draft.fabric.as_ref().map_or(default_fabric, |f| &f.value);
        match draft.cut {
            CutKind::One => out.add_whole(i, draft, fabric, None, None),
            CutKind::Count(n) => (1..=n).for_each(|copy| out.add_whole(i, draft, fabric, None, Some(copy))),
            CutKind::Pair => {
                let sides = [draft.drawn, draft.drawn.other()];
                sides.into_iter().for_each(|side| out.add_whole(i, draft, fabric, Some(side), None));
            }
            CutKind::Fold(_) => out.add_folded(i, draft, fabric),
        }
    }
    out
}

fn across_x() -> Matrix2<f64> {
    Matrix2::new(-1.0, 0.0, 0.0, 1.0)
}

impl Pieces {
    /// The error for a reference to one that is not among the pieces (or halves) cut from a drawing.
    pub(super) fn not_cut(&self, reference: &str, index: usize, draft: &Draft) -> Problem {
        let cut = self.instances.iter().filter(|i| i.draft == index);
        let known: Vec<String> = cut.map(|i| format!("{}{}", draft.name, i.suffix())).collect();
        Problem::NotCut { reference: reference.to_owned(), known: known.join(", ") }
    }

    fn add_whole(&mut self, index: usize, draft: &Draft, fabric: &str, side: Option<Side>, copy: Option<usize>) {
        let piece = self.pieces.len();
        let mirrored = side.is_some_and(|side| side != draft.drawn);
        let linear = if mirrored { across_x() } else { Matrix2::identity() };
        let count = |ring: usize| draft.rings[ring].len();
        let place_of = |ring: usize, i: usize| if mirrored { count(ring) - 1 - i } else { i };
        let edges = (0..draft.rings.len())
            .map(|ring| (0..count(ring)).map(|i| Some(EdgeId { piece, ring, index: place_of(ring, i) })).collect())
            .collect();
        let instance = Instance { draft: index, piece, side, copy, mirrored, linear, shift: Vec2::zeros(), edges };
        let loops = draft.rings.iter().map(|r| transformed(r, &instance)).collect();
        self.pieces.push(Piece {
            name: format!("{}{}", draft.name, instance.suffix()),
            drawn_as: draft.name.clone(),
            side,
            fold: None,
            fabric: fabric.to_owned(),
            layer: draft.layer,
            beneath: 0,
            warp: linear * draft.warp,
            loops,
            lines: draft.lines.iter().map(|l| line(l, &instance)).collect(),
            notches: notches(draft, &instance),
            place: place(draft.place.as_ref(), side, mirrored),
        });
        self.instances.push(instance);
    }

    fn add_folded(&mut self, index: usize, draft: &Draft, fabric: &str) {
        let Some(fold) = draft.fold else { return };
        let piece = self.pieces.len();
        let axis = &draft.rings[0][fold].path;
        let (linear, shift) = reflection(axis.start(), axis.end());
        let half = |mirrored: bool| Instance {
            draft: index,
            piece,
            side: Some(if mirrored { draft.drawn.other() } else { draft.drawn }),
            copy: None,
            mirrored,
            linear: if mirrored { linear } else { Matrix2::identity() },
            shift: if mirrored { shift } else { Vec2::zeros() },
            edges: folded_edges(draft, piece, fold, mirrored),
        };
        let halves = [half(false), half(true)];
        self.pieces.push(Piece {
            name: draft.name.clone(),
            drawn_as: draft.name.clone(),
            side: None,
            fold: Some(fold_axis(draft, axis)),
            fabric: fabric.to_owned(),
            layer: draft.layer,
            beneath: 0,
            warp: draft.warp,
            loops: folded_loops(draft, &halves, fold),
            lines: folded_lines(draft, &halves, axis),
            notches: halves.iter().flat_map(|h| notches(draft, h)).collect(),
            place: place(draft.place.as_ref(), None, false),
        });
        self.instances.extend(halves);
    }
}

/// The fold of a piece. A ring runs clockwise on screen, so that the drawn half lies on its right, where y points down.
fn fold_axis(draft: &Draft, fold: &Path) -> FoldAxis {
    let along = (fold.end() - fold.start()).normalize();
    let into_drawn = Vec2::new(-along.y, along.x);
    let left = if draft.drawn == Side::Left { into_drawn } else { -into_drawn };
    FoldAxis { on: fold.start(), left }
}

/// The reflection across the line through `a` and `b`.
fn reflection(a: Vec2, b: Vec2) -> (Matrix2<f64>, Vec2) {
    let u = (b - a).normalize();
    let linear = 2.0 * u * u.transpose() - Matrix2::identity();
    (linear, a - linear * a)
}

/// The edges of a ring in a cut piece, clockwise again if mirrored.
fn transformed(ring: &[Edge], to: &Instance) -> Vec<Edge> {
    let moved =
        ring.iter().map(|e| Edge { path: e.path.mapped(to.linear, to.shift), against: to.mirrored, ..e.clone() });
    if to.mirrored { super::outline::reversed(&moved.collect::<Vec<_>>()) } else { moved.collect() }
}

fn folded_edges(draft: &Draft, piece: usize, fold: usize, mirrored: bool) -> Vec<Vec<Option<EdgeId>>> {
    let holes = draft.rings.len() - 1;
    let outline = draft.rings[0].len();
    let id = |ring, index| Some(EdgeId { piece, ring, index });
    // The cut outline runs through the drawn half from the end of the fold to its start and back through the other.
    let rim = |i: usize| {
        let place = (i + outline - fold - 1) % outline;
        match (i == fold, mirrored) {
            (true, _) => None,
            (false, false) => id(0, place),
            (false, true) => id(0, 2 * (outline - 1) - 1 - place),
        }
    };
    let mut all = vec![(0..outline).map(rim).collect()];
    for ring in 1..=holes {
        let count = draft.rings[ring].len();
        all.push((0..count).map(|i| if mirrored { id(ring + holes, count - 1 - i) } else { id(ring, i) }).collect());
    }
    all
}

fn folded_loops(draft: &Draft, halves: &[Instance; 2], fold: usize) -> Vec<Vec<Edge>> {
    let sided = |half: &Instance, ring: Vec<Edge>| -> Vec<Edge> {
        let suffix = half.side.map_or("", Side::letter);
        ring.into_iter().map(|e| Edge { name: format!("{}.{suffix}", e.name), ..e }).collect()
    };
    let mut open = draft.rings[0].clone();
    open.rotate_left(fold);
    open.remove(0);
    let mut outline = sided(&halves[0], transformed(&open, &halves[0]));
    outline.extend(sided(&halves[1], transformed(&open, &halves[1])));
    let mut loops = vec![outline];
    for half in halves {
        loops.extend(draft.rings[1..].iter().map(|ring| sided(half, transformed(ring, half))));
    }
    loops
}

fn line(line: &Line, to: &Instance) -> Line {
    Line { name: line.name.clone(), path: line.path.mapped(to.linear, to.shift), kind: line.kind.clone() }
}

/// Lines of both halves. A line that ends on the fold goes on into the other half as one.
fn folded_lines(draft: &Draft, halves: &[Instance; 2], axis: &Path) -> Vec<Line> {
    let along = (axis.end() - axis.start()).normalize();
    let on_fold = |p: Vec2| along.perp(&(p - axis.start())).abs() < 1e-6;
    let mut lines = Vec::new();
    for drawn in &draft.lines {
        let other = line(drawn, &halves[1]);
        let joined = |path: Path| Line { name: drawn.name.clone(), path, kind: drawn.kind.clone() };
        if on_fold(drawn.path.start()) && on_fold(drawn.path.end()) {
            lines.push(drawn.clone());
        } else if on_fold(drawn.path.start()) {
            lines.push(joined(other.path.reversed().joined(&drawn.path)));
        } else if on_fold(drawn.path.end()) {
            lines.push(joined(drawn.path.joined(&other.path.reversed())));
        } else {
            for (half, l) in halves.iter().zip([drawn.clone(), other]) {
                let suffix = half.side.map_or("", Side::letter);
                lines.push(Line { name: format!("{}.{suffix}", l.name), ..l });
            }
        }
    }
    lines
}

fn notches(draft: &Draft, to: &Instance) -> Vec<Notch> {
    let notch = |&(edge, at, double): &((usize, usize), f64, bool)| {
        let span = to.span(draft, DrawnStretch { edge, from: at, to: at })?;
        Some(Notch { edge: span.edge, at: span.from, double })
    };
    draft.notches.iter().filter_map(notch).collect()
}

fn place(place: Option<&Place>, side: Option<Side>, mirrored: bool) -> Option<Place> {
    Some(match place? {
        Place::Around { words } => {
            let mut words = words.clone();
            let says = |meanings: [PlaceMeaning; 2]| words.iter().any(|w| meanings.contains(&w.meaning()));
            // A pair shares its words. On a limb they mean the piece's own side.
            let limb = says([PlaceMeaning::Arm, PlaceMeaning::Leg]) && !says([PlaceMeaning::Left, PlaceMeaning::Right]);
            if let Some(side) = side.filter(|_| limb) {
                words.insert(0, if side == Side::Left { PlaceWord::Left } else { PlaceWord::Right });
            }
            Place::Around { words }
        }
        Place::At { at, turn } if mirrored => Place::At {
            at: at.component_mul(&nalgebra::vector![-1.0, 1.0, 1.0]),
            turn: turn.component_mul(&nalgebra::vector![1.0, -1.0, -1.0]),
        },
        at => at.clone(),
    })
}
