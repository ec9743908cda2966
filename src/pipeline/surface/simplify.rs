//! Scans of millions of triangles with fewer of them.

use crate::geometry::{MM, decimated, triangles_of};
use crate::io::obj_read::ObjFaces;

/// Leaves out vertices of a surface as long as none of them is further than `tolerance` metres from the triangles that
/// are left; says how many those are and how far off they lie at most. Its texture is left out. `same` has the vertex
/// that stands for every vertex, `metres` is the unit of the file.
pub(super) fn simplify(faces: &mut ObjFaces, same: &[u32], metres: f64, tolerance: f64) -> String {
    let mut triangles = Vec::new();
    for (face, &group) in faces.faces.iter().zip(&faces.group_of_face) {
        let corners: Vec<u32> = face.iter().map(|&v| same[v as usize]).collect();
        if corners.len() > 2 {
            triangles.extend(triangles_of(&faces.vertices, &corners).into_iter().map(|t| (t, group)));
        }
    }
    let before = triangles.len();
    let fewer = decimated(&faces.vertices, &triangles, tolerance / metres);
    let error = fewer.error * metres * MM;
    let count = fewer.triangles.len();
    (faces.faces, faces.group_of_face) = fewer.triangles.into_iter().map(|(t, group)| (t.to_vec(), group)).unzip();
    faces.texture_of_face = vec![Vec::new(); count];
    format!(
        "{before} triangles are simplified to {count}; no vertex of the file is further than {error:.3} mm from them"
    )
}
