//! The fold of a piece: all of its edges that lie on one line, also where a notch or a neck opening interrupts it.

use nalgebra::Matrix2;

use super::Traced;
use super::edges::{FileEdge, edges};
use super::holes::Hole;
use super::{Fastener, ImportedNotch, InnerLine};
use crate::geometry::{Path, Vec2, mirrored};

/// A fold's ends are so near to those of an edge (metres).
const ON_FOLD: f64 = 1e-3;
/// Edges and grain of which the directions differ by no more (radians, a degree) run along each other.
const ASKEW: f64 = 0.0175;
/// A fold is drafted along the grain to this (radians, a fifth of a degree).
const DRAFTED: f64 = 0.0035;
/// The outline is square to a fold to this: the cosine of 84 degrees.
const SQUARE: f64 = 0.1;
/// Lines of less (metres) are none.
const NOTHING: f64 = 1e-8;

/// A line in which a piece is mirrored.
#[derive(Clone, Copy)]
struct MirrorLine {
    from: Vec2,
    along: Vec2,
}

impl MirrorLine {
    fn new([from, to]: [Vec2; 2]) -> Option<Self> {
        Some(Self { from, along: (to - from).try_normalize(0.0)? })
    }

    fn holds(self, p: Vec2) -> bool {
        self.along.perp(&(p - self.from)).abs() <= ON_FOLD
    }

    fn holds_edge(self, edge: &FileEdge) -> bool {
        edge.path.is_straight() && self.holds(edge.path.start()) && self.holds(edge.path.end())
    }

    fn image(self, p: Vec2) -> Vec2 {
        mirrored(p, self.from, self.along)
    }

    fn image_of(self, path: &Path) -> Path {
        let linear = 2.0 * self.along * self.along.transpose() - Matrix2::identity();
        path.mapped(linear, self.from - linear * self.from)
    }
}

/// The edges, those that follow each other on the fold as one.
pub(super) fn merged(mut edges: Vec<FileEdge>, fold: Option<[Vec2; 2]>) -> Vec<FileEdge> {
    let Some(axis) = fold.and_then(MirrorLine::new) else { return edges };
    let count = edges.len();
    let on = |edges: &[FileEdge], k: usize| axis.holds_edge(&edges[k % count]);
    // Begun where no part of the fold is cut in two.
    if let Some(begin) = (0..count).find(|&k| !(on(&edges, k) && on(&edges, k + count - 1))) {
        edges.rotate_left(begin);
    }
    let mut out: Vec<FileEdge> = Vec::new();
    for edge in edges {
        match out.last_mut() {
            Some(last) if axis.holds_edge(last) && axis.holds_edge(&edge) => {
                let before = last.path.length();
                last.path = Path::line(last.path.start(), edge.path.end());
                last.notches.extend(edge.notches.into_iter().map(|mut notch| {
                    notch.at += before;
                    notch
                }));
                let whole = last.path.length();
                last.notches.retain(|notch| notch.at < whole - ON_FOLD);
            }
            _ => out.push(edge),
        }
    }
    out
}

/// The edge that may lie on the fold where that is written on a piece and not drawn: one of that name, or the only
/// straight one that runs along the grain.
pub(super) fn written_fold(
    name: &str,
    count: usize,
    edges: &[FileEdge],
    grain: Option<[Vec2; 2]>,
    notes: &mut Vec<String>,
) -> Option<String> {
    let warp = grain.and_then(|[tail, head]| (head - tail).try_normalize(0.0));
    let is_along = |e: &&FileEdge| {
        let along = (e.path.end() - e.path.start()).try_normalize(0.0);
        e.path.is_straight() && warp.zip(along).is_none_or(|(warp, along)| warp.perp(&along).abs() <= ASKEW)
    };
    let called = edges.iter().find(|e| e.path.is_straight() && e.name.to_lowercase().contains("fold"));
    let along: Vec<&FileEdge> = edges.iter().filter(is_along).collect();
    let square: Vec<&FileEdge> = along.iter().copied().filter(|e| has_square_ends(edges, e)).collect();
    let off = |e: &FileEdge| {
        let along = (e.path.end() - e.path.start()).try_normalize(0.0);
        warp.unwrap_or(Vec2::y()).perp(&along.unwrap_or(Vec2::x())).abs()
    };
    let exact: Vec<&FileEdge> = square.iter().copied().filter(|e| off(e) <= DRAFTED).collect();
    let only = [along, square, exact].into_iter().find(|all| all.len() == 1).map(|all| all[0]);
    let fold = called.or(only).map(|e| e.name.clone());
    let more = if count > 1 {
        format!("; it is cut {count} times: write a piece 'like' it for each other")
    } else {
        String::new()
    };
    notes.push(match &fold {
        Some(edge) => format!("'{name}' is to be cut on the fold: its edge '{edge}' is taken for that{more}"),
        None => format!("'{name}' is to be cut on the fold: say at which edge, 'cut: fold EDGE'{more}"),
    });
    fold
}

/// Whether the outline turns by a right angle at both ends of an edge, as it does at a fold: the whole piece has no
/// corners there.
fn has_square_ends(edges: &[FileEdge], edge: &FileEdge) -> bool {
    let count = edges.len();
    let Some(k) = edges.iter().position(|own| std::ptr::eq(own, edge)) else { return false };
    let square = |a: &FileEdge, b: &FileEdge| {
        let (from, to) = (a.path.tangent(a.path.length()), b.path.tangent(0.0));
        from.dot(&to).abs() <= SQUARE
    };
    square(&edges[(k + count - 1) % count], edge) && square(edge, &edges[(k + 1) % count])
}

/// The name of the edge that lies on a fold: the longest.
pub(super) fn fold_edge(edges: &[FileEdge], fold: [Vec2; 2]) -> Option<String> {
    let axis = MirrorLine::new(fold)?;
    let longest = |a: &&FileEdge, b: &&FileEdge| a.path.length().total_cmp(&b.path.length());
    edges.iter().filter(|e| axis.holds_edge(e)).max_by(longest).map(|e| e.name.clone())
}

/// A piece whose fold is interrupted, as by a neck opening in its middle, as the whole piece that it is opened: its
/// opening goes all round then, which no half says. `None` of other pieces.
pub(super) fn opened(piece: &Traced) -> Option<Traced> {
    let fold = piece.mirror?;
    let axis = MirrorLine::new(fold)?;
    let outline = match (&piece.cut, piece.sew.is_empty()) {
        (Some(cut), true) => vec![(None, cut.clone())],
        _ => piece.sew.clone(),
    };
    let mut ring = merged(edges(&outline, &[]), Some(fold));
    let first = ring.iter().position(|e| axis.holds_edge(e))?;
    ring.rotate_left(first);
    let mut chains: Vec<Vec<FileEdge>> = Vec::new();
    for edge in ring {
        if axis.holds_edge(&edge) {
            chains.push(Vec::new());
        } else if let Some(chain) = chains.last_mut() {
            chain.push(edge);
        }
    }
    chains.retain(|chain| !chain.is_empty());
    let span = |chain: &Vec<FileEdge>| {
        let (start, end) = (chain[0].path.start(), chain[chain.len() - 1].path.end());
        axis.along.dot(&(end - start)).abs()
    };
    let outer = (0..chains.len()).max_by(|&a, &b| span(&chains[a]).total_cmp(&span(&chains[b])))?;
    if chains.len() < 2 {
        return None;
    }
    let rim = chains.remove(outer);
    let cut = piece.cut.as_ref().filter(|_| !piece.sew.is_empty()).map(|cut| cut.joined(&axis.image_of(cut)));
    let mut holes: Vec<Hole> = piece.holes.iter().flat_map(|h| [h.clone(), h.moved(|p| axis.image_of(p))]).collect();
    holes.extend(chains.iter().map(|chain| {
        let lines = whole_chain(chain, axis).into_iter().map(|(_, path)| path);
        let sew = lines.reduce(|line, next| line.joined(&next));
        Hole { name: None, sew: sew.unwrap_or_else(|| Path::line(fold[0], fold[1])), cut: cut.clone() }
    }));
    let aside = |p: Vec2| !axis.holds(p);
    let twice = |p: &Vec2| if aside(*p) { vec![*p, axis.image(*p)] } else { vec![*p] };
    let both = |line: &InnerLine| {
        [line.path.clone(), axis.image_of(&line.path)].map(|path| InnerLine { path, ..line.clone() })
    };
    Some(Traced {
        sew: whole_chain(&rim, axis),
        cut,
        holes,
        lines: piece.lines.iter().flat_map(both).collect(),
        points: piece.points.iter().flat_map(twice).collect(),
        fasteners: piece
            .fasteners
            .iter()
            .flat_map(|f| twice(&f.at).into_iter().map(|at| Fastener { at, ..*f }))
            .collect(),
        grain: piece.grain.or(piece.mirror),
        notches: piece.notches.iter().flat_map(|n| twice(&n.at)).map(|at| ImportedNotch { at, told: None }).collect(),
        mirror: None,
        on_fold: None,
        cut_how: None,
        ..piece.clone()
    })
}

/// Edges from the fold to the fold and their mirror images back, which close.
fn whole_chain(chain: &[FileEdge], axis: MirrorLine) -> Vec<(Option<String>, Path)> {
    let drawn = chain.iter().map(|e| (Some(format!("{}_l", e.name)), e.path.clone()));
    let images = chain.iter().rev().map(|e| (Some(format!("{}_r", e.name)), axis.image_of(&e.path).reversed()));
    let mut ring: Vec<(Option<String>, Path)> = drawn.chain(images).collect();
    let starts: Vec<Vec2> = ring.iter().map(|(_, path)| path.start()).collect();
    let count = ring.len();
    for (k, (_, path)) in ring.iter_mut().enumerate() {
        let next = starts[(k + 1) % count];
        if (path.end() - next).norm() > NOTHING {
            *path = path.joined(&Path::line(path.end(), next));
        }
    }
    ring
}
