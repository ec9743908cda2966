//! Panels whose outlines run the other way round: a panel's right side looks away from the body, whatever its maker's
//! program drew first.

use super::drawing::double_area;
use super::spec::{Curve, Panel, PanelEdge, PanelStitch};
use crate::geometry::{Vec2, Vec3};

/// A panel nearer the middle of the body than this (millimetres) is neither before nor behind it.
const CLEAR: f64 = 20.0;
/// A right side that looks this far forward or back (cosine) says where its panel should be.
const FACING: f64 = 0.5;

/// Walks the outlines of panels the other way that stand before the body and look back, or behind it and look forward.
/// A panel that lies on the wrong side of another is meant to.
pub(super) fn turn_outward(panels: &mut [Panel], stitches: &mut [PanelStitch]) {
    let mut turned = vec![false; panels.len()];
    for (k, panel) in panels.iter().enumerate() {
        let over = stitches.iter().any(|s| s.right_wrong && s.ends.iter().any(|end| end.0 == k));
        let (normal, middle) = (normal(panel), panel.middle());
        turned[k] = !over && normal.abs() > FACING && middle.z.abs() >= CLEAR && normal * middle.z < 0.0;
    }
    for (panel, _) in panels.iter_mut().zip(&turned).filter(|(_, turned)| **turned) {
        panel.edges = panel.edges.iter().rev().map(PanelEdge::reversed).collect();
    }
    for (panel, edge) in stitches.iter_mut().flat_map(|s| &mut s.ends).filter(|end| turned[end.0]) {
        *edge = panels[*panel].edges.len() - 1 - *edge;
    }
}

/// How far forward the side looks from which the outline runs counter-clockwise (cosine).
///
/// The area is that between the curves: all corners of a circle skirt's half may lie on one line.
fn normal(panel: &Panel) -> f64 {
    double_area(&panel.edges).unwrap_or(0.0).signum() * (panel.rotation * Vec3::z()).z
}

impl Panel {
    /// Where a point of it is in space.
    pub(super) fn space(&self, p: Vec2) -> Vec3 {
        self.translation + self.rotation * Vec3::new(p.x, p.y, 0.0)
    }

    /// Middle of its corners, in space.
    pub(super) fn middle(&self) -> Vec3 {
        let sum = self.edges.iter().fold(Vec2::zeros(), |sum, e| sum + e.start);
        self.space(sum / self.edges.len().max(1) as f64)
    }
}

impl PanelEdge {
    /// The edge walked the other way.
    fn reversed(&self) -> Self {
        let curve = match self.curve {
            Curve::Cubic(c, d) => Curve::Cubic(d, c),
            Curve::Arc { radius, large, sweep } => Curve::Arc { radius, large, sweep: !sweep },
            other => other,
        };
        Self { start: self.end, end: self.start, curve, label: self.label.clone() }
    }
}
