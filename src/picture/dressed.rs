//! Data of a garment for the picture, gathered from its mesh.

use super::{Scale, Scene};
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
    values: Option<(Vec<f64>, Scale)>,
    groups: Vec<String>,
}

impl Dressed {
    /// Gathers a garment whose particles are `at`. `weld` has one label per particle, the same for stitched ones.
    /// `values`, one per particle, colour the cloth instead of its pieces.
    ///
    /// # Panics
    /// When a slice is shorter than the mesh has particles: a mistake of the caller.
    pub fn new(mesh: &ClothMesh, weld: &[u32], at: &[Vec3], values: Option<(&[f64], Scale)>) -> Self {
        let welded = Welded::new(mesh, weld, at);
        let pieces = mesh.pieces.iter().enumerate();
        Self {
            piece_of_triangle: pieces.flat_map(|(k, p)| vec![k as u32; p.triangles.len()]).collect(),
            seams: seam_lines(mesh, &welded),
            rims: rim_lines(&welded.surface),
            values: values.map(|(values, scale)| (welded.largest(values), scale)),
            groups: Vec::new(),
            welded,
        }
    }

    /// Colours groups of pieces instead of pieces: `group` has that of every piece, an index into `names`.
    pub fn grouped(mut self, group: &[u32], names: Vec<String>) -> Self {
        let of = |piece: &u32| group.get(*piece as usize).copied().unwrap_or(0);
        self.piece_of_triangle = self.piece_of_triangle.iter().map(of).collect();
        self.groups = names;
        self
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
            values: self.values.as_ref().map(|(values, scale)| (values.as_slice(), *scale)),
            groups: &self.groups,
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
