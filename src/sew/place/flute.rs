//! The waves (flutes) of a circle skirt: a cone that is shorter round than its cloth, which meanders about it.
//!
//! ```text
//!        seen from above                       cut through a crest and a valley
//!     ╭──╮    ╭──╮                                   axis
//!    ╱    ╲  ╱    ╲    cloth                          │ ╲ ╲ ╲
//!  ─────────────────── cone                           │  ╲  ╲   ╲  crest
//!          ╲╱                                         │ valley cone
//! ```

use std::f64::consts::{PI, TAU};

use crate::geometry::bisect;

/// A full circle of cloth lies in so many waves: skirts of cotton hang in seven to ten.
const WAVES: f64 = 8.0;
/// The largest angle, radians, between the meandering cloth and the cone: it touches itself from 2.2 on.
const STEEPEST: f64 = 1.8;
/// A crest rises over the cone by no more than this share of its way down the skirt: the share of what the cone itself
/// widens, so that valleys do not run back to the axis.
const RISE: f64 = 0.85;
/// Steps of the table along a radius, and along a wave.
const RADII: usize = 64;
const PHASES: usize = 64;

/// Mean of cos(ω sin s) over a wave, the Bessel function J₀(ω): how much shorter cloth becomes that meanders so
/// steeply.
fn shortening(steepest: f64) -> f64 {
    (0..PHASES).map(|k| (steepest * (TAU * k as f64 / PHASES as f64).sin()).cos()).sum::<f64>() / PHASES as f64
}

/// How short meandering may make cloth: the share of its length that is left.
pub(super) fn shortest() -> f64 {
    shortening(STEEPEST)
}

/// So many whole waves has cloth that opens by `angle` radians.
pub(super) fn waves(angle: f64) -> f64 {
    (WAVES * angle / TAU).round().max(1.0)
}

/// Where the cloth of half a wave is, from a crest at s = 0 to the valley, in wavelengths of cloth over 2 π: along the
/// cone, and off it. Its direction is −ω sin s (a sine-generated curve).
fn meander(steepest: f64) -> Vec<[f64; 2]> {
    let step = PI / PHASES as f64;
    let mut at = [0.0; 2];
    let mut curve = vec![at];
    for k in 0..PHASES {
        let angle = -steepest * ((k as f64 + 0.5) * step).sin();
        at = [at[0] + step * angle.cos(), at[1] + step * angle.sin()];
        curve.push(at);
    }
    let middle = 0.5 * at[1];
    curve.iter_mut().for_each(|p| p[1] -= middle);
    curve
}

/// A point of the cloth against the cone.
#[derive(Clone, Copy, Debug, Default)]
struct Lies {
    /// Share of a wavelength it is ahead of where it would be without waves.
    ahead: f64,
    /// Off the cone, metres.
    off: f64,
    /// Down the cone from the waist, metres.
    down: f64,
}

/// Waves on a cone, by the distance from the apex in the flat cloth and the share of a wave from its crest.
pub(super) struct Flutes {
    inner: f64,
    outer: f64,
    /// Sine and cosine of the angle between the cone and its axis.
    slope: [f64; 2],
    /// By radius, then by phase from crest to valley.
    table: Vec<Vec<Lies>>,
    /// How much the cone through the valleys widens as it goes down.
    valleys: f64,
}

/// Where a point of the cloth lies, seen from the cone through the valleys.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fluted {
    /// Share of a wavelength it is ahead of where it would be without waves.
    pub(super) ahead: f64,
    /// Under the waist, metres.
    pub(super) down: f64,
    /// Off the cone through the valleys at that height, metres.
    pub(super) out: f64,
    /// How much the cone through the valleys has widened there: its radius less the waist's, metres.
    pub(super) wider: f64,
}

impl Flutes {
    /// Waves of cloth that opens by `opening` radians in all, between two radii, on a cone that widens by `slope` for a
    /// metre of its side. One wave spans `wave` radians of the cloth.
    pub(super) fn new([inner, outer]: [f64; 2], opening: f64, slope: f64, wave: f64) -> Self {
        let radius = |k: usize| inner + (outer - inner) * k as f64 / RADII as f64;
        let rise = RISE * slope;
        let mut table: Vec<Vec<Lies>> = Vec::with_capacity(RADII + 1);
        for k in 0..=RADII {
            let (r, below) = (radius(k), radius(k) - inner);
            let round = (opening * inner + TAU * slope * below) / (opening * r);
            let wanted = bisect([0.0, STEEPEST], 40, |w| round.min(1.0) - shortening(w));
            // Cloth that would have to rise more steeply than it is long stays a little crowded.
            let length = wave * r / TAU;
            let height = |w: f64| length * meander(w)[0][1];
            let highest = bisect([0.0, STEEPEST], 40, |w| height(w) - rise * below);
            let steepest = wanted.min(highest);
            let (curve, short) = (meander(steepest), shortening(steepest));
            let lies = |(j, p): (usize, &[f64; 2])| {
                let ahead = p[0] / (TAU * short) - 0.5 * j as f64 / PHASES as f64;
                let off = length * p[1];
                let down = table.last().map_or(0.0, |above| {
                    let (step, climb) = ((outer - inner) / RADII as f64, off - above[j].off);
                    above[j].down + (step * step - climb * climb).max(0.0).sqrt()
                });
                Lies { ahead, off, down }
            };
            let row = curve.iter().enumerate().map(lies).collect();
            table.push(row);
        }
        let slope = [slope, (1.0 - slope * slope).max(0.0).sqrt()];
        let mut flutes = Self { inner, outer, slope, table, valleys: 0.0 };
        let falls = flutes.table.iter().skip(1).flatten().map(|lies| flutes.fallen(lies));
        flutes.valleys = falls.map(|[down, wider]| wider / down).fold(f64::INFINITY, f64::min).max(0.0);
        flutes
    }

    /// Under the waist, and how much further from the axis.
    fn fallen(&self, lies: &Lies) -> [f64; 2] {
        let [sine, cosine] = self.slope;
        [cosine * lies.down - sine * lies.off, sine * lies.down + cosine * lies.off]
    }

    /// Where the point at radius `r` lies that is `phase` waves beyond a crest.
    pub(super) fn at(&self, r: f64, phase: f64) -> Fluted {
        let phase = phase.rem_euclid(1.0);
        // From crest to valley, and back as in a mirror.
        let (half, sign) = if phase > 0.5 { (1.0 - phase, -1.0) } else { (phase, 1.0) };
        let (k, f) = cell(RADII, (r - self.inner) / (self.outer - self.inner));
        let (j, g) = cell(PHASES, 2.0 * half);
        let corners = [[k, j], [k, j + 1], [k + 1, j], [k + 1, j + 1]].map(|[k, j]| self.table[k][j]);
        let shares = [(1.0 - f) * (1.0 - g), (1.0 - f) * g, f * (1.0 - g), f * g];
        let mean = |of: fn(&Lies) -> f64| corners.iter().zip(shares).map(|(lies, share)| share * of(lies)).sum::<f64>();
        let lies = Lies { ahead: mean(|l| l.ahead), off: mean(|l| l.off), down: mean(|l| l.down) };
        let [down, out] = self.fallen(&lies);
        let wider = self.valleys * down;
        Fluted { ahead: sign * lies.ahead, down, out: out - wider, wider }
    }
}

/// The cell of a table of so many that a share lies in, and how far.
fn cell(cells: usize, share: f64) -> (usize, f64) {
    let at = share.clamp(0.0, 1.0) * cells as f64;
    let cell = (at as usize).min(cells - 1);
    (cell, at - cell as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec3;

    #[test]
    fn meandering_cloth_is_shortened_by_a_bessel_function() {
        // Abramowitz and Stegun, table 9.1.
        for (w, j0) in [(0.0, 1.0), (0.5, 0.938_469_807_2), (1.0, 0.765_197_686_6), (1.6, 0.455_402_167_6)] {
            assert!((shortening(w) - j0).abs() < 1e-9, "{w}");
            let half = meander(w)[PHASES];
            assert!((half[0] / PI - j0).abs() < 1e-3, "half a wave at {w} reaches {half:?}");
            assert!((meander(w)[0][1] + half[1]).abs() < 1e-12, "a crest is as high as a valley is deep");
        }
    }

    /// One and a half circles in twelve waves, in space: the cloth keeps its lengths, but for right below the waist.
    #[test]
    fn cloth_in_waves_keeps_its_lengths() {
        let (opening, wave) = (1.5 * TAU, 1.5 * TAU / 12.0);
        let flutes = Flutes::new([0.08, 0.7], opening, 0.7, wave);
        let point = |r: f64, angle: f64| {
            let lies = flutes.at(r, angle / wave);
            let azimuth = (angle + lies.ahead * wave) * TAU / opening;
            let radius = 0.08 * opening / TAU + lies.wider + lies.out;
            Vec3::new(radius * azimuth.sin(), -lies.down, radius * azimuth.cos())
        };
        let mut worst = [0.0f64; 2];
        for k in 0..30 {
            let r = 0.15 + 0.018 * f64::from(k);
            for j in 0..40 {
                let angle = wave * f64::from(j) / 40.0;
                let ratio = |a: Vec3, b: Vec3, drawn: f64| ((b - a).norm() / drawn - 1.0).abs();
                let (dr, da) = (5e-3, 5e-3 / r);
                let down = ratio(point(r, angle), point(r + dr, angle), dr);
                let round = ratio(point(r, angle), point(r, angle + da), r * da);
                worst = [worst[0].max(down), worst[1].max(round)];
                assert!(flutes.at(r, angle / wave).out > -1e-9, "in the valleys' cone at {r}, {angle}");
            }
        }
        assert!(worst[0] < 0.15 && worst[1] < 0.25, "{worst:?}");
    }
}
