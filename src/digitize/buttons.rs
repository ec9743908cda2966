//! Buttons and buttonholes that are drawn as symbols: a ring with a cross over it, and a line between two bars, as
//! Valentina and cutting programs draw them.

use super::{Fastener, FastenerKind, InnerLine, Traced};
use crate::geometry::{Path, Vec2};

/// Shortest and longest line of a symbol, metres.
const LINE: std::ops::RangeInclusive<f64> = 2e-3..=0.06;
/// Smallest and largest radius of a button's ring, metres.
const RING: std::ops::RangeInclusive<f64> = 1e-3..=0.025;
/// Points of a ring lie as far from its middle as the mean, to this share: a polygon of eight corners does.
const ROUND: f64 = 0.08;
/// Lengths of the lines of a cross, over the radius of its ring.
const CROSS: std::ops::RangeInclusive<f64> = 1.5..=3.0;
/// A point is where a symbol has it to this share of its size.
const PLACED: f64 = 0.1;
/// Lines are square to each other to this (cosine of 84 degrees).
const SQUARE: f64 = 0.1;
/// Bars are no longer than this share of the line between them.
const BAR: f64 = 1.5;
/// In a piece with more short lines than this no symbols are looked for: it is embroidered.
const MOST: usize = 300;
/// Points of a ring that are looked at.
const LOOKS: usize = 32;

/// A straight line of a symbol.
struct Straight {
    /// Its number among the lines of the piece.
    line: usize,
    ends: [Vec2; 2],
}

impl Straight {
    fn middle(&self) -> Vec2 {
        (self.ends[0] + self.ends[1]) / 2.0
    }

    fn length(&self) -> f64 {
        (self.ends[1] - self.ends[0]).norm()
    }

    fn is_square_to(&self, other: &Self) -> bool {
        let [a, b] = [self, other].map(|line| (line.ends[1] - line.ends[0]).normalize());
        a.dot(&b).abs() <= SQUARE
    }
}

/// The piece with its symbols as buttons and buttonholes instead of lines. `None` of one without them.
pub(super) fn with_buttons(piece: &Traced) -> Option<Traced> {
    let lines: Vec<Straight> = piece.lines.iter().enumerate().filter_map(straight).collect();
    if lines.len() > MOST {
        return None;
    }
    let mut used = Vec::new();
    let mut fasteners = Vec::new();
    for (k, line) in piece.lines.iter().enumerate().filter(|(_, line)| line.kind.is_none()) {
        if let Some((middle, [a, b])) = ring(&line.path).and_then(|ring| Some((ring.0, cross(&lines, ring)?))) {
            used.extend([k, a, b]);
            fasteners.push(Fastener { at: middle, kind: FastenerKind::Button });
        }
    }
    for line in &lines {
        if let Some(bars) = bars(&lines, line) {
            used.extend([line.line, bars[0], bars[1]]);
            fasteners.push(Fastener { at: line.middle(), kind: FastenerKind::Buttonhole });
        }
    }
    let left = piece.lines.iter().enumerate().filter(|(k, _)| !used.contains(k)).map(|(_, line)| line.clone());
    let all = piece.fasteners.iter().copied().chain(fasteners.iter().copied()).collect();
    (!fasteners.is_empty()).then(|| Traced { lines: left.collect(), fasteners: all, ..piece.clone() })
}

fn straight((line, inner): (usize, &InnerLine)) -> Option<Straight> {
    let is_short = inner.path.is_straight() && LINE.contains(&inner.path.length());
    (inner.kind.is_none() && is_short).then(|| Straight { line, ends: [inner.path.start(), inner.path.end()] })
}

/// The middle and the radius of a closed line that is round.
fn ring(path: &Path) -> Option<(Vec2, f64)> {
    let long = path.length();
    if (path.end() - path.start()).norm() > PLACED * long {
        return None;
    }
    let points: Vec<Vec2> = (0..LOOKS).map(|k| path.point(long * k as f64 / LOOKS as f64)).collect();
    let middle = points.iter().sum::<Vec2>() / LOOKS as f64;
    let radius = points.iter().map(|p| (p - middle).norm()).sum::<f64>() / LOOKS as f64;
    let is_round = points.iter().all(|p| ((p - middle).norm() - radius).abs() <= ROUND * radius);
    (is_round && RING.contains(&radius)).then_some((middle, radius))
}

/// The numbers of two lines that cross each other in the middle of a ring.
fn cross(lines: &[Straight], (middle, radius): (Vec2, f64)) -> Option<[usize; 2]> {
    let through = |line: &&Straight| {
        (line.middle() - middle).norm() <= PLACED * radius && CROSS.contains(&(line.length() / radius))
    };
    let own: Vec<&Straight> = lines.iter().filter(through).collect();
    let first = own.first()?;
    let second = own.iter().find(|line| line.is_square_to(first))?;
    Some([first.line, second.line])
}

/// The numbers of two bars at the ends of a line, square to it and as long as each other.
fn bars(lines: &[Straight], line: &Straight) -> Option<[usize; 2]> {
    let long = line.length();
    let at = |end: Vec2| {
        let is_bar = |bar: &&Straight| {
            bar.line != line.line
                && bar.is_square_to(line)
                && (bar.middle() - end).norm() <= PLACED * long
                && bar.length() <= BAR * long
        };
        lines.iter().find(is_bar)
    };
    let [a, b] = [at(line.ends[0])?, at(line.ends[1])?];
    let alike = (a.length() - b.length()).abs() <= PLACED * a.length().max(b.length());
    (a.line != b.line && alike).then_some([a.line, b.line])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(texts: &[&str]) -> Traced {
        let line =
            |text: &&str| InnerLine { name: None, path: Path::parse_absolute(text, 1e-3).expect("a path"), kind: None };
        Traced { lines: texts.iter().map(line).collect(), ..Traced::default() }
    }

    #[test]
    fn a_crossed_ring_is_a_button_and_a_barred_line_a_buttonhole() {
        let piece = lines(&[
            "M 20 15 L 20 25",
            "M 15 20 L 25 20",
            "M 24.25 20 A 4.25 4.25 0 0 1 15.75 20 A 4.25 4.25 0 0 1 24.25 20 Z",
            "M 60 20 L 78 20",
            "M 60 16 L 60 24",
            "M 78 16 L 78 24",
            "M 10 60 L 90 60",
        ]);
        let found = with_buttons(&piece).expect("a button and a buttonhole");
        let told: Vec<(FastenerKind, [f64; 2])> =
            found.fasteners.iter().map(|f| (f.kind, [f.at.x, f.at.y].map(|x| (x * 1e3).round()))).collect();
        assert_eq!(told, [(FastenerKind::Button, [20.0, 20.0]), (FastenerKind::Buttonhole, [69.0, 20.0])]);
        assert_eq!(found.lines.len(), 1);
    }

    #[test]
    fn a_ring_alone_a_cross_alone_and_a_box_are_marks() {
        for marks in [
            &["M 24 20 A 4 4 0 0 1 16 20 A 4 4 0 0 1 24 20 Z"][..],
            &["M 20 15 L 20 25", "M 15 20 L 25 20"],
            &["M 0 0 L 40 0", "M 0 0 L 0 20", "M 40 0 L 40 20", "M 0 20 L 40 20"],
        ] {
            assert!(with_buttons(&lines(marks)).is_none(), "{marks:?}");
        }
    }
}
