//! Edges without length to speak of, as the sides of a slit of no depth: left out, their ends drawn together.

use super::spec::{Panel, PanelEdge, PanelStitch};
use crate::geometry::Vec2;
use crate::pattern::SHORTEST_EDGE;

/// Edges keep their lengths to this many millimetres when they are written.
pub(super) const KEPT: f64 = 0.005;
/// Edges shorter than this (millimetres) may be written too short to be meshed.
const SHORTEST: f64 = 1e3 * SHORTEST_EDGE + KEPT;

/// Leaves out short edges that are free or sewn to short ones, with their stitches. One that is sewn to a longer edge
/// stays: without it that edge would have no partner, and only who drew it can say what was meant.
pub(super) fn leave_out_short(panels: &mut [Panel], stitches: &mut Vec<PanelStitch>) {
    let mut left_out: Vec<Vec<bool>> =
        panels.iter().map(|panel| panel.edges.iter().map(|e| e.length() < SHORTEST).collect()).collect();
    for PanelStitch { ends: [a, b], .. } in stitches.iter() {
        let both = left_out[a.0][a.1] && left_out[b.0][b.1];
        (left_out[a.0][a.1], left_out[b.0][b.1]) = (both, both);
    }
    stitches.retain(|s| !left_out[s.ends[0].0][s.ends[0].1]);
    for (panel, k) in stitches.iter_mut().flat_map(|s| &mut s.ends) {
        *k -= left_out[*panel][..*k].iter().filter(|&&out| out).count();
    }
    for (panel, left_out) in panels.iter_mut().zip(&left_out) {
        let mut left_out = left_out.iter();
        panel.edges.retain(|_| left_out.next() == Some(&false));
        join(&mut panel.edges);
    }
}

/// Lets every edge begin where the one before it ends.
fn join(edges: &mut [PanelEdge]) {
    let Some(mut before) = edges.last().map(|e| e.end) else { return };
    for edge in edges {
        edge.start = std::mem::replace::<Vec2>(&mut before, edge.end);
    }
}
