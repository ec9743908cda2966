//! Places of the drawn lines on the cloth.

use std::collections::HashMap;

use super::Scene;
use super::color::Rgb;
use crate::geometry::Vec3;

/// A straight piece of a line.
pub(super) struct LineSegment {
    pub(super) ends: [Vec3; 2],
    /// Half its width, pixels.
    pub(super) radius: f32,
    pub(super) color: Rgb,
    /// Drawn as if this much nearer, metres.
    pub(super) lift: f32,
    /// The triangles that it lies on and those that touch them, in order. It need not be more of its pieces: a piece
    /// that lies over itself hides its own lines.
    pub(super) around: Vec<u32>,
}

/// All lines, each kind with half its width and its colour, drawn as if nearer by `lift`, metres.
pub(super) fn lines(scene: &Scene, kinds: &[(&[Vec<Vec3>], f32, Rgb)], lift: f32) -> Vec<LineSegment> {
    let cloth = Neighbours::new(scene);
    let mut out = Vec::new();
    for &(courses, radius, color) in kinds {
        for ends in courses.iter().flat_map(|course| course.windows(2)).map(|w| [w[0], w[1]]) {
            out.push(LineSegment { ends, radius, color, lift, around: cloth.around(scene, &ends) });
        }
    }
    out
}

/// Triangles that meet at a vertex, and vertices at a place.
struct Neighbours {
    triangles: Vec<Vec<u32>>,
    vertices: HashMap<[u64; 3], Vec<u32>>,
}

impl Neighbours {
    fn new(scene: &Scene) -> Self {
        let mut triangles = vec![Vec::new(); scene.cloth.vertices.len()];
        for (corners, t) in scene.cloth.triangles.iter().zip(0..) {
            corners.iter().for_each(|&v| triangles[v as usize].push(t));
        }
        let mut vertices: HashMap<_, Vec<u32>> = HashMap::new();
        for (p, v) in scene.cloth.vertices.iter().zip(0..) {
            vertices.entry(bits(p)).or_default().push(v);
        }
        Self { triangles, vertices }
    }

    /// The triangles at a place.
    fn at(&self, p: &Vec3) -> Vec<u32> {
        let vertices = self.vertices.get(&bits(p)).into_iter().flatten();
        vertices.flat_map(|&v| &self.triangles[v as usize]).copied().collect()
    }

    /// Those round a line from a vertex to another, of the pieces that are at both.
    fn around(&self, scene: &Scene, ends: &[Vec3; 2]) -> Vec<u32> {
        let touching = ends.each_ref().map(|p| self.at(p));
        let has = |triangles: &[u32], piece: u32| triangles.iter().any(|&t| scene.piece_of(t as usize) == piece);
        let own = |t: &u32| touching.iter().all(|at| has(at, scene.piece_of(*t as usize)));
        let corners = touching.iter().flatten().flat_map(|&t| scene.cloth.triangles[t as usize]);
        let mut around: Vec<u32> = corners.flat_map(|v| &self.triangles[v as usize]).copied().filter(own).collect();
        around.sort_unstable();
        around.dedup();
        around
    }
}

fn bits(p: &Vec3) -> [u64; 3] {
    [p.x, p.y, p.z].map(f64::to_bits)
}
