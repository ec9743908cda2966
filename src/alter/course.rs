//! Smooth shifts of few knots along a path, fitted to a given shift.

use nalgebra::DMatrix;

use super::shift::EdgeShift;
use crate::geometry::{Path, Vec2};

/// Largest distance of the fitted shift from the given one, metres: half a pencil line.
const NEAR: f64 = 3e-4;
/// Knots are no nearer to each other than this, metres: a maker's curve turns no faster, and a mesh shows no more.
const SHORTEST: f64 = 0.06;
/// Distance of the samples of the given shift, metres: half the usual spacing of particles.
const STEP: f64 = 5e-3;
/// Least number of intervals between samples.
const FEWEST: usize = 4;

/// The shift along a stretch of this length, as smooth as it can be, and exact at both ends. A shift that is even, or
/// changes evenly, stays so.
pub(super) fn fitted(length: f64, given: impl Fn(f64) -> Vec2) -> EdgeShift {
    let count = ((length / STEP).ceil() as usize).max(FEWEST);
    let place = |i: usize| length * i as f64 / count as f64;
    let samples: Vec<(f64, Vec2)> = (0..=count).map(|i| (place(i), given(place(i)))).collect();
    let mut knots = vec![0.0, length];
    let mut field = between(length, [samples[0].1, samples[count].1]);
    if misses(&field, &samples, &knots).iter().all(|miss| *miss <= NEAR) {
        return field;
    }
    while let Some(bent) = least_squares(&samples, &knots) {
        field = bent;
        let misses = misses(&field, &samples, &knots);
        let far = (0..misses.len()).filter(|&i| misses[i] > NEAR && knots[i + 1] - knots[i] >= 2.0 * SHORTEST);
        let Some(worst) = far.max_by(|&a, &b| misses[a].total_cmp(&misses[b])) else { break };
        knots.insert(worst + 1, 0.5 * (knots[worst] + knots[worst + 1]));
    }
    field
}

/// A shift that goes over evenly from one end to the other.
pub(super) fn between(length: f64, ends: [Vec2; 2]) -> EdgeShift {
    let rise = (ends[1] - ends[0]) / length;
    EdgeShift { knots: vec![(0.0, ends[0]), (length, ends[1])], slopes: vec![rise; 2], linear: true }
}

/// The shift with another on top that goes over evenly.
pub(super) fn tilted(field: &EdgeShift, ends: [Vec2; 2]) -> EdgeShift {
    let length = field.knots[field.knots.len() - 1].0;
    let rise = (ends[1] - ends[0]) / length;
    let mut out = field.clone();
    out.knots.iter_mut().for_each(|(s, by)| *by += ends[0] + rise * *s);
    out.slopes.iter_mut().for_each(|slope| *slope += rise);
    out
}

/// A path of the field's length as it is shifted, and the places on it of those at `marks`.
pub(super) fn carried(field: &EdgeShift, path: &Path, marks: &[f64]) -> (Path, Vec<f64>) {
    let knots: Vec<f64> = field.knots.iter().map(|k| k.0).collect();
    let (new, moved) = path.shifted(&knots, marks, |s| field.at(s));
    let line = field.linear && path.is_straight();
    (if line { Path::line(new.start(), new.end()) } else { new }, moved)
}

/// By interval between knots, the largest distance of the field from a sample.
fn misses(field: &EdgeShift, samples: &[(f64, Vec2)], knots: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0f64; knots.len() - 1];
    for (s, given) in samples {
        let i = knots[1..knots.len() - 1].partition_point(|k| k <= s);
        out[i] = out[i].max((field.at(*s).by - given).norm());
    }
    out
}

/// The cubics between these knots that are nearest to the samples; they pass the first and the last one. `None` where
/// the samples do not tell them.
fn least_squares(samples: &[(f64, Vec2)], knots: &[f64]) -> Option<EdgeShift> {
    let (last, ends) = (knots.len() - 1, [samples[0].1, samples[samples.len() - 1].1]);
    // Unknown are the shifts at the inner knots, and the slopes at all.
    let unknown = last - 1 + knots.len();
    let mut rows = DMatrix::zeros(samples.len(), unknown);
    let mut right = DMatrix::zeros(samples.len(), 2);
    for (row, (s, given)) in samples.iter().enumerate() {
        let i = knots[1..last].partition_point(|k| k <= s);
        let long = knots[i + 1] - knots[i];
        let t = (s - knots[i]) / long;
        let u = 1.0 - t;
        let mut rest = *given;
        for (knot, share) in [(i, u * u * (1.0 + 2.0 * t)), (i + 1, t * t * (3.0 - 2.0 * t))] {
            match knot {
                0 => rest -= ends[0] * share,
                k if k == last => rest -= ends[1] * share,
                k => rows[(row, k - 1)] += share,
            }
        }
        rows[(row, last - 1 + i)] += u * u * t * long;
        rows[(row, last + i)] -= t * t * u * long;
        right.set_row(row, &rest.transpose());
    }
    let solution = (rows.transpose() * &rows).cholesky()?.solve(&(rows.transpose() * right));
    let row = |i: usize| Vec2::new(solution[(i, 0)], solution[(i, 1)]);
    let shift = |k: usize| match k {
        0 => ends[0],
        k if k == last => ends[1],
        k => row(k - 1),
    };
    let field = EdgeShift {
        knots: knots.iter().enumerate().map(|(k, s)| (*s, shift(k))).collect(),
        slopes: (0..=last).map(|k| row(last - 1 + k)).collect(),
        linear: false,
    };
    field.slopes.iter().all(|slope| slope.iter().all(|x| x.is_finite())).then_some(field)
}

impl EdgeShift {
    /// Whether nothing is shifted.
    pub(super) fn is_still(&self) -> bool {
        self.knots.iter().all(|(_, by)| *by == Vec2::zeros()) && self.slopes.iter().all(|slope| *slope == Vec2::zeros())
    }
}
