//! How often a surface passes through itself.

use crate::geometry::{Vec3, pierces};

/// Number of pairs of an edge and a triangle without a common node of which the edge passes through the triangle.
pub(super) fn crossings(x: &[Vec3], triangles: &[[u32; 3]]) -> usize {
    let at = |t: [u32; 3]| t.map(|n| x[n as usize]);
    let span = |t: [u32; 3]| {
        let [a, b, c] = at(t);
        [a.inf(&b).inf(&c), a.sup(&b).sup(&c)]
    };
    // Swept upward: only triangles that overlap in height are compared.
    let mut order: Vec<([u32; 3], [Vec3; 2])> = triangles.iter().map(|t| (*t, span(*t))).collect();
    order.sort_by(|a, b| a.1[0].y.total_cmp(&b.1[0].y));
    let mut count = 0;
    for (i, (one, [low, high])) in order.iter().enumerate() {
        let meets = |[l, h]: &[Vec3; 2]| (0..3).all(|c| l[c] <= high[c] && h[c] >= low[c]);
        let later = order[i + 1..].iter().take_while(|(_, span)| span[0].y <= high.y);
        for (other, _) in later.filter(|(_, span)| meets(span)) {
            count += through(x, *one, *other) + through(x, *other, *one);
        }
    }
    count
}

/// How many sides of `one` pass through `other`; 0 if they have a corner in common. Every side counts in the triangle
/// that it runs upward in by number, so that one between two triangles counts once.
fn through(x: &[Vec3], one: [u32; 3], other: [u32; 3]) -> usize {
    if one.iter().any(|n| other.contains(n)) {
        return 0;
    }
    let [a, b, c] = one;
    let sides = [[a, b], [b, c], [c, a]];
    let passes = |[a, b]: [u32; 2]| pierces(x[a as usize], x[b as usize], other.map(|n| x[n as usize]));
    sides.into_iter().filter(|[a, b]| a < b).filter(|side| passes(*side)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_through_another_crosses_it() {
        let x = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.2, -1.0, 0.2], [0.2, 1.0, 0.2], [0.2, 1.0, 0.9]];
        let x: Vec<Vec3> = x.into_iter().map(Vec3::from).collect();
        assert_eq!(crossings(&x, &[[0, 1, 2], [3, 4, 5]]), 1);
        let apart: Vec<Vec3> = x.iter().enumerate().map(|(n, p)| p + Vec3::x() * f64::from(n as u32 / 3)).collect();
        assert_eq!(crossings(&apart, &[[0, 1, 2], [3, 4, 5]]), 0);
        assert_eq!(crossings(&x, &[[0, 1, 2], [2, 3, 4]]), 0, "a corner in common");
    }
}
