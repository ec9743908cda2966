//! Pairs of triangles that cross.

use rayon::prelude::*;

use super::bvh::{Bounds, Tree};
use super::orient::orient;
use crate::geometry::{TriMesh, Vec3};

/// Where a cloth crosses a body.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Between {
    /// Every crossing pair: cloth triangle, body triangle; sorted.
    pub pairs: Vec<[u32; 2]>,
    /// Every cloth triangle that crosses the body, once; sorted.
    pub cloth_triangles: Vec<u32>,
}

/// Pairs of triangles of one mesh that cross, the smaller index first, sorted.
///
/// Two triangles cross when a side of one passes strictly through the inside of the other. Touching, lying in one
/// plane and meeting side on side is no crossing. Two that share a vertex cross where the side of one that lies
/// opposite passes through the other; two that share a side never do. The test is exact.
pub fn crossings(mesh: &TriMesh) -> Vec<[u32; 2]> {
    let tree = Tree::new(mesh);
    let found = (0..mesh.triangles.len() as u32).into_par_iter().flat_map_iter(|t| {
        let hit = crossed(&mesh.corners(t as usize), mesh, &tree, |other| other > t);
        hit.into_iter().map(move |other| [t, other])
    });
    found.collect()
}

/// Triangles of `cloth` that cross triangles of `body`, with the meaning of [`crossings`].
pub fn crossings_between(cloth: &TriMesh, body: &TriMesh) -> Between {
    let tree = Tree::new(body);
    let found = (0..cloth.triangles.len() as u32).into_par_iter().flat_map_iter(|t| {
        let hit = crossed(&cloth.corners(t as usize), body, &tree, |_| true);
        hit.into_iter().map(move |other| [t, other])
    });
    let pairs: Vec<[u32; 2]> = found.collect();
    let mut cloth_triangles: Vec<u32> = pairs.iter().map(|p| p[0]).collect();
    cloth_triangles.dedup();
    Between { pairs, cloth_triangles }
}

/// Triangles of `mesh` that pass `wanted` and cross the triangle with these corners; sorted.
fn crossed(corners: &[Vec3; 3], mesh: &TriMesh, tree: &Tree, wanted: impl Fn(u32) -> bool) -> Vec<u32> {
    let mut found = Vec::new();
    tree.visit_box(&Bounds::of(corners), |t| {
        if wanted(t) && cross(corners, &mesh.corners(t as usize)) {
            found.push(t);
        }
    });
    found.sort_unstable();
    found
}

/// Whether a side of one triangle passes strictly through the inside of the other.
fn cross(a: &[Vec3; 3], b: &[Vec3; 3]) -> bool {
    let sides_of_b = b.map(|p| orient(&a[0], &a[1], &a[2], &p));
    // Everything lies in the plane of an `a` without area, whose sides may pass through `b` all the same.
    if !both_sides(sides_of_b) && sides_of_b != [0; 3] {
        return false;
    }
    let sides_of_a = a.map(|p| orient(&b[0], &b[1], &b[2], &p));
    pierces(b, sides_of_b, a) || pierces(a, sides_of_a, b)
}

fn both_sides(sides: [i8; 3]) -> bool {
    sides.contains(&1) && sides.contains(&-1)
}

/// Whether a side of `needle` passes through the inside of `cloth`; `sides` says where needle's corners lie.
fn pierces(needle: &[Vec3; 3], sides: [i8; 3], cloth: &[Vec3; 3]) -> bool {
    (0..3).any(|k| {
        let next = (k + 1) % 3;
        sides[k] * sides[next] < 0 && passes_inside(&needle[k], &needle[next], cloth)
    })
}

/// Whether the line through `p` and `q` passes all three sides of the triangle on the same hand.
fn passes_inside(p: &Vec3, q: &Vec3, [a, b, c]: &[Vec3; 3]) -> bool {
    let hand = orient(p, q, a, b);
    hand != 0 && orient(p, q, b, c) == hand && orient(p, q, c, a) == hand
}
