//! Text on a piece that tells how it is cut.

use crate::pattern::CutKind;

/// Most copies of a piece that words ask for.
const MOST: usize = 100;
/// Small numbers as words.
const NUMBERS: [(&str, usize); 6] = [("one", 1), ("two", 2), ("three", 3), ("four", 4), ("six", 6), ("eight", 8)];
/// Words that say that a piece is cut once as drawn and once mirrored.
const MIRRORED: [&str; 5] = ["left and right", "l and r", "mirror", "pair", "l/r"];
/// Words that say that all are of one hand.
const ALIKE: [&str; 3] = ["alike", "identical", "same way"];
/// Words that say that a piece lies on the fold.
const ON_FOLD: [&str; 3] = ["on fold", "on the fold", "on a fold"];

/// Meaning of the text on a piece about its cutting.
#[derive(Debug, PartialEq)]
pub(super) enum Said {
    /// So, and so many times over.
    Cut(CutKind, usize),
    /// So often on the fold of the cloth. Where that is, is not in the words.
    OnFold(usize),
}

/// `cut 2 (left and right)`, `Cut 1 pair`, `2 pairs`, `cut 4`, `cut 2x`, `2x cut`, `CUT 1 ON FOLD`: how a piece is cut,
/// as makers write it on.
pub(super) fn said(text: &str) -> Option<Said> {
    let text = text.to_lowercase();
    let words: Vec<&str> = text.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let at = words.iter().position(|w| *w == "cut");
    let pairs = || {
        let k = words.iter().position(|w| w.starts_with("pair"))?;
        number(words.get(k.checked_sub(1)?)?)
    };
    let beside = at.and_then(|k| {
        let next = words.get(k + 1).and_then(|w| number(w));
        next.or_else(|| k.checked_sub(1).and_then(|k| number(words[k])))
    });
    let says = |known: &[&str]| known.iter().any(|known| text.contains(known));
    // `2 pairs` are two of either hand. `cut 2, a pair` is one.
    if let Some(count) = pairs().filter(|count| (1..=MOST).contains(count)) {
        return Some(Said::Cut(CutKind::Pair, count));
    }
    match beside? {
        count @ 1..=MOST if says(&ON_FOLD) => Some(Said::OnFold(count)),
        1 if says(&MIRRORED) => Some(Said::Cut(CutKind::Pair, 1)),
        count @ 2..=MOST if says(&MIRRORED) && count % 2 == 0 => Some(Said::Cut(CutKind::Pair, count / 2)),
        count @ 2..=MOST => Some(Said::Cut(CutKind::Count(count), 1)),
        _ => None,
    }
}

/// Whether such a text says that all are of one hand.
pub(super) fn says_alike(text: &str) -> bool {
    let text = text.to_lowercase();
    ALIKE.iter().any(|word| text.contains(word))
}

/// `2`, `2x`, `x2`, `two`.
fn number(word: &str) -> Option<usize> {
    let named = NUMBERS.iter().find(|(name, _)| *name == word).map(|(_, number)| *number);
    named.or_else(|| word.trim_matches('x').parse().ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn makers_say_in_many_ways_how_often_a_piece_is_cut() {
        let count = |n| Some(Said::Cut(CutKind::Count(n), 1));
        for two in ["cut 2", "Cut 2x", "2x cut", "CUT TWO", "sleeve: cut x2", "cut: 2, shell"] {
            assert_eq!(said(two), count(2), "{two}");
        }
        for (pairs, over) in
            [("cut 1 pair", 1), ("2 pairs", 2), ("cut 4 mirrored", 2), ("cut 2 (left and right)", 1), ("one pair", 1)]
        {
            assert_eq!(said(pairs), Some(Said::Cut(CutKind::Pair, over)), "{pairs}");
        }
        assert_eq!(said("cut 1 on fold"), Some(Said::OnFold(1)));
        for nothing in ["cut 1", "cut here", "undercut 2", "haircut", "cut 999999999999999999999", "size 2"] {
            assert_eq!(said(nothing), None, "{nothing}");
        }
    }
}
