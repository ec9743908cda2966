//! Does a flat piece lie on itself? A check that knows nothing of how the piece was made.

use std::collections::HashMap;

use crate::geometry::Vec2;

/// Number of pairs of rim edges that cross, within a rim and between rims. Edges that share a vertex or only touch do
/// not count. A flat piece without flipped triangles overlaps itself exactly where its rims cross.
pub fn rim_crossings(flat: &[Vec2], rims: &[Vec<u32>]) -> usize {
    let edges: Vec<[u32; 2]> =
        rims.iter().flat_map(|rim| (0..rim.len()).map(|k| [rim[k], rim[(k + 1) % rim.len()]])).collect();
    let ends = |e: [u32; 2]| e.map(|v| flat[v as usize]);
    let longest = edges.iter().map(|&e| ends(e)).map(|[a, b]| (b - a).norm()).fold(0.0, f64::max);
    // With cells of the longest edge's size an edge meets at most four of them.
    let size = if longest > 0.0 && longest.is_finite() { longest } else { 1.0 };
    let cell = |x: f64| (x / size).floor() as i64;
    let mut cells: HashMap<[i64; 2], Vec<u32>> = HashMap::new();
    let mut near = Vec::new();
    for (k, &e) in edges.iter().enumerate() {
        let [a, b] = ends(e);
        for x in cell(a.x.min(b.x))..=cell(a.x.max(b.x)) {
            for y in cell(a.y.min(b.y))..=cell(a.y.max(b.y)) {
                let there = cells.entry([x, y]).or_default();
                near.extend(there.iter().map(|&other| (other, k as u32)));
                there.push(k as u32);
            }
        }
    }
    near.sort_unstable();
    near.dedup();
    near.into_iter().filter(|&(i, j)| cross(flat, edges[i as usize], edges[j as usize])).count()
}

/// Whether two edges without a common vertex cross in a point inside both.
fn cross(flat: &[Vec2], e: [u32; 2], f: [u32; 2]) -> bool {
    if f.contains(&e[0]) || f.contains(&e[1]) {
        return false;
    }
    let [a, b, c, d] = [e[0], e[1], f[0], f[1]].map(|v| flat[v as usize]);
    let side = |p: Vec2, q: Vec2, r: Vec2| (q - p).perp(&(r - p));
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bow_crosses_itself_once_and_a_square_never() {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(|(x, y)| Vec2::new(x, y));
        assert_eq!(rim_crossings(&corners, &[vec![0, 1, 2, 3]]), 0);
        assert_eq!(rim_crossings(&corners, &[vec![0, 2, 1, 3]]), 1);
        assert_eq!(rim_crossings(&corners, &[]), 0);
    }
}
