//! Any surface laid flat: every group, texture island or connected part of an OBJ file as a piece of its own.

mod cuts;
mod darts;
mod edges;
mod parts;
mod report;
mod write;

use std::path::Path;
use std::time::Instant;

use super::error::PipelineError;
use crate::fabric::{Fabric, TensileCurve};
use crate::flatten::{Options, Report};
use crate::geometry::box_of;
use crate::input::LengthUnit;
use crate::io::obj_read::{ObjFaces, read_obj_faces};
use crate::report::Stage;
pub use cuts::Cuts;
use cuts::Marks;
pub use darts::DartStop;
use darts::{Laid, Source, with_darts};
use edges::{NamedEdge, named_edges};
use parts::Nodes;
pub use report::{CutReport, CutWhy, EdgeReport, PartReport, SurfaceReport};
pub use write::{FLAT_OBJ, FLAT_PNG, OUTLINE_SVG};

/// Sizes of a surface, in file units, below which the unit is metres (first) or centimetres (second), otherwise
/// millimetres. Pieces of garments are between 4 cm and 4 m large.
const UNITS_BELOW: [f64; 2] = [4.0, 250.0];
/// Strain that no weave exceeds, whatever its fibre. Sheared by 30°, where its threads lock, a weave is strained by
/// 0.29 along a diagonal, and the stretchiest threads of the library's weaves add less than 0.2.
const BEYOND_WEAVES: f64 = 0.5;
/// Darts that `auto` cuts into all parts of a surface together. A part that is still beyond the limit needs a seam.
pub const DARTS: usize = 8;

/// Options for reading and flattening a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceOptions {
    /// The unit of the file. `None` guesses it from the size.
    pub unit: Option<LengthUnit>,
    /// Whether to cut along the seams of the texture.
    pub texture_seams: bool,
    /// Whether to join vertices at the same place. The legs of a sewn dart must stay apart. A file whose faces share no
    /// vertices needs the join.
    pub weld: bool,
    /// Additional cuts.
    pub cuts: Cuts,
    /// Largest number of darts, in all parts together, cut where the strain passes the limit.
    pub darts: usize,
    /// Bound of the strain of 99 % of a piece's area.
    pub limit: Limit,
    /// Options of flattening.
    pub flatten: Options,
}

/// A limit of strain.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// This |stretch − 1| in any direction.
    Strain(f64),
    /// The extension of a fabric's threads under 100 gf/cm, the load at which the FAST test reads how far cloth can be
    /// worked. The angle between threads is free.
    Fabric {
        /// Its name.
        name: String,
        /// |stretch − 1| of the warp.
        warp: f64,
        /// |stretch − 1| of the weft.
        weft: f64,
        /// Extension of warp and weft under the full load of a tensile tester, 500 gf/cm.
        most: [f64; 2],
    },
}

impl Limit {
    /// That of a fabric.
    pub fn of(fabric: &Fabric) -> Self {
        let [warp, weft] = [&fabric.warp, &fabric.weft].map(TensileCurve::workable);
        let most = fabric.emt();
        Self::Fabric { name: fabric.name.clone(), warp, weft, most }
    }

    /// Strain of a piece as a share of the limit.
    fn share(&self, piece: &Report) -> f64 {
        match self {
            Self::Strain(most) => piece.strain_p99 / most,
            Self::Fabric { warp, weft, .. } => (piece.threads.warp_p99 / warp).max(piece.threads.weft_p99 / weft),
        }
    }

    /// Whether no hand lays a piece so without a cut or a dart: its cloth gives less under the full load of a tester
    /// or, where it is not known, than any weave does.
    fn is_out_of_reach(&self, piece: &Report) -> bool {
        match self {
            Self::Strain(_) => piece.strain_p99 > BEYOND_WEAVES,
            Self::Fabric { most: [warp, weft], .. } => piece.threads.warp_p99 > *warp || piece.threads.weft_p99 > *weft,
        }
    }

    /// Whether a piece is strained more.
    pub fn passed(&self, piece: &Report) -> bool {
        self.share(piece) > 1.0
    }
}

/// A surface laid flat.
pub struct FlatSurface {
    faces: ObjFaces,
    laid: Vec<Laid>,
    /// Of every part.
    edges: Vec<Vec<NamedEdge>>,
    /// The report.
    pub report: SurfaceReport,
    /// Notes on input that its author may not have meant so, one sentence each.
    pub notes: Vec<String>,
}

/// Lays every part of an OBJ flat.
///
/// # Errors
/// A file that cannot be read, a cut that cannot be made, or a part that is no disk, with its kind and the place to cut
/// it.
pub fn flatten_surface(file: &Path, options: &SurfaceOptions) -> Result<FlatSurface, PipelineError> {
    let faces = read_obj_faces(file)?;
    let stem = file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let begin = Instant::now();
    let taken = options.unit.unwrap_or_else(|| guessed(&faces));
    let (unit, units) = (taken.metres(), taken.symbol());
    let mut notes = Vec::new();
    if options.unit.is_none() {
        notes.push(format!(
            "{units} assumed, from the size of the surface; say --units mm, cm, m or in if that is wrong"
        ));
    }
    let textured = options.texture_seams && faces.texture_of_face.iter().any(|t| !t.is_empty());
    let nodes = Nodes::new(&faces, textured, options.weld);
    let source = Source { file, faces: &faces, nodes: &nodes, unit, stem: &stem, options };
    let as_read = source.parts(&Marks::default());
    notes.extend(source.split_notes(textured, as_read.len()));
    let mut marks = Marks::asked(&source, &as_read)?;
    drop(as_read);
    if options.cuts.auto {
        let parts = source.parts(&marks);
        marks.cut_open(&parts);
    }
    let laid = with_darts(&source, &mut marks)?;
    notes.extend(laid.iter().filter_map(|l| l.part.turned_note()));
    notes.extend(marks.made.iter().map(ToString::to_string));
    let edges = named_edges(&laid.iter().map(|l| &l.part).collect::<Vec<_>>());
    let report = SurfaceReport {
        toile: env!("CARGO_PKG_VERSION").into(),
        surface: stem.clone(),
        units,
        pieces: report::pieces(&laid, &edges, &options.limit),
        cuts: marks.chains,
        cuts_made: marks.made,
        stages: vec![stage(laid.iter().map(|l| l.flat.report), begin)],
    };
    Ok(FlatSurface { faces, laid, edges, report, notes })
}

impl Source<'_> {
    /// Why the surface is in `count` parts before it is cut, where its author may have meant fewer.
    fn split_notes(&self, textured: bool, count: usize) -> Vec<String> {
        let weld = self.options.weld;
        let otherwise = |texture, weld| {
            let nodes = Nodes::new(self.faces, texture, weld);
            Source { nodes: &nodes, ..*self }.parts(&Marks::default()).len()
        };
        let mut notes = Vec::new();
        if textured && count > otherwise(false, weld) {
            notes.push("cut along the seams of its texture; --no-texture-seams leaves them closed".into());
        }
        if !weld && count > self.faces.groups.len() && count > otherwise(textured, true) {
            notes.push("parts meet in vertices of their own at the same places; --weld joins them".into());
        }
        notes
    }
}

/// The unit of a file whose surface is that large.
fn guessed(faces: &ObjFaces) -> LengthUnit {
    let [low, high] = box_of(faces.faces.iter().flatten().map(|&v| faces.vertices[v as usize]));
    LengthUnit::guessed((high - low).max(), UNITS_BELOW)
}

/// The stage that laid pieces with these figures flat.
pub(super) fn stage(reports: impl Iterator<Item = Report> + Clone, begin: Instant) -> Stage {
    Stage {
        name: "flatten".into(),
        seconds: begin.elapsed().as_secs_f64(),
        iterations: reports.clone().map(|r| r.iterations).max().unwrap_or(0),
        converged: reports.clone().all(|r| r.converged),
        energy: Some(reports.map(|r| r.energy).sum()),
        ..Stage::default()
    }
}
