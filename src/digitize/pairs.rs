//! Pieces that are drawn twice, left and right.

use nalgebra::Matrix2;

use super::{Fastener, Traced};
use crate::geometry::{Path, Vec2};
use crate::pattern::{CutKind, Side};

/// Largest distance of two outlines that are alike, metres: rounding of programs, and less than any hand draws.
const ALIKE: f64 = 5e-5;
/// Places of an outline that are looked at.
const LOOKS: usize = 60;
/// Among more pieces than this nobody looks for twins.
const MOST: usize = 300;

/// The pieces, each pair of mirror images as one that is cut as a pair. Names that differ by `left` and `right` or `L`
/// and `R` alone say so. Without such words the outline must have a left and a right, or it may be two of the same.
pub(super) fn paired(pieces: &[Traced]) -> Vec<Traced> {
    let mut left: Vec<Option<&Traced>> = pieces.iter().map(Some).collect();
    let mut out = Vec::new();
    for i in 0..left.len() {
        let Some(piece) = left[i].take() else { continue };
        let twin = (i + 1..left.len().min(MOST)).find(|&k| left[k].is_some_and(|other| are_twins(piece, other)));
        out.push(match twin {
            Some(k) => {
                left[k] = None;
                let (side, stem) = sided(&piece.name);
                let twins = pieces[k].fasteners.iter().filter_map(|f| mirrored(f, &pieces[k], piece));
                let fasteners = piece.fasteners.iter().copied().chain(twins).collect();
                Traced { name: stem, cut_how: Some(CutKind::Pair), drawn: side, fasteners, ..piece.clone() }
            }
            None => piece.clone(),
        });
    }
    out
}

/// A fastener of a piece where it is on its mirror image: buttonholes of one half lie over buttons of the other.
fn mirrored(fastener: &Fastener, piece: &Traced, image: &Traced) -> Option<Fastener> {
    let mirror = Matrix2::new(-1.0, 0.0, 0.0, 1.0);
    let from = low_corner(&piece.outline()?.mapped(mirror, Vec2::zeros()));
    Some(Fastener { at: mirror * fastener.at - from + low_corner(&image.outline()?), ..*fastener })
}

fn are_twins(one: &Traced, other: &Traced) -> bool {
    if [one, other].iter().any(|p| p.cut_how.is_some() || p.on_fold.is_some() || p.mirror.is_some()) {
        return false;
    }
    let ((side, stem), (across, other_stem)) = (sided(&one.name), sided(&other.name));
    if stem != other_stem || side.map(Side::other) != across {
        return false;
    }
    let (Some(a), Some(b)) = (one.outline(), other.outline()) else { return false };
    let mirror = Matrix2::new(-1.0, 0.0, 0.0, 1.0);
    are_alike(&a, &b.mapped(mirror, Vec2::zeros())) && (side.is_some() || !are_alike(&a, &b))
}

/// Whether two outlines are the same but for their places.
fn are_alike(a: &Path, b: &Path) -> bool {
    if (a.length() - b.length()).abs() > LOOKS as f64 * ALIKE {
        return false;
    }
    let at_origin = |path: &Path| path.mapped(Matrix2::identity(), -low_corner(path));
    let (a, b) = (at_origin(a), at_origin(b));
    let lies_on = |path: &Path, other: &Path| {
        (0..LOOKS).all(|k| other.nearest(path.point(path.length() * k as f64 / LOOKS as f64)).1 <= ALIKE)
    };
    lies_on(&a, &b) && lies_on(&b, &a)
}

/// Least coordinates of a path.
pub(super) fn low_corner(path: &Path) -> Vec2 {
    path.sampled(ALIKE / 10.0).iter().fold(path.start(), |low, p| low.inf(p))
}

/// The side a name says, and the name without it.
fn sided(name: &str) -> (Option<Side>, String) {
    let side_of = |word: &str| match word.to_lowercase().as_str() {
        "l" | "left" => Some(Side::Left),
        "r" | "right" => Some(Side::Right),
        _ => None,
    };
    let words: Vec<&str> = name.split(|c: char| !c.is_alphanumeric()).filter(|w| !w.is_empty()).collect();
    let sides: Vec<Side> = words.iter().filter_map(|w| side_of(w)).collect();
    let [side] = sides[..] else { return (None, name.to_owned()) };
    let rest: Vec<&str> = words.into_iter().filter(|w| side_of(w).is_none()).collect();
    (Some(side), rest.join("_"))
}
