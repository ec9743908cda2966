//! Taking up an earlier run from its `sewn.obj` or `garment.obj`.

use std::path::{Path, PathBuf};

use super::earlier::{Earlier, EarlierFiles};
use super::error::PipelineError;
use super::job::Job;
use super::run::Run;
use crate::geometry::{MM, Vec3};
use crate::io::obj_read::read_obj;
use crate::mesh::{EarlierMesh, EarlierPiece, PieceMesh};
use crate::verify::Welded;

impl Earlier {
    /// The state that a run of this process has reached: the garment draped, or only sewn. `None` before sewing.
    pub fn of(run: &Run) -> Option<Self> {
        let mesh = &run.job.mesh;
        let piece = |p: &PieceMesh| EarlierPiece {
            name: p.name.clone(),
            triangles: p.triangles.clone(),
            edges: p.edges.iter().map(|e| (e.name.clone(), e.particles.clone())).collect(),
        };
        let earlier = EarlierMesh {
            flat: mesh.flat.clone(),
            triangles: mesh.triangles.clone(),
            pieces: mesh.pieces.iter().map(piece).collect(),
            spacing: mesh.spacing,
        };
        Some(Self { folder: PathBuf::new(), mesh: earlier, at: run.last()?.to_vec() })
    }
}

impl<'a> Run<'a> {
    /// A run that goes on from the result of an earlier one in `folder`: of the same garment, or of one whose pieces,
    /// fabrics, body or spacing have been changed since. Pieces that it did not have are sewn in. If it cannot
    /// be carried over, the garment is sewn from nothing; the report says so.
    ///
    /// # Errors
    /// A file of the folder that is missing or cannot be read.
    pub fn continued(job: &'a Job, folder: &Path) -> Result<Self, PipelineError> {
        Ok(Self::going_on(job, Earlier::read(folder, &job.body)?))
    }

    /// As [`Run::continued`], from the result of a run of this process.
    pub fn going_on(job: &'a Job, earlier: Earlier) -> Self {
        let mut run = Self::new(job);
        run.earlier = Some(earlier);
        run
    }

    /// As [`Run::continued`], from a result that is in memory.
    ///
    /// # Errors
    /// Files that are no result, or do not belong together.
    pub fn continued_from(job: &'a Job, files: &EarlierFiles) -> Result<Self, PipelineError> {
        Ok(Self::going_on(job, Earlier::parse(files, &job.body)?))
    }

    /// Loads the garment as sewn by an earlier run from its `sewn.obj`, to continue with draping.
    ///
    /// # Errors
    /// A file that cannot be read, or that is of another garment or spacing.
    pub fn from_sewn(job: &'a Job, file: &Path) -> Result<Self, PipelineError> {
        let mut run = Self::new(job);
        run.sewn = Some(run.saved(file)?);
        Ok(run)
    }

    /// Loads the garment as draped by an earlier run from its `garment.obj`, to continue with flattening.
    ///
    /// # Errors
    /// As [`Run::from_sewn`].
    pub fn from_draped(job: &'a Job, file: &Path) -> Result<Self, PipelineError> {
        let mut run = Self::new(job);
        run.draped = Some(run.saved(file)?);
        Ok(run)
    }

    /// Positions of every particle. Both [`Welded`] and the stitching number classes by their first particles.
    fn saved(&self, file: &Path) -> Result<Vec<Vec3>, PipelineError> {
        let surface = read_obj(file)?;
        let mesh = &self.job.mesh;
        let other = |why: String| PipelineError::Saved { file: file.to_owned(), why };
        let (found, expected) = (surface.triangles.len(), mesh.triangles.len());
        if surface.vertices.len() != self.stitching.classes || found != expected {
            let [there, here] = [surface.vertices.len(), self.stitching.classes];
            let (name, spacing) = (&self.job.garment.name, mesh.spacing * MM);
            return Err(other(format!(
                "{found} faces on {there} vertices, but '{name}' has {expected} on {here} at {spacing} mm"
            )));
        }
        let welded = Welded::new(mesh, &self.stitching.class, &vec![Vec3::zeros(); mesh.flat.len()]);
        if surface.triangles != welded.surface.triangles {
            return Err(other(format!("its triangles are not those of '{}'", self.job.garment.name)));
        }
        let nodes: Vec<Vec3> = surface.vertices.iter().map(|p| self.job.body.frame.from_file(p / MM)).collect();
        Ok(self.stitching.spread(&nodes))
    }
}
