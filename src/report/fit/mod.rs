//! How a garment fits: girths and ease, pressure on the skin, lengths as worn, finished measurements.

mod bands;
mod girths;
mod lengths;
mod places;
mod pressure;
mod remarks;
mod shoulder;

pub use bands::{Band, Bands};
pub(super) use lengths::hems;
pub use pressure::pressure;
pub(super) use remarks::{loosest, tightest};

use serde::{Deserialize, Serialize};

use super::measure::Measured;
use super::openings::SewnRim;
use super::schema::Worn;
use super::strain::thread_strains;
use crate::geometry::{MM, Vec3};
use crate::verify::Welded;

/// The fit of a draped garment. Lengths in mm, pressures in kPa.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// One per girth of the body that the garment goes round.
    pub girths: Vec<Girth>,
    /// Where openings, crotch and shoulders are on the body.
    pub lengths: Vec<WornLength>,
    /// Measurements of the garment laid flat, as size tables have them.
    pub finished: Vec<Finished>,
    /// The fit in words, the tightest place first.
    pub remarks: Vec<String>,
    /// Limits of the bands of pressure.
    pub bands: Bands,
}

/// The garment at one girth of the body.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Girth {
    /// `bust`, `left biceps`.
    pub name: String,
    /// Height at which the garment is measured, mm. Of the trunk up to 60 mm below the body's girth, where the cloth
    /// belongs to the sleeves as well.
    pub height: f64,
    /// Girth of the body as a tape reads it, mm.
    pub body: f64,
    /// Length of the cloth once round there, mm.
    pub garment: f64,
    /// The same cloth as it was cut, mm.
    pub flat: f64,
    /// The garment's girth less the body's, mm.
    pub ease: f64,
    /// Pressure on the skin round there. `null` where the forces are not known.
    pub pressure: Option<Pressure>,
    /// Band of the largest pressure.
    pub band: Option<Band>,
    /// Side of the body with the largest pressure: `left front`.
    pub side: Option<String>,
    /// Largest extension of a thread round there, as a share of what its fabric gives under 500 gf/cm.
    pub cloth: f64,
}

/// Pressure on the skin, kPa.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pressure {
    /// Mean round the body.
    pub mean: f64,
    /// Largest, as a sensor of 30 mm reads it.
    pub max: f64,
}

/// A length as worn.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct WornLength {
    /// The opening, seam or place of the garment.
    pub name: String,
    /// Distance beyond or above what it is measured against, mm.
    pub value: f64,
    /// `floor`, `left wrist`, `crotch`, `left shoulder`.
    pub against: String,
    /// Height of the highest point of an opening above its lowest, mm.
    pub level: Option<f64>,
}

/// A measurement of the garment laid flat.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Finished {
    /// `bust`, `hem opening`.
    pub name: String,
    /// Length, mm.
    pub value: f64,
}

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
