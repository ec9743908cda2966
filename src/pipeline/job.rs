//! Everything that is known before cloth moves.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use super::error::PipelineError;
use super::overrides::{Overrides, SPACING};
use super::{cloth, fit, material};
use crate::contact::Collider;
use crate::dynamics::Cut;
use crate::fabric::Fabric;
use crate::io::garment::{self, Loaded, Variant};
use crate::mannequin::{Mannequin, PartKind};
use crate::mesh::{self, ClothMesh};
use crate::pattern::{Garment, outfit};
use crate::report::{Bands, Stage};
use crate::sew::{SewError, Stance};

/// A garment, its fabrics, the body it is made for and its mesh.
pub struct Job {
    /// The garment file, or for an outfit that of the innermost garment.
    pub file: PathBuf,
    /// The pieces and seams.
    pub garment: Garment,
    /// The fabric of every piece.
    pub fabrics: Vec<Arc<Fabric>>,
    /// The body.
    pub body: Mannequin,
    /// The body's surface for contact.
    pub collider: Collider,
    /// The body as it is sewn on, where its limbs nearly touch.
    pub stance: Option<Stance>,
    /// The mesh.
    pub mesh: ClothMesh,
    /// Limits of the bands of pressure.
    pub bands: Bands,
    /// Notes on input that its author may not have meant so, one text each.
    pub notes: Vec<String>,
    /// Report of the meshing.
    pub(super) meshing: Stage,
}

/// Reads and checks a garment file.
///
/// # Errors
/// Every mistake of the file.
pub fn read(path: &Path) -> Result<Loaded, PipelineError> {
    Ok(garment::read(path)?)
}

/// Reads and checks a variant of a garment file: a size, and further alterations.
///
/// # Errors
/// Every mistake of the file, and an alteration that cannot be carried out.
pub fn read_variant(path: &Path, variant: Variant) -> Result<Loaded, PipelineError> {
    Ok(garment::read_variant(path, variant)?)
}

impl Job {
    /// The input of the sewing and draping stages.
    pub fn cut(&self) -> Cut<'_> {
        Cut { garment: &self.garment, mesh: &self.mesh, fabrics: &self.fabrics }
    }

    /// Gets the fabrics and the body of a garment read from `file`, and meshes it.
    ///
    /// # Errors
    /// [`PipelineError`]: a fault of the input, or a body that cannot be prepared for contact.
    pub fn new(file: &Path, loaded: Loaded, overrides: &Overrides) -> Result<Self, PipelineError> {
        Self::dressed(vec![(file.to_owned(), loaded)], overrides)
    }

    /// Gets the fabrics and the body of garments worn over one another, each with its file, from the skin outwards, and
    /// meshes them as one.
    ///
    /// # Errors
    /// [`PipelineError`]: as of [`Self::new`], and bodies that differ, or a fabric in place of nobody knows whose.
    pub fn dressed(mut worn: Vec<(PathBuf, Loaded)>, overrides: &Overrides) -> Result<Self, PipelineError> {
        if worn.len() > 1 && (overrides.fabric.is_some() || overrides.given.fabric.is_some()) {
            return Err(PipelineError::WhoseFabric);
        }
        let mut notes: Vec<String> = worn.iter().flat_map(|(_, l)| &l.warnings).map(ToString::to_string).collect();
        let mut fabrics = Vec::new();
        for (file, loaded) in &mut worn {
            let (own, told) = material::fabrics(file, loaded, overrides)?;
            fabrics.extend(own);
            notes.extend(told);
            material::name_bounded_fabrics(file, loaded)?;
        }
        let (wanted, worn_by) = material::body_of_all(&worn, overrides)?;
        notes.extend(worn_by.notes.iter().map(|note| format!("{wanted}: {note}")));
        let body = worn_by.mannequin;
        let begin = Instant::now();
        let garment = outfit(worn.iter().map(|(_, loaded)| loaded.garment.clone()).collect());
        let meshed = mesh::build(&garment, overrides.spacing.unwrap_or(SPACING));
        let mesh = meshed.map_err(|source| material::mesh_error(&worn, source))?;
        let meshing =
            Stage { name: "mesh".into(), seconds: begin.elapsed().as_secs_f64(), converged: true, ..Stage::default() };
        let mut first = 0;
        for (_, loaded) in &worn {
            let mut findings = loaded.findings();
            fit::doubt_size(loaded, &body, &mut findings);
            fit::tell_narrow(loaded, &mesh, first, &mut findings);
            notes.extend(findings.into_sorted().iter().map(ToString::to_string));
            first += loaded.garment.pieces.len();
        }
        let collider =
            Collider::new(&body.mesh).ok_or_else(|| PipelineError::Sew(SewError::Body(body.name.clone())))?;
        let collider = collider.on_floor(body.floor());
        let stance = Stance::of(&body, &garment);
        notes.extend(stance.as_ref().map(|stance| format!("{wanted}: {}", spread(stance))));
        let file = worn.swap_remove(0).0;
        let bands = overrides.bands.clone().unwrap_or_default();
        Ok(Self { file, garment, fabrics, body, collider, stance, mesh, bands, notes, meshing })
    }

    /// The smaller text of its pictures: the body and the fabrics.
    pub(super) fn subtitle(&self) -> String {
        format!("{}, {}", self.body.name, self.fabric_names())
    }

    /// Names of the fabrics in use, joined with ` + `.
    pub fn fabric_names(&self) -> String {
        cloth::names(&self.fabrics)
    }
}

/// Files that a job is made from, of which none may be overwritten: the garment file, its fabrics' and the body's, and
/// those that take their places. (A fabric's curves are left out: no result is a `.csv`.)
pub fn inputs(file: &Path, garment: &Garment, overrides: &Overrides) -> Vec<PathBuf> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let fabrics = garment.fabrics.iter().filter_map(|f| f.spec.base.as_deref()).map(|base| folder.join(base));
    let body = material::body_name(file, garment.body.as_deref(), overrides.body.as_deref()).ok();
    let named = overrides.fabric.iter().chain(&body).map(PathBuf::from);
    let files = fabrics.chain(named).filter(|path| path.is_file());
    std::iter::once(file.to_owned()).chain(files).collect()
}

/// Note for the user on a body that is sewn on with its limbs spread.
fn spread(stance: &Stance) -> String {
    let limbs: Vec<&str> = stance.limbs().map(PartKind::name).collect();
    format!("too little room at the {}: sewn with them apart, draped on the body as it stands", limbs.join(", "))
}
