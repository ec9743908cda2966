//! The lines of an OBJ file, as all that is written here has them.

use std::fmt::{Display, Write};

use crate::geometry::{Vec2, Vec3};

/// Decimals of a millimetre in the OBJ files of garments and bodies: a nanometre, a hundredth of what a 32-bit number
/// keeps of a metre.
pub const DECIMALS: usize = 6;

/// The text of an OBJ file while it is written, line by line.
#[derive(Clone, Debug, Default)]
pub struct ObjText {
    text: String,
    decimals: Option<usize>,
}

/// A corner of a face: the numbers, from 0, of its vertex, texture coordinates and normal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObjCorner {
    /// Among the vertices.
    pub vertex: usize,
    /// Among the texture coordinates. `None` where the corner has none.
    pub texture: Option<usize>,
    /// Among the normals. `None` where the corner has none, or no texture coordinates.
    pub normal: Option<usize>,
}

impl ObjText {
    /// An empty file whose numbers are written so that they read back as the same.
    pub fn exact() -> Self {
        Self::default()
    }

    /// An empty file whose numbers have so many decimals, with room for so many bytes.
    pub fn rounded(decimals: usize, capacity: usize) -> Self {
        Self { text: String::with_capacity(capacity), decimals: Some(decimals) }
    }

    /// The text.
    pub fn into_text(self) -> String {
        self.text
    }

    /// A comment.
    pub fn comment(&mut self, text: impl Display) {
        self.line(format_args!("# {text}"));
    }

    /// Begins an object.
    pub fn object(&mut self, name: &str) {
        self.line(format_args!("o {name}"));
    }

    /// Begins a group of faces.
    pub fn group(&mut self, name: &str) {
        self.line(format_args!("g {name}"));
    }

    /// A vertex, in the unit of the file.
    pub fn vertex(&mut self, p: &Vec3) {
        self.numbers("v", p.as_slice());
    }

    /// Texture coordinates, in the unit of the file. Patterns are drawn y down and texture space is y up: y is negated,
    /// so that a print looks as drawn.
    pub fn texture(&mut self, p: &Vec2) {
        self.numbers("vt", &[p.x, -p.y]);
    }

    /// A normal.
    pub fn normal(&mut self, n: &Vec3) {
        self.numbers("vn", n.as_slice());
    }

    /// A face.
    pub fn face(&mut self, corners: impl IntoIterator<Item = impl Into<ObjCorner>>) {
        self.text.push('f');
        for ObjCorner { vertex, texture, normal } in corners.into_iter().map(Into::into) {
            let _ = write!(self.text, " {}", vertex + 1);
            for number in texture.into_iter().chain(normal) {
                let _ = write!(self.text, "/{}", number + 1);
            }
        }
        self.text.push('\n');
    }

    fn numbers(&mut self, key: &str, numbers: &[f64]) {
        self.text.push_str(key);
        for x in numbers {
            let _ = match self.decimals {
                Some(decimals) => write!(self.text, " {x:.decimals$}"),
                None => write!(self.text, " {x}"),
            };
        }
        self.text.push('\n');
    }

    /// Writing to a text cannot fail, so the result carries nothing.
    fn line(&mut self, line: impl Display) {
        let _ = writeln!(self.text, "{line}");
    }
}

impl From<u32> for ObjCorner {
    /// The corner at a vertex, without texture coordinates and normal.
    fn from(vertex: u32) -> Self {
        Self { vertex: vertex as usize, texture: None, normal: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_count_from_one_and_numbers_have_their_decimals() {
        let mut exact = ObjText::exact();
        exact.vertex(&Vec3::new(0.1, -2.0, 1e-7));
        exact.face([0, 1, 2]);
        assert_eq!(exact.into_text(), "v 0.1 -2 0.0000001\nf 1 2 3\n");
        let mut rounded = ObjText::rounded(2, 0);
        rounded.texture(&Vec2::new(1.0, 2.5));
        rounded.face([0, 3, 4].map(|k| ObjCorner { vertex: k, texture: Some(k + 1), normal: Some(k) }));
        assert_eq!(rounded.into_text(), "vt 1.00 -2.50\nf 1/2/1 4/5/4 5/6/5\n");
    }
}
