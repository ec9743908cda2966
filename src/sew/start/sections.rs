//! Sections of a garment's legs, which are held round the axes while the garment is inflated.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::balloon::Held;
use super::harmonic::{Limb, OpeningRing};

/// Sections are so far apart on the cloth, metres: two rows of a start mesh, so that each has nodes all round.
const STEP: f64 = 0.05;
/// Cloth that leaves a larger gap than this round the axis, radians, is no tube there: it goes on to the trunk.
const OPEN: f64 = FRAC_PI_2;

/// The sections of the tube round a leg, from its ring up to where it opens towards the trunk: pressure would press
/// their inner sides against the axes. None of an arm, which may be wide and hang below it.
pub(super) fn sections(ring: &OpeningRing, limb: &Limb) -> Vec<Held> {
    let Some(along) = ring.along.filter(|_| !limb.axis.kind.is_arm()) else { return Vec::new() };
    let is_own = |n: usize| limb.other.is_none_or(|other| limb.distance[n] < other[n]);
    let own: Vec<usize> = (0..limb.distance.len()).filter(|n| limb.distance[*n].is_finite() && is_own(*n)).collect();
    let mut of: Vec<Vec<u32>> = vec![Vec::new(); ((along + STEP) / STEP) as usize];
    for n in own {
        if let Some(section) = of.get_mut((limb.distance[n] / STEP) as usize) {
            section.push(n as u32);
        }
    }
    let is_round = |nodes: &Vec<u32>| gap(nodes.iter().map(|n| limb.angles[*n as usize])) < OPEN;
    of.into_iter()
        .enumerate()
        .take_while(|(_, nodes)| is_round(nodes))
        .map(|(k, rim)| {
            let station = limb.axis.station(along - (k as f64 + 0.5) * STEP);
            Held { by: rim.clone(), rim, middle: station.center, limb: None, along: Some(station.axis) }
        })
        .collect()
}

/// The largest gap between angles on the circle, radians.
fn gap(angles: impl Iterator<Item = f64>) -> f64 {
    let mut all: Vec<f64> = angles.map(|a| a.rem_euclid(TAU)).collect();
    all.sort_unstable_by(f64::total_cmp);
    let (Some(first), Some(last)) = (all.first(), all.last()) else { return TAU };
    let across = TAU - (last - first);
    all.windows(2).map(|pair| pair[1] - pair[0]).fold(across, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_gap_goes_round() {
        assert!((gap([0.0, 1.0, 2.0].into_iter()) - (TAU - 2.0)).abs() < 1e-12);
        assert!((gap([-0.5, 0.5, 3.0].into_iter()) - (TAU - 3.5)).abs() < 1e-12);
        assert!((gap([0.3].into_iter()) - TAU).abs() < 1e-12);
        assert!((gap(std::iter::empty()) - TAU).abs() < 1e-12);
    }
}
