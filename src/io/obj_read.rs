//! Reads the surface out of a Wavefront OBJ file: positions and triangles. The only user of obj-rs.
//!
//! obj-rs reads 32-bit numbers, refuses vertex colours (`v x y z r g b`) and says no line when it fails. So a first
//! pass here reads the positions in full precision, checks every index and hands obj-rs a file of
//! bare `v` and `f` lines.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::path::Path;

use obj::raw::object::Polygon;

use crate::geometry::{Vec3, triangles_of};
use crate::input::{InputError, bytes, shown};

/// Larger files are refused before they are read: at a hundred bytes a triangle this is five million of them.
const LARGEST: u64 = 512 << 20;

/// Characters of a word that an error shows.
const WORD: usize = 60;

/// Why an OBJ file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ObjError {
    /// The system refused.
    #[error("{file}: {why}")]
    Read {
        /// Path.
        file: String,
        /// The system's error.
        why: String,
    },
    /// More than 512 MiB.
    #[error("{file}: {mebibytes} MiB or more; at most 512 MiB are read: reduce the mesh first")]
    TooLarge {
        /// Path.
        file: String,
        /// Size.
        mebibytes: u64,
    },
    /// A line that means nothing.
    #[error("{file}:{line}: {why}")]
    Line {
        /// Path.
        file: String,
        /// From 1.
        line: usize,
        /// The fault, and the form that was expected.
        why: String,
    },
    /// A file without a line.
    #[error("{file}: no line; 'v' and 'l' lines of an OBJ file are expected, or points, three numbers a line")]
    NoLines {
        /// Path.
        file: String,
    },
    /// Faces without an area.
    #[error("{file}: none of its faces has an area: the corners of each lie at one place or on one line")]
    NoArea {
        /// Path.
        file: String,
    },
    /// A file without a surface.
    #[error("{file}: no faces; a surface has 'v' lines for its points and 'f' lines for its faces")]
    Empty {
        /// Path.
        file: String,
    },
}

/// Positions in the file's own unit and triangles; polygons are cut into fans from their first corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjSurface {
    /// Positions as written.
    pub vertices: Vec<Vec3>,
    /// Indices into `vertices`.
    pub triangles: Vec<[u32; 3]>,
}

/// Reads a file; see [`parse_obj`].
///
/// # Errors
/// [`ObjError`] with the line.
pub fn read_obj(path: &Path) -> Result<ObjSurface, ObjError> {
    parse_obj(&obj_text(path)?, &path.display().to_string())
}

/// The bytes of a file of a surface.
pub(super) fn obj_bytes(path: &Path) -> Result<Vec<u8>, ObjError> {
    let file = path.display().to_string();
    bytes(path, LARGEST).map_err(|e| match e {
        InputError::TooLarge { bytes, .. } => ObjError::TooLarge { file, mebibytes: bytes >> 20 },
        other => ObjError::Read { file, why: other.to_string() },
    })
}

/// The text of a file of points, whatever its encoding.
pub(super) fn obj_text(path: &Path) -> Result<String, ObjError> {
    // Only comments and names are ever other than ASCII.
    Ok(String::from_utf8_lossy(&obj_bytes(path)?).into_owned())
}

/// Reads an OBJ's text; `file` names it in errors. Every index is in range and every coordinate finite afterwards.
///
/// # Errors
/// [`ObjError::Line`] for a line that is wrong, [`ObjError::Empty`] when there are no faces.
pub fn parse_obj(text: &str, file: &str) -> Result<ObjSurface, ObjError> {
    let faces = ObjFaces::new(text).map_err(|(line, why)| ObjError::Line { file: file.to_owned(), line, why })?;
    let raw = obj::raw::parse_obj(faces.bare().as_bytes())
        .map_err(|e| ObjError::Read { file: file.to_owned(), why: e.to_string() })?;
    let mut triangles = Vec::with_capacity(raw.polygons.len());
    for polygon in &raw.polygons {
        let Polygon::P(corners) = polygon else { continue };
        let corners: Vec<u32> = corners.iter().map(|&c| c as u32).collect();
        triangles.extend(triangles_of(&faces.vertices, &corners));
    }
    if triangles.is_empty() {
        return Err(ObjError::Empty { file: file.to_owned() });
    }
    Ok(ObjSurface { vertices: faces.vertices, triangles })
}

/// A surface as its file has it: polygons in their order, each in a group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ObjFaces {
    /// Positions as written.
    pub vertices: Vec<Vec3>,
    /// Corners of every face, indices into `vertices`.
    pub faces: Vec<Vec<u32>>,
    /// Texture coordinates as written.
    pub texture: Vec<[f64; 2]>,
    /// Texture coordinates of every face's corners, indices into `texture`; empty for a face without.
    pub texture_of_face: Vec<Vec<u32>>,
    /// Names of the groups that have faces, in the order of their first face: of `g` or `o` lines, and where one of
    /// them has faces of several materials, of `usemtl` lines; empty for faces before the first such line.
    pub groups: Vec<String>,
    /// Index into `groups` of every face.
    pub group_of_face: Vec<u32>,
}

/// Reads a file with its groups, for surfaces that are written back.
///
/// # Errors
/// As [`read_obj`].
pub fn read_obj_faces(path: &Path) -> Result<ObjFaces, ObjError> {
    parse_obj_faces(&obj_text(path)?, &path.display().to_string())
}

/// As [`read_obj_faces`], of an OBJ's text; `file` names it in errors.
///
/// # Errors
/// As [`read_obj`].
pub fn parse_obj_faces(text: &str, file: &str) -> Result<ObjFaces, ObjError> {
    let file = file.to_owned();
    let faces = ObjFaces::new(text).map_err(|(line, why)| ObjError::Line { file: file.clone(), line, why })?;
    if faces.faces.is_empty() { Err(ObjError::Empty { file }) } else { Ok(faces) }
}

/// The statements that groups are told by.
#[derive(Clone, Default, PartialEq)]
struct GroupKey {
    /// Of the last `g` or `o` line.
    group: String,
    /// Of the last `usemtl` line.
    material: String,
}

/// Index of a value among those known, to which it is added. Faces of a group mostly stand together, so the last is
/// looked at first.
fn index_of<T: Clone + PartialEq>(known: &mut Vec<T>, value: &T) -> u32 {
    let index = known.iter().rposition(|k| k == value);
    index.unwrap_or_else(|| {
        known.push(value.clone());
        known.len() - 1
    }) as u32
}

/// A line's number and what is wrong with it.
type Fault = (usize, String);

impl ObjFaces {
    fn new(text: &str) -> Result<Self, Fault> {
        let mut out = Self::default();
        let mut own = GroupKey::default();
        let mut keys: Vec<GroupKey> = Vec::new();
        let mut read: Vec<(usize, Vec<Corner>)> = Vec::new();
        for (line, words) in logical_lines(text) {
            let mut words = words.split_whitespace();
            match words.next() {
                Some("vt") => out.texture.push(texture(words).map_err(|why| (line, why))?),
                Some("v") => out.vertices.push(position(words).map_err(|why| (line, why))?),
                Some("g" | "o") => own.group = words.collect::<Vec<_>>().join(" "),
                Some("usemtl") => own.material = words.collect::<Vec<_>>().join(" "),
                Some("f") => {
                    read.push((
                        line,
                        corners(words, [out.vertices.len(), out.texture.len()]).map_err(|why| (line, why))?,
                    ));
                    out.group_of_face.push(index_of(&mut keys, &own));
                }
                _ => {}
            }
        }
        out.name_groups(&keys);
        let counts = [out.vertices.len(), out.texture.len()].map(|n| n as i64);
        for (line, corners) in read {
            if let Some([wrong, _]) = corners.iter().find(|[v, _]| !(1..=counts[0]).contains(v)) {
                let has = if counts[0] == 0 { "none".to_owned() } else { format!("1 to {}", counts[0]) };
                return Err((line, format!("face uses vertex {wrong}, but the file has {has}")));
            }
            // A corner whose texture coordinates are not there has none: they are no part of the surface.
            let textured = corners.iter().all(|[_, t]| (1..=counts[1]).contains(t));
            let texture = if textured { corners.iter().map(|[_, t]| (t - 1) as u32).collect() } else { Vec::new() };
            out.texture_of_face.push(texture);
            out.faces.push(corners.into_iter().map(|[v, _]| (v - 1) as u32).collect());
        }
        Ok(out)
    }

    /// Names the groups of the faces, which have the indices of these keys so far: by `g` or `o` alone where all its
    /// faces are of one material, else by the material, and by both where that is in several groups.
    fn name_groups(&mut self, keys: &[GroupKey]) {
        let alone = |key: &GroupKey| keys.iter().filter(|k| k.group == key.group).count() == 1;
        let only_here = |key: &GroupKey| keys.iter().all(|k| k == key || k.material != key.material);
        let name = |key: &GroupKey| match key {
            key if alone(key) || key.material.is_empty() => key.group.clone(),
            key if key.group.is_empty() || only_here(key) => key.material.clone(),
            key => format!("{}.{}", key.group, key.material),
        };
        let names: Vec<String> = keys.iter().map(name).collect();
        let mut groups: Vec<String> = Vec::new();
        let index: Vec<u32> = names.iter().map(|name| index_of(&mut groups, name)).collect();
        self.group_of_face.iter_mut().for_each(|g| *g = index[*g as usize]);
        self.groups = groups;
    }

    /// Makes one group without a name of all faces.
    pub fn join_groups(&mut self) {
        self.groups = vec![String::new()];
        self.group_of_face.fill(0);
    }

    /// The file's `v` and `f` lines without all else.
    fn bare(&self) -> String {
        let mut out = String::new();
        for p in &self.vertices {
            let _ = writeln!(out, "v {} {} {}", p.x as f32, p.y as f32, p.z as f32);
        }
        for face in &self.faces {
            out.push('f');
            for c in face {
                let _ = write!(out, " {}", c + 1);
            }
            out.push('\n');
        }
        out
    }
}

/// Lines without comments and without a byte order mark, those ending in a backslash joined with the next, each with
/// the number of its first line.
fn logical_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    std::iter::from_fn(move || {
        let (number, first) = lines.next()?;
        let mut whole = Cow::Borrowed(code(first));
        while whole.ends_with('\\') {
            let joined = whole.to_mut();
            joined.pop();
            joined.push(' ');
            joined.push_str(lines.next().map_or("", |(_, next)| code(next)));
        }
        Some((number + 1, whole))
    })
}

/// A line without its comment.
fn code(line: &str) -> &str {
    line.split('#').next().unwrap_or("").trim_end()
}

/// `x y z`, after which a weight or a colour may follow.
fn position<'a>(words: impl Iterator<Item = &'a str>) -> Result<Vec3, String> {
    let mut numbers = Vec3::zeros();
    let mut count = 0;
    for word in words {
        match word.parse::<f64>() {
            // obj-rs reads 32 bits; what overflows there is no body in any unit.
            Ok(v) if (v as f32).is_finite() => {
                if let Some(number) = numbers.get_mut(count) {
                    *number = v;
                }
                count += 1;
            }
            Ok(v) if v.is_finite() => return Err(format!("coordinate '{}' is too large", shown(word, WORD))),
            Ok(_) => return Err(format!("coordinate '{}' is not finite", shown(word, WORD))),
            Err(_) => return Err(format!("'{}' is no number; a vertex is v x y z", shown(word, WORD))),
        }
    }
    if count < 3 { Err(format!("{count} coordinates; a vertex is v x y z")) } else { Ok(numbers) }
}

/// `u v`, after which a depth may follow.
fn texture<'a>(words: impl Iterator<Item = &'a str>) -> Result<[f64; 2], String> {
    let mut numbers = [0.0; 2];
    for (number, word) in numbers.iter_mut().zip(words) {
        *number = word.parse().map_err(|_| format!("'{}' is no number; texture is vt u v", shown(word, WORD)))?;
    }
    Ok(numbers)
}

/// Numbers of a corner's vertex and texture coordinates, from 1; 0 where there are none.
type Corner = [i64; 2];

/// A face's corners; negative numbers count back from what was read `so_far`.
fn corners<'a>(words: impl Iterator<Item = &'a str>, so_far: [usize; 2]) -> Result<Vec<Corner>, String> {
    let mut out = Vec::with_capacity(4);
    for word in words {
        let mut parts = word.split('/');
        let first = parts.next().unwrap_or(word);
        let vertex: i64 =
            first.parse().map_err(|_| format!("'{}' is no vertex number; a face is f 1 2 3", shown(word, WORD)))?;
        let texture: i64 = parts.next().and_then(|t| t.parse().ok()).unwrap_or(0);
        let counted = |k: i64, n: usize| if k < 0 { n as i64 + 1 + k } else { k };
        out.push([counted(vertex, so_far[0]), counted(texture, so_far[1])]);
    }
    if out.len() < 3 {
        return Err(format!("a face of {} corners; three or more are needed", out.len()));
    }
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_byte_order_mark_costs_no_vertex() {
        let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
        let marked = parse_obj(&format!("\u{feff}{text}"), "a.obj").expect("a triangle");
        assert_eq!(marked.vertices, parse_obj(text, "a.obj").expect("a triangle").vertices);
    }

    #[test]
    fn colours_quads_negative_indices_and_continuations_are_read() {
        let text = "# a square\nv 0 0 0 1 0 0\nv 1.000000001 0 0 0 1 0\r\nv 1 1 0\nvn 0 0 1\nv 0 1 \\\n 0\n\
                    f 1//1 2//1 -2 -1\n";
        let surface = parse_obj(text, "square.obj").expect("a square");
        assert_eq!(surface.vertices[1].x, 1.000_000_001);
        assert_eq!(surface.triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn materials_divide_a_group_that_has_several() {
        let vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        let groups = |lines: &str| {
            let text = lines.replace('F', "f 1 2 3");
            parse_obj_faces(&format!("{vertices}{text}"), "a.obj").expect("faces").groups
        };
        assert_eq!(groups("o Shirt\nusemtl body\nF\nusemtl sleeve\nF\nusemtl body\nF"), ["body", "sleeve"]);
        assert_eq!(groups("usemtl body\nF\nusemtl sleeve\nF"), ["body", "sleeve"]);
        assert_eq!(groups("o front\nusemtl blue\nF\no back\nusemtl blue\nF"), ["front", "back"]);
        let both = ["front.blue", "red", "back.blue", "green"];
        assert_eq!(groups("o front\nusemtl blue\nF\nusemtl red\nF\no back\nusemtl blue\nF\nusemtl green\nF"), both);
        assert_eq!(groups("F\nusemtl red\nF"), ["", "red"]);
    }

    #[test]
    fn errors_name_the_line() {
        let said = |text: &str| parse_obj(text, "a.obj").expect_err(text).to_string();
        let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
        assert_eq!(said(&format!("{square}f 1 2 4")), "a.obj:4: face uses vertex 4, but the file has 1 to 3");
        assert_eq!(said(&format!("{square}f 1 2 0")), "a.obj:4: face uses vertex 0, but the file has 1 to 3");
        assert_eq!(said(&format!("{square}\nf 1 2")), "a.obj:5: a face of 2 corners; three or more are needed");
        assert_eq!(said("v 0 0 nan"), "a.obj:1: coordinate 'nan' is not finite");
        assert_eq!(said("v 0 1e300 0"), "a.obj:1: coordinate '1e300' is too large");
        assert_eq!(said("\nv 0 0"), "a.obj:2: 2 coordinates; a vertex is v x y z");
        assert_eq!(said("v 0 zero 0"), "a.obj:1: 'zero' is no number; a vertex is v x y z");
        assert!(said(square).contains("no faces"));
        assert!(matches!(read_obj(Path::new("/nowhere/a.obj")), Err(ObjError::Read { .. })));
    }
}
