//! A pattern as it was read from a drawing: pieces with their names, edges with names and lengths, marks, and seams in
//! colours.

use super::canvas::Canvas;
use super::color::{INK, PALE_INK, PAPER, RIM, Rgb, opening};
use super::font::CAPITAL;
use super::places::{BoxPlace, places};
use super::{HEIGHT, PictureError, WIDTH, encode};
use crate::geometry::{MM, Path, Vec2, box_or_origin};

/// Pixels above the pieces, for the title.
const HEAD: usize = 110;
/// Margin left of words, pixels.
const MARGIN: usize = 56;
/// Chords stand for curves to this, metres.
const SMOOTH: f64 = 2e-4;
/// Half the width of edges that are not sewn, of sewn ones, and of lines inside, pixels.
const EDGE: f32 = 1.4;
const SEWN: f32 = 3.2;
const INNER: f32 = 0.8;
/// Length of a notch, and between the marks of a double one, pixels.
const NOTCH: f32 = 11.0;
const MARKS: f32 = 5.0;
/// Sizes of the letters: of edges, of pieces, of the legend and of the title, pixels per cell of the font.
const EDGE_CELL: f32 = 1.9;
const PIECE_CELL: f32 = 2.8;
const LEGEND_CELL: f32 = 2.4;
const TITLE_CELL: f32 = 5.0;
/// A piece's name is written no smaller than this share of its size, be the piece however narrow.
const LEAST_SHARE: f32 = 0.5;
/// Height of a line of the legend, and the side of its square, pixels.
const LINE: usize = 38;
const SQUARE: usize = 22;

/// A piece of a pattern. Lengths are metres, y down.
#[derive(Clone, Debug)]
pub struct PatternPiece {
    /// Its name.
    pub name: String,
    /// Its edges, clockwise.
    pub edges: Vec<PatternEdge>,
    /// Holes and lines inside.
    pub lines: Vec<Path>,
    /// Tail and head of the grain arrow.
    pub grain: Option<[Vec2; 2]>,
}

/// An edge of a piece.
#[derive(Clone, Debug)]
pub struct PatternEdge {
    /// Its name.
    pub name: String,
    /// Its course.
    pub path: Path,
    /// Notches from its start, metres, and whether they are double.
    pub notches: Vec<(f64, bool)>,
    /// The number of the seam that takes it.
    pub seam: Option<usize>,
}

/// Draws the pieces to one scale, with a line below for each seam in its colour, and returns the bytes of a PNG file,
/// [`WIDTH`] pixels wide.
///
/// # Errors
/// When there is nothing to draw ([`PictureError`]).
pub fn draw_pattern(title: &str, pieces: &[PatternPiece], seams: &[String]) -> Result<Vec<u8>, PictureError> {
    let boxes: Vec<[Vec2; 2]> = pieces.iter().map(bounds).collect();
    if pieces.is_empty() || !boxes.iter().flatten().all(|p| p.x.is_finite() && p.y.is_finite()) {
        return Err(PictureError::NothingToDraw);
    }
    let mut canvas = Canvas::new(WIDTH, HEIGHT + (seams.len() + 1) * LINE, PAPER);
    let (places, scale) = places(&boxes, HEAD, HEIGHT);
    for (piece, place) in pieces.iter().zip(&places) {
        draw_piece(&mut canvas, piece, &Shown { place, scale });
    }
    canvas.text(title, [MARGIN as f32, 72.0], TITLE_CELL, INK);
    legend(&mut canvas, seams);
    Ok(encode(&canvas)?)
}

/// The colour of seam `k` in the picture of a pattern, as bytes.
pub fn seam_color(k: usize) -> [u8; 3] {
    opening(k).map(super::raster::byte)
}

/// Where a piece is shown.
struct Shown<'a> {
    place: &'a BoxPlace,
    scale: f64,
}

impl Shown<'_> {
    fn at(&self, p: Vec2) -> [f32; 2] {
        let p = (p - self.place.from) * self.scale + self.place.to;
        [p.x as f32, p.y as f32]
    }

    fn path(&self, canvas: &mut Canvas, path: &Path, radius: f32, color: Rgb) {
        for step in path.sampled(SMOOTH).windows(2) {
            canvas.line(self.at(step[0]), self.at(step[1]), radius, color);
        }
    }
}

fn bounds(piece: &PatternPiece) -> [Vec2; 2] {
    box_or_origin(piece.edges.iter().flat_map(|edge| edge.path.sampled(SMOOTH)))
}

fn draw_piece(canvas: &mut Canvas, piece: &PatternPiece, shown: &Shown) {
    piece.lines.iter().for_each(|line| shown.path(canvas, line, INNER, PALE_INK));
    if let Some([tail, head]) = piece.grain {
        arrow(canvas, shown.at(tail), shown.at(head));
    }
    for edge in &piece.edges {
        let (radius, color) = edge.seam.map_or((EDGE, RIM), |seam| (SEWN, opening(seam)));
        shown.path(canvas, &edge.path, radius, color);
        edge.notches.iter().for_each(|notch| draw_notch(canvas, edge, *notch, shown));
    }
    let [low, high] = bounds(piece);
    let size = (high - low) * shown.scale;
    piece.edges.iter().for_each(|edge| label(canvas, edge, size, shown));
    let [x, y] = shown.at((low + high) / 2.0);
    let width = Canvas::text_width(&piece.name, PIECE_CELL);
    let cell = PIECE_CELL * (size.x as f32 / width.max(1.0)).clamp(LEAST_SHARE, 1.0);
    canvas.text(&piece.name, [x - Canvas::text_width(&piece.name, cell) / 2.0, y], cell, INK);
}

/// A line with a head.
fn arrow(canvas: &mut Canvas, tail: [f32; 2], head: [f32; 2]) {
    let along = Vec2::new(f64::from(head[0] - tail[0]), f64::from(head[1] - tail[1]));
    canvas.line(tail, head, INNER, PALE_INK);
    let Some(unit) = along.try_normalize(0.0) else { return };
    for side in [-0.5, 0.5] {
        let flank = (unit + side * Vec2::new(-unit.y, unit.x)) * f64::from(NOTCH);
        canvas.line(head, [head[0] - flank.x as f32, head[1] - flank.y as f32], INNER, PALE_INK);
    }
}

/// Into the piece from a place of an edge, pixels.
fn inward(edge: &PatternEdge, at: f64) -> [f32; 2] {
    let along = edge.path.tangent(at);
    [-along.y as f32, along.x as f32]
}

fn draw_notch(canvas: &mut Canvas, edge: &PatternEdge, (at, double): (f64, bool), shown: &Shown) {
    let [x, y] = shown.at(edge.path.point(at));
    let [dx, dy] = inward(edge, at);
    let offs: &[f32] = if double { &[-MARKS / 2.0, MARKS / 2.0] } else { &[0.0] };
    for off in offs {
        // Along the edge, which lies square to the way in.
        let from = [x + off * dy, y - off * dx];
        canvas.line(from, [from[0] + NOTCH * dx, from[1] + NOTCH * dy], EDGE, INK);
    }
}

/// An edge's name and length beside its middle, its name alone where that is all there is room for in a piece of this
/// size (pixels).
fn label(canvas: &mut Canvas, edge: &PatternEdge, size: Vec2, shown: &Shown) {
    let long = edge.path.length();
    let room = (long * shown.scale) as f32;
    let texts = [format!("{} {:.1}", edge.name, long * MM), edge.name.clone()];
    let [dx, dy] = inward(edge, long / 2.0);
    // Beside an upright edge a text needs room up and down alone.
    let needed = |text: &str| {
        let width = Canvas::text_width(text, EDGE_CELL);
        (width * dy.abs()).max(CAPITAL * EDGE_CELL * dx.abs())
    };
    // The edge across has its own.
    let deep = |text: &str| Canvas::text_width(text, EDGE_CELL) * dx.abs() <= 0.5 * size.x as f32;
    let fits = |text: &&String| needed(text) <= room && deep(text);
    let Some(text) = texts.iter().find(fits) else { return };
    let width = Canvas::text_width(text, EDGE_CELL);
    let height = CAPITAL * EDGE_CELL;
    let [x, y] = shown.at(edge.path.point(long / 2.0));
    let off = 6.0 + SEWN;
    let middle = [x + dx * (off + width / 2.0 * dx.abs()), y + dy * (off + height)];
    let color = edge.seam.map_or(INK, opening);
    canvas.text(text, [middle[0] - width / 2.0, middle[1] + height / 2.0], EDGE_CELL, color);
}

/// A line for each seam: its colour and what it sews.
fn legend(canvas: &mut Canvas, seams: &[String]) {
    for (k, text) in seams.iter().enumerate() {
        let top = HEIGHT + k * LINE;
        canvas.fill([MARGIN, top], [SQUARE, SQUARE], opening(k));
        let left = MARGIN + 2 * SQUARE;
        let room = (WIDTH - left - MARGIN) as f32;
        let cell = LEGEND_CELL.min(LEGEND_CELL * room / Canvas::text_width(text, LEGEND_CELL).max(1.0));
        canvas.text(text, [left as f32, (top + SQUARE - 2) as f32], cell, INK);
    }
}
