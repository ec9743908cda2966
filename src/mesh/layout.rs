//! Decisions about the whole garment that must be made before its pieces can be filled one by one.

use super::breaks::Breaks;
use super::error::MeshError;
use super::limits::{self, Fineness};
use super::lines::{LinePlan, RimLine};
use super::links::{EdgeTable, LinkedChains};
use super::sampling::{Sampling, Wish};
use super::{MeshMethod, MeshOptions, coons};
use crate::pattern::{EdgeId, Garment};

/// Turn between two segments of an edge that puts a particle at the kink, radians (15°). Cutting the corner would
/// change the area of the piece in first order of the spacing.
const KINK: f64 = 0.26;
/// Distance on either side of a joint at which turns are measured, metres.
const BESIDE: f64 = 1e-7;
/// Least number of springs across a band. It must bend along its middle, or cloth sewn to it cannot turn beside it. A
/// narrow band has one row of cells, because a second row would halve cells that are flat already.
const ACROSS_BAND: usize = 2;

/// Decisions about the whole garment, made before its pieces are filled.
pub(super) struct MeshLayout<'g> {
    /// The garment.
    pub(super) garment: &'g Garment,
    /// Its edges in one list.
    pub(super) edges: EdgeTable,
    /// Lines of every piece.
    pub(super) plans: Vec<LinePlan>,
    /// Seams first, in the garment's order.
    pub(super) links: Vec<LinkedChains>,
    /// Places on edges that need a particle.
    pub(super) breaks: Breaks,
    /// All particles of the edges.
    pub(super) sampling: Sampling,
    /// The options asked for.
    pub(super) options: MeshOptions,
    /// Spacing of every piece.
    pub(super) fineness: Vec<Fineness>,
}

impl<'g> MeshLayout<'g> {
    /// Samples all rims together.
    pub(super) fn new(garment: &'g Garment, options: MeshOptions) -> Result<Self, MeshError> {
        let fineness = limits::fineness(garment, options.spacing)?;
        let edges = EdgeTable::new(garment);
        let plans: Vec<_> =
            fineness.iter().enumerate().map(|(n, own)| LinePlan::new(garment, n, &edges, own.spacing)).collect();
        let mut links: Vec<LinkedChains> =
            garment.seams.iter().map(|s| LinkedChains::of_seam(s, garment, &edges)).collect::<Result<_, _>>()?;
        let seams = links.len();
        for (n, piece) in garment.pieces.iter().enumerate().filter(|(_, p)| coons::wanted(p, options.method)) {
            links.extend(coons::links(piece, n, &edges));
        }
        let wishes = wishes_of_edges(garment, &edges, options.method, &fineness);
        let mut seeds: Vec<_> = plans.iter().flat_map(LinePlan::rim_seeds).collect();
        seeds.extend(kinks(garment, &edges));
        let sample = |links: &[LinkedChains]| {
            let breaks = Breaks::close(&edges, links, &seeds, garment)?;
            let sampling = Sampling::new(&edges, links, &breaks, &wishes)?;
            Ok((breaks, sampling))
        };
        // Straight columns are a wish: if the seams do not allow them, the band becomes a grid.
        let sampled = sample(&links).or_else(|error: MeshError| {
            if links.len() == seams {
                return Err(error);
            }
            links.truncate(seams);
            sample(&links)
        });
        let (breaks, sampling) = sampled?;
        Ok(Self { garment, edges, plans, links, breaks, sampling, options, fineness })
    }

    /// Number of the first edge of piece `n`.
    pub(super) fn first_edge(&self, n: usize) -> usize {
        self.edges.number(EdgeId { piece: n, ring: 0, index: 0 }).unwrap_or(0)
    }

    /// Particles of a line along edges, as (edge number, position along the edge). Doubled where two edges meet.
    pub(super) fn rim_chain(&self, line: &RimLine) -> Vec<(usize, usize)> {
        let stretch = |&(edge, ends): &(usize, [f64; 2])| {
            let [a, b] = ends.map(|s| self.sampling.particle_of_break(edge, self.breaks.nearest(edge, s)));
            let ks: Vec<usize> = if a <= b { (a..=b).collect() } else { (b..=a).rev().collect() };
            ks.into_iter().map(move |k| (edge, k))
        };
        line.stretches.iter().flat_map(stretch).collect()
    }

    /// The links that are seams.
    pub(super) fn seam_links(&self) -> &[LinkedChains] {
        &self.links[..self.garment.seams.len()]
    }

    /// Particles of one side of a link, in its direction, as (edge number, position along the edge). Doubled where two
    /// runs meet.
    pub(super) fn chain(&self, link: &LinkedChains, side: usize) -> Vec<(usize, usize)> {
        let runs = self.breaks.runs(link, side);
        runs.iter().flat_map(|r| self.sampling.particles_of_run(r).into_iter().map(|k| (r.edge, k))).collect()
    }
}

/// Sampling of every edge: that of its piece, with [`ACROSS_BAND`] springs across a band.
fn wishes_of_edges(garment: &Garment, edges: &EdgeTable, method: MeshMethod, fineness: &[Fineness]) -> Vec<Wish> {
    let of_piece = |id: &EdgeId| Wish { least: 1, spacing: fineness[id.piece].spacing };
    let mut wishes: Vec<Wish> = edges.ids.iter().map(of_piece).collect();
    let bands =
        garment.pieces.iter().enumerate().filter(|(n, p)| fineness[*n].narrow.is_none() && coons::wanted(p, method));
    for (piece, p) in bands {
        let ends = coons::ends_of_band(p).into_iter().flatten();
        let ends = ends.filter_map(|index| edges.number(EdgeId { piece, ring: 0, index }));
        ends.for_each(|edge| wishes[edge].least = ACROSS_BAND);
    }
    wishes
}

/// Places where an edge turns sharply.
fn kinks(garment: &Garment, edges: &EdgeTable) -> Vec<(usize, f64)> {
    let mut out = Vec::new();
    for (e, id) in edges.ids.iter().enumerate() {
        let path = &garment.pieces[id.piece].loops[id.ring][id.index].path;
        let joints = path.joints();
        let inner = joints.iter().skip(1).take(joints.len().saturating_sub(2));
        out.extend(
            inner.filter(|&&s| path.tangent(s - BESIDE).angle(&path.tangent(s + BESIDE)) > KINK).map(|&s| (e, s)),
        );
    }
    out
}
