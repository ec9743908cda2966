//! STL: triangles, each with three corners of its own. No crate is used: the format is a list of numbers.

use super::bytes::{Cursor, NumberKind};
use crate::geometry::Vec3;
use crate::io::obj_read::ObjFaces;

/// Bytes before the count of triangles of a binary file.
const HEADER: usize = 80;
/// Bytes before its triangles.
const START: usize = HEADER + 4;
/// Bytes of a triangle: its normal, its corners, and two that mean nothing.
const TRIANGLE: usize = 50;

/// Whether a file is as long as a binary STL with its count of triangles, or reads as one of text.
pub(super) fn is_stl(bytes: &[u8]) -> bool {
    is_binary(bytes) || is_text(bytes)
}

fn is_binary(bytes: &[u8]) -> bool {
    let count = bytes.get(HEADER..START).and_then(|b| Cursor::new(b, false).number(NumberKind::U32));
    count.is_some_and(|count| bytes.len() as f64 == START as f64 + count * TRIANGLE as f64)
}

fn is_text(bytes: &[u8]) -> bool {
    /// Both words stand within the first lines.
    const LOOKED_AT: usize = 1024;
    let begin = String::from_utf8_lossy(&bytes[..bytes.len().min(LOOKED_AT)]);
    begin.trim_start().starts_with("solid") && begin.contains("facet")
}

/// The triangles of a file of either form.
pub(super) fn read(bytes: &[u8]) -> Result<ObjFaces, String> {
    let corners = if is_binary(bytes) { binary(bytes) } else { text(bytes)? };
    let count = corners.len() as u32 / 3;
    Ok(ObjFaces {
        vertices: corners,
        faces: (0..count).map(|k| vec![3 * k, 3 * k + 1, 3 * k + 2]).collect(),
        texture_of_face: vec![Vec::new(); count as usize],
        groups: vec![String::new()],
        group_of_face: vec![0; count as usize],
        ..ObjFaces::default()
    })
}

fn binary(bytes: &[u8]) -> Vec<Vec3> {
    /// Of the normal, which the corners say as well.
    const NORMAL: usize = 12;
    let mut out = Vec::new();
    for triangle in bytes[START..].chunks_exact(TRIANGLE) {
        let mut numbers = Cursor::new(&triangle[NORMAL..], false);
        let mut next = || numbers.number(NumberKind::F32).unwrap_or(f64::NAN);
        out.extend([0; 3].map(|_| Vec3::new(next(), next(), next())));
    }
    out
}

fn text(bytes: &[u8]) -> Result<Vec<Vec3>, String> {
    let text = String::from_utf8_lossy(bytes);
    let mut out = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        if words.next() == Some("vertex") {
            let read: Vec<f64> = words.filter_map(|w| w.parse().ok()).collect();
            let [x, y, z] = read[..] else { return Err(format!("line {}: a vertex is three numbers", number + 1)) };
            out.push(Vec3::new(x, y, z));
        } else if line.trim_start().starts_with("endfacet") && out.len() % 3 != 0 {
            return Err(format!("line {}: a facet has three vertices", number + 1));
        }
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_forms_are_read() {
        let text = b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1.5 0 0\nvertex 0 1 2\nendloop\n\
                     endfacet\nendsolid";
        let mut binary = vec![0; HEADER];
        binary.extend(1u32.to_le_bytes());
        [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, 1.0, 2.0]
            .iter()
            .for_each(|x: &f32| binary.extend(x.to_le_bytes()));
        binary.extend([0; 2]);
        for bytes in [&text[..], &binary] {
            assert!(is_stl(bytes));
            let read = read(bytes).expect("a triangle");
            assert_eq!(read.vertices, [Vec3::zeros(), Vec3::new(1.5, 0.0, 0.0), Vec3::new(0.0, 1.0, 2.0)]);
            assert_eq!(read.faces, [[0, 1, 2]]);
        }
        assert!(!is_stl(b"v 0 0 0") && !is_stl(b"") && !is_stl(&binary[..100]));
        assert_eq!(read(b"solid a\nfacet\nvertex 1 2\n"), Err("line 3: a vertex is three numbers".into()));
    }
}
