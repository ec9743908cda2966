//! Any surface laid flat: every group, texture island or connected part of an OBJ file as a piece of its own.

mod cuts;
mod edges;
mod parts;
mod report;
mod write;

use std::path::Path;
use std::time::Instant;

use rayon::prelude::*;

use super::error::PipelineError;
use crate::fabric::Fabric;
use crate::flatten::{FlattenError, Flattened, Options, Report, flatten};
use crate::geometry::Vec3;
use crate::io::obj_read::{ObjFaces, read_obj_faces};
use crate::report::Stage;
pub use cuts::Cuts;
use cuts::Marks;
use edges::{NamedEdge, named_edges};
use parts::{Nodes, Part, parts};
pub use report::{EdgeReport, PartReport, SurfaceReport};
pub use write::{FLAT_OBJ, FLAT_PNG, OUTLINE_SVG};

/// A surface smaller than this many file units is in metres, smaller than the next in centimetres, else in millimetres:
/// pieces of garments are between 4 cm and 4 m large.
const METRES_BELOW: f64 = 4.0;
const CENTIMETRES_BELOW: f64 = 250.0;
/// Darts that `auto` cuts into one surface at most: what is not below the limit then needs a seam.
pub const DARTS: usize = 8;

/// How to read and flatten a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceOptions {
    /// Metres in a unit of the file; `None` guesses it from the size.
    pub unit: Option<f64>,
    /// Whether to cut along the seams of the texture.
    pub texture_seams: bool,
    /// Whether vertices at the same place are one: the legs of a dart that is sewn up must not be, the triangles of a
    /// file whose faces share no vertices must.
    pub weld: bool,
    /// Where to cut besides.
    pub cuts: Cuts,
    /// Whether to cut darts where the strain passes the limit.
    pub darts: bool,
    /// What 99 % of a piece's area should stay below.
    pub limit: Limit,
    /// How to flatten.
    pub flatten: Options,
}

/// How much strain is too much.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// This |stretch − 1| in any direction.
    Strain(f64),
    /// What the threads of a fabric give under 100 gf/cm, the load at which the FAST test reads how far cloth can be
    /// worked; the angle between them is free.
    Fabric {
        /// Its name.
        name: String,
        /// |stretch − 1| of the warp.
        warp: f64,
        /// |stretch − 1| of the weft.
        weft: f64,
    },
}

impl Limit {
    /// That of a fabric.
    pub fn of(fabric: &Fabric) -> Self {
        /// 100 gf/cm in N/m.
        const WORKED: f64 = 98.0665;
        let [warp, weft] = [&fabric.warp, &fabric.weft].map(|curve| curve.strain(WORKED));
        Self::Fabric { name: fabric.name.clone(), warp, weft }
    }

    /// Whether a piece is strained more.
    pub fn passed(&self, piece: &Report) -> bool {
        match self {
            Self::Strain(most) => piece.strain_p99 > *most,
            Self::Fabric { warp, weft, .. } => piece.threads.warp_p99 > *warp || piece.threads.weft_p99 > *weft,
        }
    }
}

/// A surface laid flat.
pub struct FlatSurface {
    faces: ObjFaces,
    parts: Vec<Part>,
    flat: Vec<Flattened>,
    /// Of every part.
    edges: Vec<Vec<NamedEdge>>,
    /// What it did to the cloth.
    pub report: SurfaceReport,
    /// What was read in a way its author may not have meant: one sentence each.
    pub notes: Vec<String>,
}

/// Lays every part of an OBJ flat.
///
/// # Errors
/// A file that cannot be read, a cut that cannot be made, or a part that is no disk, with what it is instead and where
/// to cut it.
pub fn flatten_surface(file: &Path, options: &SurfaceOptions) -> Result<FlatSurface, PipelineError> {
    let faces = read_obj_faces(file)?;
    let stem = file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let begin = Instant::now();
    let (unit, units) = options.unit.map_or_else(|| guess(&faces), |unit| (unit, name_of(unit)));
    let mut notes = Vec::new();
    if options.unit.is_none() {
        notes.push(format!("{units} assumed, from the size of the surface; say --units mm, cm or m if that is wrong"));
    }
    let textured = options.texture_seams && faces.texture_of_face.iter().any(|t| !t.is_empty());
    let nodes = Nodes::new(&faces, textured, options.weld);
    let mut marks = Marks::default();
    if options.cuts != Cuts::default() {
        let whole = parts(&faces, &nodes, &marks.edges, unit, &stem);
        marks = Marks::new(file, &faces, &nodes, &whole, &options.cuts)?;
    }
    let mut darts = if options.darts { DARTS } else { 0 };
    let (parts, flat, proposals) = loop {
        let parts = parts(&faces, &nodes, &marks.edges, unit, &stem);
        let flat = lay_out(file, &parts, &options.flatten)?;
        let mut proposals = Vec::with_capacity(parts.len());
        for (part, flat) in parts.iter().zip(&flat) {
            proposals.push(if options.limit.passed(&flat.report) { cuts::dart(part, flat) } else { Vec::new() });
        }
        let wanted = proposals.iter().filter(|d| d.len() > 1).count();
        if wanted == 0 || wanted > darts {
            break (parts, flat, proposals);
        }
        darts -= wanted;
        parts.iter().zip(&proposals).for_each(|(part, dart)| marks.cut(part, dart));
    };
    let otherwise = |texture, weld| count(&faces, &Nodes::new(&faces, texture, weld), unit, &stem);
    if textured && parts.len() > otherwise(false, options.weld) {
        notes.push("cut along the seams of its texture; --no-texture-seams leaves them closed".into());
    }
    if !options.weld && parts.len() > faces.groups.len() && parts.len() > otherwise(textured, true) {
        notes.push("parts meet in vertices of their own at the same places; --weld joins them".into());
    }
    let edges = named_edges(&parts);
    let reports = parts.iter().zip(&flat).zip(&proposals);
    let mut pieces: Vec<PartReport> =
        reports.map(|((p, f), d)| PartReport::new(p, &f.report, cuts::proposal(p, d))).collect();
    for (k, piece) in pieces.iter_mut().enumerate() {
        piece.edges = edges[k].iter().map(|e| report::edge(&parts, &edges, k, e, &flat[k].positions)).collect();
    }
    let report = SurfaceReport {
        toile: env!("CARGO_PKG_VERSION").into(),
        surface: stem.clone(),
        units,
        pieces,
        cuts: marks.chains,
        stages: vec![stage(flat.iter().map(|f| f.report), begin)],
    };
    Ok(FlatSurface { faces, parts, flat, edges, report, notes })
}

/// Number of parts that nodes hang together in.
fn count(faces: &ObjFaces, nodes: &Nodes, unit: f64, stem: &str) -> usize {
    parts(faces, nodes, &Marks::default().edges, unit, stem).len()
}

/// Metres per unit of a file of this size, and the unit's name.
fn guess(faces: &ObjFaces) -> (f64, &'static str) {
    let used = || faces.faces.iter().flatten().map(|&v| faces.vertices[v as usize]);
    let low = used().fold(Vec3::repeat(f64::INFINITY), |a, p| a.inf(&p));
    let high = used().fold(Vec3::repeat(f64::NEG_INFINITY), |a, p| a.sup(&p));
    let size = (high - low).max();
    let unit = if size < METRES_BELOW {
        1.0
    } else if size < CENTIMETRES_BELOW {
        1e-2
    } else {
        1e-3
    };
    (unit, name_of(unit))
}

fn name_of(unit: f64) -> &'static str {
    if unit == 1.0 {
        "m"
    } else if unit == 1e-2 {
        "cm"
    } else {
        "mm"
    }
}

fn lay_out(file: &Path, parts: &[Part], options: &Options) -> Result<Vec<Flattened>, PipelineError> {
    let flat: Vec<Result<Flattened, FlattenError>> =
        parts.par_iter().map(|part| flatten(&part.surface, options)).collect();
    // Of several errors the first in the file's order, not the first in time.
    parts.iter().zip(flat).map(|(part, flat)| flat.map_err(|error| cuts::advise(file, part, error))).collect()
}

/// The stage that laid pieces with these figures flat.
pub(super) fn stage(reports: impl Iterator<Item = Report> + Clone, begin: Instant) -> Stage {
    Stage {
        name: "flatten".into(),
        seconds: begin.elapsed().as_secs_f64(),
        iterations: reports.clone().map(|r| r.iterations).max().unwrap_or(0),
        converged: reports.clone().all(|r| r.converged),
        energy: Some(reports.map(|r| r.energy).sum()),
        drift: None,
        residual: None,
    }
}
