//! Pleats start laid: every fold of the piece goes straight down from the pleated edge.
//!
//! ```text
//! seen from the pleated edge:      ────────╮      top layer, to the fold
//!                              ╭───────────╯      middle
//!                              ╰───────────────── bottom, and the next panel
//! ```
//!
//! Panels lie like shingles, so that pleats may follow one another edge to edge.

use super::folded::FoldedPieces;
use crate::geometry::Vec2;
use crate::mesh::ClothMesh;
use crate::pattern::{EdgeId, Garment, PleatLayer, Seam, SeamKind};

/// Layers under the top one at a pleat.
const UNDER: f64 = 2.0;
/// Cloth that reaches a fold starts short of it, metres: where two folds meet edge to edge (behind a box pleat, before
/// an inverted one) their particles would start in one place, with no way to tell from which side either came.
const SHORT: f64 = 0.2e-3;
/// A pleat that is sewn at one end opens over this many depths of it from there.
const OPENS: f64 = 4.0;
/// The outermost panels of a piece sink to the pleat over this many depths of it.
const SINK: f64 = 3.0;

/// One fold, along the direction of its edge.
#[derive(Clone, Copy, Debug)]
struct Fold {
    /// Where the cloth it takes up begins, metres from the edge's start.
    at: f64,
    /// Width of a layer, metres.
    depth: f64,
    /// Whether its top layer points to the edge's end.
    to_end: bool,
}

impl Fold {
    fn end(&self) -> f64 {
        self.at + 2.0 * self.depth
    }

    /// How short of its folds cloth starts, metres.
    fn short(&self) -> f64 {
        SHORT.min(0.25 * self.depth)
    }

    /// From the seam that holds its middle layer on its bottom layer.
    fn of(seam: &Seam) -> Option<(EdgeId, Self)> {
        let ([a], [b]) = (&seam.a[..], &seam.b[..]) else { return None };
        let ends = [a.from, a.to, b.from, b.to];
        let at = ends.into_iter().fold(f64::INFINITY, f64::min);
        let end = ends.into_iter().fold(0.0, f64::max);
        // Bottom layers lie away from where the top one points.
        let middle_first = 0.5 * (a.from + a.to) < 0.5 * (b.from + b.to);
        Some((a.edge, Self { at, depth: 0.5 * (end - at), to_end: middle_first }))
    }
}

/// Lays the pleats of every piece. Pleats that are sewn at both ends are laid once.
pub(super) fn lay(garment: &Garment, mesh: &ClothMesh, sheet: &mut FoldedPieces) {
    let under = garment.seams.iter().filter(|s| s.kind == SeamKind::Pleat(PleatLayer::Under));
    let mut all: Vec<(EdgeId, Fold)> = under.filter_map(Fold::of).collect();
    all.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.at.total_cmp(&b.1.at)));
    for of_piece in all.chunk_by(|a, b| a.0.piece == b.0.piece) {
        let number = of_piece[0].0.piece;
        let mut laid: Vec<Pleated> = Vec::new();
        for of_edge in of_piece.chunk_by(|a, b| a.0 == b.0) {
            let pleated = Pleated::new(garment, of_edge);
            if let Some(other) = laid.iter_mut().find(|other| other.meets(&pleated)) {
                other.is_shut = true;
                continue;
            }
            for p in mesh.pieces[number].particles.clone() {
                let at = pleated.along.dot(&(mesh.flat[p] - pleated.start));
                let (to, under) = pleated.laid(at);
                sheet.flat[p] += pleated.along * (to - at);
                sheet.under[p] += under;
                sheet.hidden[p] |= pleated.folds.iter().any(|f| f.at < at && at < f.end());
            }
            laid.push(pleated);
        }
        for pleated in &laid {
            mesh.pieces[number].particles.clone().for_each(|p| sheet.shut[p] *= 1.0 - pleated.opened(mesh.flat[p]));
        }
    }
}

/// An edge with its folds in order.
struct Pleated {
    start: Vec2,
    /// Unit direction.
    along: Vec2,
    length: f64,
    folds: Vec<Fold>,
    /// Whether the pleats are sewn at both ends.
    is_shut: bool,
}

impl Pleated {
    fn new(garment: &Garment, folds: &[(EdgeId, Fold)]) -> Self {
        let edge = folds[0].0;
        let path = &garment.pieces[edge.piece].loops[edge.ring][edge.index].path;
        let (start, end) = (path.point(0.0), path.point(path.length()));
        let along = (end - start).try_normalize(0.0).unwrap_or_else(Vec2::x);
        Self { start, along, length: path.length(), folds: folds.iter().map(|f| f.1).collect(), is_shut: false }
    }

    /// How far the pleat that a flat point is in opens there: 0 at the edge, 1 where it is open, 0 outside all pleats.
    fn opened(&self, p: Vec2) -> f64 {
        let off = p - self.start;
        let at = self.along.dot(&off);
        let fold = self.folds.iter().find(|f| f.at < at && at < f.end()).filter(|_| !self.is_shut);
        fold.map_or(0.0, |fold| (self.along.perp(&off).abs() / (OPENS * fold.depth)).min(1.0))
    }

    /// Whether pleats of two edges take up the same stretch: one pleat sewn at both ends.
    fn meets(&self, other: &Self) -> bool {
        let project = |of: &Self, at: f64| self.along.dot(&(of.start + of.along * at - self.start));
        self.folds.iter().any(|f| {
            other.folds.iter().any(|g| {
                let (a, b) = (project(other, g.at), project(other, g.end()));
                a.min(b) < f.end() && f.at < a.max(b)
            })
        })
    }

    /// Where a place along the unfolded edge comes to lie along the laid one, and how many layers deep.
    fn laid(&self, at: f64) -> (f64, f64) {
        let before = self.folds.partition_point(|f| f.end() <= at);
        let taken: f64 = self.folds[..before].iter().map(|f| 2.0 * f.depth).sum();
        match self.folds.get(before) {
            Some(fold) if at > fold.at => {
                let (place, under) = self.in_fold(before, at);
                (place - taken, under)
            }
            _ => (self.short_of_folds(before, at) - taken, self.panel(before, at)),
        }
    }

    /// A place of the panel before fold `k`, along the unfolded edge: off those of its ends that are folded.
    fn short_of_folds(&self, k: usize, at: f64) -> f64 {
        let left = k.checked_sub(1).map(|k| self.folds[k]).filter(|f| !f.to_end);
        let right = self.folds.get(k).filter(|f| f.to_end);
        let at = left.map_or(at, |f| at.max(f.end() + f.short()));
        right.map_or(at, |f| at.min(f.at - f.short()))
    }

    /// Inside fold `k`: its place as if no fold came before, and the layers over it.
    fn in_fold(&self, k: usize, at: f64) -> (f64, f64) {
        let fold = &self.folds[k];
        let Fold { at: from, depth: d, to_end } = *fold;
        let s = at - from;
        // The top layer of a fold to the end is the panel before it, of one to the start the panel after it.
        let panel = |place: f64| {
            if to_end { self.panel(k, from + place) } else { self.panel(k + 1, from + place + 2.0 * d) }
        };
        let (place, layer) = match (to_end, s < d) {
            (true, true) => (-s, 1.0),
            (true, false) => (s - 2.0 * d, UNDER),
            (false, true) => (s, UNDER),
            (false, false) => (2.0 * d - s, 1.0),
        };
        let [low, high] = if to_end { [-d, 0.0] } else { [0.0, d] };
        let place = place.clamp(low + fold.short(), high - fold.short());
        (from + place, panel(place) + layer)
    }

    /// Depth of the panel before fold `k` at a place along the unfolded edge: it emerges from under one neighbour, or
    /// lies on it.
    fn panel(&self, k: usize, at: f64) -> f64 {
        let left = k.checked_sub(1).map(|k| self.folds[k]);
        let right = self.folds.get(k).copied();
        let from = left.map_or(0.0, |f| f.end());
        let to = right.map_or(self.length, |f| f.at);
        let depth = |fold: Option<Fold>, hides: bool| fold.map_or(0.0, |f| if f.to_end == hides { UNDER } else { 0.0 });
        let (low, high) = (depth(left, true), depth(right, false));
        let outer = |f: Option<Fold>| f.map_or(f64::INFINITY, |f| SINK * f.depth);
        let (from, to) = match (left, right) {
            (None, Some(_)) => (from.max(to - outer(right)), to),
            (Some(_), None) => (from, to.min(from + outer(left))),
            _ => (from, to),
        };
        let share = if to > from { ((at - from) / (to - from)).clamp(0.0, 1.0) } else { 0.5 };
        low + (high - low) * share
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn pleated(folds: &[(f64, bool)]) -> Pleated {
        let folds = folds.iter().map(|&(at, to_end)| Fold { at, depth: 0.02, to_end }).collect();
        Pleated { start: Vec2::zeros(), along: Vec2::x(), length: 0.4, folds, is_shut: false }
    }

    #[test]
    fn a_pleat_takes_up_two_depths_and_lies_under_its_panel() {
        // Folded at 100 mm, bottom layer away from under it at 140 mm.
        let one = pleated(&[(0.1, true)]);
        for (at, to) in [(0.03, 0.03), (0.1, 0.1), (0.11, 0.09), (0.12, 0.08), (0.13, 0.09), (0.14, 0.1), (0.3, 0.26)] {
            assert_relative_eq!(one.laid(at).0, to, epsilon = 1.01 * SHORT);
        }
        // The other way: folded at 140 mm over what went before.
        let other = pleated(&[(0.1, false)]);
        for (at, to) in [(0.03, 0.03), (0.11, 0.11), (0.12, 0.12), (0.13, 0.11), (0.14, 0.1), (0.15, 0.11)] {
            assert_relative_eq!(other.laid(at).0, to, epsilon = 1.01 * SHORT);
        }
    }

    #[test]
    fn a_pleat_opens_away_from_its_edge_unless_it_is_sewn_at_both_ends() {
        let mut one = pleated(&[(0.1, true)]);
        let opened = |pleat: &Pleated, x: f64, y: f64| pleat.opened(Vec2::new(x, y));
        for (y, share) in [(0.0, 0.0), (0.04, 0.5), (0.08, 1.0), (0.3, 1.0)] {
            assert_relative_eq!(opened(&one, 0.12, y), share, epsilon = 1e-12);
            assert_eq!(opened(&one, 0.05, y), 0.0, "beside the pleat");
        }
        one.is_shut = true;
        assert_eq!(opened(&one, 0.12, 0.3), 0.0);
    }

    #[test]
    fn no_two_layers_share_a_place() {
        let patterns: [&[(f64, bool)]; 5] = [
            &[(0.1, true)],
            &[(0.1, false)],
            // Edge to edge, box, inverted.
            &[(0.05, true), (0.11, true), (0.17, true)],
            &[(0.1, false), (0.18, true)],
            &[(0.1, true), (0.14, false)],
        ];
        for folds in patterns {
            let pleated = pleated(folds);
            // Many a sample lies on a fold.
            let laid: Vec<(f64, f64)> = (0..=400).map(|k| pleated.laid(1e-3 * f64::from(k))).collect();
            for (i, a) in laid.iter().enumerate() {
                for b in &laid[..i] {
                    let apart = (a.0 - b.0).abs() > 1.9 * SHORT || (a.1 - b.1).abs() > 0.5;
                    assert!(apart, "{folds:?}: {a:?} and {b:?}");
                }
            }
        }
    }
}
