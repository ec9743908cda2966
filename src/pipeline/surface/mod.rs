//! Any surface laid flat: every group, texture island or connected part of an OBJ file as a piece of its own.

mod apart;
mod cuts;
mod darts;
mod drawn;
mod ease;
mod edges;
mod even;
mod form;
mod garment;
mod gores;
mod mend;
mod parts;
mod report;
mod rows;
mod sheet;
mod simplify;
mod size;
mod split;
mod thick;
mod write;

use std::path::Path;
use std::time::Instant;

use super::error::PipelineError;
use crate::fabric::{Fabric, TensileCurve};
use crate::flatten::{FlatReport, FlattenOptions};
use crate::geometry::Vec3;
use crate::input::{LengthUnit, stem};
use crate::io::obj_read::{ObjError, ObjFaces};
use crate::io::surface_read::read_surface;
use crate::report::Stage;
use apart::laid_apart;
pub use cuts::Cuts;
use cuts::{cut_as_asked, cut_open, cut_sharp};
pub use darts::DartStop;
use darts::{Failed, LaidPart, LaidSurface, LayingInput};
use drawn::cut_drawn;
pub use ease::{Ease, EaseReport};
use edges::{PartRimEdge, named_edges};
use gores::cut_gores;
pub use mend::Weld;
use mend::{AT_ONE_PLACE, mend, welded, welded_note};
pub use report::{CutReport, CutWhy, EdgeReport, FailedReport, HalvingReport, PartReport, SurfaceReport};
use sheet::CutFaces;
use simplify::simplify;
use size::Space;
use thick::leave_outer_sides;
pub use write::FlatCorners;

/// No weave is strained by more, whatever its fibre: sheared by 30°, where its threads lock, it is by 0.29 along a
/// diagonal, and the stretchiest threads of the library's weaves give less than another 0.2.
const BEYOND_WEAVES: f64 = 0.5;
/// No weave changes its area by more without stretched threads: sheared by 30° it has cos 30° of it.
const BEYOND_SHEAR: f64 = 0.134;
/// Darts that `auto` cuts: into a round part, and into all the others together. A part that is then not below the limit
/// needs a seam.
pub const DARTS: usize = 8;

/// Darts after which no more are cut, however many are needed: their allowances would be all that is left.
const ENOUGH: usize = 60;

/// How many darts are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Darts {
    /// As many as are needed, [`DARTS`] at most.
    Auto,
    /// As many as are needed.
    Enough,
    /// So many even ones into every round part that is strained beyond the limit; into the others so many together at
    /// most, as they are needed.
    Count(usize),
}

impl Darts {
    /// How many there may be in a round part, and in all the others together.
    pub fn most(self) -> usize {
        match self {
            Self::Auto => DARTS,
            Self::Enough => ENOUGH,
            Self::Count(count) => count,
        }
    }
}

/// How to read and flatten a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceOptions {
    /// The unit of the file; `None` guesses it from the size.
    pub unit: Option<LengthUnit>,
    /// The direction of the file that lies along the grain, up on the flat piece; `None` takes y, or z where the
    /// surface stands along z.
    pub up: Option<Vec3>,
    /// Whether to cut along the seams of the texture.
    pub texture_seams: bool,
    /// Whether groups and materials are pieces of their own.
    pub groups: bool,
    /// Which vertices at the same place are one: the legs of a dart that is sewn up must not be, the triangles of a
    /// file whose faces share no vertices must.
    pub weld: Weld,
    /// How far from the triangles that are left vertices may lie that are left out of a fine mesh, metres.
    pub simplify: Option<f64>,
    /// Where to cut besides.
    pub cuts: Cuts,
    /// Into how many gores to cut every part: a dome or a ball along meridians, a tube along its length.
    pub gores: Option<usize>,
    /// The darts to cut where the strain passes the limit.
    pub darts: Option<Darts>,
    /// How much smaller or larger the pieces are cut than they lie flat.
    pub ease: Ease,
    /// Limit that 99 % of a piece's area should stay below.
    pub limit: Limit,
    /// How to flatten.
    pub flatten: FlattenOptions,
    /// Number of the first vertex and of the first face in messages and in the report: 1 as in an OBJ, 0 as in arrays.
    pub first_number: u32,
}

impl Default for SurfaceOptions {
    /// As the file has it: cut along the seams of its texture, strained by 10 % at most.
    fn default() -> Self {
        Self {
            unit: None,
            up: None,
            texture_seams: true,
            groups: true,
            weld: Weld::default(),
            simplify: None,
            cuts: Cuts::default(),
            gores: None,
            darts: None,
            ease: Ease::default(),
            limit: Limit::Strain(0.1),
            flatten: FlattenOptions::default(),
            first_number: 1,
        }
    }
}

/// How much strain is too much.
#[derive(Clone, Debug, PartialEq)]
pub enum Limit {
    /// This |stretch − 1| in any direction.
    Strain(f64),
    /// The strains that the threads of a fabric reach under 100 gf/cm, the load at which the FAST test reads how far
    /// cloth can be worked. The angle between the threads is free.
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

    /// How much a piece is strained, 1 at the limit.
    fn share(&self, piece: &FlatReport) -> f64 {
        match self {
            Self::Strain(most) => piece.strain_p99 / most,
            Self::Fabric { warp, weft, .. } => (piece.threads.warp_p99 / warp).max(piece.threads.weft_p99 / weft),
        }
    }

    /// Whether no hand lays a piece so without a cut or a dart: its cloth gives less under the full load of a tester
    /// or, where it is not known, than any weave does.
    fn is_out_of_reach(&self, piece: &FlatReport) -> bool {
        match self {
            Self::Strain(_) => {
                let change = (piece.area_after / piece.area_before - 1.0).abs();
                piece.strain_p99 > BEYOND_WEAVES || change > BEYOND_SHEAR
            }
            Self::Fabric { most: [warp, weft], .. } => piece.threads.warp_p99 > *warp || piece.threads.weft_p99 > *weft,
        }
    }

    /// Whether a piece is strained more.
    pub fn passed(&self, piece: &FlatReport) -> bool {
        self.share(piece) > 1.0
    }
}

/// A surface laid flat.
pub struct FlatSurface {
    sheet: CutFaces,
    laid: Vec<LaidPart>,
    failed: Vec<Failed>,
    ease: Ease,
    /// Of every part that is laid flat.
    edges: Vec<Vec<PartRimEdge>>,
    /// The errors it leaves in the cloth.
    pub report: SurfaceReport,
    /// Notes on input that its author may not have meant as it was read: one sentence each.
    pub notes: Vec<String>,
}

/// Lays every part of an OBJ flat. A part that cannot be laid flat leaves the others as they are:
/// [`SurfaceReport::failed`] names it.
///
/// # Errors
/// A file that cannot be read, a cut that cannot be made; where no part can be laid flat, why the first cannot and
/// where to cut it.
pub fn flatten_surface(file: &Path, options: &SurfaceOptions) -> Result<FlatSurface, PipelineError> {
    flatten_faces(file, read_surface(file)?, options)
}

/// As [`flatten_surface`], of a surface in memory; `file` names it.
///
/// # Errors
/// As of [`flatten_surface`].
pub fn flatten_faces(file: &Path, mut faces: ObjFaces, options: &SurfaceOptions) -> Result<FlatSurface, PipelineError> {
    if !options.groups {
        faces.join_groups();
    }
    let stem = stem(file);
    let begin = Instant::now();
    let mut notes = Vec::new();
    let unit = options.unit.unwrap_or_else(|| {
        let (unit, said) = size::guessed(&faces);
        notes.push(said);
        unit
    });
    let up = options.up.or_else(|| {
        size::stands_along_z(&faces).then(|| {
            notes.push("z up assumed: the surface runs along z; say --up y if that is wrong".into());
            Vec3::z()
        })
    });
    let space = Space::new(unit, up);
    let textured = options.texture_seams && faces.texture_of_face.iter().any(|t| !t.is_empty());
    let same = welded(&faces, options.weld, space.metres);
    notes.extend(mend(&mut faces, &same, options.first_number));
    notes.extend(leave_outer_sides(&mut faces, &same, space.metres, &stem));
    if let Some(tolerance) = options.simplify {
        notes.push(simplify(&mut faces, &same, space.metres, tolerance));
    }
    let source = LayingInput { file, options };
    notes.extend(welded_note(&faces, options.weld, &same));
    let mut sheet = CutFaces::new(faces, same, textured, space, &stem);
    sheet.first_number = options.first_number;
    let as_read = sheet.parts();
    notes.extend(split_notes(&sheet, options.weld, as_read.len()));
    cut_as_asked(&source, &mut sheet, as_read)?;
    options.cuts.files.iter().try_for_each(|lines| cut_drawn(&mut sheet, lines))?;
    if options.cuts.sharp {
        cut_sharp(&mut sheet);
    }
    if let Some(count) = options.gores {
        notes.extend(cut_gores(&source, &mut sheet, count)?);
    }
    if options.cuts.auto {
        cut_open(&mut sheet, None);
    }
    let LaidSurface { laid, mut failed } = laid_apart(&source, &mut sheet)?;
    if laid.is_empty() && !failed.is_empty() {
        return Err(failed.swap_remove(0).error);
    }
    if laid.is_empty() {
        return Err(ObjError::NoArea { file: file.display().to_string() }.into());
    }
    notes.extend(laid.iter().filter_map(|l| l.part.turned_note()));
    notes.extend(sheet.made.iter().map(ToString::to_string));
    let edges = named_edges(&laid.iter().map(|l| &l.part).collect::<Vec<_>>());
    let report = SurfaceReport {
        toile: env!("CARGO_PKG_VERSION").into(),
        surface: stem.clone(),
        units: unit.symbol(),
        ease: options.ease.report(),
        pieces: report::pieces(&laid, &edges, options),
        failed: failed.iter().map(Failed::report).collect(),
        cuts: std::mem::take(&mut sheet.chains),
        cuts_made: std::mem::take(&mut sheet.made),
        stages: vec![stage(laid.iter().map(|l| l.flat.report), begin)],
    };
    Ok(FlatSurface { sheet, laid, ease: options.ease, failed, edges, report, notes })
}

/// Why the surface is in `count` parts before it is cut, where its author may have meant fewer.
fn split_notes(sheet: &CutFaces, weld: Weld, count: usize) -> Vec<String> {
    let all = || sheet.welded_within(Weld::Within(AT_ONE_PLACE));
    let parts = |textured: bool, same: Vec<u32>| sheet.read_as(textured, same).parts().len();
    let mut notes = Vec::new();
    if sheet.textured && count > parts(false, sheet.welded_within(weld)) {
        notes.push("cut along the seams of its texture; --no-texture-seams leaves them closed".into());
    }
    if count > sheet.faces.groups.len() && count > parts(sheet.textured, all()) {
        notes.push("parts meet in vertices of their own at the same places; --weld joins them".into());
    }
    notes
}

/// The stage that laid pieces with these figures flat.
pub(super) fn stage(reports: impl Iterator<Item = FlatReport> + Clone, begin: Instant) -> Stage {
    Stage {
        name: "flatten".into(),
        seconds: begin.elapsed().as_secs_f64(),
        iterations: reports.clone().map(|r| r.iterations).max().unwrap_or(0),
        converged: reports.clone().all(|r| r.converged),
        energy: Some(reports.map(|r| r.energy).sum()),
        ..Stage::default()
    }
}
