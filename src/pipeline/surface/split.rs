//! Splits faces along a line, so that it runs along edges.
//!
//! Every face beside an edge that a line crosses gets the new vertex, whichever part it is of, so that seams keep
//! matching vertices on both sides.

use std::collections::HashMap;

use super::mend::leave_out;
use super::parts::{Nodes, SurfacePart};
use super::sheet::CutFaces;
use crate::flatten::line::SurfacePoint;
use crate::geometry::{Vec3, sorted_pair, triangles_of};

/// A new vertex on an edge, and the share of the way to it from the smaller end.
#[derive(Clone, Copy)]
struct OnEdge {
    vertex: u32,
    at: f64,
}

/// A new vertex inside a triangle of a face.
struct InnerVertex {
    face: u32,
    /// The number of the triangle among those of the face.
    triangle: usize,
    vertex: u32,
    weights: [f64; 3],
}

/// A corner of a piece of a face.
#[derive(Clone, Copy, PartialEq)]
enum SplitCorner {
    /// A corner of the face.
    Own(usize),
    /// The new vertex between two of its corners.
    Between(usize, usize),
    /// The new vertex inside.
    Inner,
}

/// The new vertices of a line.
#[derive(Default)]
struct Added {
    on_edge: HashMap<[u32; 2], OnEdge>,
    inside: Vec<InnerVertex>,
}

impl CutFaces {
    /// Splits the faces that a line of a part crosses; the line's vertices.
    pub(super) fn split(&mut self, part: &SurfacePart, line: &[SurfacePoint]) -> Vec<u32> {
        let mut added = Added::default();
        let chain = line.iter().map(|spot| self.vertex_at(part, spot, &mut added)).collect();
        if !added.on_edge.is_empty() || !added.inside.is_empty() {
            for f in self.beside(&added) {
                self.split_face(f, &added);
            }
            let mut edges: Vec<([u32; 2], u32)> = added.on_edge.iter().map(|(edge, on)| (*edge, on.vertex)).collect();
            edges.sort_unstable();
            edges.into_iter().for_each(|(edge, by)| self.divide(edge, by));
            self.nodes = Nodes::new(&self.faces, self.textured, &self.same);
        }
        chain
    }

    /// The vertex at a spot, a new one where there is none.
    fn vertex_at(&mut self, part: &SurfacePart, spot: &SurfacePoint, added: &mut Added) -> u32 {
        match *spot {
            SurfacePoint::Vertex(v) => part.vertices[v as usize],
            SurfacePoint::Edge { ends, at } => {
                let [a, b] = ends.map(|v| part.vertices[v as usize]);
                let (edge, at) = if a < b { ([a, b], at) } else { ([b, a], 1.0 - at) };
                if let Some(on) = added.on_edge.get(&edge) {
                    return on.vertex;
                }
                let [p, q] = edge.map(|v| self.faces.vertices[v as usize]);
                let vertex = self.add(p.lerp(&q, at));
                added.on_edge.insert(edge, OnEdge { vertex, at });
                vertex
            }
            SurfacePoint::Face { triangle, weights } => {
                let corners = part.surface.triangles[triangle as usize].map(|v| part.vertices[v as usize]);
                let sum: Vec3 = corners.iter().zip(weights).map(|(&v, w)| self.faces.vertices[v as usize] * w).sum();
                let vertex = self.add(sum);
                let (face, triangle, weights) = part.in_face(triangle as usize, weights);
                added.inside.push(InnerVertex { face, triangle, vertex, weights });
                vertex
            }
        }
    }

    fn add(&mut self, place: Vec3) -> u32 {
        let vertex = self.faces.vertices.len() as u32;
        self.faces.vertices.push(place);
        self.same.push(vertex);
        vertex
    }

    /// The faces that may have one of the new vertices.
    fn beside(&self, added: &Added) -> Vec<usize> {
        let mut is_end = vec![false; self.faces.vertices.len()];
        added.on_edge.keys().flatten().for_each(|&v| is_end[v as usize] = true);
        let mut holds = vec![false; self.faces.faces.len()];
        added.inside.iter().for_each(|inside| holds[inside.face as usize] = true);
        let ends = |f: usize| self.faces.faces[f].iter().filter(|v| is_end[self.same[**v as usize] as usize]).count();
        (0..holds.len()).filter(|&f| holds[f] || ends(f) > 1).collect()
    }

    /// Splits a face at the new vertices that it has.
    fn split_face(&mut self, f: usize, added: &Added) {
        let corners = self.faces.faces[f].clone();
        let places: Vec<Vec3> = corners.iter().map(|&v| self.place(v)).collect();
        let all: Vec<u32> = (0..corners.len() as u32).collect();
        let triangles: Vec<[usize; 3]> =
            triangles_of(&places, &all).into_iter().map(|t| t.map(|k| k as usize)).collect();
        let stands = |k: usize| self.same[corners[k] as usize];
        let on = |a: usize, b: usize| added.on_edge.get(&sorted_pair([stands(a), stands(b)])).copied();
        let inside = |t: usize| added.inside.iter().find(|i| i.face as usize == f && i.triangle == t);
        let mut pieces: Vec<(usize, [SplitCorner; 3])> = Vec::new();
        for (t, &triangle) in triangles.iter().enumerate() {
            let sides = [0, 1, 2].map(|k| on(triangle[k], triangle[(k + 1) % 3]).is_some());
            let place = |corner: SplitCorner| match corner {
                SplitCorner::Own(k) => places[k],
                SplitCorner::Between(a, b) => {
                    let (low, high) = if stands(a) < stands(b) { (a, b) } else { (b, a) };
                    places[low].lerp(&places[high], on(a, b).map_or(0.5, |on| on.at))
                }
                SplitCorner::Inner => triangle.iter().map(|&k| places[k]).sum::<Vec3>() / 3.0,
            };
            pieces.extend(pieces_of(triangle, sides, inside(t).is_some(), place).into_iter().map(|piece| (t, piece)));
        }
        if pieces.len() == triangles.len() {
            return;
        }
        let vertex = |t: usize, corner: SplitCorner| match corner {
            SplitCorner::Own(k) => corners[k],
            SplitCorner::Between(a, b) => on(a, b).map_or(corners[a], |on| on.vertex),
            SplitCorner::Inner => inside(t).map_or(corners[0], |inside| inside.vertex),
        };
        let faces: Vec<Vec<u32>> =
            pieces.iter().map(|(t, piece)| piece.iter().map(|&c| vertex(*t, c)).collect()).collect();
        let textures = self.textures(f, &triangles, &pieces, added);
        let (group, origin) = (self.faces.group_of_face[f], self.origin[f]);
        leave_out(&mut self.faces, f);
        for (face, texture) in faces.into_iter().zip(textures) {
            self.faces.faces.push(face);
            self.faces.texture_of_face.push(texture);
            self.faces.group_of_face.push(group);
            self.origin.push(origin);
        }
    }

    /// Texture coordinates of the pieces of a face, the new ones between those of its corners; they are the same bits
    /// on both sides of an edge.
    fn textures(
        &mut self,
        f: usize,
        triangles: &[[usize; 3]],
        pieces: &[(usize, [SplitCorner; 3])],
        added: &Added,
    ) -> Vec<Vec<u32>> {
        let own = self.faces.texture_of_face.get(f).cloned().unwrap_or_default();
        if own.is_empty() {
            return vec![Vec::new(); pieces.len()];
        }
        let corners = self.faces.faces[f].clone();
        let mut out = Vec::with_capacity(pieces.len());
        for (t, piece) in pieces {
            let mut of_piece = Vec::with_capacity(3);
            for corner in piece {
                let at = |k: usize| self.faces.texture[own[k] as usize];
                let stands = |k: usize| self.same[corners[k] as usize];
                let new = match *corner {
                    SplitCorner::Own(k) => {
                        of_piece.push(own[k]);
                        continue;
                    }
                    SplitCorner::Between(a, b) => {
                        let (low, high) = if stands(a) < stands(b) { (a, b) } else { (b, a) };
                        let share = added.on_edge.get(&[stands(low), stands(high)]).map_or(0.5, |on| on.at);
                        [0, 1].map(|i| at(low)[i] + (at(high)[i] - at(low)[i]) * share)
                    }
                    SplitCorner::Inner => {
                        let inside = added.inside.iter().find(|i| i.face as usize == f && i.triangle == *t);
                        let weights = inside.map_or([1.0 / 3.0; 3], |inside| inside.weights);
                        let sum = |i: usize| triangles[*t].iter().zip(weights).map(|(&k, w)| at(k)[i] * w).sum();
                        [0, 1].map(sum)
                    }
                };
                of_piece.push(self.faces.texture.len() as u32);
                self.faces.texture.push(new);
            }
            out.push(of_piece);
        }
        out
    }
}

/// The pieces of a triangle with new vertices on some of its sides (side k runs from corner k to the next) and perhaps
/// one inside, which they all meet in.
fn pieces_of(
    triangle: [usize; 3],
    sides: [bool; 3],
    inside: bool,
    place: impl Fn(SplitCorner) -> Vec3,
) -> Vec<[SplitCorner; 3]> {
    let own = triangle.map(SplitCorner::Own);
    let between = [0, 1, 2].map(|k| SplitCorner::Between(triangle[k], triangle[(k + 1) % 3]));
    if inside {
        let all = (0..3).flat_map(|k| [Some(own[k]), sides[k].then_some(between[k])]);
        let rim: Vec<SplitCorner> = all.flatten().collect();
        return (0..rim.len()).map(|k| [rim[k], rim[(k + 1) % rim.len()], SplitCorner::Inner]).collect();
    }
    match sides.iter().filter(|side| **side).count() {
        0 => vec![own],
        1 => {
            let k = sides.iter().position(|side| *side).unwrap_or(0);
            let (a, b, c) = (own[k], own[(k + 1) % 3], own[(k + 2) % 3]);
            vec![[a, between[k], c], [between[k], b, c]]
        }
        2 => {
            // The corner between the two sides, then round the triangle.
            let whole = sides.iter().position(|side| !*side).unwrap_or(0);
            let (b, c, a) = (own[whole], own[(whole + 1) % 3], own[(whole + 2) % 3]);
            let (on_ca, on_ab) = (between[(whole + 1) % 3], between[(whole + 2) % 3]);
            let length = |p: SplitCorner, q: SplitCorner| (place(q) - place(p)).norm();
            let tip = [a, on_ab, on_ca];
            if length(on_ab, c) < length(b, on_ca) {
                vec![tip, [on_ab, b, c], [on_ab, c, on_ca]]
            } else {
                vec![tip, [on_ab, b, on_ca], [b, c, on_ca]]
            }
        }
        _ => {
            let [ab, bc, ca] = between;
            vec![[own[0], ab, ca], [ab, own[1], bc], [ca, bc, own[2]], [ab, bc, ca]]
        }
    }
}
