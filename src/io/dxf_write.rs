//! Patterns for cutting as DXF-AAMA (ASTM D6673): what cutters and pattern programs of the trade exchange.
//!
//! One block per piece, inserted once; layers are numbers (see [`layer`]). The dialect is DXF R12 as text, with neither
//! tables nor layout blocks, which the trade's readers do not expect. Coordinates are millimetres, y up; units are said
//! in the style's text, for DXF R12 has no place for them. Curves are polylines; a point on layer 2 or 3 says of each
//! of their vertices whether the line turns or runs smoothly there. Small texts on the lines tell
//! names of edges, folds, elastic, darts, pleats and kinds of notches, for which the standard has no layer.

use std::fmt::Write as _;

use super::dxf_told::{Told, notch_text, place};
use crate::cutting::{MarkKind, NotchMark, Paper, SewKind};
use crate::geometry::{MM, Path, Vec2};
use crate::pattern::LineKind;

/// The standard's layers.
pub mod layer {
    /// Cut line, and the texts that name the style and the piece.
    pub const BOUNDARY: u32 = 1;
    /// Vertices at which a line turns, and its ends.
    pub const TURN: u32 = 2;
    /// The other vertices.
    pub const CURVE: u32 = 3;
    /// Notches.
    pub const NOTCH: u32 = 4;
    /// The line in which a half piece is mirrored.
    pub const MIRROR: u32 = 6;
    /// Grain.
    pub const GRAIN: u32 = 7;
    /// Lines inside, not cut.
    pub const INTERNAL: u32 = 8;
    /// The holes of a piece.
    pub const CUTOUT: u32 = 11;
    /// Drill holes.
    pub const DRILL: u32 = 13;
    /// Sewing line.
    pub const SEW: u32 = 14;
    /// Text on the piece.
    pub const TEXT: u32 = 15;
}

/// Chords leave curves by at most this much (metres).
const CHORD_ERROR: f64 = 2e-6;
/// Turning by more than this (radians, 10 degrees) at a vertex makes it a turn point.
const TURN: f64 = 0.175;
/// Height of texts, mm.
const LETTERS: f64 = 6.0;
/// Height of texts on lines, mm.
const SMALL_LETTERS: f64 = 3.0;
/// Most letters of a block's name in DXF R12.
const LONGEST_NAME: usize = 31;

/// The papers as DXF text; `style` is the garment's name.
pub fn cutting_dxf(style: &str, papers: &[Paper]) -> String {
    let mut dxf = Dxf::default();
    let names = block_names(papers);
    dxf.begin("HEADER");
    dxf.end();
    dxf.begin("BLOCKS");
    for (paper, name) in papers.iter().zip(&names) {
        dxf.block(style, paper, name);
    }
    dxf.end();
    dxf.begin("ENTITIES");
    dxf.style(style, papers);
    for name in &names {
        dxf.pair(0, "INSERT");
        dxf.pair(8, layer::BOUNDARY);
        dxf.pair(2, name);
        dxf.point(Vec2::zeros());
    }
    dxf.end();
    dxf.pair(0, "EOF");
    dxf.text
}

/// The text on the sides of a fish-eye dart, which is sewn and neither an edge nor cut.
fn fish_eye() -> LineKind {
    LineKind::Mark("dart".to_owned())
}

/// Names of blocks: letters, digits, `_`, `-` and `$`, each once.
fn block_names(papers: &[Paper]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for paper in papers {
        let plain = |c: char| if c.is_ascii_alphanumeric() || "_-$".contains(c) { c } else { '_' };
        let stem: String = paper.name.chars().map(plain).take(LONGEST_NAME - 4).collect();
        let mut name = stem.clone();
        let mut again = 2;
        while names.iter().any(|n| n.eq_ignore_ascii_case(&name)) {
            name = format!("{stem}_{again}");
            again += 1;
        }
        names.push(name);
    }
    names
}

/// Text of group codes and values.
#[derive(Default)]
struct Dxf {
    text: String,
}

impl Dxf {
    fn pair(&mut self, code: i32, value: impl std::fmt::Display) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.text, "{code:3}\n{value}");
    }

    fn begin(&mut self, section: &str) {
        self.pair(0, "SECTION");
        self.pair(2, section);
    }

    fn end(&mut self) {
        self.pair(0, "ENDSEC");
    }

    /// A position, metres y down, as millimetres y up.
    fn point(&mut self, p: Vec2) {
        self.pair(10, number(p.x * MM));
        self.pair(20, number(-p.y * MM));
    }

    fn block(&mut self, style: &str, paper: &Paper, name: &str) {
        self.pair(0, "BLOCK");
        self.pair(8, layer::BOUNDARY);
        self.pair(2, name);
        self.pair(70, 0);
        self.point(Vec2::zeros());
        self.piece_texts(style, paper);
        self.cut_lines(paper);
        for line in &paper.sew {
            let (on, told) = match line.of {
                SewKind::Outline | SewKind::Hole => (layer::SEW, Some(Told::Edge(line.name.clone(), line.corner))),
                SewKind::Dart => (layer::INTERNAL, Some(Told::Edge(line.name.clone(), None))),
                SewKind::FishEye => (layer::INTERNAL, Some(Told::Line(line.name.clone(), fish_eye()))),
                SewKind::Mouth => (layer::SEW, None),
            };
            self.told_line(&line.path, on, told);
        }
        for mark in &paper.marks {
            let told = match (mark.kind, &mark.line) {
                (MarkKind::Fold, _) => continue,
                (MarkKind::PleatFold, _) => Some(Told::PleatFold),
                (MarkKind::PleatPlace, _) => Some(Told::PleatPlace),
                (MarkKind::PleatArrow, _) => Some(Told::PleatArrow),
                (MarkKind::Line, kind) => kind.clone().map(|kind| Told::Line(mark.name.clone(), kind)),
            };
            self.told_line(&mark.path, layer::INTERNAL, told);
        }
        for notch in &paper.notches {
            self.notch(notch);
        }
        for (_, at) in &paper.drills {
            self.marker(*at, layer::DRILL);
        }
        if let Some(fold) = paper.fold {
            self.line(fold, layer::MIRROR);
        }
        self.line(paper.grain, layer::GRAIN);
        for t in &paper.texts {
            self.words(&t.text, t.at, t.height * MM, layer::TEXT);
        }
        self.pair(0, "ENDBLK");
        self.pair(8, layer::BOUNDARY);
    }

    fn cut_lines(&mut self, paper: &Paper) {
        for (i, contour) in paper.cut.iter().enumerate() {
            let on = if i == 0 { layer::BOUNDARY } else { layer::CUTOUT };
            self.polyline(contour, on, true);
        }
    }

    /// The statements that the standard demands of a piece, one text each on the boundary's layer.
    fn piece_texts(&mut self, style: &str, paper: &Paper) {
        // As drawn, and mirrored.
        let (plain, mirrored) =
            if paper.mirrored { (paper.quantity / 2, paper.quantity / 2) } else { (paper.quantity, 0) };
        let texts = [
            format!("Piece Name: {}", paper.name),
            format!("Style Name: {style}"),
            format!("Quantity: {plain},{mirrored}"),
            format!("Material: {}", paper.fabric),
            format!("Annotation: {}", paper.count),
        ];
        let cloth = paper.cloth.as_ref().map(|cloth| format!("Fabric: {cloth}"));
        let drawn = paper.drawn.map(|side| format!("Drawn: {}", side.letter()));
        for (i, text) in texts.iter().chain(&cloth).chain(&drawn).enumerate() {
            let down = Vec2::new(0.0, i as f64 * 1.5 * LETTERS / MM);
            self.words(text, paper.grain[0] + down, LETTERS, layer::BOUNDARY);
        }
    }

    /// The statements on the whole style.
    fn style(&mut self, style: &str, papers: &[Paper]) {
        let texts = [
            format!("Style Name: {style}"),
            concat!("Author: toile ", env!("CARGO_PKG_VERSION")).to_owned(),
            "Units: METRIC".to_owned(),
            format!("Pieces: {}", papers.len()),
        ];
        for (i, text) in texts.iter().enumerate() {
            self.words(text, Vec2::new(0.0, i as f64 * 1.5 * LETTERS / MM), LETTERS, layer::BOUNDARY);
        }
    }

    fn polyline(&mut self, points: &[Vec2], on: u32, closed: bool) {
        self.pair(0, "POLYLINE");
        self.pair(8, on);
        self.pair(66, 1);
        self.pair(70, i32::from(closed));
        for &p in points {
            self.pair(0, "VERTEX");
            self.pair(8, on);
            self.point(p);
        }
        self.pair(0, "SEQEND");
        self.pair(8, on);
        for k in 0..points.len() {
            let end = !closed && (k == 0 || k + 1 == points.len());
            let turns = end || turn_at(points, k).abs() > TURN;
            self.marker(points[k], if turns { layer::TURN } else { layer::CURVE });
        }
    }

    /// A line, and on it what is told of it.
    fn told_line(&mut self, path: &Path, on: u32, told: Option<Told>) {
        let points = path.sampled(CHORD_ERROR);
        self.polyline(&points, on, false);
        if let Some(told) = told {
            self.words(&told.text(), place(&Path::polyline(&points)), SMALL_LETTERS, layer::TEXT);
        }
    }

    /// A slit notch: a point on the cut line with its depth and its direction, degrees; and a text where it meets the
    /// sewing line, of which the other does not tell the place.
    fn notch(&mut self, notch: &NotchMark) {
        let into = notch.inside - notch.at;
        self.marker(notch.at, layer::NOTCH);
        self.pair(30, number(into.norm() * MM));
        self.pair(50, number((-into.y).atan2(into.x).to_degrees()));
        self.words(&notch_text(notch), notch.sewn, SMALL_LETTERS, layer::TEXT);
    }

    fn line(&mut self, [from, to]: [Vec2; 2], on: u32) {
        self.pair(0, "LINE");
        self.pair(8, on);
        self.point(from);
        self.pair(11, number(to.x * MM));
        self.pair(21, number(-to.y * MM));
    }

    fn marker(&mut self, at: Vec2, on: u32) {
        self.pair(0, "POINT");
        self.pair(8, on);
        self.point(at);
    }

    fn words(&mut self, text: &str, at: Vec2, height: f64, on: u32) {
        self.pair(0, "TEXT");
        self.pair(8, on);
        self.point(at);
        self.pair(40, number(height));
        self.pair(1, plain(text));
    }
}

/// The angle by which a closed contour turns at a vertex.
fn turn_at(contour: &[Vec2], k: usize) -> f64 {
    let count = contour.len();
    let (before, at, after) = (contour[(k + count - 1) % count], contour[k], contour[(k + 1) % count]);
    let (u, v) = (at - before, after - at);
    u.perp(&v).atan2(u.dot(&v))
}

/// A tenth of a micrometre.
fn number(x: f64) -> String {
    let text = format!("{x:.4}");
    if text == "-0.0000" { "0.0000".to_owned() } else { text }
}

/// DXF R12 knows ASCII; other letters are written as their codes, of four digits each: those beyond that, as emoji, as
/// the two that UTF-16 has for them. Control characters are left out.
fn plain(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars().filter(|c| !c.is_control()) {
        if matches!(c, ' '..='~') {
            out.push(c);
            continue;
        }
        for code in c.encode_utf16(&mut [0; 2]) {
            let _ = write!(out, "\\U+{code:04X}");
        }
    }
    out
}
