//! Letters of a page: those of Windows code page 1252 in Helvetica, which every reader has, and all others as strokes
//! in fonts of the file's own (type 3, ISO 32000-1, 9.6.5), a font for each 256 letters of Unicode.

use std::collections::BTreeSet;

use pdf_writer::types::{SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Finish as _, Name, Pdf, Rect, Ref, Str};

use crate::geometry::{CAPITAL_CELLS, from_left, letter_strokes};

/// Widths of Helvetica's letters from the blank to `~`, thousandths of the size, as its metrics give them; other
/// letters are about as wide as an `n`.
const WIDTHS: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833,
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556,
    556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334,
    260, 334, 584,
];
const OTHER_WIDTH: u16 = 556;
/// Height of the capitals of Helvetica over its size.
pub(super) const CAPITALS: f64 = 0.72;
/// A cell of a narrow glyph over the size of the type: its capitals are as high as Helvetica's.
const CELL: f64 = CAPITALS / CAPITAL_CELLS;
/// A wide glyph is a square as large as the type.
const WIDE_CELL: f64 = 1.0 / 16.0;
/// The name by which pages speak of Helvetica.
pub(super) const HELVETICA: &str = "F";

/// Letters that one font has, as its codes.
pub(super) struct FontRun {
    /// The name by which pages speak of the font.
    pub(super) font: String,
    pub(super) codes: Vec<u8>,
    /// Set in size 1.
    pub(super) width: f64,
}

/// A text as letters of the fonts that have them, from left to right. A letter that none has is `?`.
pub(super) fn font_runs(text: &str) -> Vec<FontRun> {
    let mut runs: Vec<FontRun> = Vec::new();
    for letter in from_left(text).chars() {
        let (font, code, width) = placed(letter);
        match runs.last_mut() {
            Some(run) if run.font == font => {
                run.codes.push(code);
                run.width += width;
            }
            _ => runs.push(FontRun { font, codes: vec![code], width }),
        }
    }
    runs
}

/// Width of a text set in size 1.
pub(super) fn width(text: &str) -> f64 {
    from_left(text).chars().map(|letter| placed(letter).2).sum()
}

/// Font, code and width of a letter.
fn placed(letter: char) -> (String, u8, f64) {
    let helvetica = |code: u8| {
        let width = WIDTHS.get(usize::from(code).wrapping_sub(32)).copied().unwrap_or(OTHER_WIDTH);
        (HELVETICA.to_owned(), code, f64::from(width) / 1000.0)
    };
    if let Some(code) = windows_letter(letter) {
        return helvetica(code);
    }
    let drawn = letter_strokes(letter).map(|own| own.advance * cell(own.is_wide));
    drawn.map_or_else(|| helvetica(b'?'), |width| (block_name(block(letter)), letter as u32 as u8, width))
}

fn cell(is_wide: bool) -> f64 {
    if is_wide { WIDE_CELL } else { CELL }
}

fn block(letter: char) -> u32 {
    letter as u32 >> 8
}

fn block_name(block: u32) -> String {
    format!("U{block:02X}")
}

/// The letters of a text that no font has; they are printed as `?`.
pub(super) fn unprintable(text: &str) -> impl Iterator<Item = char> + '_ {
    text.chars().filter(|&letter| letter != '?' && windows_letter(letter).is_none() && letter_strokes(letter).is_none())
}

/// The letters of a text that are drawn as strokes.
pub(super) fn drawn_letters(text: &str) -> BTreeSet<char> {
    let is_drawn = |letter: &char| windows_letter(*letter).is_none() && letter_strokes(*letter).is_some();
    from_left(text).chars().filter(is_drawn).collect()
}

/// The code of a letter in code page 1252, if it has it.
fn windows_letter(letter: char) -> Option<u8> {
    match letter {
        ' '..='~' | '\u{a0}'..='\u{ff}' => Some(letter as u32 as u8),
        '–' => Some(0x96),
        '—' => Some(0x97),
        '…' => Some(0x85),
        '€' => Some(0x80),
        '‘' => Some(0x91),
        '’' => Some(0x92),
        '“' => Some(0x93),
        '”' => Some(0x94),
        _ => None,
    }
}

/// Writes the fonts of `letters`, with refs from `next` on: the name of each, and its ref.
pub(super) fn write_fonts(pdf: &mut Pdf, letters: &BTreeSet<char>, next: &mut Ref) -> Vec<(String, Ref)> {
    let blocks: BTreeSet<u32> = letters.iter().copied().map(block).collect();
    let own = |of: u32| letters.iter().copied().filter(move |letter| block(*letter) == of).collect::<Vec<char>>();
    blocks.into_iter().map(|block| (block_name(block), write_font(pdf, &own(block), next))).collect()
}

/// A font of letters of one block, in rising order.
fn write_font(pdf: &mut Pdf, letters: &[char], next: &mut Ref) -> Ref {
    let (id, map) = (next.bump(), next.bump());
    let glyphs: Vec<Ref> = letters.iter().map(|_| next.bump()).collect();
    let codes: Vec<u8> = letters.iter().map(|letter| *letter as u32 as u8).collect();
    let (first, last) = (codes.first().copied().unwrap_or(0), codes.last().copied().unwrap_or(0));
    // Widths are in cells of narrow glyphs, as is everything in the font.
    let advance = |letter: char| letter_strokes(letter).map_or(0.0, |own| own.advance * cell(own.is_wide) / CELL);
    let mut font = pdf.type3_font(id);
    font.bbox(Rect::new(-8.0, -3.0, 16.0, 16.0)).matrix([CELL as f32, 0.0, 0.0, CELL as f32, 0.0, 0.0]);
    let mut procs = font.char_procs();
    for (letter, glyph) in letters.iter().zip(&glyphs) {
        procs.pair(Name(glyph_name(*letter).as_bytes()), *glyph);
    }
    procs.finish();
    let mut differences = font.encoding_custom();
    let mut names = differences.differences();
    for (letter, code) in letters.iter().zip(&codes) {
        names.consecutive(*code, [Name(glyph_name(*letter).as_bytes())]);
    }
    names.finish();
    differences.finish();
    let width = |code: u8| codes.iter().position(|own| *own == code).map_or(0.0, |k| advance(letters[k]) as f32);
    font.first_char(first).last_char(last).widths((first..=last).map(width)).to_unicode(map);
    font.resources().finish();
    font.finish();
    for (letter, glyph) in letters.iter().zip(&glyphs) {
        pdf.stream(*glyph, &drawn(*letter).finish());
    }
    let mut unicode = UnicodeCmap::new(
        Name(b"Toile-Letters"),
        SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"UCS"), supplement: 0 },
    );
    letters.iter().zip(&codes).for_each(|(letter, code)| unicode.pair(*code, *letter));
    pdf.cmap(map, &unicode.finish());
    id
}

fn glyph_name(letter: char) -> String {
    format!("uni{:04X}", letter as u32)
}

/// The strokes of a letter, a cell wide.
fn drawn(letter: char) -> Content {
    let mut content = Content::new();
    let Some(own) = letter_strokes(letter) else { return content };
    let scale = cell(own.is_wide) / CELL;
    let advance = (own.advance * scale) as f32;
    content.start_shape_glyph(advance, -8.0, -3.0, 16.0, 16.0);
    content.transform([scale as f32, 0.0, 0.0, scale as f32, 0.0, 0.0]);
    content.set_line_width(1.0).set_dash_pattern([], 0.0);
    content.set_line_cap(pdf_writer::types::LineCapStyle::RoundCap);
    content.set_line_join(pdf_writer::types::LineJoinStyle::RoundJoin);
    for [from, to] in own.strokes {
        content.move_to(from[0], from[1]).line_to(to[0], to[1]);
    }
    content.stroke();
    content
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_beyond_the_code_page_are_in_a_font_of_their_block() {
        let runs: Vec<(String, Vec<u8>)> = font_runs("a пё 前").into_iter().map(|run| (run.font, run.codes)).collect();
        let of = |font: &str, codes: &[u8]| (font.to_owned(), codes.to_vec());
        let wanted = [of("F", b"a "), of("U04", &[0x3f, 0x51]), of("F", b" "), of("U52", &[0x4d])];
        assert_eq!(runs, wanted);
        assert_eq!(unprintable("пё 前?\u{1f600}").collect::<String>(), "\u{1f600}");
    }
}
