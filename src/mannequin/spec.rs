//! A mannequin's numbers as they stand in `mannequins/*.yaml`: millimetres, degrees.

use serde::Deserialize;

use super::{HEIGHTS, MannequinError};
use crate::input::yaml;

/// Metres per unit of these numbers. They are multiplied by it. Dividing by a thousand would change their last digit,
/// so that every garment would start a hair elsewhere and fold differently.
pub(super) const UNIT: f64 = 1e-3;

/// Everything needed to build a mannequin. See `mannequins/woman_92.yaml` for the meaning of each number.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MannequinSpec {
    /// Name, as garments call it.
    pub name: String,
    /// From the floor to the top of the head, which the mannequin does not have. `None` where nobody has said.
    #[serde(default)]
    pub height: Option<f64>,
    /// Trunk and neck, from the crotch up.
    pub torso: Vec<TorsoRow>,
    /// The left leg. The right one mirrors it.
    pub leg: LegSpec,
    /// The left arm. The right one mirrors it.
    pub arm: ArmSpec,
}

/// A horizontal section |2x/w|ⁿ + |2(z−z₀)/d|ⁿ = 1 of the trunk.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorsoRow {
    /// `waist`, `hip` …
    pub name: String,
    /// Height above the floor.
    pub y: f64,
    /// Girth: width and depth are scaled together to reach it exactly.
    pub girth: f64,
    /// Full width.
    pub width: f64,
    /// Full depth.
    pub depth: f64,
    /// Exponent: 2 is an ellipse, more is boxier.
    pub n: f64,
    /// Centre, forward.
    pub z: f64,
}

/// A leg: ellipses one above the other.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LegSpec {
    /// Centre of the leg's first section, which lies at the torso's crotch row.
    pub crotch_x: f64,
    /// Sections from the thigh down.
    pub rows: Vec<LegRow>,
}

/// A horizontal, elliptic section of a leg.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LegRow {
    /// `thigh`, `knee` …
    pub name: String,
    /// Height above the floor.
    pub y: f64,
    /// Girth.
    pub girth: f64,
    /// Centre, sideways.
    pub x: f64,
    /// Centre, forward.
    pub z: f64,
    /// Width over depth.
    pub ratio: f64,
}

/// An arm: ellipses across a straight axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArmSpec {
    /// The acromion, where the shoulder seam ends.
    pub shoulder: [f64; 3],
    /// Start of the axis, under the skin.
    pub joint: [f64; 3],
    /// Degrees between the axis and the vertical, sideways.
    pub abduction: f64,
    /// Degrees between the axis and the vertical, forward.
    pub forward: f64,
    /// Width (in the plane of abduction) over depth.
    pub ratio: f64,
    /// Sections from the shoulder to the wrist.
    pub rows: Vec<ArmRow>,
}

/// An elliptic section of an arm, square to its axis.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ArmRow {
    /// `biceps`, `elbow`, `wrist`.
    pub name: String,
    /// Distance along the arm from the acromion.
    pub at: f64,
    /// Girth.
    pub girth: f64,
}

/// Rows of the torso that the build refers to by name.
const NEEDED: [&str; 5] = ["crotch", "hip", "axilla", "shoulder", "neck base"];
/// Range of exponents of sections. Below it a section is a diamond, above it a box with edges.
const EXPONENTS: std::ops::RangeInclusive<f64> = 1.2..=8.0;

impl MannequinSpec {
    /// Reads and checks a mannequin file's text. `from` names it in errors.
    ///
    /// # Errors
    /// [`MannequinError::Syntax`] with line and column, [`MannequinError::Value`] for numbers no body has.
    pub fn parse(text: &str, from: &str) -> Result<Self, MannequinError> {
        let spec: Self = yaml(text).map_err(|why| MannequinError::Syntax { file: from.to_owned(), why })?;
        spec.check().map_err(|why| MannequinError::Value { file: from.to_owned(), why })?;
        Ok(spec)
    }

    /// The torso row of that name. [`MannequinSpec::parse`] guarantees `crotch`, `hip`, `axilla`, `shoulder` and
    /// `neck base`.
    pub fn torso_row(&self, name: &str) -> Option<&TorsoRow> {
        self.torso.iter().find(|r| r.name == name)
    }

    pub(super) fn check(&self) -> Result<(), String> {
        if self.name.chars().any(char::is_control) {
            return Err(format!("the name {:?} is more than one line of text", self.name));
        }
        for name in NEEDED {
            self.torso_row(name).ok_or_else(|| format!("the torso needs a row named '{name}'"))?;
        }
        if self.torso[0].name != "crotch" || self.torso[1].name != "hip" {
            return Err("the torso's first two rows must be 'crotch' and 'hip'".to_owned());
        }
        if let Some(height) = self.height {
            positive("height", &[height])?;
        }
        self.check_torso()?;
        self.check_leg()?;
        self.check_arm()
    }

    fn check_torso(&self) -> Result<(), String> {
        for row in &self.torso {
            let name = format!("torso row '{}'", row.name);
            positive(&name, &[row.y, row.girth, row.width, row.depth])?;
            finite(&name, &[row.z])?;
            if !EXPONENTS.contains(&row.n) {
                return Err(format!(
                    "{name}: n = {} is not between {} and {}",
                    row.n,
                    EXPONENTS.start(),
                    EXPONENTS.end()
                ));
            }
        }
        let top = self.torso.iter().map(|r| r.y).fold(0.0, f64::max);
        if !HEIGHTS.contains(&(1e-3 * top)) {
            let (low, high) = (1e3 * HEIGHTS.start(), 1e3 * HEIGHTS.end());
            return Err(format!("the body is {top} mm high; it must be {low} to {high} mm, numbers being millimetres"));
        }
        ascending("torso rows", self.torso.iter().map(|r| r.y))
    }

    fn check_leg(&self) -> Result<(), String> {
        for row in &self.leg.rows {
            let name = format!("leg row '{}'", row.name);
            positive(&name, &[row.y, row.girth, row.x, row.ratio])?;
            finite(&name, &[row.z])?;
        }
        let crotch = &self.torso[0];
        positive("leg", &[self.leg.crotch_x, crotch.width / 2.0 - self.leg.crotch_x])?;
        positive("leg at the crotch", &[crotch.girth - 4.0 * self.leg.crotch_x])?;
        ascending("leg rows, from the last up to the crotch,", {
            self.leg.rows.iter().rev().map(|r| r.y).chain([crotch.y])
        })
    }

    fn check_arm(&self) -> Result<(), String> {
        for row in &self.arm.rows {
            positive(&format!("arm row '{}'", row.name), &[row.at, row.girth])?;
        }
        finite("arm", &self.arm.shoulder)?;
        finite("arm", &self.arm.joint)?;
        positive("arm", &[self.arm.ratio, self.arm.joint[0]])?;
        let angles = [self.arm.abduction, self.arm.forward];
        if !angles.iter().all(|a| (0.0..=90.0).contains(a)) {
            return Err(format!("arm: angles {angles:?} are not between 0 and 90 degrees"));
        }
        ascending("arm rows", self.arm.rows.iter().map(|r| r.at))
    }
}

/// Largest number in a body's file, millimetres or degrees. A larger one is in another unit.
const LARGEST: f64 = 5000.0;

fn finite(name: &str, values: &[f64]) -> Result<(), String> {
    match values.iter().find(|v| !v.is_finite() || v.abs() > LARGEST) {
        Some(v) if v.is_finite() => {
            Err(format!("{name}: {v:e} mm is more than {LARGEST} mm, and no body's; numbers are millimetres"))
        }
        Some(v) => Err(format!("{name}: {v} is not a finite number")),
        None => Ok(()),
    }
}

fn positive(name: &str, values: &[f64]) -> Result<(), String> {
    finite(name, values)?;
    match values.iter().find(|v| **v <= 0.0) {
        Some(v) => Err(format!("{name}: {v} is not above zero")),
        None => Ok(()),
    }
}

fn ascending(name: &str, values: impl Iterator<Item = f64>) -> Result<(), String> {
    let values: Vec<f64> = values.collect();
    if values.len() < 2 {
        return Err(format!("{name}: two or more are needed"));
    }
    match values.windows(2).find(|w| w[0] >= w[1]) {
        Some(w) => Err(format!("{name} do not rise: {} is followed by {}", w[0], w[1])),
        None => Ok(()),
    }
}
