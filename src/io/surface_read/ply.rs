//! PLY (Turk 1994), in text and in both orders of bytes: `vertex` with x, y, z and `face` with a list of corners. Other
//! elements and properties are passed over. No crate is used: the header says how everything else is to be read.

use super::bytes::{Cursor, NumberKind};
use crate::geometry::Vec3;
use crate::io::obj_read::ObjFaces;

/// Whether a file begins as one of this format.
pub(super) fn is_ply(bytes: &[u8]) -> bool {
    bytes.starts_with(b"ply\n") || bytes.starts_with(b"ply\r")
}

/// A property of an element: one number, or a list with a count before it.
struct Property {
    name: String,
    count: Option<NumberKind>,
    kind: NumberKind,
}

struct PlyElement {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// How the numbers are written.
#[derive(Clone, Copy)]
enum PlyForm {
    Text,
    Bytes { big: bool },
}

/// Where the next number comes from.
enum Numbers<'a> {
    Text(std::str::SplitWhitespace<'a>),
    Bytes(Cursor<'a>),
}

impl Numbers<'_> {
    fn next(&mut self, kind: NumberKind) -> Result<f64, String> {
        match self {
            Self::Text(words) => {
                let word = words.next().ok_or("the file ends too early")?;
                word.parse().map_err(|_| format!("'{}' is no number", word.chars().take(60).collect::<String>()))
            }
            Self::Bytes(cursor) => cursor.number(kind).ok_or_else(|| "the file ends too early".into()),
        }
    }
}

/// The surface of a file.
pub(super) fn read(bytes: &[u8]) -> Result<ObjFaces, String> {
    const END: &[u8] = b"end_header";
    let end = bytes.windows(END.len()).position(|w| w == END).ok_or("the header has no end")?;
    let line_end = bytes[end..].iter().position(|b| *b == b'\n').ok_or("nothing follows the header")?;
    let (form, elements) = header(&String::from_utf8_lossy(&bytes[..end]))?;
    let body = &bytes[end + line_end + 1..];
    let text = String::from_utf8_lossy(if matches!(form, PlyForm::Text) { body } else { &[] });
    let mut numbers = match form {
        PlyForm::Text => Numbers::Text(text.split_whitespace()),
        PlyForm::Bytes { big } => Numbers::Bytes(Cursor::new(body, big)),
    };
    let mut out = ObjFaces { groups: vec![String::new()], ..ObjFaces::default() };
    for element in &elements {
        for _ in 0..element.count {
            one(element, &mut numbers, &mut out)?;
        }
    }
    let count = out.vertices.len();
    if let Some(wrong) = out.faces.iter().flatten().find(|v| **v as usize >= count) {
        return Err(format!("a face uses vertex {wrong}, but the file has {count} (from 0)"));
    }
    out.texture_of_face = vec![Vec::new(); out.faces.len()];
    out.group_of_face = vec![0; out.faces.len()];
    Ok(out)
}

/// Reads one vertex, one face, or what is passed over.
fn one(element: &PlyElement, numbers: &mut Numbers<'_>, out: &mut ObjFaces) -> Result<(), String> {
    let mut place = Vec3::zeros();
    for property in &element.properties {
        let count = match property.count {
            Some(kind) => numbers.next(kind)?,
            None => 1.0,
        };
        let mut list = Vec::new();
        for _ in 0..count as usize {
            list.push(numbers.next(property.kind)?);
        }
        match (element.name.as_str(), property.name.as_str()) {
            ("vertex", "x") => place.x = list[0],
            ("vertex", "y") => place.y = list[0],
            ("vertex", "z") => place.z = list[0],
            ("face", "vertex_indices" | "vertex_index") if list.len() > 2 => {
                out.faces.push(list.iter().map(|v| if *v < 0.0 { u32::MAX } else { *v as u32 }).collect());
            }
            _ => {}
        }
    }
    if element.name == "vertex" {
        out.vertices.push(place);
    }
    Ok(())
}

fn header(text: &str) -> Result<(PlyForm, Vec<PlyElement>), String> {
    let mut form = None;
    let mut elements: Vec<PlyElement> = Vec::new();
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["format", "ascii", _] => form = Some(PlyForm::Text),
            ["format", "binary_little_endian", _] => form = Some(PlyForm::Bytes { big: false }),
            ["format", "binary_big_endian", _] => form = Some(PlyForm::Bytes { big: true }),
            ["element", name, count] => {
                let count = count.parse().map_err(|_| format!("'{line}' has no count"))?;
                elements.push(PlyElement { name: name.into(), count, properties: Vec::new() });
            }
            ["property", ref kinds @ .., name] => {
                let element = elements.last_mut().ok_or("a property stands before every element")?;
                let (count, kind) = match kinds {
                    ["list", count, kind] => (Some(known(count)?), known(kind)?),
                    [kind] => (None, known(kind)?),
                    _ => return Err(format!("'{line}' means nothing")),
                };
                element.properties.push(Property { name: name.into(), count, kind });
            }
            _ => {}
        }
    }
    Ok((
        form.ok_or("the header names no format; ascii, binary_little_endian and binary_big_endian are read")?,
        elements,
    ))
}

fn known(name: &str) -> Result<NumberKind, String> {
    Ok(match name {
        "char" | "int8" => NumberKind::I8,
        "uchar" | "uint8" => NumberKind::U8,
        "short" | "int16" => NumberKind::I16,
        "ushort" | "uint16" => NumberKind::U16,
        "int" | "int32" => NumberKind::I32,
        "uint" | "uint32" => NumberKind::U32,
        "float" | "float32" => NumberKind::F32,
        "double" | "float64" => NumberKind::F64,
        other => return Err(format!("'{other}' is no type of number")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The header of a triangle with colours.
    fn head(format: &str) -> String {
        format!(
            "ply\nformat {format} 1.0\ncomment made by hand\nelement vertex 3\nproperty float x\nproperty float y\n\
             property double z\nproperty uchar red\nelement face 1\n\
             property list uchar int vertex_indices\nend_header\n"
        )
    }

    #[test]
    fn text_and_both_orders_of_bytes_are_read() {
        let places: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.5, 0.0, 0.0], [0.0, 1.0, 2.25]];
        let mut text = head("ascii");
        places.iter().for_each(|[x, y, z]| text += &format!("{x} {y} {z} 255\n"));
        let binary = |big: bool| {
            let mut out = head(if big { "binary_big_endian" } else { "binary_little_endian" }).into_bytes();
            for [x, y, z] in places {
                for single in [x as f32, y as f32] {
                    out.extend(if big { single.to_be_bytes() } else { single.to_le_bytes() });
                }
                out.extend(if big { z.to_be_bytes() } else { z.to_le_bytes() });
                out.push(255);
            }
            out.push(3);
            [0i32, 1, 2].iter().for_each(|v| out.extend(if big { v.to_be_bytes() } else { v.to_le_bytes() }));
            out
        };
        for bytes in [(text + "3 0 1 2\n").into_bytes(), binary(false), binary(true)] {
            assert!(is_ply(&bytes));
            let read = read(&bytes).expect("a triangle");
            assert_eq!(read.vertices, places.map(|[x, y, z]| Vec3::new(x, y, z)));
            assert_eq!((read.faces, read.group_of_face), (vec![vec![0, 1, 2]], vec![0]));
        }
    }

    #[test]
    fn damage_is_named() {
        let said = |text: String| read(text.as_bytes()).expect_err("damaged");
        assert!(said(head("ascii") + "0 0 0 1\n").contains("ends too early"));
        assert!(said(head("ascii") + "0 0 0 1\n0 0 0 1\n0 0 0 1\n3 0 1 7\n").contains("vertex 7"));
        assert!(said(head("ascii") + "0 zero").contains("'zero' is no number"));
        assert!(said(head("later")).contains("names no format"));
        assert!(said("ply\n".into()).contains("no end"));
    }
}
