//! The lettering of a piece, and where there is room for it.

use super::marks::grain_arrow;
use super::room::{AIR, Room, foot};
use super::{Lettering, Paper, SewKind};
use crate::geometry::{Path, Vec2, distance_to_segment, encloses, letter_strokes, sides_of};
use crate::pattern::{CutKind, LineKind};

/// Largest and smallest height of letters, metres: easily read at arm's length, and the least that home printers draw
/// clearly.
const LETTERS: (f64, f64) = (0.007, 0.0025);
/// A block of text is turned where that makes its letters so many times larger.
const CLEARLY: f64 = 1.3;
/// Height of the name over the other lines'.
const NAME: f64 = 1.4;
/// Width of a letter of a sans-serif type over its height, on average, with some air.
pub const LETTER_WIDTH: f64 = 0.62;
/// Widths of capitals, and of the letters of East Asian scripts, which are as wide as their type is large.
const CAPITAL_WIDTH: f64 = 0.90;
const SQUARE_WIDTH: f64 = 1.40;
/// Width of the letters of other scripts: a PDF draws them all as wide as this.
const SCRIPT_WIDTH: f64 = 0.80;
/// The first letter that is not of a Latin alphabet.
const FIRST_OF_SCRIPTS: char = '\u{250}';
/// Distance of lines over the height of letters, and how far some letters reach below their line.
const LINE: f64 = 1.45;
const BELOW: f64 = 0.3;
/// Lines that are never left out: the name, and how many are cut of what.
const NEEDED: usize = 2;
/// Height of letters along a line or beside a piece, metres, and the share of its box that they take.
const BESIDE: f64 = 0.004;
const AIR_BESIDE: f64 = 0.75;
/// Height of the letters of seams beside edges, metres: they fit into usual allowances.
const SEAM: f64 = 0.003;
/// Where along a line words are tried: near its middle first.
const BESIDE_AT: [f64; 7] = [0.5, 0.35, 0.65, 0.25, 0.75, 0.12, 0.88];
/// Places along a cut line at which the name of its size is tried.
const TAG_PLACES: u32 = 60;
/// So many of them the names of sizes begin apart.
const TAG_STEP: u32 = 7;
/// Half the width of a drill mark, metres.
const DRILL: f64 = 0.002;
/// Longest line of a remark that is written, letters.
const LONGEST_NOTE: usize = 60;

/// An edge's allowance and length, metres.
pub(super) struct EdgeWidth<'a> {
    pub(super) name: &'a str,
    pub(super) width: f64,
    pub(super) length: f64,
}

/// Further lines on the labels of a garment's pieces.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Label {
    /// The garment's name.
    pub title: String,
    /// For whom it is.
    pub wearer: Option<String>,
    /// When it was drawn, as the maker writes it.
    pub date: Option<String>,
}

impl Label {
    /// `Shirt for Ada, 3 May, piece 2 of 7`.
    pub(super) fn line(&self, number: usize, of: usize) -> String {
        let wearer = self.wearer.as_ref().map_or_else(String::new, |wearer| format!(" for {wearer}"));
        let date = self.date.as_ref().map_or_else(String::new, |date| format!(", {date}"));
        format!("{}{wearer}{date}, piece {number} of {of}", self.title)
    }
}

/// The words on a piece; each is written where there is room for it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PieceWords {
    /// The lines of its label, the name first; the first two are never left out.
    pub(super) lines: Vec<String>,
    /// Seams, each with the index in [`Paper::sew`] of an edge that it takes.
    pub(super) seams: Vec<(usize, String)>,
    /// The name of its size, beside its cut line.
    pub(super) tag: Option<String>,
}

impl PieceWords {
    /// The name and the count, what the piece belongs to, the allowances of its edges, and the file's remark.
    pub(super) fn new(paper: &Paper, heading: Option<String>, widths: &[EdgeWidth], note: Option<&str>) -> Self {
        let mut lines = vec![paper.name.clone(), format!("{}, {}", paper.count, paper.fabric)];
        lines.extend(heading);
        lines.extend(allowances(widths));
        lines.extend(note.map(|n| crate::input::shown(n.trim(), LONGEST_NOTE)));
        Self { lines, seams: Vec::new(), tag: None }
    }
}

/// How many are cut.
pub(super) fn count(cut: &CutKind) -> String {
    match cut {
        CutKind::One => "cut 1".to_owned(),
        CutKind::Pair => "cut 2 (left and right)".to_owned(),
        CutKind::Fold(_) => "cut 1 on the fold".to_owned(),
        CutKind::Count(n) => format!("cut {n} (alike)"),
    }
}

/// The texts on a piece, clear of the `joins` of pages as far as there is room for that.
pub(super) fn lettering(paper: &Paper, joins: &[[Vec2; 2]]) -> Vec<Lettering> {
    let lines = &paper.words.lines;
    let mut room = room(paper);
    let mut clear = room.clone();
    clear.walls.extend(joins);
    let mut texts = elastic(paper, &clear);
    for text in &texts {
        [&mut room, &mut clear].into_iter().for_each(|room| room.add_wall(&outline(text)));
    }
    let sewn = sewn(paper);
    let fitted_in = |room: &Room| wordings(lines).iter().find_map(|lines| fitted(room, &sewn, lines));
    if !lines.is_empty() {
        let inside = fitted_in(&clear).or_else(|| fitted_in(&room).filter(|_| !joins.is_empty()));
        texts.extend(inside.unwrap_or_else(|| under(paper, lines)));
    }
    texts.extend(paper.words.tag.as_ref().and_then(|tag| size_tag(paper, tag, joins)));
    texts.iter().for_each(|t| clear.add_wall(&outline(t)));
    for (line, seam) in &paper.words.seams {
        let text = clear_beside(&clear, &paper.sew[*line].path, seam, SEAM);
        texts.extend(text.inspect(|t| clear.add_wall(&outline(t))));
    }
    texts
}

impl Paper {
    /// Its lettering moved clear of the `joins` of pages, as far as there is room for that.
    #[must_use]
    pub fn lettered_clear_of(&self, joins: &[[Vec2; 2]]) -> Self {
        Self { texts: lettering(self, joins), ..self.clone() }
    }
}

/// The name of a size on the inner side of its cut line, where that is farthest from those of the other sizes and
/// clear of all lines.
fn size_tag(paper: &Paper, tag: &str, joins: &[[Vec2; 2]]) -> Option<Lettering> {
    let contour = paper.cut.first()?;
    let mut room = Room { contours: paper.cut.clone(), walls: Vec::new() };
    paper.others.iter().for_each(|line| room.add_wall(line));
    let others = room.walls.clone();
    room.walls.extend(paper.cut.iter().flat_map(|line| sides_of(line)).chain(joins.iter().copied()));
    paper.sew.iter().for_each(|line| room.add_wall(&line.path.sampled(1e-4)));
    let path = Path::polyline(contour);
    // Where sizes are alike their names stand one after the other.
    let first = paper.size.as_ref().map_or(0, |size| size.number as u32 * TAG_STEP);
    let places = (first..first + TAG_PLACES).map(|k| (f64::from(k % TAG_PLACES) + 0.5) / f64::from(TAG_PLACES));
    let apart = |share: f64| {
        let p = path.point(path.length() * share);
        others.iter().map(|side| distance_to_segment(p, *side)).fold(f64::INFINITY, f64::min)
    };
    let mut places: Vec<(f64, f64)> = places.map(|share| (apart(share), share)).collect();
    places.sort_by(|a, b| b.0.total_cmp(&a.0));
    places.into_iter().find_map(|(_, share)| {
        // The cloth is on the right of a contour that is walked clockwise.
        [1.0, -1.0].into_iter().find_map(|side| {
            let (middle, size, upright) = place_beside(&path, tag, SEAM, share, side);
            room.is_clear(middle, size).then(|| lettering_at(tag, middle, SEAM, upright))
        })
    })
}

/// The lines one under the other, or all in one, for narrow pieces; then without the last, as far as they are not
/// needed.
fn wordings(lines: &[String]) -> Vec<Vec<String>> {
    let kept = (NEEDED..=lines.len()).rev().map(|n| &lines[..n]);
    kept.flat_map(|lines| [lines.to_vec(), vec![lines.join(", ")]]).collect()
}

/// The sides of what is left of a piece when it is sewn, in any order.
fn sewn(paper: &Paper) -> Vec<[Vec2; 2]> {
    let around = paper.sew.iter().filter(|s| matches!(s.of, SewKind::Outline | SewKind::Hole | SewKind::Dart));
    let lines = around.map(|s| s.path.sampled(1e-4)).chain(paper.fold.map(|fold| fold.to_vec()));
    let smallest = paper.others.iter().take(usize::from(paper.cut.is_empty()));
    let closed = smallest.flat_map(|contour| sides_of(contour));
    closed.chain(lines.flat_map(|line| line.windows(2).map(|w| [w[0], w[1]]).collect::<Vec<_>>())).collect()
}

/// The lines where there is most room for them, if they are legible there and not in an allowance, where nobody sees
/// them once it is sewn.
fn fitted(room: &Room, sewn: &[[Vec2; 2]], lines: &[String]) -> Option<Vec<Lettering>> {
    let (middle, height, upright) = room.level_or_turned(block(lines), LETTERS.0, CLEARLY);
    // What is in one line is written as high as a name.
    let smallest = if lines.len() == 1 { NAME * height } else { height };
    let fits = smallest >= LETTERS.1 && encloses(sewn.iter().copied(), middle);
    fits.then(|| write(lines, middle, height.min(LETTERS.0), upright))
}

/// The lines under the piece, clear of it: there is no room within.
fn under(paper: &Paper, lines: &[String]) -> Vec<Lettering> {
    let [low, high] = paper.bounds();
    let size = block(lines) * (BESIDE / AIR);
    write(lines, Vec2::new(low.x, high.y) + size / 2.0, BESIDE, false)
}

/// Width of a line over the height of its letters.
fn wide(line: &str) -> f64 {
    let letter = |c: char| match c {
        'm' | 'w' | '@' | '%' => CAPITAL_WIDTH,
        c if c.is_uppercase() => CAPITAL_WIDTH,
        FIRST_OF_SCRIPTS.. if letter_strokes(c).is_none_or(|own| own.is_wide) => SQUARE_WIDTH,
        FIRST_OF_SCRIPTS.. => SCRIPT_WIDTH,
        _ => LETTER_WIDTH,
    };
    line.chars().map(letter).sum()
}

/// Width and height of lines over the height of their letters.
fn block(lines: &[String]) -> Vec2 {
    let wide = |(i, line): (usize, &String)| wide(line) * if i == 0 { NAME } else { 1.0 };
    let below = if lines.len() == 1 { NAME * BELOW } else { BELOW };
    let high = NAME + (lines.len() as f64 - 1.0) * LINE + below;
    Vec2::new(lines.iter().enumerate().map(wide).fold(1.0, f64::max), high)
}

/// The allowance of most of the outline, and edges that have another.
fn allowances(widths: &[EdgeWidth]) -> Option<String> {
    let mm = |w: f64| (w * 1e5).round() / 100.0;
    let along = |w: f64| widths.iter().filter(|e| mm(e.width) == mm(w)).map(|e| e.length).sum::<f64>();
    let common = widths.iter().max_by(|a, b| along(a.width).total_cmp(&along(b.width)))?;
    let common = mm(common.width);
    // What a dart cuts in two, `hem` and `hem.2`, is one edge to a reader.
    let others: Vec<String> = widths
        .iter()
        .filter(|e| mm(e.width) != common && !e.name.contains('.'))
        .map(|e| format!("{} {}", e.name, mm(e.width)))
        .collect();
    let but = if others.is_empty() { String::new() } else { format!("; {}", others.join(", ")) };
    Some(format!("allowance {common} mm{but}"))
}

fn write(lines: &[String], middle: Vec2, height: f64, upright: bool) -> Vec<Lettering> {
    let mut down = height * (NAME - block(lines).y / 2.0);
    let mut out = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        // Turned, the heads of the letters are to the right: the first line is the rightmost.
        let at = if upright { Vec2::new(-down, 0.0) } else { Vec2::new(0.0, down) };
        let letters = if i == 0 { height * NAME } else { height };
        out.push(Lettering { text: line.clone(), at: middle + at, height: letters, upright });
        down += LINE * height;
    }
    out
}

/// The cloth of a paper, and the lines that text should keep clear of.
fn room(paper: &Paper) -> Room {
    // A half piece is closed by its fold.
    let walls = paper.cut.iter().flat_map(|contour| sides_of(contour)).collect();
    // The label of a nest is on the smallest of its sizes.
    let smallest = paper.others.iter().take(usize::from(paper.cut.is_empty()));
    let mut room = Room { contours: paper.cut.iter().chain(smallest).cloned().collect(), walls };
    paper.others.iter().for_each(|line| room.add_wall(line));
    for line in &paper.sew {
        room.add_wall(&line.path.sampled(1e-4));
    }
    for mark in &paper.marks {
        room.add_wall(&mark.path.sampled(1e-4));
    }
    room.add_wall(&grain_arrow(paper.grain));
    for (_, at) in &paper.drills {
        let half = Vec2::new(DRILL, 0.0);
        room.add_wall(&[at - half, at + half]);
    }
    if let Some(fold) = paper.fold {
        room.add_wall(&fold);
    }
    room
}

/// The label along elastic: the share of its length that it is drawn in to.
fn elastic(paper: &Paper, room: &Room) -> Vec<Lettering> {
    let mut texts = Vec::new();
    for mark in &paper.marks {
        if let Some(LineKind::Elastic(ratio)) = mark.line {
            texts.push(beside(room, &mark.path, format!("elastic, {:.0} %", 100.0 * ratio)));
        }
    }
    texts
}

/// A text beside a line, where it is clear of all lines if there is such a place.
fn beside(room: &Room, path: &Path, text: String) -> Lettering {
    clear_beside(room, path, &text, BESIDE).unwrap_or_else(|| {
        let (middle, _, upright) = place_beside(path, &text, BESIDE, 0.5, -1.0);
        lettering_at(&text, middle, BESIDE, upright)
    })
}

/// A text beside a line where it is clear of all lines.
fn clear_beside(room: &Room, path: &Path, text: &str, height: f64) -> Option<Lettering> {
    let places =
        BESIDE_AT.iter().flat_map(|&share| [-1.0, 1.0].map(|side| place_beside(path, text, height, share, side)));
    let mut clear = places.filter(|(middle, size, _)| room.is_clear(*middle, *size));
    clear.next().map(|(middle, _, upright)| lettering_at(text, middle, height, upright))
}

/// A text of which the letters, with what reaches below their line, lie round `middle`.
fn lettering_at(text: &str, middle: Vec2, height: f64, upright: bool) -> Lettering {
    let at = middle + foot((1.0 - BELOW) * height, upright);
    Lettering { text: text.to_owned(), at, height, upright }
}

/// The middle and the size of a text's box beside a line, at a share of its length, and whether it is turned.
fn place_beside(path: &Path, text: &str, height: f64, share: f64, side: f64) -> (Vec2, Vec2, bool) {
    let wide = wide(text) * height;
    let t = path.tangent(path.length() * share);
    let upright = t.y.abs() > t.x.abs();
    let high = (1.0 + BELOW) * height;
    let size = if upright { Vec2::new(high, wide) } else { Vec2::new(wide, high) } * (1.0 / AIR_BESIDE);
    let across = Vec2::new(-t.y, t.x) * side;
    // As far off as the corner of its box needs.
    let off = (across.x.abs() * size.x + across.y.abs() * size.y) / 2.0;
    (path.point(path.length() * share) + across * (off * 1.01), size, upright)
}

/// The box round a text with its air, as a line.
pub(super) fn outline(text: &Lettering) -> [Vec2; 5] {
    let wide = wide(&text.text) * text.height / AIR / 2.0;
    let corner = |along: f64, up: f64| {
        let (along, up) = (along * wide, up * text.height);
        text.at + if text.upright { Vec2::new(up, along) } else { Vec2::new(along, -up) }
    };
    [corner(-1.0, -BELOW), corner(1.0, -BELOW), corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -BELOW)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turned_lines_are_read_from_the_right() {
        let lines = ["front".to_owned(), "cut 1".to_owned()];
        let level = write(&lines, Vec2::zeros(), 0.01, false);
        let turned = write(&lines, Vec2::zeros(), 0.01, true);
        assert!(level[0].at.y < level[1].at.y && turned[0].at.x > turned[1].at.x);
    }
}
