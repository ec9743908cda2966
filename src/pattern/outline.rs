//! The outline of a piece as the file writes it, edge by edge: read, closed, clockwise.

use std::collections::HashSet;

use super::Edge;
use super::diagnostic::{Findings, Spot};
use super::draft::shown;
use super::file::OutlineFile;
use super::problem::Problem;
use super::value::Unit;
use crate::geometry::{Path, Vec2};

/// Distance by which a drawn outline may miss its start, metres: rounding of the file's numbers.
pub(super) const CLOSURE: f64 = 5e-5;
/// Widest gap of an outline that is bridged, metres. It is still an error, but the rest of the piece is checked in the
/// same run. A wider gap is a missing side, without which other checks would report false faults.
const BRIDGED: f64 = 0.02;
/// Longest edge, metres. A longer one is in another unit or a slip of the pen, and would take for ever to process.
const LONGEST_EDGE: f64 = 200.0;

/// Reads the outline's edges: closed, clockwise, every name once.
pub(super) fn outline(piece: &str, file: &OutlineFile, unit: Unit, findings: &mut Findings) -> Option<Vec<Edge>> {
    let scale = unit.factor();
    let start = Vec2::from(file.start.value);
    let mut at = start;
    let mut edges: Vec<Edge> = Vec::new();
    let mut seen = HashSet::new();
    let mut sound = true;
    for (name, commands) in &file.edges {
        if !seen.insert(name.value.as_str()) {
            findings.error(name.at, Problem::EdgeTwice { piece: piece.to_owned(), edge: name.value.clone() });
        }
        match edge_path(at, &commands.value, scale) {
            Ok(path) => {
                at = path.end() / scale;
                edges.push(Edge { name: name.value.clone(), path, against: false });
            }
            Err(reason) => {
                let (piece, edge) = (piece.to_owned(), name.value.clone());
                findings.error(commands.at, Problem::BadPath { piece, edge, reason });
                sound = false;
            }
        }
    }
    if !sound {
        return None;
    }
    let Some(last) = edges.last() else {
        findings.error(file.start.at, Problem::NoOutline(piece.to_owned()));
        return None;
    };
    let (end, first) = (last.path.end(), start * scale);
    let gap = (end - first).norm();
    if gap > CLOSURE {
        let at = file.edges.last().map_or(file.start.at, |e| e.1.at);
        let (last, start) = (shown(end), shown(first));
        findings.error(at, Problem::NotClosed { piece: piece.to_owned(), last, start, gap: gap * 1e3 });
        if gap > BRIDGED {
            return None;
        }
    }
    let closed = ended_at(&last.path, edges[0].path.start());
    if let Some(last) = edges.last_mut() {
        last.path = closed;
    }
    orient(piece, edges, file.start.at, findings)
}

/// Refuses numbers with units of their own, which would be read as commands.
fn check_units(commands: &str) -> Result<(), String> {
    let is_number = |before: &str| before.trim_end().ends_with(|c: char| c.is_ascii_digit() || c == '.');
    let is_word = |after: &str| after.starts_with(|c: char| c.is_ascii_alphabetic());
    let found = ["mm", "cm", "in"].into_iter().find(|unit| {
        commands.match_indices(unit).any(|(k, _)| is_number(&commands[..k]) && !is_word(&commands[k + 2..]))
    });
    match found {
        Some(unit) => Err(format!(
            "a number of '{commands}' has the unit {unit}; in a path all numbers are in the file's units ('units: cm' \
             makes them centimetres)"
        )),
        None => Ok(()),
    }
}

fn edge_path(at: Vec2, commands: &str, scale: f64) -> Result<Path, String> {
    check_units(commands)?;
    if commands.contains(['M', 'm', 'Z', 'z']) {
        return Err("an edge goes on from the one before it; use L, C, Q or A, without M or Z".to_owned());
    }
    // SVG's own words would show the `M` that is put in front: say what the file has.
    let path = Path::parse(at, commands, scale).map_err(|e| match e {
        crate::geometry::PathError::Syntax(_) => {
            format!("cannot read '{commands}'; expected commands L C Q A with numbers")
        }
        crate::geometry::PathError::NotFinite(_) => format!("'{commands}' holds a number that is not finite"),
        crate::geometry::PathError::Empty(_) if commands.contains(['A', 'a']) => {
            format!("'{commands}' has no length; an arc ends elsewhere than it starts, a circle takes two")
        }
        crate::geometry::PathError::Empty(_) => format!("'{commands}' has no length"),
    })?;
    check_size(path)
}

/// A path with its own `M`.
pub(super) fn whole_path(commands: &str, scale: f64) -> Result<Path, String> {
    check_units(commands)?;
    Path::parse_absolute(commands, scale).map_err(|e| e.to_string()).and_then(check_size)
}

fn check_size(path: Path) -> Result<Path, String> {
    if path.length() > LONGEST_EDGE {
        let length = path.length();
        let shown = if length < 1e6 { format!("{length:.0}") } else { format!("{length:.1e}") };
        return Err(format!("it is {shown} m long; at most {LONGEST_EDGE} m are read"));
    }
    Ok(path)
}

/// The path changed by a hair, so that it ends exactly at `end`. One that comes back to its start, as a circle does,
/// has no chord to turn: its second half is taken.
pub(super) fn ended_at(path: &Path, end: Vec2) -> Path {
    let length = path.length();
    if path.end() == end || (path.end() - path.start()).norm() > length / 2.0 {
        return turned_to(path, end);
    }
    path.part(0.0, length / 2.0).joined(&turned_to(&path.part(length / 2.0, length), end))
}

/// The path turned and scaled about its start, so that it ends at `end`.
fn turned_to(path: &Path, end: Vec2) -> Path {
    let (a, b) = (path.end() - path.start(), end - path.start());
    let square = a.norm_squared();
    if a == b || square == 0.0 {
        return path.clone();
    }
    let (cos, sin) = (a.dot(&b) / square, a.perp(&b) / square);
    let linear = nalgebra::Matrix2::new(cos, -sin, sin, cos);
    path.mapped(linear, path.start() - linear * path.start())
}

fn orient(piece: &str, mut edges: Vec<Edge>, at: Spot, findings: &mut Findings) -> Option<Vec<Edge>> {
    let double_area: f64 = edges.iter().map(|e| e.path.double_area()).sum();
    if double_area.abs() < 1e-9 {
        findings.error(at, Problem::NoArea(piece.to_owned()));
        return None;
    }
    if double_area < 0.0 {
        findings.warn(at, Problem::CounterClockwise(piece.to_owned()));
        edges = reversed(&edges);
    }
    Some(edges)
}

/// The ring walked the other way.
pub(super) fn reversed(ring: &[Edge]) -> Vec<Edge> {
    ring.iter().rev().map(|e| Edge { path: e.path.reversed(), ..e.clone() }).collect()
}
