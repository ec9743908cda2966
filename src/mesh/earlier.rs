//! From the mesh of an earlier garment to that of the garment as it has become.

use std::collections::HashSet;
use std::ops::Range;

use nalgebra::SVector;

use super::transfer::{Place, at, between, shares};
use super::{ClothMesh, EdgeParticles, PieceMesh};
use crate::geometry::{Locator, Vec2, Vec3, box_of};

/// The mesh of an earlier garment, as far as its results tell.
#[derive(Clone, Debug, Default)]
pub struct EarlierMesh {
    /// Flat position of every particle, metres.
    pub flat: Vec<Vec2>,
    /// Corners of every triangle.
    pub triangles: Vec<[u32; 3]>,
    /// The pieces.
    pub pieces: Vec<EarlierPiece>,
    /// Distance of neighbouring particles, metres.
    pub spacing: f64,
}

/// A piece of an earlier garment.
#[derive(Clone, Debug, Default)]
pub struct EarlierPiece {
    /// Its name.
    pub name: String,
    /// Its triangles.
    pub triangles: Range<usize>,
    /// Its edges by name, with the particles along them.
    pub edges: Vec<(String, Vec<u32>)>,
}

/// Cloth goes on straight beyond an edge that has been moved outward by no more than this, in earlier spacings.
const BEYOND: f64 = 1.0;

/// How edges are laid on the earlier ones of their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edges {
    /// All of them at the same shares of their lengths.
    Shares,
    /// Edges that no seam joins are left to their neighbours, if they have not moved far outward: what has been added
    /// beyond them hangs on straight, and edges that end there are measured from their other end. Seams stay closed
    /// only if both sides have been changed alike.
    Loose,
}

impl EarlierMesh {
    /// Positions of the particles of `mesh` where the cloth of the earlier garment lies, whose particles are at `x`.
    /// None for the particles of pieces that it did not have.
    ///
    /// Edges lie on those of their names, as `edges` says. Cloth between them is displaced as they are, as the nearer
    /// ones most. So seams that were closed stay closed however the pieces have been redrawn, and the cloth is only
    /// strained.
    ///
    /// # Panics
    /// When `x` has not as many positions as there are particles, or a corner is no particle.
    pub fn carry(&self, x: &[Vec3], mesh: &ClothMesh, edges: Edges) -> Vec<Option<Vec3>> {
        let mut out = vec![None; mesh.flat.len()];
        let sewn: HashSet<u32> = mesh.seams.iter().flat_map(|seam| seam.pairs.iter().flatten().copied()).collect();
        for (piece, earlier) in mesh.pieces.iter().zip(self.pieces_of(mesh)) {
            let Some(earlier) = earlier else { continue };
            let locator = Locator::new(&self.flat, &self.triangles[earlier.triangles.clone()], self.spacing);
            let is_loose = |edge: &&EdgeParticles| {
                let inner = &edge.particles[1..edge.particles.len() - 1];
                let lies_near = |n: &u32| locator.place(mesh.flat[*n as usize]).1.iter().all(|w| *w > -BEYOND);
                edges == Edges::Loose && inner.iter().all(|n| !sewn.contains(n)) && edge.particles.iter().all(lies_near)
            };
            let loose: Vec<&EdgeParticles> = piece.edges.iter().filter(is_loose).collect();
            let mut rim: Vec<(Vec2, Vec2)> = Vec::new();
            for edge in piece.edges.iter().filter(|edge| !loose.iter().any(|l| std::ptr::eq(*l, *edge))) {
                let Some((_, chain)) = earlier.edges.iter().find(|(name, _)| *name == edge.name) else { continue };
                for (&n, place) in edge.particles.iter().zip(self.places_on(chain, edge, &loose, mesh)) {
                    rim.push((mesh.flat[n as usize], at(&place, &self.flat) - mesh.flat[n as usize]));
                    out[n as usize] = Some(at(&place, x));
                }
            }
            for n in piece.particles.clone() {
                let flat = mesh.flat[n] + interpolated(&rim, mesh.flat[n]);
                out[n].get_or_insert_with(|| at(&locator.place(flat), x));
            }
        }
        out
    }

    /// Places of the particles of an `edge` on an earlier edge: at the same shares of the length, or at the same
    /// lengths from the one end that is not that of a `loose` edge.
    fn places_on(&self, chain: &[u32], edge: &EdgeParticles, loose: &[&EdgeParticles], mesh: &ClothMesh) -> Vec<Place> {
        let ends = |edge: &EdgeParticles| [edge.particles[0], edge.particles[edge.particles.len() - 1]];
        let is_loose = ends(edge).map(|n| loose.iter().any(|edge| ends(edge).contains(&n)));
        let (own, theirs) = (shares(&mesh.flat, &edge.particles), shares(&self.flat, chain));
        let ratio = length(&mesh.flat, &edge.particles) / length(&self.flat, chain).max(f64::MIN_POSITIVE);
        let share = |share: f64| match is_loose {
            [false, true] => share * ratio,
            [true, false] => 1.0 - (1.0 - share) * ratio,
            _ => share,
        };
        own.into_iter().map(|own| between(chain, &theirs, share(own))).collect()
    }

    /// The earlier piece of every piece of `mesh`: that of its name, or else one without a namesake whose drawing lies
    /// in the same place.
    fn pieces_of(&self, mesh: &ClothMesh) -> Vec<Option<&EarlierPiece>> {
        let named = |name: &str| self.pieces.iter().find(|p| p.name == name);
        let is_left = |p: &&EarlierPiece| mesh.pieces.iter().all(|own| own.name != p.name);
        let mut left: Vec<&EarlierPiece> = self.pieces.iter().filter(is_left).collect();
        let extent = |points: &[Vec2]| box_of(points.iter().copied());
        let of = |piece: &PieceMesh| {
            named(&piece.name).or_else(|| {
                let own = extent(&mesh.flat[piece.particles.clone()]);
                let corners = |p: &EarlierPiece| self.triangles[p.triangles.clone()].iter().flatten();
                let drawn = |p: &EarlierPiece| corners(p).map(|&n| self.flat[n as usize]).collect::<Vec<Vec2>>();
                let is_there = |p: &&EarlierPiece| {
                    let there = extent(&drawn(p));
                    own.iter().zip(there).all(|(a, b)| (a - b).norm() <= self.spacing)
                };
                let k = left.iter().position(is_there)?;
                Some(left.remove(k))
            })
        };
        mesh.pieces.iter().map(of).collect()
    }
}

/// The value at a point `p` of a piece of which values are `given` at others: their mean, weighted by the inverse
/// fourth powers of the distances (Shepard 1968). With squares the far points of a long band, which are many, would
/// weigh as much as the nearest. Zero without any.
pub fn interpolated<const D: usize>(given: &[(Vec2, SVector<f64, D>)], p: Vec2) -> SVector<f64, D> {
    let (mut sum, mut whole) = (SVector::zeros(), 0.0);
    for (at, value) in given {
        let weight = (at - p).norm_squared().powi(-2);
        if !weight.is_finite() {
            return *value;
        }
        sum += value * weight;
        whole += weight;
    }
    if whole > 0.0 { sum / whole } else { SVector::zeros() }
}

/// Length of a chain of particles, metres.
fn length(flat: &[Vec2], chain: &[u32]) -> f64 {
    chain.windows(2).map(|ends| (flat[ends[1] as usize] - flat[ends[0] as usize]).norm()).sum()
}
