//! GLB (glTF 2.0, binary): the triangles of every mesh of the scene in its place, one group per material of a mesh. No
//! crate is used: of the format only positions and indices matter here.

use nalgebra::{Matrix4, Quaternion, UnitQuaternion};
use serde_json::Value;

use super::bytes::{Cursor, NumberKind};
use crate::geometry::Vec3;
use crate::io::obj_read::ObjFaces;

/// How a file begins.
pub(super) const MAGIC: &[u8] = b"glTF";
/// Kinds of a primitive (section 5.24.4) that have an area.
const TRIANGLES: u64 = 4;
const STRIP: u64 = 5;
const FAN: u64 = 6;
/// Nodes within nodes, at most.
const DEEPEST: usize = 100;

/// The file's two parts.
struct GlbParts<'a> {
    json: Value,
    bytes: &'a [u8],
}

/// The surface of a file.
pub(super) fn read(bytes: &[u8]) -> Result<ObjFaces, String> {
    let file = chunks(bytes)?;
    let mut out = ObjFaces::default();
    let scene = file.json["scene"].as_u64().unwrap_or(0) as usize;
    match file.json["scenes"][scene]["nodes"].as_array() {
        Some(roots) => {
            for root in roots {
                file.node(root, &Matrix4::identity(), 0, &mut out)?;
            }
        }
        // A file without a scene is a library of meshes.
        None => {
            for mesh in 0..file.json["meshes"].as_array().map_or(0, Vec::len) {
                file.mesh(mesh, &Matrix4::identity(), "", &mut out)?;
            }
        }
    }
    Ok(out)
}

fn chunks(bytes: &[u8]) -> Result<GlbParts<'_>, String> {
    /// Of the file's header, and of a chunk's.
    const HEADERS: [usize; 2] = [12, 8];
    const VERSION: f64 = 2.0;
    let number = |at: usize| bytes.get(at..at + 4).and_then(|b| Cursor::new(b, false).number(NumberKind::U32));
    if number(4) != Some(VERSION) {
        return Err("only version 2 is read".into());
    }
    let chunk = |at: usize, kind: &[u8; 4]| {
        let length = number(at)? as usize;
        let begin = at + HEADERS[1];
        let matches = bytes.get(at + 4..begin)? == kind;
        bytes.get(begin..begin.checked_add(length)?).filter(|_| matches)
    };
    let json = chunk(HEADERS[0], b"JSON").ok_or("the first part is not JSON, or the file ends too early")?;
    let rest = HEADERS[0] + HEADERS[1] + json.len();
    let json = serde_json::from_slice(json).map_err(|e| e.to_string())?;
    Ok(GlbParts { json, bytes: chunk(rest, b"BIN\0").unwrap_or(&[]) })
}

/// Numbers of an array, as many as it should have.
fn numbers<const N: usize>(value: &Value) -> Option<[f64; N]> {
    let read: Vec<f64> = value.as_array()?.iter().filter_map(Value::as_f64).collect();
    read.try_into().ok()
}

/// Where a node puts what it holds.
fn placed(node: &Value) -> Matrix4<f64> {
    if let Some(matrix) = numbers::<16>(&node["matrix"]) {
        return Matrix4::from_column_slice(&matrix);
    }
    let shift = numbers::<3>(&node["translation"]).map_or_else(Vec3::zeros, Vec3::from);
    let scale = numbers::<3>(&node["scale"]).map_or_else(|| Vec3::repeat(1.0), Vec3::from);
    let [x, y, z, w] = numbers::<4>(&node["rotation"]).unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let turn = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_homogeneous();
    Matrix4::new_translation(&shift) * turn * Matrix4::new_nonuniform_scaling(&scale)
}

impl GlbParts<'_> {
    fn node(&self, index: &Value, within: &Matrix4<f64>, depth: usize, out: &mut ObjFaces) -> Result<(), String> {
        if depth > DEEPEST {
            return Err("nodes lie within each other without end".into());
        }
        let node = &self.json["nodes"][index.as_u64().unwrap_or(u64::MAX) as usize];
        let here = within * placed(node);
        if let Some(mesh) = node["mesh"].as_u64() {
            self.mesh(mesh as usize, &here, node["name"].as_str().unwrap_or(""), out)?;
        }
        for child in node["children"].as_array().into_iter().flatten() {
            self.node(child, &here, depth + 1, out)?;
        }
        Ok(())
    }

    fn mesh(&self, index: usize, place: &Matrix4<f64>, node: &str, out: &mut ObjFaces) -> Result<(), String> {
        let mesh = &self.json["meshes"][index];
        let primitives = mesh["primitives"].as_array().map_or(&[][..], Vec::as_slice);
        let name = if node.is_empty() { mesh["name"].as_str().unwrap_or("") } else { node };
        for primitive in primitives {
            let material = primitive["material"].as_u64();
            let material = material.and_then(|m| self.json["materials"][m as usize]["name"].as_str());
            let group = if primitives.len() > 1 { material.unwrap_or(name) } else { name };
            self.primitive(primitive, place, group, out)?;
        }
        Ok(())
    }

    fn primitive(
        &self,
        primitive: &Value,
        place: &Matrix4<f64>,
        group: &str,
        out: &mut ObjFaces,
    ) -> Result<(), String> {
        if primitive["extensions"]["KHR_draco_mesh_compression"].is_object() {
            return Err("its meshes are compressed (Draco); export it without compression".into());
        }
        let first = out.vertices.len() as u32;
        let places = self.accessor(&primitive["attributes"]["POSITION"])?;
        let count = places.len() as u32 / 3;
        out.vertices.extend(places.chunks_exact(3).map(|p| place.transform_point(&[p[0], p[1], p[2]].into()).coords));
        let corners: Vec<u32> = match primitive.get("indices") {
            Some(indices) => self.accessor(indices)?.into_iter().map(|v| v as u32).collect(),
            None => (0..count).collect(),
        };
        if let Some(wrong) = corners.iter().find(|v| **v >= count) {
            return Err(format!("a face uses vertex {wrong}, but there are {count} (from 0)"));
        }
        let group = group_of(out, group);
        for face in triangles(&corners, primitive["mode"].as_u64().unwrap_or(TRIANGLES)) {
            out.faces.push(face.map(|v| first + v).into());
            out.texture_of_face.push(Vec::new());
            out.group_of_face.push(group);
        }
        Ok(())
    }

    /// The numbers of an accessor, those of one vertex after those of the other.
    fn accessor(&self, index: &Value) -> Result<Vec<f64>, String> {
        let accessor = &self.json["accessors"][index.as_u64().ok_or("a mesh has no positions")? as usize];
        if accessor["sparse"].is_object() {
            return Err("sparse accessors are not read; export it without morph targets".into());
        }
        let kind = match accessor["componentType"].as_u64() {
            Some(5120) => NumberKind::I8,
            Some(5121) => NumberKind::U8,
            Some(5122) => NumberKind::I16,
            Some(5123) => NumberKind::U16,
            Some(5125) => NumberKind::U32,
            Some(5126) => NumberKind::F32,
            _ => return Err("an accessor is damaged".into()),
        };
        let each = match accessor["type"].as_str() {
            Some("SCALAR") => 1,
            Some("VEC3") => 3,
            _ => return Err("positions are of three numbers and indices of one".into()),
        };
        let view = &self.json["bufferViews"][accessor["bufferView"].as_u64().unwrap_or(u64::MAX) as usize];
        let at = |v: &Value| v.as_u64().unwrap_or(0) as usize;
        let begin = at(&view["byteOffset"]).saturating_add(at(&accessor["byteOffset"]));
        let step = view["byteStride"].as_u64().map_or(each * kind.size(), |s| s as usize);
        let mut out = Vec::new();
        for k in 0..at(&accessor["count"]) {
            let from = k.saturating_mul(step).saturating_add(begin);
            let mut cursor = Cursor::new(self.bytes.get(from..).unwrap_or(&[]), false);
            for _ in 0..each {
                out.push(cursor.number(kind).ok_or("the file ends too early")?);
            }
        }
        Ok(out)
    }
}

/// Index of a group's name.
fn group_of(out: &mut ObjFaces, name: &str) -> u32 {
    let known = out.groups.iter().position(|g| g == name);
    known.unwrap_or_else(|| {
        out.groups.push(name.to_owned());
        out.groups.len() - 1
    }) as u32
}

/// The triangles of a primitive; points and lines have none.
fn triangles(corners: &[u32], mode: u64) -> Vec<[u32; 3]> {
    match mode {
        TRIANGLES => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
        STRIP => {
            let each = corners.windows(3).enumerate();
            each.map(|(k, c)| if k % 2 == 0 { [c[0], c[1], c[2]] } else { [c[1], c[0], c[2]] }).collect()
        }
        FAN => corners.windows(2).skip(1).map(|c| [corners[0], c[0], c[1]]).collect(),
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// A file of a JSON part and its numbers.
    fn file(json: &Value, bytes: &[u8]) -> Vec<u8> {
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut out = [MAGIC, &2u32.to_le_bytes(), &0u32.to_le_bytes()].concat();
        for (kind, part) in [(b"JSON", &text[..]), (b"BIN\0", bytes)] {
            out.extend((part.len() as u32).to_le_bytes());
            out.extend(kind);
            out.extend(part);
        }
        out
    }

    fn square() -> (Value, Vec<u8>) {
        let mut bytes = Vec::new();
        let places = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0f32];
        places.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        [0u16, 1, 2, 2, 1, 3].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
        let json = json!({
            "scene": 0, "scenes": [{"nodes": [0]}],
            "nodes": [{"children": [1], "translation": [0, 0, 5]}, {"mesh": 0, "name": "panel", "scale": [2, 2, 2]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "accessors": [
                {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"},
            ],
            "bufferViews": [{"byteLength": 48}, {"byteOffset": 48, "byteLength": 12}],
        });
        (json, bytes)
    }

    #[test]
    fn meshes_lie_where_their_nodes_put_them() {
        let (json, bytes) = square();
        let read = read(&file(&json, &bytes)).expect("a square");
        assert_eq!(read.vertices[3], Vec3::new(2.0, 2.0, 5.0));
        assert_eq!((read.faces, read.groups), (vec![vec![0, 1, 2], vec![2, 1, 3]], vec!["panel".to_owned()]));
    }

    #[test]
    fn damage_is_named() {
        let (mut json, bytes) = square();
        let whole = file(&json, &bytes);
        assert!(read(&whole[..40]).expect_err("cut short").contains("ends too early"));
        json["accessors"][1]["count"] = json!(7);
        assert!(read(&file(&json, &bytes)).expect_err("too many").contains("ends too early"));
        json["nodes"][0]["children"] = json!([0]);
        assert!(read(&file(&json, &bytes)).expect_err("a circle").contains("without end"));
    }

    #[test]
    fn strips_and_fans_turn_as_they_should() {
        assert_eq!(triangles(&[0, 1, 2, 3], STRIP), [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(triangles(&[0, 1, 2, 3], FAN), [[0, 1, 2], [0, 2, 3]]);
        assert!(triangles(&[0, 1, 2], 1).is_empty());
    }
}
