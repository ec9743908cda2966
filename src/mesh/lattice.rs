//! The grain-aligned lattice of a piece: where its rows and columns run.

use super::frame::{PieceFrame, Straight};
use crate::geometry::{Vec2, range_of};

/// Largest deviation of a straight stretch from an axis, in spacings, at which it counts as running along the axis.
const STRAY: f64 = 0.05;
/// Largest relative difference of a stretch's own step from the spacing at which the lattice takes that step.
const STEP_SLACK: f64 = 0.1;
/// Least share of the piece along the axis that a stretch must span to set the lattice's step. A shorter one has little
/// bearing on the rest.
const SPAN: f64 = 0.25;

/// Rows along the weft, columns along the warp.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    origin: Vec2,
    /// Unit weft and warp. The warp lies on the weft's positive side.
    axes: [Vec2; 2],
    /// Cell size along weft and warp, metres.
    pub(super) step: [f64; 2],
}

impl Lattice {
    /// Fits a lattice to a piece: it takes the step and place of the longest straight, evenly sampled stretch along
    /// each axis, so that its rows end on the rim's own particles. Else it puts a row on the longest stretch across
    /// the axis. Else a row through the middle of the piece, which makes it symmetric if the piece is.
    pub(super) fn fit(frame: &PieceFrame, warp: Vec2, spacing: f64) -> Self {
        let axes = [Vec2::new(warp.y, -warp.x), warp];
        let fits = axes.map(|axis| fit_axis(frame, axis, spacing));
        Self { origin: axes[0] * fits[0].0 + axes[1] * fits[1].0, axes, step: [fits[0].1, fits[1].1] }
    }

    /// A point in cells from the origin, along weft and warp.
    pub(super) fn cells(&self, p: Vec2) -> Vec2 {
        let d = p - self.origin;
        Vec2::new(d.dot(&self.axes[0]) / self.step[0], d.dot(&self.axes[1]) / self.step[1])
    }

    /// The lattice point in column `i` and row `j`.
    pub(super) fn point(&self, i: i64, j: i64) -> Vec2 {
        self.origin + self.axes[0] * (i as f64 * self.step[0]) + self.axes[1] * (j as f64 * self.step[1])
    }
}

/// Offset and step along `axis`.
fn fit_axis(frame: &PieceFrame, axis: Vec2, spacing: f64) -> (f64, f64) {
    let along = |s: &&Straight| {
        let d = s.to - s.from;
        let step = d.norm() / s.springs as f64;
        d.perp(&axis).abs() < STRAY * spacing && (step / spacing - 1.0).abs() < STEP_SLACK
    };
    let across = |s: &&Straight| (s.to - s.from).dot(&axis).abs() < STRAY * spacing;
    let [low, high] = extent(frame, axis);
    if let Some(s) = longest(frame.straights.iter().filter(along))
        && length(s) >= SPAN * (high - low)
    {
        return (s.from.dot(&axis), length(s) / s.springs as f64);
    }
    match longest(frame.straights.iter().filter(across)) {
        Some(s) => (0.5 * (s.from + s.to).dot(&axis), spacing),
        None => (0.5 * (low + high), spacing),
    }
}

fn length(s: &Straight) -> f64 {
    (s.to - s.from).norm()
}

/// The first of the longest. Lengths that differ by rounding only count as equal, so that a mirrored piece chooses
/// the mirrored stretch.
fn longest<'a>(stretches: impl Iterator<Item = &'a Straight>) -> Option<&'a Straight> {
    stretches.fold(None, |best, s| match best {
        Some(b) if length(s) <= length(b) * (1.0 + 1e-9) => Some(b),
        _ => Some(s),
    })
}

fn extent(frame: &PieceFrame, axis: Vec2) -> [f64; 2] {
    range_of(frame.points[..frame.rim].iter().map(|p| p.dot(&axis)))
}
