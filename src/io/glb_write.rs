//! `garment.glb`: the draped garment for 3D programs (glTF 2.0, binary).

use std::collections::HashMap;

use serde_json::{Value, json};

use crate::geometry::{MM, TriMesh, Vec2, Vec3};
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::Garment;
use crate::verify::Welded;

/// Numbers of the format (glTF 2.0, sections 3.6, 3.7 and 4.4).
const FLOAT: u32 = 5126;
const UNSIGNED_SHORT: u32 = 5123;
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
/// - Each of the `values` is an attribute of the particles, named as glTF wants it: `_EASE`.
/// - `extras` of a mesh tell its fabric, the extension along warp and weft that this `gives` under full load, and its
///   edges: their names, seams and vertices in order.
///
/// # Panics
/// When `weld`, `positions` or one of the `values` is shorter than the particles of `mesh`, or `garment` is not what
/// was meshed: a mistake of the caller.
pub fn garment_glb(
    garment: &Garment,
    mesh: &ClothMesh,
    weld: &[u32],
    positions: &[Vec3],
    values: &[(&str, Vec<f64>)],
    gives: &[[f64; 2]],
) -> Vec<u8> {
    let welded = Welded::new(mesh, weld, positions);
    let normals = welded.surface.vertex_normals();
    let mut file = GlbFile::default();
    let mut fabrics: Vec<&str> = Vec::new();
    let mut meshes = Vec::new();
    let sewn = sewn_particles(mesh);
    for (number, (piece, cut)) in mesh.pieces.iter().zip(&garment.pieces).enumerate() {
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
        let mut attributes = json!({
            "POSITION": file.vectors(&places, true),
            "NORMAL": file.vectors(&shading, false),
            "TEXCOORD_0": file.vectors(&drawn, false),
        });
        for (name, values) in values {
            let own: Vec<[f32; 1]> = values[own.clone()].iter().map(|value| [*value as f32]).collect();
            attributes[*name] = file.vectors(&own, false).into();
        }
        let indices = file.indices(&corners, false);
        let extras = json!({
            "fabric": cut.fabric,
            "gives": gives.get(number),
            "edges": edges(mesh, piece, &sewn),
        });
        let primitive = json!({ "attributes": attributes, "indices": indices, "material": material });
        meshes.push(json!({ "name": piece.name, "primitives": [primitive], "extras": extras }));
    }
    let materials: Vec<Value> = fabrics.iter().enumerate().map(|(i, name)| cloth(i, name)).collect();
    file.finish(&garment.title, meshes, materials)
}

/// A surface without pieces as GLB bytes, such as a body: metres, y up, one mesh called `name`.
pub fn surface_glb(name: &str, surface: &TriMesh, place: impl Fn(Vec3) -> Vec3) -> Vec<u8> {
    let mut file = GlbFile::default();
    let places: Vec<[f32; 3]> = surface.vertices.iter().map(|p| single(&place(*p))).collect();
    let corners: Vec<u32> = surface.triangles.iter().flatten().copied().collect();
    let attributes = json!({ "POSITION": file.vectors(&places, true) });
    // The largest number of two bytes is not allowed for a corner.
    let indices = file.indices(&corners, surface.vertices.len() <= usize::from(u16::MAX));
    let mesh = json!({ "name": name, "primitives": [{ "attributes": attributes, "indices": indices }] });
    file.finish(name, vec![mesh], Vec::new())
}

/// The numbers of the seams that every particle is in.
fn sewn_particles(mesh: &ClothMesh) -> HashMap<u32, Vec<usize>> {
    let mut out: HashMap<u32, Vec<usize>> = HashMap::new();
    for (number, seam) in mesh.seams.iter().enumerate() {
        for particle in seam.pairs.iter().flatten() {
            let seams = out.entry(*particle).or_default();
            if seams.last() != Some(&number) {
                seams.push(number);
            }
        }
    }
    out
}

/// The edges of a piece, parted where their seams end: name, seam (or null), vertices of the piece in order.
fn edges(mesh: &ClothMesh, piece: &PieceMesh, sewn: &HashMap<u32, Vec<usize>>) -> Vec<Value> {
    let seams = |particle: u32| sewn.get(&particle).map_or(&[][..], Vec::as_slice);
    let mut out = Vec::new();
    for edge in &piece.edges {
        let mut runs: Vec<(Option<usize>, Vec<u32>)> = Vec::new();
        for step in edge.particles.windows(2) {
            let seam = seams(step[0]).iter().copied().find(|seam| seams(step[1]).contains(seam));
            match runs.last_mut() {
                Some((last, along)) if *last == seam => along.push(step[1]),
                _ => runs.push((seam, step.to_vec())),
            }
        }
        out.extend(runs.into_iter().map(|(seam, along)| {
            let along: Vec<u32> = along.iter().map(|particle| particle - piece.particles.start as u32).collect();
            json!({ "edge": edge.name, "seam": seam.map(|seam| &mesh.seams[seam].name), "along": along })
        }));
    }
    out
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

/// Name in glTF of a vector of so many numbers.
fn kind(numbers: usize) -> String {
    if numbers == 1 { "SCALAR".to_owned() } else { format!("VEC{numbers}") }
}

/// The binary part of the file, and what describes it.
#[derive(Default)]
struct GlbFile {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl GlbFile {
    /// Adds vertex data and gives its accessor; positions must say their bounds.
    fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]], bounds: bool) -> usize {
        let begin = self.bytes.len();
        vectors.iter().flatten().for_each(|x| self.bytes.extend(x.to_le_bytes()));
        let mut accessor = json!({ "componentType": FLOAT, "count": vectors.len(), "type": kind(N) });
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

    /// Adds the corners of triangles, in two bytes each if that is `short` enough for their numbers.
    fn indices(&mut self, indices: &[u32], short: bool) -> usize {
        let begin = self.bytes.len();
        for index in indices {
            let bytes = index.to_le_bytes();
            self.bytes.extend(if short { &bytes[..2] } else { &bytes[..] });
        }
        let kind = if short { UNSIGNED_SHORT } else { UNSIGNED_INT };
        let accessor = json!({ "componentType": kind, "count": indices.len(), "type": "SCALAR" });
        self.accessor(begin, ELEMENT_ARRAY_BUFFER, accessor)
    }

    fn accessor(&mut self, begin: usize, target: u32, mut accessor: Value) -> usize {
        let length = self.bytes.len() - begin;
        // Data begin at multiples of four bytes.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
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
            "extras": {
                "TEXCOORD_0": "flat position in mm, x right, y down",
                "_STRAIN_WARP": "extension, a fraction; so _STRAIN_WEFT",
                "_SHEAR": "change of the angle between warp and weft, degrees",
                "_EASE": "distance to the skin, mm",
                "_PRESSURE": "pressure on the skin, kPa",
                "_SEAM_GAP": "distance to the partner as the seam was closed, mm",
            },
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
