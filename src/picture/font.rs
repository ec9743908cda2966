//! Letters: the outlines of a typeface.

use epaint_default_fonts::UBUNTU_LIGHT;
use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// Cells that a capital is high. Sizes of letters are given in pixels per cell.
pub(super) const CAPITAL: f32 = 7.0;

/// Chords that stand for a curve. A letter has curves of a few pixels.
const CHORDS: u8 = 8;

/// A closed line, in cells: rightwards from where the letter begins, and downwards from the base line.
pub(super) type Contour = Vec<[f32; 2]>;

/// The typeface of all pictures.
pub(super) struct Typeface {
    face: Face<'static>,
    /// Cells per unit of the face.
    scale: f32,
}

impl Typeface {
    /// Ubuntu Light, which is part of the program. `None` if it cannot be read, which a test rules out.
    pub(super) fn new() -> Option<Self> {
        let face = Face::parse(UBUNTU_LIGHT, 0).ok()?;
        let height = face.glyph_bounding_box(face.glyph_index('H')?)?.y_max;
        Some(Self { scale: CAPITAL / f32::from(height), face })
    }

    /// Whether it has a letter.
    pub(super) fn has(&self, letter: char) -> bool {
        self.face.glyph_index(letter).is_some()
    }

    /// The contours of a letter. Letters that the typeface does not have are a box.
    pub(super) fn contours(&self, letter: char) -> Vec<Contour> {
        let mut outline = Outline { scale: self.scale, done: Vec::new() };
        // A blank has no outline.
        let _ = self.face.outline_glyph(self.glyph(letter), &mut outline);
        outline.done
    }

    /// Cells from a letter to the next one.
    pub(super) fn advance(&self, letter: char) -> f32 {
        self.scale * f32::from(self.face.glyph_hor_advance(self.glyph(letter)).unwrap_or(0))
    }

    /// The glyph of a letter, or the one that stands for letters that are missing.
    fn glyph(&self, letter: char) -> GlyphId {
        self.face.glyph_index(letter).unwrap_or(GlyphId(0))
    }
}

/// Collects contours as chords.
struct Outline {
    scale: f32,
    done: Vec<Contour>,
}

impl Outline {
    fn at(&self, x: f32, y: f32) -> [f32; 2] {
        [self.scale * x, -self.scale * y]
    }

    fn add(&mut self, point: [f32; 2]) {
        if let Some(contour) = self.done.last_mut() {
            contour.push(point);
        }
    }

    /// Adds a Bézier curve from where the contour has come to, by de Casteljau's construction.
    fn curve(&mut self, rest: &[[f32; 2]]) {
        let Some(&from) = self.done.last().and_then(|contour| contour.last()) else { return };
        for k in 1..=CHORDS {
            let share = f32::from(k) / f32::from(CHORDS);
            let mut points = [&[from], rest].concat();
            while points.len() > 1 {
                points = points.windows(2).map(|w| [0, 1].map(|c| w[0][c] + share * (w[1][c] - w[0][c]))).collect();
            }
            self.add(points[0]);
        }
    }
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.done.push(vec![self.at(x, y)]);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add(self.at(x, y));
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.curve(&[self.at(x1, y1), self.at(x, y)]);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.curve(&[self.at(x1, y1), self.at(x2, y2), self.at(x, y)]);
    }

    fn close(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Letters of titles, names and legends.
    const LETTERS: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyzäöüéèçßœñøłžšÅ\
                           0123456789.,:;-–_+=*/%()·!?&#'×°";

    /// Area within contours, cells squared: holes run the other way round.
    fn area(contours: &[Contour]) -> f32 {
        let twice = |c: &Contour| -> f32 {
            (0..c.len()).map(|k| [c[k], c[(k + 1) % c.len()]]).map(|[p, q]| p[0] * q[1] - q[0] * p[1]).sum()
        };
        0.5 * contours.iter().map(twice).sum::<f32>().abs()
    }

    #[test]
    fn the_typeface_has_the_letters_of_titles_and_legends() {
        let face = Typeface::new().expect("it is part of the program");
        let missing = face.contours('\u{10ffff}');
        for letter in LETTERS.chars() {
            let own = face.contours(letter);
            assert!(own != missing && area(&own) > 0.1 && face.advance(letter) > 1.0, "{letter}");
        }
        assert!(face.contours(' ').is_empty() && face.advance(' ') > 1.0);
    }

    #[test]
    fn a_capital_is_seven_cells_high_and_stands_on_the_base_line() {
        let face = Typeface::new().expect("it is part of the program");
        let heights = || face.contours('H').into_iter().flatten().map(|p| p[1]);
        let (top, foot) = (heights().fold(0.0, f32::min), heights().fold(-9.0, f32::max));
        assert!((top + CAPITAL).abs() < 1e-4 && foot.abs() < 1e-4, "{top}, {foot}");
        // An O has its counter.
        assert_eq!(face.contours('O').len(), 2);
    }
}
