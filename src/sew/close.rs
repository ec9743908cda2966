//! Drawing the seams shut.

use std::sync::Arc;

use super::error::SewError;
use super::settle::{settle, sewn_world, untangle};
use super::stitch::Stitching;
use crate::contact::{Collider, Neighbourhood};
use crate::dynamics::{Cloth, ContactLaw, Pull, Reach, SpringModel, World, identity_nodes};
use crate::fabric::Fabric;
use crate::geometry::Vec3;
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// How a garment is sewn.
#[derive(Clone, Copy, Debug)]
pub struct SewOptions {
    /// Largest gap of a stitched pair before it is stitched, metres.
    pub tolerance: f64,
    /// Steps after which sewing gives up.
    pub max_steps: usize,
}

impl Default for SewOptions {
    fn default() -> Self {
        Self { tolerance: 1e-3, max_steps: 400 }
    }
}

/// A sewn garment.
#[derive(Clone, Debug)]
pub struct Sewn {
    /// Who is sewn to whom.
    pub stitching: Stitching,
    /// Position of every class.
    pub nodes: Vec<Vec3>,
    /// Gap of every pair of [`Stitching::pairs`] before it was stitched, metres.
    pub gaps: Vec<f64>,
    /// Steps made.
    pub steps: usize,
    /// Crossings of the cloth with itself that could not be led out.
    pub tangles: usize,
}

/// Time step while sewing, s. Inertia is what keeps the pieces apart until the seams have led them home.
const STEP: f64 = 1.0 / 60.0;
/// Share of the velocity that lives on from step to step.
const KEEP: f64 = 0.8;
/// Soft springs while the seams close: N/m, and their share on the bias.
const SOFT: SpringModel = SpringModel::Soft { stiffness: 1000.0, bias: 0.4 };
/// Stitch stiffness, N/m, and the largest force of a pair, N, phase by phase (F5). What closes the last
/// millimetres is the growing cap, not the stiffness.
const PHASES: [(f64, f64); 3] = [(100.0, 0.3), (800.0, 1.0), (6400.0, 4.0)];
/// The first phase ends when no gap is wider than this, metres.
const NEAR: f64 = 7.5e-3;
/// The next phase also begins when the widest gap has not shrunk to this share of itself in so many steps.
const STALL: usize = 6;
const PROGRESS: f64 = 0.8;
/// Classes of three and more particles pull so much harder: closed last they jam.
const JUNCTION: f64 = 8.0;

/// Sews a garment whose particles start at `start`.
///
/// # Errors
/// [`SewError`]: a step that cannot be made, or a seam that does not close.
pub fn sew(
    garment: &Garment,
    mesh: &ClothMesh,
    fabrics: &[Arc<Fabric>],
    body: &Collider,
    start: Vec<Vec3>,
    options: &SewOptions,
    progress: &mut dyn FnMut(f64),
) -> Result<Sewn, SewError> {
    let stitching = Stitching::new(mesh);
    let cloth = Cloth::new(mesh, garment, fabrics, identity_nodes(mesh), SOFT);
    let pairs: Vec<[u32; 2]> = stitching.pairs.iter().map(|p| p.0).collect();
    let h = mesh.spacing;
    let law = ContactLaw { stiffness: 600.0, body_clearance: 1.5e-3, face_clearance: 1.5e-3, cloth_gap: Some(0.1 * h) };
    let reach = Reach { cloth: 1.6 * h, body: 0.02, renew: 0.2 };
    let hood = Neighbourhood { class: stitching.class.clone(), seams: beside_seams(mesh, &stitching, &cloth), tangled: Vec::new() };
    let mut world = World::new(cloth, start, &pairs, body, hood, law, reach)?;

    untangle(&mut world, false)?;
    let mut phase = 0;
    let mut history: Vec<f64> = Vec::new();
    let (mut steps, mut first) = (0, options.tolerance);
    while steps < options.max_steps {
        let gaps = stitching.gaps(&world.x);
        let widest = gaps.iter().copied().fold(0.0, f64::max);
        if std::env::var("TOILE_TRACE").is_ok() {
            let w = (0..gaps.len()).max_by(|&a, &b| gaps[a].total_cmp(&gaps[b])).unwrap(); let at = world.x[stitching.pairs[w].0[0] as usize]; eprintln!("   at {} ({:.0} {:.0} {:.0}) size {}", mesh.seams[stitching.pairs[w].1 as usize].name, 1e3*at.x, 1e3*at.y, 1e3*at.z, stitching.size[stitching.class[stitching.pairs[w].0[0] as usize] as usize]); eprintln!("step {steps} phase {phase} widest {:.2} mm mean {:.2} contacts {}", 1e3 * widest, 1e3 * gaps.iter().sum::<f64>() / gaps.len() as f64, world.contacts().len()); let c=world.contacts(); let ins: Vec<f64> = world.x.iter().filter_map(|p| body.nearest(*p, 0.05)).map(|n| n.distance).filter(|d| *d < 0.0).collect(); eprintln!("   inside {} deepest {:.4}", ins.len(), ins.iter().copied().fold(0.0, f64::min)); eprintln!("   body1 {} body2 {} body3 {} cloth {} residual {:.2}", c.iter().filter(|c|c.body&&c.count==1).count(), c.iter().filter(|c|c.body&&c.count==2).count(), c.iter().filter(|c|c.body&&c.count==3).count(), c.iter().filter(|c|!c.body).count(), world.residual_in_weights());
        }
        if widest <= options.tolerance {
            break;
        }
        if steps == 0 {
            first = widest;
        }
        history.push(widest);
        let stalled = history.len() > STALL && widest > PROGRESS * history[history.len() - 1 - STALL];
        if phase + 1 < PHASES.len() && (stalled || (phase == 0 && widest < NEAR)) {
            phase += 1;
            history.clear();
        }
        let (stiffness, force) = PHASES[phase];
        let pulls: Vec<Pull> = stitching
            .pairs
            .iter()
            .map(|(ends, _)| {
                let junction = stitching.size[stitching.class[ends[0] as usize] as usize] > 2;
                let factor = if junction { JUNCTION } else { 1.0 };
                Pull { ends: *ends, stiffness: stiffness * factor, cap: force / stiffness }
            })
            .collect();
        world.advance(STEP, KEEP, &pulls)?;
        steps += 1;
        // Gaps shrink by decades: the share of the way in their logarithm.
        let way = (first / widest).ln() / (first / options.tolerance).ln().max(1e-9);
        progress(way.clamp(0.0, 1.0));
    }
    let gaps = stitching.gaps(&world.x);
    let nodes = stitching.welded(&world.x);
    let mut world = sewn_world(garment, mesh, fabrics, body, &stitching, nodes)?;
    let (more, tangles) = settle(&mut world)?;
    steps += more;
    Ok(Sewn { nodes: world.x, stitching, gaps, steps, tangles })
}

/// Particle → seams it lies on or next to: while such a seam closes, the cloth beside it may touch itself.
fn beside_seams(mesh: &ClothMesh, stitching: &Stitching, cloth: &Cloth) -> Vec<Vec<u32>> {
    let mut on: Vec<Vec<u32>> = vec![Vec::new(); mesh.flat.len()];
    for (ends, seam) in &stitching.pairs {
        for &p in ends {
            on[p as usize].push(*seam);
        }
    }
    let mut out = on.clone();
    for e in &cloth.edges {
        let (a, b) = (e[0] as usize, e[1] as usize);
        out[a].extend(&on[b]);
        out[b].extend(&on[a]);
    }
    for list in &mut out {
        list.sort_unstable();
        list.dedup();
    }
    out
}
