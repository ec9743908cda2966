//! Whether a closed surface runs through itself.

use crate::geometry::{TriMesh, Vec3};

/// Width of cells in the broad phase, in mean edges: a few triangles lie in each.
const CELL_IN_EDGES: f64 = 2.0;

/// Most cells that a triangle meets on average, which sets the least width of cells. Usual triangles meet up to eight.
/// A splinter could meet any number.
const MOST_CELLS: f64 = 64.0;

/// Number of pairs of triangles of `mesh` that cross without sharing a vertex, and the place of the first pair. `None`
/// if there are none.
pub(super) fn crossings(mesh: &TriMesh) -> Option<(usize, Vec3)> {
    let boxes: Vec<[Vec3; 2]> = (0..mesh.triangles.len()).map(|t| bounds(mesh.corners(t))).collect();
    let mut found: Option<(usize, Vec3)> = None;
    each_close_pair(cell_width(mesh, &boxes), &boxes, |s, t| {
        let shared = mesh.triangles[s].iter().any(|v| mesh.triangles[t].contains(v));
        if shared || !overlap(&boxes[s], &boxes[t]) {
            return;
        }
        let (a, b) = (mesh.corners(s), mesh.corners(t));
        if let Some(place) = pierces(a, b).or_else(|| pierces(b, a)) {
            found.get_or_insert((0, place)).0 += 1;
        }
    });
    found
}

fn bounds(c: [Vec3; 3]) -> [Vec3; 2] {
    [c[0].inf(&c[1]).inf(&c[2]), c[0].sup(&c[1]).sup(&c[2])]
}

fn overlap(a: &[Vec3; 2], b: &[Vec3; 2]) -> bool {
    (0..3).all(|k| a[0][k] <= b[1][k] && b[0][k] <= a[1][k])
}

/// Width of the broad phase's cells.
fn cell_width(mesh: &TriMesh, boxes: &[[Vec3; 2]]) -> f64 {
    let count = boxes.len().max(1) as f64;
    // A mesh of n triangles has edges of about √(2.3 · area / n).
    let mut cell = CELL_IN_EDGES * (2.3 * mesh.area() / count).sqrt();
    let cells = |cell: f64| -> f64 { boxes.iter().map(|[low, high]| met(low, high, cell)).sum() };
    while cell > 0.0 && cells(cell) > MOST_CELLS * count {
        cell *= 2.0;
    }
    cell
}

/// Approximate number of cells that a box meets.
fn met(low: &Vec3, high: &Vec3, cell: f64) -> f64 {
    (high - low).map(|side| side / cell + 1.0).product()
}

/// Visits the pairs of boxes that meet a common cell, each once, in order.
fn each_close_pair(cell: f64, boxes: &[[Vec3; 2]], mut visit: impl FnMut(usize, usize)) {
    let index = |x: f64| (x / cell).floor() as i64;
    let mut entries: Vec<([i64; 3], usize)> = Vec::new();
    for (t, [low, high]) in boxes.iter().enumerate() {
        for i in index(low.x)..=index(high.x) {
            for j in index(low.y)..=index(high.y) {
                entries.extend((index(low.z)..=index(high.z)).map(|k| ([i, j, k], t)));
            }
        }
    }
    entries.sort_unstable();
    for group in entries.chunk_by(|a, b| a.0 == b.0) {
        for (k, (cell_of, s)) in group.iter().enumerate() {
            for (_, t) in &group[k + 1..] {
                // The pair belongs to the lowest cell that both boxes meet.
                let first: [i64; 3] = std::array::from_fn(|k| index(boxes[*s][0][k].max(boxes[*t][0][k])));
                if first == *cell_of {
                    visit(*s, *t);
                }
            }
        }
    }
}

/// Place where an edge of `a` passes through the inside of `b`. Touching does not count.
///
/// This is decided with rounding on purpose, not by the exact predicate that cloth has. Halves of a mirrored body that
/// run through each other meet edge on edge, where exactly no pair of triangles would cross.
fn pierces(a: [Vec3; 3], b: [Vec3; 3]) -> Option<Vec3> {
    let n = (b[1] - b[0]).cross(&(b[2] - b[0]));
    let side = a.map(|p| (p - b[0]).dot(&n));
    (0..3).find_map(|k| {
        let (p, q, s, t) = (a[k], a[(k + 1) % 3], side[k], side[(k + 1) % 3]);
        if s * t >= 0.0 {
            return None;
        }
        let x = p + (q - p) * (s / (s - t));
        let inside = (0..3).all(|m| (b[(m + 1) % 3] - b[m]).cross(&(x - b[m])).dot(&n) > 0.0);
        inside.then_some(x)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tetrahedra(offset: f64) -> TriMesh {
        let corners = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
        let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mut mesh = TriMesh::default();
        for (copy, shift) in [(0_u32, 0.0), (4, offset)] {
            mesh.vertices.extend(corners.map(|p| p + Vec3::new(shift, 0.05, 0.05)));
            mesh.triangles.extend(faces.map(|f| f.map(|v| v + copy)));
        }
        mesh
    }

    /// In cells as wide as its mean edge a splinter across all axes would meet 10¹³ of them.
    #[test]
    fn a_splinter_meets_a_bounded_number_of_cells() {
        let corners = [Vec3::zeros(), Vec3::repeat(1e3), Vec3::y() * 1e-6, Vec3::z() * 1e-6];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let splinter = TriMesh { vertices: corners.into(), triangles };
        assert_eq!(crossings(&splinter), None);
    }

    #[test]
    fn bodies_that_overlap_cross_and_others_do_not() {
        assert_eq!(crossings(&tetrahedra(2.0)), None);
        let (count, place) = crossings(&tetrahedra(0.3)).expect("they overlap");
        assert!(count > 0 && place.x > 0.0 && place.x < 1.0);
    }
}
