//! A pattern as it was read from a drawing: pieces with their names, edges with names and lengths, marks, and seams in
//! colours.

use super::canvas::Canvas;
use super::clear::Taken;
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
/// Dashes of a fold, and the gaps between them, pixels.
const DASHES: [f64; 2] = [16.0, 9.0];
/// Radius of the ring that stands for a button or a buttonhole, pixels, and its sides.
const RING: f64 = 7.0;
const RING_SIDES: usize = 16;
/// Space between an edge and its label, and round a piece's name, pixels.
const OFF: f64 = 6.0;
/// The grain arrow ends so far within its piece, as a share of the piece's size.
const GRAIN_ROOM: f64 = 0.05;
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
    /// Holes, darts and lines inside.
    pub lines: Vec<Path>,
    /// Buttons and buttonholes.
    pub points: Vec<Vec2>,
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
    /// Whether it lies on the fold of the cloth.
    pub fold: bool,
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
        let p = self.point(p);
        [p.x as f32, p.y as f32]
    }

    fn point(&self, p: Vec2) -> Vec2 {
        (p - self.place.from) * self.scale + self.place.to
    }

    /// The chords of a path, pixels.
    fn steps(&self, path: &Path) -> impl Iterator<Item = [Vec2; 2]> {
        let points: Vec<Vec2> = path.sampled(SMOOTH).into_iter().map(|p| self.point(p)).collect();
        (1..points.len()).map(move |k| [points[k - 1], points[k]])
    }

    /// A path in dashes.
    fn dashed(&self, canvas: &mut Canvas, path: &Path, radius: f32, color: Rgb) {
        let [dash, gap] = DASHES.map(|pixels| pixels / self.scale);
        let mut from = 0.0;
        while from < path.length() {
            self.path(canvas, &path.part(from, (from + dash).min(path.length())), radius, color);
            from += dash + gap;
        }
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
    let mut taken = Taken::default();
    for line in &piece.lines {
        shown.path(canvas, line, INNER, PALE_INK);
        shown.steps(line).for_each(|step| taken.line(step));
    }
    piece.points.iter().for_each(|point| ring(canvas, shown.point(*point), &mut taken));
    let [low, high] = bounds(piece);
    if let Some(ends) = piece.grain.and_then(|grain| within(grain, [low, high])) {
        let ends = ends.map(|p| shown.point(p));
        arrow(canvas, ends);
        taken.line(ends);
    }
    let sides: Vec<[Vec2; 2]> = piece.edges.iter().flat_map(|edge| shown.steps(&edge.path)).collect();
    sides.iter().for_each(|side| taken.line(*side));
    for edge in &piece.edges {
        let (radius, color) = edge.seam.map_or((EDGE, RIM), |seam| (SEWN, opening(seam)));
        if edge.fold {
            shown.dashed(canvas, &edge.path, radius, color);
        } else {
            shown.path(canvas, &edge.path, radius, color);
        }
        edge.notches.iter().for_each(|notch| draw_notch(canvas, edge, *notch, shown));
    }
    let size = (high - low) * shown.scale;
    piece.edges.iter().for_each(|edge| label(canvas, edge, size, shown, &mut taken));
    let width = Canvas::text_width(&piece.name, PIECE_CELL);
    let cell = PIECE_CELL * (size.x as f32 / width.max(1.0)).clamp(LEAST_SHARE, 1.0);
    let words = words_size(&piece.name, cell);
    let middle = shown.point((low + high) / 2.0);
    let clear = taken.place(&sides, words + Vec2::repeat(2.0 * OFF), middle);
    write(canvas, &piece.name, clear.unwrap_or(middle), cell, INK);
}

/// The size of a line of text, pixels.
fn words_size(text: &str, cell: f32) -> Vec2 {
    Vec2::new(f64::from(Canvas::text_width(text, cell)), f64::from(CAPITAL * cell))
}

/// Writes a text round its middle.
fn write(canvas: &mut Canvas, text: &str, middle: Vec2, cell: f32, color: Rgb) {
    let size = words_size(text, cell);
    let at = middle + Vec2::new(-size.x, size.y) / 2.0;
    canvas.text(text, [at.x as f32, at.y as f32], cell, color);
}

/// A ring round a point.
fn ring(canvas: &mut Canvas, middle: Vec2, taken: &mut Taken) {
    let corner = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / RING_SIDES as f64).sin_cos();
        middle + RING * Vec2::new(cos, sin)
    };
    for k in 0..RING_SIDES {
        let [a, b] = [corner(k), corner(k + 1)];
        canvas.line([a.x as f32, a.y as f32], [b.x as f32, b.y as f32], INNER, INK);
    }
    taken.words(middle, Vec2::repeat(2.0 * RING));
}

/// The part of an arrow that lies in a piece's box, a little within where it leaves it; `None` beside it.
fn within(ends: [Vec2; 2], [low, high]: [Vec2; 2]) -> Option<[Vec2; 2]> {
    let is_in = |p: Vec2| (0..2).all(|k| (low[k]..=high[k]).contains(&p[k]));
    if ends.into_iter().all(is_in) {
        return Some(ends);
    }
    let room = GRAIN_ROOM * (high - low);
    let (low, high, along) = (low + room, high - room, ends[1] - ends[0]);
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    for k in (0..2).filter(|k| along[*k] != 0.0) {
        let at = [(low[k] - ends[0][k]) / along[k], (high[k] - ends[0][k]) / along[k]];
        from = from.max(at[0].min(at[1]));
        to = to.min(at[0].max(at[1]));
    }
    (from < to).then(|| [from, to].map(|share| ends[0] + share * along))
}

/// A line with a head.
fn arrow(canvas: &mut Canvas, ends: [Vec2; 2]) {
    let Some(unit) = (ends[1] - ends[0]).try_normalize(0.0) else { return };
    let [tail, head] = ends.map(|p| [p.x as f32, p.y as f32]);
    canvas.line(tail, head, INNER, PALE_INK);
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
fn label(canvas: &mut Canvas, edge: &PatternEdge, size: Vec2, shown: &Shown, taken: &mut Taken) {
    let long = edge.path.length();
    let room = long * shown.scale;
    let fold = if edge.fold { " fold" } else { "" };
    let texts = [format!("{} {:.1}{fold}", edge.name, long * MM), edge.name.clone()];
    let [dx, dy] = inward(edge, long / 2.0).map(|c| f64::from(c).abs());
    // Beside an upright edge a text needs room up and down alone, and the edge across has its own.
    let fits = |text: &&String| {
        let words = words_size(text, EDGE_CELL);
        (words.x * dy).max(words.y * dx) <= room && words.x * dx <= 0.5 * size.x
    };
    let Some(text) = texts.iter().find(fits) else { return };
    let words = words_size(text, EDGE_CELL);
    // The nearest of three places of the edge that is clear of what is there.
    let places = [0.5, 0.35, 0.65].map(|share| {
        let [dx, dy] = inward(edge, share * long).map(f64::from);
        let off = OFF + f64::from(SEWN) + (words.x * dx.abs() + words.y * dy.abs()) / 2.0;
        shown.point(edge.path.point(share * long)) + off * Vec2::new(dx, dy)
    });
    let middle = places.into_iter().find(|at| taken.is_clear(*at, words)).unwrap_or(places[0]);
    taken.words(middle, words);
    write(canvas, text, middle, EDGE_CELL, edge.seam.map_or(INK, opening));
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
