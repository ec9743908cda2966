//! Makes the half surface's faces well shaped without leaving the body's skin, and mirrors it.

use super::field::BodyField;
use super::surface::HalfSurface;
use crate::geometry::{TriMesh, Vec3};

/// Rounds of smoothing. More rounds do not raise the smallest angle.
const ROUNDS: usize = 12;
/// Share of the way to its neighbours' middle that a vertex moves in one round.
const PACE: f64 = 0.7;
/// Newton steps onto the skin after the last round. The error is then far below a micrometre.
const LAST_STEPS: usize = 3;
/// Step of the difference quotient along the normal, metres.
const PROBE: f64 = 1e-4;

/// Smooths `half` along `body`'s skin.
pub(super) fn relax(half: &mut HalfSurface, body: &BodyField) {
    let neighbours = QuadNeighbours::new(half);
    for _ in 0..ROUNDS {
        let normals = normals(half);
        let moved: Vec<Vec3> = (0..half.vertices.len())
            .map(|v| {
                let p = half.vertices[v];
                let way = neighbours.middle(v, &half.vertices) - p;
                let n = normals[v];
                project(body, p + PACE * (way - n * n.dot(&way)), n)
            })
            .collect();
        half.vertices = moved;
    }
    let normals = normals(half);
    for (p, n) in half.vertices.iter_mut().zip(&normals) {
        for _ in 0..LAST_STEPS {
            *p = project(body, *p, *n);
        }
    }
}

/// One Newton step along `n` onto the skin. The point stays where the function is flat along `n`.
fn project(body: &BodyField, p: Vec3, n: Vec3) -> Vec3 {
    let f = body.distance(p);
    let slope = (body.distance(p + n * PROBE) - f) / PROBE;
    if slope < 0.1 {
        return p;
    }
    p - n * (f / slope)
}

/// Quad-edge neighbours of every vertex, as one flat list.
struct QuadNeighbours {
    start: Vec<usize>,
    list: Vec<u32>,
}

impl QuadNeighbours {
    fn new(half: &HalfSurface) -> Self {
        let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(8 * half.quads.len());
        for q in &half.quads {
            for k in 0..4 {
                let (a, b) = (q[k], q[(k + 1) % 4]);
                pairs.push((a, b));
                pairs.push((b, a));
            }
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut start = vec![0; half.vertices.len() + 1];
        for &(a, _) in &pairs {
            start[a as usize + 1] += 1;
        }
        for v in 0..half.vertices.len() {
            start[v + 1] += start[v];
        }
        Self { start, list: pairs.into_iter().map(|p| p.1).collect() }
    }

    /// The neighbours' middle. A vertex on the mirror plane counts those beside the plane twice, once for their image.
    fn middle(&self, v: usize, at: &[Vec3]) -> Vec3 {
        let on_plane = at[v].x == 0.0;
        let (mut sum, mut weight) = (Vec3::zeros(), 0.0);
        for &u in &self.list[self.start[v]..self.start[v + 1]] {
            let mut p = at[u as usize];
            let w = if on_plane && p.x != 0.0 { 2.0 } else { 1.0 };
            if on_plane {
                p.x = 0.0;
            }
            sum += w * p;
            weight += w;
        }
        if weight > 0.0 { sum / weight } else { at[v] }
    }
}

/// Unit vertex normals. On the mirror plane they lie in it.
fn normals(half: &HalfSurface) -> Vec<Vec3> {
    let at = &half.vertices;
    let mut normals = vec![Vec3::zeros(); at.len()];
    for q in &half.quads {
        let [a, b, c, d] = q.map(|v| at[v as usize]);
        let n = (c - a).cross(&(d - b));
        for &v in q {
            normals[v as usize] += n;
        }
    }
    for (n, p) in normals.iter_mut().zip(at) {
        if p.x == 0.0 {
            n.x = 0.0;
        }
        *n = n.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
    }
    normals
}

/// Both halves as triangles: every quad cut along the diagonal that leaves the larger smallest angle.
pub(super) fn mirrored(half: &HalfSurface) -> TriMesh {
    let mut vertices = half.vertices.clone();
    let image: Vec<u32> = half
        .vertices
        .iter()
        .enumerate()
        .map(|(v, p)| {
            if p.x == 0.0 {
                return v as u32;
            }
            vertices.push(Vec3::new(-p.x, p.y, p.z));
            vertices.len() as u32 - 1
        })
        .collect();
    let mut triangles = Vec::with_capacity(4 * half.quads.len());
    for q in &half.quads {
        triangles.extend(cut(*q, &half.vertices));
    }
    for t in 0..triangles.len() {
        let [a, b, c] = triangles[t].map(|v| image[v as usize]);
        triangles.push([c, b, a]);
    }
    TriMesh { vertices, triangles }
}

fn cut([a, b, c, d]: [u32; 4], at: &[Vec3]) -> [[u32; 3]; 2] {
    let one = [[a, b, c], [a, c, d]];
    let other = [[b, c, d], [b, d, a]];
    let worst = |pair: &[[u32; 3]; 2]| pair.iter().map(|t| sharpest(t.map(|v| at[v as usize]))).fold(-1.0, f64::max);
    if worst(&one) <= worst(&other) { one } else { other }
}

/// Cosine of a triangle's smallest angle.
fn sharpest(corners: [Vec3; 3]) -> f64 {
    let mut most: f64 = -1.0;
    for k in 0..3 {
        let (u, v) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
        let length = u.norm() * v.norm();
        most = most.max(if length > 0.0 { u.dot(&v) / length } else { 1.0 });
    }
    most
}
