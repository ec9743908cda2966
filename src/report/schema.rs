//! The report as it is written: keys and units of `report.json`.

use serde::{Deserialize, Serialize};

use super::fit_report::Fit;
use super::form::FormReport;

/// A whole report. Values of stages that did not run are `null`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// Version of this program.
    pub toile: String,
    /// The garment's short name.
    pub garment: String,
    /// The mannequin's name.
    pub mannequin: String,
    /// The fabric's name. Several are joined with ` + `.
    pub fabric: String,
    /// Mesh spacing, mm.
    pub spacing: f64,
    /// Everything that is wrong, in words: cloth that is not at rest or tight, bounds that are broken.
    #[serde(default)]
    pub problems: Vec<String>,
    /// One per piece as cut.
    pub pieces: Vec<PieceReport>,
    /// All pieces together, named `total`. `stretched` pieces included.
    pub total: PieceReport,
    /// One per seam.
    pub seams: Vec<SeamReport>,
    /// One per closure. A zip in a seam is that seam.
    #[serde(default)]
    pub closures: Vec<ClosureReport>,
    /// Numbers of crossings.
    pub contact: ContactReport,
    /// The crossings by pieces, the most frequent first. Empty in a good result.
    #[serde(default)]
    pub crossings: Vec<Crossing>,
    /// One per opening.
    pub worn: Vec<Worn>,
    /// Draped cloth that lies folded on itself, three deep, without a fold in the pattern. The largest place first.
    #[serde(default)]
    pub bunched: Vec<Bunched>,
    /// How the draped garment fits. `null` before draping.
    #[serde(default)]
    pub fit: Option<Fit>,
    /// The earlier result that this one went on from. `null` for a garment made from nothing.
    #[serde(default)]
    pub from: Option<ContinuedFrom>,
    /// The changed form that the garment was laid flat from. Absent for any other garment.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub form: Option<FormReport>,
    /// One per stage that ran.
    pub stages: Vec<Stage>,
}

/// An earlier result, and what became of it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContinuedFrom {
    /// Its folder.
    pub folder: String,
    /// Whether the garment could not be carried over, and was sewn from nothing after all.
    pub anew: bool,
    /// Pieces that it did not have.
    pub new: Vec<String>,
    /// How far the particles of its pieces have moved since, in the mean, mm. An edge that has been redrawn counts from
    /// where the earlier edge was.
    pub moved_mean: f64,
    /// The same of the particle that has moved furthest, mm.
    pub moved_max: f64,
}

/// Cloth that lies folded on itself.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bunched {
    /// Mean height, mm.
    pub height: f64,
    /// The part of the body there, as in [`Worn::body_part`].
    pub body_part: Option<String>,
    /// `front`, `back`, `left` or `right` of that part's axis.
    pub side: Option<String>,
    /// Flat area of the cloth that lies so, all layers counted, mm².
    pub area: f64,
    /// The pieces that it is of.
    pub pieces: Vec<String>,
}

impl std::fmt::Display for Bunched {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { height, body_part, side, area, pieces } = self;
        let (cm2, pieces) = (area / 100.0, pieces.join(", "));
        write!(f, "bunched: {cm2:.0} cm² of {pieces} lie folded on themselves at a height of {height:.0} mm")?;
        let part = body_part.as_ref().zip(side.as_ref());
        part.map_or(Ok(()), |(part, side)| write!(f, ", at the {side} of the {part}"))
    }
}

/// Figures of one piece.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PieceReport {
    /// As in the garment.
    pub name: String,
    /// Number of particles.
    pub particles: usize,
    /// Number of triangles.
    pub triangles: usize,
    /// Smallest angle of a triangle of the flat mesh, degrees.
    pub smallest_angle: f64,
    /// Set where the piece is narrower than the spacing, and was meshed finer.
    #[serde(default)]
    pub narrow: Option<NarrowReport>,
    /// Areas (`area_flat`, …, mm²) and lengths of the rim (`boundary_flat`, …, mm).
    #[serde(flatten)]
    pub sizes: PieceSizes,
    /// |area after − area before| / area before, without the triangles on the rim of a seam that joins lengths more
    /// than 5 % apart.
    pub area_error: Quartet,
    /// The same with the length of the rim. Between the two lengths a seam joins, any length is right.
    pub boundary_error: Quartet,
    /// Area error of all triangles.
    pub area_error_raw: Quartet,
    /// Boundary error against the drawn lengths alone.
    pub boundary_error_raw: Quartet,
    /// |length / flat length − 1| of the mesh edges within 10° of warp or weft, fractions.
    pub strain: Spread,
    /// Extension of these edges, 99th percentile, a fraction. Compressed edges, as in gathers, count as 0.
    #[serde(default)]
    pub drawn_out: f64,
    /// Change of the angle between warp and weft over all triangles, degrees.
    pub shear: Spread,
    /// Largest |length / flat length − 1| of any mesh edge, bias ones too.
    pub largest_edge_error: f64,
    /// Largest distance between the drawn outline and the flattened one laid onto it, mm.
    #[serde(default)]
    pub outline_distance: Option<f64>,
    /// Crossings of the flattened rim: 0 unless the flat piece lies on itself.
    #[serde(default)]
    pub overlaps: Option<usize>,
    /// Set where the piece had to stretch.
    pub stretched: Option<Stretched>,
    /// The piece's edges. None in `total`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub edges: Vec<PieceEdge>,
}

/// An edge of a piece in the mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PieceEdge {
    /// As in the garment.
    pub name: String,
    /// The points along it, from its start to its end: numbers of `vt` lines in `garment.obj`, counted from 1.
    pub points: Vec<usize>,
}

/// Measures of a piece narrower than the spacing, which has one row of cells across.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NarrowReport {
    /// Its width, mm.
    pub width: f64,
    /// Length of its springs along, mm.
    pub along: f64,
}

/// Sizes of a piece after every stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PieceSizes {
    /// As meshed, mm².
    pub area_flat: f64,
    /// Sewn, mm².
    pub area_sewn: Option<f64>,
    /// Draped, mm².
    pub area_draped: Option<f64>,
    /// Flattened, mm².
    pub area_flattened: Option<f64>,
    /// As meshed, mm.
    pub boundary_flat: f64,
    /// Sewn, mm.
    pub boundary_sewn: Option<f64>,
    /// Draped, mm.
    pub boundary_draped: Option<f64>,
    /// Flattened, mm.
    pub boundary_flattened: Option<f64>,
}

/// An error of each way, as fractions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Quartet {
    /// Sewn against flat.
    pub sew: Option<f64>,
    /// Draped against flat.
    pub drape: Option<f64>,
    /// Flattened against draped.
    pub flatten: Option<f64>,
    /// Flattened against flat.
    pub round_trip: Option<f64>,
}

/// Distribution of a quantity over a piece.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// 95 % are no larger.
    pub p95: f64,
    /// 99 % are no larger.
    pub p99: f64,
    /// Largest.
    pub max: f64,
}

/// That a piece had to stretch, and why.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stretched {
    /// By how much, a fraction.
    pub by: f64,
    /// `seam NAME` or `body`.
    pub why: String,
}

/// One seam.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SeamReport {
    /// The seam's name.
    pub name: String,
    /// Flat length of its first side, mm.
    pub length_a: f64,
    /// Flat length of its second side, mm.
    pub length_b: f64,
    /// Mean distance of partners when the seam had been closed, before they were made one, mm.
    pub gap_mean: f64,
    /// Largest such distance, mm.
    pub gap_max: f64,
}

/// One closure, on the garment as it was left.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ClosureReport {
    /// Kind: button, hook, zip, …
    pub kind: String,
    /// The piece that carries it, `null` where the file does not say.
    pub on: Option<String>,
    /// The piece it meets, given or, as `note` says, the other half of a pair.
    pub meets: Option<String>,
    /// Number of its points.
    pub points: usize,
    /// Mean distance of its tied points, mm. `null` if nothing could be measured.
    pub gap_mean: Option<f64>,
    /// Largest such distance, mm.
    pub gap_max: Option<f64>,
    /// Between neighbouring points, how far the line through them on one side is from that on the other at most, mm.
    pub gape: Option<f64>,
    /// Whether all its points came together, so that its stretch of rim is no opening.
    pub closed: bool,
    /// Note on these figures.
    pub note: Option<String>,
    /// Place where the layer of its lap that belongs inside lies outside. `null` if the order is kept.
    #[serde(default)]
    pub turned: Option<Turned>,
}

/// A lap of which a part is in the wrong order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Turned {
    /// Length of its edge there, mm.
    pub length: f64,
    /// The points of the closure between which it lies, and the piece that lies outside.
    pub at: String,
}

/// Findings of the independent checks on the final garment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactReport {
    /// Vertices inside the body.
    pub inside_body: usize,
    /// Depth of the deepest, mm.
    pub deepest: f64,
    /// Cloth triangles that cross the body.
    pub cloth_body_intersections: usize,
    /// Pairs of cloth triangles that cross.
    pub cloth_cloth_intersections: usize,
}

/// Two pieces, or a piece and the body, that pass through each other.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Crossing {
    /// The piece.
    pub piece: String,
    /// The piece it passes through, which may be itself. `null` for the body.
    pub through: Option<String>,
    /// Number of pairs of crossing triangles. For crossings with the body, the number of triangles of the piece.
    pub pairs: usize,
    /// Near the first of them, mm.
    pub near: [f64; 3],
}

/// The body part that passes through an opening.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Worn {
    /// The opening, named after the edges round it.
    pub opening: String,
    /// `torso`, `neck`, `left arm`, `right arm`, `left leg`, `right leg`, `legs` or nothing.
    pub body_part: Option<String>,
    /// The piece edges round the opening, `piece.edge`, in order.
    pub edges: Vec<String>,
    /// Its length, mm.
    pub length: f64,
    /// Its length as drawn, mm. A gap that closures bridge counts as worn.
    #[serde(default)]
    pub length_flat: f64,
    /// Round an arm or a leg: how far past the limb's last section (wrist, ankle) it is, mm. Negative before it.
    pub past_end: Option<f64>,
    /// Mean height of its rim, mm.
    #[serde(default)]
    pub height: f64,
    /// Height of the highest point of its rim above the lowest, mm.
    #[serde(default)]
    pub level: f64,
    /// The same opening when the garment had been put on, before its seams were closed. `null` where that is not known.
    #[serde(default)]
    pub placed: Option<WornBefore>,
    /// The same opening when the garment had been sewn, before it was draped. `null` where that is not known.
    #[serde(default)]
    pub sewn: Option<WornBefore>,
    /// Why the garment is not worn where it belongs here. `null` where it is.
    #[serde(default)]
    pub fault: Option<Fault>,
}

/// An opening in an earlier state of the garment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WornBefore {
    /// As in [`Worn::body_part`].
    pub body_part: Option<String>,
    /// As in [`Worn::past_end`].
    pub past_end: Option<f64>,
    /// As in [`Worn::height`].
    pub height: f64,
}

/// Why a garment is not worn where it belongs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fault {
    /// Kind of the fault.
    pub kind: FaultKind,
    /// The same in words, with its figures.
    pub text: String,
}

/// Kinds of [`Fault`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FaultKind {
    /// The body has no torso, so nothing can be told.
    Unknown,
    /// Nothing passes through the opening.
    Empty,
    /// Another part of the body passes through it than when it was put on or sewn.
    Lost,
    /// One arm or leg passes through an opening that is the same on the left and the right.
    Askew,
    /// It has slid down.
    Slid,
    /// A piece lies higher or lower than the words of its place say.
    Level,
}

/// Report of a stage.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Stage {
    /// `sew`, `drape`, `flatten`.
    pub name: String,
    /// Wall-clock time, s.
    pub seconds: f64,
    /// Steps taken. Of a drape also those of part of the garment.
    pub iterations: usize,
    /// Whether it came to rest.
    pub converged: bool,
    /// Energy at the end, J. `null` for a stage without one.
    pub energy: Option<f64>,
    /// Motion of the last check for rest. `null` for a stage without one.
    pub drift: Option<Drift>,
    /// Unbalanced force at the end, in particle weights (root mean square). `null` for a stage without one.
    pub residual: Option<f64>,
    /// Wall-clock time of contact. `null` for a stage without contact.
    pub contact_seconds: Option<ContactSeconds>,
}

/// Wall-clock time that finding and following contacts took, s, without coarser levels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ContactSeconds {
    /// Looking for the body near particles.
    pub body: f64,
    /// Looking for its vertices and edges near triangles and edges of the cloth.
    pub features: f64,
    /// Looking for cloth near cloth.
    pub cloth: f64,
    /// Following contacts between two searches.
    pub follow: f64,
    /// All of the stage that these are parts of.
    pub of: f64,
}

/// Motion of the garment in as many steps again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Drift {
    /// Root mean square over the particles, mm.
    pub rms: f64,
    /// Largest, mm.
    pub max: f64,
}
