//! Drawing the seams shut.

use std::collections::HashMap;

use super::error::SewError;
use super::recover::lead_out;
use super::settle::{Calm, joined, settle, sewn_world};
use super::stitch::Stitching;
use super::untangle::untangle;
use crate::contact::{Collider, Neighbourhood};
use crate::dynamics::{Cloth, ContactLaw, Cut, Hardening, Pull, Reach, SpringModel, World, identity_nodes, tacked};
use crate::geometry::{Vec3, sorted_pair};
use crate::mesh::ClothMesh;

/// How a garment is sewn.
#[derive(Clone, Copy, Debug)]
pub struct SewOptions {
    /// Largest gap of a stitched pair before it is stitched, metres.
    pub tolerance: f64,
    /// Steps after which sewing gives up.
    pub max_steps: usize,
    /// Whether pieces start joined at their seams: then none is moved out of the body by itself.
    pub joined: bool,
}

impl Default for SewOptions {
    fn default() -> Self {
        Self { tolerance: 1e-3, max_steps: 400, joined: false }
    }
}

/// A sewn garment.
#[derive(Clone, Debug)]
pub struct Sewn {
    /// The particles that are sewn together.
    pub stitching: Stitching,
    /// Position of every class.
    pub nodes: Vec<Vec3>,
    /// Gap of every pair of [`Stitching::pairs`] before it was stitched, metres.
    pub gaps: Vec<f64>,
    /// Steps made.
    pub steps: usize,
    /// Crossings of the cloth with itself that could not be led out.
    pub tangles: usize,
    /// Whether the body cuts an edge of the cloth; not asked while a seam is open.
    pub is_cut: bool,
    /// Where every particle lies, if a seam did not close: nothing has been stitched then.
    pub open: Option<Vec<Vec3>>,
}

impl Sewn {
    /// Gaps by seam and pair of the mesh, metres; [`Self::gaps`] has a pair that two seams share once.
    pub fn gaps_of_seams(&self, mesh: &ClothMesh) -> Vec<Vec<f64>> {
        let pairs = self.stitching.pairs.iter().map(|(ends, _)| sorted_pair(*ends));
        let of_pair: HashMap<[u32; 2], f64> = pairs.zip(self.gaps.iter().copied()).collect();
        // A pair of one particle with itself (the tip of a dart) is never open.
        let gap = |ends: &[u32; 2]| of_pair.get(&sorted_pair(*ends)).copied().unwrap_or(0.0);
        mesh.seams.iter().map(|seam| seam.pairs.iter().map(gap).collect()).collect()
    }

    /// Whether every seam has closed to within `tolerance` metres.
    ///
    /// # Errors
    /// [`SewError::Open`] with the seam whose gap is widest.
    pub fn closed(&self, mesh: &ClothMesh, tolerance: f64) -> Result<(), SewError> {
        let widest = (0..self.gaps.len()).max_by(|&a, &b| self.gaps[a].total_cmp(&self.gaps[b]));
        let Some(widest) = widest.filter(|&w| self.gaps[w] > tolerance) else { return Ok(()) };
        let (ends, seam) = self.stitching.pairs[widest];
        let piece = |p: u32| mesh.piece_of(p).map_or_else(String::new, |i| mesh.pieces[i].name.clone());
        Err(SewError::Open {
            seam: mesh.seams[seam as usize].name.clone(),
            gap_mm: 1e3 * self.gaps[widest],
            limit_mm: 1e3 * tolerance,
            iterations: self.steps,
            piece_a: piece(ends[0]),
            piece_b: piece(ends[1]),
        })
    }
}

/// Time step while sewing, s. Inertia is what keeps the pieces apart until the seams have led them home.
const STEP: f64 = 1.0 / 60.0;
/// Share of the velocity that lives on from step to step.
const KEEP: f64 = 0.8;
/// Contact while the seams close: N/m as it begins, metres kept from the body beyond half the cloth's thickness, and
/// the distance layers keep, in grid spacings and at most in metres: rims that lie on each other have to come nearer
/// than a stitch may be long.
const PENALTY: f64 = 600.0;
const CLEARANCE: f64 = 1.5e-3;
const GAP: f64 = 0.1;
const WIDEST_GAP: f64 = 0.9e-3;
/// Soft springs while the seams close: N/m, and their share on the bias.
const SOFT: SpringModel = SpringModel::Soft { stiffness: 1000.0, bias: 0.4 };
/// Stitch stiffness, N/m, and the largest force of a pair, N, phase by phase (F5). The growing cap
/// closes the last millimetres, not the stiffness.
const PHASES: [(f64, f64); 3] = [(100.0, 0.3), (800.0, 1.0), (6400.0, 4.0)];
/// The first phase ends when no gap is wider than this, metres.
const NEAR: f64 = 7.5e-3;
/// The next phase also begins when the widest gap has not shrunk to this share of itself in so many steps.
const STALL: usize = 6;
const PROGRESS: f64 = 0.8;
/// In the last phase, pairs that have not closed by as much in so many steps are stuck: the garment is tight there, or
/// their rims lie folded over one another. Every stitch then pulls twice as hard, up to so many times; near pairs and
/// their neighbours let each other pass besides, and what is tangled once they are stitched is led out.
const STUCK: usize = 12;
const HARDER: i32 = 4;
/// Pairs that pull their hardest are given up when the widest gap has not come below this share of its least in so many
/// steps. Of thirty garments that close none waits for more than 54, dungarees whose straps cross wait for 280 of 400.
const SHRUNK: f64 = 0.95;
const GIVEN_UP: usize = 100;
/// Classes of three and more particles pull so much harder: closed last they jam.
const JUNCTION: f64 = 8.0;

/// Closures are done up when no two points of theirs are further apart than this, metres: the layers between them, and
/// what particles lie beside the points.
const DONE_UP: f64 = 5e-3;

/// Layers are looked for this near while the seams close, in grid spacings.
const REACH: f64 = 1.6;

/// Sews a garment whose particles start at `start`.
///
/// # Errors
/// [`SewError`]: a piece that starts in the body, or a step that cannot be made. A seam that does not close is no error
/// yet: see [`Sewn::open`] and [`Sewn::closed`].
pub fn sew(
    cut: &Cut,
    body: &Collider,
    mut start: Vec<Vec3>,
    options: &SewOptions,
    progress: &mut dyn FnMut(f64),
) -> Result<Sewn, SewError> {
    let mesh = cut.mesh;
    let stitching = Stitching::new(mesh);
    if !options.joined {
        lead_out(cut, body, &mut start)?;
    }
    let cloth = Cloth::new(cut, identity_nodes(mesh), SOFT);
    let tacks: Vec<[u32; 2]> = tacked(mesh, cut.garment).filter(|[a, b]| a != b).collect();
    let pairs: Vec<[u32; 2]> = stitching.pairs.iter().map(|p| p.0).chain(tacks.iter().copied()).collect();
    let h = mesh.spacing;
    let (hardening, cloth_gap) = (Hardening::Slow, Some((GAP * h).min(WIDEST_GAP)));
    let law = ContactLaw { stiffness: PENALTY, hardening, body_clearance: CLEARANCE, cloth_gap };
    let reach = Reach::new(REACH * h);
    let hood = Neighbourhood { class: stitching.class.clone(), passing: Vec::new() };
    let mut world = World::new(cloth, start, &pairs, body, hood, law, reach)?;
    untangle(&mut world)?;
    let mut closing = Closing::new(mesh, &stitching, tacks, options.tolerance);
    let (mut steps, stages) = (0, closing.harder.len());
    for stage in 0..stages {
        let mut tell = |way: f64| progress((stage as f64 + way) / stages as f64);
        steps += closing.close(&mut world, stage, options.max_steps - steps, &mut tell)?;
    }
    steps += closing.do_up(&mut world, options.max_steps - steps)?;
    let (gaps, nodes) = (stitching.gaps(world.x()), stitching.welded(world.x()));
    if gaps.iter().any(|gap| *gap > options.tolerance) {
        let tangles = world.tangles().len();
        return Ok(Sewn { stitching, nodes, gaps, steps, tangles, is_cut: false, open: Some(world.into_x()) });
    }
    let world = sewn_world(cut, body, &stitching, nodes)?;
    let mut sewn = settled(world, stitching, gaps, Calm::TO_FALL, &mut || progress(1.0))?;
    sewn.steps += steps;
    Ok(sewn)
}

/// How long the widest gap has hardly shrunk.
struct Wait {
    /// The least it was when it last shrank, metres, and the step of that.
    least: f64,
    since: usize,
}

impl Wait {
    fn look(&mut self, widest: f64, step: usize) {
        if widest < SHRUNK * self.least {
            (self.least, self.since) = (widest, step);
        }
    }

    fn is_over(&self, step: usize) -> bool {
        step - self.since >= GIVEN_UP
    }
}

/// The seams on their way shut, stage by stage.
struct Closing<'a> {
    stitching: &'a Stitching,
    /// The pairs that closures tie: drawn together with the seams, as a wearer does them up.
    tacks: Vec<[u32; 2]>,
    /// How many times they pull twice as hard as at first.
    tighter: i32,
    /// Metres.
    tolerance: f64,
    /// The stage of every pair, counted from 0.
    stage: Vec<usize>,
    /// How many times the pairs of every stage pull twice as hard as at first.
    harder: Vec<i32>,
    /// Which particles may pass through one another; none if empty.
    passing: Vec<bool>,
}

impl<'a> Closing<'a> {
    fn new(mesh: &ClothMesh, stitching: &'a Stitching, tacks: Vec<[u32; 2]>, tolerance: f64) -> Self {
        let mut stages: Vec<i32> = mesh.seams.iter().map(|seam| seam.stage).collect();
        stages.sort_unstable();
        stages.dedup();
        let of = |seam: u32| stages.partition_point(|s| *s < mesh.seams[seam as usize].stage);
        let stage = stitching.pairs.iter().map(|(_, seam)| of(*seam)).collect();
        Self {
            stitching,
            tacks,
            tighter: 0,
            tolerance,
            stage,
            harder: vec![0; stages.len().max(1)],
            passing: Vec::new(),
        }
    }

    /// Closes the seams of a `stage` and keeps those of earlier ones closed. Returns the steps that took, at most
    /// `max_steps`; what is open then is left where its widest gap was the least.
    fn close(
        &mut self,
        world: &mut World,
        stage: usize,
        max_steps: usize,
        progress: &mut dyn FnMut(f64),
    ) -> Result<usize, SewError> {
        let mut phase = 0;
        let mut history: Vec<f64> = Vec::new();
        let mut first = None;
        let mut best: Option<(f64, Vec<Vec3>)> = None;
        let mut wait = Wait { least: f64::INFINITY, since: 0 };
        let mut made = 0;
        while made < max_steps && !(self.harder[stage] == HARDER && wait.is_over(made)) {
            let gaps = self.stitching.gaps(world.x());
            let widest = self.widest(&gaps, stage);
            if widest <= self.tolerance {
                return Ok(made);
            }
            wait.look(widest, made);
            if best.as_ref().is_none_or(|best| widest < best.0) {
                best = Some((widest, world.x().to_vec()));
            }
            let first = *first.get_or_insert(widest);
            history.push(widest);
            if phase + 1 < PHASES.len() {
                if is_stuck(&history, STALL) || (phase == 0 && widest < NEAR) {
                    phase += 1;
                    history.clear();
                }
            } else if is_stuck(&history, STUCK) {
                self.harder[stage] = (self.harder[stage] + 1).min(HARDER);
                if widest < NEAR {
                    self.let_pass(world, &gaps, stage)?;
                }
                history.clear();
            }
            world.advance(STEP, KEEP, &self.pulls(stage, phase))?;
            // Gaps shrink by decades: the share of the way in their logarithm.
            let way = (first / widest).ln() / (first / self.tolerance).ln().max(1e-9);
            progress(way.clamp(0.0, 1.0));
            made += 1;
        }
        if let Some((widest, x)) = best
            && widest < self.widest(&self.stitching.gaps(world.x()), stage)
        {
            world.displace(x)?;
        }
        Ok(made)
    }

    /// Goes on with closed seams while what closures tie comes nearer, in at most `max_steps`, so that a garment does
    /// not fall while it is open. A step that tears a seam open, which does not close again, is left undone. Returns
    /// the steps that took.
    fn do_up(&mut self, world: &mut World, max_steps: usize) -> Result<usize, SewError> {
        let last = self.harder.len().saturating_sub(1);
        let is_open = |own: &Self, x: &[Vec3]| own.widest(&own.stitching.gaps(x), last) > own.tolerance;
        let (mut steps, mut history, closed) = (0, Vec::new(), world.x().to_vec());
        if self.tacks.is_empty() || is_open(self, &closed) {
            return Ok(0);
        }
        while steps < max_steps {
            let apart = self.tacks.iter().map(|[a, b]| (world.x()[*a as usize] - world.x()[*b as usize]).norm());
            let widest = apart.fold(0.0, f64::max);
            history.push(widest);
            let is_stuck = is_stuck(&history, STUCK);
            if widest <= DONE_UP || is_stuck && self.tighter == HARDER {
                break;
            }
            if is_stuck {
                self.tighter += 1;
                history.clear();
            }
            world.advance(STEP, KEEP, &self.pulls(last, PHASES.len() - 1))?;
            steps += 1;
        }
        steps += self.close(world, last, max_steps - steps, &mut |_| {})?;
        if is_open(self, world.x()) {
            world.displace(closed)?;
        }
        Ok(steps)
    }

    /// The widest of the `gaps` of pairs that pull in a `stage`, metres.
    fn widest(&self, gaps: &[f64], stage: usize) -> f64 {
        gaps.iter().zip(&self.stage).filter(|(_, of)| **of <= stage).map(|(gap, _)| *gap).fold(0.0, f64::max)
    }

    /// The pull of the pairs while those of a `stage` are in a `phase`: those of earlier stages pull as they did last,
    /// those of later ones with nothing. Tacks pull as seams do in the phase, and harder where they are stuck.
    fn pulls(&self, stage: usize, phase: usize) -> Vec<Pull> {
        let pull = |(ends, &of): (&[u32; 2], &usize)| {
            let (stiffness, force) = PHASES[if of < stage { PHASES.len() - 1 } else { phase }];
            let junction = self.stitching.size[self.stitching.class[ends[0] as usize] as usize] > 2;
            let factor = if junction { JUNCTION } else { 1.0 } * 2f64.powi(self.harder[of]);
            let stiffness_now = if of > stage { 0.0 } else { stiffness * factor };
            Pull { ends: *ends, stiffness: stiffness_now, cap: force / stiffness }
        };
        let (stiffness, force) = PHASES[phase];
        let tighter = stiffness * 2f64.powi(self.tighter);
        let tacks = self.tacks.iter().map(|&ends| Pull { ends, stiffness: tighter, cap: force / stiffness });
        self.stitching.pairs.iter().map(|p| &p.0).zip(&self.stage).map(pull).chain(tacks).collect()
    }

    /// Lets what lies beside pairs that are open pass through itself, and what was let pass before.
    fn let_pass(&mut self, world: &mut World, gaps: &[f64], stage: usize) -> Result<(), SewError> {
        let pairs = self.stitching.pairs.iter().zip(gaps).zip(&self.stage);
        let open = pairs.filter(|((_, gap), of)| **of <= stage && **gap > self.tolerance);
        let jammed = neighbourhood(world, open.flat_map(|(((ends, _), _), _)| ends));
        self.passing.resize(jammed.len(), false);
        self.passing.iter_mut().zip(jammed).for_each(|(passing, jammed)| *passing |= jammed);
        Ok(world.set_passing(self.passing.clone())?)
    }
}

/// Whether the last of the widest gaps has hardly shrunk in so many steps.
fn is_stuck(history: &[f64], steps: usize) -> bool {
    let last = history.len().saturating_sub(1);
    last >= steps && history[last] > PROGRESS * history[last - steps]
}

/// These nodes and one ring round them.
fn neighbourhood<'a>(world: &World, nodes: impl Iterator<Item = &'a u32>) -> Vec<bool> {
    let mut core = vec![false; world.x().len()];
    nodes.for_each(|n| core[*n as usize] = true);
    world.cloth.with_neighbours(&core)
}

/// Stitches particles that already lie as those of a sewn garment do, as a coarser one's have come to lie. `None` where
/// the cloth passes through itself and is not soon led out. `told` is called after every step.
///
/// # Errors
/// [`SewError`]: a step that cannot be made.
pub fn stitch(
    cut: &Cut,
    body: &Collider,
    particles: &[Vec3],
    told: &mut dyn FnMut(),
) -> Result<Option<Sewn>, SewError> {
    let stitching = Stitching::new(cut.mesh);
    let gaps = stitching.gaps(particles);
    let world = joined(cut, body, &stitching, particles)?;
    world.map(|world| settled(world, stitching, gaps, Calm::TO_LIE, told)).transpose()
}

/// Lets a garment with its seams closed settle.
fn settled(
    mut world: World,
    stitching: Stitching,
    gaps: Vec<f64>,
    calm: Calm,
    told: &mut dyn FnMut(),
) -> Result<Sewn, SewError> {
    let (steps, tangles) = settle(&mut world, calm, told)?;
    let is_cut = world.is_cut();
    Ok(Sewn { nodes: world.into_x(), stitching, gaps, steps, tangles, is_cut, open: None })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gap_that_shrinks_is_waited_for_and_one_that_does_not_is_given_up() {
        let mut wait = Wait { least: f64::INFINITY, since: 0 };
        for step in 0..300 {
            // It halves every 20 steps, and then stays.
            wait.look(0.1 * 0.5f64.powi(step.min(100) / 20), step as usize);
            assert_eq!(wait.is_over(step as usize), step >= 200, "step {step}");
        }
    }
}
