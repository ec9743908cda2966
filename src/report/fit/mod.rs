//! How a garment fits: girths and ease, pressure on the skin, lengths as worn, finished measurements.

mod girths;
mod lengths;
mod places;
mod pressure;
mod remarks;
mod shoulder;

pub(super) use lengths::hems;
pub use pressure::pressure;
pub(super) use remarks::{loosest, tightest};

use super::bands::{Band, Bands};
use super::fit_report::{Finished, Fit, Girth, Pressure, WornLength};
use super::measured::Measured;
use super::openings::SewnRim;
use super::schema::Worn;
use super::strain::thread_strains;
use crate::geometry::{MM, Vec3};
use crate::verify::Welded;

/// Measures the fit of the draped garment `welded`, whose openings have the rows `worn`.
pub(super) fn fit(run: &Measured, at: &[Vec3], welded: &Welded, openings: &[SewnRim], worn: &[Worn]) -> Fit {
    let state = State {
        run,
        welded,
        pressure: run.pressed.map(|forces| pressure(welded, run.weld, forces)),
        used: limit_used(run, at),
    };
    let girths = girths::girths(&state);
    let mut lengths = lengths::openings(worn, run.body);
    lengths.extend(lengths::crotch(welded, worn, run.body));
    lengths.extend(shoulder::shoulders(run.mesh, welded, openings, run.body));
    let mut finished: Vec<Finished> =
        girths.iter().map(|girth| Finished { name: girth.name.clone(), value: girth.flat }).collect();
    let opening = |w: &Worn| Finished { name: format!("{} opening", w.opening), value: w.length_flat };
    finished.extend(worn.iter().map(opening));
    let remarks = remarks::remarks(&girths, &run.bands);
    Fit { girths, lengths, finished, remarks, bands: run.bands.clone() }
}

/// The garment on the body, with what is known of every place.
struct State<'a> {
    run: &'a Measured<'a>,
    welded: &'a Welded,
    /// Pa, per vertex of the surface. `None` where the forces are not known.
    pressure: Option<Vec<f64>>,
    /// Per particle, its larger thread extension as a share of what the fabric gives.
    used: Vec<f64>,
}

/// Share of the fabric's extension under full load that every particle's threads use.
fn limit_used(run: &Measured, at: &[Vec3]) -> Vec<f64> {
    let strains = thread_strains(run.mesh, at);
    let mut out = vec![0.0; strains.len()];
    for (piece, gives) in run.mesh.pieces.iter().zip(run.gives) {
        for particle in piece.particles.clone() {
            let share = |k: usize| strains[particle][k].max(0.0) / gives[k].max(f64::MIN_POSITIVE);
            out[particle] = share(0).max(share(1));
        }
    }
    out
}

/// `left front` and the like: the side of a body part on which a point lies.
fn side(from: Vec3, point: Vec3) -> String {
    /// Sine of the angle off a direction beyond which the next one is named as well: 22.5°, half an eighth of a turn.
    const ASIDE: f64 = 0.3827;
    let off = Vec3::new(point.x - from.x, 0.0, point.z - from.z);
    let Some(way) = off.try_normalize(0.0) else { return String::new() };
    let word = |share: f64, positive: &'static str, negative: &'static str| match share {
        s if s > ASIDE => Some(positive),
        s if s < -ASIDE => Some(negative),
        _ => None,
    };
    let words = [word(way.x, "left", "right"), word(way.z, "front", "back")];
    words.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// Millimetres to a hundredth of a micrometre: rounding of metres is not shown.
fn mm(metres: f64) -> f64 {
    (metres * MM * 1e5).round() / 1e5
}
