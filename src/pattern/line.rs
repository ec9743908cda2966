//! Lines inside a piece: folds, elastic and marks.

use super::along::{Along, along};
use super::diagnostic::{Findings, Located, Spot};
use super::draft::{Draft, shown};
use super::file::{LineFile, PieceFile};
use super::outline::whole_path;
use super::problem::Problem;
use super::region::{Region, first_off};
use super::value::Unit;
use super::{Line, LineKind};
use crate::geometry::{Path, Vec2, mirrored};
use crate::input::{did_you_mean, nearest};

/// Least length of a line that bends or gathers the cloth, metres. A shorter one is a slip of the pen, and would make
/// springs without length.
const SHORTEST_LINE: f64 = 1e-3;

/// Lines may run through darts, which are closed when lines are checked, and end anywhere on the cloth.
pub(super) fn lines(drawn: &mut Draft, whole: &Region, piece: &PieceFile, unit: Unit, findings: &mut Findings) {
    let across = drawn.fold.map(|fold| across(&drawn.rings[0][fold].path));
    let on_cloth = |p: Vec2| whole.holds(p) || across.as_ref().is_some_and(|across| whole.holds(across(p)));
    for file in &piece.lines {
        let names = || (drawn.name.clone(), file.name.value.clone());
        if let Some(contradiction) = contradiction(file) {
            let (piece, line) = names();
            findings.error(file.name.at, Problem::LineKind { piece, line, contradiction });
        }
        let kind = match kind(file) {
            Ok(kind) => kind,
            Err((at, problem)) => {
                findings.error(at, problem);
                continue;
            }
        };
        match whole_path(&file.path.value, unit.factor()) {
            Ok(path) => {
                let line = Line { name: file.name.value.clone(), path, kind };
                for problem in faults(drawn, &line, on_cloth) {
                    findings.error(file.path.at, problem);
                }
                drawn.lines.push(line);
            }
            Err(reason) => {
                let (piece, edge) = names();
                findings.error(file.path.at, Problem::BadPath { piece, edge, reason });
            }
        }
    }
}

/// Kind of a line. An impossible fold angle or share is a problem, with its place.
fn kind(file: &LineFile) -> Result<LineKind, (Spot, Problem)> {
    let out_of = |number: &Located<f64>, what: &str, expected| {
        (number.at, Problem::OutOfRange { what: what.to_owned(), expected, found: number.value.to_string() })
    };
    match (&file.fold, &file.ratio) {
        (Some(angle), _) => {
            LineKind::fold(angle.value).ok_or_else(|| out_of(angle, "fold", "between -180 and 180 degrees"))
        }
        (None, Some(ratio)) => LineKind::elastic(ratio.value)
            .ok_or_else(|| out_of(ratio, "ratio", "between 0.05 and 1, the length drawn in over that cut")),
        (None, None) => {
            Ok(LineKind::Mark(file.kind.as_ref().map_or_else(|| "mark".to_owned(), |kind| kind.value.clone())))
        }
    }
}

/// Faults of a line's position.
fn faults(drawn: &Draft, line: &Line, on_cloth: impl Fn(Vec2) -> bool) -> Vec<Problem> {
    let names = || (drawn.name.clone(), line.name.clone());
    let mut faults = Vec::new();
    if let Some(off) = first_off(&line.path, on_cloth) {
        let (piece, line) = names();
        faults.push(Problem::LineOff { piece, line, near: shown(off) });
    }
    let length = line.path.length();
    if length < SHORTEST_LINE && !matches!(line.kind, LineKind::Mark(_)) {
        let (piece, line) = names();
        let (length, least) = ((length * 1e6).round() / 1e3, SHORTEST_LINE * 1e3);
        faults.push(Problem::LineShort { piece, line, length, least });
    }
    // Beyond the edge on which a piece is cut folded there is more of it.
    let outer = |on: &Along| drawn.fold != Some(on.edge.1) || on.edge.0 != 0;
    if line.kind.hinge().is_some()
        && let Some(on) = along(&line.path, &drawn.rings).into_iter().find(outer)
    {
        let (piece, line) = names();
        faults.push(Problem::FoldOnEdge { piece, line, edge: drawn.rings[on.edge.0][on.edge.1].name.clone() });
    }
    faults
}

/// Contradiction within a line. Kinds are free words, but `elastic` and `fold` draw in or crease the cloth, and need a
/// number.
fn contradiction(line: &LineFile) -> Option<String> {
    let kind = line.kind.as_ref().map(|k| k.value.as_str());
    match (kind, &line.fold, &line.ratio) {
        (_, Some(_), Some(_)) => Some("has both a fold angle and a ratio; make it two lines".to_owned()),
        (Some("elastic"), _, None) => {
            Some("is elastic and does not say to what share it draws in; add 'ratio: 0.8'".to_owned())
        }
        (Some("fold"), None, _) => Some("is a fold and does not say its angle; add 'fold: 180'".to_owned()),
        (Some(kind), _, Some(_)) if kind != "elastic" => {
            Some(format!("has a ratio and is of kind '{kind}'; only 'kind: elastic' has one"))
        }
        (Some(kind), None, None) => {
            let meant = nearest(kind, ["elastic", "fold"])?;
            Some(format!("is of kind '{kind}'{}", did_you_mean(Some(meant))))
        }
        _ => None,
    }
}

/// The reflection across a straight edge.
fn across(edge: &Path) -> impl Fn(Vec2) -> Vec2 + use<> {
    let (start, along) = (edge.start(), (edge.end() - edge.start()).normalize());
    move |p| mirrored(p, start, along)
}
