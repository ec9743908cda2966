//! Splines and ellipses of a DXF file as cubic curves.

use std::f64::consts::TAU;

use super::dxf_error::DxfError;
use super::dxf_text::Entity;
use crate::geometry::{Cubic, Path, Vec2};

/// Cubic curves for an ellipse: they leave it by less than a millionth of its size.
const PER_ELLIPSE: usize = 32;
/// Cubic curves for a span that is none itself, having weights or a higher degree.
const PER_SPAN: usize = 8;
/// The slope of a span is taken over this share of it; within a span a spline is as smooth as can be.
const SLOPE: f64 = 1e-3;
/// No spline has a higher degree, or more control points.
const MOST: (usize, usize) = (11, 2_000);
/// Curves shorter than this (metres) are none.
const SHORTEST: f64 = 1e-9;

/// An ELLIPSE; `None` where a number is missing.
pub(super) fn ellipse(entity: &Entity, unit: f64) -> Result<Option<Path>, DxfError> {
    let (centre, axis) = (entity.points(10, unit)?.first().copied(), entity.points(11, unit)?.first().copied());
    let (Some(centre), Some(axis), Some(ratio)) = (centre, axis, entity.number(40, 1.0)?) else { return Ok(None) };
    let from = entity.number(41, 1.0)?.unwrap_or(0.0);
    let to = entity.number(42, 1.0)?.unwrap_or(TAU);
    let turn = (to - from).rem_euclid(TAU);
    let turn = if turn < 1e-9 { TAU } else { turn };
    // Counterclockwise on the sheet, whose y goes up; seen from below where it was mirrored.
    let seen = if entity.is_seen_from_below() { -1.0 } else { 1.0 };
    let other = seen * ratio * Vec2::new(axis.y, -axis.x);
    let step = turn / PER_ELLIPSE as f64;
    // Handles of a circle's arc, 4/3 · tan(a quarter of the angle).
    let handle = 4.0 / 3.0 * (0.25 * step).tan();
    let at = |angle: f64| centre + axis * angle.cos() + other * angle.sin();
    let slope = |angle: f64| other * angle.cos() - axis * angle.sin();
    let curve = |k: usize| {
        let [a, b] = [k, k + 1].map(|k| from + step * k as f64);
        [at(a), at(a) + slope(a) * handle, at(b) - slope(b) * handle, at(b)]
    };
    let usable = axis.norm() > SHORTEST && ratio > 0.0;
    Ok(usable.then(|| (0..PER_ELLIPSE).map(curve).collect::<Vec<Cubic>>()).and_then(|curves| path(&curves)))
}

/// A SPLINE: of its knots and control points, which may have weights, or through its fit points. `None` where it is
/// none.
pub(super) fn spline(entity: &Entity, unit: f64) -> Result<Option<Path>, DxfError> {
    let controls = entity.points(10, unit)?;
    let knots = entity.numbers(40)?;
    let weights = entity.numbers(41)?;
    let degree = entity.value(71).and_then(|v| v.parse::<usize>().ok()).unwrap_or(3);
    let usable = (1..=MOST.0).contains(&degree) && controls.len() <= MOST.1 && controls.len() > degree;
    if usable && knots.len() == controls.len() + degree + 1 && knots.is_sorted() {
        let weighted = weights.len() == controls.len() && weights.iter().any(|w| *w != weights[0]);
        let weights = if weighted { weights } else { vec![1.0; controls.len()] };
        let parts = if weighted || degree > 3 { PER_SPAN } else { 1 };
        return Ok(path(&RationalSpline { degree, knots, controls, weights }.curves(parts)));
    }
    let through = entity.points(11, unit)?;
    Ok((through.len() > 1 && through.len() <= MOST.1).then(|| smooth_through(&through)).and_then(|c| path(&c)))
}

/// The curves as one line, if they are one of some length.
fn path(curves: &[Cubic]) -> Option<Path> {
    let finite = |c: &Cubic| c.iter().all(|p| p.x.is_finite() && p.y.is_finite());
    let long = |c: &&Cubic| (1..4).any(|k| (c[k] - c[0]).norm() > SHORTEST);
    let curves: Vec<Cubic> = curves.iter().filter(long).copied().collect();
    (!curves.is_empty() && curves.iter().all(finite)).then(|| Path::cubics(&curves))
}

/// A rational B-spline.
struct RationalSpline {
    degree: usize,
    knots: Vec<f64>,
    controls: Vec<Vec2>,
    weights: Vec<f64>,
}

impl RationalSpline {
    /// Its spans, each as so many cubics with its points and slopes: a cubic itself is one.
    fn curves(&self, parts: usize) -> Vec<Cubic> {
        let mut curves = Vec::new();
        for span in self.degree..self.controls.len() {
            let (from, to) = (self.knots[span], self.knots[span + 1]);
            if to <= from {
                continue;
            }
            let part = (to - from) / parts as f64;
            let at = |t: f64| self.point(span, t);
            let slope = |t: f64| (at(t + SLOPE * part) - at(t - SLOPE * part)) / (2.0 * SLOPE);
            for k in 0..parts {
                let [a, b] = [k, k + 1].map(|k| from + part * k as f64);
                let third = |t: f64| slope(t) / 3.0;
                curves.push([at(a), at(a) + third(a), at(b) - third(b), at(b)]);
            }
        }
        curves
    }

    /// De Boor's algorithm, on points with their weights.
    fn point(&self, span: usize, t: f64) -> Vec2 {
        let p = self.degree;
        let own = |j: usize| {
            let i = span - p + j;
            (self.controls[i] * self.weights[i], self.weights[i])
        };
        let mut at: Vec<(Vec2, f64)> = (0..=p).map(own).collect();
        for r in 1..=p {
            for j in (r..=p).rev() {
                let i = span - p + j;
                let (low, high) = (self.knots[i], self.knots[i + p + 1 - r]);
                let share = if high > low { (t - low) / (high - low) } else { 0.0 };
                let (a, b) = (at[j - 1], at[j]);
                at[j] = (a.0 * (1.0 - share) + b.0 * share, a.1 * (1.0 - share) + b.1 * share);
            }
        }
        at[p].0 / at[p].1
    }
}

/// A smooth line through points: cubics whose slopes are those of the parabola through three that follow each other.
fn smooth_through(points: &[Vec2]) -> Vec<Cubic> {
    let tangent = |k: usize| {
        let [before, here, next] = [k.saturating_sub(1), k, (k + 1).min(points.len() - 1)].map(|i| points[i]);
        let (a, b) = ((here - before).norm(), (next - here).norm());
        match (a > 0.0, b > 0.0) {
            (true, true) => ((here - before) / a * b + (next - here) / b * a) / (a + b),
            (true, false) => (here - before) / a,
            (false, true) => (next - here) / b,
            (false, false) => Vec2::zeros(),
        }
    };
    let curve = |k: usize| {
        let (from, to) = (points[k], points[k + 1]);
        let third = (to - from).norm() / 3.0;
        [from, from + tangent(k) * third, to - tangent(k + 1) * third, to]
    };
    (0..points.len() - 1).map(curve).collect()
}
