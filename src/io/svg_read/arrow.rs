//! Arrows drawn as one element: a straight shaft with barbs at one end or both.

use crate::geometry::{Path, Vec2};

/// No grain arrow is shorter (metres).
const SHORTEST: f64 = 0.02;
/// Largest distance of a barb's end from the end of its shaft along the shaft: a share of its length, and metres.
const BARBS: (f64, f64) = (0.25, 0.04);
/// Largest distance of a barb's end aside of its shaft: a share of its length, and metres.
const ASIDE: (f64, f64) = (0.15, 0.02);
/// Barbs go back from the tip by no less than this share of how far they go aside.
const BACK: f64 = 0.2;
/// Nearer to the shaft's line than this (metres) a point is on it.
const ON_SHAFT: f64 = 2e-4;
/// More points than this are no arrow.
const MOST_POINTS: usize = 40;

/// The shaft of the arrow that these lines make together, from its tail to its head.
pub(super) fn shaft(lines: &[Path]) -> Option<Path> {
    let points: Vec<Vec2> = lines.iter().flat_map(|line| line.joints().iter().map(|&s| line.point(s))).collect();
    if points.len() > MOST_POINTS {
        return None;
    }
    let sides = lines.iter().flat_map(|line| line.beziers().filter(|(_, controls, _)| controls.is_none()));
    let [a, b] =
        sides.map(|(from, _, to)| [from, to]).max_by(|x, y| (x[1] - x[0]).norm().total_cmp(&(y[1] - y[0]).norm()))?;
    let length = (b - a).norm();
    let along = (b - a).try_normalize(0.0).filter(|_| length >= SHORTEST)?;
    let place = |p: Vec2| along.dot(&(p - a));
    let aside = |p: Vec2| along.perp(&(p - a));
    let near = |p: &Vec2| {
        let off_end = place(*p).abs().min((place(*p) - length).abs());
        off_end <= BARBS.0 * length && off_end <= BARBS.1 && aside(*p).abs() <= (ASIDE.0 * length).min(ASIDE.1)
    };
    // An arrowhead has a point to either side, back from its tip: the bars of a buttonhole are square to the line.
    let has_head = |at_end: bool| {
        let off = |p: Vec2| place(p).abs().min((place(p) - length).abs());
        let own = |p: &&Vec2| {
            (place(**p) > 0.5 * length) == at_end && aside(**p).abs() > ON_SHAFT && off(**p) >= BACK * aside(**p).abs()
        };
        let sides: Vec<f64> = points.iter().filter(own).map(|p| aside(*p)).collect();
        sides.iter().any(|s| *s > 0.0) && sides.iter().any(|s| *s < 0.0)
    };
    let heads = [has_head(false), has_head(true)];
    if !points.iter().all(near) || heads == [false, false] {
        return None;
    }
    Some(if heads == [true, false] { Path::line(b, a) } else { Path::line(a, b) })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Option<[Vec2; 2]> {
        let lines: Vec<Path> = Path::parse_many(text)
            .expect("lines")
            .iter()
            .map(|p| p.mapped(nalgebra::Matrix2::identity() * 1e-3, Vec2::zeros()))
            .collect();
        shaft(&lines).map(|p| [p.start(), p.end()].map(|p| p * 1e3))
    }

    #[test]
    fn arrows_are_told_from_straps_and_darts() {
        let two =
            read("M 150 300 L 150 80 M 150 80 L 146 92 L 154 92 L 150 80 M 150 300 L 146 288 L 154 288 L 150 300");
        assert_eq!(two, Some([Vec2::new(150.0, 300.0), Vec2::new(150.0, 80.0)]));
        // One head, at the end where the line begins.
        let one = read("M 10 10 L 200 10 M 20 15 L 10 10 L 20 5");
        assert_eq!(one, Some([Vec2::new(200.0, 10.0), Vec2::new(10.0, 10.0)]));
        for none in [
            "M 0 0 H 200 V 10 H 0 Z",
            "M 0 0 L 200 10 L 0 20",
            "M 0 0 H 200",
            "M 0 0 H 200 M 100 5 V -5",
            "M 0 0 H 25 M 0 3 V -3 M 25 3 V -3",
        ] {
            assert!(read(none).is_none(), "{none}");
        }
    }
}
