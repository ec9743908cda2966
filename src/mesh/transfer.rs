//! From one mesh of a garment to another, coarser or finer.

use nalgebra::SVector;

use super::ClothMesh;
use crate::geometry::{Locator, Vec2, Vec3, shares_along};

/// Places of the particles of one mesh in another mesh of the same garment. A particle lies in the triangle of its
/// piece that holds its flat position, or is extrapolated from the nearest one, because a coarser rim cuts off curves.
/// A particle of an edge lies on that edge at the same share of its length, so that seams stay closed.
#[derive(Clone, Debug)]
pub struct Transfer {
    places: Vec<Place>,
}

/// A place in a mesh: the corners of a triangle and their weights, which sum to 1.
pub(super) type Place = ([u32; 3], [f64; 3]);

/// The point of a place, from those of the particles.
pub(super) fn at<const D: usize>((corners, weights): &Place, x: &[SVector<f64, D>]) -> SVector<f64, D> {
    corners.iter().zip(weights).map(|(&n, &w)| x[n as usize] * w).sum()
}

impl Transfer {
    /// Finds the particles of `to` in `from`.
    ///
    /// # Panics
    /// When the two are not meshes of one garment.
    pub fn new(from: &ClothMesh, to: &ClothMesh) -> Self {
        assert_eq!(from.pieces.len(), to.pieces.len(), "meshes of different garments");
        let mut places = Vec::with_capacity(to.flat.len());
        for (source, target) in from.pieces.iter().zip(&to.pieces) {
            let locator = Locator::new(&from.flat, &from.triangles[source.triangles.clone()], from.spacing);
            places.extend(to.flat[target.particles.clone()].iter().map(|&p| locator.place(p)));
            for (edge, finer) in source.edges.iter().zip(&target.edges) {
                let along = (shares(&from.flat, &edge.particles), shares(&to.flat, &finer.particles));
                for (&n, &share) in finer.particles.iter().zip(&along.1) {
                    places[n as usize] = between(&edge.particles, &along.0, share);
                }
            }
        }
        Self { places }
    }

    /// Positions of the particles of the one mesh from those of the other.
    pub fn apply(&self, x: &[Vec3]) -> Vec<Vec3> {
        self.places.iter().map(|place| at(place, x)).collect()
    }
}

/// Share of the length of a chain at each of its particles, 0 … 1. All are 0 if it has no length.
pub(super) fn shares(flat: &[Vec2], chain: &[u32]) -> Vec<f64> {
    shares_along(chain.iter().map(|&n| flat[n as usize])).unwrap_or_else(|| vec![0.0; chain.len()])
}

/// The place `share` of the way along a chain whose particles are at `shares` of it.
pub(super) fn between(chain: &[u32], shares: &[f64], share: f64) -> Place {
    let k = shares.partition_point(|s| *s <= share).clamp(1, chain.len() - 1);
    let t = (share - shares[k - 1]) / (shares[k] - shares[k - 1]).max(f64::MIN_POSITIVE);
    ([chain[k - 1], chain[k], chain[k]], [1.0 - t, t, 0.0])
}
