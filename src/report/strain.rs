//! Strain along the threads, and shear between them.

use std::collections::HashSet;

use super::schema::Spread;
use super::statistics::spread;
use crate::geometry::{Topology, Vec2, Vec3};
use crate::mesh::{ClothMesh, PieceMesh, SpringClass};

/// Changes of the edges and triangles of a piece.
#[derive(Clone, Debug, Default)]
pub(super) struct PieceStrain {
    /// Strain of warp and weft edges (shrinking is negative).
    pub(super) threads: Vec<f64>,
    /// |change of the angle between warp and weft| per triangle, degrees.
    pub(super) shear: Vec<f64>,
    /// Largest |strain| of any edge.
    pub(super) largest: f64,
    /// Mean extension (shrinking is negative) along warp and weft. Zero without such edges.
    pub(super) extension: [f64; 2],
}

impl PieceStrain {
    /// Adds another piece's values. `extension`, which means nothing across pieces, stays.
    pub(super) fn extend(&mut self, other: &Self) {
        self.threads.extend(&other.threads);
        self.shear.extend(&other.shear);
        self.largest = self.largest.max(other.largest);
    }

    pub(super) fn strain(&self) -> Spread {
        spread(self.threads.iter().map(|strain| strain.abs()).collect())
    }

    /// Extension of warp and weft edges, 99th percentile.
    pub(super) fn drawn_out(&self) -> f64 {
        spread(self.threads.iter().map(|strain| strain.max(0.0)).collect()).p99
    }

    pub(super) fn shear(&self) -> Spread {
        spread(self.shear.clone())
    }
}

/// Strain of a piece at the positions `at`. Edges along elastic, between particles `elastic`, are left out, because the
/// gathers there are finer than the grid.
pub(super) fn piece_strain(mesh: &ClothMesh, piece: &PieceMesh, elastic: &HashSet<u32>, at: &[Vec3]) -> PieceStrain {
    let mut out = PieceStrain::default();
    let mut sums = [(0.0, 0.0); 2];
    for (ends, strain) in edge_strains(mesh, piece, at) {
        if ends.iter().all(|p| elastic.contains(p)) {
            continue;
        }
        out.largest = out.largest.max(strain.abs());
        if let Some(thread) = thread(mesh, piece, ends) {
            out.threads.push(strain);
            sums[thread] = (sums[thread].0 + strain, sums[thread].1 + 1.0);
        }
    }
    out.extension = sums.map(|(sum, count)| if count > 0.0 { sum / count } else { 0.0 });
    let triangles = &mesh.triangles[piece.triangles.clone()];
    out.shear = triangles.iter().filter_map(|t| shear(mesh, piece.warp, t, at)).collect();
    out
}

/// Mean extension of every piece along warp and weft (shrinking is negative), without the edges along elastic.
pub fn extensions(mesh: &ClothMesh, at: &[Vec3]) -> Vec<[f64; 2]> {
    let elastic = mesh.on_elastic();
    mesh.pieces.iter().map(|piece| piece_strain(mesh, piece, &elastic, at).extension).collect()
}

/// For every particle, the warp or weft strain of largest size among its edges (negative for compression). Zero if it
/// has no such edge. `--color strain` shows these values.
pub fn vertex_strain(mesh: &ClothMesh, at: &[Vec3]) -> Vec<f64> {
    let mut out = vec![0.0f64; mesh.flat.len()];
    for piece in &mesh.pieces {
        for (ends, strain) in edge_strains(mesh, piece, at) {
            if thread(mesh, piece, ends).is_none() {
                continue;
            }
            for v in ends {
                let held = &mut out[v as usize];
                *held = if strain.abs() > held.abs() { strain } else { *held };
            }
        }
    }
    out
}

/// Every edge of a piece that has a length, with its strain.
fn edge_strains(mesh: &ClothMesh, piece: &PieceMesh, at: &[Vec3]) -> Vec<([u32; 2], f64)> {
    let topology = Topology::new(&mesh.triangles[piece.triangles.clone()]);
    let strain = |ends: [u32; 2]| {
        let [a, b] = ends.map(|v| v as usize);
        let flat = (mesh.flat[b] - mesh.flat[a]).norm();
        (flat > 0.0).then(|| (ends, (at[b] - at[a]).norm() / flat - 1.0))
    };
    topology.edges.iter().filter_map(|e| strain(e.ends)).collect()
}

/// 0 for an edge along the warp, 1 along the weft, none for a bias one.
fn thread(mesh: &ClothMesh, piece: &PieceMesh, ends: [u32; 2]) -> Option<usize> {
    let course = mesh.flat[ends[1] as usize] - mesh.flat[ends[0] as usize];
    match SpringClass::of(course, piece.warp) {
        SpringClass::Warp => Some(0),
        SpringClass::Weft => Some(1),
        SpringClass::Bias => None,
    }
}

/// For every particle the extensions along warp and weft (fractions, negative for compression) and the change of the
/// angle between them (degrees): means over its triangles, weighted by their areas.
pub fn thread_strains(mesh: &ClothMesh, at: &[Vec3]) -> Vec<[f64; 3]> {
    let mut sums = vec![([0.0; 3], 0.0); mesh.flat.len()];
    for piece in &mesh.pieces {
        for triangle in &mesh.triangles[piece.triangles.clone()] {
            let Some((area, images)) = images(mesh, piece.warp, triangle, at) else { continue };
            let [x, y] = images;
            let values = [x.norm() - 1.0, y.norm() - 1.0, angle(x, y).unwrap_or(0.0)];
            for &v in triangle {
                let (sum, weight) = &mut sums[v as usize];
                (0..3).for_each(|k| sum[k] += area * values[k]);
                *weight += area;
            }
        }
    }
    sums.into_iter().map(|(sum, weight)| if weight > 0.0 { sum.map(|s| s / weight) } else { sum }).collect()
}

/// |90° − angle between the images of warp and weft| of a triangle, degrees; none for a triangle without area.
fn shear(mesh: &ClothMesh, warp: Vec2, triangle: &[u32; 3], at: &[Vec3]) -> Option<f64> {
    let (_, [x, y]) = images(mesh, warp, triangle, at)?;
    angle(x, y)
}

/// |90° − angle between two vectors|, degrees. None for one without length.
fn angle(x: Vec3, y: Vec3) -> Option<f64> {
    let size = x.norm() * y.norm();
    (size > 0.0).then(|| (x.dot(&y) / size).clamp(-1.0, 1.0).asin().to_degrees().abs())
}

/// Twice the flat area of a triangle, and the images of the unit vectors along warp and weft. None without area.
fn images(mesh: &ClothMesh, warp: Vec2, triangle: &[u32; 3], at: &[Vec3]) -> Option<(f64, [Vec3; 2])> {
    let [a, b, c] = triangle.map(|v| v as usize);
    let (p, q) = (mesh.flat[b] - mesh.flat[a], mesh.flat[c] - mesh.flat[a]);
    let (u, v) = (at[b] - at[a], at[c] - at[a]);
    let double_area = p.perp(&q);
    // A flat direction d is s·p + t·q by Cramer's rule. Its image is s·u + t·v.
    let image = |d: Vec2| (u * d.perp(&q) + v * p.perp(&d)) / double_area;
    (double_area != 0.0).then(|| (double_area.abs(), [image(warp), image(Vec2::new(-warp.y, warp.x))]))
}
