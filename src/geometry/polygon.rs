//! Polygons in space as triangles.

use std::collections::HashSet;

use super::{Vec2, Vec3, sorted_pair};

/// A polygon of a surface, its corners among the `vertices`, as triangles that turn as it does: round its first corner
/// where it bulges outward in every corner, otherwise one ear after the other (Meisters 1975), seen along its mean
/// normal. A rest that is too crumpled to have an ear is filled round a corner. A polygon of n corners gives n − 2
/// triangles.
pub(crate) fn triangles_of(vertices: &[Vec3], corners: &[u32]) -> Vec<[u32; 3]> {
    let at = if corners.len() > 3 { flattened(vertices, corners) } else { None };
    let Some(at) = at.filter(|at| has_bay(at)) else {
        return (2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]).collect();
    };
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut out = Vec::with_capacity(corners.len() - 2);
    while left.len() > 2 {
        let n = left.len();
        // The corner after the first, as round the first.
        let k = (1..n).chain([0]).find(|&k| is_ear(&at, &left, k)).unwrap_or(1);
        out.push([(k + n - 1) % n, k, (k + 1) % n].map(|i| corners[left[i]]));
        left.remove(k);
    }
    out
}

/// The sides of the `triangles` of a polygon that are none of its own.
pub(crate) fn diagonals_of(corners: &[u32], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let next = corners.iter().cycle().skip(1);
    let own: HashSet<[u32; 2]> = corners.iter().zip(next).map(|(a, b)| sorted_pair([*a, *b])).collect();
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    let mut all: Vec<[u32; 2]> = sides.map(sorted_pair).filter(|side| !own.contains(side)).collect();
    all.sort_unstable();
    all.dedup();
    all
}

/// A corner whose turn has a smaller sine than this lies on a straight side: its triangle would have no area.
const STRAIGHT: f64 = 1e-6;

/// Whether one of the corners turns inward, or not at all.
fn has_bay(at: &[Vec2]) -> bool {
    let n = at.len();
    (0..n).any(|k| !turns_outward(at[(k + n - 1) % n], at[k], at[(k + 1) % n]))
}

/// Whether a polygon that goes through these three turns to the left at the second.
fn turns_outward(p: Vec2, q: Vec2, r: Vec2) -> bool {
    turns(p, q, r) > STRAIGHT * (q - p).norm() * (r - q).norm()
}

/// Twice the area of a triangle, negative of one that turns to the right.
fn turns(p: Vec2, q: Vec2, r: Vec2) -> f64 {
    (q - p).perp(&(r - q))
}

/// The corners as seen along the polygon's mean normal (Newell's), which then turns them to the left; `None` of one
/// without an area.
fn flattened(vertices: &[Vec3], corners: &[u32]) -> Option<Vec<Vec2>> {
    let origin = vertices[*corners.first()? as usize];
    let at = |k: usize| vertices[corners[k % corners.len()] as usize] - origin;
    let normal = (0..corners.len()).map(|k| at(k).cross(&at(k + 1))).sum::<Vec3>().try_normalize(0.0)?;
    // Square to it and to the axis that it is furthest from.
    let mut axis = Vec3::zeros();
    axis[normal.iamin()] = 1.0;
    let u = normal.cross(&axis).normalize();
    let v = normal.cross(&u);
    Some((0..corners.len()).map(|k| Vec2::new(at(k).dot(&u), at(k).dot(&v))).collect())
}

/// Whether the `k`-th of the corners that are left turns outward, and no other of them is in its triangle.
fn is_ear(at: &[Vec2], left: &[usize], k: usize) -> bool {
    let n = left.len();
    let ends @ [before, own, after] = [(k + n - 1) % n, k, (k + 1) % n];
    let [a, b, c] = [before, own, after].map(|i| at[left[i]]);
    let is_in = |p: Vec2| turns(a, b, p) >= 0.0 && turns(b, c, p) >= 0.0 && turns(c, a, p) >= 0.0;
    // A corner at the very place of one of the ear's own is no obstacle.
    let others = (0..n).filter(|i| !ends.contains(i)).map(|i| at[left[i]]);
    turns_outward(a, b, c) && !others.filter(|p| ![a, b, c].contains(p)).any(is_in)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// In a plane that lies askew.
    fn askew(corners: &[[f64; 2]]) -> Vec<Vec3> {
        let (u, v) = (Vec3::new(2.0, 1.0, -2.0) / 3.0, Vec3::new(1.0, 2.0, 2.0) / 3.0);
        corners.iter().map(|[x, y]| Vec3::new(5.0, -3.0, 1.0) + u * *x + v * *y).collect()
    }

    /// Of all triangles, and by how much they turn against the first.
    fn area(vertices: &[Vec3], triangles: &[[u32; 3]]) -> (f64, f64) {
        let double = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| vertices[v as usize]);
            (b - a).cross(&(c - a))
        };
        let sum: Vec3 = triangles.iter().map(double).sum();
        (0.5 * triangles.iter().map(|t| double(t).norm()).sum::<f64>(), 0.5 * sum.norm())
    }

    #[test]
    fn what_bulges_everywhere_is_a_fan() {
        let square = askew(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(triangles_of(&square, &[0, 1, 2, 3]), [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(diagonals_of(&[0, 1, 2, 3], &[[0, 1, 2], [0, 2, 3]]), [[0, 2]]);
        assert_eq!(triangles_of(&square, &[0, 1, 2]), [[0, 1, 2]]);
    }

    #[test]
    fn a_polygon_with_a_bay_keeps_its_area_whichever_corner_comes_first() {
        // A C of area 10 - 3.
        let c = [[0.0, 0.0], [5.0, 0.0], [5.0, 0.5], [2.0, 0.5], [2.0, 1.5], [5.0, 1.5], [5.0, 2.0], [0.0, 2.0]];
        for turned in [false, true] {
            let mut corners = c;
            if turned {
                corners.reverse();
            }
            let vertices = askew(&corners);
            for first in 0..8 {
                let polygon: Vec<u32> = (0..8).map(|k| (k + first) % 8).collect();
                let triangles = triangles_of(&vertices, &polygon);
                let (all, turned_alike) = area(&vertices, &triangles);
                assert_eq!((triangles.len(), diagonals_of(&polygon, &triangles).len()), (6, 5));
                assert_relative_eq!(all, 7.0, max_relative = 1e-12);
                assert_relative_eq!(turned_alike, 7.0, max_relative = 1e-12);
            }
        }
    }

    #[test]
    fn a_corner_on_a_straight_side_makes_no_triangle_without_area() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 2.0], [0.0, 2.0]];
        let vertices = askew(&corners);
        for first in 0..6 {
            let polygon: Vec<u32> = (0..6).map(|k| (k + first) % 6).collect();
            let triangles = triangles_of(&vertices, &polygon);
            for t in &triangles {
                assert!(area(&vertices, &[*t]).0 > 0.1, "{triangles:?}");
            }
            assert_relative_eq!(area(&vertices, &triangles).0, 4.0, max_relative = 1e-12);
        }
    }

    #[test]
    fn what_has_no_area_is_cut_up_all_the_same() {
        let line = askew(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [3.0, 0.0]]);
        assert_eq!(triangles_of(&line, &[0, 1, 2, 3]).len(), 2);
        assert!(triangles_of(&line, &[0, 1]).is_empty());
    }
}
