//! `garment.obj` and `sewn.obj`.

use std::fmt::Write;

use crate::geometry::{MM, Vec3};
use crate::mesh::ClothMesh;
use crate::verify::Welded;

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
    let mut out = String::with_capacity(48 * lines);
    // Writing to a String cannot fail, so the results below carry nothing.
    let _ =
        writeln!(out, "# toile {}: {name}; millimetres, y up; vt = flat position (x, -y)", env!("CARGO_PKG_VERSION"));
    for p in &welded.surface.vertices {
        let _ = writeln!(out, "v {:.6} {:.6} {:.6}", p.x * MM, p.y * MM, p.z * MM);
    }
    for p in &mesh.flat {
        let _ = writeln!(out, "vt {:.6} {:.6}", p.x * MM, -p.y * MM);
    }
    for n in welded.surface.vertex_normals() {
        let _ = writeln!(out, "vn {:.6} {:.6} {:.6}", n.x, n.y, n.z);
    }
    for piece in &mesh.pieces {
        let _ = writeln!(out, "g {}", piece.name);
        for t in piece.triangles.clone() {
            let [a, b, c] = [0, 1, 2].map(|k| corner(welded.surface.triangles[t][k], welded.corners[t][k]));
            let _ = writeln!(out, "f {a} {b} {c}");
        }
    }
    out
}

/// `vertex/texture/normal`, counted from one.
fn corner(vertex: u32, particle: u32) -> String {
    format!("{v}/{t}/{v}", v = vertex + 1, t = particle + 1)
}
