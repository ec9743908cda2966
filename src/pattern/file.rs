//! A garment file as it was written: every statement kept, also those no stage uses, each with its place in the text.

use super::alteration_file::{AlterationFile, SizeFile};
use super::diagnostic::Located;
use super::value::{Corner, CutKind, Quantity, Side, Unit, Value};
use crate::input::LengthUnit;

/// The whole file. Absent statements are `None` or empty, so that writing adds nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct GarmentFile {
    /// `garment: 1`, the version of the format.
    pub version: Located<u32>,
    /// Name for people.
    pub name: Option<Located<String>>,
    /// Free statements about the file: `source`, `license`, `note`, `measurements`.
    pub about: Vec<(Located<String>, Located<Value>)>,
    /// Unit of bare numbers. Millimetres if not given.
    pub units: Option<Located<Unit>>,
    /// Mannequin.
    pub body: Option<Located<String>>,
    /// Measures of the wearer by name, where the mannequin stands for the rest.
    pub body_measures: Vec<(Located<String>, Located<Quantity>)>,
    /// Unit of the body's `.obj` file.
    pub body_units: Option<Located<LengthUnit>>,
    /// Default seam allowance.
    pub allowance: Option<Located<Quantity>>,
    /// Fabrics by name: a preset's name or a mapping.
    pub fabrics: Vec<(Located<String>, Located<Value>)>,
    /// Pieces in order.
    pub pieces: Vec<PieceFile>,
    /// Seams in order.
    pub seams: Vec<SeamFile>,
    /// Closures.
    pub closures: Vec<ClosureFile>,
    /// Edges (or globs) that stay unsewn.
    pub free: Vec<Located<String>>,
    /// Regression bounds.
    pub tests: Vec<Located<TestEntry>>,
    /// Alterations, carried out in order when the garment is read.
    pub alter: Vec<Located<AlterationFile>>,
    /// Sizes, each with its alterations.
    pub sizes: Vec<SizeFile>,
}

impl GarmentFile {
    /// Unit of bare numbers.
    pub fn unit(&self) -> Unit {
        self.units.as_ref().map_or(Unit::Millimetre, |u| u.value)
    }
}

/// A piece as drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceFile {
    /// Its key.
    pub name: Located<String>,
    /// Another piece whose statements count where this one makes none.
    pub like: Option<Located<String>>,
    /// Key in `fabrics`.
    pub fabric: Option<Located<String>>,
    /// How the piece is cut.
    pub cut: Option<Located<CutKind>>,
    /// Drawn side: the drawn one of a pair, or the drawn half of a folded piece.
    pub drawn: Option<Located<Side>>,
    /// Layer, positive outward.
    pub layer: Option<Located<i32>>,
    /// Seam allowance of all edges, or edge by edge.
    pub allowance: Option<AllowanceFile>,
    /// Tail and head of the grain arrow.
    pub grain: Option<Located<[[f64; 2]; 2]>>,
    /// Start position.
    pub place: Option<Located<PlaceFile>>,
    /// The outline.
    pub outline: Option<OutlineFile>,
    /// Notches by edge.
    pub notches: Vec<(Located<String>, Vec<Located<NotchFile>>)>,
    /// Darts.
    pub darts: Vec<DartFile>,
    /// Pleats.
    pub pleats: Vec<PleatFile>,
    /// Holes: name and closed path.
    pub holes: Vec<(Located<String>, Located<String>)>,
    /// Internal lines.
    pub lines: Vec<LineFile>,
    /// A remark.
    pub note: Option<Located<String>>,
}

impl PieceFile {
    /// A piece that is as another in everything.
    pub fn like(name: Located<String>, other: Located<String>) -> Self {
        Self { like: Some(other), ..Self::named(name) }
    }

    /// A piece of which nothing but its name is said.
    pub fn named(name: Located<String>) -> Self {
        Self {
            name,
            like: None,
            fabric: None,
            cut: None,
            drawn: None,
            layer: None,
            allowance: None,
            grain: None,
            place: None,
            outline: None,
            notches: Vec::new(),
            darts: Vec::new(),
            pleats: Vec::new(),
            holes: Vec::new(),
            lines: Vec::new(),
            note: None,
        }
    }
}

/// Seam allowance of a piece.
#[derive(Clone, Debug, PartialEq)]
pub enum AllowanceFile {
    /// One for all edges.
    All(Located<AllowanceWidth>),
    /// By edge.
    Edges(Vec<(Located<String>, Located<AllowanceWidth>)>),
}

/// A width of seam allowance: `10`, `30 folded`, `1.5 cm squared`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AllowanceWidth {
    /// From the sewing line to the cut line.
    pub width: Quantity,
    /// Ending at the edge's corners, if given.
    pub corner: Option<Corner>,
}

/// An outline: a start point and named edges with their path commands.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineFile {
    /// First point, file units.
    pub start: Located<[f64; 2]>,
    /// Edges in order: name, path commands.
    pub edges: Vec<(Located<String>, Located<String>)>,
}

/// Start position.
#[derive(Clone, Debug, PartialEq)]
pub enum PlaceFile {
    /// Words naming a body part.
    Words(String),
    /// Position (file units) and turn (degrees).
    At {
        /// Position.
        at: [f64; 3],
        /// Turn about x, y, z.
        turn: Option<[f64; 3]>,
    },
}

/// A notch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotchFile {
    /// Distance from the edge's start.
    pub at: Quantity,
    /// `60 double`.
    pub double: bool,
}

/// A dart: on an edge, or inside the piece.
#[derive(Clone, Debug, PartialEq)]
pub struct DartFile {
    /// Its own name. `dart`, `dart2`, … if not given.
    pub name: Option<Located<String>>,
    /// Width taken out.
    pub intake: Located<Quantity>,
    /// Place and length.
    pub shape: DartShape,
}

/// The two shapes of dart.
#[derive(Clone, Debug, PartialEq)]
pub enum DartShape {
    /// A wedge from an edge.
    Edge {
        /// The edge it opens.
        edge: Located<String>,
        /// Middle of its mouth, from the edge's start.
        at: Located<Quantity>,
        /// Length from the middle of the mouth, square to it.
        length: Option<Located<Quantity>>,
        /// Or the tip's position.
        tip: Option<Located<[f64; 2]>>,
    },
    /// A lozenge (fish-eye) inside the piece.
    FishEye {
        /// Middle of its widest line.
        at: Located<[f64; 2]>,
        /// Length above it.
        up: Located<Quantity>,
        /// Length below it.
        down: Located<Quantity>,
    },
}

/// Folding of a pleat.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PleatKind {
    /// One fold.
    Knife,
    /// Two folds that point away from each other on the right side.
    Box,
    /// Two folds that meet on the right side.
    Inverted,
}

/// Pleats along an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct PleatFile {
    /// The edge.
    pub edge: Located<String>,
    /// Start of each pleat, from the edge's start.
    pub at: Vec<Located<Quantity>>,
    /// Width of one under-layer.
    pub depth: Located<Quantity>,
    /// Shape. Knife if not given.
    pub kind: Option<Located<PleatKind>>,
    /// The edge next to `edge` that knife pleats point to.
    pub toward: Option<Located<String>>,
    /// Length stitched down from the edge.
    pub sewn: Option<Located<Quantity>>,
}

/// A line inside a piece.
#[derive(Clone, Debug, PartialEq)]
pub struct LineFile {
    /// Its key.
    pub name: Located<String>,
    /// A whole path, with its own `M`.
    pub path: Located<String>,
    /// Fold angle, degrees.
    pub fold: Option<Located<f64>>,
    /// `stitch`, `place`, `drill`, `elastic`, …
    pub kind: Option<Located<String>>,
    /// Elastic: length drawn in over length cut.
    pub ratio: Option<Located<f64>>,
}

/// A seam.
#[derive(Clone, Debug, PartialEq)]
pub struct SeamFile {
    /// Its key.
    pub name: Located<String>,
    /// First chain.
    pub sew: Vec<Located<String>>,
    /// Second chain. `[mirror]` means the other half.
    pub to: Vec<Located<String>>,
    /// Length the second chain has in excess.
    pub ease: Option<Located<Quantity>>,
    /// Ratio length(sew) / length(to), where the first chain is gathered.
    pub gather: Option<Located<f64>>,
    /// Ratio length(sew) / length(to), where the second chain is stretched.
    pub stretch: Option<Located<f64>>,
    /// Difference that passes.
    pub tolerance: Option<Located<Quantity>>,
    /// Stretches that are open.
    pub open: Vec<OpenFile>,
    /// Kind of their closure.
    pub closure: Option<Located<String>>,
    /// `face: same`, wrong side on right side.
    pub face_same: Option<Located<bool>>,
    /// `match: notches`.
    pub match_notches: Option<Located<bool>>,
    /// Sewing order.
    pub stage: Option<Located<i32>>,
    /// Layers that meet.
    pub layers: Option<Located<[i32; 2]>>,
    /// Seam allowance.
    pub allowance: Option<Located<Quantity>>,
    /// A remark.
    pub note: Option<Located<String>>,
}

impl SeamFile {
    /// A seam of which nothing is said but what it sews to what.
    pub fn new(name: Located<String>, sew: Vec<Located<String>>, to: Vec<Located<String>>) -> Self {
        Self {
            name,
            sew,
            to,
            ease: None,
            gather: None,
            stretch: None,
            tolerance: None,
            open: Vec::new(),
            closure: None,
            face_same: None,
            match_notches: None,
            stage: None,
            layers: None,
            allowance: None,
            note: None,
        }
    }

    /// Whether it is written `face: same`.
    pub(super) fn is_face_same(&self) -> bool {
        self.face_same.as_ref().is_some_and(|f| f.value)
    }
}

/// An opening in a seam.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenFile {
    /// The edge at whose end it starts.
    pub from: Located<String>,
    /// Its length.
    pub length: Located<Quantity>,
    /// Kind of its closure. If absent, the seam's `closure` counts.
    pub closure: Option<Located<String>>,
}

/// A button, hook, zip, …
#[derive(Clone, Debug, PartialEq)]
pub struct ClosureFile {
    /// Its kind.
    pub kind: Located<String>,
    /// The piece (or edge) that carries it.
    pub on: Option<Located<String>>,
    /// Points on it.
    pub at: Vec<Located<[f64; 2]>>,
    /// The piece it meets.
    pub meets: Option<Located<String>>,
    /// The points it meets there. The mirrored or same points if not given.
    pub meets_at: Vec<Located<[f64; 2]>>,
    /// Distance of repeated points along the grain.
    pub pitch: Option<Located<Quantity>>,
    /// Number of repeated points.
    pub count: Option<Located<usize>>,
    /// Everything else said of it (size, colour, order number).
    pub hardware: Vec<(Located<String>, Located<Value>)>,
}

/// A regression bound, and the fabric it holds in.
#[derive(Clone, Debug, PartialEq)]
pub struct TestEntry {
    /// The bound.
    pub test: TestFile,
    /// `{…, fabric: cotton_poplin}`: only when the garment is made in this fabric.
    pub fabric: Option<Located<String>>,
}

/// A regression bound.
#[derive(Clone, Debug, PartialEq)]
pub enum TestFile {
    /// `{seam: all, length: 1 mm}`.
    Seam(Located<String>, Located<Quantity>),
    /// `{gap: side, below: 2 mm}`.
    Gap(Located<String>, Located<Quantity>),
    /// `{closure: button, below: 5 mm}`.
    Closure(Located<String>, Located<Quantity>),
    /// `{flatten: skirt, area: 0.5 %, boundary: 1 mm}`.
    Flatten(Located<String>, Option<Located<Quantity>>, Option<Located<Quantity>>),
    /// `{drape: skirt, area: 0.5 %, boundary: 0.5 %}`.
    Drape(Located<String>, Option<Located<Quantity>>, Option<Located<Quantity>>),
    /// `{crossings: 0}`.
    Crossings(usize),
    /// `{openings: 4}`: rims of the sewn garment, checked on reading.
    Openings(usize),
    /// `{worn: true}`.
    Worn,
    /// `{ease: bust, from: 40 mm, to: 90 mm}`.
    Ease(Located<String>, Option<Located<Quantity>>, Option<Located<Quantity>>),
    /// `{pressure: waist, below: 2.3 kPa}`: the number of kPa.
    Pressure(Located<String>, Located<f64>),
    /// `{hem: level within 10 mm}`.
    HemLevel(Located<Quantity>),
}
