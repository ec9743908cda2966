//! Cloth that the body cuts is led off it.

use super::untangle::lead;
use crate::dynamics::{StepError, World};
use crate::geometry::Vec3;

/// Rounds of leading the cloth off the body.
const ROUNDS: usize = 100;

/// Moves cloth that a thin part of the body passes through (the rim of an ear, the web of a thumb), with its particles
/// on both sides of it, out over the end of that part. No contact does: each particle is outside. No spring pulls
/// meanwhile. Cloth that cannot be led off is left as it was least cut; cloth that would come to pass through itself
/// stays.
///
/// # Errors
/// As [`World::displace`].
pub(crate) fn lead_off(world: &mut World) -> Result<(), StepError> {
    let tangled = world.tangles().len();
    let shift = |_: &World, x: &mut [Vec3], ways: Vec<Vec3>, pull: f64| {
        x.iter_mut().zip(&ways).for_each(|(x, way)| *x += way * pull);
    };
    let (_, x) = lead(world, ROUNDS, |world, x| world.ways_off(x), shift);
    let stays = world.tangles_at(&x).len() > tangled;
    world.displace(if stays { world.x().to_vec() } else { x })
}
