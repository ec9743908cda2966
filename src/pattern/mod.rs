//! The checked garment: every piece that is cut and every seam, nothing left implicit.
//!
//! A garment *file* says `cut: pair`, darts, pleats and `to: mirror`. A [`Garment`] has the pieces and seams that
//! follow from them, so that no later stage knows those words. All lengths are metres.
//!
//! # Names
//! * `cut: pair` gives the pieces `front.L` and `front.R`. The edges of both are `neck`, `side`, …
//! * `cut: fold center` gives one piece `front` without the edge `center`. All other edges are there twice, `side.L`
//!   and `side.R`. In a seam, `front.side` is matched with sided partners side by side (`side.L`, `side.R`). Sewn to a
//!   piece that is there once, an edge that ends on the fold is taken whole, across both halves.
//! * `cut: 3` gives `tab.1`, `tab.2`, `tab.3`.
//! * A side may stand after the piece or after the edge: `front.L.side` and `front.side.L` are the same.
//! * A dart `bust` on the edge `side` leaves `side`, `bust.a`, `bust.b`, `side.2`. In a seam `side` means both parts.
//!   Its seam is `front.bust.L`. A fish-eye dart `waist` is a hole with the edges `waist.upper_a`, `waist.lower_a`,
//!   `waist.lower_b`, `waist.upper_b` and the seams `front.waist.upper.L`, `front.waist.lower.L`.
//! * Ranges (`cap@20%..80%`), notches and pleats are measured along the edge as drawn, from its start in the drawing,
//!   also on the mirrored piece.

mod allowance;
mod along;
mod alteration_file;
mod bound;
mod chain;
mod closure;
mod cover;
mod crossing;
mod cut;
mod dart;
mod diagnostic;
mod draft;
mod drawing;
mod edge_name;
mod expand;
mod fasten;
mod file;
mod free;
mod inherit;
mod layers;
mod line;
mod measure;
mod notch;
mod notch_kind;
mod outfit;
mod outline;
mod place_word;
mod pleat;
mod problem;
mod reference;
mod region;
mod rim;
mod seam;
mod select;
mod spelling;
mod tube;
mod value;
mod walk;
mod want_file;

pub use along::{Along, along};
pub use alteration_file::{AlterationFile, SizeFile, StationFile};
pub(crate) use bound::known_girth;
pub(crate) use crossing::loop_crossing;
pub(crate) use dart::{FISH_EYE_EDGES, dart_legs};
pub use diagnostic::{Diagnostic, Findings, Located, Severity, Spot};
pub use drawing::{Allowance, Dart, DrawnEdge, DrawnFold, DrawnNotch, DrawnPiece, drawings};
pub(crate) use edge_name::edge_name;
pub use edge_name::{written_edge, written_names};
pub use expand::{DEFAULT_CLOTH, expand, fabrics};
pub use fasten::{Bridge, Fastening, RimSpot, Step, fastenings, patches, worn_rims};
pub use file::{
    AllowanceFile, AllowanceWidth, ClosureFile, DartFile, DartShape, GarmentFile, LineFile, NotchFile, OpenFile,
    OutlineFile, PieceFile, PlaceFile, PleatFile, PleatKind, SeamFile, TestEntry, TestFile,
};
pub use inherit::whole_pieces;
pub(crate) use inherit::{own_shape, unknown_piece};
pub use notch_kind::{DOUBLE_MARKS, NotchKind};
pub use outfit::{belongs_to, outfit};
pub use place_word::{PlaceMeaning, PlaceWord, TrunkLevel, place_words, words_of};
pub use problem::{ChainDoubt, Problem};
pub use reference::parse_quantity;
pub(crate) use reference::{LARGEST, Words};
pub(crate) use region::{Region, SLACK};
pub use rim::{Opening, openings};
pub(crate) use seam::DEFAULT_TOLERANCE;
pub(crate) use spelling::glob;
pub use value::{Corner, CutKind, Quantity, Side, Unit, Value};
pub use walk::{SeamWalk, walk};
pub use want_file::{KnobFile, WantFile, Wanted, WantsFile};

use std::ops::RangeInclusive;

/// Widest seam allowance, metres. A wider one is in another unit.
pub const WIDEST_ALLOWANCE: f64 = 0.2;
/// Length up to which an edge counts as having none, metres. It cannot be meshed.
pub const SHORTEST_EDGE: f64 = 2e-5;

use crate::geometry::{Path, Vec2, Vec3};

/// A garment ready to be meshed.
#[derive(Clone, Debug)]
pub struct Garment {
    /// Short name: the file's stem, `child_dress`.
    pub name: String,
    /// The file's `name:`, for people.
    pub title: String,
    /// Mannequin name or path of an OBJ, as in the file.
    pub body: Option<String>,
    /// Pieces as cut: `front.L` and `front.R` for a pair.
    pub pieces: Vec<Piece>,
    /// Seams in sewing order: the file's, then those of darts and pleats, mirrored ones written out.
    pub seams: Vec<Seam>,
    /// Fabrics by the name the pieces use.
    pub fabrics: Vec<FabricUse>,
    /// Buttons, hooks and the like.
    pub closures: Vec<Closure>,
    /// Names of the garments of an outfit, from the skin outwards. Empty for a single garment.
    pub worn: Vec<String>,
    /// The garment's own regression bounds.
    pub tests: Vec<Test>,
}

/// One piece of cloth.
#[derive(Clone, Debug)]
pub struct Piece {
    /// `front.L`.
    pub name: String,
    /// The drawn piece it comes from, `front`.
    pub drawn_as: String,
    /// Side of a piece of a pair.
    pub side: Option<Side>,
    /// Where the wearer's left half begins, of a piece cut on the fold.
    pub fold: Option<FoldAxis>,
    /// Name in [`Garment::fabrics`].
    pub fabric: String,
    /// 0 = its garment's shell, positive further out, negative nearer the body.
    pub layer: i32,
    /// Layers by which its garment's shell lies further out, because of garments that are worn under it.
    pub beneath: i32,
    /// Warp direction in the flat piece, unit length, tail to head.
    pub warp: Vec2,
    /// `loops[0]` is the outline, clockwise on screen (y down; [`Path::double_area`] sums to a positive number). The
    /// others are holes, running the other way. Every edge starts where the one before it ends.
    pub loops: Vec<Vec<Edge>>,
    /// Fold, elastic and other lines inside the piece.
    pub lines: Vec<Line>,
    /// Marks on edges.
    pub notches: Vec<Notch>,
    /// Start position. `None` means that it is worked out.
    pub place: Option<Place>,
}

impl Piece {
    /// Whether the file says at which position it starts.
    pub fn has_position(&self) -> bool {
        matches!(self.place, Some(Place::At { .. }))
    }

    /// Meanings of the words of its place. Its name means nothing.
    pub fn meanings(&self) -> Vec<PlaceMeaning> {
        match &self.place {
            Some(Place::Around { words }) => words.iter().map(|word| word.meaning()).collect(),
            _ => Vec::new(),
        }
    }

    /// Whether it and another piece are the two halves of a pair.
    pub fn is_twin(&self, other: &Self) -> bool {
        let sides = self.side.zip(other.side);
        self.drawn_as == other.drawn_as && sides.is_some_and(|(own, other)| own != other)
    }

    /// Its layer among those of all garments that are worn over one another.
    pub fn level(&self) -> i32 {
        self.layer.saturating_add(self.beneath)
    }
}

/// The line on which a piece is cut on the fold: the wearer's left half lies on one side of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FoldAxis {
    /// A point of it, metres.
    pub on: Vec2,
    /// Unit direction across it, into the wearer's left half.
    pub left: Vec2,
}

impl FoldAxis {
    /// How far a point of the flat piece lies in the wearer's left half, metres; negative in the right one.
    pub fn left_of(&self, p: Vec2) -> f64 {
        (p - self.on).dot(&self.left)
    }
}

/// A named stretch of a piece's rim.
#[derive(Clone, Debug)]
pub struct Edge {
    /// `shoulder`. Unique in its piece. An edge that a dart cuts in two is `waist` and `waist.2`.
    pub name: String,
    /// Its course.
    pub path: Path,
    /// Whether it runs against the drawn edge, as on mirrored pieces. A file measures along the drawn edge.
    pub against: bool,
}

/// An edge of a piece: `piece.loops[ring][index]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct EdgeId {
    /// Index in [`Garment::pieces`].
    pub piece: usize,
    /// 0 = outline, else a hole.
    pub ring: usize,
    /// Index in the ring.
    pub index: usize,
}

/// A stretch of an edge, walked from `from` to `to` (metres from the edge's start; `from > to` walks against it).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The edge.
    pub edge: EdgeId,
    /// Start of the walk.
    pub from: f64,
    /// End of the walk.
    pub to: f64,
}

impl Span {
    /// Length walked.
    pub fn length(&self) -> f64 {
        (self.to - self.from).abs()
    }

    /// Its two ends, the one nearer to the edge's start first.
    pub fn sorted(&self) -> (f64, f64) {
        (self.from.min(self.to), self.from.max(self.to))
    }
}

/// Two chains of spans that are stitched together, start to start and end to end, in proportion to their lengths
/// between [`Seam::marks`].
#[derive(Clone, Debug)]
pub struct Seam {
    /// `side.L`.
    pub name: String,
    /// First chain (`sew`).
    pub a: Vec<Span>,
    /// Second chain (`to`).
    pub b: Vec<Span>,
    /// Matched positions (metres along `a`, metres along `b`), rising in both, first (0, 0) and last the two lengths.
    pub marks: Vec<(f64, f64)>,
    /// How unequal lengths are meant.
    pub give: Give,
    /// Sewing order: all seams of a stage close before the next stage starts.
    pub stage: i32,
    /// Origin of the seam.
    pub kind: SeamKind,
    /// Kind of closure of an opening of the seam that is worn shut (`zip`). A stretch that is worn open is not in `a`
    /// and `b`.
    pub closure: Option<String>,
}

impl Seam {
    /// Length of the first chain.
    pub fn length_a(&self) -> f64 {
        self.a.iter().map(Span::length).sum()
    }

    /// Length of the second chain.
    pub fn length_b(&self) -> f64 {
        self.b.iter().map(Span::length).sum()
    }

    /// Whether it joins layers that lie on each other: a pleat, or some of the garment's `pieces` of different layers.
    pub fn is_lapped(&self, pieces: &[Piece]) -> bool {
        let mut layers = self.a.iter().chain(&self.b).map(|s| pieces[s.edge.piece].layer);
        let first = layers.next();
        matches!(self.kind, SeamKind::Pleat(_)) || layers.any(|l| Some(l) != first)
    }
}

/// How a seam treats unequal lengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Give {
    /// Equal within the tolerance.
    Even,
    /// So many metres more on the `b` side.
    Ease(f64),
    /// The chain `a` is gathered: length(a) / length(b) > 1.
    Gather(f64),
    /// The chain `b` is stretched: length(a) / length(b) > 1.
    Stretch(f64),
}

/// Origin of a seam.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeamKind {
    /// Written in the file.
    Written,
    /// The legs of a dart.
    Dart,
    /// A pleat laid down and sewn.
    Pleat(PleatLayer),
}

/// The layers of a pleat that a seam holds together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PleatLayer {
    /// The top one on the middle one.
    Top,
    /// The middle one (first chain) on the bottom one (second chain).
    Under,
}

/// A line inside a piece, or across it from rim to rim.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its name.
    pub name: String,
    /// Its course.
    pub path: Path,
    /// Its kind.
    pub kind: LineKind,
}

/// Kinds of internal lines.
#[derive(Clone, Debug, PartialEq)]
pub enum LineKind {
    /// The cloth is creased to this angle (radians; 0 = flat, π = folded onto its own wrong side).
    Fold(f64),
    /// Drawn in to this share of its length.
    Elastic(f64),
    /// Marking, topstitching, drill hole, … : kept, not simulated.
    Mark(String),
}

impl LineKind {
    /// Angles of folds, degrees: at 180 the cloth lies on itself, and no farther can it go.
    const FOLDS: RangeInclusive<f64> = -180.0..=180.0;
    /// Allowed ratios of elastic to the line's length.
    const ELASTICS: RangeInclusive<f64> = 0.05..=1.0;

    /// A fold of this angle, if it is an allowed one.
    pub(crate) fn fold(degrees: f64) -> Option<Self> {
        Self::FOLDS.contains(&degrees).then(|| Self::Fold(degrees.to_radians()))
    }

    /// Elastic that leaves this share of the length, if there is one.
    pub(crate) fn elastic(ratio: f64) -> Option<Self> {
        Self::ELASTICS.contains(&ratio).then_some(Self::Elastic(ratio))
    }

    /// The angle of a fold in which the cloth hinges, radians. A fold of angle 0 is pressed flat again: there the cloth
    /// bends as everywhere.
    pub fn hinge(&self) -> Option<f64> {
        match *self {
            Self::Fold(angle) if angle != 0.0 => Some(angle),
            _ => None,
        }
    }
}

/// A notch on an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct Notch {
    /// The edge.
    pub edge: EdgeId,
    /// Metres from the edge's start.
    pub at: f64,
    /// Double notches mark the back.
    pub double: bool,
}

/// Start position of a piece.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// Bent round a body part: `torso front`, `left arm`, `right leg back`, `waist`, `neck`.
    Around {
        /// The words of the file.
        words: Vec<PlaceWord>,
    },
    /// A rigid position: the flat piece's origin goes to `at` (metres) after turning by `turn` (degrees about x, y, z,
    /// in this order about the fixed axes).
    At {
        /// Position.
        at: Vec3,
        /// Turn.
        turn: Vec3,
    },
}

/// A fabric as a garment names it.
#[derive(Clone, Debug)]
pub struct FabricUse {
    /// `shell`.
    pub name: String,
    /// Its description.
    pub spec: crate::fabric::FabricSpec,
}

impl FabricUse {
    /// The library's fabric that it is, unless it has values of its own or comes from a file.
    pub fn cloth(&self) -> Option<&str> {
        let base = self.spec.base.as_deref().filter(|_| self.spec.values.is_empty())?;
        crate::fabric::library().into_iter().find(|shipped| *shipped == base)
    }
}

/// A closure: simulated as tacks where `a` meets `b` when both are given, else kept only.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Closure {
    /// Its kind: button, hook, zip, …
    pub kind: String,
    /// The cut piece that carries it.
    pub on: Option<String>,
    /// The cut piece it meets.
    pub meets: Option<String>,
    /// Points that are worn together: (piece, flat position) twice.
    pub tacks: Vec<[(usize, Vec2); 2]>,
    /// Number of points in a row of points that follow each other.
    pub row: usize,
    /// For a closure without `meets` on one of a pair: its points and the same points of the other half. They are not
    /// tied.
    pub mirrored: Vec<[(usize, Vec2); 2]>,
}

/// An entry of the garment's own `tests`.
#[derive(Clone, Debug, PartialEq)]
pub struct Test {
    /// The bound.
    pub bound: Bound,
    /// The test holds only if the garment is made in this fabric. `None` means in any. The name is the file's: one of
    /// the garment's own fabrics, a shipped one or a file. In a [`Job`](crate::pipeline::Job) it is the name in
    /// reports.
    pub fabric: Option<String>,
    /// The garment of an outfit whose pieces, seams and openings it is about, as their names begin. `None` = all.
    pub of: Option<String>,
}

/// A regression bound of the garment's own `tests`.
#[derive(Clone, Debug, PartialEq)]
pub enum Bound {
    /// Largest difference of the two lengths of a seam (`None` = all), metres.
    SeamLength(Option<String>, f64),
    /// Largest gap of a seam before stitching, metres.
    Gap(Option<String>, f64),
    /// Largest gap at the points of closures of a kind (`None` = all) on the garment as it was left, metres.
    Closure(Option<String>, f64),
    /// Round trip of a piece: area (fraction), boundary (metres).
    Flatten {
        /// Drawn or cut piece. `None` = all.
        piece: Option<String>,
        /// Fraction.
        area: Option<f64>,
        /// Metres.
        boundary: Option<f64>,
    },
    /// Sewn and draped piece: area and boundary as fractions.
    Drape {
        /// Drawn or cut piece. `None` = all.
        piece: Option<String>,
        /// Fraction.
        area: Option<f64>,
        /// Fraction.
        boundary: Option<f64>,
    },
    /// Largest number of crossings, cloth with body and cloth with cloth.
    Crossings(usize),
    /// Every opening worn.
    Worn,
    /// Ease of the draped garment at a girth of the body.
    Ease {
        /// One of [`GIRTHS`], with or without its side.
        girth: String,
        /// Least ease, metres.
        from: Option<f64>,
        /// Largest ease, metres.
        to: Option<f64>,
    },
    /// Largest pressure on the skin at a girth of the body, kPa.
    Pressure(String, f64),
    /// Largest height of a hem's highest point above its lowest, metres.
    HemLevel(f64),
}

/// Girths of a body at which garments are measured. Those from the thigh on are of limbs and have a side (`left
/// thigh`).
pub const GIRTHS: [&str; 12] =
    ["neck", "bust", "underbust", "waist", "high hip", "hip", "thigh", "knee", "calf", "biceps", "elbow", "wrist"];

/// How many of [`GIRTHS`] are of the trunk.
const OF_TRUNK: usize = 6;

/// Whether `wanted`, with or without a side, means the girth called `name`: `thigh` means `left thigh` and `right
/// thigh`.
pub fn is_girth(wanted: &str, name: &str) -> bool {
    wanted == name || SIDES.iter().any(|side| name.strip_prefix(side) == Some(wanted))
}

/// Words before the girths of limbs.
const SIDES: [&str; 2] = ["left ", "right "];
