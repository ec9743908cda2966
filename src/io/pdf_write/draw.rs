//! Lines and letters on a page.

use std::collections::BTreeSet;

use pdf_writer::{Content, Name, Str};

use super::POINTS;
use super::letters::{CAPITALS, drawn_letters, font_runs, width};
use crate::cutting::{
    CLOTH_LETTERS, ClothLength, INCH_SQUARE, MarkKind, Paper, PaperLayer, PaperSize, SQUARE_GAP, SewKind, Sheet,
    TEST_SQUARE, grain_arrow, layers,
};
use crate::geometry::{Path, Vec2};

/// Widths of lines, points: what is cut, and everything else.
const CUT: f32 = 1.4;
const FINE: f32 = 0.7;
/// Dashes of the sewing line and of the fold, points.
const SEWN: [f32; 2] = [8.0, 5.0];
const FOLD: [f32; 4] = [24.0, 6.0, 4.0, 6.0];
/// Dashes of the cut lines of sizes that are drawn over one another, points.
const SIZES: [&[f32]; 6] =
    [&[], &[9.0, 4.0], &[9.0, 4.0, 1.0, 4.0], &[4.0, 3.0], &[9.0, 3.0, 1.0, 3.0, 1.0, 3.0], &[1.0, 3.0]];
/// Half the arms of a drill mark's cross, metres.
const DRILL: f64 = 0.002;
/// How far chords may be from the curves they stand for where only the page counts, metres.
const CHORDS: f64 = 1e-4;

/// The name by which pages speak of a layer.
pub(super) fn layer_name(layer: usize) -> String {
    format!("M{layer}")
}

/// A page being drawn on; positions are metres from the upper left corner of what it shows, y down.
pub(super) struct PagePen {
    content: Content,
    /// Of the page, metres.
    height: f64,
    /// Where on the page the drawing's origin lies.
    origin: Vec2,
    /// The letters on it that are drawn as strokes.
    letters: BTreeSet<char>,
}

/// A page that is drawn.
pub(super) struct PageContent {
    pub(super) content: Content,
    /// The letters on it that are drawn as strokes.
    pub(super) letters: BTreeSet<char>,
}

impl PagePen {
    pub(super) fn new(height: f64, origin: Vec2) -> Self {
        let mut content = Content::new();
        content.set_line_cap(pdf_writer::types::LineCapStyle::RoundCap);
        content.set_line_join(pdf_writer::types::LineJoinStyle::RoundJoin);
        Self { content, height, origin, letters: BTreeSet::new() }
    }

    pub(super) fn finish(self) -> PageContent {
        PageContent { content: self.content, letters: self.letters }
    }

    /// Nothing is drawn outside of this any more, until [`PagePen::unclip`].
    pub(super) fn clip(&mut self, low: Vec2, high: Vec2) {
        self.content.save_state();
        let (a, b) = (self.place(low), self.place(high));
        self.content.rect(a[0], b[1], b[0] - a[0], a[1] - b[1]).clip_nonzero().end_path();
    }

    pub(super) fn unclip(&mut self) {
        self.content.restore_state();
    }

    pub(super) fn moved_to(&mut self, origin: Vec2) {
        self.origin = origin;
    }

    fn place(&self, p: Vec2) -> [f32; 2] {
        let on_page = p + self.origin;
        [(on_page.x * POINTS) as f32, ((self.height - on_page.y) * POINTS) as f32]
    }

    fn style(&mut self, width: f32, dashes: &[f32]) {
        self.content.set_line_width(width).set_dash_pattern(dashes.iter().copied(), 0.0);
    }

    fn trace(&mut self, points: &[Vec2]) {
        for (i, &p) in points.iter().enumerate() {
            let [x, y] = self.place(p);
            if i == 0 {
                self.content.move_to(x, y);
            } else {
                self.content.line_to(x, y);
            }
        }
    }

    /// A cut line, in the dashes of its size.
    fn cut(&mut self, points: &[Vec2], open: bool, size: Option<&PaperSize>) {
        self.style(CUT, size.map_or(&[], |size| SIZES[size.number % SIZES.len()]));
        self.trace(points);
        if open {
            self.content.stroke()
        } else {
            self.content.close_and_stroke()
        };
    }

    pub(super) fn line(&mut self, points: &[Vec2], fine: bool) {
        self.style(if fine { FINE } else { CUT }, &[]);
        self.trace(points);
        self.content.stroke();
    }

    pub(super) fn closed(&mut self, points: &[Vec2], fine: bool) {
        self.style(if fine { FINE } else { CUT }, &[]);
        self.trace(points);
        self.content.close_and_stroke();
    }

    fn path(&mut self, path: &Path, dashes: &[f32]) {
        self.style(FINE, dashes);
        for (i, (from, controls, to)) in path.beziers().enumerate() {
            if i == 0 {
                let [x, y] = self.place(from);
                self.content.move_to(x, y);
            }
            let [x, y] = self.place(to);
            match controls.map(|c| c.map(|p| self.place(p))) {
                Some([one, two]) => self.content.cubic_to(one[0], one[1], two[0], two[1], x, y),
                None => self.content.line_to(x, y),
            };
        }
        self.content.stroke();
    }

    /// A line of text with its foot at `at`: begun there, or (`centred`) its middle there.
    pub(super) fn text(&mut self, words: &str, at: Vec2, height: f64, centred: bool, upright: bool) {
        let size = height / CAPITALS;
        let back = if centred { width(words) * size / 2.0 } else { 0.0 };
        let along = if upright { Vec2::y() } else { Vec2::x() };
        let [x, y] = self.place(at - along * back);
        let matrix = if upright { [0.0, -1.0, 1.0, 0.0, x, y] } else { [1.0, 0.0, 0.0, 1.0, x, y] };
        self.content.begin_text().set_text_matrix(matrix);
        for run in font_runs(words) {
            self.content.set_font(Name(run.font.as_bytes()), (size * POINTS) as f32).show(Str(&run.codes));
        }
        self.content.end_text();
        self.letters.extend(drawn_letters(words));
    }

    /// The parts of a sheet that lie in the box from `low` to `high`, or touch it.
    pub(super) fn sheet(&mut self, sheet: &Sheet, [low, high]: [Vec2; 2]) {
        sheet.cloth.iter().for_each(|cloth| self.cloth(cloth));
        let layers = layers(&sheet.papers);
        for paper in &sheet.papers {
            let [least, greatest] = paper.extent();
            if (0..2).all(|k| least[k] <= high[k] && greatest[k] >= low[k]) {
                let own = PaperLayer::of(paper);
                let layer = layers.iter().position(|layer| *layer == own).unwrap_or(0);
                let name = layer_name(layer);
                self.content.begin_marked_content_with_properties(Name(b"OC")).properties_named(Name(name.as_bytes()));
                self.paper(paper);
                self.content.end_marked_content();
            }
        }
        if let Some(corner) = sheet.square {
            self.square(corner);
            self.inch_square(corner + Vec2::new(TEST_SQUARE + SQUARE_GAP, 0.0));
        }
    }

    /// A stretch of cloth: its edges, its fold, and what it is.
    fn cloth(&mut self, cloth: &ClothLength) {
        let (low, high) = (cloth.corner, cloth.corner + cloth.size);
        self.closed(&[low, Vec2::new(high.x, low.y), high, Vec2::new(low.x, high.y)], true);
        let [height, above] = CLOTH_LETTERS;
        self.text(&cloth.text, low - Vec2::new(0.0, above), height * CAPITALS, false, false);
        if cloth.folded {
            self.style(2.0 * CUT, &FOLD);
            self.trace(&[low, Vec2::new(low.x, high.y)]);
            self.content.stroke();
        }
    }

    /// The square to measure.
    pub(super) fn square(&mut self, corner: Vec2) {
        self.measured(corner, TEST_SQUARE, "100 mm");
    }

    /// The square to measure in inches.
    pub(super) fn inch_square(&mut self, corner: Vec2) {
        self.measured(corner, INCH_SQUARE, "2 inches");
    }

    fn measured(&mut self, corner: Vec2, side: f64, words: &str) {
        let corners = [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)];
        self.closed(&corners.map(|(x, y)| corner + Vec2::new(x, y)), true);
        self.text(words, corner + Vec2::repeat(side / 2.0), 0.005, true, false);
    }

    fn paper(&mut self, paper: &Paper) {
        for (i, contour) in paper.cut.iter().enumerate() {
            self.cut(contour, i == 0 && paper.fold.is_some(), paper.size.as_ref());
        }
        if let Some(fold) = paper.fold {
            self.style(CUT, &FOLD);
            self.trace(&fold);
            self.content.stroke();
        }
        for line in &paper.sew {
            let dashes: &[f32] = if matches!(line.of, SewKind::Dart | SewKind::FishEye) { &[] } else { &SEWN };
            self.path(&line.path, dashes);
        }
        for notch in &paper.notches {
            self.line(&[notch.at, notch.inside], false);
        }
        for mark in &paper.marks {
            self.path(&mark.path, if mark.kind == MarkKind::Line { &SEWN } else { &[] });
        }
        for (_, at) in &paper.drills {
            self.line(&[at - Vec2::x() * DRILL, at + Vec2::x() * DRILL], true);
            self.line(&[at - Vec2::y() * DRILL, at + Vec2::y() * DRILL], true);
        }
        // A nest has one, beside its label.
        if paper.size.is_none() {
            self.line(&grain_arrow(paper.grain), true);
        }
        for t in &paper.texts {
            self.text(&t.text, t.at, t.height, true, t.upright);
        }
    }
}

/// Every line that [`PagePen::paper`] draws, curves as chords, and the boxes of the letters.
pub(super) fn lines(paper: &Paper) -> Vec<[Vec2; 2]> {
    let mut lines = Vec::new();
    let mut add = |points: &[Vec2]| lines.extend(points.windows(2).map(|w| [w[0], w[1]]));
    for (i, contour) in paper.cut.iter().enumerate() {
        add(contour);
        // A half piece is open at its fold, which has a line of its own.
        if let (Some(first), Some(last), true) = (contour.first(), contour.last(), i > 0 || paper.fold.is_none()) {
            add(&[*last, *first]);
        }
    }
    paper.fold.iter().for_each(|fold| add(fold));
    paper.sew.iter().for_each(|line| add(&line.path.sampled(CHORDS)));
    paper.marks.iter().for_each(|mark| add(&mark.path.sampled(CHORDS)));
    paper.notches.iter().for_each(|notch| add(&[notch.at, notch.inside]));
    for (_, at) in &paper.drills {
        [Vec2::x(), Vec2::y()].iter().for_each(|arm| add(&[at - arm * DRILL, at + arm * DRILL]));
    }
    add(&grain_arrow(paper.grain));
    for t in &paper.texts {
        let along = if t.upright { Vec2::y() } else { Vec2::x() };
        let up = Vec2::new(along.y, -along.x) * t.height;
        let half = along * (width(&t.text) * t.height / CAPITALS / 2.0);
        add(&[t.at - half, t.at + half, t.at + half + up, t.at - half + up, t.at - half]);
    }
    lines
}
