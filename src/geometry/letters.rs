//! Letters of every script as strokes; the only user of unifont.
//!
//! GNU Unifont has a glyph of 16 rows for every letter of the Basic Multilingual Plane. Its dots, joined to their
//! neighbours by round strokes, make letters that a pen could draw.

use unifont::i18n::preprocess_text;
use unifont::{Glyph, get_glyph};

/// Rows of a glyph.
const ROWS: usize = 16;
/// The row on which letters stand; two more are below it.
const FOOT_ROW: usize = 13;
/// Height of the capitals, cells.
pub(crate) const CAPITAL_CELLS: f64 = 10.0;

/// A letter, in cells of its glyph: x from its left side, y **up** from the line on which it stands.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LetterStrokes {
    /// From dot to dot. A dot that touches no other is a stroke from itself to itself. As wide as a cell.
    pub(crate) strokes: Vec<[[f32; 2]; 2]>,
    /// Width with the space to the next letter: 8 or 16, and 0 of an accent that is set on the letter before it.
    pub(crate) advance: f64,
    /// Whether the glyph is 16 cells wide, as those of East Asia are.
    pub(crate) is_wide: bool,
}

/// The strokes of a letter; `None` beyond the Basic Multilingual Plane, and of letters that Unifont does not have.
pub(crate) fn letter_strokes(letter: char) -> Option<LetterStrokes> {
    let glyph = get_glyph(letter)?;
    let is_accent = ('\u{300}'..='\u{36f}').contains(&letter);
    let width = glyph.get_width() as f64;
    let shift = if is_accent { -width } else { 0.0 };
    let place =
        |[column, row]: [usize; 2]| [(column as f64 + 0.5 + shift) as f32, (FOOT_ROW as f64 - row as f64 + 0.5) as f32];
    let strokes = runs(glyph).into_iter().map(|ends| ends.map(place)).collect();
    Some(LetterStrokes { strokes, advance: if is_accent { 0.0 } else { width }, is_wide: glyph.is_fullwidth() })
}

/// Straight rows of dots that touch, each as long as it goes, and the dots that are in none.
fn runs(glyph: &Glyph) -> Vec<[[usize; 2]; 2]> {
    let width = glyph.get_width();
    let dot = |x: usize, y: usize| x < width && glyph.get_pixel(x, y);
    let mut runs = Vec::new();
    let mut joined = [[false; ROWS]; ROWS];
    for (dx, dy) in [(1_isize, 0_usize), (0, 1), (1, 1), (-1, 1)] {
        // A diagonal only where no corner joins the two already.
        let next = |x: usize, y: usize| {
            let (to, below) = (x.checked_add_signed(dx)?, y + dy);
            let round_corner = dx != 0 && dy != 0 && (dot(to, y) || dot(x, below));
            (dot(x, y) && dot(to, below) && !round_corner).then_some((to, below))
        };
        for (y, x) in (0..ROWS).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let before = x.checked_add_signed(-dx).zip(y.checked_sub(dy));
            if before.is_some_and(|(x, y)| next(x, y).is_some()) {
                continue;
            }
            let mut end = (x, y);
            while let Some(to) = next(end.0, end.1) {
                joined[end.1][end.0] = true;
                joined[to.1][to.0] = true;
                end = to;
            }
            if end != (x, y) {
                runs.push([[x, y], [end.0, end.1]]);
            }
        }
    }
    let single = (0..ROWS).flat_map(|y| (0..width).map(move |x| [x, y])).filter(|&[x, y]| dot(x, y) && !joined[y][x]);
    runs.extend(single.map(|at| [at, at]));
    runs
}

/// A text in the order in which its letters stand from left to right: Arabic in its joined forms, and words of scripts
/// that are written from the right turned round. Figures and Latin words among them stay as they are.
pub(crate) fn from_left(text: &str) -> String {
    // The shaping of unifont has no form of these five.
    let shaped = if text.chars().any(|c| ('\u{63b}'..='\u{63f}').contains(&c)) || !text.chars().any(is_leftward) {
        text.to_owned()
    } else {
        preprocess_text(text)
    };
    let mut letters: Vec<char> = shaped.chars().collect();
    let mut at = 0;
    while at < letters.len() {
        if !is_leftward(letters[at]) {
            at += 1;
            continue;
        }
        let more = letters[at..].iter().take_while(|c| is_leftward(**c) || **c == ' ').count();
        let blanks = letters[at..at + more].iter().rev().take_while(|c| **c == ' ').count();
        letters[at..at + more - blanks].reverse();
        at += more;
    }
    letters.into_iter().collect()
}

/// Whether a letter is of a script that is written from the right: Hebrew, Arabic and their relatives.
fn is_leftward(letter: char) -> bool {
    matches!(letter, '\u{590}'..='\u{8ff}' | '\u{fb1d}'..='\u{fdff}' | '\u{fe70}'..='\u{fefc}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_of_many_scripts_have_strokes_within_their_cells() {
        for letter in "пёЖЛщ Ωλ אב ع क 前後袖 한 ế".chars().filter(|c| *c != ' ') {
            let own = letter_strokes(letter).unwrap_or_else(|| panic!("{letter}"));
            assert!(!own.strokes.is_empty(), "{letter}");
            let within = |[x, y]: &[f32; 2]| (0.0..=own.advance as f32).contains(x) && (-2.0..=14.0).contains(y);
            assert!(own.strokes.iter().flatten().all(within), "{letter}: {own:?}");
        }
        assert!(letter_strokes('前').is_some_and(|own| own.is_wide) && !letter_strokes('Ж').is_some_and(|l| l.is_wide));
        assert_eq!(letter_strokes('\u{1f600}'), None);
    }

    #[test]
    fn capitals_are_as_high_as_said() {
        for letter in "НПЕ".chars() {
            let own = letter_strokes(letter).expect("a letter");
            let ys = own.strokes.iter().flatten().map(|p| f64::from(p[1]));
            let (low, high) = ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
            assert_eq!([low, high], [0.5, CAPITAL_CELLS - 0.5], "{letter}");
        }
    }

    #[test]
    fn hebrew_and_arabic_stand_from_the_right() {
        assert_eq!(from_left("front 2"), "front 2");
        assert_eq!(from_left("גב, cut 2"), "בג, cut 2");
        // Joined: beh as it begins a word, and beh as it ends one.
        assert_eq!(from_left("بب"), "\u{fe90}\u{fe91}");
    }
}
