//! The cost of a dealing: girths and distances unlike those of garments that are worn so, rare kinds of garments, and
//! broken mirror symmetry.

use std::f64::consts::TAU;

use super::ends::Ends;
use super::girths::Range;
use super::marks::{Mirror, RimStretch};
use super::openings::GluedOpening;

/// An opening too narrow for what would go through it.
const TOO_NARROW: f64 = 6.0;
/// Half a squared deviation counts in these units of the logarithm: below and above the usual girths.
const BELOW: f64 = 0.15;
const ABOVE: f64 = 0.6;
/// The same for distances between openings, and what is added to both, metres.
const APART: f64 = 0.25;
const APART_SLACK: f64 = 0.02;
/// An opening that nothing passes through, and the unit of its girth's logarithm.
const EMPTY: f64 = 1.5;
const EMPTY_WIDE: f64 = 0.3;
/// Added to [`EMPTY`] at the end of a tube, and not at a hole of a flat sheet: sleeves and legs are seldom empty.
const EMPTY_TUBE: f64 = 3.0;
/// Left and right unlike: of two openings that mirror each other, of one that is its own mirror image (times the share
/// of the cloth that is symmetric with it), and of two that may be either.
const UNLIKE: f64 = 6.0;
const UNLIKE_TWINS: f64 = 3.0;
/// The unit of the logarithm of two girths that differ on the left and the right: a sleeve on one arm, a strap over the
/// other.
const UNEVEN: f64 = 0.5;
/// Both arms alone through one opening, as of a halter, that is not its own mirror image: a top over one shoulder.
const LOPSIDED: f64 = 2.0;

/// The cost of dealing these ends to an opening by its girth, or of leaving it empty.
pub(super) fn girth_cost(opening: &GluedOpening, ends: Ends, range: Range) -> f64 {
    let girth = opening.girth;
    let Range { least, usual: [low, high] } = range;
    let half_square = |x: f64| 0.5 * x * x;
    if ends.is_empty() {
        let like_a_tube = (1.0 + opening.turning / TAU).clamp(0.0, 1.0);
        return EMPTY + EMPTY_TUBE * like_a_tube + half_square(((girth / high).ln() / EMPTY_WIDE).max(0.0));
    }
    if girth < least {
        TOO_NARROW + half_square((least / girth.max(1e-3)).ln() / BELOW)
    } else if girth < low {
        half_square((low / girth).ln() / BELOW)
    } else {
        half_square(((girth / high).ln() / ABOVE).max(0.0))
    }
}

/// The cost of a distance outside its range.
pub(super) fn beyond(distance: f64, [low, high]: [f64; 2]) -> f64 {
    let off =
        |more: f64, less: f64| 0.5 * (((more + APART_SLACK) / (less + APART_SLACK)).ln() / APART).max(0.0).powi(2);
    if distance.is_finite() { off(low, distance) + off(distance, high) } else { 0.0 }
}

/// The cost of both arms or both legs going alone through openings of these girths, if these are unlike.
pub(super) fn uneven([one, other]: [f64; 2]) -> f64 {
    0.5 * ((one / other).ln() / UNEVEN).powi(2)
}

/// How unusual a garment with openings for these sets is.
pub(super) fn prior(ends: &[Ends]) -> f64 {
    let mut sets: Vec<Ends> = ends.iter().copied().filter(|e| !e.is_empty()).collect();
    sets.sort_unstable();
    let is = |list: &[Ends]| {
        let mut list = list.to_vec();
        list.sort_unstable();
        list == sets
    };
    let (head, left, right) = (Ends::HEAD, Ends::LEFT_ARM, Ends::RIGHT_ARM);
    let usual = is(&[head, left, right, Ends::LEGS])
        || is(&[Ends::TOP, Ends::LEFT_LEG, Ends::RIGHT_LEG])
        || is(&[Ends::TOP, Ends::LEGS])
        || is(&[head, left, right, Ends::LEFT_LEG, Ends::RIGHT_LEG]);
    let over_one_shoulder =
        [[left, right.with(head)], [right, left.with(head)]].iter().any(|[a, b]| is(&[*a, *b, Ends::LEGS]));
    if usual {
        0.0
    } else if is(&[left, right, head.with(Ends::LEGS)]) || is(&[head, Ends::ARMS.with(Ends::LEGS)]) {
        0.5
    } else if is(&[Ends::ARMS, head, Ends::LEGS]) || is(&[Ends::ALL]) || over_one_shoulder {
        1.5
    } else {
        4.0
    }
}

/// The cost of breaking the mirror symmetry of openings.
pub(super) struct Unlike {
    /// Of unlike ends of two openings; on the diagonal, of one opening's ends that are not their own mirror image.
    pub(super) pairs: Vec<Vec<f64>>,
    /// Of both arms alone through an opening.
    pub(super) arms: Vec<f64>,
}

/// Finds what it costs to break the mirror symmetry of openings.
pub(super) fn unlike(
    mirror: &Mirror,
    openings: &[GluedOpening],
    stretches: &[Vec<RimStretch>],
    spacing: f64,
) -> Unlike {
    let n = openings.len();
    let maps = |i: usize, j: usize| mirror.maps(&stretches[i], &stretches[j], spacing);
    let symmetric = |i: usize| if maps(i, i) { mirror.symmetric_share(&stretches[i]) } else { 0.0 };
    let arms = (0..n).map(|i| LOPSIDED * (1.0 - symmetric(i))).collect();
    let mut out = vec![vec![0.0; n]; n];
    for i in 0..n {
        let partners: Vec<usize> =
            (0..n).filter(|&j| j != i && openings[i].part == openings[j].part && maps(i, j) && maps(j, i)).collect();
        let own = maps(i, i);
        match partners[..] {
            [] if own => out[i][i] = UNLIKE * symmetric(i),
            [j] if !own => out[i][j] = UNLIKE,
            _ => partners.iter().for_each(|&j| out[i][j] = UNLIKE_TWINS),
        }
    }
    Unlike { pairs: out, arms }
}
