//! The figures of a flattened surface: keys and units of its `report.json`.

use std::f64::consts::PI;

use serde::Serialize;

use super::super::error::PipelineError;
use super::SurfaceOptions;
use super::cuts;
use super::darts::{DartStop, Failed, LaidPart};
use super::ease::{Ease, EaseReport};
use super::edges::PartRimEdge;
use crate::flatten::FlattenError;
use crate::geometry::MM;
use crate::report::{Quartet, Stage};

/// The result of flattening a surface, written as `report.json`. Vertices have their numbers of the file, from
/// [`SurfaceOptions::first_number`].
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceReport {
    /// Version of this program.
    pub toile: String,
    /// The file's stem.
    pub surface: String,
    /// Unit of the file: `mm`, `cm`, `m` or `in`.
    pub units: &'static str,
    /// How much smaller or larger than they lie flat the pieces are cut, in the drawings and in `flat.obj`.
    pub ease: Option<EaseReport>,
    /// One per part.
    pub pieces: Vec<PartReport>,
    /// The parts that could not be laid flat, of which the files have nothing.
    pub failed: Vec<FailedReport>,
    /// Where the surface was cut besides its groups and texture seams: chains of the file's vertices.
    pub cuts: Vec<Vec<u32>>,
    /// A row for each of these: what it is, and how long.
    pub cuts_made: Vec<CutReport>,
    /// The one stage.
    pub stages: Vec<Stage>,
}

/// A part that could not be laid flat.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FailedReport {
    /// Named as the others are.
    pub name: String,
    /// Why it could not, and where to cut it if that is the remedy.
    pub why: String,
}

impl Failed {
    /// Its place and reason, as the report has them.
    pub(super) fn report(&self) -> FailedReport {
        // File and piece are named beside it.
        let bare = |source: &FlattenError| match source {
            FlattenError::Piece { source, .. } => source.to_string(),
            other => other.to_string(),
        };
        let why = match &self.error {
            PipelineError::NoDisk { source, advice, .. } => format!("{}; {advice}", bare(source)),
            PipelineError::Surface { source, .. } => bare(source),
            other => other.to_string(),
        };
        FailedReport { name: self.part.name.clone(), why }
    }
}

/// The errors of one part. Keys and units are those of a garment's report. The surface in space is `draped`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartReport {
    /// The group's name; numbered where a group has several parts.
    pub name: String,
    /// Vertices.
    pub particles: usize,
    /// Triangles.
    pub triangles: usize,
    /// Area in space, mm².
    pub area_draped: f64,
    /// Area of the flat piece, mm².
    pub area_flattened: f64,
    /// Area as it is cut: with the ease that was asked for, mm².
    pub area_cut: f64,
    /// Length of the rim in space, mm.
    pub boundary_draped: f64,
    /// Length of the flat rim, mm.
    pub boundary_flattened: f64,
    /// Length of its rims as they are cut, mm.
    pub boundary_cut: f64,
    /// Flat against space.
    pub area_error: Quartet,
    /// The same with its sign: below zero where the flat piece is smaller.
    pub area_change: f64,
    /// The same for the rim.
    pub boundary_error: Quartet,
    /// Largest |length / length in space − 1| of an edge.
    pub largest_edge_error: f64,
    /// Largest |length / length in space − 1| of an edge of the rim.
    pub largest_rim_error: f64,
    /// By which share, in the mean, rim edges (in the mode `woven` the lengths between corners and notches) are off
    /// that the mode was to keep and could not; `null` where it keeps them, or none.
    pub rim_missed: Option<f64>,
    /// Root mean square of the triangles' stretches minus one.
    pub distortion: f64,
    /// Root mean square of the triangles' relative change of area.
    pub area_distortion: f64,
    /// |stretch − 1| in the worst direction: what all but a hundredth of the area stays below, and the largest.
    pub strain: StrainReport,
    /// The strain of warp and weft.
    pub threads: ThreadReport,
    /// L²/4πS of the rim and the area in space. Below 1 no flat piece has both that rim and that area.
    pub isoperimetric: f64,
    /// The least area error of any flat piece with the same length of rim: 1 − L²/4πS, or 0.
    pub area_error_bound: f64,
    /// Total Gauss curvature, degrees: by so much less, all together, are the flat rim's angles.
    pub curvature: f64,
    /// Largest change of the rim's angle in one vertex, degrees.
    pub corner_change: f64,
    /// The least that any flat piece has: the curvature spread over all vertices of the rim, degrees.
    pub corner_change_forced: f64,
    /// Triangles turned over: always 0.
    pub flips: usize,
    /// Crossings of the flat rim: 0 unless the piece lies on itself.
    pub overlaps: usize,
    /// The rims, between corners and where the other side of a cut changes.
    pub edges: Vec<EdgeReport>,
    /// Whether cloth can be worked to lie so: `false` where the fabric gives less even under 500 gf/cm, or without a
    /// fabric where the strain passes a half or the area changes by more than 13 %, which no weave gives. Such a piece
    /// needs a cut or a dart.
    pub layable: bool,
    /// A dart that would relieve the piece, where its strain passes the limit.
    pub dart: Option<DartReport>,
    /// Where it is best cut in two, where it lies on itself or is not `layable`: from rim to rim.
    pub halving: Option<HalvingReport>,
    /// How many darts were cut into it.
    pub darts: usize,
    /// Why there are no more where they were asked for and the strain still passes the limit: `none_left` (of those
    /// allowed), `overlap` (the piece would lie on itself) or `no_place` (none can be told that would help).
    pub darts_stopped: Option<DartStop>,
}

/// Strain of a part, fractions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StrainReport {
    /// 99 % of the area is strained no more.
    pub p99: f64,
    /// 99 % of the area is stretched no more in the flat piece.
    pub stretch_p99: f64,
    /// 99 % of the area is compressed no more in the flat piece.
    pub compression_p99: f64,
    /// Largest.
    pub max: f64,
}

/// An edge of a part, as `pattern.svg` names it after the part: `NAME.1`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct EdgeReport {
    /// Its number along the rim.
    pub name: String,
    /// The file's vertices at its ends.
    pub ends: [u32; 2],
    /// Length in space, mm.
    pub length_draped: f64,
    /// Length in the flat piece, mm.
    pub length_flattened: f64,
    /// Length as it is cut: with the ease that was asked for, mm.
    pub length_cut: f64,
    /// The edge on the other side of the cut, `PART.EDGE`.
    pub sewn_to: Option<String>,
}

/// All parts as they are reported, with their edges.
pub(super) fn pieces(laid: &[LaidPart], edges: &[Vec<PartRimEdge>], options: &SurfaceOptions) -> Vec<PartReport> {
    let partner = |e: &PartRimEdge| e.partner.map(|[p, e]| format!("{}.{}", laid[p].part.name, edges[p][e].name));
    let piece = |(k, own): (usize, &LaidPart)| {
        let edges: Vec<EdgeReport> = edges[k].iter().map(|e| edge(own, e, partner(e), options.ease)).collect();
        let boundary_cut = edges.iter().map(|edge| edge.length_cut).sum();
        PartReport { edges, boundary_cut, ..PartReport::new(own, options) }
    };
    laid.iter().enumerate().map(piece).collect()
}

/// An edge of a part as it is reported.
fn edge(own: &LaidPart, edge: &PartRimEdge, sewn_to: Option<String>, ease: Ease) -> EdgeReport {
    let (part, flat, vertices) = (&own.part, &own.flat.positions, &edge.vertices);
    let ends = [vertices[0], vertices[vertices.len() - 1]].map(|v| part.number(v));
    let pairs = || vertices.windows(2).map(|w| [w[0] as usize, w[1] as usize]);
    let at = &part.surface.vertices;
    EdgeReport {
        name: edge.name.clone(),
        ends,
        length_draped: pairs().map(|[a, b]| (at[b] - at[a]).norm()).sum::<f64>() * MM,
        length_flattened: pairs().map(|[a, b]| (flat[b] - flat[a]).norm()).sum::<f64>() * MM,
        length_cut: pairs().map(|[a, b]| (ease.cut(flat[b]) - ease.cut(flat[a])).norm()).sum::<f64>() * MM,
        sewn_to,
    }
}

/// Threads of the flat cloth on the surface in space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThreadReport {
    /// Root mean square of the warp's stretch minus one.
    pub warp: f64,
    /// The same of the weft.
    pub weft: f64,
    /// |stretch − 1| of the warp that all but a hundredth of the area stays below.
    pub warp_p99: f64,
    /// The same of the weft.
    pub weft_p99: f64,
    /// Root mean square of the change of the angle between them, degrees.
    pub shear: f64,
    /// The largest, degrees.
    pub shear_max: f64,
    /// The file's vertex where that is.
    pub shear_at: u32,
}

/// A cut besides groups and texture seams.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CutReport {
    /// The part that was cut, named as it was before.
    pub piece: String,
    /// The purpose.
    pub why: CutWhy,
    /// The file's vertex at its start.
    pub from: u32,
    /// The file's vertex at its end.
    pub to: u32,
    /// Length, mm.
    pub length: f64,
    /// How much 99 % of the piece was strained before it was cut for that, and with the cut or, of even darts, with all
    /// of them: fractions.
    pub strain: Option<[f64; 2]>,
}

/// Why a surface was cut: `asked` for, `auto` to make a disk of it, as a `dart`, or between two of its `gore`s.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CutWhy {
    /// `--cut A,B`.
    Asked,
    /// `--cut auto`.
    Auto,
    /// `--dart`.
    Dart,
    /// `--gores`.
    Gore,
    /// The piece would lie on itself when flat, or `--max-strain` needs it.
    Apart,
}

impl std::fmt::Display for CutReport {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { piece, why, from, to, length, strain } = self;
        let what = match why {
            CutWhy::Dart => "a dart in",
            CutWhy::Apart => "cut apart, for no dart cures it:",
            CutWhy::Asked | CutWhy::Auto | CutWhy::Gore => "cut",
        };
        write!(f, "{what} '{piece}' from vertex {from} to vertex {to} ({length:.1} mm)")?;
        strain.map_or(Ok(()), |[before, after]| {
            write!(f, ": strain {:.1} % before, {:.1} % after", 100.0 * before, 100.0 * after)
        })
    }
}

/// A way from rim to rim.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HalvingReport {
    /// The file's vertex at its start.
    pub from: u32,
    /// The file's vertex at its end.
    pub to: u32,
    /// Length, mm.
    pub length: f64,
}

/// A dart, from the rim to its tip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DartReport {
    /// The file's vertex on the rim.
    pub rim: u32,
    /// The file's vertex at the tip.
    pub tip: u32,
    /// Length, mm.
    pub length: f64,
}

impl PartReport {
    fn new(laid: &LaidPart, options: &SurfaceOptions) -> Self {
        let (part, r) = (&laid.part, &laid.flat.report);
        let out_of_reach = options.limit.is_out_of_reach(r);
        let error = |e: f64| Quartet { flatten: Some(e), ..Quartet::default() };
        let isoperimetric = r.boundary_before.powi(2) / (4.0 * PI * r.area_before);
        Self {
            name: part.name.clone(),
            particles: part.surface.vertices.len(),
            triangles: part.surface.triangles.len(),
            area_draped: r.area_before * MM * MM,
            area_flattened: r.area_after * MM * MM,
            area_cut: r.area_after * options.ease.area() * MM * MM,
            boundary_draped: r.boundary_before * MM,
            boundary_flattened: r.boundary_after * MM,
            boundary_cut: r.boundary_after * MM,
            area_error: error(r.area_error),
            area_change: r.area_after / r.area_before - 1.0,
            boundary_error: error(r.boundary_error),
            largest_edge_error: r.largest_edge_error,
            largest_rim_error: r.largest_rim_error,
            rim_missed: r.rim_missed,
            distortion: r.distortion,
            area_distortion: r.area_distortion,
            strain: StrainReport {
                p99: r.strain_p99,
                stretch_p99: r.stretch_p99,
                compression_p99: r.compression_p99,
                max: r.strain_max,
            },
            threads: ThreadReport {
                warp: r.threads.warp,
                weft: r.threads.weft,
                warp_p99: r.threads.warp_p99,
                weft_p99: r.threads.weft_p99,
                shear: r.threads.shear.to_degrees(),
                shear_max: r.threads.shear_max.to_degrees(),
                shear_at: part.number(r.threads.shear_at),
            },
            isoperimetric,
            area_error_bound: (1.0 - isoperimetric).max(0.0),
            curvature: r.curvature.to_degrees(),
            corner_change: r.corner_change.to_degrees(),
            corner_change_forced: r.corner_change_forced.to_degrees(),
            flips: r.flips,
            overlaps: r.overlaps,
            edges: Vec::new(),
            layable: !out_of_reach,
            dart: cuts::proposal(part, &laid.dart),
            halving: (out_of_reach || r.overlaps > 0).then(|| cuts::proposed_halving(part)).flatten(),
            darts: laid.darts,
            darts_stopped: laid.stop,
        }
    }
}
