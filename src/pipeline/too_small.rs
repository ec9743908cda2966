//! A garment that cannot be put on: its seams close only if its cloth tears.

use super::job::Job;
use super::obstacle::TooSmall;
use crate::fabric::Fabric;
use crate::geometry::Vec3;
use crate::report::extensions;

/// Extension of cloth beyond the tester's range before it tears. Woven cotton tears at 8 to 20 % in a strip test (ISO
/// 13934-1), of which the first few are those under the tester's load.
const BEFORE_IT_TEARS: f64 = 0.2;

/// Names of the directions of [`extensions`].
const THREADS: [&str; 2] = ["warp", "weft"];

impl Job {
    /// The piece that is stretched furthest beyond its cloth's range, with the particles of the sewn garment `at`.
    pub(super) fn too_small(&self, at: &[Vec3]) -> Option<TooSmall> {
        let pieces = self.mesh.pieces.iter().zip(&self.fabrics).zip(extensions(&self.mesh, at));
        let threads = pieces.flat_map(|((piece, fabric), strains)| {
            let threads = strains.into_iter().zip(gives(fabric)).zip(THREADS);
            threads.map(move |((by, gives), thread)| (by - gives, piece, fabric, thread, by, gives))
        });
        let worst = threads.filter(|t| t.0 > 0.0).max_by(|a, b| a.0.total_cmp(&b.0));
        worst.map(|(_, piece, fabric, thread, by, gives)| TooSmall {
            file: self.file.clone(),
            piece: piece.name.clone(),
            thread,
            by: 100.0 * by,
            fabric: fabric.name.clone(),
            gives: 100.0 * gives,
        })
    }
}

/// Mean strains along warp and weft at which a fabric is taken to tear.
fn gives(fabric: &Fabric) -> [f64; 2] {
    fabric.emt().map(|strain| strain + BEFORE_IT_TEARS)
}
