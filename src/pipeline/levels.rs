//! From coarse to fine: a garment is sewn and draped with few particles first, where a step costs little and carries
//! folds far, and what comes out is where more particles start (cascadic multigrid; Bornemann and Deuflhard 1996).

use super::job::Job;
use crate::drape::{DrapeOptions, Until, drape};
use crate::dynamics::Cut;
use crate::geometry::Vec3;
use crate::mesh::{self, ClothMesh, Transfer};
use crate::sew::place::place;
use crate::sew::{SewError, SewOptions, Sewn, Stitching, join, sew, stitch};

/// How much coarser each level is than the next.
const COARSER: f64 = 2.0;
/// No level is coarser than this, metres: a waistband of 40 mm can just be meshed then, and a wrist has seven cells round
/// it. Skirts and trousers begun at 28 to 32 mm came to rest no sooner.
const COARSEST: f64 = 0.025;
/// A level has to be so much coarser to pay.
const LEAST: f64 = 1.5;
/// Share of a stage's progress that its coarser levels are.
pub(super) const COARSE_SHARE: f64 = 0.3;

/// A garment with its seams closed.
pub(super) struct Closed {
    pub(super) sewn: Sewn,
    /// The coarser one it was made from.
    pub(super) coarse: Option<Box<Coarse>>,
}

/// A coarser mesh of a garment with its seams closed.
pub(super) struct Coarse {
    mesh: ClothMesh,
    closed: Closed,
}

impl Job {
    /// Sews `mesh`: coarser first, where that goes, else from `start`.
    ///
    /// # Errors
    /// A garment that cannot be sewn.
    pub(super) fn sew_from_coarse(
        &self,
        mesh: &ClothMesh,
        start: Vec<Vec3>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Closed, SewError> {
        let (cut, options) = (self.cut_of(mesh), SewOptions::default());
        if let Some(coarse) = self.coarser(mesh, &mut |share| progress(COARSE_SHARE * share)) {
            let sewn = stitch(&cut, &self.collider, &coarse.carry(&coarse.closed.sewn.nodes, mesh)).ok().flatten();
            // What does not come out whole begins anew, as it would without a coarser level.
            if let Some(sewn) = sewn.filter(|sewn| is_whole(mesh, sewn)) {
                return Ok(Closed { sewn, coarse: Some(coarse) });
            }
        }
        let sewn = sew(&cut, &self.collider, start, &options, progress)?;
        Ok(Closed { sewn, coarse: None })
    }

    /// The next coarser level, sewn; none where the garment cannot be meshed or sewn so coarse.
    fn coarser(&self, mesh: &ClothMesh, progress: &mut dyn FnMut(f64)) -> Option<Box<Coarse>> {
        let spacing = (COARSER * mesh.spacing).min(COARSEST);
        if spacing < LEAST * mesh.spacing {
            return None;
        }
        let mesh = mesh::build(&self.garment, spacing).ok()?;
        let start = place(&self.garment, &mesh, &self.body, &self.collider).ok()?;
        let closed = self.sew_from_coarse(&mesh, start, progress).ok()?;
        is_whole(&mesh, &closed.sewn).then(|| Box::new(Coarse { mesh, closed }))
    }

    /// Where the nodes of a garment on `mesh` begin to drape: as the coarser one has come to hang. None where that cannot
    /// be had, or gives no whole garment.
    pub(super) fn start_from_coarse(
        &self,
        mesh: &ClothMesh,
        coarse: &Coarse,
        progress: &mut dyn FnMut(f64),
    ) -> Option<Vec<Vec3>> {
        let Closed { sewn, coarse: coarser } = &coarse.closed;
        let lower = coarser.as_deref().and_then(|lower| self.start_from_coarse(&coarse.mesh, lower, progress));
        let options = DrapeOptions { until: Until::Near, near: lower.is_some(), ..DrapeOptions::default() };
        let start = lower.unwrap_or_else(|| sewn.nodes.clone());
        let mut tell = |share| progress(COARSE_SHARE * share);
        let cut = self.cut_of(&coarse.mesh);
        let draped = drape(&cut, &self.collider, &sewn.stitching, start, &options, &mut tell).ok()?;
        let start = coarse.carry(&draped.nodes, mesh);
        join(&self.cut_of(mesh), &self.collider, &Stitching::new(mesh), &start).ok().flatten()
    }

    fn cut_of<'a>(&'a self, mesh: &'a ClothMesh) -> Cut<'a> {
        Cut { mesh, ..self.cut() }
    }
}

impl Coarse {
    /// Positions of the particles of `mesh` from those of this level's classes.
    fn carry(&self, nodes: &[Vec3], mesh: &ClothMesh) -> Vec<Vec3> {
        Transfer::new(&self.mesh, mesh).apply(&self.closed.sewn.stitching.spread(nodes))
    }
}

/// Whether all seams have closed and the cloth does not pass through itself.
fn is_whole(mesh: &ClothMesh, sewn: &Sewn) -> bool {
    sewn.tangles == 0 && sewn.closed(mesh, SewOptions::default().tolerance).is_ok()
}
