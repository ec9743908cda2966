//! Closed lines that are part of a sheet and not of the pattern on it: pages, frames, test squares, title blocks.

use super::contour::Contour;
use super::follow::follows;
use super::said::said;
use super::{Remark, Role};
use crate::geometry::{MM, Vec2, range_of};

/// Sides of a rectangle run along the sheet's to this (metres).
const ASKEW: f64 = 2e-4;
/// A rectangle is the page whose sides are those of the sheet to this (metres), or to this share of them.
const PAGE: (f64, f64) = (1e-3, 5e-3);
/// A frame's margins on the sheet differ by no more (metres).
const EVEN_MARGINS: f64 = 2e-3;
/// Least share of a page that its contents take. Less is a mark in a piece that fills its sheet.
const CONTENT: f64 = 0.1;
/// Nobody draws a pocket on a piece that takes this share of it.
const LARGE: f64 = 0.25;
/// Several outlines that take this share of the rectangle round them are pieces in a frame, not pockets on a piece.
const PIECES: f64 = 0.4;
/// No test square is larger (metres).
const LARGEST_TEST: f64 = 0.16;
/// Sides of usual test squares, millimetres.
const TEST_SIDES: [f64; 11] = [20.0, 25.0, 25.4, 30.0, 40.0, 50.0, 50.8, 76.2, 100.0, 101.6, 150.0];
/// A side is one of these to this share.
const TEST_EXACT: f64 = 0.005;
/// Words beside a test square stand no farther from it (metres).
const BESIDE: f64 = 0.015;
/// So many texts in a box without a name are a title block or a legend.
const MANY_TEXTS: usize = 3;
/// Words on sheets, not on pieces.
const SHEET_WORDS: [&str; 22] = [
    "sheet",
    "page",
    "seite",
    "blatt",
    "feuille",
    "hoja",
    "foglio",
    "legend",
    "legende",
    "légende",
    "title",
    "scale",
    "maßstab",
    "échelle",
    "escala",
    "scala",
    "print",
    "copyright",
    "license",
    "licence",
    "designer",
    "date",
];
/// Words of test squares.
const TEST_WORDS: [&str; 8] = ["test", "square", "control", "kontroll", "quadrat", "carré", "cuadro", "prueba"];

/// Kinds of closed lines that belong to the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SheetLine {
    Page,
    Frame,
    TestSquare,
    TitleBlock,
}

impl SheetLine {
    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Page => "the page",
            Self::Frame => "a frame round pieces",
            Self::TestSquare => "a test square",
            Self::TitleBlock => "a title block",
        }
    }
}

/// Data of a drawing's sheet.
pub(super) struct DrawingFrame<'a> {
    pub(super) contours: &'a [Contour],
    pub(super) remarks: &'a [Remark],
    /// Size of the sheet, whose corner is the origin, if that is said.
    pub(super) sheet: Option<Vec2>,
    /// A contour of less (square metres) is no piece.
    pub(super) smallest: f64,
}

impl DrawingFrame<'_> {
    /// Kind of the contour of this number if it belongs to the sheet and not to the pattern.
    pub(super) fn of_sheet(&self, k: usize) -> Option<SheetLine> {
        let contour = &self.contours[k];
        let [low, high] = rectangle(contour).filter(|_| contour.role == Role::Unknown)?;
        let content = self.content(contour);
        let share = content.iter().map(|c| c.area()).sum::<f64>() / contour.area();
        let is_page = self.sheet.is_some_and(|sheet| is_page([low, high], sheet));
        let followed = || content.iter().any(|c| follows(&c.whole, &contour.whole));
        let behind = contour.filled && !content.is_empty();
        if is_page && (behind || share >= CONTENT && content.len() > 1 || share >= LARGE && !followed()) {
            return Some(SheetLine::Page);
        }
        if !content.is_empty() && !followed() {
            let named = |c: &&Contour| c.name.is_some() && c.name != contour.name;
            let apart = content.len() > 1 && (content.iter().all(named) || share >= PIECES);
            let even = self.sheet.is_some_and(|sheet| has_even_margins([low, high], sheet));
            let one = even && share >= CONTENT && contour.name.is_none() && content.iter().all(named);
            if is_page && (share >= CONTENT && content.iter().all(named)) {
                return Some(SheetLine::Page);
            }
            if behind || apart || one {
                return Some(SheetLine::Frame);
            }
        }
        let alone = self.contours.iter().filter(|c| c.area() > contour.area()).count() == 0;
        if alone || !content.is_empty() {
            return None;
        }
        self.is_test_square(contour, [low, high])
            .then_some(SheetLine::TestSquare)
            .or_else(|| self.is_title_block(contour, [low, high]).then_some(SheetLine::TitleBlock))
    }

    /// The contours of the size of a piece that lie in this one, and in no other within it.
    fn content(&self, contour: &Contour) -> Vec<&Contour> {
        let other = |c: &&Contour| !std::ptr::eq(*c, contour) && c.area() >= self.smallest;
        let within: Vec<&Contour> = self.contours.iter().filter(other).filter(|c| c.lies_in(contour)).collect();
        let top = |c: &&&Contour| !within.iter().any(|o| !std::ptr::eq(*o, **c) && c.lies_in(o));
        within.iter().filter(top).copied().collect()
    }

    /// Texts in a box or as near to it as this.
    fn texts(&self, [low, high]: [Vec2; 2], near: f64) -> Vec<String> {
        let is_near = |r: &&Remark| (0..2).all(|i| r.at[i] >= low[i] - near && r.at[i] <= high[i] + near);
        self.remarks.iter().filter(is_near).map(|r| r.text.to_lowercase()).collect()
    }

    fn is_test_square(&self, contour: &Contour, corners: [Vec2; 2]) -> bool {
        let [width, height] = (corners[1] - corners[0]).into();
        if width.max(height) > LARGEST_TEST {
            return false;
        }
        let usual = |side: f64| TEST_SIDES.iter().any(|test| (side * MM / test - 1.0).abs() <= TEST_EXACT);
        let square = (width - height).abs() <= ASKEW;
        let texts = self.texts(corners, BESIDE);
        let is_said = |words: &[&str]| texts.iter().any(|text| words.iter().any(|w| has_word(text, w)));
        let measured = texts.iter().any(|text| lengths(text).any(|l| (l / width - 1.0).abs() <= 0.02));
        let named = contour.name.as_deref().map(str::to_lowercase);
        let called = named.as_deref().is_some_and(|name| TEST_WORDS[..3].iter().any(|w| name.contains(w)));
        let unnamed = named.is_none() && !texts.iter().any(|t| said(t).is_some());
        called || (is_said(&TEST_WORDS) || measured) && unnamed || square && usual(width) && unnamed
    }

    fn is_title_block(&self, contour: &Contour, corners: [Vec2; 2]) -> bool {
        let texts = self.texts(corners, 0.0);
        let on_sheets = texts
            .iter()
            .any(|text| SHEET_WORDS.iter().any(|w| has_word(text, w)) || text.contains('©') || counts_sheets(text));
        let named = contour.name.as_deref().map(str::to_lowercase);
        let called = named.as_deref().is_some_and(|name| ["legend", "title"].iter().any(|w| name.contains(w)));
        let cut = texts.iter().any(|text| said(text).is_some());
        called || contour.name.is_none() && !cut && (on_sheets || texts.len() >= MANY_TEXTS)
    }
}

fn has_word(text: &str, word: &str) -> bool {
    text.split(|c: char| !c.is_alphanumeric()).any(|w| w == word || word.len() > 5 && w.starts_with(word))
}

/// `1 of 2`.
fn counts_sheets(text: &str) -> bool {
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let number = |word: &str| word.parse::<u32>().is_ok();
    words.windows(3).any(|w| number(w[0]) && ["of", "von", "sur", "de", "di"].contains(&w[1]) && number(w[2]))
}

/// Lengths that a text says, metres: `5 cm`, `2in`, `50mm`.
fn lengths(text: &str) -> impl Iterator<Item = f64> + '_ {
    const UNITS: [(&str, f64); 6] =
        [("mm", 1e-3), ("cm", 1e-2), ("inch", 0.0254), ("in", 0.0254), ("\"", 0.0254), ("″", 0.0254)];
    let starts = text.char_indices().filter(|(k, c)| {
        c.is_ascii_digit() && !text[..*k].ends_with(|b: char| b.is_ascii_digit() || b == '.' || b == ',')
    });
    starts.filter_map(|(k, _)| {
        let rest = &text[k..];
        let end = rest.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == ',')).unwrap_or(rest.len());
        let number: f64 = rest[..end].replace(',', ".").parse().ok()?;
        let unit = rest[end..].trim_start();
        let metres = UNITS.iter().find(|(name, _)| unit.starts_with(name)).map(|(_, metres)| *metres)?;
        Some(number * metres)
    })
}

/// The least and greatest coordinates of a contour that is a rectangle along the axes.
fn rectangle(contour: &Contour) -> Option<[Vec2; 2]> {
    let [low, high] = contour.bounds;
    let sides = high - low;
    // What fills its box is one.
    let full = (contour.area() - sides.x * sides.y).abs() <= ASKEW * (sides.x + sides.y);
    full.then_some([low, high])
}

fn is_page([low, high]: [Vec2; 2], sheet: Vec2) -> bool {
    let near = |a: f64, b: f64, side: f64| (a - b).abs() <= PAGE.0.max(PAGE.1 * side);
    (0..2).all(|i| near(low[i], 0.0, sheet[i]) && near(high[i], sheet[i], sheet[i]))
}

fn has_even_margins([low, high]: [Vec2; 2], sheet: Vec2) -> bool {
    let margins = [low.x, low.y, sheet.x - high.x, sheet.y - high.y];
    let [least, most] = range_of(margins);
    least >= 0.0 && most - least <= EVEN_MARGINS
}
