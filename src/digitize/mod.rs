//! From lines on somebody else's pattern to a garment file.
//!
//! A reader of a format gives [`Traced`] pieces: sewing and cut lines, grain, notches and inner lines, in metres, y
//! down. [`garment_file`] makes of them a `GarmentFile` in which only the seams are missing: outlines split into named
//! edges at corners and notches, allowances measured, and [`Suggestion`]s of what may be sewn to what.

mod chain;
mod contour;
mod contours;
mod darts;
mod edges;
mod file;
mod fish_eyes;
mod folds;
mod follow;
mod frames;
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
mod suggest;
mod trimmed;

pub(crate) use chain::nearly_meet;
pub use chain::{Bridged, Gaping, bridged, chained, gaping};
pub use contours::pieces;
pub use file::{Digitized, garment_file};
pub(crate) use follow::follows;
pub use holes::{Hole, holes};
pub(crate) use notches::DOUBLE;
pub(crate) use sizes::{size_of, sizes};
pub use suggest::{Suggestion, sewn};
pub(crate) use trimmed::parts_within;

use crate::geometry::{Path, Vec2};
use crate::pattern::{Corner, Cut, LineKind, NotchKind, Side};

/// A line of a foreign file.
#[derive(Clone, Debug)]
pub struct Stroke {
    /// Its course.
    pub path: Path,
    /// What it is, as far as the format says.
    pub role: Role,
    /// Its name, if it has one.
    pub name: Option<String>,
    /// The name of the group it is in, if that has one and is a piece.
    pub group: Option<String>,
    /// The name of the group or layer it is in, be that a piece or what holds several.
    pub layer: Option<String>,
    /// What it does if it is a line inside a piece, where the file says so.
    pub kind: Option<LineKind>,
    /// What is told of it if it is a notch, as toile itself writes it.
    pub notch: Option<ToldNotch>,
    /// The size of the pattern that it is of, where a layer says that.
    pub size: Option<String>,
    /// Whether it bounds what is filled, and no pen runs along it.
    pub filled: bool,
}

/// A notch, or one of the marks of a double one.
#[derive(Clone, Debug, PartialEq)]
pub struct Notch {
    /// Near the outline: on the cut line or the sewing line.
    pub at: Vec2,
    /// What is told of it; it is on the sewing line then.
    pub told: Option<ToldNotch>,
}

/// What toile's own drawings tell of a notch, so that none are taken for a double one that lie side by side.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ToldNotch {
    /// What it belongs to.
    pub kind: NotchKind,
    /// Name of the edge that it is on, which tells at a corner.
    pub edge: String,
}

/// What a piece is cut from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Material {
    /// As the drawing calls it.
    pub name: String,
    /// The library's fabric that it is, if the drawing says so.
    pub cloth: Option<String>,
}

/// A line inside a piece.
#[derive(Clone, Debug)]
pub struct Inner {
    /// Its name, if it has one.
    pub name: Option<String>,
    /// Its course.
    pub path: Path,
    /// What it does, where the file says so.
    pub kind: Option<LineKind>,
}

/// Words of a foreign file.
#[derive(Clone, Debug)]
pub struct Remark {
    /// Where they stand.
    pub at: Vec2,
    /// What they say.
    pub text: String,
}

/// What a line is.
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
    /// Where a pleat is folded: a line that begins at the edge.
    PleatFold,
    /// Where the fold that was drawn before it is brought to.
    PleatPlace,
    /// A ring round a point that is marked through all layers.
    Drill,
}

/// What a drawing holds.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// What it is called, if it says so.
    pub title: Option<String>,
    /// Its pieces.
    pub pieces: Vec<Traced>,
    /// What it shows besides that was not read: a sentence for each kind.
    pub left_out: Vec<String>,
    /// What was taken for something that it does not say.
    pub notes: Vec<String>,
    /// What is wrong with it, so that pieces are missing: a sentence for each.
    pub faults: Vec<String>,
    /// What the closed lines go round that were left out though they may be pieces, square metres.
    pub lost: f64,
    /// The sizes that it holds, in its order; none where it is drawn in one.
    pub sizes: Vec<String>,
}

/// Of what a drawing shows no more than this share may be lost.
const MOST_LOST: f64 = 0.1;

impl Drawing {
    /// What is wrong with it: outlines that are not closed, and pieces that are missing.
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

/// What was left out, as the end of a message that no piece was found.
pub(crate) fn besides(left_out: &[String]) -> String {
    left_out.iter().map(|sentence| format!("; {sentence}")).collect()
}

/// A piece as traced.
#[derive(Clone, Debug, Default)]
pub struct Traced {
    /// As the format names it.
    pub name: String,
    /// The sewing line, walked round once; edges that have names keep them.
    pub sew: Vec<(Option<String>, Path)>,
    /// The cut line.
    pub cut: Option<Path>,
    /// What is cut out.
    pub holes: Vec<Hole>,
    /// Lines inside.
    pub lines: Vec<Inner>,
    /// Points inside: drill holes.
    pub points: Vec<Vec2>,
    /// Tail and head of the grain line.
    pub grain: Option<[Vec2; 2]>,
    /// Notches.
    pub notches: Vec<Notch>,
    /// Pleats, each by the points of an edge where it is folded and where the fold is brought to.
    pub pleats: Vec<[Vec2; 2]>,
    /// The line in which a half is mirrored.
    pub mirror: Option<[Vec2; 2]>,
    /// Other lines on the fold: a quarter of a circle has two.
    pub more_folds: Vec<[Vec2; 2]>,
    /// How it is cut, if said.
    pub cut_how: Option<Cut>,
    /// How many times over that is done: a pair cut from folded cloth twice is two of either hand.
    pub copies: usize,
    /// How often it is cut on the fold, if that is written on it; the line is [`Self::mirror`], if it is drawn.
    pub on_fold: Option<usize>,
    /// Which of the drawing's remarks says how it is cut.
    pub said_by: Option<usize>,
    /// Which of a pair, or which half, is drawn, if said.
    pub drawn: Option<Side>,
    /// What it is cut from.
    pub material: Option<Material>,
    /// How the allowances of edges end at corners, by their names, where that is told.
    pub corners: Vec<(String, Corner)>,
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
            lines: self.lines.iter().map(|l| Inner { path: path(&l.path), ..l.clone() }).collect(),
            points: self.points.iter().map(|p| p + shift).collect(),
            grain: self.grain.map(|g| g.map(|p| p + shift)),
            notches: self.notches.iter().map(|n| Notch { at: n.at + shift, told: n.told.clone() }).collect(),
            pleats: self.pleats.iter().map(|ends| ends.map(|p| p + shift)).collect(),
            mirror: self.mirror.map(|m| m.map(|p| p + shift)),
            more_folds: self.more_folds.iter().map(|m| m.map(|p| p + shift)).collect(),
            ..self.clone()
        }
    }
}
