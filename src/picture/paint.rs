//! Colour of every corner of every triangle before lighting.

use super::color::{Rgb, piece, strain, wrong_side};
use super::{Scale, Scene};

/// The strain scale does not end below this: smaller strains are noise of the mesh.
const SMALLEST_LIMIT: f64 = 0.005;

/// Share of the vertices whose strain the scale must reach.
const REACHED: f64 = 0.99;

/// Colouring of the cloth.
pub(super) enum Paint {
    /// One colour per piece.
    Pieces(Vec<Rgb>),
    /// By value: one colour per vertex, and the value at the end of the scale.
    Values(Vec<Rgb>, Scale, f64),
}

impl Paint {
    pub(super) fn new(scene: &Scene) -> Self {
        if let Some((values, scale)) = scene.values {
            let limit = limit(values);
            return Self::Values(values.iter().map(|v| scale.color((v / limit) as f32)).collect(), scale, limit);
        }
        let last = scene.piece_of_triangle.iter().max().copied().unwrap_or(0);
        Self::Pieces((0..=last).map(piece).collect())
    }

    /// Colours of the corners of a cloth triangle, seen from its right or its wrong side.
    pub(super) fn corners(&self, scene: &Scene, triangle: usize, right_side: bool) -> [Rgb; 3] {
        let of_right = match self {
            Self::Pieces(colors) => [colors[scene.piece_of(triangle) as usize]; 3],
            Self::Values(colors, ..) => scene.cloth.triangles[triangle].map(|v| colors[v as usize]),
        };
        if right_side { of_right } else { of_right.map(wrong_side) }
    }
}

impl Scale {
    /// The colour of a value, as a share of the value at the scale's end.
    pub(super) fn color(self, share: f32) -> Rgb {
        match self {
            Self::Strain | Self::Pressure => strain(share),
            // What touches the skin is as red as what is drawn out.
            Self::Ease => strain(1.0 - 2.0 * share.max(0.0)),
        }
    }
}

/// A round number (1, 2 or 5 times a power of ten) that nearly all values stay below.
pub(super) fn limit(values: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|v| v.abs()).filter(|v| v.is_finite()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let last = sizes.len().saturating_sub(1) as f64;
    let wanted = sizes.get((REACHED * last) as usize).copied().unwrap_or(0.0).max(SMALLEST_LIMIT);
    let decade = 10f64.powf(wanted.log10().floor());
    // A rounding error in the logarithm must not push a limit of exactly 1, 2 or 5 up to the next one.
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
    steps.into_iter().find(|s| *s >= wanted * (1.0 - 1e-9)).unwrap_or(wanted)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_round() {
        assert_eq!(limit(&[0.013; 10]), 0.02);
        assert_eq!(limit(&[0.02, -0.02]), 0.02);
        assert!((limit(&[0.3, f64::NAN]) - 0.5).abs() < 1e-12);
        assert_eq!(limit(&[]), SMALLEST_LIMIT);
    }
}
