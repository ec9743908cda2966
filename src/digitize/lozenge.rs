//! Closed lines within a piece that are fish-eye darts: pointed at both ends, and symmetric about the line between.

use crate::geometry::{Path, Vec2, box_of, distance_to_segment, sides_of};

/// Least length of a fish-eye, metres.
const LEAST_LENGTH: f64 = 0.03;
/// Least and largest intake of a fish-eye, metres.
const INTAKE: (f64, f64) = (2e-3, 0.08);
/// Largest intake of a fish-eye, as a share of its length.
const WIDEST: f64 = 0.5;
/// At this share of its length from either tip it is no wider than that share of its intake: it is pointed.
const POINTED: (f64, f64) = (0.05, 0.36);
/// Its halves are each other's mirror images to this (metres), or to this share of the intake.
const ALIKE: (f64, f64) = (3e-4, 0.02);
/// Largest sideways distance of the tips of an upright fish-eye, metres.
const UPRIGHT: f64 = 3e-4;
/// Largest distance of legs from straight lines, metres. A larger one is reported.
const STRAIGHT: f64 = 1e-3;
/// Largest distance of curves from the chords that replace them, metres.
const COARSE: f64 = 2e-5;
/// Largest number of points of such chords.
const MOST_POINTS: usize = 400;

/// A fish-eye dart, metres.
#[derive(Clone, Debug)]
pub(super) struct FishEye {
    pub(super) name: String,
    /// The middle of its widest line.
    pub(super) at: Vec2,
    pub(super) intake: f64,
    /// Its length above that line and below.
    pub(super) up: f64,
    pub(super) down: f64,
}

/// A closed line that is a fish-eye dart.
pub(super) struct Lozenge {
    /// The dart, if it is upright: others a garment file does not know.
    pub(super) dart: Option<FishEye>,
    /// Whether its legs are bent, where a dart's are straight.
    pub(super) is_bent: bool,
}

impl Lozenge {
    pub(super) fn of(path: &Path) -> Option<Self> {
        let points = path.sampled(COARSE);
        if points.len() < 4 || points.len() > MOST_POINTS || (path.start() - path.end()).norm() > COARSE {
            return None;
        }
        let [low, high] = box_of(points.iter().copied());
        if (high - low).norm() < LEAST_LENGTH {
            return None;
        }
        let [one, other] = farthest(&points);
        let [top, bottom] = if one.y <= other.y { [one, other] } else { [other, one] };
        let length = (bottom - top).norm();
        let along = (bottom - top).try_normalize(0.0)?;
        let place = |p: Vec2| along.dot(&(p - top));
        let aside = |p: Vec2| along.perp(&(p - top));
        let widest = points.iter().copied().max_by(|a, b| aside(*a).abs().total_cmp(&aside(*b).abs()))?;
        let intake = 2.0 * aside(widest).abs();
        if length < LEAST_LENGTH || !(INTAKE.0..=INTAKE.1.min(WIDEST * length)).contains(&intake) {
            return None;
        }
        let alike = ALIKE.0.max(ALIKE.1 * intake);
        let is_on = |p: Vec2| sides_of(&points).any(|side| distance_to_segment(p, side) <= alike);
        let image = |p: Vec2| p - 2.0 * aside(p) * Vec2::new(-along.y, along.x);
        let near_tip = |p: &&Vec2| place(**p).min(length - place(**p)) <= POINTED.0 * length;
        let pointed = points.iter().filter(near_tip).all(|p| 2.0 * aside(*p).abs() <= POINTED.1 * intake);
        let blunt = sides_of(&points).any(|[a, b]| {
            // A long side may pass the place that is looked at without a point there.
            [POINTED.0 * length, (1.0 - POINTED.0) * length].into_iter().any(|at| {
                let (from, to) = (place(a), place(b));
                let share = (at - from) / (to - from);
                (0.0..=1.0).contains(&share) && 2.0 * aside(a + share * (b - a)).abs() > POINTED.1 * intake
            })
        });
        if !pointed || blunt || !points.iter().all(|p| is_on(image(*p))) {
            return None;
        }
        let corners = [top, widest, bottom, image(widest)];
        let legs = (0..4).map(|k| [corners[k], corners[(k + 1) % 4]]);
        let off = |p: &Vec2| legs.clone().map(|leg| distance_to_segment(*p, leg)).fold(f64::INFINITY, f64::min);
        let is_bent = points.iter().map(off).fold(0.0, f64::max) > STRAIGHT;
        let up = place(widest);
        let at = top + along * up;
        let dart = FishEye { name: String::new(), at, intake, up, down: length - up };
        let upright = (bottom.x - top.x).abs() <= UPRIGHT;
        Some(Self { dart: upright.then_some(dart), is_bent })
    }
}

/// The two points farthest from each other.
fn farthest(points: &[Vec2]) -> [Vec2; 2] {
    let mut best = [points[0], points[0]];
    for (i, a) in points.iter().enumerate() {
        for b in &points[i + 1..] {
            if (a - b).norm() > (best[0] - best[1]).norm() {
                best = [*a, *b];
            }
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<Lozenge> {
        Lozenge::of(&Path::parse_absolute(text, 1e-3).expect("a path"))
    }

    #[test]
    fn lozenges_are_darts_and_welts_and_eyelets_are_not() {
        let dart = read("M 100 90 L 110 150 L 100 250 L 90 150 Z").expect("a lozenge").dart.expect("upright");
        assert!((dart.at - Vec2::new(0.1, 0.15)).norm() < 1e-9 && (dart.intake - 0.02).abs() < 1e-9);
        assert!((dart.up - 0.06).abs() < 1e-9 && (dart.down - 0.1).abs() < 1e-9);
        let bent = read("M 0 0 C 0 0 -11 128 -11 160 C -11 176 0 242 0 242 C 0 242 11 176 11 160 C 11 128 0 0 0 0 Z");
        assert!(bent.is_some_and(|l| l.dart.is_some()));
        let tilted = read("M 0 0 L 70 50 L 100 100 L 50 70 Z").expect("a lozenge");
        assert!(tilted.dart.is_none());
        for none in [
            "M 0 0 H 10 V 150 H 0 Z",
            "M 0 0 L 30 50 L 0 160 L -10 50 Z",
            "M 0 0 H 100 V 110 L 50 130 L 0 110 Z",
            "M 0 30 A 10 30 0 0 1 20 30 A 10 30 0 0 1 0 30 Z",
            "M 50 0 L 100 50 L 50 100 L 0 50 Z",
        ] {
            assert!(read(none).is_none(), "{none}");
        }
    }
}
