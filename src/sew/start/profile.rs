//! How wide a garment is at distances from an opening, and at which height of the trunk it fits so.

use super::axes::Axis;
use super::cloth::Distances;
use super::glue::Glued;
use super::openings::parallels;
use crate::mannequin::PartKind;

/// The girth of the cloth is measured at distances so far apart, metres, so many times.
const STEP: f64 = 0.02;
const STEPS: usize = 16;
/// Heights are tried so far apart, metres.
const TRIAL: f64 = 0.01;
/// Cloth narrower than the body costs so many times as much as cloth that is wider.
const TIGHT: f64 = 30.0;
/// An opening that is wider than the body holds nothing: that costs so many times as much as wide cloth below it.
const HELD: f64 = 8.0;

/// The girth of the cloth along curves parallel to an opening, metres, from the opening on in steps.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    girths: Vec<f64>,
}

impl Profile {
    /// Of an opening of this length from which every node is `far` on the cloth.
    pub(super) fn new(glued: &Glued, cloth: &Distances, length: f64, far: &[f64]) -> Self {
        let beyond = parallels(glued, cloth, far, STEP, STEPS - 1);
        Self { girths: std::iter::once(length).chain(beyond).collect() }
    }
}

/// How far along the trunk or a limb, between two places, an opening lies whose garment hangs from it, metres. The
/// trunk is measured from the crotch upward, a limb from the trunk on.
pub(super) fn best_height(profile: &Profile, axis: &Axis, [from, to]: [f64; 2]) -> f64 {
    let trials = (0..=((to - from) / TRIAL).max(0.0) as usize).map(|k| from + k as f64 * TRIAL);
    let down = if axis.kind == PartKind::Torso { -STEP } else { STEP };
    let cost = |s: f64| {
        let below = profile.girths.iter().enumerate().map(|(k, girth)| ((s + k as f64 * down).max(0.0), k, *girth));
        let part = |(at, k, girth): (f64, usize, f64)| {
            let excess = (girth / axis.girth(at)).ln();
            match excess {
                e if e < 0.0 => TIGHT * e * e,
                e if k == 0 => HELD * e * e,
                e => e * e,
            }
        };
        let costs: Vec<f64> = below.filter(|(_, _, girth)| *girth > 0.0).map(part).collect();
        costs.iter().sum::<f64>() / costs.len().max(1) as f64
    };
    trials.min_by(|a, b| cost(*a).total_cmp(&cost(*b))).unwrap_or(from)
}
