//! Surfaces out of the files that 3D programs and scanners write: OBJ, PLY, STL and GLB.

mod bytes;
mod glb;
mod ply;
mod stl;

use std::path::Path;

use super::obj_read::{ObjError, ObjFaces, obj_bytes, parse_obj_faces};

/// Reads a surface. The format is told by the file's first bytes; STL, whose binary form has no mark, by its length.
///
/// # Errors
/// [`ObjError`]: a file that cannot be read, is damaged, or has no faces.
pub fn read_surface(path: &Path) -> Result<ObjFaces, ObjError> {
    let file = path.display().to_string();
    let bytes = obj_bytes(path)?;
    let damaged = |format: &str, why: String| ObjError::Read { file: file.clone(), why: format!("{format}: {why}") };
    let faces = if bytes.starts_with(glb::MAGIC) {
        glb::read(&bytes).map_err(|why| damaged("GLB", why))?
    } else if ply::is_ply(&bytes) {
        ply::read(&bytes).map_err(|why| damaged("PLY", why))?
    } else if stl::is_stl(&bytes) {
        stl::read(&bytes).map_err(|why| damaged("STL", why))?
    } else {
        // Only comments and names are ever other than ASCII.
        return parse_obj_faces(&String::from_utf8_lossy(&bytes), &file);
    };
    if faces.faces.is_empty() {
        return Err(ObjError::Empty { file });
    }
    // As in an OBJ file, whose other readers keep 32 bits: what overflows there is no surface in any unit.
    match faces.vertices.iter().position(|p| p.iter().any(|x| !(*x as f32).is_finite())) {
        Some(v) => Err(ObjError::Read { file, why: format!("vertex {} has a coordinate that is not finite", v + 1) }),
        None => Ok(faces),
    }
}
