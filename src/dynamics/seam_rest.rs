//! How long the rims of pieces are once they are sewn.

use crate::geometry::sorted_pair;
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, Give};

/// Length ratio of a seam's sides above which an even seam counts as gathered: it then has the length of its shorter
/// side.
const GATHERED: f64 = 1.05;

/// Rest lengths of rim edges once they are sewn, for seams whose sides differ in length.
pub(super) struct SeamRest {
    /// (ends, metres), sorted.
    lengths: Vec<([u32; 2], f64)>,
}

impl SeamRest {
    pub(super) fn new(mesh: &ClothMesh, garment: &Garment) -> Self {
        let mut lengths = Vec::new();
        for (stitches, seam) in mesh.seams.iter().zip(&garment.seams) {
            for w in stitches.pairs.windows(2) {
                let side = |k: usize| (mesh.flat[w[0][k] as usize] - mesh.flat[w[1][k] as usize]).norm();
                let (a, b) = (side(0), side(1));
                if a <= 0.0 || b <= 0.0 {
                    continue;
                }
                let rest = match seam.give {
                    Give::Stretch(_) => a.max(b),
                    Give::Gather(_) | Give::Ease(_) => a.min(b),
                    Give::Even if a.max(b) > GATHERED * a.min(b) => a.min(b),
                    Give::Even => 0.5 * (a + b),
                };
                for (&p, &q) in w[0].iter().zip(&w[1]) {
                    lengths.push((sorted_pair([p, q]), rest));
                }
            }
        }
        lengths.sort_by_key(|e| e.0);
        lengths.dedup_by_key(|e| e.0);
        Self { lengths }
    }

    /// Rest length of an edge of the mesh, metres: the one given by its seam, or that of the flat piece.
    pub(super) fn of(&self, mesh: &ClothMesh, ends: [u32; 2]) -> f64 {
        let found = self.lengths.binary_search_by(|e| e.0.cmp(&sorted_pair(ends)));
        let flat = || (mesh.flat[ends[1] as usize] - mesh.flat[ends[0] as usize]).norm();
        found.map_or_else(|_| flat(), |k| self.lengths[k].1)
    }
}
