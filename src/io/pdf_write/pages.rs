//! Sheets on pages.

use pdf_writer::Content;

use super::draw::{Pen, lines};
use super::{LONGEST_SIDE, POINTS, Page, PdfError, document};
use crate::cutting::{LETTER_WIDTH, Layout, Paper, Sheet, TEST_SQUARE};
use crate::geometry::Vec2;

/// The margin that home printers leave white at every side, metres, with a little to spare.
const MARGIN: f64 = 0.007;
/// Width of the strip that neighbouring pages share, metres.
const OVERLAP: f64 = 0.010;
/// Half the diagonal of a match mark, metres.
const MATCH: f64 = 0.004;
/// Lines that end within this of a frame, metres, are on the pages at both of its sides: half the width of a cut line.
const TOUCH: f64 = 2.5e-4;
/// More pages than this are a wrong unit.
const MOST_PAGES: usize = 600;
/// Points of the outline nearer than this (metres) are one on the plan.
const MAP_DETAIL: f64 = 0.003;
/// Most letters of a title on the first page.
const LONGEST_TITLE: usize = 80;
/// Letters of the first page and of the pages' names, metres.
const LETTERS: f64 = 0.0035;

/// One page that holds the whole sheet.
///
/// # Errors
/// [`PdfError::TooLarge`].
pub fn one_page(title: &str, sheet: &Sheet) -> Result<Vec<u8>, PdfError> {
    if sheet.size.max() * POINTS > LONGEST_SIDE {
        return Err(PdfError::TooLarge { width: sheet.size.x * 1e3, height: sheet.size.y * 1e3 });
    }
    let mut pen = Pen::new(sheet.size.y, Vec2::zeros());
    pen.sheet(sheet, [Vec2::zeros(), sheet.size]);
    Ok(document(title, [sheet.size.x, sheet.size.y], vec![pen.finish()]))
}

/// Pages to be joined: the first has the test square, the plan of the pages and what to cut; then a page for every
/// field of the plan on which something is drawn, row by row.
///
/// Every page shows its frame and a strip of 5 mm beyond it; frames of neighbours are the same line, and the
/// halves of a match mark on it make a diamond.
///
/// # Errors
/// [`PdfError::TooMany`].
pub fn tiled(title: &str, papers: &[Paper], page: Page) -> Result<Vec<u8>, PdfError> {
    let frame = Vec2::new(page.width, page.height) - Vec2::repeat(2.0 * MARGIN + OVERLAP);
    let plan = Plan::new(papers, frame)?;
    let mut pages = vec![cover(title, papers, &plan, page)];
    for row in 0..plan.rows {
        for column in (0..plan.columns).filter(|&c| plan.is_used(row, c)) {
            pages.push(tile(&plan, row, column, page));
        }
    }
    Ok(document(title, [page.width, page.height], pages))
}

/// A sheet cut into fields.
struct Plan {
    sheet: Sheet,
    frame: Vec2,
    columns: usize,
    rows: usize,
    used: Vec<bool>,
}

impl Plan {
    /// The width, in pages, that takes the fewest pages; the narrower of two that take as many.
    fn new(papers: &[Paper], frame: Vec2) -> Result<Self, PdfError> {
        let widest = papers.iter().map(|p| p.extent()[1].x - p.extent()[0].x).fold(0.0, f64::max);
        let least = fields(widest, frame.x);
        if least > MOST_PAGES {
            return Err(PdfError::TooMany { pages: least, most: MOST_PAGES });
        }
        // Twice the widest piece is wide enough for any two to lie side by side.
        let mut best = Self::of_width(papers, frame, least);
        for columns in least + 1..=2 * least.max(2) {
            let wider = Self::of_width(papers, frame, columns);
            if wider.pages() < best.pages() {
                best = wider;
            }
        }
        let pages = best.pages();
        if pages > MOST_PAGES { Err(PdfError::TooMany { pages, most: MOST_PAGES }) } else { Ok(best) }
    }

    fn of_width(papers: &[Paper], frame: Vec2, columns: usize) -> Self {
        let layout = Layout { width: Some(columns as f64 * frame.x), margin: 0.0, square: false };
        let sheet = Sheet::new(papers, &layout);
        let (columns, rows) = (fields(sheet.size.x, frame.x), fields(sheet.size.y, frame.y));
        let mut plan = Self { sheet, frame, columns, rows, used: Vec::new() };
        plan.used = plan.drawn_on();
        plan
    }

    fn pages(&self) -> usize {
        self.used.iter().filter(|used| **used).count()
    }

    fn is_used(&self, row: usize, column: usize) -> bool {
        self.used[row * self.columns + column]
    }

    /// Upper left corner of a field.
    fn corner(&self, row: usize, column: usize) -> Vec2 {
        Vec2::new(column as f64, row as f64).component_mul(&self.frame)
    }

    /// Of every field whether a line or a letter is within its frame. What is only in the strip beyond the frame is on
    /// the neighbour.
    fn drawn_on(&self) -> Vec<bool> {
        let mut used = vec![false; self.rows * self.columns];
        // The fields that coordinates reach, at least the last one: a sheet ends on its last frame.
        let reach = |from: f64, to: f64, of: f64, count: usize| {
            let field = |x: f64| ((x / of).max(0.0) as usize).min(count - 1);
            field(from - TOUCH)..=field(to + TOUCH)
        };
        for [a, b] in self.sheet.papers.iter().flat_map(lines) {
            for row in reach(a.y.min(b.y), a.y.max(b.y), self.frame.y, self.rows) {
                for column in reach(a.x.min(b.x), a.x.max(b.x), self.frame.x, self.columns) {
                    let low = self.corner(row, column) - Vec2::repeat(TOUCH);
                    let high = self.corner(row + 1, column + 1) + Vec2::repeat(TOUCH);
                    let field = &mut used[row * self.columns + column];
                    *field = *field || segment_meets(a, b, low, high);
                }
            }
        }
        used
    }

    /// Whether a field is one of the plan and has a page.
    fn has_page(&self, row: Option<usize>, column: Option<usize>) -> bool {
        let inside = row.filter(|r| *r < self.rows).zip(column.filter(|c| *c < self.columns));
        inside.is_some_and(|(r, c)| self.is_used(r, c))
    }
}

fn fields(length: f64, of: f64) -> usize {
    // A hair over the edge of a field is rounding.
    ((length / of - 1e-9).ceil() as usize).max(1)
}

/// Whether a segment has a point within a box (slab test).
fn segment_meets(a: Vec2, b: Vec2, low: Vec2, high: Vec2) -> bool {
    let (mut from, mut to) = (0.0, 1.0);
    for k in 0..2 {
        let d = b[k] - a[k];
        if d == 0.0 {
            if a[k] < low[k] || a[k] > high[k] {
                return false;
            }
            continue;
        }
        let (one, other) = ((low[k] - a[k]) / d, (high[k] - a[k]) / d);
        from = f64::max(from, one.min(other));
        to = f64::min(to, one.max(other));
    }
    from <= to
}

/// `B3`: row, then column from 1.
fn field_name(row: usize, column: usize) -> String {
    let mut letters = String::new();
    let mut rest = row + 1;
    while rest > 0 {
        let digit = (rest - 1) % 26;
        letters.insert(0, char::from(b'A' + digit as u8));
        rest = (rest - 1) / 26;
    }
    format!("{letters}{}", column + 1)
}

fn tile(plan: &Plan, row: usize, column: usize, page: Page) -> Content {
    let inset = Vec2::repeat(MARGIN + OVERLAP / 2.0);
    let corner = plan.corner(row, column);
    let mut pen = Pen::new(page.height, inset - corner);
    let strip = Vec2::repeat(OVERLAP / 2.0);
    pen.clip(corner - strip, corner + plan.frame + strip);
    pen.sheet(&plan.sheet, [corner - strip, corner + plan.frame + strip]);
    pen.unclip();
    pen.moved_to(inset);
    marks(&mut pen, plan, row, column);
    let name = field_name(row, column);
    pen.text(&name, Vec2::new(2.0 * MATCH, LETTERS + 0.002), LETTERS, false, false);
    pen.finish()
}

/// The frame, and half diamonds where a neighbour is joined, named alike on both pages.
fn marks(pen: &mut Pen, plan: &Plan, row: usize, column: usize) {
    let size = plan.frame;
    let corners = [(0.0, 0.0), (size.x, 0.0), (size.x, size.y), (0.0, size.y)];
    pen.closed(&corners.map(|(x, y)| Vec2::new(x, y)), true);
    // Middle of the side, along it, out of the frame, and the field on whose right or lower side it is.
    let sides = [
        (
            plan.has_page(Some(row), column.checked_sub(1)),
            Vec2::new(0.0, size.y / 2.0),
            Vec2::y(),
            Vec2::x(),
            field_name(row, column.saturating_sub(1)),
            "r",
        ),
        (
            plan.has_page(Some(row), Some(column + 1)),
            Vec2::new(size.x, size.y / 2.0),
            Vec2::y(),
            -Vec2::x(),
            field_name(row, column),
            "r",
        ),
        (
            plan.has_page(row.checked_sub(1), Some(column)),
            Vec2::new(size.x / 2.0, 0.0),
            Vec2::x(),
            Vec2::y(),
            above(row, column),
            "d",
        ),
        (
            plan.has_page(Some(row + 1), Some(column)),
            Vec2::new(size.x / 2.0, size.y),
            Vec2::x(),
            -Vec2::y(),
            field_name(row, column),
            "d",
        ),
    ];
    for (joined, middle, along, inward, name, side) in sides {
        if joined {
            pen.line(&[middle - along * MATCH, middle + inward * MATCH, middle + along * MATCH], true);
            let at = middle + inward * (MATCH + LETTERS * 1.5) + Vec2::y() * (LETTERS / 2.0);
            pen.text(&format!("{name}{side}"), at, LETTERS * 0.8, true, false);
        }
    }
}

fn above(row: usize, column: usize) -> String {
    field_name(row.saturating_sub(1), column)
}

fn cover(title: &str, papers: &[Paper], plan: &Plan, page: Page) -> Content {
    let mut pen = Pen::new(page.height, Vec2::repeat(0.015));
    let mut line = 0.006;
    let mut write = |pen: &mut Pen, words: &str, height: f64| {
        pen.text(words, Vec2::new(0.0, line), height, false, false);
        line += 1.7 * height;
    };
    let title = crate::input::shown(title, LONGEST_TITLE);
    let fitting = (page.width - 0.030) / (LETTER_WIDTH * title.chars().count().max(1) as f64);
    write(&mut pen, &title, fitting.min(0.006));
    let how = format!("{} pages of {}, {} rows of {}", plan.pages(), page.name, plan.rows, plan.columns);
    write(&mut pen, &how, LETTERS);
    write(&mut pen, "Print at 100 % (actual size). The square must measure 100 mm both ways.", LETTERS);
    write(&mut pen, "Cut each page along the frame at its right and lower side, and lay it on the next", LETTERS);
    write(&mut pen, "frame on frame: equal marks meet in a diamond.", LETTERS);
    let below = line + 0.004;
    pen.square(Vec2::new(0.0, below));
    let mut line = below + TEST_SQUARE + 0.012;
    let room = page.height - 0.030;
    for paper in papers {
        if line > room {
            break;
        }
        let words = format!("{}: {}, {}", paper.name, paper.count, paper.fabric);
        pen.text(&crate::input::shown(&words, 50), Vec2::new(0.0, line), LETTERS, false, false);
        line += 1.7 * LETTERS;
    }
    let corner = Vec2::new(TEST_SQUARE + 0.010, below);
    map(&mut pen, plan, corner, Vec2::new(page.width - 0.030 - corner.x, page.height - 0.030 - corner.y));
    pen.finish()
}

/// The plan of the pages with the pieces on it, small.
fn map(pen: &mut Pen, plan: &Plan, corner: Vec2, room: Vec2) {
    let whole = Vec2::new(plan.columns as f64, plan.rows as f64).component_mul(&plan.frame);
    let scale = (room.component_div(&whole)).min();
    let at = |p: Vec2| corner + p * scale;
    for row in 0..plan.rows {
        for column in (0..plan.columns).filter(|&c| plan.is_used(row, c)) {
            let (low, high) = (plan.corner(row, column), plan.corner(row + 1, column + 1));
            let corners = [low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)];
            pen.closed(&corners.map(at), true);
            let middle = at((low + high) / 2.0);
            let letters = LETTERS.min(plan.frame.x * scale / 4.0);
            pen.text(&field_name(row, column), middle, letters, true, false);
        }
    }
    for contour in plan.sheet.papers.iter().flat_map(|p| &p.cut) {
        let mut points = contour.clone();
        points.dedup_by(|b, a| (*b - *a).norm() < MAP_DETAIL);
        pen.closed(&points.into_iter().map(at).collect::<Vec<_>>(), true);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A piece with these corners and nothing on it but a short grain in its middle.
    fn paper(corners: &[[f64; 2]], grain: [f64; 2]) -> Paper {
        let middle = Vec2::new(grain[0], grain[1]);
        Paper {
            name: "piece".into(),
            count: "cut 1".into(),
            quantity: 1,
            mirrored: false,
            drawn: None,
            fabric: "shell".into(),
            cloth: None,
            cut: vec![corners.iter().map(|&[x, y]| Vec2::new(x, y)).collect()],
            fold: None,
            sew: Vec::new(),
            notches: Vec::new(),
            grain: [middle, middle - Vec2::new(0.0, 0.01)],
            marks: Vec::new(),
            drills: Vec::new(),
            texts: Vec::new(),
            narrowed: Vec::new(),
        }
    }

    #[test]
    fn every_page_with_a_line_is_printed_and_no_blank_one() {
        // Frames of 10 cm; the side from the last corner to the first runs down the left.
        let square = [[0.0, 0.0], [0.45, 0.0], [0.45, 0.45], [0.0, 0.45]];
        let plan = Plan::of_width(&[paper(&square, [0.05, 0.05])], Vec2::repeat(0.1), 5);
        let used: Vec<String> = (0..plan.rows)
            .map(|row| (0..plan.columns).map(|c| if plan.is_used(row, c) { '#' } else { '.' }).collect())
            .collect();
        assert_eq!(used, ["#####", "#...#", "#...#", "#...#", "#####"]);
    }

    #[test]
    fn what_is_only_in_the_strip_beside_a_page_takes_none() {
        // Three millimetres past the second frame would be in the strip of a third page.
        let square = [[0.0, 0.0], [0.197, 0.0], [0.197, 0.09], [0.0, 0.09]];
        let plan = Plan::of_width(&[paper(&square, [0.05, 0.05])], Vec2::repeat(0.1), 3);
        assert_eq!(plan.pages(), 2);
    }
}
