//! Straps that cross are put on uncrossed, and their ends are led to where they belong afterwards.
//!
//! Two straps that cross give the glued surface a handle, and no dealing of the body's ends fits a surface with a
//! handle. Where a mirrored pair of seams or closures exchanges its partners, the straps run side by side: the handle
//! is gone, and the garment can be put on as any other.

use std::collections::BTreeSet;

use super::cloth::Distances;
use super::glue::{Glued, glued};
use super::laps::matched;
use crate::geometry::{DisjointSets, Vec2, Vec3};
use crate::mesh::{ClothMesh, UncrossedStraps};
use crate::pattern::{Closure, Garment, Piece, Seam, Span};

/// A strap that crosses another is led across over this share of its length: that of dungarees crosses below the
/// shoulder blades.
const SLANTED: f64 = 0.5;

/// Two seams or closures, each the mirror image of the other, that exchange their partners for the start.
#[derive(Clone, Debug)]
pub(super) enum Exchange {
    /// Numbers of the two seams, and the side of each (0 = `a`) that moves.
    Seams([usize; 2], usize),
    /// The numbers (closure, tack) of two rows of points, and the end of each (0 = first) that moves.
    Closures([Vec<[usize; 2]>; 2], usize),
}

/// A garment with its straps uncrossed. `None` where no straps cross.
pub fn uncrossed(garment: &Garment, mesh: &ClothMesh) -> Option<UncrossedStraps> {
    if Exchange::all(garment).is_empty() {
        return None;
    }
    let exchange = glued(garment, mesh, &[]).1?;
    let mut sets = DisjointSets::new(mesh.flat.len());
    for k in 0..mesh.seams.len() {
        for [a, b] in exchange.pairs(mesh, k) {
            sets.join(a, b);
        }
    }
    let weld = (0..mesh.flat.len() as u32).map(|p| sets.root(p)).collect();
    Some(UncrossedStraps { weld, closures: exchange.closures(garment) })
}

/// The end of a strap that starts beside its place.
#[derive(Clone, Debug, PartialEq)]
pub struct CrossedEnd {
    /// Particles of the end.
    pub end: Vec<u32>,
    /// Particles that it is welded to for the start.
    pub from: Vec<u32>,
    /// Particles that it is sewn or buttoned to.
    pub to: Vec<u32>,
    /// Whether its strap lies over the other.
    pub is_over: bool,
}

impl Exchange {
    /// All exchanges that a garment allows, whether its straps cross or not.
    pub(super) fn all(garment: &Garment) -> Vec<Self> {
        let mirror = Mirror::new(garment);
        let seams = (0..garment.seams.len()).filter_map(|k| mirror.seams(garment, k));
        seams.chain(mirror.closures(garment)).collect()
    }

    /// The pairs of particles that seam `k` joins, once exchanged.
    pub(super) fn pairs(&self, mesh: &ClothMesh, k: usize) -> Vec<[u32; 2]> {
        let Self::Seams(seams, moving) = self else { return mesh.seams[k].pairs.clone() };
        let Some(number) = seams.iter().position(|seam| *seam == k) else { return mesh.seams[k].pairs.clone() };
        // The exchanged end is shifted across, not mirrored: its left side stays on the left.
        let mut end = side_of(mesh, seams[1 - number], *moving);
        end.reverse();
        matched(&side_of(mesh, k, 1 - moving), &end)
    }

    /// The closures of the garment, once exchanged.
    pub(super) fn closures(&self, garment: &Garment) -> Vec<Closure> {
        let mut out = garment.closures.clone();
        if let Self::Closures([one, other], moving) = self {
            for ([k, i], [l, j]) in one.iter().zip(other) {
                let ends = [garment.closures[*k].tacks[*i], garment.closures[*l].tacks[*j]];
                out[*k].tacks[*i][1 - moving] = ends[1][1 - moving];
                out[*l].tacks[*j][1 - moving] = ends[0][1 - moving];
            }
        }
        out
    }

    /// The two ends that start beside their places.
    pub(super) fn ends(&self, garment: &Garment, mesh: &ClothMesh) -> [CrossedEnd; 2] {
        [0, 1].map(|number| {
            let of = |number: usize, side: usize| -> Vec<u32> {
                match self {
                    Self::Seams(seams, _) => side_of(mesh, seams[number], side),
                    Self::Closures(rows, _) => {
                        let end = |[k, i]: &[usize; 2]| garment.closures[*k].tacks[*i][side];
                        let nearest = |(piece, at): (usize, Vec2)| Some(mesh.nearest(piece, at)? as u32);
                        rows[number].iter().map(end).filter_map(nearest).collect()
                    }
                }
            };
            let (Self::Seams(_, moving) | Self::Closures(_, moving)) = *self;
            CrossedEnd {
                end: of(number, moving),
                from: of(1 - number, 1 - moving),
                to: of(number, 1 - moving),
                is_over: number == 0,
            }
        })
    }
}

impl CrossedEnd {
    /// How far on the cloth of `glued` it starts from its place, metres.
    pub(super) fn shift(&self, glued: &Glued, mesh: &ClothMesh) -> f64 {
        let far = Distances::new(glued, mesh).from(&nodes(glued, &self.to));
        nodes(glued, &self.from).into_iter().map(|n| far[n as usize]).fold(0.0, f64::max)
    }

    /// The way to its place from where it starts, when the particles are at `x`. `None` if one of the two has no place.
    pub(super) fn way(&self, x: &[Option<Vec3>]) -> Option<Vec3> {
        let middle = |particles: &[u32]| {
            let places: Vec<Vec3> = particles.iter().filter_map(|p| x[*p as usize]).collect();
            (!places.is_empty()).then(|| places.iter().sum::<Vec3>() / places.len() as f64)
        };
        Some(middle(&self.to)? - middle(&self.from)?)
    }

    /// The particles of its strap that are led across, with the share of the way across that is left: 1 at the end, 0
    /// where the strap has come to run straight.
    pub(super) fn slanted(&self, mesh: &ClothMesh, glued: &Glued) -> Vec<(usize, f64)> {
        let far = Distances::new(glued, mesh).from(&nodes(glued, &self.end));
        let pieces: BTreeSet<usize> = self.end.iter().filter_map(|p| mesh.piece_of(*p)).collect();
        let particles = pieces.into_iter().flat_map(|piece| mesh.pieces[piece].particles.clone());
        let strap: Vec<(usize, f64)> = particles.filter_map(|p| Some((p, far[glued.node_of[p]? as usize]))).collect();
        let length = strap.iter().map(|s| s.1).fold(0.0, f64::max);
        strap.into_iter().map(|(p, far)| (p, (1.0 - far / (SLANTED * length)).clamp(0.0, 1.0))).collect()
    }
}

/// Particles of one side (0 = `a`) of seam `k`, in order.
fn side_of(mesh: &ClothMesh, k: usize, side: usize) -> Vec<u32> {
    mesh.seams[k].pairs.iter().map(|pair| pair[side]).collect()
}

/// The nodes of particles of a surface.
fn nodes(glued: &Glued, particles: &[u32]) -> Vec<u32> {
    particles.iter().filter_map(|p| glued.node_of[*p as usize]).collect()
}

/// For every piece the other half of its pair.
struct Mirror(Vec<Option<usize>>);

impl Mirror {
    fn new(garment: &Garment) -> Self {
        let pieces = &garment.pieces;
        let twin = |own: &Piece| pieces.iter().position(|piece| piece.is_twin(own));
        Self(pieces.iter().map(twin).collect())
    }

    /// The edges of a chain, mirrored or as they are. An edge of a piece that is no half of a pair has no name here:
    /// its mirror image is another edge of the same piece.
    fn chain<'g>(&self, garment: &'g Garment, chain: &[Span], is_mirrored: bool) -> BTreeSet<(usize, &'g str)> {
        let edge = |span: &Span| match self.0[span.edge.piece] {
            Some(half) => {
                let name = garment.pieces[span.edge.piece].loops[span.edge.ring][span.edge.index].name.as_str();
                (if is_mirrored { half } else { span.edge.piece }, name)
            }
            None => (span.edge.piece, ""),
        };
        chain.iter().map(edge).collect()
    }

    /// Whether all pieces of a chain are halves of pairs.
    fn is_half(&self, chain: &[Span]) -> bool {
        chain.iter().all(|span| self.0[span.edge.piece].is_some())
    }

    /// The exchange of a seam with a later one that is its mirror image.
    fn seams(&self, garment: &Garment, k: usize) -> Option<Exchange> {
        let seam = &garment.seams[k];
        let chains = |seam: &Seam, is_mirrored| [&seam.a, &seam.b].map(|chain| self.chain(garment, chain, is_mirrored));
        let mirrored = chains(seam, true);
        let other = (k + 1..garment.seams.len()).find(|&other| chains(&garment.seams[other], false) == mirrored)?;
        let area = |chain: &[Span]| -> f64 { chain.iter().map(|span| garment.pieces[span.edge.piece].area()).sum() };
        let moving = usize::from(area(&seam.b) <= area(&seam.a));
        self.is_half([&seam.a, &seam.b][moving]).then_some(Exchange::Seams([k, other], moving))
    }

    /// The exchanges of the closures between two pieces with those between their mirror images.
    fn closures(&self, garment: &Garment) -> Vec<Exchange> {
        let mut rows: Vec<([usize; 2], Vec<[usize; 2]>)> = Vec::new();
        for (k, closure) in garment.closures.iter().enumerate() {
            for (i, tack) in closure.tacks.iter().enumerate() {
                let pieces = tack.map(|end| end.0);
                match rows.iter_mut().find(|row| row.0 == pieces) {
                    Some(row) => row.1.push([k, i]),
                    None => rows.push((pieces, vec![[k, i]])),
                }
            }
        }
        let exchange = |(n, (pieces, row)): (usize, &([usize; 2], Vec<[usize; 2]>))| {
            let mirrored = pieces.map(|piece| self.0[piece].unwrap_or(piece));
            let (_, other) =
                rows[n + 1..].iter().find(|(pieces, other)| *pieces == mirrored && other.len() == row.len())?;
            let [a, b] = pieces.map(|piece| garment.pieces[piece].area());
            let moving = usize::from(b <= a);
            self.0[pieces[moving]].is_some().then(|| Exchange::Closures([row.clone(), other.clone()], moving))
        };
        rows.iter().enumerate().filter_map(exchange).collect()
    }
}
