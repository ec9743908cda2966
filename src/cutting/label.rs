//! What is written on a piece, and where there is room for it.

use super::{Lettering, Paper};
use crate::geometry::Vec2;
use crate::pattern::Cut;

/// Largest and smallest height of letters, metres: easily read at arm's length, and the least that home printers draw
/// clearly.
const LETTERS: (f64, f64) = (0.007, 0.0025);
/// Height of the name over the other lines'.
const NAME: f64 = 1.4;
/// Width of a letter of a sans-serif type over its height, on average, with some air.
pub const LETTER_WIDTH: f64 = 0.62;
/// Distance of lines over the height of letters.
const LINE: f64 = 1.45;
/// Share of the room between lines that a block of text takes.
const AIR: f64 = 0.85;
/// Places looked at along each side of the piece's box.
const PLACES: usize = 40;
/// Longest line of a remark that is written, letters.
const LONGEST_NOTE: usize = 60;

/// An edge's allowance and length, metres.
pub(super) struct EdgeWidth<'a> {
    pub(super) name: &'a str,
    pub(super) width: f64,
    pub(super) length: f64,
}

/// How many are cut.
pub(super) fn count(cut: &Cut) -> String {
    match cut {
        Cut::One => "cut 1".to_owned(),
        Cut::Pair => "cut 2 (left and right)".to_owned(),
        Cut::Fold(_) => "cut 1 on the fold".to_owned(),
        Cut::Count(n) => format!("cut {n}"),
    }
}

/// The lines of text on a piece; `widths` are those of its edges.
pub(super) fn lettering(paper: &Paper, widths: &[EdgeWidth], note: Option<&str>) -> Vec<Lettering> {
    let mut lines = vec![paper.name.clone(), format!("{}, {}", paper.count, paper.fabric)];
    lines.push(allowances(widths));
    lines.extend(note.map(|n| crate::input::shown(n.trim(), LONGEST_NOTE)));
    let longest = lines.iter().map(|l| l.chars().count()).max().unwrap_or(1) as f64;
    let block = Vec2::new(longest * LETTER_WIDTH, lines.len() as f64 * LINE + (NAME - 1.0));
    let walls = walls(paper);
    let flat = roomiest(paper, &walls, block, false);
    let turned = roomiest(paper, &walls, block, true);
    // Text is easier to read level; it is turned where that makes it clearly larger.
    let upright = turned.1 > 1.3 * flat.1 && flat.1 < LETTERS.0;
    let (middle, room) = if upright { turned } else { flat };
    let height = room.clamp(LETTERS.1, LETTERS.0);
    write(&lines, middle, height, upright)
}

/// The allowance of most of the outline, and edges that have another.
fn allowances(widths: &[EdgeWidth]) -> String {
    let mm = |w: f64| (w * 1e5).round() / 100.0;
    let along = |w: f64| widths.iter().filter(|e| mm(e.width) == mm(w)).map(|e| e.length).sum::<f64>();
    let Some(common) = widths.iter().max_by(|a, b| along(a.width).total_cmp(&along(b.width))) else {
        return String::new();
    };
    let common = mm(common.width);
    // What a dart cuts in two, `hem` and `hem.2`, is one edge to a reader.
    let others: Vec<String> = widths
        .iter()
        .filter(|e| mm(e.width) != common && !e.name.contains('.'))
        .map(|e| format!("{} {}", e.name, mm(e.width)))
        .collect();
    let but = if others.is_empty() { String::new() } else { format!("; {}", others.join(", ")) };
    format!("allowance {common} mm{but}")
}

fn write(lines: &[String], middle: Vec2, height: f64, upright: bool) -> Vec<Lettering> {
    let whole = height * (lines.len() as f64 * LINE + (NAME - 1.0));
    let mut down = -whole / 2.0 + height * NAME;
    let mut out = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        // Turned, the heads of the letters are to the right: the first line is the rightmost.
        let at = if upright { Vec2::new(-down, 0.0) } else { Vec2::new(0.0, down) };
        let height = if i == 0 { height * NAME } else { height };
        out.push(Lettering { text: line.clone(), at: middle + at, height, upright });
        down += LINE * height.min(whole);
    }
    out
}

/// What the text should keep clear of.
fn walls(paper: &Paper) -> Vec<[Vec2; 2]> {
    let mut walls = Vec::new();
    let mut add = |points: &[Vec2]| walls.extend(points.windows(2).map(|w| [w[0], w[1]]));
    for line in &paper.sew {
        add(&line.path.sampled(1e-4));
    }
    for mark in &paper.marks {
        add(&mark.path.sampled(1e-4));
    }
    add(&paper.grain);
    if let Some(fold) = paper.fold {
        add(&fold);
    }
    walls
}

/// Where in the piece a block of this size (in heights of letters) has most room, and how high its letters may be.
fn roomiest(paper: &Paper, walls: &[[Vec2; 2]], block: Vec2, upright: bool) -> (Vec2, f64) {
    let block = if upright { Vec2::new(block.y, block.x) } else { block };
    // In these units the block is a square of side 1 per letter height.
    let scaled = |p: Vec2| p.component_div(&block);
    let walls: Vec<[Vec2; 2]> = walls.iter().map(|w| w.map(scaled)).collect();
    let [low, high] = paper.bounds();
    let mut best = ((low + high) / 2.0, 0.0);
    for i in 1..PLACES {
        for k in 1..PLACES {
            let share = Vec2::new(i as f64, k as f64) / PLACES as f64;
            let p = low + (high - low).component_mul(&share);
            if inside(paper, p) {
                let clear = walls.iter().map(|w| distance(scaled(p), *w)).fold(f64::INFINITY, f64::min);
                let room = 2.0 * AIR * clear;
                if room > best.1 {
                    best = (p, room);
                }
            }
        }
    }
    best
}

/// Whether `p` is on the cloth; a half piece is closed by its fold.
fn inside(paper: &Paper, p: Vec2) -> bool {
    let mut inside = false;
    for contour in &paper.cut {
        let next = contour.iter().cycle().skip(1);
        for (a, b) in contour.iter().zip(next) {
            if (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                inside = !inside;
            }
        }
    }
    inside
}

/// Half the side of the largest square round `p` that a segment does not enter.
fn distance(p: Vec2, [a, b]: [Vec2; 2]) -> f64 {
    let (from, along) = (a - p, b - a);
    // Along the segment |x| and |y| are straight between their zeros,
    // and the greater of them between where they are equal.
    let turning = [(1.0, 0.0), (0.0, 1.0), (1.0, -1.0), (1.0, 1.0)].map(|(x, y)| {
        let slope = x * along.x + y * along.y;
        if slope == 0.0 { 0.0 } else { (-(x * from.x + y * from.y) / slope).clamp(0.0, 1.0) }
    });
    turning.into_iter().chain([0.0, 1.0]).map(|share| (from + along * share).amax()).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_grows_to_the_segment() {
        let from_origin = |a: [f64; 2], b: [f64; 2]| distance(Vec2::zeros(), [a, b].map(|p| Vec2::new(p[0], p[1])));
        assert_eq!(from_origin([-5.0, 2.0], [5.0, 2.0]), 2.0);
        assert_eq!(from_origin([3.0, -9.0], [3.0, 9.0]), 3.0);
        // A diagonal meets the square's corner first; a short one its own end.
        assert_eq!(from_origin([4.0, 0.0], [0.0, 4.0]), 2.0);
        assert_eq!(from_origin([4.0, 1.0], [3.5, 1.5]), 3.5);
        assert_eq!(from_origin([-1.0, -1.0], [1.0, 1.0]), 0.0);
        let dense = |a: Vec2, b: Vec2| {
            (0..=10_000).map(|k| (a + (b - a) * (f64::from(k) / 1e4)).amax()).fold(f64::INFINITY, f64::min)
        };
        for k in 0..50 {
            let at = |seed: i32| f64::from(seed * 7919 % 41 - 20) / 4.0;
            let (a, b) = (Vec2::new(at(k), at(3 * k + 1)), Vec2::new(at(5 * k + 2), at(7 * k + 3)));
            assert!((distance(Vec2::zeros(), [a, b]) - dense(a, b)).abs() < 2e-3, "{a} {b}");
        }
    }

    #[test]
    fn turned_lines_are_read_from_the_right() {
        let lines = ["front".to_owned(), "cut 1".to_owned()];
        let level = write(&lines, Vec2::zeros(), 0.01, false);
        let turned = write(&lines, Vec2::zeros(), 0.01, true);
        assert!(level[0].at.y < level[1].at.y && turned[0].at.x > turned[1].at.x);
    }
}
