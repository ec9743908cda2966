//! Makes a garment file from the lines of another program's pattern.
//!
//! A reader of a format gives [`Traced`] pieces: sewing and cut lines, grain, notches and inner lines, in metres, y
//! down. [`garment_file`] makes a `GarmentFile` of them that lacks only the seams: outlines are split into named edges
//! at corners and notches, allowances are measured, and [`Suggestion`]s list edges that may be sewn together.

mod buttons;
mod chain;
mod contour;
mod contours;
mod darts;
mod edges;
mod fasteners;
mod file;
mod fish_eyes;
mod folds;
mod follow;
mod frames;
mod hands;
mod holes;
mod joined;
mod lozenge;
mod materials;
mod notches;
mod pairs;
mod partial;
mod said;
mod sizes;
mod smooth;
mod sorted;
mod spikes;
mod stated;
mod suggest;
mod titles;
mod trimmed;

pub(crate) use chain::nearly_meet;
pub use chain::{Bridged, Gaping, bridged, chained, gaping};
pub use contours::pieces;
pub use file::{Digitized, garment_file};
pub(crate) use follow::follows;
pub use holes::{Hole, holes};
pub(crate) use notches::DOUBLE;
pub(crate) use sizes::{size_of, sizes};
pub use suggest::{Suggestion, sewn, suggestions};
pub(crate) use trimmed::parts_within;

use crate::geometry::{Path, Vec2};
use crate::pattern::{Corner, CutKind, LineKind, NotchKind, Side};

/// A line of a foreign file.
#[derive(Clone, Debug)]
pub struct Stroke {
    /// Its course.
    pub path: Path,
    /// Its role, as far as the format tells.
    pub role: Role,
    /// Its name, if it has one.
    pub name: Option<String>,
    /// The name of the group it is in, if that has one and is a piece.
    pub group: Option<String>,
    /// Name of its group or layer, be that a piece or a group of several.
    pub layer: Option<String>,
    /// Purpose of a line inside a piece, if the file tells it.
    pub kind: Option<LineKind>,
    /// Meaning of a notch, as toile itself writes it.
    pub notch: Option<ToldNotch>,
    /// The size of the pattern that it is of, where a layer says that.
    pub size: Option<String>,
    /// Whether it bounds a filled area without being drawn.
    pub filled: bool,
}

/// A notch, or one of the marks of a double one.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportedNotch {
    /// Near the outline: on the cut line or the sewing line.
    pub at: Vec2,
    /// Its meaning, if the file tells it. It is then on the sewing line.
    pub told: Option<ToldNotch>,
}

/// Meaning of a notch in toile's own drawings, so that neighbouring notches are not taken for a double one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ToldNotch {
    /// Its kind.
    pub kind: NotchKind,
    /// Name of the edge that it is on, which tells at a corner.
    pub edge: String,
}

/// Material of a piece.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Material {
    /// As the drawing calls it.
    pub name: String,
    /// The library's fabric that it is, if the drawing says so.
    pub cloth: Option<String>,
}

/// A line inside a piece.
#[derive(Clone, Debug)]
pub struct InnerLine {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Its course.
    pub path: Path,
    /// Purpose, if the file tells it.
    pub kind: Option<LineKind>,
}

/// Words of a foreign file.
#[derive(Clone, Debug)]
pub struct Remark {
    /// Their place.
    pub at: Vec2,
    /// Their text.
    pub text: String,
    /// Height of the letters, in any unit that is the same all over the file; 0 where it is not told.
    pub height: f64,
}

/// A button or what it goes through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fastener {
    /// Its place.
    pub at: Vec2,
    /// Its kind.
    pub kind: FastenerKind,
}

/// Kind of a fastener.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FastenerKind {
    /// A button.
    Button,
    /// A buttonhole.
    Buttonhole,
    /// The stud of a snap.
    Stud,
    /// The socket of a snap.
    Socket,
}

/// Role of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Not said.
    Unknown,
    /// A cut line.
    Cut,
    /// A sewing line.
    Sew,
    /// One edge of a sewing line.
    Edge,
    /// A grain line.
    Grain,
    /// An arrow of which nothing is said: the grain where no other line is.
    Arrow,
    /// The line on the fold.
    Fold,
    /// A notch: a short line, or a point as a line without length to speak of.
    Notch,
    /// Fold of a pleat: a line that begins at the edge.
    PleatFold,
    /// Place to which the fold drawn before it is brought.
    PleatPlace,
    /// A ring round a point that is marked through all layers.
    Drill,
    /// A point, as a line without length to speak of, where something is buttoned.
    Fastener(FastenerKind),
}

/// Contents of a drawing.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// Its title, if it has one.
    pub title: Option<String>,
    /// Its pieces.
    pub pieces: Vec<Traced>,
    /// Further content that was not read: a sentence for each kind.
    pub left_out: Vec<String>,
    /// Notes on assumptions about things that it does not tell.
    pub notes: Vec<String>,
    /// Faults because of which pieces are missing: a sentence for each.
    pub faults: Vec<String>,
    /// Area inside closed lines that were left out though they may be pieces, m².
    pub lost: f64,
    /// The sizes that it holds, in its order. None where it is drawn in one.
    pub sizes: Vec<String>,
}

/// Largest share of a drawing's area that may be lost.
const MOST_LOST: f64 = 0.1;

impl Drawing {
    /// Its faults: outlines that are not closed, and pieces that are missing.
    pub fn complaints(&self) -> Vec<String> {
        let area =
            |p: &Traced| p.cut.clone().or_else(|| p.outline()).map_or(0.0, |path| 0.5 * path.double_area().abs());
        let whole = self.lost + self.pieces.iter().map(area).sum::<f64>();
        let mut complaints = self.faults.clone();
        if self.lost > MOST_LOST * whole {
            let share = 100.0 * self.lost / whole;
            complaints.push(format!("{share:.0} % of what the drawing's closed lines go round was left out"));
        }
        complaints
    }
}

/// List of omissions, as the end of a message that no piece was found.
pub(crate) fn besides(left_out: &[String]) -> String {
    left_out.iter().map(|sentence| format!("; {sentence}")).collect()
}

/// A piece as traced.
#[derive(Clone, Debug, Default)]
pub struct Traced {
    /// As the format names it.
    pub name: String,
    /// The sewing line, walked round once. Edges that have names keep them.
    pub sew: Vec<(Option<String>, Path)>,
    /// The cut line.
    pub cut: Option<Path>,
    /// Its holes.
    pub holes: Vec<Hole>,
    /// Lines inside.
    pub lines: Vec<InnerLine>,
    /// Points inside: drill holes.
    pub points: Vec<Vec2>,
    /// Buttons and buttonholes.
    pub fasteners: Vec<Fastener>,
    /// Tail and head of the grain line.
    pub grain: Option<[Vec2; 2]>,
    /// Notches.
    pub notches: Vec<ImportedNotch>,
    /// Pleats, each by the points of an edge where it is folded and where the fold is brought to.
    pub pleats: Vec<[Vec2; 2]>,
    /// The line in which a half is mirrored.
    pub mirror: Option<[Vec2; 2]>,
    /// Other lines on the fold: a quarter of a circle has two.
    pub more_folds: Vec<[Vec2; 2]>,
    /// How it is cut, if the drawing tells.
    pub cut_how: Option<CutKind>,
    /// Number of repetitions of that: a pair cut twice from folded cloth gives two of either hand.
    pub copies: usize,
    /// Whether the drawing says that those which are cut are alike, not left and right.
    pub alike: bool,
    /// Number of times it is cut on the fold, if that is written on it. The line is [`Self::mirror`], if it is drawn.
    pub on_fold: Option<usize>,
    /// Numbers of the remarks that were read of it: how it is cut, its title, its number.
    pub said_by: Vec<usize>,
    /// Its number among the pieces of the pattern, as it is written on it.
    pub number: Option<String>,
    /// The drawn one of a pair, or the drawn half, if the drawing tells.
    pub drawn: Option<Side>,
    /// Its material.
    pub material: Option<Material>,
    /// Endings of edges' allowances at corners, by the edges' names, if the file tells them.
    pub corners: Vec<(String, Corner)>,
    /// Number of its size, where sizes are drawn over one another: pieces of two sizes are never sewn to each other.
    pub size: Option<usize>,
    /// The name of that size.
    pub size_name: Option<String>,
}

impl Traced {
    /// The line walked round once: the sewing line, or the cut line where that is all there is.
    fn outline(&self) -> Option<Path> {
        let sewn = self.sew.iter().map(|e| e.1.clone()).reduce(|whole, next| whole.joined(&next));
        sewn.or_else(|| self.cut.clone())
    }

    /// The piece with its upper left corner at (0, 0): where on a sheet it lay is nobody's business.
    fn at_origin(&self) -> Self {
        let Some(shift) = self.outline().map(|outline| -pairs::low_corner(&outline)) else { return self.clone() };
        let path = |p: &Path| p.mapped(nalgebra::Matrix2::identity(), shift);
        let named = |lines: &[(Option<String>, Path)]| lines.iter().map(|(n, p)| (n.clone(), path(p))).collect();
        Self {
            sew: named(&self.sew),
            cut: self.cut.as_ref().map(path),
            holes: self.holes.iter().map(|h| h.moved(path)).collect(),
            lines: self.lines.iter().map(|l| InnerLine { path: path(&l.path), ..l.clone() }).collect(),
            points: self.points.iter().map(|p| p + shift).collect(),
            fasteners: self.fasteners.iter().map(|f| Fastener { at: f.at + shift, ..*f }).collect(),
            grain: self.grain.map(|g| g.map(|p| p + shift)),
            notches: self.notches.iter().map(|n| ImportedNotch { at: n.at + shift, told: n.told.clone() }).collect(),
            pleats: self.pleats.iter().map(|ends| ends.map(|p| p + shift)).collect(),
            mirror: self.mirror.map(|m| m.map(|p| p + shift)),
            more_folds: self.more_folds.iter().map(|m| m.map(|p| p + shift)).collect(),
            ..self.clone()
        }
    }
}
