//! Cloth that the body cuts is led off it.

use crate::dynamics::{StepError, World};

/// Rounds of leading the cloth off the body.
const ROUNDS: usize = 100;
/// How far a round moves what is cut, metres: little at first, for most cuts are shallow; as much more again every so
/// many rounds.
const PULL: f64 = 0.3e-3;
const MORE: f64 = 20.0;

/// Moves cloth that a thin part of the body passes through (the rim of an ear, the web of a thumb), with its particles
/// on both sides of it, out over the end of that part. No contact does: each particle is outside. No spring pulls
/// meanwhile. What cannot be led off is left as it was least cut; cloth that would come to pass through itself stays.
///
/// # Errors
/// As [`World::detect`].
pub(crate) fn lead_off(world: &mut World) -> Result<(), StepError> {
    let (from, tangled) = (world.x.clone(), world.tangles().len());
    let (mut cuts, mut ways) = world.ways_off();
    let mut best = (cuts, from.clone());
    for round in 0..ROUNDS {
        if cuts == 0 {
            break;
        }
        let pull = PULL * (1.0 + round as f64 / MORE);
        world.x.iter_mut().zip(&ways).for_each(|(x, way)| *x += way * pull);
        (cuts, ways) = world.ways_off();
        if cuts < best.0 {
            best = (cuts, world.x.clone());
        }
    }
    world.x = best.1;
    if world.tangles().len() > tangled {
        world.x = from;
    }
    world.detect()
}
