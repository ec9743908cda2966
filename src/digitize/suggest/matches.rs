//! Two runs that may be sewn together, and how much speaks for it.

use std::f64::consts::FRAC_PI_2;

use super::notched::{compared, reversed};
use super::over_darts::are_legs;
use super::run::{EdgeRun, LOOKS};
use super::{Outline, Tolerance};

/// A run that bends aside by less than this share of its chord is straight.
pub(super) const STRAIGHT: f64 = 0.015;
/// Courses are alike that differ by no more than this share of how far they bend.
const ALIKE: f64 = 0.2;
/// Two runs that both lie farther than this share of their chords within their pieces are not sewn to each other:
/// necklines and armholes. With 0.11, which sides that are nipped in at the waist need, two of 17 seams offered for the
/// shipped patterns were wrong, and none of 18 with this.
const HOLLOW: f64 = 0.04;
/// Long runs along the grain may both be hollow up to this: sides that are nipped in at the waist, and the seams of a
/// two-part sleeve at the elbow. Necklines and armholes are shorter than this (metres).
const NIPPED: f64 = 0.09;
const NIPPED_LENGTH: f64 = 0.3;
/// That two shorter runs are alike says nothing where both lie farther than this share within their pieces.
const SCOOPED: f64 = 0.015;
/// Runs that are sewn together lie alike to the grain, to this (radians, 12 degrees); farther apart than the second (45
/// degrees) they seldom are.
const TO_GRAIN: [f64; 2] = [0.21, 0.79];
/// Within this of square to the grain (radians, 8 degrees) lie hems and waists.
const SQUARE: f64 = 0.14;
/// Sides of one piece that are sewn to each other, as those of a sleeve, are so long, as a share of how far they are
/// apart: shorter are the sides of collars, longer those of bands.
const SLEEVE: std::ops::Range<f64> = 0.6..5.0;
/// Two runs that both lie farther than this share of their chords outside these (hems) are not sewn to each other.
const BULGING: f64 = -0.06;
/// Points for the legs of a dart.
pub(super) const DART_SCORE: f64 = 6.0;

/// Two runs, and what speaks for a seam.
#[derive(Clone, Debug)]
pub(super) struct Match {
    pub(super) a: EdgeRun,
    pub(super) b: EdgeRun,
    /// Whether the start of the one meets the end of the other.
    pub(super) opposed: bool,
    /// Whether one is longer, and eased in.
    pub(super) eased: bool,
    /// How much speaks for it; no unit.
    pub(super) score: f64,
    pub(super) reasons: Vec<String>,
}

impl Match {
    pub(super) fn meets(&self, other: &Self) -> bool {
        [&self.a, &self.b].iter().any(|run| run.meets(&other.a) || run.meets(&other.b))
    }

    /// Whether it has all that another match has.
    pub(super) fn holds(&self, other: &Self) -> bool {
        (self.a.holds(&other.a) && self.b.holds(&other.b)) || (self.a.holds(&other.b) && self.b.holds(&other.a))
    }
}

/// A side is longer than the one that it is sewn to by no more than this share, which is eased in, or by the second
/// where both come as many corners after another seam of their pieces. It is no shorter than this (metres).
const EASED: [f64; 2] = [0.03, 0.11];
const EASED_LENGTH: f64 = 0.06;
/// The note on two sides of one course.
const SAME_COURSE: &str = "same course";
/// Points for that order.
const IN_STEP: f64 = 1.0;

/// A seam of two sides that run down the grain, of which one is a little longer.
pub(super) fn eased(
    outlines: &[Outline],
    [a, b]: [&EdgeRun; 2],
    tolerance: Tolerance,
    opposed: bool,
    in_step: impl Fn(&Match) -> bool,
) -> Option<Match> {
    let (short, long) = if a.length() <= b.length() { (a, b) } else { (b, a) };
    let more = long.length() - short.length();
    let down = |run: &EdgeRun| to_grain(outlines, run).is_some_and(|angle| angle <= TO_GRAIN[0]);
    let fits =
        more > tolerance.of(long.length()) && more <= EASED[1] * short.length() && short.length() >= EASED_LENGTH;
    if short.piece == long.piece || !fits || !down(a) || !down(b) || a.hollow().min(b.hollow()) > NIPPED {
        return None;
    }
    let mut found = one(outlines, short, long, opposed, 1.0)?;
    found.eased = true;
    found.reasons.push("the longer one is eased in".to_owned());
    if in_step(&found) {
        found.score += IN_STEP;
        found.reasons.push("they follow other seams of both".to_owned());
    } else if more > EASED[0] * short.length() || !found.reasons.iter().any(|reason| reason == SAME_COURSE) {
        return None;
    }
    Some(found)
}

/// Both ways to lay two runs along each other, the better first; none where no seam is there.
pub(super) fn matches(outlines: &[Outline], a: &EdgeRun, b: &EdgeRun, tolerance: Tolerance) -> Vec<Match> {
    let off = (a.length() - b.length()).abs();
    let most = tolerance.of(a.length().max(b.length()));
    let is_side = |run: &EdgeRun| {
        run.length() >= NIPPED_LENGTH && to_grain(outlines, run).is_some_and(|angle| angle <= TO_GRAIN[0])
    };
    let hollow = if is_side(a) && is_side(b) { NIPPED } else { HOLLOW };
    if off > most || a.hollow().min(b.hollow()) > hollow || a.hollow().max(b.hollow()) < BULGING {
        return Vec::new();
    }
    let mut found: Vec<Match> =
        ways(outlines, a, b).iter().filter_map(|&way| one(outlines, a, b, way, off / most)).collect();
    found.sort_by(|x, y| y.score.total_cmp(&x.score));
    found
}

/// Whether two runs may be walked against each other (`true`) or along each other. Right sides lie together where they
/// are walked against each other, else one of them must be a mirror image.
pub(super) fn ways(outlines: &[Outline], a: &EdgeRun, b: &EdgeRun) -> &'static [bool] {
    if outlines[a.piece].mirrored || outlines[b.piece].mirrored { &[true, false] } else { &[true] }
}

fn one(outlines: &[Outline], a: &EdgeRun, b: &EdgeRun, opposed: bool, off: f64) -> Option<Match> {
    let mut score = 2.0 - off;
    let mut reasons = Vec::new();
    let mut count = |points: f64, reason: &str| {
        score += points;
        if points > 0.0 && !reason.is_empty() {
            reasons.push(reason.to_owned());
        }
    };
    let (points, reason) = by_notches(a, b, opposed)?;
    count(points, reason);
    let (points, reason) = by_course(a, b, opposed);
    count(points, reason);
    if a.piece == b.piece {
        count(-0.5, "");
        if !may_close(a, b, opposed) {
            return None;
        }
    } else {
        let (points, reason) = by_grain(outlines, a, b);
        count(points, reason);
        if outlines[a.piece].material != outlines[b.piece].material {
            count(-1.0, "");
        }
    }
    Some(Match { a: a.clone(), b: b.clone(), opposed, eased: false, score, reasons })
}

/// The evidence of notches. `None` where a single one would meet a double one.
fn by_notches(a: &EdgeRun, b: &EdgeRun, opposed: bool) -> Option<(f64, &'static str)> {
    let marks = if opposed { reversed(&b.marks, b.length()) } else { b.marks.clone() };
    let inside = compared((&a.marks, a.length()), (&marks, b.length()));
    let [start, end] = b.end_marks;
    let across = if opposed { [end, start] } else { [start, end] };
    let ends = a.end_marks.iter().zip(across);
    let (mut matched, mut alone, mut conflict) = (inside.matched, inside.alone, inside.conflict);
    for (one, other) in ends {
        match (*one, other) {
            (Some(one), Some(other)) => {
                matched += 1;
                conflict |= one != other;
            }
            (None, None) => {}
            _ => alone += 1,
        }
    }
    if conflict {
        return None;
    }
    Some(match matched {
        0 => (-0.75 * alone.min(2) as f64, ""),
        _ => (2.0 + 0.5 * (matched.min(3) - 1) as f64 - 0.5 * alone.min(3) as f64, "notches match"),
    })
}

/// How far the courses differ, as a share of how far they bend: as mirror images or the same, and as one in the other.
fn differences(a: &EdgeRun, b: &EdgeRun, opposed: bool) -> [f64; 2] {
    let most = a.bow().max(b.bow()).max(f64::MIN_POSITIVE);
    let across = |k: usize| b.profile[if opposed { LOOKS - 1 - k } else { k }];
    [1.0, -1.0].map(|sign| (0..LOOKS).map(|k| (a.profile[k] - sign * across(k)).abs()).fold(0.0, f64::max) / most)
}

fn by_course(a: &EdgeRun, b: &EdgeRun, opposed: bool) -> (f64, &'static str) {
    if a.bow().max(b.bow()) < STRAIGHT {
        return (0.25, "");
    }
    // Armholes and necklines are alike, too.
    let scooped = a.hollow().min(b.hollow()) > SCOOPED && a.length() < NIPPED_LENGTH;
    match differences(a, b, opposed) {
        [same, _] if same <= ALIKE && scooped => (0.0, ""),
        [same, _] if same <= ALIKE => (1.5, SAME_COURSE),
        [_, inverse] if inverse <= ALIKE => (1.25, "courses fit into each other"),
        [same, inverse] if same.min(inverse) <= 2.0 * ALIKE => (0.5, ""),
        _ if a.bow().min(b.bow()) < STRAIGHT => (-1.0, ""),
        _ => (-0.5, ""),
    }
}

/// Angle of a run to the grain, from 0 to a right one.
pub(super) fn to_grain(outlines: &[Outline], run: &EdgeRun) -> Option<f64> {
    let (warp, along) = (outlines[run.piece].warp?, run.along()?);
    Some(along.perp(&warp).abs().atan2(along.dot(&warp).abs()))
}

fn by_grain(outlines: &[Outline], a: &EdgeRun, b: &EdgeRun) -> (f64, &'static str) {
    let (Some(one), Some(other)) = (to_grain(outlines, a), to_grain(outlines, b)) else { return (0.0, "") };
    let apart = (one - other).abs();
    if apart > TO_GRAIN[1] {
        (-1.5, "")
    } else if apart > TO_GRAIN[0] {
        (0.0, "")
    } else if one.min(other) > FRAC_PI_2 - SQUARE {
        (-0.5, "")
    } else {
        (1.0, "alike to the grain")
    }
}

/// Whether two sides of one piece may be sewn to each other, as those of a sleeve: mirror images that are long for how
/// far they are apart.
fn may_close(a: &EdgeRun, b: &EdgeRun, opposed: bool) -> bool {
    let middle = |run: &EdgeRun| run.path.point(run.length() / 2.0);
    let apart = (middle(a) - middle(b)).norm();
    opposed
        && SLEEVE.contains(&(a.length() / apart))
        && differences(a, b, true)[0] <= ALIKE.max(STRAIGHT / a.bow().max(1e-9))
}

/// The legs of a dart that is drawn as a wedge in the outline: runs that follow each other round its tip.
pub(super) fn dart(a: &EdgeRun, b: &EdgeRun, angle: f64) -> Option<Match> {
    let reasons = vec!["legs of a dart".to_owned()];
    are_legs([a.length(), b.length()], angle).then(|| Match {
        a: a.clone(),
        b: b.clone(),
        opposed: true,
        eased: false,
        score: DART_SCORE,
        reasons,
    })
}
