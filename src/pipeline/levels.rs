//! Coarse to fine: a garment is sewn and draped on a coarse mesh first, where a step costs little and moves folds far.
//! The result is the start of the next finer mesh (cascadic multigrid; Bornemann and Deuflhard 1996).

use super::glimpse::{Glimpse, Reached, Watch};
use super::job::Job;
use crate::drape::{DrapeOptions, Until, drape};
use crate::dynamics::Cut;
use crate::geometry::Vec3;
use crate::mesh::{self, ClothMesh, Transfer};
use crate::sew::place::{PlaceError, positioned};
use crate::sew::start::{SPACING, start_at};
use crate::sew::{SewError, SewOptions, Sewn, Stitching, join, sew, sewn_on, stitch};

/// Ratio of spacings between neighbouring levels.
const COARSER: f64 = 2.0;
/// Largest spacing of a level, metres. A wrist then has seven cells round it, and a waistband of 40 mm two across.
/// Skirts and trousers begun at 28 to 32 mm came to rest no sooner.
const COARSEST: f64 = 0.025;
/// Least ratio of spacings at which a coarser level pays.
const LEAST: f64 = 1.5;
/// Spacings of the meshes on which a garment starts, metres: on the next where a seam stays open, or cloth is left
/// caught on the body or in itself. Other particles lie elsewhere: a wrist cuts the cuff of a hooded sweatshirt that
/// starts at 25 or at 28 mm, and not at 22. Under arms that hang close to the trunk a shirt started at 25 mm stays open
/// at its armpit, and one started at 22 mm closes.
const START_MESHES: [f64; 2] = [SPACING, 0.022];
/// Share of a stage's progress that its coarser levels take.
pub(super) const COARSE_SHARE: f64 = 0.3;

/// A garment with its seams closed.
pub(super) struct Closed {
    pub(super) sewn: Sewn,
    /// For every seam the gaps of its pairs before they were stitched, metres, on the mesh whose seams were drawn shut.
    pub(super) gaps: Vec<Vec<f64>>,
    /// The coarser one it was made from.
    pub(super) coarse: Option<Box<Coarse>>,
    /// Start positions of its particles, on whichever mesh its seams were drawn shut.
    pub(super) start: Option<Vec<Vec3>>,
}

/// A coarser mesh of a garment with its seams closed.
pub(super) struct Coarse {
    mesh: ClothMesh,
    closed: Closed,
}

impl Job {
    /// Sews `mesh`: coarser first, where that goes; else from where the file positions the pieces, or from the
    /// topology. `watch` is told of the coarser levels.
    ///
    /// # Errors
    /// A piece without a place, or a garment that cannot be sewn.
    pub(super) fn sew_from_coarse(
        &self,
        mesh: &ClothMesh,
        watch: Watch,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Closed, SewError> {
        if let Some(coarse) = self.coarser(mesh, watch, &mut |share| progress(COARSE_SHARE * share)) {
            // What does not come out whole begins anew, as it would without a coarser level.
            if let Some((sewn, gaps)) = self.carried(&coarse, mesh, &mut || progress(COARSE_SHARE)) {
                let start = coarse.closed.start.as_ref().map(|x| Transfer::new(&coarse.mesh, mesh).apply(x));
                return Ok(Closed { sewn, gaps, coarse: Some(coarse), start });
            }
        }
        if let Some(start) = self.positioned(mesh) {
            let closed = self.sew_here(mesh, start.clone(), SewOptions::default(), progress)?;
            return Ok(Closed { start: Some(start), ..closed });
        }
        self.sew_from_topology(mesh, progress)
    }

    /// `mesh` sewn from starts that its topology gives: from the first of which it comes out whole, or else from the
    /// first of all.
    fn sew_from_topology(&self, mesh: &ClothMesh, progress: &mut dyn FnMut(f64)) -> Result<Closed, SewError> {
        let mut sewn_at = |spacing| self.sew_from(mesh, self.topological(spacing, mesh)?, progress);
        let [first, others @ ..] = START_MESHES;
        let closed = sewn_at(first)?;
        if is_whole(mesh, &closed.sewn) {
            return Ok(closed);
        }
        let again = others.into_iter().filter_map(|spacing| sewn_at(spacing).ok());
        Ok(again.into_iter().find(|again| is_whole(mesh, &again.sewn)).unwrap_or(closed))
    }

    /// `mesh` sewn from `start`, where most of it lies as a sewn garment does.
    ///
    /// # Errors
    /// A garment that cannot be sewn.
    pub(super) fn sew_from(
        &self,
        mesh: &ClothMesh,
        start: Vec<Vec3>,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Closed, SewError> {
        let options = SewOptions { joined: true, ..SewOptions::default() };
        let closed = self.sew_here(mesh, start.clone(), options, progress)?;
        Ok(Closed { start: Some(start), ..closed })
    }

    /// Start positions of `mesh`, of which a positioned garment's are given. `None` where it has none.
    pub(super) fn started(&self, mesh: &ClothMesh) -> Option<Vec<Vec3>> {
        self.positioned(mesh).or_else(|| self.topological(SPACING, mesh).ok())
    }

    /// Start positions of `mesh` that the file gives, if it gives them.
    fn positioned(&self, mesh: &ClothMesh) -> Option<Vec<Vec3>> {
        positioned(&self.garment, mesh)
    }

    /// Start positions of `mesh` from the garment's topology, by way of a mesh of this spacing, metres.
    fn topological(&self, spacing: f64, mesh: &ClothMesh) -> Result<Vec<Vec3>, PlaceError> {
        let (body, collider) = sewn_on(self.stance.as_ref(), &self.body, &self.collider);
        start_at(spacing, &self.garment, mesh, body, collider)
    }

    /// Draws the seams of `mesh` itself shut.
    fn sew_here(
        &self,
        mesh: &ClothMesh,
        start: Vec<Vec3>,
        options: SewOptions,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Closed, SewError> {
        let cut = self.cut_of(mesh);
        let sewn = match &self.stance {
            Some(stance) => stance.sew(&cut, &self.collider, start, &options, progress)?,
            None => sew(&cut, &self.collider, start, &options, progress)?,
        };
        Ok(Closed { gaps: sewn.gaps_of_seams(mesh), sewn, coarse: None, start: None })
    }

    /// The next coarser level, sewn. None where the garment cannot be meshed or sewn so coarse.
    fn coarser(&self, mesh: &ClothMesh, watch: Watch, progress: &mut dyn FnMut(f64)) -> Option<Box<Coarse>> {
        let spacing = (COARSER * mesh.spacing).min(COARSEST);
        if spacing < LEAST * mesh.spacing {
            return None;
        }
        let mesh = mesh::build(&self.garment, spacing).ok()?;
        let closed = self.sew_from_coarse(&mesh, watch, progress).ok()?;
        is_whole(&mesh, &closed.sewn).then(|| {
            let coarse = Box::new(Coarse { mesh, closed });
            coarse.show(&coarse.closed.sewn.nodes, Reached::Sewn, watch);
            coarse
        })
    }

    /// `mesh` stitched where a coarser one's particles lie, and the gaps of that one. None where it comes out torn or
    /// crossed. `told` is called after every step.
    fn carried(&self, coarse: &Coarse, mesh: &ClothMesh, told: &mut dyn FnMut()) -> Option<(Sewn, Vec<Vec<f64>>)> {
        let closed = &coarse.closed;
        let particles = coarse.carry(&closed.sewn.nodes, mesh);
        let mut sewn = stitch(&self.cut_of(mesh), &self.collider, &particles, told).ok().flatten()?;
        sewn.steps += closed.sewn.steps;
        is_whole(mesh, &sewn).then(|| (sewn, closed.gaps.clone()))
    }

    /// Start positions for draping `mesh`, from the draped coarser level, of which `watch` is told. `None` if that
    /// level cannot be draped, or gives no whole garment.
    pub(super) fn start_from_coarse(
        &self,
        mesh: &ClothMesh,
        coarse: &Coarse,
        watch: Watch,
        progress: &mut dyn FnMut(f64),
    ) -> Option<Vec<Vec3>> {
        let Closed { sewn, coarse: coarser, .. } = &coarse.closed;
        let lower = coarser.as_deref().and_then(|lower| self.start_from_coarse(&coarse.mesh, lower, watch, progress));
        let options = DrapeOptions { until: Until::Near, near: lower.is_some(), ..DrapeOptions::default() };
        let start = lower.unwrap_or_else(|| sewn.nodes.clone());
        let mut tell = |share| progress(COARSE_SHARE * share);
        let cut = self.cut_of(&coarse.mesh);
        let draped = drape(&cut, &self.collider, &sewn.stitching, start, &options, &mut tell).ok()?;
        coarse.show(&draped.nodes, Reached::Draped, watch);
        let start = coarse.carry(&draped.nodes, mesh);
        join(&self.cut_of(mesh), &self.collider, &Stitching::new(mesh), &start).ok().flatten()
    }

    fn cut_of<'a>(&'a self, mesh: &'a ClothMesh) -> Cut<'a> {
        Cut { mesh, ..self.cut() }
    }
}

impl Coarse {
    /// Shows this level with its classes at `nodes`.
    fn show(&self, nodes: &[Vec3], reached: Reached, watch: Watch) {
        let stitching = &self.closed.sewn.stitching;
        watch(&Glimpse { mesh: &self.mesh, class: &stitching.class, at: &stitching.spread(nodes), reached });
    }

    /// Positions of the particles of `mesh` from those of this level's classes.
    fn carry(&self, nodes: &[Vec3], mesh: &ClothMesh) -> Vec<Vec3> {
        Transfer::new(&self.mesh, mesh).apply(&self.closed.sewn.stitching.spread(nodes))
    }
}

/// Whether all seams have closed, and the cloth passes neither through itself nor through the body.
pub(super) fn is_whole(mesh: &ClothMesh, sewn: &Sewn) -> bool {
    sewn.tangles == 0 && !sewn.is_cut && sewn.closed(mesh, SewOptions::default().tolerance).is_ok()
}

#[cfg(test)]
mod tests {
    use std::cell::RefCell;
    use std::path::Path;

    use super::*;
    use crate::picture::PictureLayout;
    use crate::pipeline::{Overrides, Run, read};

    fn skirt(spacing: f64) -> Job {
        job("patterns/gore_skirt.yaml", spacing)
    }

    fn job(garment: &str, spacing: f64) -> Job {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(garment);
        let overrides = Overrides { spacing: Some(spacing), ..Overrides::default() };
        Job::new(&file, read(&file).expect("read"), &overrides).expect("job")
    }

    fn pairs(mesh: &ClothMesh) -> Vec<usize> {
        mesh.seams.iter().map(|seam| seam.pairs.len()).collect()
    }

    fn counts(gaps: &[Vec<f64>]) -> Vec<usize> {
        gaps.iter().map(Vec::len).collect()
    }

    #[test]
    fn a_garment_carried_over_tells_the_gaps_and_the_steps_of_the_one_that_was_sewn() {
        let job = skirt(0.014);
        let mesh = mesh::build(&job.garment, 0.014).expect("meshed");
        let mut told = Vec::new();
        let closed = job.sew_from_coarse(&mesh, &|_| {}, &mut |share| told.push(share)).expect("sewn");
        let coarse = closed.coarse.as_deref().expect("a coarser level");
        assert_eq!(counts(&closed.gaps), pairs(&coarse.mesh));
        assert_eq!(closed.gaps, coarse.closed.sewn.gaps_of_seams(&coarse.mesh));
        assert!(closed.sewn.steps > coarse.closed.sewn.steps, "settling takes steps of its own");
        // Each is told, so that it can be the last.
        let own = closed.sewn.steps - coarse.closed.sewn.steps;
        let settling = told.iter().filter(|share| **share >= COARSE_SHARE).count();
        assert!(2 * settling > own, "{settling} of {own} steps");
    }

    /// At 24 mm the start on the first mesh leaves this sweatshirt cut by a wrist.
    #[test]
    fn what_is_caught_on_the_body_starts_anew_on_another_mesh() {
        let file = "../shared/cases/sew/fs_hugo_hood.yaml";
        if !Path::new(env!("CARGO_MANIFEST_DIR")).join(file).is_file() {
            println!("skipped: {file} is not there");
            return;
        }
        let job = job(file, 0.024);
        let mesh = mesh::build(&job.garment, 0.024).expect("meshed");
        let closed = job.sew_from_topology(&mesh, &mut |_| {}).expect("sewn");
        assert!(is_whole(&mesh, &closed.sewn));
    }

    /// Points between the particles of a coarser level lie in one plane within rounding, which is no crossing.
    #[test]
    fn cloth_of_large_flat_cells_can_be_carried_over() {
        let job = job("tests/scenes/sheet_on_sphere.yaml", 0.016);
        let closed = job.sew_from_coarse(&job.mesh, &|_| {}, &mut |_| {});
        let coarse = closed.expect("nothing to sew").coarse.expect("a coarser level");
        assert!(job.start_from_coarse(&job.mesh, &coarse, &|_| {}, &mut |_| {}).is_some());
    }

    #[test]
    fn a_garment_is_shown_as_it_begins_and_a_coarser_level_once_it_is_sewn_and_once_it_is_draped() {
        let job = skirt(0.015);
        let seen = RefCell::new(Vec::new());
        let watch = |glimpse: &Glimpse| {
            assert_eq!(glimpse.at.len(), glimpse.class.len());
            let lowest = glimpse.at.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
            seen.borrow_mut().push((glimpse.mesh.spacing, glimpse.reached, lowest));
            let picture = job.draw_glimpse(glimpse, &PictureLayout::default()).expect("a picture");
            assert!(picture.starts_with(b"\x89PNG"));
        };
        let mut run = Run::new(&job).watched_by(&watch);
        run.drape(&mut |_, _| {}).expect("draped");
        let seen = seen.into_inner();
        let [begun, sewn, draped] = seen[..] else { panic!("{seen:?}") };
        assert!(begun.0 > COARSEST && begun.1 == Reached::Begun, "{begun:?}");
        assert_eq!([(sewn.0, sewn.1), (draped.0, draped.1)], [(COARSEST, Reached::Sewn), (COARSEST, Reached::Draped)]);
        assert_ne!(sewn.2, draped.2, "the hem hangs elsewhere once the skirt is draped");
    }
}
