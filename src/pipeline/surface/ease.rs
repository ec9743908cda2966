//! Ease of a whole surface: pieces that are cut smaller than they lie flat, for cloth that is stretched when it is worn
//! (swimwear, covers), or larger.

use serde::Serialize;

use crate::geometry::Vec2;

/// By which share pieces are cut larger than they lie flat; negative for smaller.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ease {
    /// Along the grain.
    pub warp: f64,
    /// Across it.
    pub weft: f64,
}

/// Ease as it is reported, with what it does to the cloth: fractions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EaseReport {
    /// Along the grain, negative where pieces are cut smaller.
    pub warp: f64,
    /// Across it.
    pub weft: f64,
    /// By how much the cloth is stretched along the grain on the surface for that alone; negative where it is
    /// compressed.
    pub stretch_warp: f64,
    /// The same across the grain.
    pub stretch_weft: f64,
}

impl Ease {
    /// Where a flat position lies on the piece as it is cut.
    pub(super) fn cut(self, flat: Vec2) -> Vec2 {
        Vec2::new(flat.x * (1.0 + self.weft), flat.y * (1.0 + self.warp))
    }

    /// The area as it is cut, as a share of the flat one.
    pub(super) fn area(self) -> f64 {
        (1.0 + self.warp) * (1.0 + self.weft)
    }

    /// As it is reported; `None` without ease.
    pub(super) fn report(self) -> Option<EaseReport> {
        let stretch = |ease: f64| 1.0 / (1.0 + ease) - 1.0;
        let Self { warp, weft } = self;
        let report = EaseReport { warp, weft, stretch_warp: stretch(warp), stretch_weft: stretch(weft) };
        (self != Self::default()).then_some(report)
    }
}
