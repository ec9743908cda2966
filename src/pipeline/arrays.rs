//! The draped garment as arrays, for programs that take it over from memory.

use super::run::Run;
use crate::geometry::{KPA, MM};
use crate::report::{pressure, thread_strains};
use crate::verify::{Welded, distances};

/// The surface of `garment.obj`, with what was measured on it. Lengths are millimetres.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Arrays {
    /// Positions, y up, where the body's own file has the body.
    pub vertices: Vec<[f64; 3]>,
    /// Vertices of every triangle, counter-clockwise seen from the right side of the cloth.
    pub faces: Vec<[u32; 3]>,
    /// Flat position (x, −y) at every corner of every triangle.
    pub uv: Vec<[[f64; 2]; 3]>,
    /// Names of the pieces.
    pub pieces: Vec<String>,
    /// The piece of every triangle.
    pub piece_of_face: Vec<u32>,
    /// Strain of warp and weft, as fractions, at every corner of every triangle.
    pub strain: Vec<[[f64; 2]; 3]>,
    /// Distance of every vertex from the body.
    pub ease: Vec<f64>,
    /// Pressure of every vertex on the body, kPa. Empty where the forces are not known.
    pub pressure: Vec<f64>,
}

impl Run<'_> {
    /// The draped garment, if it has been draped.
    pub fn arrays(&self) -> Option<Arrays> {
        let (mesh, class, at) = (&self.job.mesh, self.class(), self.draped.as_deref()?);
        let welded = Welded::new(mesh, &class, at);
        let corner = |particle: u32| mesh.flat[particle as usize];
        let strains = thread_strains(mesh, at);
        let threads = |particle: u32| [0, 1].map(|way| strains[particle as usize][way]);
        let far = distances(&welded.surface.vertices, &self.job.body.mesh);
        let pressed = self.pressed.as_ref().map(|forces| pressure(&welded, &class, forces)).unwrap_or_default();
        let numbers = |k: u32, count: usize| std::iter::repeat_n(k, count);
        let frame = &self.job.body.frame;
        Some(Arrays {
            vertices: welded.surface.vertices.iter().map(|p| (frame.to_file(*p) * MM).into()).collect(),
            faces: welded.surface.triangles.clone(),
            uv: welded.corners.iter().map(|t| t.map(|p| [corner(p).x * MM, -corner(p).y * MM])).collect(),
            pieces: mesh.pieces.iter().map(|piece| piece.name.clone()).collect(),
            piece_of_face: (0..).zip(&mesh.pieces).flat_map(|(k, p)| numbers(k, p.triangles.len())).collect(),
            strain: welded.corners.iter().map(|t| t.map(threads)).collect(),
            ease: far.into_iter().map(|far| far * MM).collect(),
            pressure: pressed.into_iter().map(|pascal| KPA * pascal).collect(),
        })
    }
}
