//! The part of the report on the fit.

use serde::{Deserialize, Serialize};

use super::bands::{Band, Bands};

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
