//! Seams and rims as polylines.

use crate::geometry::{TriMesh, Vec3, rim_loops};
use crate::mesh::ClothMesh;

/// The course of every seam, from positions per particle.
pub fn seam_lines(mesh: &ClothMesh, at: &[Vec3]) -> Vec<Vec<Vec3>> {
    let middle = |&[a, b]: &[u32; 2]| (at[a as usize] + at[b as usize]) / 2.0;
    mesh.seams.iter().map(|s| s.pairs.iter().map(middle).collect()).collect()
}

/// The rims of a surface, each closed by repeating its first point.
pub fn rim_lines(cloth: &TriMesh) -> Vec<Vec<Vec3>> {
    let line = |ring: Vec<u32>| ring.iter().chain(ring.first()).map(|&v| cloth.vertices[v as usize]).collect();
    rim_loops(&cloth.triangles).into_iter().map(line).collect()
}
