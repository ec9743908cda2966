//! A tree of boxes over the triangles of a mesh.

use crate::geometry::{TriMesh, Vec3};

/// Triangles in a leaf: below this, testing them all is cheaper than another box.
const LEAF: usize = 4;

/// An axis-aligned box.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aabb {
    pub(super) lo: Vec3,
    pub(super) hi: Vec3,
}

impl Aabb {
    const EMPTY: Self = Self {
        lo: Vec3::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
        hi: Vec3::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    };

    pub(super) fn of(points: &[Vec3]) -> Self {
        points.iter().fold(Self::EMPTY, |b, p| Self { lo: b.lo.inf(p), hi: b.hi.sup(p) })
    }

    fn joined(&self, other: &Self) -> Self {
        Self { lo: self.lo.inf(&other.lo), hi: self.hi.sup(&other.hi) }
    }

    /// Whether the two have a point in common, their faces included.
    pub(super) fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.lo[k] <= other.hi[k] && other.lo[k] <= self.hi[k])
    }

    /// Squared distance of `p`. Zero inside.
    pub(super) fn squared_distance(&self, p: &Vec3) -> f64 {
        (0..3).map(|k| (self.lo[k] - p[k]).max(p[k] - self.hi[k]).max(0.0).powi(2)).sum()
    }

    /// Distance of `p` from the corner farthest from it.
    pub(super) fn farthest(&self, p: &Vec3) -> f64 {
        (0..3).map(|k| (p[k] - self.lo[k]).max(self.hi[k] - p[k]).powi(2)).sum::<f64>().sqrt()
    }
}

/// Contents of a node of the tree.
#[derive(Clone, Copy, Debug)]
pub(super) enum BvhContents {
    /// `Bvh::order[start..end]`.
    Triangles { start: u32, end: u32 },
    /// Node indices, both larger than the node's own.
    Nodes { left: u32, right: u32 },
}

/// A box and its contents.
#[derive(Clone, Copy, Debug)]
pub(super) struct BvhNode {
    pub(super) bounds: Aabb,
    pub(super) held: BvhContents,
}

/// The tree. Node 0 is the root. A mesh without triangles has no nodes.
#[derive(Clone, Debug, Default)]
pub(super) struct Bvh {
    pub(super) nodes: Vec<BvhNode>,
    pub(super) order: Vec<u32>,
    boxes: Vec<Aabb>,
}

impl Bvh {
    /// Splits at the median of the widest side: balanced, and the same for the same mesh.
    pub(super) fn new(mesh: &TriMesh) -> Self {
        let boxes: Vec<Aabb> = (0..mesh.triangles.len()).map(|t| Aabb::of(&mesh.corners(t))).collect();
        let mut tree = Self { nodes: Vec::new(), order: (0..boxes.len() as u32).collect(), boxes };
        if !tree.order.is_empty() {
            let mut order = std::mem::take(&mut tree.order);
            tree.build(&mut order, 0);
            tree.order = order;
        }
        tree
    }

    /// Builds the node over `part`, which begins at `start` in the order, and returns its index.
    fn build(&mut self, part: &mut [u32], start: usize) -> u32 {
        let bounds = part.iter().fold(Aabb::EMPTY, |b, &t| b.joined(&self.boxes[t as usize]));
        let at = self.nodes.len();
        let held = BvhContents::Triangles { start: start as u32, end: (start + part.len()) as u32 };
        self.nodes.push(BvhNode { bounds, held });
        if part.len() > LEAF {
            let axis = (bounds.hi - bounds.lo).imax();
            let middle = part.len() / 2;
            let boxes = &self.boxes;
            let key = |t: u32| boxes[t as usize].lo[axis] + boxes[t as usize].hi[axis];
            part.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
            let (low, high) = part.split_at_mut(middle);
            let left = self.build(low, start);
            let right = self.build(high, start + middle);
            self.nodes[at].held = BvhContents::Nodes { left, right };
        }
        at as u32
    }

    /// The box of triangle `t`.
    pub(super) fn bounds(&self, t: u32) -> &Aabb {
        &self.boxes[t as usize]
    }

    /// Calls `visit` with every triangle whose box meets `bounds`.
    pub(super) fn visit_box(&self, bounds: &Aabb, mut visit: impl FnMut(u32)) {
        let mut open = if self.nodes.is_empty() { vec![] } else { vec![0u32] };
        while let Some(at) = open.pop() {
            let node = &self.nodes[at as usize];
            if !node.bounds.meets(bounds) {
                continue;
            }
            match node.held {
                BvhContents::Nodes { left, right } => open.extend([right, left]),
                BvhContents::Triangles { start, end } => {
                    let near = self.order[start as usize..end as usize].iter();
                    near.filter(|&&t| self.bounds(t).meets(bounds)).for_each(|&t| visit(t));
                }
            }
        }
    }

    /// Distance of `p` from the nearest triangle of `mesh`, the mesh the tree was made of. Infinite without triangles.
    pub(super) fn distance(&self, mesh: &TriMesh, p: &Vec3) -> f64 {
        let mut best = f64::INFINITY;
        let mut open = if self.nodes.is_empty() { vec![] } else { vec![(0.0, 0u32)] };
        while let Some((at_least, at)) = open.pop() {
            if at_least >= best {
                continue;
            }
            match self.nodes[at as usize].held {
                BvhContents::Triangles { start, end } => {
                    for &t in &self.order[start as usize..end as usize] {
                        best = best.min(squared_distance(p, &mesh.corners(t as usize)));
                    }
                }
                BvhContents::Nodes { left, right } => {
                    let mut pair = [left, right].map(|n| (self.nodes[n as usize].bounds.squared_distance(p), n));
                    // The nearer one is popped, and so searched, first.
                    pair.sort_by(|x, y| y.0.total_cmp(&x.0));
                    open.extend(pair);
                }
            }
        }
        best.sqrt()
    }
}

/// Squared distance of a point from a triangle.
fn squared_distance(p: &Vec3, corners: &[Vec3; 3]) -> f64 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a));
    let above = |from: &Vec3, to: &Vec3| normal.cross(&(to - from)).dot(&(p - from)) >= 0.0;
    if normal.norm_squared() > 0.0 && above(a, b) && above(b, c) && above(c, a) {
        return normal.dot(&(p - a)).powi(2) / normal.norm_squared();
    }
    let to_side = |from: &Vec3, to: &Vec3| {
        let along = to - from;
        let share = (p - from).dot(&along) / along.norm_squared().max(f64::MIN_POSITIVE);
        (p - from - along * share.clamp(0.0, 1.0)).norm_squared()
    };
    to_side(a, b).min(to_side(b, c)).min(to_side(c, a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distance_to_face_side_and_corner() {
        let corners = [Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        let at = |x: f64, y: f64, z: f64| squared_distance(&Vec3::new(x, y, z), &corners).sqrt();
        approx::assert_relative_eq!(at(0.2, 0.2, 0.5), 0.5);
        approx::assert_relative_eq!(at(0.5, -2.0, 0.0), 2.0);
        approx::assert_relative_eq!(at(1.0, 1.0, 0.0), 0.5f64.sqrt());
        approx::assert_relative_eq!(at(4.0, 0.0, 4.0), 5.0);
    }
}
