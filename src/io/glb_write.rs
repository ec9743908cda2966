//! `garment.glb`: the draped garment for 3D programs (glTF 2.0, binary).

use serde_json::{Value, json};

use crate::geometry::{MM, Vec2, Vec3};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;
use crate::verify::Welded;

/// Numbers of the format (glTF 2.0, sections 3.6, 3.7 and 4.4).
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;
const MAGIC: &[u8; 4] = b"glTF";
const VERSION: u32 = 2;
const JSON_CHUNK: &[u8; 4] = b"JSON";
const BIN_CHUNK: &[u8; 4] = b"BIN\0";

/// Cloth scatters nearly all light it does not swallow.
const ROUGHNESS: f64 = 0.9;
/// Colours of the fabrics in turn (linear red, green, blue): told apart by eye,
/// also by those who confuse red and green.
const COLORS: [[f64; 3]; 6] = [
    [0.53, 0.62, 0.76],
    [0.80, 0.55, 0.32],
    [0.36, 0.58, 0.48],
    [0.74, 0.64, 0.40],
    [0.60, 0.42, 0.60],
    [0.45, 0.45, 0.45],
];

/// The garment as GLB bytes: metres, y up, a node and a mesh per piece, a material per fabric, both sides drawn.
///
/// - Texture coordinates are the flat position in millimetres, x right and y down from the drawing's origin, which is
///   the direction glTF counts them in; the right side of the cloth shows them as drawn.
/// - Normals are the sewn surface's, so that pieces shade as one across their seams.
/// - Faces run counter-clockwise seen from the right side.
///
/// # Panics
/// When `weld` or `positions` is shorter than the particles of `mesh`, or `garment` is not what was meshed: a mistake
/// of the caller.
pub fn garment_glb(garment: &Garment, mesh: &ClothMesh, weld: &[u32], positions: &[Vec3]) -> Vec<u8> {
    let welded = Welded::new(mesh, weld, positions);
    let normals = welded.surface.vertex_normals();
    let mut file = File::default();
    let mut fabrics: Vec<&str> = Vec::new();
    let mut meshes = Vec::new();
    for (piece, cut) in mesh.pieces.iter().zip(&garment.pieces) {
        let material = fabrics.iter().position(|f| *f == cut.fabric).unwrap_or_else(|| {
            fabrics.push(&cut.fabric);
            fabrics.len() - 1
        });
        let own = piece.particles.clone();
        let places: Vec<[f32; 3]> = positions[own.clone()].iter().map(single).collect();
        let upright = |v: &u32| single(&normals[*v as usize].try_normalize(0.0).unwrap_or_else(Vec3::z));
        let shading: Vec<[f32; 3]> = welded.vertex_of[own.clone()].iter().map(upright).collect();
        let flat = |p: &Vec2| [(p.x * MM) as f32, (p.y * MM) as f32];
        let drawn: Vec<[f32; 2]> = mesh.flat[own.clone()].iter().map(flat).collect();
        let corners: Vec<u32> =
            welded.corners[piece.triangles.clone()].iter().flatten().map(|&v| v - own.start as u32).collect();
        let attributes = json!({
            "POSITION": file.vectors(&places, true),
            "NORMAL": file.vectors(&shading, false),
            "TEXCOORD_0": file.vectors(&drawn, false),
        });
        let indices = file.indices(&corners);
        let primitive = json!({ "attributes": attributes, "indices": indices, "material": material });
        meshes.push(json!({ "name": piece.name, "primitives": [primitive] }));
    }
    let materials: Vec<Value> = fabrics.iter().enumerate().map(|(i, name)| cloth(i, name)).collect();
    file.finish(&garment.title, meshes, materials)
}

fn single(p: &Vec3) -> [f32; 3] {
    [p.x as f32, p.y as f32, p.z as f32]
}

fn cloth(index: usize, name: &str) -> Value {
    let [r, g, b] = COLORS[index % COLORS.len()];
    json!({
        "name": name,
        "doubleSided": true,
        "pbrMetallicRoughness": {
            "baseColorFactor": [r, g, b, 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": ROUGHNESS,
        },
    })
}

/// The binary part of the file, and what describes it.
#[derive(Default)]
struct File {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl File {
    /// Adds vertex data and gives its accessor; positions must say their bounds.
    fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]], bounds: bool) -> usize {
        let begin = self.bytes.len();
        vectors.iter().flatten().for_each(|x| self.bytes.extend(x.to_le_bytes()));
        let mut accessor = json!({ "componentType": FLOAT, "count": vectors.len(), "type": format!("VEC{N}") });
        if bounds {
            let fold = |of: fn(f32, f32) -> f32, from: f32| {
                let one = |k: usize| f64::from(vectors.iter().map(|v| v[k]).fold(from, of));
                (0..N).map(one).collect::<Vec<f64>>()
            };
            accessor["min"] = json!(fold(f32::min, f32::INFINITY));
            accessor["max"] = json!(fold(f32::max, f32::NEG_INFINITY));
        }
        self.accessor(begin, ARRAY_BUFFER, accessor)
    }

    fn indices(&mut self, indices: &[u32]) -> usize {
        let begin = self.bytes.len();
        indices.iter().for_each(|i| self.bytes.extend(i.to_le_bytes()));
        let accessor = json!({ "componentType": UNSIGNED_INT, "count": indices.len(), "type": "SCALAR" });
        self.accessor(begin, ELEMENT_ARRAY_BUFFER, accessor)
    }

    fn accessor(&mut self, begin: usize, target: u32, mut accessor: Value) -> usize {
        let length = self.bytes.len() - begin;
        accessor["bufferView"] = json!(self.views.len());
        self.views.push(json!({ "buffer": 0, "byteOffset": begin, "byteLength": length, "target": target }));
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn finish(self, title: &str, meshes: Vec<Value>, materials: Vec<Value>) -> Vec<u8> {
        let node = |(i, mesh): (usize, &Value)| json!({ "name": mesh["name"], "mesh": i });
        let nodes: Vec<Value> = meshes.iter().enumerate().map(node).collect();
        let scene = json!({ "name": title, "nodes": (0..nodes.len()).collect::<Vec<_>>() });
        let about = json!({
            "version": "2.0",
            "generator": concat!("toile ", env!("CARGO_PKG_VERSION")),
            "extras": { "TEXCOORD_0": "flat position in mm, x right, y down" },
        });
        let document = json!({
            "asset": about,
            "scene": 0,
            "scenes": [scene],
            "nodes": nodes,
            "meshes": meshes,
            "materials": materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.bytes.len() }],
        });
        let json = padded(document.to_string().into_bytes(), b' ');
        let bytes = padded(self.bytes, 0);
        let length = 12 + 8 + json.len() + 8 + bytes.len();
        let mut out = Vec::with_capacity(length);
        out.extend(MAGIC);
        out.extend(VERSION.to_le_bytes());
        out.extend((length as u32).to_le_bytes());
        for (kind, chunk) in [(JSON_CHUNK, json), (BIN_CHUNK, bytes)] {
            out.extend((chunk.len() as u32).to_le_bytes());
            out.extend(kind);
            out.extend(chunk);
        }
        out
    }
}

/// Chunks are multiples of four bytes.
fn padded(mut bytes: Vec<u8>, with: u8) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(4), with);
    bytes
}
