//! Fabrics as measured: the shipped library, fabric files, and inline values of a garment file.

use std::ops::RangeInclusive;

mod columns;
mod curve;
mod error;
mod library;
pub mod measure;
mod resolve;
mod sheet;
mod units;

pub use curve::TensileCurve;
pub use error::FabricError;
pub use library::{library, load, load_text, sheet};
pub use resolve::{Context, resolve};
pub use sheet::{FabricSheet, LiuMeasures, Measurement};

/// Gravity, m/s² (standard acceleration, ISO 80000-3).
pub const GRAVITY: f64 = 9.80665;

/// Bending lengths outside which a fabric is doubted, mm.
const BENDING_LENGTHS: RangeInclusive<f64> = 4.0..=100.0;
/// Extensions at 500 gf/cm outside which a fabric is doubted, per cent.
const EXTENSIONS: RangeInclusive<f64> = 0.1..=300.0;
/// Densities outside which a fabric is doubted, kg/m³.
const DENSITIES: RangeInclusive<f64> = 30.0..=3000.0;

/// Reference to a fabric in a garment file: a library name or file, with inline measurements or multipliers on top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FabricSpec {
    /// Library name (`cotton_poplin`), path, or another fabric of the same garment.
    pub base: Option<String>,
    /// Inline values, key and text as written (`weight: 70 g/m2`, `bend: 2.5`). Nested values come as
    /// `tensile.weft.EMT` or as the text of the whole map, `{weft: {EMT: 5 %}}`.
    pub values: Vec<(String, String)>,
}

/// A fabric in physical units. Every value is there. Assumed ones are named in `defaults`.
#[derive(Clone, Debug, PartialEq)]
pub struct Fabric {
    /// `cotton_poplin`.
    pub name: String,
    /// Mass per area, kg/m².
    pub areal_density: f64,
    /// Thickness, metres.
    pub thickness: f64,
    /// Bending rigidity along the warp, N·m (per metre of width).
    pub bend_warp: f64,
    /// Bending rigidity along the weft, N·m (per metre of width).
    pub bend_weft: f64,
    /// Load–extension along the warp.
    pub warp: TensileCurve,
    /// Load–extension along the weft.
    pub weft: TensileCurve,
    /// Shear stiffness, N/m per radian.
    pub shear: f64,
    /// Coulomb friction against the body and against cloth.
    pub friction: f64,
    /// Source of the values.
    pub source: String,
    /// Values that were not measured but assumed.
    pub defaults: Vec<String>,
}

impl Fabric {
    /// EMT along warp and weft: extension under a tensile tester's full load, 500 gf/cm, as fractions.
    pub fn emt(&self) -> [f64; 2] {
        [&self.warp, &self.weft].map(TensileCurve::emt)
    }

    /// Bending length along the warp, metres: c = (B / ρg)^⅓, the scale of the cloth's folds.
    pub fn bending_length_warp(&self) -> f64 {
        self.bending_length_of(self.bend_warp)
    }

    /// Bending length along the weft, metres.
    pub fn bending_length_weft(&self) -> f64 {
        self.bending_length_of(self.bend_weft)
    }

    /// Bending length of the mean of both rigidities, metres.
    pub fn bending_length_mean(&self) -> f64 {
        self.bending_length_of(0.5 * (self.bend_warp + self.bend_weft))
    }

    /// Notes for the user on properties that were not measured.
    pub fn notes(&self) -> Vec<String> {
        let curves = [&self.warp, &self.weft].map(TensileCurve::ends_early);
        let mut ends: Vec<f64> = curves.into_iter().flatten().collect();
        ends.dedup();
        let note = |end: f64| {
            format!(
                "fabric '{}': tensile curve ends at {end:.0} gf/cm; KES runs to 500. Beyond the last point the last \
                 slope is kept",
                self.name
            )
        };
        ends.into_iter().map(note).chain(self.doubts()).collect()
    }

    /// Values that hardly any cloth has: most often a unit is not the one that was meant.
    fn doubts(&self) -> Vec<String> {
        let mut out = Vec::new();
        let is_measured = |key: &str| !self.defaults.iter().any(|d| d == key);
        let length = 1e3 * self.bending_length_mean();
        if !BENDING_LENGTHS.contains(&length) {
            out.push(format!("a bending length of {length:.1} mm, of cloth mostly 8 to 60; look at weight and bend"));
        }
        for (name, emt) in ["warp", "weft"].into_iter().zip(self.emt().map(|e| 100.0 * e)) {
            if is_measured("tensile") && is_measured(&format!("tensile.{name}")) && !EXTENSIONS.contains(&emt) {
                let kind = "of cloth mostly 1 to 100; is the strain in %, and the load in gf/cm?";
                out.push(format!("along the {name} it gives {emt:.3} % under 500 gf/cm, {kind}"));
            }
        }
        let density = self.areal_density / self.thickness;
        if is_measured("thickness") && is_measured("weight") && !DENSITIES.contains(&density) {
            out.push(format!("{density:.0} kg/m3, of cloth mostly 100 to 1500; look at weight and thickness"));
        }
        out.into_iter().map(|doubt| format!("fabric '{}': {doubt}", self.name)).collect()
    }

    fn bending_length_of(&self, rigidity: f64) -> f64 {
        (rigidity / (self.areal_density * GRAVITY)).cbrt()
    }
}
