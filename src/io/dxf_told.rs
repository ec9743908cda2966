//! Texts on the lines themselves, for statements that DXF-AAMA has no layer for: names of edges, kinds of inner lines,
//! directions of pleats, edges of notches. Other readers show them as any annotation, so that people find the
//! kind of a line on the screen.

use crate::cutting::NotchMark;
use crate::digitize::ToldNotch;
use crate::geometry::{Path, Vec2};
use crate::pattern::{Corner, LineKind, NotchKind};

/// A text stands at this share of its line: beyond it no two lines meet as they do at their ends and cross in their
/// middles.
const SHARE: f64 = 0.3;
/// And no farther from there than this (metres): its coordinates are rounded.
const NEAR: f64 = 1e-5;

/// The statements on a line.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Told {
    /// It is this edge of the piece, whose allowance ends so at corners.
    Edge(String, Option<Corner>),
    /// It is a line inside, and does this.
    Line(String, LineKind),
    /// A pleat is folded along it.
    PleatFold,
    /// And this is where that fold is brought to.
    PleatPlace,
    /// The arrow from the one to the other.
    PleatArrow,
}

impl Told {
    /// As it is written.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Edge(name, None) => format!("Edge: {name}"),
            Self::Edge(name, Some(corner)) => format!("Edge: {name}, {}", corner.word()),
            Self::Line(name, LineKind::Fold(angle)) => format!("Line: {name}, fold {:.4}", angle.to_degrees()),
            Self::Line(name, LineKind::Elastic(ratio)) => format!("Line: {name}, elastic {ratio:.4}"),
            Self::Line(name, LineKind::Mark(kind)) => format!("Line: {name}, {kind}"),
            Self::PleatFold => "Pleat: fold".to_owned(),
            Self::PleatPlace => "Pleat: place".to_owned(),
            Self::PleatArrow => "Pleat: arrow".to_owned(),
        }
    }

    /// The statement of a text, if it is one of these.
    pub(super) fn read(text: &str) -> Option<Self> {
        let (key, value) = text.split_once(": ")?;
        match (key, value.trim()) {
            ("Edge", value) => Some(edge(value)),
            ("Line", value) => value.split_once(", ").map(|(name, kind)| Self::Line(name.to_owned(), line_kind(kind))),
            ("Pleat", "fold") => Some(Self::PleatFold),
            ("Pleat", "place") => Some(Self::PleatPlace),
            ("Pleat", "arrow") => Some(Self::PleatArrow),
            _ => None,
        }
    }
}

/// Names of edges have no commas.
fn edge(text: &str) -> Told {
    let ends = text.split_once(", ").and_then(|(name, word)| Some((name, Corner::from_word(word)?)));
    ends.map_or_else(|| Told::Edge(text.to_owned(), None), |(name, corner)| Told::Edge(name.to_owned(), Some(corner)))
}

fn line_kind(text: &str) -> LineKind {
    let number = |key: &str| text.strip_prefix(key)?.trim().parse::<f64>().ok();
    let fold = number("fold ").and_then(LineKind::fold);
    let elastic = || number("elastic ").and_then(LineKind::elastic);
    fold.or_else(elastic).unwrap_or_else(|| LineKind::Mark(text.to_owned()))
}

/// Where what is told of a line stands.
pub(super) fn place(line: &Path) -> Vec2 {
    line.point(SHARE * line.length())
}

/// The statements of the texts at these places on a line.
pub(super) fn told_of<'t>(line: &Path, texts: &'t [(Told, Vec2)]) -> Option<&'t Told> {
    let place = place(line);
    texts.iter().find(|(_, at)| (at - place).norm() <= NEAR).map(|(told, _)| told)
}

/// The statement on a notch where it meets the sewing line. The edge's name is last, for it may hold anything.
pub(super) fn notch_text(notch: &NotchMark) -> String {
    format!("Notch: {}, {}", notch.kind.word(), notch.edge)
}

/// The statement of a text on a notch, if it is one of these.
pub(super) fn read_notch(text: &str) -> Option<ToldNotch> {
    let (kind, edge) = text.strip_prefix("Notch: ")?.split_once(", ")?;
    Some(ToldNotch { kind: NotchKind::from_word(kind)?, edge: edge.trim().to_owned() })
}

/// Whether a place is on a slit that begins at `at` and goes so far `into` the piece.
pub(super) fn is_on_slit(place: Vec2, at: Vec2, into: Vec2) -> bool {
    let depth = into.norm();
    let along = into.try_normalize(0.0).unwrap_or_else(Vec2::zeros);
    let way = along.dot(&(place - at)).clamp(0.0, depth);
    (at + along * way - place).norm() <= NEAR
}
