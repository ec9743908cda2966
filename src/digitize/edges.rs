//! An outline as named edges.

use super::ImportedNotch;
use super::notches::{EdgeNotch, Notches};
use super::smooth::smoothed;
use crate::geometry::{Path, Vec2};
use crate::pattern::SHORTEST_EDGE;

/// A turn of more than this (radians, 20 degrees) between two segments is a corner.
pub(super) const CORNER: f64 = 0.35;
/// A path that turns at more places than this is no drawn line.
const MOST_CORNERS: usize = 400;
/// Splits nearer to each other than this (metres) are one.
const LEAST_EDGE: f64 = 3e-3;
/// Length up to which a drawn edge is a slip of the pen, metres: twice the length that cannot be meshed, because the
/// numbers of the file are rounded.
const SHORTEST: f64 = 2.0 * SHORTEST_EDGE;

/// An edge of the file to come.
#[derive(Clone, Debug)]
pub(super) struct FileEdge {
    pub(super) name: String,
    pub(super) path: Path,
    /// Notches on it, from its start.
    pub(super) notches: Vec<EdgeNotch>,
}

/// Number of the edge that two points together are nearest to.
pub(super) fn nearest_edge(edges: &[FileEdge], points: [Vec2; 2]) -> Option<usize> {
    let off = |k: &usize| points.iter().map(|p| edges[*k].path.nearest(*p).1).sum::<f64>();
    (0..edges.len()).min_by(|a, b| off(a).total_cmp(&off(b)))
}

/// An edge that may not have a name yet.
type Unnamed = (Option<String>, Path, Vec<EdgeNotch>);

/// Splits an outline at its corners and notches, and names unnamed edges: `a`, `b`, `c` … clockwise from the upper left
/// corner. Edges with names stay as they are, so that a garment drawn by toile keeps its edges.
pub(super) fn edges(outline: &[(Option<String>, Path)], notches: &[ImportedNotch]) -> Vec<FileEdge> {
    let clockwise = outline.iter().map(|e| e.1.double_area()).sum::<f64>() > 0.0;
    let mut turned: Vec<(Option<String>, Path)> = if clockwise {
        outline.to_vec()
    } else {
        outline.iter().rev().map(|(name, path)| (name.clone(), path.reversed())).collect()
    };
    turned.retain(|(_, path)| path.length() > SHORTEST);
    let notches = Notches::new(&turned, notches);
    let mut edges: Vec<Unnamed> = Vec::new();
    if let [(None, whole)] = turned.as_slice() {
        edges.extend(split_ring(whole, &notches));
    } else {
        let several = turned.len() > 1;
        for (k, (name, path)) in turned.iter().enumerate() {
            let corners = corners(path);
            if name.is_some() && (several || corners.is_empty()) {
                edges.push((name.clone(), path.clone(), notches.on(k, path)));
                continue;
            }
            let parts = split(path, &corners, &notches.on(k, path));
            let alone = parts.len() == 1;
            for (k, (part, notch)) in parts.into_iter().enumerate() {
                let name = name.as_ref().map(|n| if alone { n.clone() } else { format!("{n}_{}", k + 1) });
                edges.push((name, part, notch));
            }
        }
    }
    let first = (0..edges.len()).min_by(|&a, &b| {
        let low = |k: usize| edges[k].1.start().sum();
        low(a).total_cmp(&low(b))
    });
    edges.rotate_left(first.unwrap_or(0));
    named(edges)
}

/// A closed path without names: begun at one of its corners.
fn split_ring(whole: &Path, notches: &Notches) -> Vec<Unnamed> {
    let mut at = corners(whole);
    let closing = turn(whole.tangent(whole.length()), whole.tangent(0.0)) > CORNER;
    if closing || at.is_empty() {
        return split(whole, &at, &notches.on(0, whole)).into_iter().map(|(p, n)| (None, p, n)).collect();
    }
    let begin = at.remove(0);
    let length = whole.length();
    let turned = whole.part(begin, length).joined(&whole.part(0.0, begin));
    let at: Vec<f64> = at.iter().map(|s| s - begin).collect();
    split(&turned, &at, &notches.on(0, &turned)).into_iter().map(|(p, n)| (None, p, n)).collect()
}

/// Arc lengths at which a path turns.
fn corners(path: &Path) -> Vec<f64> {
    let found = turns(path);
    // A scanned or rough line turns everywhere and has no corners.
    if found.len() > MOST_CORNERS { Vec::new() } else { found }
}

fn turns(path: &Path) -> Vec<f64> {
    let stations = path.stations(0.0, 1e-3);
    let joints = path.joints();
    let turns = |k: &usize| match (stations[*k].last(), stations[k + 1].first()) {
        (Some(before), Some(after)) => turn(before.tangent, after.tangent) > CORNER,
        _ => false,
    };
    (0..stations.len().saturating_sub(1)).filter(turns).map(|k| joints[k + 1]).collect()
}

fn turn(before: Vec2, after: Vec2) -> f64 {
    before.perp(&after).atan2(before.dot(&after)).abs()
}

/// Parts of a path between corners and the notches that are nearest to it.
fn split(path: &Path, corners: &[f64], notches: &[EdgeNotch]) -> Vec<(Path, Vec<EdgeNotch>)> {
    let length = path.length();
    let mut cuts: Vec<(f64, Option<EdgeNotch>)> = corners.iter().map(|&s| (s, None)).collect();
    cuts.extend(notches.iter().map(|notch| (notch.at, Some(*notch))));
    cuts.push((length, None));
    cuts.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut parts: Vec<(Path, Option<EdgeNotch>)> = Vec::new();
    let mut from = 0.0;
    for (k, &(at, notch)) in cuts.iter().enumerate() {
        let last = k + 1 == cuts.len();
        if at - from < LEAST_EDGE || (!last && length - at < LEAST_EDGE) {
            // A notch at a corner marks the end of the edge before it.
            if let (Some(part), Some(_)) = (parts.last_mut(), notch) {
                part.1 = part.1.or(notch);
            }
            if !last {
                continue;
            }
        }
        if at - from >= LEAST_EDGE || parts.is_empty() {
            parts.push((path.part(from, at), notch));
        } else if let Some(part) = parts.last_mut() {
            part.0 = part.0.joined(&path.part(from, at));
        }
        from = at;
    }
    // The notches at which a line is split stand at the ends of its parts.
    let at_end = |(part, notch): (Path, Option<EdgeNotch>)| {
        let notch = notch.map(|notch| EdgeNotch { at: part.length(), ..notch });
        (part, notch.into_iter().collect())
    };
    parts.into_iter().map(at_end).collect()
}

fn named(edges: Vec<Unnamed>) -> Vec<FileEdge> {
    let mut taken: Vec<String> = Vec::new();
    let mut next = 0;
    let mut out = Vec::new();
    for (name, path, mut notches) in edges {
        let mut name = name.map(|n| super::file::word(&n)).filter(|n| super::file::is_usable(n) && !taken.contains(n));
        while name.is_none() {
            let made_up = letters(next);
            next += 1;
            name = (!taken.contains(&made_up)).then_some(made_up);
        }
        let name = name.unwrap_or_default();
        taken.push(name.clone());
        let smooth = smoothed(&path);
        let longer = smooth.length() / path.length();
        notches.iter_mut().for_each(|n| n.at *= longer);
        notches.sort_by(|a, b| a.at.total_cmp(&b.at));
        out.push(FileEdge { name, path: smooth, notches });
    }
    out
}

/// `a` to `z`, then `aa`.
fn letters(mut k: usize) -> String {
    let mut out = String::new();
    loop {
        out.insert(0, char::from(b'a' + (k % 26) as u8));
        if k < 26 {
            return out;
        }
        k = k / 26 - 1;
    }
}
