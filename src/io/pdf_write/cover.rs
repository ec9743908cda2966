//! The first pages: what is to be measured, joined and cut, and in what order it is sewn.

use super::Page;
use super::draw::{PageContent, PagePen};
use super::pages::{FieldPlan, LETTERS, field_name};
use crate::cutting::{INCH_SQUARE, LETTER_WIDTH, Paper, TEST_SQUARE};
use crate::geometry::Vec2;

/// The margin of these pages, metres.
const MARGIN: f64 = 0.015;
/// Points of the outline nearer than this (metres) are one on the plan.
const MAP_DETAIL: f64 = 0.003;
/// Most letters of a title.
const LONGEST_TITLE: usize = 80;
/// Largest letters of a title, metres.
const TITLE: f64 = 0.006;
/// Distance of lines over the height of letters.
const LINE: f64 = 1.7;
/// Space round the squares, metres.
const GAP: f64 = 0.010;

/// The title, how to print and to join, the squares, the pieces, and the plan of the pages.
pub(super) fn cover(title: &str, papers: &[Paper], plan: &FieldPlan, page: Page) -> PageContent {
    let mut pen = PagePen::new(page.height, Vec2::repeat(MARGIN));
    let room = Vec2::new(page.width, page.height) - Vec2::repeat(2.0 * MARGIN);
    let mut line = TITLE;
    let mut write = |pen: &mut PagePen, words: &str, height: f64| {
        pen.text(words, Vec2::new(0.0, line), height, false, false);
        line += LINE * height;
    };
    let title = crate::input::shown(title, LONGEST_TITLE);
    let fitting = room.x / (LETTER_WIDTH * title.chars().count().max(1) as f64);
    write(&mut pen, &title, fitting.min(TITLE));
    let how = format!("{} pages of {}, {} rows of {}", plan.pages(), page.name, plan.rows, plan.columns);
    write(&mut pen, &how, LETTERS);
    write(&mut pen, "Print at 100 % (actual size). The squares must measure 100 mm and 2 inches both ways.", LETTERS);
    write(&mut pen, "Cut each page along the frame at its right and lower side, and lay it on the next", LETTERS);
    write(&mut pen, "frame on frame: equal marks meet in a diamond.", LETTERS);
    let below = line + 0.004;
    pen.square(Vec2::new(0.0, below));
    pen.inch_square(Vec2::new(TEST_SQUARE + GAP, below));
    list(&mut pen, papers, [below + TEST_SQUARE + GAP, room.y]);
    let corner = Vec2::new(TEST_SQUARE + GAP, below + INCH_SQUARE + GAP);
    map(&mut pen, plan, corner, room - corner);
    pen.finish()
}

/// How many are cut of what, as far as there is room between two heights.
fn list(pen: &mut PagePen, papers: &[Paper], [from, to]: [f64; 2]) {
    let rows = ((to - from) / (LINE * LETTERS)) as usize;
    for (k, paper) in papers.iter().filter(|paper| paper.size.is_none()).enumerate().take(rows) {
        let words = format!("{}: {}, {}", paper.name, paper.count, paper.fabric);
        let at = Vec2::new(0.0, from + (k as f64 + 1.0) * LINE * LETTERS);
        pen.text(&crate::input::shown(&words, 50), at, LETTERS, false, false);
    }
}

/// The order of sewing, on as many pages as it takes.
pub(super) fn sewing(steps: &[String], page: Page) -> Vec<PageContent> {
    let room = Vec2::new(page.width, page.height) - Vec2::repeat(2.0 * MARGIN);
    let most = (room.x / (LETTER_WIDTH * LETTERS)) as usize;
    let numbered = steps.iter().enumerate().flat_map(|(k, step)| wrapped(&format!("{}  {step}", k + 1), most));
    let lines: Vec<String> = numbered.collect();
    let rows = ((room.y - 2.0 * LINE * TITLE) / (LINE * LETTERS)) as usize;
    lines.chunks(rows.max(1)).map(|lines| steps_page(lines, page)).collect()
}

fn steps_page(lines: &[String], page: Page) -> PageContent {
    let mut pen = PagePen::new(page.height, Vec2::repeat(MARGIN));
    pen.text("Order of sewing", Vec2::new(0.0, TITLE), TITLE, false, false);
    for (k, line) in lines.iter().enumerate() {
        let at = Vec2::new(0.0, 2.0 * LINE * TITLE + k as f64 * LINE * LETTERS);
        pen.text(line, at, LETTERS, false, false);
    }
    pen.finish()
}

/// A text in lines of no more letters than `most`, as far as its words allow; all but the first are indented.
fn wrapped(text: &str, most: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if lines[last].chars().count() + word.chars().count() + 1 > most && !lines[last].trim().is_empty() {
            lines.push(format!("    {word}"));
        } else {
            let space = if lines[last].is_empty() { "" } else { " " };
            lines[last] = format!("{}{space}{word}", lines[last]);
        }
    }
    lines
}

/// The plan of the pages with the pieces on it, small.
fn map(pen: &mut PagePen, plan: &FieldPlan, corner: Vec2, room: Vec2) {
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

    #[test]
    fn long_steps_are_wrapped_between_words() {
        let lines = wrapped("12  armhole: front.armhole + back.armhole to sleeve.cap", 30);
        assert_eq!(lines, ["12  armhole: front.armhole +", "    back.armhole to sleeve.cap"]);
        assert_eq!(wrapped("unbreakable", 3), ["unbreakable"]);
    }
}
