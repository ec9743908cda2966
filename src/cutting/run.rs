//! Smooth stretches of a ring, which corners join.

use crate::geometry::{Station, Vec2, mirrored};

/// A smooth stretch of a ring, walked with the cloth on the right.
#[derive(Clone, Debug)]
pub(super) struct SmoothRun {
    /// The sewing line.
    pub(super) base: Vec<Vec2>,
    /// The same, moved out.
    pub(super) moved: Vec<Vec2>,
    /// Tangents at its ends, along the walk.
    pub(super) ends: [Vec2; 2],
    pub(super) width: f64,
}

impl SmoothRun {
    /// The stretch through `stations`, with an allowance of this width, metres.
    pub(super) fn new(stations: &[Station], width: f64) -> Self {
        // The cloth is on the right of the walk (y down), so the allowance is on its left.
        let out = |s: &Station| s.at + width * Vec2::new(s.tangent.y, -s.tangent.x);
        let tangent = |s: Option<&Station>| s.map_or_else(Vec2::zeros, |s| s.tangent);
        Self {
            base: stations.iter().map(|s| s.at).collect(),
            moved: stations.iter().map(out).collect(),
            ends: [tangent(stations.first()), tangent(stations.last())],
            width,
        }
    }

    /// Its image in the line through `on` along `along`, walked the other way: the cloth stays on the right.
    pub(super) fn image(&self, [on, along]: [Vec2; 2]) -> Self {
        let points = |line: &[Vec2]| line.iter().rev().map(|&p| mirrored(p, on, along)).collect();
        let [first, last] = self.ends.map(|t| -mirrored(t, Vec2::zeros(), along));
        Self { base: points(&self.base), moved: points(&self.moved), ends: [last, first], width: self.width }
    }

    /// The stretch as it is sewn: without allowance.
    pub(super) fn sewn(&self) -> Self {
        Self { moved: self.base.clone(), width: 0.0, ..self.clone() }
    }
}
