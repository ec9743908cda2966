//! The garment file of traced pieces.

use super::Traced;
use super::edges::{Edge, edges};
use super::pairs::paired;
use super::suggest::{Suggestion, suggest};
use crate::geometry::{Path, Vec2};
use crate::pattern::{
    AllowanceFile, AllowanceWidth, Cut, GarmentFile, LineFile, LineKind, Located, NotchFile, OutlineFile, PieceFile,
    Quantity, Spot,
};

/// Millimetres per metre.
const MM: f64 = 1e3;
/// A fold's ends are so near to those of an edge (metres).
const ON_FOLD: f64 = 1e-3;
/// Widest allowance that is measured (metres): farther apart, two lines have nothing to do with each other.
const WIDEST: f64 = 0.1;
/// Where along an edge its allowance is measured.
const LOOKS: [f64; 3] = [0.4, 0.5, 0.6];
/// Where these differ by more (metres), the cut line does not run along the edge: it passes the mouth of a dart.
const ALONG: f64 = 2e-3;
/// Length of the line that stands for a drill hole, metres.
const DRILL: f64 = 2e-3;
/// Longest name.
const LONGEST: usize = 40;

/// A garment file, and what there is to say about it.
#[derive(Clone, Debug)]
pub struct Digitized {
    /// All edges free, no seams.
    pub file: GarmentFile,
    /// Edges that may belong together.
    pub suggestions: Vec<Suggestion>,
    /// What was taken for something that the drawing does not say.
    pub notes: Vec<String>,
}

/// Makes a garment file of traced pieces; `title` is its name.
pub fn garment_file(title: &str, traced: &[Traced]) -> Digitized {
    let mut notes = Vec::new();
    let mut names: Vec<String> = Vec::new();
    let (mut pieces, mut outlines) = (Vec::new(), Vec::new());
    for piece in &paired(traced) {
        let name = fresh(&piece.name, &names);
        names.push(name.clone());
        let (file, edges) = piece_file(&name, &piece.at_origin(), &mut notes);
        outlines.push((name, edges, matches!(&file.cut, Some(c) if c.value == Cut::Pair)));
        pieces.push(file);
    }
    let file = GarmentFile {
        version: at_no_place(1),
        name: Some(at_no_place(title.to_owned())),
        about: Vec::new(),
        units: None,
        body: None,
        allowance: None,
        fabrics: Vec::new(),
        pieces,
        seams: Vec::new(),
        closures: Vec::new(),
        free: vec![at_no_place("*.*".to_owned())],
        tests: Vec::new(),
    };
    Digitized { file, suggestions: suggest(&outlines), notes }
}

fn at_no_place<T>(value: T) -> Located<T> {
    Located::new(value, Spot::default())
}

/// Letters, digits, `_` and `-`: what a name in a garment file may be made of.
pub(super) fn word(name: &str) -> String {
    let kept = |c: char| if c.is_alphanumeric() || c == '-' { c } else { '_' };
    let word: String = name.trim().chars().map(kept).take(LONGEST).collect();
    word.trim_matches('_').to_owned()
}

/// Text without control characters, which YAML does not take.
fn plain(text: &str) -> String {
    text.chars().filter(|c| !c.is_control()).take(LONGEST).collect()
}

/// Whether a garment file takes it as a name of an edge, a piece or a line.
pub(super) fn is_usable(name: &str) -> bool {
    !name.is_empty() && !["L", "R", "mirror", "all", "start"].contains(&name) && name.parse::<f64>().is_err()
}

fn fresh(name: &str, taken: &[String]) -> String {
    let word = word(name);
    let stem = if is_usable(&word) { word } else { format!("piece{word}") };
    let mut fresh = if stem == "piece" { "piece1".to_owned() } else { stem.clone() };
    let mut again = 2;
    while taken.contains(&fresh) {
        fresh = format!("{stem}{}{again}", if stem == "piece" { "" } else { "_" });
        again += 1;
    }
    fresh
}

fn piece_file(name: &str, piece: &Traced, notes: &mut Vec<String>) -> (PieceFile, Vec<Edge>) {
    let outline = match (&piece.cut, piece.sew.is_empty()) {
        (Some(cut), true) => {
            notes.push(format!("'{name}' has only a cut line: it is taken as the sewing line, with no allowance"));
            vec![(None, cut.clone())]
        }
        _ => piece.sew.clone(),
    };
    let edges = edges(&outline, &piece.notches);
    // What lies on the fold of the cloth lies along the warp.
    let grain = piece.grain.or(piece.mirror);
    let fold = piece.mirror.and_then(|mirror| fold_edge(&edges, mirror));
    let cut = fold.map(Cut::Fold).or(piece.cut_how.clone());
    let whole = piece.cut.as_ref().filter(|_| !piece.sew.is_empty());
    let file = PieceFile {
        name: at_no_place(name.to_owned()),
        like: None,
        fabric: None,
        allowance: whole.and_then(|line| allowance(&edges, line, &cut)),
        drawn: piece.drawn.filter(|_| cut == Some(Cut::Pair)).map(at_no_place),
        cut: cut.map(at_no_place),
        layer: None,
        grain: grain.map(|g| at_no_place(g.map(file_point))),
        place: None,
        outline: Some(outline_file(&edges)),
        notches: notches(&edges),
        darts: Vec::new(),
        pleats: Vec::new(),
        holes: numbered("hole", &piece.holes, &edges),
        lines: lines(piece),
        note: piece.fabric.as_ref().map(|f| at_no_place(format!("material: {}", plain(f)))),
    };
    (file, edges)
}

/// Ten nanometres in a millimetre file: nobody's rounding, and short.
fn rounded(x: f64) -> f64 {
    let r = (x * 1e5).round() / 1e5;
    if r == 0.0 { 0.0 } else { r }
}

fn file_point(p: Vec2) -> [f64; 2] {
    [rounded(p.x * MM), rounded(p.y * MM)]
}

fn outline_file(edges: &[Edge]) -> OutlineFile {
    let start = edges.first().map_or([0.0; 2], |e| file_point(e.path.start()));
    let edge = |e: &Edge| (at_no_place(e.name.clone()), at_no_place(e.path.to_svg(MM, false)));
    OutlineFile { start: at_no_place(start), edges: edges.iter().map(edge).collect() }
}

fn notches(edges: &[Edge]) -> Vec<(Located<String>, Vec<Located<NotchFile>>)> {
    let mut all = Vec::new();
    for edge in edges.iter().filter(|e| !e.notches.is_empty()) {
        // Never past the end: the file's numbers are rounded.
        let most = ((edge.path.length() * MM - 1e-5) * 1e4).floor() / 1e4;
        let notch = |&(at, double): &(f64, bool)| {
            let at = Quantity { number: ((at * MM * 1e4).round() / 1e4).min(most), unit: None };
            at_no_place(NotchFile { at, double })
        };
        all.push((at_no_place(edge.name.clone()), edge.notches.iter().map(notch).collect()));
    }
    all
}

fn numbered(stem: &str, paths: &[Path], edges: &[Edge]) -> Vec<(Located<String>, Located<String>)> {
    let name = |k: usize| {
        let name = format!("{stem}{}", k + 1);
        if edges.iter().any(|e| e.name == name) { format!("{name}_") } else { name }
    };
    let text = |p: &Path| format!("{} Z", p.to_svg(MM, true));
    paths.iter().enumerate().map(|(k, p)| (at_no_place(name(k)), at_no_place(text(p)))).collect()
}

fn lines(piece: &Traced) -> Vec<LineFile> {
    let mut taken: Vec<String> = Vec::new();
    let mut add = |stem: &str, path: &Path, kind: LineKind| {
        let mut name = stem.to_owned();
        let mut again = 2;
        while taken.contains(&name) {
            name = format!("{stem}{again}");
            again += 1;
        }
        taken.push(name.clone());
        let (mut fold, mut ratio) = (None, None);
        let kind = match kind {
            LineKind::Fold(angle) => {
                fold = Some(at_no_place((angle.to_degrees() * 1e3).round() / 1e3));
                None
            }
            LineKind::Elastic(share) => {
                ratio = Some(at_no_place(share));
                Some("elastic".to_owned())
            }
            LineKind::Mark(kind) => Some(kind),
        };
        let path = at_no_place(path.to_svg(MM, true));
        LineFile { name: at_no_place(name), path, fold, kind: kind.map(at_no_place), ratio }
    };
    let mut lines = Vec::new();
    for line in &piece.lines {
        let stem = line.name.as_deref().map(word).filter(|w| is_usable(w)).unwrap_or_else(|| "line".to_owned());
        lines.push(add(&stem, &line.path, line.kind.clone().unwrap_or_else(|| LineKind::Mark("mark".to_owned()))));
    }
    for &p in &piece.points {
        let half = Vec2::new(DRILL / 2.0, 0.0);
        lines.push(add("drill", &Path::line(p - half, p + half), LineKind::Mark("drill".to_owned())));
    }
    lines
}

/// The edge that lies on the mirror line.
fn fold_edge(edges: &[Edge], [from, to]: [Vec2; 2]) -> Option<String> {
    let along = (to - from).try_normalize(0.0)?;
    let on = |p: Vec2| along.perp(&(p - from)).abs() <= ON_FOLD;
    let lies = |e: &&Edge| e.path.is_straight() && on(e.path.start()) && on(e.path.end());
    let longest = |a: &&Edge, b: &&Edge| a.path.length().total_cmp(&b.path.length());
    edges.iter().filter(lies).max_by(longest).map(|e| e.name.clone())
}

/// The distance of the cut line from every edge, in tenths of a millimetre.
fn allowance(edges: &[Edge], cut: &Path, how: &Option<Cut>) -> Option<AllowanceFile> {
    let on_fold = |e: &Edge| matches!(how, Some(Cut::Fold(name)) if *name == e.name);
    let width = |e: &Edge| {
        // Round its middle: near its ends the neighbours' cut lines may be nearer than its own.
        let mut looks = LOOKS.map(|share| cut.nearest(e.path.point(e.path.length() * share)).1);
        looks.sort_by(f64::total_cmp);
        let along = looks[LOOKS.len() - 1] - looks[0] <= ALONG;
        along.then(|| (looks[LOOKS.len() / 2] * 1e4).round() / 10.0)
    };
    let said = |number: f64| at_no_place(AllowanceWidth { width: Quantity { number, unit: None }, corner: None });
    let widths: Vec<(&Edge, f64)> = edges.iter().filter(|e| !on_fold(e)).filter_map(|e| Some((e, width(e)?))).collect();
    if widths.iter().any(|(_, w)| w / MM > WIDEST) {
        return None;
    }
    let first = widths.first()?.1;
    if widths.iter().all(|(_, w)| *w == first) {
        return Some(AllowanceFile::All(said(first)));
    }
    let edge = |(e, w): &(&Edge, f64)| (at_no_place(e.name.clone()), said(*w));
    Some(AllowanceFile::Edges(widths.iter().map(edge).collect()))
}
