//! Sizes of one pattern drawn over one another, told by the names of their layers.

use super::Stroke;
use super::chain::is_closed;
use super::contour::Contour;
use super::follow::{follows, unevenness};

/// Words that announce a size.
const WORDS: [&str; 9] = ["size", "sizes", "gr", "größe", "grösse", "taille", "talla", "taglia", "maat"];
/// Sizes told by letters.
const LETTERS: [&str; 12] = ["xxs", "xs", "s", "m", "l", "xl", "xxl", "xxxl", "2xl", "3xl", "4xl", "5xl"];
/// Of more outlines than this the first tell whether they are sizes.
const MOST_OUTLINES: usize = 30;
/// Three outlines in one another of which nothing is said are sizes where one follows another so unevenly (metres): a
/// sewing line and a row of stitches keep their distance.
const UNEVEN: f64 = 2e-3;

/// The size that the name of a layer says: `size 38`, `Gr. 38`, `XL`, `38`.
pub(crate) fn size_of(name: &str) -> Option<String> {
    let words: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let is_size = |word: &str| {
        let number = word.parse::<u32>().is_ok_and(|n| n < 200);
        number || LETTERS.contains(&word.to_lowercase().as_str())
    };
    let called = |k: &usize| WORDS.contains(&words[*k].to_lowercase().as_str());
    let after = (0..words.len()).find(called).and_then(|k| words.get(k + 1)).filter(|w| is_size(w));
    let alone = || words.first().filter(|w| words.len() == 1 && is_size(w));
    let glued = || {
        let lower = name.to_lowercase();
        let rest = WORDS.iter().find_map(|word| lower.strip_prefix(word).map(|_| &name[word.len()..]))?;
        rest.parse::<u32>().ok().filter(|n| *n < 200).map(|n| n.to_string())
    };
    after.or_else(alone).map(|w| (*w).to_owned()).or_else(glued)
}

/// The remark on a piece of one size among others.
pub(super) fn size_note(size: &str) -> String {
    format!("size {size}")
}

/// The size that such a remark says.
pub(super) fn noted_size(note: &str) -> Option<&str> {
    note.split(", ").find_map(|said| said.strip_prefix("size "))
}

/// The sizes that strokes are drawn in, in the order of the drawing. None where no outline of one follows that of
/// another round it.
pub(crate) fn sizes(strokes: &[Stroke]) -> Vec<String> {
    let mut sizes: Vec<String> = Vec::new();
    for size in strokes.iter().filter_map(|s| s.size.as_ref()) {
        if !sizes.contains(size) {
            sizes.push(size.clone());
        }
    }
    let is_outline =
        |s: &&Stroke| s.size.is_some() && is_closed(&[((), s.path.clone())]) && s.path.double_area() != 0.0;
    let outlines: Vec<&Stroke> = strokes.iter().filter(is_outline).take(MOST_OUTLINES).collect();
    let nested = |a: &Stroke| outlines.iter().any(|b| a.size != b.size && follows(&a.path, &b.path));
    if sizes.len() > 1 && outlines.iter().any(|a| nested(a)) { sizes } else { Vec::new() }
}

/// Whether three contours, each in the next, are sizes: nothing is said of them, and they do not keep one distance.
pub(super) fn are_sizes(innermost: &Contour, middle: &Contour, outer: &Contour) -> bool {
    let follow = follows(&innermost.whole, &middle.whole) && follows(&middle.whole, &outer.whole);
    let uneven = |a: &Contour, b: &Contour| unevenness(&a.whole, &b.whole) > UNEVEN;
    follow && (uneven(innermost, middle) || uneven(middle, outer))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_told_by_the_names_of_layers() {
        for (name, size) in [("size 38", "38"), ("Gr. 40", "40"), ("XL", "XL"), ("36", "36"), ("Taille 12", "12")] {
            assert_eq!(size_of(name).as_deref(), Some(size));
        }
        assert_eq!(size_of("size36").as_deref(), Some("36"));
        for none in ["Layer 1", "front", "back_2", "path 38", "s-curve", "sew"] {
            assert_eq!(size_of(none), None, "{none}");
        }
    }
}
