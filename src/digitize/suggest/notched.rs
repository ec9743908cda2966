//! Whether the notches of two sides of a seam lie opposite each other.

use super::run::RunNotch;

/// Notches opposite each other lie so near (metres), and as a share of the side's length: programs set them by measure
/// from the end, and ease lies between.
const OPPOSITE: (f64, f64) = (0.006, 0.03);

/// The evidence of the notches of two sides for a seam.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Compared {
    /// Pairs that lie opposite each other.
    pub(super) matched: usize,
    /// Notches of either side that have none opposite.
    pub(super) alone: usize,
    /// Whether a single one lies opposite a double one.
    pub(super) conflict: bool,
}

/// Compares the notches of two sides laid along each other, each with its length.
pub(super) fn compared((a, la): (&[RunNotch], f64), (b, lb): (&[RunNotch], f64)) -> Compared {
    let near = OPPOSITE.0.max(OPPOSITE.1 * la.max(lb)) + (la - lb).abs();
    let mut out = Compared::default();
    let mut left: Vec<&RunNotch> = b.iter().collect();
    for mark in a {
        // From whichever end they were measured.
        let off = |other: &RunNotch| (mark.at - other.at).abs().min(((la - mark.at) - (lb - other.at)).abs());
        let nearest = (0..left.len()).min_by(|&i, &k| off(left[i]).total_cmp(&off(left[k])));
        match nearest.filter(|&k| off(left[k]) <= near) {
            Some(k) => {
                out.conflict |= left[k].double != mark.double;
                out.matched += 1;
                left.remove(k);
            }
            None => out.alone += 1,
        }
    }
    out.alone += left.len();
    out
}

/// The notches walked from the other end.
pub(super) fn reversed(marks: &[RunNotch], length: f64) -> Vec<RunNotch> {
    marks.iter().rev().map(|mark| RunNotch { at: length - mark.at, ..*mark }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notches_match_by_place_and_never_single_to_double() {
        let mark = |at: f64, double: bool| RunNotch { at, double };
        let (front, back) = ([mark(0.1, false)], [mark(0.101, true)]);
        assert!(compared((&front, 0.3), (&back, 0.3)).conflict);
        let same = compared((&front, 0.3), (&[mark(0.103, false), mark(0.25, true)], 0.31));
        assert_eq!((same.matched, same.alone, same.conflict), (1, 1, false));
        assert_eq!(reversed(&front, 0.3), [mark(0.3 - 0.1, false)]);
    }
}
