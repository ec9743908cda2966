//! From an OBJ's faces to the parts that are laid flat one by one.
//!
//! Faces hang together across an edge unless it lies between two groups, is a seam of the texture or is marked as a
//! cut. Every fan of faces that hang together round a vertex gets a vertex of its own, so that cuts open and parts that
//! only touch come apart.

use std::collections::{HashMap, HashSet};

use super::rows::Rows;
use super::sheet::CutFaces;
use super::size::Space;
use crate::flatten::{FlattenError, Solid, orient};
use crate::geometry::{DisjointSets, TriMesh, Vec3, diagonals_of, sorted_pair, triangles_of};
use crate::io::obj_read::ObjFaces;

/// A connected part of the surface.
#[derive(Clone)]
pub(super) struct SurfacePart {
    pub(super) name: String,
    /// The file's vertex of every vertex.
    pub(super) vertices: Vec<u32>,
    /// Its faces, indices into those of the sheet.
    pub(super) faces: Vec<u32>,
    /// The face of the file that each is of.
    origins: Vec<u32>,
    /// Number of the first vertex and of the first face in messages and reports.
    first_number: u32,
    /// Corners of each of these, as vertices of the part.
    pub(super) corners: Rows,
    /// Edges of the surface that are inside a polygon of the file.
    pub(super) diagonals: Solid,
    /// In metres, its triangles turned round: a flat piece shows the side that faces outward in space.
    pub(super) surface: TriMesh,
    /// Triangles that ran against most others and were turned; none where no turning makes them agree.
    pub(super) turned: Option<Vec<usize>>,
}

/// The corners of the faces: the vertices of the file, once for every group and texture position they have.
#[derive(Clone)]
pub(super) struct Nodes {
    /// Of every face's corners.
    of_face: Rows,
    /// The file's vertex of every node.
    vertex: Vec<u32>,
}

/// No node.
const NONE: u32 = u32::MAX;

/// Group and, where it counts, texture position of a node.
type NodeKey = (u32, Option<[u64; 2]>);

impl Nodes {
    /// With `texture`, a vertex that has several texture positions is several nodes. `same` has the vertex that stands
    /// for every vertex.
    pub(super) fn new(faces: &ObjFaces, texture: bool, same: &[u32]) -> Self {
        let (mut of_face, mut vertex) = (Rows::new(), Vec::new());
        // The nodes of a vertex, which are few: the last made, and from each to the one before.
        let mut last = vec![NONE; faces.vertices.len()];
        let mut made: Vec<(NodeKey, u32)> = Vec::new();
        for (f, corners) in faces.faces.iter().enumerate() {
            let textured = faces.texture_of_face.get(f).filter(|t| texture && !t.is_empty());
            let nodes = corners.iter().enumerate().map(|(k, &v)| {
                let v = same[v as usize];
                // Equal positions count as one even if they are written twice; −0 is 0.
                let at = textured.map(|t| faces.texture[t[k] as usize].map(|x| (x + 0.0).to_bits()));
                let key = (faces.group_of_face[f], at);
                let mut node = last[v as usize];
                while node != NONE && made[node as usize].0 != key {
                    node = made[node as usize].1;
                }
                if node == NONE {
                    node = made.len() as u32;
                    made.push((key, std::mem::replace(&mut last[v as usize], node)));
                    vertex.push(v);
                }
                node
            });
            of_face.push(nodes);
        }
        Self { of_face, vertex }
    }

    /// Edges of nodes, smaller first, that lie on one of the file's edges.
    pub(super) fn edges_on(&self, of_file: &HashSet<[u32; 2]>) -> HashSet<[u32; 2]> {
        let on = |ends: &[u32; 2]| of_file.contains(&sorted_pair(ends.map(|n| self.vertex[n as usize])));
        self.of_face.iter().flat_map(sides).filter(on).collect()
    }
}

fn sides(face: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    (0..face.len()).map(|k| sorted_pair([face[k], face[(k + 1) % face.len()]]))
}

/// The parts in the order of their first faces, group by group; named by their group or, without one, by `stem`.
pub(super) fn parts(sheet: &CutFaces, cuts: &HashSet<[u32; 2]>, space: Space, stem: &str) -> Vec<SurfacePart> {
    let CutFaces { faces, nodes, origin, first_number, .. } = sheet;
    let fans = Fans::new(nodes, cuts);
    let source = PartSource { faces, nodes, origin, fans: &fans, space, first_number: *first_number };
    let mut local = vec![0; fans.of_corner.len()];
    let mut parts: Vec<SurfacePart> = Vec::new();
    let mut of_group: Vec<Vec<u32>> = vec![Vec::new(); faces.groups.len()];
    sheet.order().into_iter().for_each(|f| of_group[faces.group_of_face[f as usize] as usize].push(f));
    for (group, own) in faces.groups.iter().zip(of_group) {
        let mut number = HashMap::new();
        let mut split: Vec<Vec<u32>> = Vec::new();
        for f in own {
            let k = *number.entry(fans.part_of_face[f as usize]).or_insert(split.len());
            split.resize_with(split.len().max(k + 1), Vec::new);
            split[k].push(f);
        }
        let name = if group.is_empty() { stem } else { group };
        let several = split.len() > 1;
        for (k, own) in split.into_iter().enumerate() {
            let name = if several { format!("{name}.{}", k + 1) } else { name.to_owned() };
            parts.push(SurfacePart::new(&source, name, own, &mut local));
        }
    }
    parts
}

/// The faces and groups that parts are made from.
#[derive(Clone, Copy)]
struct PartSource<'a> {
    faces: &'a ObjFaces,
    nodes: &'a Nodes,
    origin: &'a [u32],
    fans: &'a Fans,
    space: Space,
    first_number: u32,
}

/// Which corners are one vertex, and which faces one part.
struct Fans {
    /// First corner of every face.
    starts: Vec<usize>,
    of_corner: Vec<u32>,
    part_of_face: Vec<u32>,
}

impl Fans {
    fn new(nodes: &Nodes, cuts: &HashSet<[u32; 2]>) -> Self {
        let mut starts = vec![0];
        let mut sides: Vec<([u32; 2], u32, u32)> = Vec::new();
        for (f, face) in nodes.of_face.iter().enumerate() {
            for k in 0..face.len() {
                sides.push((sorted_pair([face[k], face[(k + 1) % face.len()]]), f as u32, k as u32));
            }
            starts.push(starts[f] + face.len());
        }
        sides.sort_unstable();
        let mut corners = DisjointSets::new(starts[nodes.of_face.len()]);
        let mut faces = DisjointSets::new(nodes.of_face.len());
        for shared in sides.chunk_by(|a, b| a.0 == b.0).filter(|s| s.len() > 1 && !cuts.contains(&s[0].0)) {
            // The corner of a side at one of its nodes.
            let at = |(_, f, k): (_, u32, u32), node: u32| {
                let face = &nodes.of_face[f as usize];
                let here = k as usize;
                let corner = if face[here] == node { here } else { (here + 1) % face.len() };
                (starts[f as usize] + corner) as u32
            };
            for other in &shared[1..] {
                for &node in &shared[0].0 {
                    corners.join(at(shared[0], node), at(*other, node));
                }
                faces.join(shared[0].1, other.1);
            }
        }
        let of_corner = (0..corners.len() as u32).map(|c| corners.root(c)).collect();
        let part_of_face = (0..faces.len() as u32).map(|f| faces.root(f)).collect();
        Self { starts, of_corner, part_of_face }
    }
}

impl SurfacePart {
    /// `local` has room for every fan; a part uses its own places only.
    fn new(source: &PartSource<'_>, name: String, own: Vec<u32>, local: &mut [u32]) -> Self {
        let PartSource { faces, nodes, origin, fans, space, first_number } = *source;
        // Vertices in the file's order, of those that a cut has made of one the first face's first.
        let mut all: Vec<(u32, u32)> = Vec::new();
        let fan_of = |f: u32, k: usize| fans.of_corner[fans.starts[f as usize] + k];
        for &f in &own {
            for (k, &node) in nodes.of_face[f as usize].iter().enumerate() {
                all.push((nodes.vertex[node as usize], fan_of(f, k)));
            }
        }
        all.sort_unstable();
        all.dedup_by_key(|(_, fan)| *fan);
        all.iter().enumerate().for_each(|(k, &(_, fan))| local[fan as usize] = k as u32);
        let number = |f: u32| (0..faces.faces[f as usize].len()).map(move |k| fan_of(f, k));
        let mut corners = Rows::new();
        own.iter().for_each(|&f| corners.push(number(f).map(|fan| local[fan as usize])));
        let vertices: Vec<u32> = all.iter().map(|a| a.0).collect();
        let positions: Vec<Vec3> = vertices.iter().map(|&v| space.place(faces.vertices[v as usize])).collect();
        let of_polygon: Vec<Vec<[u32; 3]>> = corners.iter().map(|polygon| triangles_of(&positions, polygon)).collect();
        let mut triangles: Vec<[u32; 3]> = of_polygon.iter().flatten().map(|&[a, b, c]| [a, c, b]).collect();
        let turned = orient(&mut triangles);
        let both = corners.iter().zip(&of_polygon);
        let diagonals = both.flat_map(|(polygon, triangles)| diagonals_of(polygon, triangles)).collect();
        let surface = TriMesh { vertices: positions, triangles };
        let origins = own.iter().map(|&f| origin[f as usize]).collect();
        Self { name, vertices, faces: own, origins, first_number, corners, diagonals, surface, turned }
    }

    /// The face that a triangle is of, its number among that face's triangles, and the weights of its corners in the
    /// order in which they are there.
    pub(super) fn in_face(&self, triangle: usize, weights: [f64; 3]) -> (u32, usize, [f64; 3]) {
        let mut first = 0;
        let mut face = 0;
        while first + self.corners[face].len() - 2 <= triangle {
            first += self.corners[face].len() - 2;
            face += 1;
        }
        let own = triangles_of(&self.surface.vertices, &self.corners[face])[triangle - first];
        let corners = self.surface.triangles[triangle];
        let of = |v: u32| corners.iter().position(|&w| w == v).map_or(0.0, |k| weights[k]);
        (self.faces[face], triangle - first, own.map(of))
    }

    /// The file's number of a vertex.
    pub(super) fn number(&self, vertex: u32) -> u32 {
        self.vertices.get(vertex as usize).map_or(0, |v| v + self.first_number)
    }

    /// The note on faces that were turned.
    pub(super) fn turned_note(&self) -> Option<String> {
        let mut is_turned = vec![false; self.surface.triangles.len()];
        self.turned.as_ref()?.iter().for_each(|&t| is_turned[t] = true);
        let mut done = 0;
        // All faces at once: looked up one by one, each would be counted from the first.
        let turned = self.origins.iter().zip(self.corners.iter()).filter(|(_, corners)| {
            let own = done..done + corners.len() - 2;
            done = own.end;
            is_turned[own].contains(&true)
        });
        let mut faces: Vec<usize> = turned.map(|(f, _)| (*f + self.first_number) as usize).collect();
        faces.dedup();
        let mut all = self.origins.clone();
        all.dedup();
        let (count, all, first) = (faces.len(), all.len(), *faces.first()?);
        let (run, were) = if count == 1 { ("face runs", "was") } else { ("faces run", "were") };
        let said = format!("{count} of its {all} {run} against the others and {were} turned to lay it flat");
        Some(format!("'{}': {said}; the first is face {first}", self.name))
    }

    /// The file's number of the face a triangle is of.
    fn face_of(&self, triangle: usize) -> usize {
        let mut first = 0;
        let counts = self.corners.iter().map(|c| c.len() - 2);
        let face = counts
            .take_while(|n| {
                first += n;
                first <= triangle
            })
            .count();
        self.origins.get(face).map_or(0, |f| (f + self.first_number) as usize)
    }

    /// An error in the file's numbers.
    pub(super) fn blame(&self, error: FlattenError) -> FlattenError {
        error.renumbered(&|v| self.number(v as u32) as usize, &|t| self.face_of(t))
    }
}
