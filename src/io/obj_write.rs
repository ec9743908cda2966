//! `garment.obj` and `sewn.obj`.

use super::obj_text::{DECIMALS, ObjCorner, ObjText};
use crate::geometry::{MM, Vec3};
use crate::mesh::ClothMesh;
use crate::verify::Welded;

/// Bytes that a line takes at most, with places within ten metres: room for the text is made at once.
const BYTES_OF_A_LINE: usize = 48;

/// The garment as OBJ text: millimetres, y up, one group per piece, six decimals (a nanometre).
///
/// - A vertex is written once for all particles with the same label in `weld`, so the rims of the surface are the
///   garment's openings; normals are the welded surface's.
/// - Texture coordinates are written once per particle: its flat position in mm, `u = x` and `v = −y`. Patterns are
///   drawn y down and texture space is y up, so a print looks as drawn, not mirrored, on the right side of the cloth.
/// - Faces run counter-clockwise seen from the right side.
///
/// # Panics
/// When `weld` or `positions` is shorter than the particles of `mesh`: a mistake of the caller.
pub fn garment_obj(name: &str, mesh: &ClothMesh, weld: &[u32], positions: &[Vec3]) -> String {
    let welded = Welded::new(mesh, weld, positions);
    let lines = 2 * welded.surface.vertices.len() + mesh.flat.len() + mesh.triangles.len();
    let mut obj = ObjText::rounded(DECIMALS, BYTES_OF_A_LINE * lines);
    let version = env!("CARGO_PKG_VERSION");
    obj.comment(format_args!("toile {version}: {name}; millimetres, y up; vt = flat position (x, -y)"));
    welded.surface.vertices.iter().for_each(|p| obj.vertex(&(p * MM)));
    mesh.flat.iter().for_each(|p| obj.texture(&(p * MM)));
    welded.surface.vertex_normals().iter().for_each(|n| obj.normal(n));
    for piece in &mesh.pieces {
        obj.group(&piece.name);
        for t in piece.triangles.clone() {
            obj.face([0, 1, 2].map(|k| corner(welded.surface.triangles[t][k], welded.corners[t][k])));
        }
    }
    obj.into_text()
}

/// A corner of a triangle of the welded surface. Every vertex has its own normal.
fn corner(vertex: u32, particle: u32) -> ObjCorner {
    let vertex = vertex as usize;
    ObjCorner { vertex, texture: Some(particle as usize), normal: Some(vertex) }
}
