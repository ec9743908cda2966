//! Data of a garment for the picture, gathered from its mesh.

use super::Scene;
use crate::geometry::{TriMesh, Vec3, rim_loops};
use crate::mesh::ClothMesh;
use crate::verify::Welded;

/// A garment's surface, pieces, seams and rims, ready to be drawn.
#[derive(Clone, Debug, Default)]
pub struct Dressed {
    welded: Welded,
    piece_of_triangle: Vec<u32>,
    seams: Vec<Vec<Vec3>>,
    rims: Vec<Vec<Vec3>>,
    strain: Option<Vec<f64>>,
}

impl Dressed {
    /// Gathers a garment whose particles are `at`. `weld` has one label per particle, the same for stitched ones.
    /// `strain`, one value per particle, colours the cloth instead of its pieces.
    ///
    /// # Panics
    /// When a slice is shorter than the mesh has particles: a mistake of the caller.
    pub fn new(mesh: &ClothMesh, weld: &[u32], at: &[Vec3], strain: Option<&[f64]>) -> Self {
        let welded = Welded::new(mesh, weld, at);
        let pieces = mesh.pieces.iter().enumerate();
        Self {
            piece_of_triangle: pieces.flat_map(|(k, p)| vec![k as u32; p.triangles.len()]).collect(),
            seams: seam_lines(mesh, &welded),
            rims: rim_lines(&welded.surface),
            strain: strain.map(|values| welded.largest(values)),
            welded,
        }
    }

    /// The garment on a body, with its title and the smaller text beside it.
    pub fn scene<'a>(&'a self, body: &'a TriMesh, title: &'a str, subtitle: &'a str) -> Scene<'a> {
        Scene {
            body,
            cloth: &self.welded.surface,
            piece_of_triangle: &self.piece_of_triangle,
            seams: &self.seams,
            rims: &self.rims,
            title,
            subtitle,
            strain: self.strain.as_deref(),
        }
    }
}

/// The course of every seam, from vertex to vertex where it is stitched.
fn seam_lines(mesh: &ClothMesh, welded: &Welded) -> Vec<Vec<Vec3>> {
    let at = |particle: u32| welded.surface.vertices[welded.vertex_of[particle as usize] as usize];
    let middle = |&[a, b]: &[u32; 2]| (at(a) + at(b)) / 2.0;
    mesh.seams.iter().map(|s| s.pairs.iter().map(middle).collect()).collect()
}

/// The rims of a surface, each closed by repeating its first point.
pub fn rim_lines(cloth: &TriMesh) -> Vec<Vec<Vec3>> {
    let line = |ring: Vec<u32>| ring.iter().chain(ring.first()).map(|&v| cloth.vertices[v as usize]).collect();
    rim_loops(&cloth.triangles).into_iter().map(line).collect()
}
