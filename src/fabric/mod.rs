//! Fabrics as measured.

/// How a garment file names a fabric: a library name or file, with inline measurements or multipliers on top.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FabricSpec {
    /// Library name (`cotton_poplin`), path, or another fabric of the same garment.
    pub base: Option<String>,
    /// Inline values, key and text as written (`weight: 70 g/m2`, `bend: 2.5`).
    pub values: Vec<(String, String)>,
}

/// Load per width against strain of a woven direction, piecewise linear (F4).
#[derive(Clone, Debug, PartialEq)]
pub struct TensileCurve {
    /// (strain, N/m), rising, first (0, 0); the last slope goes on beyond the last point.
    pub points: Vec<(f64, f64)>,
}

/// A fabric in physical units; every value is there, those not measured are named in `defaults`.
#[derive(Clone, Debug, PartialEq)]
pub struct Fabric {
    /// `cotton_poplin`.
    pub name: String,
    /// kg/m².
    pub areal_density: f64,
    /// Metres.
    pub thickness: f64,
    /// Bending rigidity, N·m (per metre of width), bent along the warp.
    pub bend_warp: f64,
    /// The same along the weft.
    pub bend_weft: f64,
    /// Load–extension along the warp.
    pub warp: TensileCurve,
    /// Load–extension along the weft.
    pub weft: TensileCurve,
    /// Shear stiffness, N/m per radian.
    pub shear: f64,
    /// Coulomb friction against the body and against cloth.
    pub friction: f64,
    /// Where the values come from.
    pub source: String,
    /// Values that were not measured but assumed.
    pub defaults: Vec<String>,
}
