//! The course of a surface through one cube of a grid, from the signs at its corners.
//!
//! Corner `c` of a cube lies on its high side of axis `a` where bit `a` of `c` is set.

use crate::geometry::Vec3;

/// Edges of a cube.
const EDGES: usize = 12;

/// The node at corner `c` of the cell whose lowest corner is `cell`.
pub(super) fn corner(cell: [i32; 3], c: usize) -> [i32; 3] {
    std::array::from_fn(|axis| cell[axis] + (c >> axis & 1) as i32)
}

/// Number of the edge that leaves corner `c` (on the low side of `axis`) along `axis`.
pub(super) fn edge_index(c: usize, axis: usize) -> usize {
    4 * axis + (c >> ((axis + 1) % 3) & 1) + 2 * (c >> ((axis + 2) % 3) & 1)
}

/// The corners of a face in a ring.
fn face(axis: usize, side: usize) -> [usize; 4] {
    let (base, b, c) = (side << axis, 1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
    [base, base | b, base | b | c, base | c]
}

/// The edge between two neighbouring corners.
fn edge_between(c: usize, d: usize) -> usize {
    edge_index(c.min(d), (c ^ d).trailing_zeros() as usize)
}

/// Whether the surface passes through the face of a cube on `side` (0 low, 1 high) of `axis`.
pub(super) fn face_is_crossed(values: &[f64; 8], axis: usize, side: usize) -> bool {
    let inside = face(axis, side).map(|c| values[c] < 0.0);
    inside.iter().any(|&i| i != inside[0])
}

/// The patches of surface in a cube. A cube with one patch is the rule. Two sheets of skin in one cube are two patches,
/// each with its own vertex, which keeps the net manifold.
pub(super) struct CellPatches {
    /// The patch that meets each edge of the cube. `None` where the surface does not cross the edge.
    pub(super) patch_of: [Option<u8>; EDGES],
    /// Number of patches.
    pub(super) patches: u8,
}

impl CellPatches {
    /// From the values at the corners, negative inside.
    pub(super) fn new(values: &[f64; 8]) -> Self {
        let mut group: [usize; EDGES] = std::array::from_fn(|e| e);
        for axis in 0..3 {
            for side in 0..2 {
                join_across_face(values, face(axis, side), &mut group);
            }
        }
        let mut out = Self { patch_of: [None; EDGES], patches: 0 };
        for e in 0..EDGES {
            if !is_crossed(values, e) {
                continue;
            }
            let earlier = (0..e).find(|&d| group[d] == group[e] && out.patch_of[d].is_some());
            out.patch_of[e] = earlier.and_then(|d| out.patch_of[d]).or_else(|| {
                out.patches += 1;
                Some(out.patches - 1)
            });
        }
        out
    }

    /// The middle of each patch's crossings with the cube's edges, in units of the cube's side from its lowest corner.
    pub(super) fn middles(&self, values: &[f64; 8]) -> impl Iterator<Item = Vec3> {
        (0..self.patches).map(|patch| {
            let (mut sum, mut count) = (Vec3::zeros(), 0.0);
            for e in (0..EDGES).filter(|&e| self.patch_of[e] == Some(patch)) {
                let (c, axis) = edge_start(e);
                let (a, b) = (values[c], values[c | 1 << axis]);
                let mut p = Vec3::from_fn(|k, _| (c >> k & 1) as f64);
                p[axis] = a / (a - b);
                sum += p;
                count += 1.0;
            }
            sum / count
        })
    }
}

/// The low corner and the axis of an edge: the reverse of [`edge_index`].
fn edge_start(e: usize) -> (usize, usize) {
    let axis = e / 4;
    ((e & 1) << ((axis + 1) % 3) | (e >> 1 & 1) << ((axis + 2) % 3), axis)
}

fn is_crossed(values: &[f64; 8], e: usize) -> bool {
    let (c, axis) = edge_start(e);
    (values[c] < 0.0) != (values[c | 1 << axis] < 0.0)
}

/// Joins the edges that the surface's line across a face connects. A face with its inside corners on a diagonal has
/// two lines, each round one inside corner. Both cubes beside the face see the same signs and so agree.
fn join_across_face(values: &[f64; 8], ring: [usize; 4], group: &mut [usize; EDGES]) {
    let edges: [usize; 4] = std::array::from_fn(|k| edge_between(ring[k], ring[(k + 1) % 4]));
    let crossed: Vec<usize> = edges.into_iter().filter(|&e| is_crossed(values, e)).collect();
    match crossed[..] {
        [a, b] => join(group, a, b),
        [_, _, _, _] => {
            for k in (0..4).filter(|&k| values[ring[k]] < 0.0) {
                join(group, edges[k], edges[(k + 3) % 4]);
            }
        }
        _ => {}
    }
}

fn join(group: &mut [usize; EDGES], a: usize, b: usize) {
    let (from, to) = (group[a], group[b]);
    for g in group.iter_mut().filter(|g| **g == from) {
        *g = to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Corner values from the set of inside corners.
    fn signs(inside: &[usize]) -> [f64; 8] {
        std::array::from_fn(|c| if inside.contains(&c) { -1.0 } else { 1.0 })
    }

    #[test]
    fn edges_are_numbered_once() {
        for e in 0..EDGES {
            let (c, axis) = edge_start(e);
            assert_eq!(edge_index(c, axis), e);
            assert_eq!(edge_between(c | 1 << axis, c), e);
        }
    }

    #[test]
    fn opposite_corners_are_two_patches() {
        assert_eq!(CellPatches::new(&signs(&[])).patches, 0);
        assert_eq!(CellPatches::new(&signs(&[0, 1, 2, 3])).patches, 1);
        assert_eq!(CellPatches::new(&signs(&[0, 7])).patches, 2);
        assert_eq!(CellPatches::new(&signs(&[0, 3])).patches, 2);
        // Two outside corners on a diagonal of a face, the other six inside: one patch.
        assert_eq!(CellPatches::new(&signs(&[0, 3, 4, 5, 6, 7])).patches, 1);
    }

    #[test]
    fn a_flat_patch_lies_where_the_values_vanish() {
        let values = std::array::from_fn(|c| if c >> 2 & 1 == 1 { 0.75 } else { -0.25 });
        let middles: Vec<Vec3> = CellPatches::new(&values).middles(&values).collect();
        assert_eq!(middles, [Vec3::new(0.5, 0.5, 0.25)]);
    }
}
