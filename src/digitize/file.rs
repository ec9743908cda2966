//! The garment file of traced pieces.

use super::buttons::with_buttons;
use super::darts::{ClosedDart, closed};
use super::edges::{FileEdge, edges, nearest_edge};
use super::fasteners::{Fastened, closures};
use super::fish_eyes::taken;
use super::folds::{fold_edge, merged, opened, written_fold};
use super::hands::handed;
use super::holes::Hole;
use super::lozenge::FishEye;
use super::materials::{declared, name_of};
use super::notches::EdgeNotch;
use super::pairs::paired;
use super::sizes::size_note;
use super::stated::{at_no_place, file_point};
use super::suggest::{Guess, Outline, Suggestion, suggest};
use super::{Material, Traced};
use crate::geometry::{MM, Path, Vec2};
use crate::pattern::{
    AllowanceFile, AllowanceWidth, Corner, CutKind, DartFile, DartShape, GarmentFile, LineFile, LineKind, Located,
    NotchFile, OutlineFile, PieceFile, PlaceFile, PleatFile, Quantity, SLACK, Side, Value,
};

/// Widest allowance that is measured (metres): farther apart, two lines have nothing to do with each other.
const WIDEST: f64 = 0.1;
/// Places along an edge where its allowance is measured, as shares of its length.
const LOOKS: [f64; 3] = [0.4, 0.5, 0.6];
/// Largest difference of these measurements, metres. With a larger one the cut line does not run along the edge: it
/// passes the mouth of a dart.
const ALONG: f64 = 2e-3;
/// Distance within which a point is a notch or the tip of a dart, metres.
const ON_NOTCH: f64 = 5e-4;
/// Length of the line that stands for a drill hole, metres: one on the rim of the cloth, where a patch is tacked down,
/// has its ends no farther off than lines may be.
const DRILL: f64 = SLACK;
/// Longest name.
const LONGEST: usize = 40;

/// A garment file, with notes on it.
#[derive(Clone, Debug)]
pub struct Digitized {
    /// All edges free, no seams.
    pub file: GarmentFile,
    /// Edges that may belong together.
    pub suggestions: Vec<Suggestion>,
    /// Notes on assumptions about things that the drawing does not tell.
    pub notes: Vec<String>,
}

/// Makes a garment file of traced pieces. `title` is its name.
pub fn garment_file(title: &str, traced: &[Traced]) -> Digitized {
    let mut notes = Vec::new();
    let mut names: Vec<String> = Vec::new();
    let (mut pieces, mut outlines, mut told, mut fastened) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    // Before pairs are: the buttons of one half meet the buttonholes of the other.
    let traced: Vec<Traced> = traced.iter().map(|p| with_buttons(p).unwrap_or_else(|| p.clone())).collect();
    let traced = paired(&traced);
    let fabrics = declared(&traced, &mut notes);
    for piece in &traced {
        let name = fresh(&piece.name, &names);
        names.push(name.clone());
        let whole = opened(piece);
        if whole.is_some() {
            notes.push(format!(
                "the fold of '{name}' is interrupted: the piece is opened, with the opening as a hole, and cut once"
            ));
        }
        let piece = whole.as_ref().unwrap_or(piece);
        let piece = handed(piece.at_origin(), &name, &mut notes);
        let (mut file, edges) = piece_file(&name, &piece, &mut notes);
        fastened.push(Fastened::new(&file, &piece.fasteners));
        // The only fabric is that of every piece.
        file.fabric = piece.material.as_ref().filter(|_| fabrics.len() > 1).map(|m| at_no_place(name_of(m)));
        let fold = fold_of(&file).map(str::to_owned);
        let pair = file.cut.as_ref().is_some_and(|cut| cut.value == CutKind::Pair);
        let copies = copies(&file, piece.copies, &mut names, &mut notes);
        let allowances = edges.iter().map(|e| width_of(&file, &e.name)).collect();
        // A piece without grain is taken as running down the drawing.
        let arrow = file.grain.as_ref().map(|g| Vec2::from(g.value[1]) - Vec2::from(g.value[0]));
        let warp = arrow.map_or(Some(Vec2::y()), |arrow| arrow.try_normalize(0.0));
        let material = piece.material.as_ref().map(name_of);
        let mirrored = pair || fold.is_some();
        let single = file.cut.as_ref().is_none_or(|cut| cut.value == CutKind::One) && piece.copies <= 1;
        told.push((name.clone(), piece.drawn.is_some()));
        let size = piece.size;
        outlines.push(Outline { piece: name, edges, allowances, fold, pair, mirrored, single, warp, material, size });
        pieces.push(file);
        pieces.extend(copies);
    }
    let (suggestions, guesses) = suggest(outlines);
    for ((name, told), mut guess) in told.into_iter().zip(guesses) {
        guess.drawn = guess.drawn.filter(|side| *side == Side::Right && !told);
        let own = pieces.iter_mut().find(|piece| piece.name.value == name);
        notes.extend(own.and_then(|piece| guessed(piece, guess)));
    }
    let file = GarmentFile {
        alter: Vec::new(),
        sizes: Vec::new(),
        version: at_no_place(1),
        name: Some(at_no_place(title.to_owned())),
        about: Vec::new(),
        units: None,
        body: None,
        body_measures: Vec::new(),
        body_units: None,
        allowance: None,
        fabrics: fabrics.into_iter().map(|d| (at_no_place(d.name), at_no_place(Value::Text(d.cloth)))).collect(),
        pieces,
        seams: Vec::new(),
        closures: closures(&fastened, &mut notes),
        free: vec![at_no_place("*.*".to_owned())],
        tests: Vec::new(),
    };
    Digitized { file, suggestions, notes }
}

/// The further pieces of one that is cut several times over, each like it.
fn copies(piece: &PieceFile, count: usize, names: &mut Vec<String>, notes: &mut Vec<String>) -> Vec<PieceFile> {
    let mut copies = Vec::new();
    for _ in 1..count {
        let name = fresh(&piece.name.value, names);
        names.push(name.clone());
        copies.push(PieceFile::like(at_no_place(name), at_no_place(piece.name.value.clone())));
    }
    if let Some(last) = copies.last() {
        let (name, last) = (&piece.name.value, &last.name.value);
        let cut = if copies.len() == 1 { format!("'{last}' is") } else { format!("pieces up to '{last}' are") };
        notes.push(format!("'{name}' is cut {count} times as a pair, {count} left and {count} right: {cut} like it"));
    }
    copies
}

/// A name made of the characters that a garment file allows: letters, digits, `_` and `-`.
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

fn piece_file(name: &str, piece: &Traced, notes: &mut Vec<String>) -> (PieceFile, Vec<FileEdge>) {
    let (fish_eyes, piece) = taken(piece, ON_NOTCH, notes);
    let piece = &piece;
    let outline = match (&piece.cut, piece.sew.is_empty()) {
        (Some(cut), true) => {
            notes.push(format!("'{name}' has only a cut line: it is taken as the sewing line, with no allowance"));
            vec![(None, cut.clone())]
        }
        _ => piece.sew.clone(),
    };
    let (outline, wedges) = closed(&outline);
    let mut edges = merged(edges(&outline, &piece.notches), piece.mirror);
    let mut darts: Vec<DartFile> = wedges.iter().filter_map(|wedge| dart(wedge, &mut edges)).collect();
    darts.extend(fish_eyes.iter().map(fish_eye));
    let pleats: Vec<PleatFile> = piece.pleats.iter().filter_map(|ends| pleat(*ends, &mut edges)).collect();
    notes.extend(untold(name, piece));
    // What lies on the fold of the cloth lies along the warp.
    let grain = piece.grain.or(piece.mirror);
    let drawn_fold = piece.mirror.and_then(|mirror| fold_edge(&edges, mirror));
    let fold = drawn_fold.or_else(|| written_fold(name, piece.on_fold?, &edges, grain, notes));
    for other in piece.more_folds.iter().filter_map(|ends| fold_edge(&edges, *ends)) {
        if let Some(fold) = fold.as_ref().filter(|fold| **fold != other) {
            notes.push(format!(
                "'{name}' lies on two folds: its edge '{fold}' is mirrored, its edge '{other}' is not; draw it opened \
                 at one of them"
            ));
        }
    }
    let cut = fold.map(CutKind::Fold).or(piece.cut_how.clone());
    let whole = piece.cut.as_ref().filter(|_| !piece.sew.is_empty());
    let holes = named_holes(&piece.holes, &edges);
    let file = PieceFile {
        name: at_no_place(name.to_owned()),
        like: None,
        fabric: None,
        allowance: whole.and_then(|line| allowance(&edges, &wedges, &holes, line, &cut, &piece.corners)),
        drawn: piece.drawn.filter(|_| matches!(cut, Some(CutKind::Pair | CutKind::Fold(_)))).map(at_no_place),
        cut: cut.map(at_no_place),
        layer: None,
        grain: grain.map(|g| at_no_place(g.map(file_point))),
        place: None,
        outline: Some(outline_file(&edges)),
        notches: notches(&edges),
        darts,
        pleats,
        holes: holes.iter().map(|(name, hole)| (at_no_place(name.clone()), at_no_place(ring(&hole.sew)))).collect(),
        lines: lines(piece, &wedges),
        note: noted(piece).map(at_no_place),
    };
    (file, edges)
}

/// Writes into a piece what is guessed of it and not told, and says so.
fn guessed(piece: &mut PieceFile, guess: Guess) -> Option<String> {
    let mut said = Vec::new();
    let halves = piece.cut.as_ref().is_some_and(|cut| matches!(cut.value, CutKind::Pair | CutKind::Fold(_)));
    if let Some(side) = guess.drawn.filter(|_| halves) {
        said.push(format!("'drawn: {}'", side.letter()));
        piece.drawn = Some(at_no_place(side));
    }
    if let Some(words) = guess.place.filter(|_| piece.place.is_none()) {
        said.push(format!("'place: {words}'"));
        piece.place = Some(at_no_place(PlaceFile::Words(words)));
    }
    (!said.is_empty()).then(|| format!("guessed of '{}': {}", piece.name.value, said.join(" and ")))
}

/// The allowance of an edge, metres.
fn width_of(piece: &PieceFile, edge: &str) -> Option<f64> {
    let width = match piece.allowance.as_ref()? {
        AllowanceFile::All(all) => all.value,
        AllowanceFile::Edges(edges) => edges.iter().find(|(name, _)| name.value == edge)?.1.value,
    };
    Some(width.width.number / MM)
}

/// The edge on the fold of the cloth, which nothing is sewn to.
fn fold_of(piece: &PieceFile) -> Option<&str> {
    match &piece.cut.as_ref()?.value {
        CutKind::Fold(edge) => Some(edge),
        _ => None,
    }
}

/// The note of a piece: its number, its material and its size in the drawing, for which a garment file has no key.
fn noted(piece: &Traced) -> Option<String> {
    let number = piece.number.as_ref().map(|number| format!("no. {} of the drawing", plain(number)));
    let size = piece.size_name.as_ref().map(|size| size_note(&plain(size)));
    let said: Vec<String> = number.into_iter().chain(piece.material.as_ref().and_then(note)).chain(size).collect();
    (!said.is_empty()).then(|| said.join(", "))
}

/// The drawing's own words for a material whose name in the file is another.
fn note(material: &Material) -> Option<String> {
    (name_of(material) != material.name).then(|| format!("material: {}", plain(&material.name)))
}

/// Note on lines inside a piece whose purpose the drawing does not tell.
fn untold(name: &str, piece: &Traced) -> Option<String> {
    let count = piece.lines.iter().filter(|line| line.kind.is_none()).count();
    let (lines, are) = if count == 1 { ("line", "is") } else { ("lines", "are") };
    (count > 0).then(|| {
        format!(
            "{count} {lines} inside '{name}' {are} taken as marks, for the drawing does not say what they do; give a \
             fold its 'fold: 180', elastic its 'kind: elastic' and 'ratio', and write darts and pleats as such"
        )
    })
}

fn outline_file(edges: &[FileEdge]) -> OutlineFile {
    let start = edges.first().map_or([0.0; 2], |e| file_point(e.path.start()));
    let edge = |e: &FileEdge| (at_no_place(e.name.clone()), at_no_place(e.path.to_svg(MM, false)));
    OutlineFile { start: at_no_place(start), edges: edges.iter().map(edge).collect() }
}

fn notches(edges: &[FileEdge]) -> Vec<(Located<String>, Vec<Located<NotchFile>>)> {
    let mut all = Vec::new();
    for edge in edges.iter().filter(|e| !e.notches.is_empty()) {
        // Never past the end: the file's numbers are rounded.
        let most = ((edge.path.length() * MM - 1e-5) * 1e4).floor() / 1e4;
        let notch = |&EdgeNotch { at, double, .. }: &EdgeNotch| {
            let at = Quantity { number: ((at * MM * 1e4).round() / 1e4).min(most), unit: None };
            at_no_place(NotchFile { at, double })
        };
        all.push((at_no_place(edge.name.clone()), edge.notches.iter().map(notch).collect()));
    }
    all
}

/// The holes under their own names, or numbered, none named as an edge.
fn named_holes<'a>(holes: &'a [Hole], edges: &[FileEdge]) -> Vec<(String, &'a Hole)> {
    let mut named: Vec<(String, &Hole)> = Vec::new();
    for (k, hole) in holes.iter().enumerate() {
        let own = hole.name.as_deref().map(word).filter(|w| is_usable(w));
        let mut name = own.unwrap_or_else(|| format!("hole{}", k + 1));
        while edges.iter().any(|e| e.name == name) || named.iter().any(|(taken, _)| *taken == name) {
            name.push('_');
        }
        named.push((name, hole));
    }
    named
}

/// A closed path as text.
fn ring(path: &Path) -> String {
    format!("{} Z", path.to_svg(MM, true))
}

/// A length in millimetres, to a tenth of a micrometre.
fn millimetres(metres: f64) -> Located<Quantity> {
    at_no_place(Quantity { number: (metres * MM * 1e4).round() / 1e4, unit: None })
}

/// A dart that was closed, without the notches at its mouth, which it has by itself.
fn dart(wedge: &ClosedDart, edges: &mut [FileEdge]) -> Option<DartFile> {
    let (edge, at, intake) = wedge.on(edges)?;
    let name = edge.name.clone();
    unnotch(edges, &name, [at - intake / 2.0, at + intake / 2.0]);
    let tip = Some(at_no_place(file_point(wedge.tip)));
    let shape = DartShape::Edge { edge: at_no_place(name), at: millimetres(at), length: None, tip };
    Some(DartFile { name: Some(at_no_place(word(&wedge.name))), intake: millimetres(intake), shape })
}

fn fish_eye(dart: &FishEye) -> DartFile {
    let (up, down) = (millimetres(dart.up), millimetres(dart.down));
    let shape = DartShape::FishEye { at: at_no_place(file_point(dart.at)), up, down };
    DartFile { name: Some(at_no_place(word(&dart.name))), intake: millimetres(dart.intake), shape }
}

/// A knife pleat that is folded at the first point and brought to the second, without the notches there. (Box and
/// inverted pleats are two of them.)
fn pleat(ends: [Vec2; 2], edges: &mut [FileEdge]) -> Option<PleatFile> {
    let on = nearest_edge(edges, ends)?;
    let [fold, place] = ends.map(|p| edges[on].path.nearest(p).0);
    let depth = (place - fold).abs() / 2.0;
    if depth <= ON_NOTCH {
        return None;
    }
    // Brought back along the edge it points to its end.
    let before = edges[(on + edges.len() - 1) % edges.len()].name.clone();
    let toward = (fold > place).then(|| at_no_place(before));
    let name = edges[on].name.clone();
    unnotch(edges, &name, [fold, place]);
    let (at, depth) = (vec![millimetres(fold.min(place))], millimetres(depth));
    Some(PleatFile { edge: at_no_place(name), at, depth, kind: None, toward, sewn: None })
}

/// Takes the notches at these places off an edge, if they are not told to be others.
fn unnotch(edges: &mut [FileEdge], name: &str, places: [f64; 2]) {
    for edge in edges.iter_mut().filter(|e| e.name == name) {
        let is_there = |notch: &EdgeNotch| places.iter().any(|place| (notch.at - place).abs() <= ON_NOTCH);
        edge.notches.retain(|notch| !(notch.may_be_mouth && is_there(notch)));
    }
}

fn lines(piece: &Traced, wedges: &[ClosedDart]) -> Vec<LineFile> {
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
    let is_tip = |p: &Vec2| wedges.iter().any(|w| (w.tip - p).norm() <= ON_NOTCH);
    for &p in piece.points.iter().filter(|p| !is_tip(p)) {
        let half = Vec2::new(DRILL / 2.0, 0.0);
        lines.push(add("drill", &Path::line(p - half, p + half), LineKind::Mark("drill".to_owned())));
    }
    lines
}

/// The longest stretch of an edge beside the mouths of its darts.
fn clear_of_mouths(edge: &FileEdge, edges: &[FileEdge], wedges: &[ClosedDart]) -> [f64; 2] {
    let on_it = wedges.iter().filter_map(|w| w.on(edges)).filter(|(e, ..)| e.name == edge.name);
    let mut mouths: Vec<[f64; 2]> = on_it.map(|(_, at, intake)| [at - intake / 2.0, at + intake / 2.0]).collect();
    mouths.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let begins = std::iter::once(0.0).chain(mouths.iter().map(|m| m[1]));
    let ends = mouths.iter().map(|m| m[0]).chain([edge.path.length()]);
    let longer = |a: &[f64; 2], b: &[f64; 2]| (a[1] - a[0]).total_cmp(&(b[1] - b[0]));
    begins.zip(ends).map(|(from, to)| [from, to]).max_by(longer).unwrap_or_default()
}

/// Relative accuracy of the width of cut lines that programs draw along curves and beside short edges.
const INEXACT: f64 = 0.15;
/// Length of an edge, in widths of its allowance, below which it is short.
const SHORT: f64 = 5.0;

/// The width that was meant where one was measured (millimetres) beside a bent or a short edge: that of the straight,
/// long edges whose is nearly the same, of several the nearest.
fn meant(edge: &FileEdge, width: f64, all: &[(&FileEdge, f64)]) -> f64 {
    let is_sure = |e: &FileEdge, w: f64| e.path.is_straight() && e.path.length() * MM >= SHORT * w;
    if is_sure(edge, width) {
        return width;
    }
    let sure = all.iter().filter(|(e, w)| is_sure(e, *w) && (w - width).abs() <= INEXACT * w).map(|(_, w)| *w);
    sure.min_by(|a, b| (a - width).abs().total_cmp(&(b - width).abs())).unwrap_or(width)
}

/// The distance of the cut line from every edge and hole, in tenths of a millimetre.
fn allowance(
    edges: &[FileEdge],
    wedges: &[ClosedDart],
    holes: &[(String, &Hole)],
    cut: &Path,
    how: &Option<CutKind>,
    corners: &[(String, Corner)],
) -> Option<AllowanceFile> {
    let on_fold = |e: &FileEdge| matches!(how, Some(CutKind::Fold(name)) if *name == e.name);
    let tenths = |metres: f64| (metres * 1e4).round() / 10.0;
    let width = |e: &FileEdge| {
        // Round the middle: near its ends the neighbours' cut lines, or that over a dart, may be nearer than its own.
        let [from, to] = clear_of_mouths(e, edges, wedges);
        let mut looks = LOOKS.map(|share| cut.nearest(e.path.point(from + (to - from) * share)).1);
        looks.sort_by(f64::total_cmp);
        let along = looks[LOOKS.len() - 1] - looks[0] <= ALONG;
        along.then(|| tenths(looks[LOOKS.len() / 2]))
    };
    let said = |number: f64, corner| at_no_place(AllowanceWidth { width: Quantity { number, unit: None }, corner });
    let corner = |edge: &str| corners.iter().find(|(name, _)| word(name) == edge).map(|(_, corner)| *corner);
    type Width<'a> = (&'a str, f64);
    let measured: Vec<(&FileEdge, f64)> =
        edges.iter().filter(|e| !on_fold(e)).filter_map(|e| Some((e, width(e)?))).collect();
    let outline: Vec<Width> = measured.iter().map(|(e, w)| (e.name.as_str(), meant(e, *w, &measured))).collect();
    let cut_out = holes.iter().map(|(name, hole)| (name.as_str(), tenths(hole.allowance())));
    let cut_out: Vec<Width> = cut_out.filter(|(_, w)| *w > 0.0).collect();
    if outline.iter().any(|(_, w)| w / MM > WIDEST) {
        return None;
    }
    let first = outline.first()?.1;
    // A hole has an allowance only where that is said of it.
    if cut_out.is_empty() && outline.iter().all(|(name, w)| *w == first && corner(name).is_none()) {
        return Some(AllowanceFile::All(said(first, None)));
    }
    let edge = |(name, w): &Width| (at_no_place((*name).to_owned()), said(*w, corner(name)));
    Some(AllowanceFile::Edges(outline.iter().chain(&cut_out).map(edge).collect()))
}
