//! The garment as one surface.

use std::collections::HashMap;

use crate::geometry::{TriMesh, Vec2, Vec3};
use crate::mesh::ClothMesh;

/// A cloth mesh whose stitched particles are one vertex each.
#[derive(Clone, Debug, Default)]
pub struct Welded {
    /// The surface: triangles in the order of the cloth mesh, counter-clockwise seen from the cloth's right side.
    pub surface: TriMesh,
    /// The particles at the corners of every triangle of the surface, corner by corner.
    pub corners: Vec<[u32; 3]>,
    /// The vertex of every particle.
    pub vertex_of: Vec<u32>,
}

impl Welded {
    /// Joins the particles that have the same label in `weld`. A vertex takes the position of its first particle.
    /// Vertices are numbered in the order of their first particles.
    ///
    /// # Panics
    /// When `positions` or `weld` is shorter than the particles of `mesh`: a mistake of the caller.
    pub fn new(mesh: &ClothMesh, weld: &[u32], positions: &[Vec3]) -> Self {
        let mut vertex_of_label: HashMap<u32, u32> = HashMap::new();
        let mut out = Self::default();
        for particle in 0..mesh.flat.len() {
            let vertices = &mut out.surface.vertices;
            let vertex = *vertex_of_label.entry(weld[particle]).or_insert_with(|| {
                vertices.push(positions[particle]);
                vertices.len() as u32 - 1
            });
            out.vertex_of.push(vertex);
        }
        out.corners = mesh.triangles.iter().map(|&t| right_side_out(t, &mesh.flat)).collect();
        out.surface.triangles = out.corners.iter().map(|t| t.map(|p| out.vertex_of[p as usize])).collect();
        out
    }

    /// Of values given per particle, the one of largest size at every vertex.
    pub fn largest(&self, per_particle: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0f64; self.surface.vertices.len()];
        for (&vertex, &value) in self.vertex_of.iter().zip(per_particle) {
            let held = &mut out[vertex as usize];
            *held = if value.abs() > held.abs() { value } else { *held };
        }
        out
    }
}

/// The triangle run counter-clockwise as the reader sees the right side: y points down in the flat, so that is the
/// turn with negative area.
fn right_side_out([a, b, c]: [u32; 3], flat: &[Vec2]) -> [u32; 3] {
    let [p, q, r] = [a, b, c].map(|v| flat[v as usize]);
    if (q - p).perp(&(r - p)) > 0.0 { [a, c, b] } else { [a, b, c] }
}
