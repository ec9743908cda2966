//! The moment after stitching: crossings left beside the seams are led out, and the cloth gets its own springs.

use super::lead_off::lead_off;
use super::stitch::Stitching;
use super::untangle::untangle;
use crate::contact::{Collider, Neighbourhood};
use crate::dynamics::{Cloth, ContactLaw, Cut, Hardening, Reach, SpringModel, StepError, World};
use crate::geometry::Vec3;

/// Distance kept from the body beyond half the cloth's thickness, metres. A band without ease stands off by it, and
/// every 0.1 mm of it is 0.08 % of a waist.
pub(crate) const CLEARANCE: f64 = 0.25e-3;
/// Stiffness of a contact as it begins, N/m: a particle's weight presses 0.02 mm. Soft, so that a contact that comes or
/// goes does not shake the rest; it hardens as the gap closes.
const PENALTY: f64 = 60.0;
/// Layers are looked for this near, in grid spacings and at most in metres: between two looks a node goes half of it,
/// and must not go further than edges and vertices of the body are looked for.
const REACH: f64 = 0.8;
const LONGEST_REACH: f64 = 8.8e-3;
/// Cloth is looked at at least this far around, beyond its thickness, metres.
pub(crate) const NEAREST_LOOK: f64 = 2e-3;
/// The measured springs pull the cloth true after the last tangle is gone: at most so many steps, until no node goes
/// further than so many metres in one. Cloth that is cut off on its way may pass through itself where it is carried to
/// finer particles.
const SETTLE: usize = 100;
const STILL: f64 = 0.2e-3;
/// Cloth that the body still cuts comes out in a few steps more, or not in many.
const COME_OUT: usize = 20;
/// Cloth that is led off the body then is drawn out, and pulled true in so many steps.
const LED_OFF: usize = 3;
/// The most a step changes an edge, metres: half a cell at the usual spacing.
pub(super) const TRUST: f64 = 5e-3;
/// However badly the model fits, it is trusted so far, metres.
const LEAST_TRUST: f64 = 0.2e-3;
/// Step length, s: long, for inertia only delays rest.
pub(super) const STEP: f64 = 0.1;

/// When newly stitched cloth has settled, its springs not yet still.
/// (What moves then are waves of cloth without weight.)
#[derive(Clone, Copy, Debug)]
pub struct Calm {
    /// Number of the last steps that are looked at.
    steps: usize,
    /// Largest share of the energy by which they may have lowered it.
    share: f64,
}

impl Calm {
    /// For cloth that drapes from where it settles: what it keeps of its energy here takes longer there.
    pub const TO_FALL: Self = Self { steps: 5, share: 0.05 };
    /// For cloth that lies as coarser cloth has settled, and drapes from where that comes to hang. Its pieces are as
    /// large as drawn, to some .1 %, long before the last waves have gone.
    pub const TO_LIE: Self = Self { steps: 5, share: 0.1 };

    /// Whether the last of `energies` is hardly less than it was.
    fn holds(&self, energies: &[f64]) -> bool {
        let last = energies.len() - 1;
        last >= self.steps && energies[last] > (1.0 - self.share) * energies[last - self.steps]
    }
}

/// A sewn garment as one cloth in its measured fabric, ready to settle or to drape.
///
/// # Errors
/// As [`World::new`].
pub fn sewn_world<'a>(
    cut: &Cut,
    body: &'a Collider,
    stitching: &Stitching,
    nodes: Vec<Vec3>,
) -> Result<World<'a>, StepError> {
    let cloth = Cloth::new(cut, stitching.class.clone(), SpringModel::Measured);
    draping_world(cloth, nodes, cut.mesh.spacing, body)
}

/// Cloth of grid spacing `spacing` (metres) at `nodes`, with contact as draped garments have it until they
/// are near their rest ([`World::harden`]).
///
/// # Errors
/// As [`World::new`].
pub fn draping_world(cloth: Cloth, nodes: Vec<Vec3>, spacing: f64, body: &Collider) -> Result<World<'_>, StepError> {
    let hardening = Hardening::Slow;
    let law = ContactLaw { stiffness: PENALTY, hardening, body_clearance: CLEARANCE, cloth_gap: None };
    let reach = Reach::new(drape_reach(spacing, cloth.thickest()));
    let n = nodes.len();
    let hood = Neighbourhood { class: (0..n as u32).collect(), passing: Vec::new() };
    World::new(cloth, nodes, &[], body, hood, law, reach)
}

/// How near layers are looked for in a sewn garment of grid spacing `spacing` and thickness `thick`, metres,
/// while it moves freely.
pub fn drape_reach(spacing: f64, thick: f64) -> f64 {
    (REACH * spacing).min(LONGEST_REACH).max(thick + NEAREST_LOOK)
}

/// Stitches particles that already lie as a sewn garment does: positions of the classes, or `None` where the cloth
/// passes through itself and is not soon led out.
///
/// # Errors
/// As [`World::new`].
pub fn join(
    cut: &Cut,
    body: &Collider,
    stitching: &Stitching,
    particles: &[Vec3],
) -> Result<Option<Vec<Vec3>>, StepError> {
    Ok(joined(cut, body, stitching, particles)?.map(World::into_x))
}

/// [`join`], as a world that goes on from there.
pub(super) fn joined<'a>(
    cut: &Cut,
    body: &'a Collider,
    stitching: &Stitching,
    particles: &[Vec3],
) -> Result<Option<World<'a>>, StepError> {
    let mut world = sewn_world(cut, body, stitching, stitching.welded(particles))?;
    untangle(&mut world)?;
    Ok(world.tangles().is_empty().then_some(world))
}

/// Lets the measured springs pull a newly stitched cloth true, out of its tangles first, until it is `calm` and out of
/// the body. Returns the steps made and the tangles left. `told` is called after every step, so that whoever waits can
/// end the work.
///
/// # Errors
/// As [`World::advance`].
pub fn settle(world: &mut World, calm: Calm, told: &mut dyn FnMut()) -> Result<(usize, usize), StepError> {
    let mut steps = untangle(world)?;
    let mut energies = vec![world.energy()];
    let mut trust = TRUST;
    for _ in 0..SETTLE {
        let step = world.newton(STEP, trust)?;
        trust = step.trust(trust).clamp(LEAST_TRUST, TRUST);
        steps += 1;
        energies.push(world.energy());
        told();
        if step.moved < STILL || calm.holds(&energies) {
            break;
        }
    }
    steps += come_out(world)?;
    Ok((steps, world.tangles().len()))
}

/// Lets the measured springs pull while the body cuts the cloth, at most for [`COME_OUT`] steps; what it still cuts is
/// led off it then. Returns the steps made.
///
/// # Errors
/// As [`World::newton`].
pub(super) fn come_out(world: &mut World) -> Result<usize, StepError> {
    for steps in 0..COME_OUT {
        if !world.is_cut() {
            return Ok(steps);
        }
        world.newton(STEP, TRUST)?;
    }
    if !world.is_cut() {
        return Ok(COME_OUT);
    }
    lead_off(world)?;
    for _ in 0..LED_OFF {
        world.newton(STEP, TRUST)?;
    }
    Ok(COME_OUT + LED_OFF)
}
