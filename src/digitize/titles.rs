//! Titles and numbers that are written on pieces.

use super::Remark;
use super::said::said;
use crate::geometry::Vec2;

/// Most letters of a title: longer texts are instructions.
const LONGEST: usize = 40;
/// First words of texts that are no titles, also with `line` after them: a grainline.
const OTHER: [&str; 16] = [
    "cut", "grain", "fold", "place", "size", "date", "for", "by", "material", "fabric", "scale", "test", "page",
    "notch", "center", "centre",
];
/// Words before a title, and before a number.
const TITLE: [&str; 3] = ["piece name", "name", "title"];
const NUMBER: [&str; 7] = ["piece", "no", "nr", "number", "part", "#", "pattern piece"];

/// The title and the number on a piece, each with the number of its remark.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Titles {
    /// The text in the largest letters that is a title; of several as large the first.
    pub(super) title: Option<(usize, String)>,
    /// A number, or a single letter.
    pub(super) number: Option<(usize, String)>,
}

/// The title and the number among the remarks on a piece, which lie where `holds` says.
pub(super) fn titles(remarks: &[Remark], holds: impl Fn(Vec2) -> bool) -> Titles {
    let own: Vec<(usize, &Remark)> = remarks.iter().enumerate().filter(|(_, remark)| holds(remark.at)).collect();
    let largest = |texts: Vec<(usize, f64, String)>| {
        let first = |best: Option<(usize, f64, String)>, next: (usize, f64, String)| match best {
            Some(best) if best.1 >= next.1 => Some(best),
            _ => Some(next),
        };
        texts.into_iter().fold(None, first).map(|(i, _, text)| (i, text))
    };
    let of = |read: fn(&str) -> Option<String>| {
        own.iter().filter_map(|(i, remark)| Some((*i, remark.height, read(&remark.text)?))).collect()
    };
    Titles { title: largest(of(title)), number: largest(of(number)) }
}

/// The words of a text that is a title: `Front`, `Piece name: Front`.
fn title(text: &str) -> Option<String> {
    let text = text.trim();
    let words = match text.split_once(':') {
        Some((key, value)) => TITLE.contains(&key.trim().to_lowercase().as_str()).then(|| value.trim())?,
        None => text,
    };
    let first = words.split(|c: char| !c.is_alphanumeric()).find(|word| !word.is_empty())?.to_lowercase();
    let letters = words.chars().filter(|c| c.is_alphabetic()).count();
    let is_title = letters > 1
        && !first.starts_with(|c: char| c.is_ascii_digit())
        && words.chars().count() <= LONGEST
        && !OTHER.contains(&first.strip_suffix("line").unwrap_or(&first))
        && number(words).is_none()
        && said(words).is_none();
    is_title.then(|| words.to_owned())
}

/// The number of a text that is one: `3`, `3a`, `A`, `Piece 3`, `#3`.
fn number(text: &str) -> Option<String> {
    let lower = text.trim().to_lowercase();
    let after = NUMBER.iter().filter_map(|word| lower.strip_prefix(word)).map(|rest| rest.len()).min();
    let trimmed = text.trim();
    let rest = after.and_then(|rest| trimmed.get(trimmed.len().checked_sub(rest)?..)).unwrap_or(trimmed);
    let own = rest.trim_start_matches(['.', ':', ' ', '#']).trim();
    let digits = own.chars().take_while(char::is_ascii_digit).count();
    let letters = own.chars().skip(digits).filter(|c| c.is_alphabetic()).count();
    let all = own.chars().count();
    let short = (1..=3).contains(&digits) && letters <= 1 || digits == 0 && letters == 1 && after.is_none();
    (short && digits + letters == all).then(|| own.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn titles_and_numbers_are_told_from_other_texts() {
        for (text, wanted) in [("Front", "Front"), ("Piece name: Back yoke", "Back yoke"), ("рукав", "рукав")]
        {
            assert_eq!(title(text).as_deref(), Some(wanted), "{text}");
        }
        for none in
            ["cut 2", "Grainline", "Size: 38", "38", "3", "A", "2 x shell", "on a long instruction ".repeat(3).trim()]
        {
            assert_eq!(title(none), None, "{none}");
        }
        for (text, wanted) in [("3", "3"), ("Piece 3", "3"), ("#12", "12"), ("No. 4", "4"), ("A", "A"), ("2b", "2b")] {
            assert_eq!(number(text).as_deref(), Some(wanted), "{text}");
        }
        for none in ["cut 2", "Front", "1234", "38 cm", "Nose", "part of it"] {
            assert_eq!(number(none), None, "{none}");
        }
    }

    #[test]
    fn the_largest_letters_are_the_title() {
        let remark = |text: &str, height: f64| Remark { at: Vec2::zeros(), text: text.to_owned(), height };
        let remarks = [remark("Shirt 42", 3.0), remark("Front", 7.0), remark("cut 2", 9.0), remark("1", 12.0)];
        let found = titles(&remarks, |_| true);
        assert_eq!(found, Titles { title: Some((1, "Front".into())), number: Some((3, "1".into())) });
        assert_eq!(titles(&remarks, |_| false), Titles::default());
    }
}
