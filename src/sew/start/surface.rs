//! The glued surface as lengths: what its edges and folds measure flat.

use super::balloon::Length;
use super::glue::Glued;
use crate::geometry::{MeshEdge, Topology, Vec2, sorted_pair};
use crate::mesh::ClothMesh;

/// The edges of the glued surface, as long as in the flat pieces: along a seam the mean of both sides.
pub(super) fn edges(glued: &Glued, mesh: &ClothMesh) -> Vec<Length> {
    let mut all: Vec<([u32; 2], f64)> = Vec::with_capacity(3 * glued.triangles.len());
    for (t, nodes) in glued.triangles.iter().enumerate() {
        let flat = glued.flat(mesh, t);
        for k in 0..3 {
            let [a, b] = [nodes[k], nodes[(k + 1) % 3]];
            all.push((sorted_pair([a, b]), (flat[(k + 1) % 3] - flat[k]).norm()));
        }
    }
    all.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mean = |run: &[([u32; 2], f64)]| run.iter().map(|l| l.1).sum::<f64>() / run.len() as f64;
    all.chunk_by(|a, b| a.0 == b.0)
        .filter(|run| run[0].0[0] != run[0].0[1])
        .map(|run| Length { ends: run[0].0, rest: mean(run) })
        .collect()
}

/// Nodes opposite to one another across an edge within a piece, as far apart as in the flat piece.
pub(super) fn bending(glued: &Glued, mesh: &ClothMesh) -> Vec<Length> {
    let whole = &glued.corners;
    let across = |edge: &MeshEdge| {
        let [Some(a), Some(b)] = edge.triangles else { return None };
        let third = |t: u32| (0..3).find(|k| !edge.ends.contains(&whole[t as usize][*k]));
        let (i, j) = (third(a)?, third(b)?);
        let flat = |t: u32, k: usize| -> Vec2 { mesh.flat[whole[t as usize][k] as usize] };
        let ends = [glued.triangles[a as usize][i], glued.triangles[b as usize][j]];
        (ends[0] != ends[1]).then(|| Length { ends, rest: (flat(b, j) - flat(a, i)).norm() })
    };
    Topology::new(whole).edges.iter().filter_map(across).collect()
}
