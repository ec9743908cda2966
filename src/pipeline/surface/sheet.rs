//! The surface as it has been cut so far.

use std::collections::HashSet;

use super::mend::{Weld, welded};
use super::parts::{Nodes, SurfacePart, parts};
use super::report::{CutReport, CutWhy};
use super::size::Space;
use crate::flatten::line::{self, SurfacePoint};
use crate::geometry::{MM, Vec3, sorted_pair};
use crate::io::obj_read::ObjFaces;

/// Faces, the lines along which they are split, and those of them that are cut open.
#[derive(Clone)]
pub(super) struct CutFaces {
    /// The file's faces, then those that faces were split into; a face that was split has no corners any more.
    pub(super) faces: ObjFaces,
    /// The face of the file that every face is of.
    pub(super) origin: Vec<u32>,
    /// Of every vertex the one that stands for it.
    pub(super) same: Vec<u32>,
    pub(super) nodes: Nodes,
    /// Whether seams of the texture are cuts.
    pub(super) textured: bool,
    pub(super) space: Space,
    /// Name of what has none.
    stem: String,
    /// Number of the first vertex and of the first face in messages and reports.
    pub(super) first_number: u32,
    /// Edges that are cut: the vertices that stand for their ends, the smaller first.
    pub(super) edges: HashSet<[u32; 2]>,
    /// The cuts as chains of vertices, by their numbers.
    pub(super) chains: Vec<Vec<u32>>,
    /// A row for each of these.
    pub(super) made: Vec<CutReport>,
    /// Lines that are split already and not yet cut: the part's name and vertices.
    planned: Vec<(String, Vec<u32>)>,
}

impl CutFaces {
    /// The surface as it was read.
    pub(super) fn new(mut faces: ObjFaces, same: Vec<u32>, textured: bool, space: Space, stem: &str) -> Self {
        faces.texture_of_face.resize(faces.faces.len(), Vec::new());
        let nodes = Nodes::new(&faces, textured, &same);
        Self {
            origin: (0..faces.faces.len() as u32).collect(),
            faces,
            same,
            nodes,
            textured,
            space,
            stem: stem.to_owned(),
            first_number: 1,
            edges: HashSet::new(),
            chains: Vec::new(),
            made: Vec::new(),
            planned: Vec::new(),
        }
    }

    /// The faces that are left in the order of the file, those that one was split into in its place.
    pub(super) fn order(&self) -> Vec<u32> {
        let left = (0..self.faces.faces.len() as u32).filter(|&f| !self.faces.faces[f as usize].is_empty());
        let mut order: Vec<u32> = left.collect();
        order.sort_by_key(|&f| (self.origin[f as usize], f));
        order
    }

    /// Its parts, in the order of their first faces.
    pub(super) fn parts(&self) -> Vec<SurfacePart> {
        parts(self, &self.nodes.edges_on(&self.edges), self.space, &self.stem)
    }

    /// The vertex that stands for every one if they are welded like this.
    pub(super) fn welded_within(&self, weld: Weld) -> Vec<u32> {
        welded(&self.faces, weld, self.space.metres)
    }

    /// The same faces without cuts, their vertices joined like this.
    pub(super) fn read_as(&self, textured: bool, same: Vec<u32>) -> Self {
        Self::new(self.faces.clone(), same, textured, self.space, &self.stem)
    }

    /// Makes one of all groups.
    pub(super) fn join_groups(&mut self) {
        self.faces.join_groups();
        self.nodes = Nodes::new(&self.faces, self.textured, &self.same);
    }

    /// Cuts a part along a line.
    pub(super) fn cut(&mut self, part: &SurfacePart, line: &[SurfacePoint], why: CutWhy) {
        if line.len() > 1 {
            let length = line::length(&part.surface, line) * MM;
            let chain = self.split(part, line);
            self.open(part.name.clone(), why, chain, length);
        }
    }

    /// Splits the faces along a line of a part, which is cut when [`Self::cut_planned`] is called.
    pub(super) fn draw(&mut self, part: &SurfacePart, line: &[SurfacePoint]) {
        let chain = self.split(part, line);
        self.plan(part.name.clone(), chain);
    }

    /// Notes a chain of vertices of a part as one to be cut when [`Self::cut_planned`] is called.
    pub(super) fn plan(&mut self, piece: String, chain: Vec<u32>) {
        self.planned.push((piece, chain));
    }

    /// Cuts all lines that were planned.
    pub(super) fn cut_planned(&mut self, why: CutWhy) {
        for (piece, chain) in std::mem::take(&mut self.planned) {
            let length = chain.windows(2).map(|w| (self.place(w[1]) - self.place(w[0])).norm()).sum::<f64>() * MM;
            self.open(piece, why, chain, length);
        }
    }

    /// Opens the edges along a chain of vertices, `length` millimetres long.
    fn open(&mut self, piece: String, why: CutWhy, chain: Vec<u32>, length: f64) {
        self.edges.extend(chain.windows(2).map(|w| sorted_pair([w[0], w[1]])));
        if let [from, .., to] = *chain {
            let number = |v: u32| v + self.first_number;
            self.made.push(CutReport { piece, why, from: number(from), to: number(to), length, strain: None });
            self.chains.push(chain.iter().map(|&v| number(v)).collect());
        }
    }

    /// Closes the cut of this number again. The faces along it stay split.
    pub(super) fn close(&mut self, number: usize) {
        self.made.remove(number);
        for ends in self.chains.remove(number).windows(2) {
            self.edges.remove(&sorted_pair([ends[0] - self.first_number, ends[1] - self.first_number]));
        }
    }

    /// Notes an edge as split by a vertex: where it is cut both halves are, and chains along it go through the vertex.
    pub(super) fn divide(&mut self, edge: [u32; 2], by: u32) {
        if self.edges.remove(&edge) {
            self.edges.extend(edge.map(|end| sorted_pair([end, by])));
        }
        let through = |chain: &mut Vec<u32>, first: u32| {
            let ends = edge.map(|v| v + first);
            while let Some(k) = chain.windows(2).position(|w| sorted_pair([w[0], w[1]]) == ends) {
                chain.insert(k + 1, by + first);
            }
        };
        self.chains.iter_mut().for_each(|chain| through(chain, self.first_number));
        self.planned.iter_mut().for_each(|(_, chain)| through(chain, 0));
    }

    /// Says of all cuts from number `first` on how much the piece was strained before them and is with them.
    pub(super) fn tell_strain(&mut self, first: usize, strain: [f64; 2]) {
        self.made[first..].iter_mut().for_each(|made| made.strain = Some(strain));
    }

    /// Where a vertex of the file lies, metres.
    pub(super) fn place(&self, v: u32) -> Vec3 {
        self.space.place(self.faces.vertices[v as usize])
    }
}
