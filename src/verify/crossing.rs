//! Pairs of triangles that cross.
//!
//! Two triangles that do not lie in one plane have at most a piece of one line in common. If it runs through the inside
//! of both, they cross. If it runs along a side of one or both, as it does wherever meshes with round coordinates meet,
//! the sheets round that line decide: one surface goes through the other where each has sheets on both sides of the
//! other's. All of it is signs of [`orient`], which are exact. Rings of triangles round a side are looked up only where
//! a side lies on the line.

use std::collections::HashMap;
use std::sync::OnceLock;

use rayon::prelude::*;

use super::bvh::{Aabb, Bvh};
use super::orient::orient;
use crate::geometry::{TriMesh, Vec3, sorted_pair};

/// Crossings of a cloth with a body.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Between {
    /// Every crossing pair: cloth triangle, body triangle. Sorted.
    pub pairs: Vec<[u32; 2]>,
    /// Every cloth triangle that crosses the body, once. Sorted.
    pub cloth_triangles: Vec<u32>,
}

/// Pairs of triangles of one mesh that cross, the smaller index first, sorted.
///
/// Two triangles cross when they have a piece of a line in common, longer than a point, along which the surface of one
/// passes to the other side of the other's: through its inside, or exactly along a side of its mesh, where the other
/// triangles round that side count too. Touching, lying in one plane and meeting side on side is no crossing. A surface
/// that lies in the other before it leaves it on the far side only touches it. Two that share a vertex cross where they
/// do so away from it. Two that share a side never do. A side belongs to the triangles that name the same two vertices.
/// A triangle without area crosses what its sides pass through strictly. The test is exact.
pub fn crossings(mesh: &TriMesh) -> Vec<[u32; 2]> {
    let (tree, surface) = (Bvh::new(mesh), Surface::new(mesh));
    let shares_side = |t: u32, other: u32| {
        let [one, two] = [t, other].map(|t| mesh.triangles[t as usize]);
        one.iter().filter(|v| two.contains(v)).count() > 1
    };
    let found = (0..mesh.triangles.len() as u32).into_par_iter().flat_map_iter(|t| {
        let hit = crossed(&surface, t, &surface, &tree, |other| other > t && !shares_side(t, other));
        hit.into_iter().map(move |other| [t, other])
    });
    found.collect()
}

/// Triangles of `cloth` that cross triangles of `body`, with the meaning of [`crossings`].
pub fn crossings_between(cloth: &TriMesh, body: &TriMesh) -> Between {
    let tree = Bvh::new(body);
    let [cloth, body] = [cloth, body].map(Surface::new);
    let found = (0..cloth.mesh.triangles.len() as u32).into_par_iter().flat_map_iter(|t| {
        let hit = crossed(&cloth, t, &body, &tree, |_| true);
        hit.into_iter().map(move |other| [t, other])
    });
    let pairs: Vec<[u32; 2]> = found.collect();
    let mut cloth_triangles: Vec<u32> = pairs.iter().map(|p| p[0]).collect();
    cloth_triangles.dedup();
    Between { pairs, cloth_triangles }
}

/// Triangles of `of` that pass `wanted` and cross triangle `t` of `from`. Sorted.
fn crossed(from: &Surface, t: u32, of: &Surface, tree: &Bvh, wanted: impl Fn(u32) -> bool) -> Vec<u32> {
    let mut found = Vec::new();
    tree.visit_box(&Aabb::of(&from.mesh.corners(t as usize)), |other| {
        if wanted(other) && cross([from, of], [t, other]) {
            found.push(other);
        }
    });
    found.sort_unstable();
    found
}

/// A mesh, and who lies round its sides.
struct Surface<'a> {
    mesh: &'a TriMesh,
    /// By the two ends of a side, the third vertices of all triangles that have it. Made when first asked for.
    rings: OnceLock<HashMap<[u32; 2], Vec<u32>>>,
}

impl<'a> Surface<'a> {
    fn new(mesh: &'a TriMesh) -> Self {
        Self { mesh, rings: OnceLock::new() }
    }

    /// The sheets of triangle `t` that meet on a line, as a point of each: both parts of it if the line runs through
    /// its inside, else all triangles round its side there. `sides` says on which side of the line its corners lie.
    fn sheets(&self, t: u32, sides: [i8; 3]) -> Vec<Vec3> {
        let corners = self.mesh.triangles[t as usize];
        let at = |v: &u32| self.mesh.vertices[*v as usize];
        let Some(ends) = side_on(sides) else {
            return (0..3).filter(|k| sides[*k] != 0).map(|k| at(&corners[k])).collect();
        };
        let rings = self.rings.get_or_init(|| rings(&self.mesh.triangles));
        rings[&sorted_pair(ends.map(|k| corners[k]))].iter().map(at).collect()
    }
}

fn rings(triangles: &[[u32; 3]]) -> HashMap<[u32; 2], Vec<u32>> {
    let mut rings: HashMap<[u32; 2], Vec<u32>> = HashMap::new();
    for &[a, b, c] in triangles {
        for (side, third) in [([a, b], c), ([b, c], a), ([c, a], b)] {
            rings.entry(sorted_pair(side)).or_default().push(third);
        }
    }
    rings
}

/// Whether the surface of one triangle passes through that of the other along a line that they have in common.
fn cross(surfaces: [&Surface; 2], triangles: [u32; 2]) -> bool {
    let [a, b] = [0, 1].map(|k| surfaces[k].mesh.corners(triangles[k] as usize));
    let sides_of_b = b.map(|p| orient(&a[0], &a[1], &a[2], &p));
    let apex_of_b = apex(sides_of_b);
    // Everything lies in the plane of an `a` without area, whose sides may pass through `b` all the same.
    if apex_of_b.is_none() && sides_of_b != [0; 3] {
        return false;
    }
    let sides_of_a = a.map(|p| orient(&b[0], &b[1], &b[2], &p));
    if sides_of_a == [0; 3] || sides_of_b == [0; 3] {
        return pierces(&b, sides_of_b, &a) || pierces(&a, sides_of_a, &b);
    }
    let (Some(apex_of_a), Some(apex_of_b)) = (apex(sides_of_a), apex_of_b) else { return false };
    if !overlap(&from_apex(&a, apex_of_a), &from_apex(&b, apex_of_b)) {
        return false;
    }
    let on_line = side_on(sides_of_a).map(|ends| ends.map(|k| a[k]));
    let Some(line) = on_line.or_else(|| side_on(sides_of_b).map(|ends| ends.map(|k| b[k]))) else { return true };
    pass(line, &surfaces[0].sheets(triangles[0], sides_of_a), &surfaces[1].sheets(triangles[1], sides_of_b))
}

fn both_sides<const N: usize>(sides: [i8; N]) -> bool {
    sides.contains(&1) && sides.contains(&-1)
}

/// The corner that lies on one side of a plane while no other does, if more of the triangle than a corner is in it.
fn apex(sides: [i8; 3]) -> Option<usize> {
    (0..3).find(|&k| sides[k] != 0 && sides.iter().filter(|s| **s == sides[k]).count() == 1)
}

/// The ends of the side that lies in the plane.
fn side_on(sides: [i8; 3]) -> Option<[usize; 2]> {
    (0..3).map(|k| [k, (k + 1) % 3]).find(|ends| ends.iter().all(|k| sides[*k] == 0))
}

/// The triangle beginning at its corner `k`.
fn from_apex(corners: &[Vec3; 3], k: usize) -> [Vec3; 3] {
    [0, 1, 2].map(|i| corners[(k + i) % 3])
}

/// Whether two triangles cut a common piece, longer than a point, out of the line in which their planes meet. They cut
/// that line with the two sides at their first corners. For a side of one and a side of the other `orient` says which
/// cuts the line further on (or which less far on, but the same of all four pairs). It is zero where both cut it in one
/// point. Pieces that come one after the other have no two pairs of different order.
fn overlap([p, q, r]: &[Vec3; 3], [a, b, c]: &[Vec3; 3]) -> bool {
    both_sides([orient(p, q, a, b), orient(p, q, a, c), orient(p, r, a, b), orient(p, r, a, c)])
}

/// Whether of the sheets round a line, each given by a point of it, two of `one` lie on different sides of two of the
/// `other`, none of them in another. Going once round the line one meets them in turn.
fn pass([p, q]: [Vec3; 2], one: &[Vec3], other: &[Vec3]) -> bool {
    let turn = |a: &Vec3, b: &Vec3| orient(&p, &q, a, b);
    // Of the three turns from one sheet to the next at most one is half a round or more, or at most one is less. Where
    // two of the sheets are one, the other two turns cancel.
    let order = |a: &Vec3, b: &Vec3, c: &Vec3| (turn(a, b) + turn(b, c) + turn(c, a)).signum();
    let parts = |a: &Vec3, b: &Vec3| {
        let on = |side: i8| one.iter().any(|x| order(a, x, b) == side);
        on(1) && on(-1)
    };
    other.iter().enumerate().any(|(k, a)| other[k + 1..].iter().any(|b| parts(a, b)))
}

/// Whether a side of `needle` passes through the inside of `cloth`. `sides` says where needle's corners lie.
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
