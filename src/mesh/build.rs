//! From a garment to its mesh: the order of the steps.

use rayon::prelude::*;

use super::chords::SelfSeam;
use super::error::MeshError;
use super::fill::Fill;
use super::frame::PieceFrame;
use super::grid::Core;
use super::improve::Improver;
use super::lattice::Lattice;
use super::layout::MeshLayout;
use super::links::LinkedChains;
use super::patch::Patch;
use super::{ClothMesh, MeshMethod, MeshOptions, coons, strip};
use crate::pattern::Garment;

/// Rounds of relaxing, removing chords and repairing. Each of these steps disturbs the result of the others.
const ROUNDS: usize = 2;

/// Meshes every piece of `garment` with springs of about `spacing` metres. See [`build_with`].
///
/// # Errors
/// As [`build_with`].
pub fn build(garment: &Garment, spacing: f64) -> Result<ClothMesh, MeshError> {
    build_with(garment, &MeshOptions { spacing, method: MeshMethod::Auto })
}

/// Meshes every piece of `garment`.
///
/// Rims lie on the drawn edges. Both sides of a seam have the same number of particles at matching arc length. There is
/// a particle at every mark, span end, edge end and kink of either side, also of edges that are sewn to it indirectly.
/// Inside is a regular grid along the grain whose diagonals alternate, with an irregular strip of about one spacing
/// along rims that are not in line with it. The same garment and options give the same bytes for any number of threads.
///
/// A piece narrower than the spacing gets one row of cells across, and springs along it that are at most three times as
/// long as it is wide ([`PieceMesh::narrow`](super::PieceMesh::narrow)).
///
/// The smallest angle is normally above 25°. Exceptions are sharper corners of the outline, strips and gaps narrower
/// than a spacing, and neighbouring springs of very different length where marks lie close together.
/// [`PieceMesh::smallest_angle`](super::PieceMesh::smallest_angle) has the value reached.
///
/// # Errors
/// [`MeshError`] when the spacing is no positive length or does not suit the pieces, or when an outline, a line or a
/// seam contradicts itself.
pub fn build_with(garment: &Garment, options: &MeshOptions) -> Result<ClothMesh, MeshError> {
    let layout = MeshLayout::new(garment, *options)?;
    let numbers: Vec<usize> = (0..garment.pieces.len()).collect();
    let fills: Vec<_> = numbers.par_iter().map(|&n| layout.fill(n)).collect();
    // Of several errors the first in the garment's order, not the first in time.
    let fills: Vec<_> = fills.into_iter().collect::<Result<_, _>>()?;
    Ok(layout.assemble(fills))
}

impl MeshLayout<'_> {
    /// Meshes piece `n`.
    fn fill(&self, n: usize) -> Result<(PieceFrame, Fill), MeshError> {
        let piece = &self.garment.pieces[n];
        let mut frame = PieceFrame::of_rim(piece, n, &self.edges, &self.breaks, &self.sampling)?;
        if coons::wanted(piece, self.options.method)
            && let Some(fill) =
                coons::fill(&frame, &self.plans[n], self.options.method, self.fineness[n].narrow.is_some())
        {
            return Ok((frame, fill));
        }
        frame.add_lines(&self.plans[n], |edge, s| {
            (edge - self.first_edge(n), self.sampling.particle_of_break(edge, self.breaks.nearest(edge, s)))
        });
        let fill = self.fill_with_grid(n, &frame)?;
        Ok((frame, fill))
    }

    /// Lays a lattice into a frame, triangulates what is left and repairs it.
    fn fill_with_grid(&self, n: usize, frame: &PieceFrame) -> Result<Fill, MeshError> {
        let spacing = self.fineness[n].spacing;
        let lattice = Lattice::fit(frame, self.garment.pieces[n].warp, spacing);
        let core = Core::lay(frame, &lattice, spacing);
        let strip = strip::triangulate(frame, &core).map_err(|e| self.blame(n, frame, &core, e))?;
        let triangles: Vec<_> = core.triangles.iter().chain(&strip).copied().collect();
        let mut patch = Patch::new(core.points, frame.points.len(), &triangles, &frame.line_springs);
        let self_seams = self.self_seams(n, frame);
        let mut improver = Improver { patch: &mut patch, rim: frame.rim as u32, spacing };
        for _ in 0..ROUNDS {
            improver.relax();
            improver.part_chords(&self_seams);
            improver.mend();
        }
        improver.relax();
        let (points, triangles) = patch.finish();
        Ok(Fill { points, triangles, lines: frame.lines.clone() })
    }

    /// Seams with both sides on piece `n`.
    fn self_seams(&self, n: usize, frame: &PieceFrame) -> Vec<SelfSeam> {
        let first = self.first_edge(n);
        let side = |link: &LinkedChains, side: usize| {
            let own = self.chain(link, side).into_iter().filter(|&(edge, _)| self.edges.ids[edge].piece == n);
            let mut on: Vec<u32> = own.map(|(edge, k)| frame.edges[edge - first][k]).collect();
            on.sort_unstable();
            on.dedup();
            on
        };
        let seams = self.seam_links().iter().map(|link| [side(link, 0), side(link, 1)]);
        seams.filter(|[a, b]| !a.is_empty() && !b.is_empty()).map(SelfSeam).collect()
    }
}
