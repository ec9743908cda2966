//! The finished picture's pixels, and flat drawing on them.

use super::color::Rgb;
use super::font::{CAPITAL, Contour, Typeface};
use super::ink::Ink;
use super::raster::byte;
use crate::geometry::{CAPITAL_CELLS, LetterStrokes, from_left, letter_strokes};

/// Letters are made bolder by this on both sides of a stroke, in cells of the font: small ones of a light typeface are
/// too pale on the picture.
const BOLDER: f32 = 0.1;
/// Cells of the font per cell of a letter that is drawn as strokes: its capitals are as high.
const STROKE_CELL: f32 = CAPITAL / CAPITAL_CELLS as f32;
/// The same of a letter that is a square: it is as high as a capital with the space below the line.
const WIDE_CELL: f32 = 9.0 / 16.0;
/// Half the width of such strokes, cells of the font: as thick as the typeface's.
const STROKE: f32 = 0.4;

/// Pixels, three bytes each, row by row.
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) rgb: Vec<u8>,
}

impl Canvas {
    pub(super) fn new(width: usize, height: usize, color: Rgb) -> Self {
        Self { width, height, rgb: color.map(byte).repeat(width * height) }
    }

    /// Copies rows of pixels, `width` each, to column `left` from row `top` on.
    pub(super) fn paste(&mut self, left: usize, top: usize, width: usize, pixels: &[u8]) {
        for (row, pixels) in pixels.chunks_exact(3 * width).enumerate() {
            let start = 3 * ((top + row) * self.width + left);
            self.rgb[start..start + 3 * width].copy_from_slice(pixels);
        }
    }

    /// Fills a box given by its corner and its size. Parts outside are left out.
    pub(super) fn fill(&mut self, [left, top]: [usize; 2], [width, height]: [usize; 2], color: Rgb) {
        for y in top..(top + height).min(self.height) {
            for x in left..(left + width).min(self.width) {
                self.mix(x, y, color, 1.0);
            }
        }
    }

    /// A straight line with round ends, `radius` being half its width, its edge smoothed over a pixel.
    pub(super) fn line(&mut self, a: [f32; 2], b: [f32; 2], radius: f32, color: Rgb) {
        let reach = radius + 1.0;
        let span = |k: usize, end: usize| {
            let low = (a[k].min(b[k]) - reach).floor().max(0.0) as usize;
            low..((a[k].max(b[k]) + reach).ceil().max(0.0) as usize).min(end)
        };
        let along = [b[0] - a[0], b[1] - a[1]];
        let length2 = (along[0] * along[0] + along[1] * along[1]).max(f32::MIN_POSITIVE);
        for y in span(1, self.height) {
            for x in span(0, self.width) {
                let d = [x as f32 + 0.5 - a[0], y as f32 + 0.5 - a[1]];
                let t = ((d[0] * along[0] + d[1] * along[1]) / length2).clamp(0.0, 1.0);
                let off = (d[0] - t * along[0]).hypot(d[1] - t * along[1]);
                self.mix(x, y, color, (radius + 0.5 - off).clamp(0.0, 1.0));
            }
        }
    }

    /// Writes a line of text from `start`, on the base line. `cell` is the size of a cell of the font, seven of which
    /// make a capital. Letters that the typeface does not have are drawn as strokes. Returns where the text ends.
    pub(super) fn text(&mut self, text: &str, [left, base]: [f32; 2], cell: f32, color: Rgb) -> f32 {
        let Some(face) = Typeface::new() else { return left };
        let mut x = left;
        for letter in from_left(text).chars() {
            match strokes(&face, letter) {
                Some(own) => self.strokes(&own, [x, base], cell, color),
                None => {
                    let placed = |c: Contour| c.iter().map(|p| [x + cell * p[0], base + cell * p[1]]).collect();
                    let contours: Vec<Contour> = face.contours(letter).into_iter().map(placed).collect();
                    if let Some(ink) = Ink::of(&contours, BOLDER * cell, [self.width, self.height]) {
                        self.print(&ink, color);
                    }
                }
            }
            x += cell * advance(&face, letter);
        }
        x
    }

    /// Width of a line of text, pixels.
    pub(super) fn text_width(text: &str, cell: f32) -> f32 {
        Typeface::new().map_or(0.0, |face| from_left(text).chars().map(|letter| cell * advance(&face, letter)).sum())
    }

    /// A letter as strokes.
    fn strokes(&mut self, letter: &LetterStrokes, [left, base]: [f32; 2], cell: f32, color: Rgb) {
        let scale = cell * stroke_cell(letter);
        for ends in &letter.strokes {
            let [a, b] = ends.map(|[x, y]| [left + scale * x, base - scale * y]);
            self.line(a, b, STROKE * cell, color);
        }
    }

    fn print(&mut self, ink: &Ink, color: Rgb) {
        for (row, shares) in ink.shares.chunks_exact(ink.width).enumerate() {
            for (column, share) in shares.iter().enumerate().filter(|(_, share)| **share > 0.0) {
                self.mix(ink.from[0] + column, ink.from[1] + row, color, share.min(1.0));
            }
        }
    }

    fn mix(&mut self, x: usize, y: usize, color: Rgb, share: f32) {
        let start = 3 * (y * self.width + x);
        for (held, new) in self.rgb[start..start + 3].iter_mut().zip(color) {
            *held = byte(f32::from(*held) / 255.0 * (1.0 - share) + new * share);
        }
    }
}

/// The strokes of a letter that the typeface does not have.
fn strokes(face: &Typeface, letter: char) -> Option<LetterStrokes> {
    if face.has(letter) { None } else { letter_strokes(letter) }
}

/// Cells of the font per cell of a letter's strokes.
fn stroke_cell(letter: &LetterStrokes) -> f32 {
    if letter.is_wide { WIDE_CELL } else { STROKE_CELL }
}

/// Cells of the font from a letter to the next one.
fn advance(face: &Typeface, letter: char) -> f32 {
    strokes(face, letter).map_or_else(|| face.advance(letter), |own| stroke_cell(&own) * own.advance as f32)
}
