//! Distances on the cloth.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::glue::Glued;
use crate::geometry::Vec2;
use crate::mesh::ClothMesh;

/// The triangles round every node of a glued surface.
pub(super) struct Around {
    /// First entry of every node.
    first: Vec<usize>,
    entries: Vec<(u32, u8)>,
}

impl Around {
    pub(super) fn new(glued: &Glued) -> Self {
        let mut first = vec![0; glued.count + 1];
        glued.triangles.iter().flatten().for_each(|&n| first[n as usize + 1] += 1);
        for n in 0..glued.count {
            first[n + 1] += first[n];
        }
        let mut at = first.clone();
        let mut entries = vec![(0, 0); 3 * glued.triangles.len()];
        for (t, corners) in glued.triangles.iter().enumerate() {
            for (k, &n) in corners.iter().enumerate() {
                entries[at[n as usize]] = (t as u32, k as u8);
                at[n as usize] += 1;
            }
        }
        Self { first, entries }
    }

    /// Triangles round a node, and the node's place in each.
    pub(super) fn of(&self, node: u32) -> &[(u32, u8)] {
        &self.entries[self.first[node as usize]..self.first[node as usize + 1]]
    }
}

/// A glued surface on which distances are measured: along its edges and across its triangles.
pub struct Distances<'a> {
    glued: &'a Glued,
    flat: &'a [Vec2],
    around: Around,
}

impl<'a> Distances<'a> {
    /// Of this surface.
    pub fn new(glued: &'a Glued, mesh: &'a ClothMesh) -> Self {
        Self { glued, flat: &mesh.flat, around: Around::new(glued) }
    }

    /// Flat corners of a triangle of the surface.
    pub fn corners(&self, triangle: usize) -> [Vec2; 3] {
        self.glued.corners[triangle].map(|p| self.flat[p as usize])
    }

    /// Sum of the flat angles of the cloth round a node, radians.
    pub(super) fn angle(&self, node: u32) -> f64 {
        let angle = |&(t, k): &(u32, u8)| {
            let corners = self.corners(t as usize);
            let [own, one, other] = [0, 1, 2].map(|step| corners[(k as usize + step) % 3]);
            (one - own).angle(&(other - own))
        };
        self.around.of(node).iter().map(angle).sum()
    }

    /// Distance of every node from the nearest of these, metres; infinite in other parts.
    pub fn from(&self, nodes: &[u32]) -> Vec<f64> {
        let mut far = vec![f64::INFINITY; self.glued.count];
        let mut done = vec![false; self.glued.count];
        let mut queue = BinaryHeap::new();
        for &n in nodes {
            far[n as usize] = 0.0;
            queue.push(Reverse((Key(0.0), n)));
        }
        while let Some(Reverse((_, node))) = queue.pop() {
            if std::mem::replace(&mut done[node as usize], true) {
                continue;
            }
            for &(t, k) in self.around.of(node) {
                for step in [1, 2] {
                    let to = self.glued.triangles[t as usize][(k as usize + step) % 3];
                    let reached = self.reached(t as usize, k as usize, step, &far);
                    if !done[to as usize] && reached < far[to as usize] {
                        far[to as usize] = reached;
                        queue.push(Reverse((Key(reached), to)));
                    }
                }
            }
        }
        far
    }

    /// Distance of the corner `step` places after corner `k` of a triangle: along the side between the two, or straight
    /// across from a front that passes the other two corners.
    fn reached(&self, t: usize, k: usize, step: usize, far: &[f64]) -> f64 {
        let flat = self.corners(t);
        let (to, other) = ((k + step) % 3, (k + 3 - step) % 3);
        let [u, v] = [k, other].map(|c| far[self.glued.triangles[t][c] as usize]);
        let along = u + (flat[to] - flat[k]).norm();
        if !v.is_finite() {
            return along;
        }
        along.min(across([flat[k], flat[other], flat[to]], [u, v]).unwrap_or(f64::INFINITY))
    }
}

/// Distance of `c` from a straight front that reached `a` at `u` and `b` at `v`; none where it does not come through
/// the side between them.
fn across([a, b, c]: [Vec2; 3], [u, v]: [f64; 2]) -> Option<f64> {
    let side = b - a;
    let length = side.norm();
    let along = side / length;
    let slope = (v - u) / length;
    if slope.abs() >= 1.0 {
        return None;
    }
    let off = c - a;
    let (x, y) = (off.dot(&along), off.perp(&along).abs());
    let rise = (1.0 - slope * slope).sqrt();
    // The ray that ends in c leaves the side here.
    let foot = x - y * slope / rise;
    (foot > 0.0 && foot < length).then_some(u + slope * x + rise * y)
}

/// A distance that can be ordered.
#[derive(Clone, Copy, PartialEq)]
struct Key(f64);

impl Eq for Key {}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_front_goes_straight_across_a_triangle() {
        let corners = [Vec2::new(0.0, 0.0), Vec2::new(1.0, 0.0), Vec2::new(0.5, 1.0)];
        assert_relative_eq!(across(corners, [2.0, 2.0]).expect("through"), 3.0);
        // Slanting by 3 in 5 it comes from another place of the side.
        let slanting = across([corners[0], corners[1], Vec2::new(0.8, 0.8)], [0.0, 0.6]);
        assert_relative_eq!(slanting.expect("through"), 0.48 + 0.64);
        assert_eq!(across(corners, [0.0, 1.2]), None);
    }
}
