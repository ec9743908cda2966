//! Pieces that are cut twice and are not their own mirror image: a left and a right one.

use super::Traced;
use crate::geometry::{Path, Vec2};
use crate::pattern::CutKind;

/// Places of an outline at which it is compared with its mirror image.
const LOOKS: usize = 512;
/// An outline is its own mirror image where the two differ by no more than a step between places and this (metres).
const ALIKE: f64 = 1e-3;

/// The piece, as a pair if it is cut an even number of times and is not its own mirror image, unless the drawing says
/// that all are alike.
pub(super) fn handed(piece: Traced, name: &str, notes: &mut Vec<String>) -> Traced {
    let Some(CutKind::Count(count)) = piece.cut_how else { return piece };
    let fold = piece.mirror.is_some() || piece.on_fold.is_some();
    if count % 2 != 0 || piece.alike || fold || piece.outline().is_none_or(|outline| is_symmetric(&outline)) {
        return piece;
    }
    notes.push(format!(
        "'{name}' is cut {count} times and is not its own mirror image: taken as left and right, 'cut: pair'; for \
         pieces of one hand write 'cut: {count}'"
    ));
    Traced { cut_how: Some(CutKind::Pair), copies: piece.copies.max(1) * count / 2, ..piece }
}

/// Whether a closed line is its own mirror image: the distances of its places from their middle are the same both ways
/// round from one of them.
fn is_symmetric(outline: &Path) -> bool {
    let step = outline.length() / LOOKS as f64;
    let points: Vec<Vec2> = (0..LOOKS).map(|k| outline.point(step * k as f64)).collect();
    let middle = points.iter().sum::<Vec2>() / LOOKS as f64;
    let off: Vec<f64> = points.iter().map(|p| (p - middle).norm()).collect();
    let alike = |a: usize, b: usize| (off[a % LOOKS] - off[b % LOOKS]).abs() <= step + ALIKE;
    // The axis goes through a place or between two.
    (0..LOOKS).any(|sum| (0..LOOKS).all(|k| alike(k, sum + LOOKS - k)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(text: &str) -> Path {
        Path::parse_absolute(text, 1e-3).expect("a path")
    }

    #[test]
    fn symmetric_outlines_are_told_whichever_way_their_axis_lies() {
        for text in
            ["M 0 0 H 200 V 300 H 0 Z", "M 20 0 H 180 L 200 300 H 0 Z", "M 0 0 L 150 -150 L 300 300 L -150 150 Z"]
        {
            assert!(is_symmetric(&path(text)), "{text}");
        }
        assert!(!is_symmetric(&path("M 0 0 L 200 10 L 210 200 L 100 320 Z")));
        assert!(!is_symmetric(&path("M 0 0 L 150 100 V 350 L 0 250 Z")), "a parallelogram");
        assert!(is_symmetric(&path("M 100 0 A 100 100 0 0 1 100 200 A 100 100 0 0 1 100 0 Z")));
    }

    #[test]
    fn two_of_an_asymmetric_piece_are_left_and_right() {
        let piece = |text: &str, alike: bool| Traced {
            sew: vec![(None, path(text))],
            cut_how: Some(CutKind::Count(2)),
            copies: 1,
            alike,
            ..Traced::default()
        };
        let mut notes = Vec::new();
        let front = "M 0 0 H 200 L 220 300 H 0 Z";
        assert_eq!(handed(piece(front, false), "front", &mut notes).cut_how, Some(CutKind::Pair));
        assert!(notes.len() == 1 && notes[0].contains("'cut: 2'"), "{notes:?}");
        assert_eq!(handed(piece(front, true), "front", &mut notes).cut_how, Some(CutKind::Count(2)));
        assert_eq!(
            handed(piece("M 0 0 H 90 V 80 H 0 Z", false), "pocket", &mut notes).cut_how,
            Some(CutKind::Count(2))
        );
    }
}
