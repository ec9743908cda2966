//! Colours: the paper, the mannequin, the pieces and the strain scale.
//!
//! Shades are chosen in Oklab (lightness, then two hues), where equal steps look equal. Light and cloth multiply. Both
//! are kept as displayed (gamma-encoded) values, since a power law of a product is the product of the power laws.

/// Red, green, blue as displayed, 0 to 1.
pub(super) type Rgb = [f32; 3];

/// The exponent of displays.
const GAMMA: f32 = 2.2;

/// The paper.
pub(super) const PAPER: Rgb = [0.965, 0.957, 0.945];
/// The mannequin: matte linen.
pub(super) const BODY: Rgb = [0.86, 0.835, 0.80];
/// Text.
pub(super) const INK: Rgb = [0.20, 0.19, 0.21];
/// Lesser text.
pub(super) const PALE_INK: Rgb = [0.47, 0.45, 0.46];
/// Seams on the cloth.
pub(super) const SEAM: Rgb = [0.25, 0.23, 0.27];
/// Rims of the cloth.
pub(super) const RIM: Rgb = [0.36, 0.33, 0.36];

/// The axes of the body.
pub(super) const AXIS: Rgb = [0.12, 0.11, 0.13];

/// A linear light value as displayed.
pub(super) fn displayed(linear: f32) -> f32 {
    linear.max(0.0).powf(1.0 / GAMMA)
}

/// Turning by the golden angle (degrees) never comes near an earlier hue soon.
const GOLDEN_ANGLE: f32 = 137.507_77;

/// The right side of a piece: gentle, and as far as can be from the pieces just before it.
pub(super) fn piece(index: u32) -> Rgb {
    /// The first piece is a soft blue.
    const FIRST_HUE: f32 = 245.0;
    // A step of lightness tells neighbours apart in grey as well.
    let lightness = if index.is_multiple_of(2) { 0.83 } else { 0.77 };
    oklch(lightness, 0.062, FIRST_HUE + GOLDEN_ANGLE * index as f32)
}

/// The wrong side of cloth whose right side has this colour: darker and greyer.
pub(super) fn wrong_side(right: Rgb) -> Rgb {
    let grey = (right[0] + right[1] + right[2]) / 3.0;
    right.map(|x| 0.72 * (0.6 * x + 0.4 * grey))
}

/// The rim of an opening: strong, and as far as can be from those just before it.
pub(super) fn opening(index: usize) -> Rgb {
    /// The first rim is red.
    const FIRST_HUE: f32 = 27.0;
    oklch(0.58, 0.19, FIRST_HUE + GOLDEN_ANGLE * index as f32)
}

/// The strain scale: blue for −1 (shorter), paper grey for 0, red for 1 (longer). Lightness falls evenly to both ends.
pub(super) fn strain(share: f32) -> Rgb {
    let end = if share < 0.0 { lab(0.47, 0.15, 262.0) } else { lab(0.50, 0.18, 27.0) };
    let middle = lab(0.93, 0.008, 95.0);
    let t = share.abs().min(1.0);
    from_oklab([0, 1, 2].map(|k| middle[k] + t * (end[k] - middle[k])))
}

fn oklch(lightness: f32, chroma: f32, hue: f32) -> Rgb {
    from_oklab(lab(lightness, chroma, hue))
}

fn lab(lightness: f32, chroma: f32, hue: f32) -> [f32; 3] {
    let (sin, cos) = hue.to_radians().sin_cos();
    [lightness, chroma * cos, chroma * sin]
}

/// Oklab (B. Ottosson, 2020) to displayed values.
fn from_oklab([l, a, b]: [f32; 3]) -> Rgb {
    let long = (l + 0.396_337_78 * a + 0.215_803_76 * b).powi(3);
    let medium = (l - 0.105_561_346 * a - 0.063_854_17 * b).powi(3);
    let short = (l - 0.089_484_18 * a - 1.291_485_5 * b).powi(3);
    [
        4.076_741_7 * long - 3.307_711_6 * medium + 0.230_969_94 * short,
        -1.268_438 * long + 2.609_757_4 * medium - 0.341_319_38 * short,
        -0.004_196_086_3 * long - 0.703_418_6 * medium + 1.707_614_7 * short,
    ]
    .map(|x| displayed(x.min(1.0)))
}
