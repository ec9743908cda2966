//! The state of a garment file as the page shows it: pieces as drawn, seams, problems, and what can be chosen.

use std::path::Path as FilePath;

use serde::Serialize;
use serde_json::{Value, json};

use super::acts::told;
use super::names::{bare, label};
use super::wanted::{SPACINGS, Wanted};
use crate::digitize::suggestions;
use crate::fabric;
use crate::geometry::{MM, Path, Vec2};
use crate::io::garment::{KeyPath, Variant, read_file_only, scalars};
use crate::mannequin::{self, measure_names};
use crate::pattern::{
    CutKind, Diagnostic, GarmentFile, PieceFile, PlaceFile, PlaceWord, Severity, fabrics, glob, parse_quantity,
    whole_pieces,
};
use crate::pipeline::check_text;

/// Number of problems that the page lists. The count of the rest is the last of them.
const MOST_PROBLEMS: usize = 200;
/// Seams that are offered at a time.
const MOST_OFFERS: usize = 40;

/// A file as the page shows it.
pub(super) struct View {
    pub(super) json: Value,
    /// Whether a garment can be made of it.
    pub(super) is_sound: bool,
}

/// A problem of the file.
#[derive(Serialize)]
struct ProblemView {
    error: bool,
    line: usize,
    column: usize,
    message: String,
    hint: Option<String>,
    /// Pieces that it is about, as far as its line tells.
    pieces: Vec<String>,
}

/// A piece as drawn.
#[derive(Serialize)]
struct PieceView {
    name: String,
    like: Option<String>,
    cut: String,
    place: Option<String>,
    fabric: Option<String>,
    edges: Vec<EdgeView>,
    /// Lines and holes inside, as SVG paths in mm.
    lines: Vec<String>,
    grain: Option<[[f64; 2]; 2]>,
}

/// An edge as drawn.
#[derive(Serialize)]
struct EdgeView {
    name: String,
    /// SVG path, mm.
    path: String,
    /// mm
    length: f64,
    /// Point in the middle, mm.
    middle: [f64; 2],
    seams: Vec<String>,
    free: bool,
    fold: bool,
}

/// A length that can be typed.
#[derive(Serialize)]
struct LengthView {
    path: KeyPath,
    label: String,
    value: String,
}

/// Shows a file. One that is no garment yet is shown as far as it can be read.
pub(super) fn view(file: &FilePath, text: &str, unreadable: Option<&str>, wanted: &Wanted) -> View {
    let shown = file.display().to_string();
    let said = read_file_only(&shown, text).ok();
    let wanted = wanted.of(said.as_ref());
    let variant = Variant { size: wanted.size.as_deref(), alter: &[] };
    let checked = check_text(file, text, variant, Some(wanted.spacing / MM));
    let mut problems: Vec<ProblemView> = match &checked {
        Ok(checked) => problems(&checked.loaded.warnings, said.as_ref()),
        Err(refused) => problems(&refused.diagnostics, said.as_ref()),
    };
    if let Some(why) = unreadable {
        let message = format!("{shown}: {why}; this is the file as it was before");
        problems.insert(0, ProblemView { error: true, line: 0, column: 0, message, hint: None, pieces: Vec::new() });
    }
    let no_body = said.as_ref().is_some_and(|said| said.body.is_none());
    if no_body && checked.is_ok() {
        let message = "nothing to dress: choose a body".to_owned();
        problems.insert(0, ProblemView { error: true, line: 0, column: 0, message, hint: None, pieces: Vec::new() });
    }
    let is_sound = checked.is_ok() && unreadable.is_none() && !no_body;
    let mut json = json!({
        "file": shown,
        "sound": is_sound,
        "problems": problems,
        "spacing": wanted.spacing,
        "spacings": SPACINGS,
        "size": wanted.size,
        "measures": measure_names().collect::<Vec<_>>(),
        "bodies": mannequin::library(),
        "cloths": fabric::library(),
        "words": PlaceWord::all().map(PlaceWord::name).collect::<Vec<_>>(),
    });
    if let (Some(said), Value::Object(map)) = (&said, &mut json)
        && let Value::Object(statements) = statements(said, text)
    {
        map.extend(statements);
    }
    View { json, is_sound }
}

/// All that the file says.
fn statements(said: &GarmentFile, text: &str) -> Value {
    let pieces = whole_pieces(said);
    let used: Vec<Value> = fabrics(said).iter().map(|f| json!({ "name": f.name, "cloth": f.cloth() })).collect();
    let seams: Vec<Value> = said
        .seams
        .iter()
        .map(|seam| json!({ "name": seam.name.value, "sew": values(&seam.sew), "to": values(&seam.to) }))
        .collect();
    let offers: Vec<Value> = suggestions(said)
        .iter()
        .take(MOST_OFFERS)
        .map(|s| json!({ "name": s.name, "sew": s.sew, "to": s.to, "reason": s.reason() }))
        .collect();
    json!({
        "title": said.name.as_ref().map(|name| &name.value),
        "body": said.body.as_ref().map(|body| &body.value),
        "fabrics": used,
        "pieces": pieces.iter().map(|piece| shown(piece, said)).collect::<Vec<_>>(),
        "seams": seams,
        "free": values(&said.free),
        "suggestions": offers,
        "lengths": lengths(text),
        "sizes": said.sizes.iter().map(|size| &size.name.value).collect::<Vec<_>>(),
        "alterations": said.alter.iter().map(|own| told(&own.value)).collect::<Vec<_>>(),
    })
}

fn values(list: &[crate::pattern::Located<String>]) -> Vec<&str> {
    list.iter().map(|item| item.value.as_str()).collect()
}

fn shown(piece: &PieceFile, said: &GarmentFile) -> PieceView {
    let metres = said.unit().factor();
    let name = piece.name.value.clone();
    let mut edges = Vec::new();
    if let Some(outline) = &piece.outline {
        let mut at = Vec2::from(outline.start.value);
        for (edge, commands) in &outline.edges {
            let Ok(path) = Path::parse(at, &commands.value, metres) else { break };
            at = path.end() / metres;
            edges.push(edge_view(&name, &edge.value, &path, piece, said));
        }
    }
    let inner = piece.holes.iter().map(|hole| &hole.1).chain(piece.lines.iter().map(|line| &line.path));
    let inner = inner.filter_map(|text| Path::parse_absolute(&text.value, metres).ok());
    PieceView {
        like: piece.like.as_ref().map(|like| like.value.clone()),
        cut: match piece.cut.as_ref().map(|cut| &cut.value) {
            None | Some(CutKind::One) => "once".to_owned(),
            Some(CutKind::Pair) => "as a pair".to_owned(),
            Some(CutKind::Fold(edge)) => format!("on the fold at {edge}"),
            Some(CutKind::Count(times)) => format!("{times} times"),
        },
        place: piece.place.as_ref().map(|place| match &place.value {
            PlaceFile::Words(words) => words.clone(),
            PlaceFile::At { at: [x, y, z], .. } => format!("at {x}, {y}, {z}"),
        }),
        fabric: piece.fabric.as_ref().map(|fabric| fabric.value.clone()),
        lines: inner.map(|path| path.to_svg(MM, true)).collect(),
        grain: piece.grain.as_ref().map(|grain| grain.value.map(|p| p.map(|x| x * metres * MM))),
        edges,
        name,
    }
}

fn edge_view(piece: &str, edge: &str, path: &Path, file: &PieceFile, said: &GarmentFile) -> EdgeView {
    let full = format!("{piece}.{edge}");
    let takes = |list: &[crate::pattern::Located<String>]| list.iter().any(|own| bare(&own.value) == full);
    let own = said.seams.iter().filter(|seam| takes(&seam.sew) || takes(&seam.to));
    let middle = path.point(0.5 * path.length()) * MM;
    EdgeView {
        name: edge.to_owned(),
        path: path.to_svg(MM, true),
        length: path.length() * MM,
        middle: [middle.x, middle.y],
        seams: own.map(|seam| seam.name.value.clone()).collect(),
        free: said.free.iter().any(|free| glob(&bare(&free.value), &full)),
        fold: file.cut.as_ref().is_some_and(|cut| cut.value == CutKind::Fold(edge.to_owned())),
    }
}

fn problems(found: &[Diagnostic], said: Option<&GarmentFile>) -> Vec<ProblemView> {
    let shown = |d: &Diagnostic| ProblemView {
        error: d.severity == Severity::Error,
        line: d.line,
        column: d.column,
        message: d.message.clone(),
        hint: d.hint.clone(),
        pieces: said.map(|said| pieces_at(said, d.line)).unwrap_or_default(),
    };
    found.iter().take(MOST_PROBLEMS).map(shown).collect()
}

/// The pieces that a line of the file is about: the one that it stands in, or those of the seam.
fn pieces_at(said: &GarmentFile, line: usize) -> Vec<String> {
    let mut marks: Vec<(usize, Vec<String>)> = Vec::new();
    marks.extend(said.pieces.iter().map(|piece| (piece.name.at.line, vec![piece.name.value.clone()])));
    for seam in &said.seams {
        let piece = |edge: &str| edge.split('.').next().unwrap_or_default().to_owned();
        let mut names: Vec<String> = seam.sew.iter().chain(&seam.to).map(|edge| piece(&edge.value)).collect();
        names.dedup();
        names.retain(|name| said.pieces.iter().any(|piece| piece.name.value == *name));
        marks.push((seam.name.at.line, names));
    }
    let others = said.free.iter().map(|free| free.at.line).chain(said.tests.iter().map(|test| test.at.line));
    let others = others.chain(said.alter.iter().map(|alter| alter.at.line));
    let others = others.chain(said.fabrics.iter().map(|fabric| fabric.0.at.line));
    let others = others.chain(said.body.iter().map(|body| body.at.line));
    let others = others.chain(said.closures.iter().map(|closure| closure.kind.at.line));
    marks.extend(others.map(|line| (line, Vec::new())));
    let above = marks.into_iter().filter(|(first, _)| *first <= line && *first > 0);
    above.max_by_key(|(first, _)| *first).map(|(_, names)| names).unwrap_or_default()
}

/// The lengths of the file that stand alone: ease and allowances, measures of the wearer, amounts of alterations.
fn lengths(text: &str) -> Vec<LengthView> {
    let shown = |(path, value): (KeyPath, String)| {
        let label = label(&path)?;
        parse_quantity(&value).ok().map(|_| LengthView { path, label, value })
    };
    scalars(text).into_iter().filter_map(shown).collect()
}
