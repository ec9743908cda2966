//! Sheets on pages.

use super::cover::{cover, sewing};
use super::draw::{PageContent, PagePen, lines};
use super::{LONGEST_SIDE, POINTS, Page, PdfError, document};
use crate::cutting::{LETTER_WIDTH, Layout, Paper, Sheet, layers};
use crate::geometry::Vec2;

/// The margin that home printers leave white at every side, metres, with a little to spare.
const MARGIN: f64 = 0.007;
/// Width of the strip that neighbouring pages share, metres.
const OVERLAP: f64 = 0.010;
/// Half the diagonal of a match mark, metres.
const MATCH: f64 = 0.004;
/// Lines that end within this of a frame, metres, are on the pages at both of its sides: half the width of a cut line.
const TOUCH: f64 = 2.5e-4;
/// Space round the names on a page, metres, and how far apart the places are that are tried for one, and their number
/// to either side.
const NAME_AIR: f64 = 0.0007;
const NAME_STEP: f64 = 0.004;
const NAME_PLACES: u32 = 20;
/// Rows of such places.
const NAME_ROWS: u32 = 4;
/// More pages than this are a wrong unit.
const MOST_PAGES: usize = 600;
/// Letters of the first page and of the pages' names, metres.
pub(super) const LETTERS: f64 = 0.0035;

/// One page that holds the whole sheet.
///
/// # Errors
/// [`PdfError::TooLarge`].
pub fn one_page(title: &str, sheet: &Sheet) -> Result<Vec<u8>, PdfError> {
    if sheet.size.max() * POINTS > LONGEST_SIDE {
        return Err(PdfError::TooLarge { width: sheet.size.x * 1e3, height: sheet.size.y * 1e3 });
    }
    let mut pen = PagePen::new(sheet.size.y, Vec2::zeros());
    pen.sheet(sheet, [Vec2::zeros(), sheet.size]);
    Ok(document(title, [sheet.size.x, sheet.size.y], vec![pen.finish()], &layers(&sheet.papers)))
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
    booklet(title, papers, &[], page)
}

/// As [`tiled`], with the order of sewing, a line per `step`, on pages behind the first. Labels are moved clear of
/// the frames along which pages are joined, as far as the pieces have room.
///
/// # Errors
/// As [`tiled`].
pub fn booklet(title: &str, papers: &[Paper], steps: &[String], page: Page) -> Result<Vec<u8>, PdfError> {
    let frame = Vec2::new(page.width, page.height) - Vec2::repeat(2.0 * MARGIN + OVERLAP);
    let plan = FieldPlan::new(papers, frame)?.with_clear_labels();
    let mut pages = vec![cover(title, papers, &plan, page)];
    pages.extend(sewing(steps, page));
    for row in 0..plan.rows {
        for column in (0..plan.columns).filter(|&c| plan.is_used(row, c)) {
            pages.push(tile(&plan, row, column, page));
        }
    }
    Ok(document(title, [page.width, page.height], pages, &layers(&plan.sheet.papers)))
}

/// A sheet cut into fields.
pub(super) struct FieldPlan {
    pub(super) sheet: Sheet,
    pub(super) frame: Vec2,
    pub(super) columns: usize,
    pub(super) rows: usize,
    used: Vec<bool>,
    /// All that is drawn, as segments.
    lines: Vec<[Vec2; 2]>,
}

impl FieldPlan {
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
        let mut plan = Self { sheet, frame, columns, rows, used: Vec::new(), lines: Vec::new() };
        plan.look();
        plan
    }

    /// The plan with the labels of its pieces off the lines between fields.
    fn with_clear_labels(mut self) -> Self {
        let frame = self.frame;
        let is_cut =
            |[low, high]: [Vec2; 2]| (0..2).any(|k| (low[k] / frame[k]).floor() < (high[k] / frame[k]).floor());
        for paper in &mut self.sheet.papers {
            if paper.lettered().any(is_cut) {
                *paper = paper.lettered_clear_of(&joins(paper.extent(), frame));
            }
        }
        self.look();
        self
    }

    /// Finds what is drawn, and on which fields.
    fn look(&mut self) {
        self.lines = self.sheet.papers.iter().flat_map(lines).collect();
        self.used = self.drawn_on();
    }

    /// Whether nothing is drawn in a box on the sheet.
    fn is_clear(&self, low: Vec2, high: Vec2) -> bool {
        !self.lines.iter().any(|[a, b]| segment_meets(*a, *b, low, high))
    }

    pub(super) fn pages(&self) -> usize {
        self.used.iter().filter(|used| **used).count()
    }

    pub(super) fn is_used(&self, row: usize, column: usize) -> bool {
        self.used[row * self.columns + column]
    }

    /// Upper left corner of a field.
    pub(super) fn corner(&self, row: usize, column: usize) -> Vec2 {
        Vec2::new(column as f64, row as f64).component_mul(&self.frame)
    }

    /// Whether a line or a letter is within the frame, for every field. The strip beyond the frame does not count: it
    /// shows a part of the neighbour.
    fn drawn_on(&self) -> Vec<bool> {
        let mut used = vec![false; self.rows * self.columns];
        // The fields that coordinates reach, at least the last one: a sheet ends on its last frame.
        let reach = |from: f64, to: f64, of: f64, count: usize| {
            let field = |x: f64| ((x / of).max(0.0) as usize).min(count - 1);
            field(from - TOUCH)..=field(to + TOUCH)
        };
        for &[a, b] in &self.lines {
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

/// The lines between fields that run through a box.
fn joins([low, high]: [Vec2; 2], frame: Vec2) -> Vec<[Vec2; 2]> {
    let between = |k: usize| {
        let [first, last] = [low[k], high[k]].map(|x| (x / frame[k]).floor().max(0.0) as usize);
        (first + 1..=last).map(move |i| i as f64 * frame[k])
    };
    let upright = between(0).map(|x| [Vec2::new(x, low.y), Vec2::new(x, high.y)]);
    let level = between(1).map(|y| [Vec2::new(low.x, y), Vec2::new(high.x, y)]);
    upright.chain(level).collect()
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
pub(super) fn field_name(row: usize, column: usize) -> String {
    let mut letters = String::new();
    let mut rest = row + 1;
    while rest > 0 {
        let digit = (rest - 1) % 26;
        letters.insert(0, char::from(b'A' + digit as u8));
        rest = (rest - 1) / 26;
    }
    format!("{letters}{}", column + 1)
}

fn tile(plan: &FieldPlan, row: usize, column: usize, page: Page) -> PageContent {
    let inset = Vec2::repeat(MARGIN + OVERLAP / 2.0);
    let corner = plan.corner(row, column);
    let mut pen = PagePen::new(page.height, inset - corner);
    let strip = Vec2::repeat(OVERLAP / 2.0);
    pen.clip(corner - strip, corner + plan.frame + strip);
    pen.sheet(&plan.sheet, [corner - strip, corner + plan.frame + strip]);
    pen.unclip();
    pen.moved_to(inset);
    marks(&mut pen, plan, row, column);
    let name = field_name(row, column);
    let at = Vec2::new(3.0 * MATCH, LETTERS + 0.002);
    pen.text(&name, clear_place(plan, corner, at, Vec2::x(), (&name, LETTERS)), LETTERS, true, false);
    pen.finish()
}

/// Where on a page a name is clear of all lines: at `at`, or as near to that along `along`, one of the axes, as there
/// is such a place.
/// Where there is none it stays.
fn clear_place(plan: &FieldPlan, corner: Vec2, at: Vec2, along: Vec2, (name, height): (&str, f64)) -> Vec2 {
    let half = LETTER_WIDTH * height * name.chars().count() as f64 / 2.0 + NAME_AIR;
    let is_clear = |at: &Vec2| {
        let (low, high) = (at - Vec2::new(half, height + NAME_AIR), at + Vec2::new(half, NAME_AIR));
        let on_page = low.min() > 0.0 && (0..2).all(|k| high[k] < plan.frame[k]);
        on_page && plan.is_clear(corner + low, corner + high)
    };
    // Farther into the page only where the whole side has no such place.
    let middle = plan.frame / 2.0;
    let across = Vec2::new(along.y, along.x);
    let inward = across * (middle - at).dot(&across).signum();
    let places = (0..NAME_ROWS).flat_map(|row| (0..NAME_PLACES).map(move |k| (f64::from(row), f64::from(k))));
    let moved = |(row, k): (f64, f64)| {
        let at = at + inward * (row * 2.0 * NAME_STEP);
        [1.0, -1.0].map(|side| at + along * (side * k * NAME_STEP))
    };
    places.flat_map(moved).find(is_clear).unwrap_or(at)
}

/// The frame, and half diamonds where a neighbour is joined, named alike on both pages.
fn marks(pen: &mut PagePen, plan: &FieldPlan, row: usize, column: usize) {
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
            let (name, height) = (format!("{name}{side}"), LETTERS * 0.8);
            let at = clear_place(plan, plan.corner(row, column), at, along, (&name, height));
            pen.text(&name, at, height, true, false);
        }
    }
}

fn above(row: usize, column: usize) -> String {
    field_name(row.saturating_sub(1), column)
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
            words: crate::cutting::PieceWords::default(),
            texts: Vec::new(),
            narrowed: Vec::new(),
            nest: None,
            size: None,
            others: Vec::new(),
        }
    }

    #[test]
    fn every_page_with_a_line_is_printed_and_no_blank_one() {
        // Frames of 10 cm; the side from the last corner to the first runs down the left.
        let square = [[0.0, 0.0], [0.45, 0.0], [0.45, 0.45], [0.0, 0.45]];
        let plan = FieldPlan::of_width(&[paper(&square, [0.05, 0.05])], Vec2::repeat(0.1), 5);
        let used: Vec<String> = (0..plan.rows)
            .map(|row| (0..plan.columns).map(|c| if plan.is_used(row, c) { '#' } else { '.' }).collect())
            .collect();
        assert_eq!(used, ["#####", "#...#", "#...#", "#...#", "#####"]);
    }

    #[test]
    fn what_is_only_in_the_strip_beside_a_page_takes_none() {
        // Three millimetres past the second frame would be in the strip of a third page.
        let square = [[0.0, 0.0], [0.197, 0.0], [0.197, 0.09], [0.0, 0.09]];
        let plan = FieldPlan::of_width(&[paper(&square, [0.05, 0.05])], Vec2::repeat(0.1), 3);
        assert_eq!(plan.pages(), 2);
    }
}
