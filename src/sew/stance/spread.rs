//! How far limbs are spread so that cloth has room between them.

use std::cell::LazyCell;

use super::limbs::{Limbs, apart};
use crate::geometry::Topology;
use crate::mannequin::{JunctionSide, LEVEL, LIMB, LimbSpread, Mannequin, junctions};

/// Spread limbs are apart by this share of how far down it is, metres; further down by this much and the other share of
/// it. The shipped mannequins stand so.
const OPENING: f64 = 0.6;
const ROOM: f64 = 0.02;
const STRIDE: f64 = 0.25;
/// Limbs are spread that come nearer than this share of that.
const NARROW: f64 = 0.4;
/// Nearer to where they join than this, metres, nobody's limbs have room.
const FORK: f64 = 0.06;
/// No limb leans further out than this (tangent).
const LEAN: f64 = 0.6;
/// A spread is smoothed over so many levels up and down.
const SMOOTH: usize = 8;

/// The limbs of `body` that are too near to others to sew between them, and how they are spread; its legs only where
/// cloth goes `between_legs`, which is asked only if they are too near.
pub(super) fn spreads(body: &Mannequin, between_legs: impl FnOnce() -> bool) -> Vec<LimbSpread> {
    let mut mesh = body.mesh.clone();
    let edges = Topology::new(&mesh.triangles).edges;
    let Some(known) = Limbs::new(body) else { return Vec::new() };
    let mut out: Vec<LimbSpread> = Vec::new();
    let between_legs = LazyCell::new(between_legs);
    for junction in junctions(&mesh, &edges, LIMB) {
        let [Some(limb), beside] = known.of(&junction) else { continue };
        if out.iter().any(|spread| spread.kind == limb) {
            continue;
        }
        let levels = junction.levels();
        // Legs come first: spread, they come nearer to the arms.
        let (gaps, way) = apart(&mesh, &junction, &levels);
        let Some(by) = opening(&gaps) else { continue };
        if limb.is_leg() && !*between_legs {
            continue;
        }
        // Of two legs both give way; what an arm hangs beside stays.
        let sides = match beside.filter(|beside| limb.is_leg() && beside.is_leg()) {
            Some(beside) => vec![(JunctionSide::Limb, limb, 0.5), (JunctionSide::Beside, beside, -0.5)],
            None => vec![(JunctionSide::Limb, limb, 1.0)],
        };
        for (side, kind, share) in sides {
            let spread = LimbSpread::new(&junction, side, kind, by.iter().map(|by| by * share * way).collect());
            spread.apply(&mut mesh, 1.0);
            out.push(spread);
        }
    }
    out
}

/// How far apart spread limbs are so far down from where they join, metres.
fn room(down: f64) -> f64 {
    (OPENING * down).min(ROOM + STRIDE * down)
}

/// By how much two limbs with these gaps (metres), level by level, are moved apart; none if they have room. Each level
/// goes at least as far as the one above it.
fn opening(gaps: &[Option<f64>]) -> Option<Vec<f64>> {
    let down = |k: usize| k as f64 * LEVEL;
    let narrow =
        |(k, gap): (usize, &Option<f64>)| down(k) > FORK && gap.is_some_and(|gap| gap < NARROW * room(down(k)));
    if !gaps.iter().enumerate().any(narrow) {
        return None;
    }
    let mut most = 0.0;
    let wanted = |(k, gap): (usize, &Option<f64>)| {
        most = f64::max(most, gap.map_or(0.0, |gap| room(down(k)) - gap));
        most
    };
    let raw: Vec<f64> = gaps.iter().enumerate().map(wanted).collect();
    let at = |k: isize| if k < 0 { 0.0 } else { raw[(k as usize).min(raw.len() - 1)] };
    let smooth = |k: usize| {
        let around = k as isize - SMOOTH as isize..=k as isize + SMOOTH as isize;
        (around.map(at).sum::<f64>() / (2 * SMOOTH + 1) as f64).min(LEAN * down(k))
    };
    Some((0..raw.len()).map(smooth).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limbs_with_room_stay_and_others_open_like_a_fork_from_where_they_join() {
        let apart = |share: f64| (0..100).map(|k| Some(share * room(k as f64 * LEVEL))).collect::<Vec<_>>();
        assert!(opening(&apart(0.5)).is_none());
        let by = opening(&apart(0.3)).expect("narrow");
        assert_eq!(by[0], 0.0);
        for (k, by) in by.iter().enumerate().take(100 - SMOOTH).skip(2 * SMOOTH) {
            let wanted = 0.7 * room(k as f64 * LEVEL);
            assert!((by - wanted).abs() < 0.05 * wanted, "{k}: {by} for {wanted}");
        }
    }

    #[test]
    fn what_is_below_a_narrow_place_goes_as_far_as_that() {
        let mut gaps = vec![Some(0.3); 100];
        gaps[30] = Some(0.0);
        let by = opening(&gaps).expect("narrow");
        assert!((by[99] - room(30.0 * LEVEL)).abs() < 1e-12, "{}", by[99]);
        assert!(by.windows(2).all(|w| w[1] >= w[0]), "{by:?}");
    }
}
