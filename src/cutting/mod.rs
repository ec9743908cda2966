//! Patterns for cutting: the sheets that a maker prints, lays on the cloth and cuts round.
//!
//! A [`Sheet`] is a set of [`Paper`] pieces laid out side by side. Every paper has a cut line (the sewing line moved
//! out by the allowance of each edge), the sewing lines, notches, grain and fold arrows, inner lines, drill marks and
//! its lettering. Writers of formats draw this and add nothing. Lengths are metres, y down, the right side of the cloth
//! up.

mod clean;
mod corner;
mod label;
mod layout;
mod marks;
mod nest;
mod offset;
mod outline;
mod plan;
mod room;
mod run;
mod sewing;
mod walls;
mod whole;

pub use label::{LETTER_WIDTH, Label, PieceWords};
pub use layout::{CLOTH_LETTERS, ClothLength, INCH_SQUARE, Layout, SQUARE_GAP, Sheet, TEST_SQUARE, shelves};
pub use marks::{arrow, grain_arrow};
pub use nest::{PaperLayer, PaperSize, layers, nested};
pub use outline::{labelled, papers};
pub use plan::{LaidPaper, Plan, PlanError, PlanOptions, plan_sheet, plans};
pub use room::{Room, foot};
pub use sewing::{SewingStep, sewing_order};

use nalgebra::Matrix2;

use crate::geometry::{Path, Vec2, box_of, box_or_origin};
use crate::pattern::{Corner, LineKind, NotchKind, Side};

/// Choices that the file does not make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CuttingOptions {
    /// Allowance of edges for which the file gives none, metres.
    pub allowance: f64,
    /// Pieces as they are cut: folds opened, both of a pair, every copy.
    pub whole: bool,
}

/// The usual allowance of metric patterns, metres.
pub const DEFAULT_ALLOWANCE: f64 = 0.010;

impl Default for CuttingOptions {
    fn default() -> Self {
        Self { allowance: DEFAULT_ALLOWANCE, whole: false }
    }
}

/// A piece on paper.
#[derive(Clone, Debug)]
pub struct Paper {
    /// `front`, or `front.L` where pieces are drawn as they are cut.
    pub name: String,
    /// Number of cut pieces, in words: `cut 2 (left and right)`.
    pub count: String,
    /// Number of them in the garment.
    pub quantity: usize,
    /// Whether half of these are mirrored.
    pub mirrored: bool,
    /// The drawn one of a pair, or the drawn half. `None` if nothing is mirrored.
    pub drawn: Option<Side>,
    /// Name of its fabric.
    pub fabric: String,
    /// The library's fabric that this is, if it is one.
    pub cloth: Option<String>,
    /// Cut lines: the outline, then bays and holes. Closed; but with a [`Paper::fold`] the outline is open and runs
    /// from the end of the fold to its start.
    pub cut: Vec<Vec<Vec2>>,
    /// The line that lies on the fold of the cloth, along the outline.
    pub fold: Option<[Vec2; 2]>,
    /// Sewing lines by edge: of the outline, of holes and of darts.
    pub sew: Vec<SewLine>,
    /// Notches.
    pub notches: Vec<NotchMark>,
    /// Tail and head of the grain line.
    pub grain: [Vec2; 2],
    /// Arrows, inner lines and the like.
    pub marks: Vec<Mark>,
    /// Points to be marked through all layers: ends of darts, buttons.
    pub drills: Vec<(String, Vec2)>,
    /// The words on it.
    pub words: PieceWords,
    /// Its lettering.
    pub texts: Vec<Lettering>,
    /// Allowances of holes for which these are too small.
    pub narrowed: Vec<Narrowed>,
    /// Number of the piece whose sizes lie over one another, and of which this is a size or the label.
    pub nest: Option<usize>,
    /// The size that it is of, in a nest.
    pub size: Option<PaperSize>,
    /// Lines of other sizes, which labels keep clear of. Of the label of a nest those of all, the cut line of the
    /// smallest first.
    pub others: Vec<Vec<Vec2>>,
}

/// An allowance that does not fit into its hole, and the one drawn in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Narrowed {
    /// The hole's edge.
    pub edge: String,
    /// As asked for, metres.
    pub asked: f64,
    /// As drawn, metres.
    pub drawn: f64,
}

/// A sewing line.
#[derive(Clone, Debug)]
pub struct SewLine {
    /// The edge's name.
    pub name: String,
    /// Its course.
    pub path: Path,
    /// Its kind.
    pub of: SewKind,
    /// Ending of its allowance at corners, if the file gives one.
    pub corner: Option<Corner>,
}

/// Kinds of sewing lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SewKind {
    /// The outline. Part of it, together with the fold and the darts' legs.
    Outline,
    /// A hole that is cut out.
    Hole,
    /// A dart's leg.
    Dart,
    /// A side of a fish-eye dart.
    FishEye,
    /// Line of a seam over the mouth of a dart that is sewn and pressed.
    Mouth,
}

/// A notch's mark.
#[derive(Clone, Debug, PartialEq)]
pub struct NotchMark {
    /// On the cut line.
    pub at: Vec2,
    /// On the sewing line.
    pub sewn: Vec2,
    /// The end of its mark: on the sewing line, or where that is near, a little inside.
    pub inside: Vec2,
    /// Its kind.
    pub kind: NotchKind,
    /// Name of the edge it stands on.
    pub edge: String,
}

/// A line that is drawn and neither cut nor sewn.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Its kind.
    pub kind: MarkKind,
    /// Its name, if it has one.
    pub name: String,
    /// Its course.
    pub path: Path,
    /// Purpose of a line of the file.
    pub line: Option<LineKind>,
}

/// Kinds of marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MarkKind {
    /// The bent arrow at a fold.
    Fold,
    /// The line along which a pleat is folded, from the edge.
    PleatFold,
    /// The line to which that fold is brought.
    PleatPlace,
    /// The arrow from the one to the other.
    PleatArrow,
    /// A line of the file.
    Line,
}

/// A line of text, centred.
#[derive(Clone, Debug, PartialEq)]
pub struct Lettering {
    /// The words.
    pub text: String,
    /// Middle of the line's foot.
    pub at: Vec2,
    /// Height of the letters, metres.
    pub height: f64,
    /// Whether it is turned to be read from the right.
    pub upright: bool,
}

impl Paper {
    /// Every point moved by `p ↦ linear · p + shift`. `linear` keeps lengths.
    #[must_use]
    fn mapped(&self, linear: Matrix2<f64>, shift: Vec2) -> Self {
        let to = |p: Vec2| linear * p + shift;
        let path = |p: &Path| p.mapped(linear, shift);
        Self {
            cut: self.cut.iter().map(|c| c.iter().map(|&p| to(p)).collect()).collect(),
            fold: self.fold.map(|f| f.map(to)),
            sew: self.sew.iter().map(|s| SewLine { path: path(&s.path), ..s.clone() }).collect(),
            notches: self
                .notches
                .iter()
                .map(|n| NotchMark { at: to(n.at), sewn: to(n.sewn), inside: to(n.inside), ..n.clone() })
                .collect(),
            grain: self.grain.map(to),
            marks: self.marks.iter().map(|m| Mark { path: path(&m.path), ..m.clone() }).collect(),
            drills: self.drills.iter().map(|(k, p)| (k.clone(), to(*p))).collect(),
            texts: self.texts.iter().map(|t| Lettering { at: to(t.at), ..t.clone() }).collect(),
            others: self.others.iter().map(|c| c.iter().map(|&p| to(p)).collect()).collect(),
            ..self.clone()
        }
    }

    /// The boxes round its lettering, each by its least and greatest coordinates.
    pub fn lettered(&self) -> impl Iterator<Item = [Vec2; 2]> + '_ {
        self.texts.iter().map(|text| box_or_origin(label::outline(text)))
    }

    /// Least and greatest coordinates of its cut lines; of the label of a nest those of its sizes.
    pub fn bounds(&self) -> [Vec2; 2] {
        let lines = if self.cut.is_empty() { &self.others } else { &self.cut };
        box_or_origin(lines.iter().flatten().chain(self.fold.iter().flatten()).copied())
    }

    /// Bounds as of [`Paper::bounds`], with the lettering beside it.
    pub fn extent(&self) -> [Vec2; 2] {
        let written = self.texts.iter().flat_map(label::outline);
        box_of(written.chain(self.bounds()))
    }
}
