//! Any surface laid flat: every group or connected part of an OBJ file as a piece of its own.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Instant;

use rayon::prelude::*;
use serde::Serialize;

use super::error::PipelineError;
use super::results::{PATTERN_SVG, REPORT_JSON, ResultFile, json_text};
use crate::flatten::{self, FlattenError, Flattened, Options, flatten};
use crate::geometry::{Topology, TriMesh, Vec2, rim_loops};
use crate::io::obj_read::{ObjFaces, read_obj_faces};
use crate::io::pattern_svg::pattern_svg;
use crate::mesh::{ClothMesh, EdgeParticles, PieceMesh};
use crate::pattern::EdgeId;
use crate::report::{Quartet, Stage};

/// The surface as read, with flat texture coordinates.
pub const FLAT_OBJ: &str = "flat.obj";

/// Millimetres in a metre.
const MM: f64 = 1e3;

/// A surface laid flat.
pub struct FlatSurface {
    faces: ObjFaces,
    parts: Vec<Part>,
    flat: Vec<Flattened>,
    /// What it did to the cloth.
    pub report: SurfaceReport,
}

/// What flattening did to a surface; written as `report.json`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SurfaceReport {
    /// Version of this program.
    pub toile: String,
    /// The file's stem.
    pub surface: String,
    /// One per part.
    pub pieces: Vec<PartReport>,
    /// The one stage.
    pub stages: Vec<Stage>,
}

/// What flattening did to one part. Keys and units are those of a garment's report; the surface in space is `draped`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PartReport {
    /// The group's name; numbered where a group has several parts.
    pub name: String,
    /// Vertices.
    pub particles: usize,
    /// Triangles.
    pub triangles: usize,
    /// Area in space, mm².
    pub area_draped: f64,
    /// Area of the flat piece, mm².
    pub area_flattened: f64,
    /// Length of the rim in space, mm.
    pub boundary_draped: f64,
    /// Length of the flat rim, mm.
    pub boundary_flattened: f64,
    /// Flat against space.
    pub area_error: Quartet,
    /// The same for the rim.
    pub boundary_error: Quartet,
    /// Largest |length / length in space − 1| of an edge.
    pub largest_edge_error: f64,
    /// Root mean square of the triangles' stretches minus one.
    pub distortion: f64,
    /// Triangles turned over: always 0.
    pub flips: usize,
    /// Crossings of the flat rim: 0 unless the piece lies on itself.
    pub overlaps: usize,
}

/// A connected part of the surface.
struct Part {
    name: String,
    /// Indices of its vertices in the file.
    vertices: Vec<u32>,
    /// Indices of its faces in the file.
    faces: Vec<u32>,
    /// In metres, its triangles turned round: a flat piece shows the side that faces outward in space.
    surface: TriMesh,
}

/// Lays every part of an OBJ flat; `unit` is what one unit of the file is in metres.
///
/// # Errors
/// A file that cannot be read, or a part that is no disk, with what it is instead.
pub fn flatten_surface(file: &Path, unit: f64, options: &Options) -> Result<FlatSurface, PipelineError> {
    let faces = read_obj_faces(file)?;
    let name = file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let begin = Instant::now();
    let parts = parts(&faces, unit, &name);
    let flat: Vec<Result<Flattened, FlattenError>> = parts
        .par_iter()
        .map(|part| {
            flatten(&part.surface, options)
                .map_err(|e| FlattenError::Piece { piece: part.name.clone(), source: Box::new(e) })
        })
        .collect();
    // Of several errors the first in the file's order, not the first in time.
    let flat: Result<Vec<Flattened>, FlattenError> = flat.into_iter().collect();
    let flat = flat.map_err(|source| PipelineError::Surface { file: file.to_owned(), source })?;
    let stage = stage(&flat, begin);
    let pieces = parts.iter().zip(&flat).map(|(part, flat)| part_report(part, &flat.report)).collect();
    let report = SurfaceReport { toile: env!("CARGO_PKG_VERSION").into(), surface: name, pieces, stages: vec![stage] };
    Ok(FlatSurface { faces, parts, flat, report })
}

fn stage(flat: &[Flattened], begin: Instant) -> Stage {
    let reports = flat.iter().map(|f| f.report);
    Stage {
        name: "flatten".into(),
        seconds: begin.elapsed().as_secs_f64(),
        iterations: reports.clone().map(|r| r.iterations).max().unwrap_or(0),
        converged: reports.clone().all(|r| r.converged),
        energy: Some(reports.map(|r| r.energy).sum()),
        drift: None,
    }
}

fn part_report(part: &Part, r: &flatten::Report) -> PartReport {
    let error = |e: f64| Quartet { flatten: Some(e), ..Quartet::default() };
    PartReport {
        name: part.name.clone(),
        particles: part.surface.vertices.len(),
        triangles: part.surface.triangles.len(),
        area_draped: r.area_before * MM * MM,
        area_flattened: r.area_after * MM * MM,
        boundary_draped: r.boundary_before * MM,
        boundary_flattened: r.boundary_after * MM,
        area_error: error(r.area_error),
        boundary_error: error(r.boundary_error),
        largest_edge_error: r.largest_edge_error,
        distortion: r.distortion,
        flips: r.flips,
        overlaps: r.overlaps,
    }
}

/// The connected parts of every group, in the order of their first faces.
fn parts(faces: &ObjFaces, unit: f64, stem: &str) -> Vec<Part> {
    let mut parts = Vec::new();
    for (g, group) in faces.groups.iter().enumerate() {
        let own: Vec<u32> =
            (0..faces.faces.len() as u32).filter(|&f| faces.group_of_face[f as usize] == g as u32).collect();
        let split = connected(faces, &own);
        let name = if group.is_empty() { stem } else { group };
        let several = split.len() > 1;
        for (k, own) in split.into_iter().enumerate() {
            let name = if several { format!("{name}.{}", k + 1) } else { name.to_owned() };
            parts.push(part(faces, name, own, unit));
        }
    }
    parts
}

/// Splits faces into sets that hang together by their edges.
fn connected(faces: &ObjFaces, own: &[u32]) -> Vec<Vec<u32>> {
    let mut triangles = Vec::new();
    let mut face_of_triangle = Vec::new();
    for (k, &f) in own.iter().enumerate() {
        for t in fan(&faces.faces[f as usize]) {
            triangles.push(t);
            face_of_triangle.push(k);
        }
    }
    let mut parent: Vec<usize> = (0..own.len()).collect();
    for edge in &Topology::new(&triangles).edges {
        if let [Some(s), Some(t)] = edge.triangles {
            let [s, t] = [s, t].map(|t| root(&mut parent, face_of_triangle[t as usize]));
            parent[s.max(t)] = s.min(t);
        }
    }
    let mut sets: Vec<(usize, Vec<u32>)> = Vec::new();
    let mut set_of_root = vec![usize::MAX; own.len()];
    for (k, &f) in own.iter().enumerate() {
        let root = root(&mut parent, k);
        if set_of_root[root] == usize::MAX {
            set_of_root[root] = sets.len();
            sets.push((root, Vec::new()));
        }
        sets[set_of_root[root]].1.push(f);
    }
    sets.into_iter().map(|(_, faces)| faces).collect()
}

fn root(parent: &mut [usize], mut k: usize) -> usize {
    while parent[k] != k {
        parent[k] = parent[parent[k]];
        k = parent[k];
    }
    k
}

/// A polygon as triangles round its first corner.
fn fan(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> + '_ {
    (1..corners.len() - 1).map(|k| [corners[0], corners[k], corners[k + 1]])
}

fn part(faces: &ObjFaces, name: String, own: Vec<u32>, unit: f64) -> Part {
    let mut vertices: Vec<u32> = own.iter().flat_map(|&f| faces.faces[f as usize].iter().copied()).collect();
    vertices.sort_unstable();
    vertices.dedup();
    let local = |v: u32| vertices.partition_point(|&w| w < v) as u32;
    let triangles = own.iter().flat_map(|&f| fan(&faces.faces[f as usize])).map(|[a, b, c]| [a, c, b].map(local));
    let surface = TriMesh {
        triangles: triangles.collect(),
        vertices: vertices.iter().map(|&v| faces.vertices[v as usize] * unit).collect(),
    };
    Part { name, vertices, faces: own, surface }
}

impl FlatSurface {
    /// `flat.obj`, `pattern.svg` and `report.json`.
    ///
    /// # Errors
    /// When one of them cannot be drawn.
    pub fn results(&self) -> Result<Vec<ResultFile>, PipelineError> {
        let sheet = self.sheet();
        Ok(vec![
            (FLAT_OBJ, self.obj().into_bytes()),
            (PATTERN_SVG, pattern_svg(&sheet, &sheet.flat, &[])?.into_bytes()),
            (REPORT_JSON, json_text(&self.report)?.into_bytes()),
        ])
    }

    /// The file's vertices and faces as they were, with flat texture coordinates in mm. Numbers are written so that
    /// they read back as the same.
    fn obj(&self) -> String {
        let mut out = format!(
            "# toile {}: {}; vt = flat position (x, -y), millimetres\n",
            env!("CARGO_PKG_VERSION"),
            self.report.surface
        );
        for p in &self.faces.vertices {
            let _ = writeln!(out, "v {} {} {}", p.x, p.y, p.z);
        }
        let mut first = Vec::with_capacity(self.parts.len());
        let mut written = 1;
        for flat in &self.flat {
            first.push(written);
            written += flat.positions.len();
            for p in &flat.positions {
                let _ = writeln!(out, "vt {} {}", p.x * MM, -p.y * MM);
            }
        }
        let mut part_of_face = vec![0; self.faces.faces.len()];
        for (k, part) in self.parts.iter().enumerate() {
            part.faces.iter().for_each(|&f| part_of_face[f as usize] = k);
        }
        let mut group = None;
        for (f, corners) in self.faces.faces.iter().enumerate() {
            let k = part_of_face[f];
            if group != Some(k) {
                let _ = writeln!(out, "g {}", self.parts[k].name);
                group = Some(k);
            }
            out.push('f');
            for &v in corners {
                let texture = first[k] + self.parts[k].vertices.partition_point(|&w| w < v);
                let _ = write!(out, " {}/{texture}", v + 1);
            }
            out.push('\n');
        }
        out
    }

    /// The flat parts as the pieces of a cloth, each with its rims as edges.
    fn sheet(&self) -> ClothMesh {
        let mut cloth = ClothMesh::default();
        for (k, (part, flat)) in self.parts.iter().zip(&self.flat).enumerate() {
            let (particle, triangle) = (cloth.flat.len(), cloth.triangles.len());
            cloth.flat.extend(&flat.positions);
            cloth.triangles.extend(part.surface.triangles.iter().map(|t| t.map(|v| v + particle as u32)));
            cloth.pieces.push(PieceMesh {
                name: part.name.clone(),
                particles: particle..cloth.flat.len(),
                triangles: triangle..cloth.triangles.len(),
                edges: rims(part, k, particle as u32),
                lines: Vec::new(),
                smallest_angle: 0.0,
                warp: -Vec2::y(),
            });
        }
        cloth
    }
}

/// The rims of a part as closed edges, `rim` and, for holes, `rim.2` ….
fn rims(part: &Part, piece: usize, first: u32) -> Vec<EdgeParticles> {
    let edge = |(ring, mut vertices): (usize, Vec<u32>)| {
        vertices.extend(vertices.first().copied());
        EdgeParticles {
            edge: EdgeId { piece, ring, index: 0 },
            name: if ring == 0 { "rim".into() } else { format!("rim.{}", ring + 1) },
            particles: vertices.iter().map(|v| v + first).collect(),
        }
    };
    rim_loops(&part.surface.triangles).into_iter().enumerate().map(edge).collect()
}
