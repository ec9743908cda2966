//! Bands of pressure.

use serde::{Deserialize, Serialize};

/// Band of a pressure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Band {
    /// Comfortable all day.
    #[serde(rename = "ok")]
    Ok,
    /// Felt as tight.
    #[serde(rename = "tight")]
    Tight,
    /// Not worn willingly.
    #[serde(rename = "too tight")]
    TooTight,
}

impl Band {
    /// `ok`, `tight`, `too tight`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Tight => "tight",
            Self::TooTight => "too tight",
        }
    }
}

/// Limits of the bands, kPa, and their source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bands {
    /// From here on cloth is tight.
    pub tight: f64,
    /// Above this it is too tight.
    pub too_tight: f64,
    /// Source of the two.
    pub source: String,
}

/// Pressures of waistbands, kPa. A waistband that fits well pressed with 17.5 mmHg on the average, and wearers
/// complained from 35 mmHg on (measured on women by a hydrostatic method: Sen'i Gakkaishi 47 (6), 1991, page 282).
const WAIST: [f64; 2] = [2.3, 4.7];

impl Default for Bands {
    fn default() -> Self {
        let source = "waistbands that fit well press with 2.3 kPa (17.5 mmHg), wearers complain from 4.7 kPa (35 mmHg) \
                      on: Sen'i Gakkaishi 47 (6), 1991, p. 282; --pressure-bands sets others";
        Self { tight: WAIST[0], too_tight: WAIST[1], source: source.into() }
    }
}

/// Cloth never presses so hard, kPa.
const MOST: f64 = 1e3;

impl Bands {
    /// Limits of the caller's own, kPa. `None` of what are no two rising pressures.
    pub fn given(tight: f64, too_tight: f64) -> Option<Self> {
        let are_rising = tight > 0.0 && (tight..MOST).contains(&too_tight);
        are_rising.then(|| Self { tight, too_tight, source: "given with --pressure-bands".into() })
    }

    /// Band of a pressure in kPa.
    pub fn of(&self, pressure: f64) -> Band {
        match pressure {
            p if p > self.too_tight => Band::TooTight,
            p if p >= self.tight => Band::Tight,
            _ => Band::Ok,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_band_begins_at_its_limit() {
        let bands = Bands::default();
        let of = [2.29, 2.3, 4.7, 4.71].map(|p| bands.of(p).name());
        assert_eq!(of, ["ok", "tight", "tight", "too tight"]);
        assert_eq!(Bands::given(1.0, 2.0).expect("rising").of(1.5), Band::Tight);
    }
}
