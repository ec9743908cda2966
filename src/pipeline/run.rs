//! One garment through the stages.

use std::borrow::Cow;
use std::time::{Duration, Instant};

use super::earlier::{Continued, Earlier};
use super::error::PipelineError;
use super::glimpse::Watch;
use super::job::Job;
use super::levels::{COARSE_SHARE, Closed, Coarse};
use super::problems::problems;
use super::surface;
use crate::drape::{DrapeOptions, check_fall, drape};
use crate::dynamics::{ContactTime, identity_nodes};
use crate::flatten::{self, flatten_garment};
use crate::geometry::{MM, Vec2, Vec3};
use crate::report::{ContactSeconds, Drift, FormReport, Measured, Report, Stage, measure};
use crate::sew::start::uncrossed;
use crate::sew::{SewError, SewOptions, Stitching};

/// Told the name of the stage under way and the share of it that is done.
pub type Progress<'a> = &'a mut dyn FnMut(&str, f64);

/// A job under way, with the results of each stage so far.
pub struct Run<'a> {
    pub(super) job: &'a Job,
    /// The particles that are sewn together.
    pub(super) stitching: Stitching,
    /// [`Closed::gaps`].
    pub(super) gaps: Option<Vec<Vec<f64>>>,
    /// Positions of every particle before sewing and after each stage.
    pub(super) placed: Option<Vec<Vec3>>,
    pub(super) sewn: Option<Vec<Vec3>>,
    /// Whether sewing left a seam open. Every particle stands alone then.
    pub(super) open: bool,
    pub(super) draped: Option<Vec<Vec3>>,
    /// Normal force of the body on every class at the end of draping, N.
    pub(super) pressed: Option<Vec<Vec3>>,
    pub(super) flattened: Option<Vec<Vec2>>,
    /// [`Measured::overlaps`].
    overlaps: Option<Vec<usize>>,
    /// By piece, the strain of its threads from flat to draped: warp, weft.
    pub(super) threads: Vec<[f64; 2]>,
    /// The change of form that the pattern is to follow.
    pub(super) form: Option<FormReport>,
    stages: Vec<Stage>,
    /// The coarser level from which the garment was sewn. Draping starts with it.
    coarse: Option<Box<Coarse>>,
    /// The earlier result to go on from.
    pub(super) earlier: Option<Earlier>,
    /// Whether that could not be carried over.
    anew: bool,
    /// Positions of the classes where the earlier garment hangs. Draping starts with them, and nothing is sewn.
    pub(super) hanging: Option<Vec<Vec3>>,
    /// The function that is told of coarser levels, if there is one.
    watch: Option<Watch<'a>>,
}

impl<'a> Run<'a> {
    /// Nothing sewn yet.
    pub fn new(job: &'a Job) -> Self {
        let stages = vec![job.meshing.clone()];
        let stitching = Stitching::new(&job.mesh);
        Self {
            job,
            stitching,
            gaps: None,
            placed: None,
            sewn: None,
            open: false,
            draped: None,
            pressed: None,
            flattened: None,
            overlaps: None,
            threads: Vec::new(),
            form: None,
            stages,
            coarse: None,
            earlier: None,
            anew: false,
            hanging: None,
            watch: None,
        }
    }

    /// The same, with `watch` shown the garment before it is sewn, and told of every coarser level that is sewn or
    /// draped on the way.
    pub fn watched_by(self, watch: Watch<'a>) -> Self {
        Self { watch: Some(watch), ..self }
    }

    fn watch(&self) -> Watch<'a> {
        self.watch.unwrap_or(&|_| {})
    }

    /// Places the pieces round the body and closes the seams.
    ///
    /// # Errors
    /// A piece without a place, or a garment that cannot be sewn.
    pub fn sew(&mut self, progress: Progress) -> Result<(), PipelineError> {
        let job = self.job;
        let begin = Instant::now();
        progress("sew", 0.0);
        let failed = |e| PipelineError::sewing(&job.file, e);
        let mut tell = |share| progress("sew", share);
        let continued = self.earlier.as_ref().and_then(|earlier| job.continued(earlier, &mut tell));
        let closed = match continued {
            Some(Continued::Hanging { stitching, gaps, nodes }) => {
                (self.stitching, self.gaps, self.hanging) = (stitching, Some(gaps), Some(nodes));
                return Ok(());
            }
            Some(Continued::Sewn(closed)) => *closed,
            None => {
                self.anew = self.earlier.is_some();
                self.watch.iter().for_each(|watch| job.look_first(watch));
                let closed = job.sew_from_coarse(&job.mesh, self.watch(), &mut tell);
                closed.inspect_err(|_| self.placed = job.started(&job.mesh)).map_err(failed)?
            }
        };
        let Closed { sewn, gaps, coarse, start } = closed;
        self.coarse = coarse;
        self.placed = start;
        let closed = sewn.closed(&job.mesh, SewOptions::default().tolerance);
        self.stages.push(Stage {
            name: "sew".into(),
            seconds: begin.elapsed().as_secs_f64(),
            iterations: sewn.steps,
            converged: closed.is_ok(),
            ..Stage::default()
        });
        self.gaps = Some(gaps);
        self.open = sewn.open.is_some();
        self.sewn = Some(sewn.open.unwrap_or_else(|| sewn.stitching.spread(&sewn.nodes)));
        self.stitching = sewn.stitching;
        // The state is kept first: a garment that did not close is worth a look.
        closed.map_err(|e| self.obstacle(&e).unwrap_or_else(|| failed(e)))?;
        let too_small = self.sewn.as_deref().and_then(|at| job.too_small(at));
        too_small.map_or(Ok(()), |small| Err(PipelineError::TooSmall(Box::new(small))))
    }

    /// The obstacle that keeps a seam open, if it can be found.
    fn obstacle(&self, error: &SewError) -> Option<PipelineError> {
        let caught = self.job.caught(error, self.sewn.as_deref().unwrap_or_default());
        let caught = caught.map(|caught| PipelineError::Caught(Box::new(caught)));
        caught.or_else(|| self.across(error).map(|across| PipelineError::Across(Box::new(across))))
    }

    /// Drapes the garment, and sews it first if that has not been done.
    ///
    /// # Errors
    /// A garment that cannot be sewn or draped.
    pub fn drape(&mut self, progress: Progress) -> Result<(), PipelineError> {
        if self.sewn.is_none() || self.open {
            self.sew(progress)?;
        }
        let job = self.job;
        let begin = Instant::now();
        let hanging = self.hanging.take();
        let sewn = hanging.clone();
        let sewn = sewn.unwrap_or_else(|| gathered(&self.stitching, self.sewn.as_deref().unwrap_or_default()));
        let mut tell = |share| progress("drape", share);
        let watch = self.watch();
        let from_coarse = |coarse| job.start_from_coarse(&job.mesh, coarse, watch, &mut tell);
        let start = hanging.or_else(|| self.coarse.as_deref().and_then(from_coarse));
        let options = DrapeOptions { near: start.is_some(), ..DrapeOptions::default() };
        let begun = if start.is_some() { COARSE_SHARE } else { 0.0 };
        let mut tell = |share| progress("drape", begun + (1.0 - begun) * share);
        let nodes = start.unwrap_or_else(|| sewn.clone());
        let finest = Instant::now();
        let draped = drape(&job.cut(), &job.collider, &self.stitching, nodes, &options, &mut tell)?;
        check_fall(&job.cut(), &job.collider, &self.stitching, sewn, &draped)?;
        let contact_seconds = Some(contact_seconds(&draped.contact, finest.elapsed()));
        self.stages.push(Stage {
            name: "drape".into(),
            seconds: begin.elapsed().as_secs_f64(),
            iterations: draped.steps,
            converged: draped.converged,
            energy: Some(draped.energy),
            drift: Some(Drift { rms: draped.drift[0] * MM, max: draped.drift[1] * MM }),
            residual: Some(draped.residual),
            contact_seconds,
        });
        self.draped = Some(self.stitching.spread(&draped.nodes));
        let [normal, _] = draped.body_forces;
        self.pressed = Some(normal);
        Ok(())
    }

    /// Lays the draped garment flat. Drapes it first if that has not been done.
    ///
    /// # Errors
    /// A garment that cannot be sewn, draped or laid flat.
    pub fn flatten(&mut self, options: &flatten::FlattenOptions, progress: Progress) -> Result<(), PipelineError> {
        if self.draped.is_none() {
            self.drape(progress)?;
        }
        let begin = Instant::now();
        progress("flatten", 0.0);
        let draped = self.draped.as_deref().unwrap_or_default();
        let flat = flatten_garment(&self.job.mesh, &self.job.garment.seams, draped, options)?;
        progress("flatten", 1.0);
        self.stages.push(surface::stage(flat.pieces.iter().map(|p| p.report), begin));
        self.overlaps = Some(flat.pieces.iter().map(|p| p.report.overlaps).collect());
        self.threads = flat.pieces.iter().map(|p| [p.report.threads.warp_p99, p.report.threads.weft_p99]).collect();
        self.flattened = Some(flat.positions);
        Ok(())
    }

    /// The class of every particle: particles that are stitched together share one.
    pub(super) fn class(&self) -> Cow<'_, [u32]> {
        if self.open { identity_nodes(&self.job.mesh).into() } else { (&self.stitching.class).into() }
    }

    /// The latest positions in space, if the garment has been sewn.
    pub fn last(&self) -> Option<&[Vec3]> {
        self.draped.as_deref().or(self.sewn.as_deref())
    }

    /// Measures the results so far.
    pub fn report(&self) -> Report {
        let gives: Vec<[f64; 2]> = self.job.fabrics.iter().map(|fabric| fabric.emt()).collect();
        let uncrossed = uncrossed(&self.job.garment, &self.job.mesh);
        let mut report = measure(&Measured {
            garment: &self.job.garment,
            mesh: &self.job.mesh,
            weld: &self.class(),
            uncrossed: uncrossed.as_ref(),
            body: &self.job.body,
            fabric: &self.job.fabric_names(),
            gaps: self.gaps.as_deref(),
            placed: self.placed.as_deref(),
            sewn: self.sewn.as_deref(),
            draped: self.draped.as_deref(),
            flattened: self.flattened.as_deref(),
            overlaps: self.overlaps.as_deref(),
            pressed: self.pressed.as_deref(),
            gives: &gives,
            bands: self.job.bands.clone(),
            stages: &self.stages,
        });
        let earlier = self.earlier.as_ref().zip(self.last());
        report.from = earlier.map(|(earlier, at)| earlier.told(&self.job.mesh, at, self.anew));
        report.form.clone_from(&self.form);
        report.problems = problems(self.job, &report).into_iter().map(|problem| problem.text).collect();
        report
    }
}

/// The share that contact has of a drape.
fn contact_seconds(contact: &ContactTime, whole: Duration) -> ContactSeconds {
    let [body, features, cloth, follow, of] =
        [contact.body, contact.features, contact.cloth, contact.follow, whole].map(|d| d.as_secs_f64());
    ContactSeconds { body, features, cloth, follow, of }
}

/// Positions per class from positions per particle, those of a class being equal.
fn gathered(stitching: &Stitching, positions: &[Vec3]) -> Vec<Vec3> {
    let mut nodes = vec![Vec3::zeros(); stitching.classes];
    for (&class, &p) in stitching.class.iter().zip(positions) {
        nodes[class as usize] = p;
    }
    nodes
}
