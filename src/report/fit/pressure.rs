//! Pressure on the skin, from the forces of contact.

use rayon::prelude::*;

use crate::geometry::{Topology, TriMesh, Vec3};
use crate::verify::Welded;

/// Radius of the disc of cloth over which pressure is averaged, metres: that of the sensors with which pressure under
/// clothing is measured. The pressure at one particle would depend on the mesh.
const SENSOR: f64 = 0.015;

/// Pressure at every vertex of a garment, Pa: force on the body over area of cloth, within 15 mm.
/// `weld` has the label of every particle, `forces` the normal force of the body on the particles of every label, N.
///
/// # Panics
/// When `forces` is shorter than the labels: a mistake of the caller.
pub fn pressure(welded: &Welded, weld: &[u32], forces: &[Vec3]) -> Vec<f64> {
    let surface = &welded.surface;
    let (normals, mut force) = (surface.vertex_normals(), vec![0.0; surface.vertices.len()]);
    for (&vertex, &label) in welded.vertex_of.iter().zip(weld) {
        // Pressure acts across the cloth. On the edges of a faceted body some of the force runs along it.
        force[vertex as usize] = forces[label as usize].dot(&normals[vertex as usize]).abs();
    }
    let area = areas(surface);
    let near = neighbours(surface);
    let mean = |vertex: usize| {
        let disc = within(&near, &surface.vertices, vertex, SENSOR);
        let (force, area) = disc.iter().fold((0.0, 0.0), |(f, a), &v| (f + force[v], a + area[v]));
        if area > 0.0 { force / area } else { 0.0 }
    };
    (0..force.len()).into_par_iter().map(mean).collect()
}

/// Area of cloth nearest to every vertex, m². (Thirds of triangles would depend on how the diagonals of the grid run: a
/// vertex where none meets would have half the area of its neighbours, and twice their pressure.)
fn areas(surface: &TriMesh) -> Vec<f64> {
    let mut area = vec![0.0; surface.vertices.len()];
    for (t, triangle) in surface.triangles.iter().enumerate() {
        let whole = 0.5 * surface.double_normal(t).norm();
        triangle.iter().zip(shares(&surface.corners(t))).for_each(|(&v, share)| area[v as usize] += share * whole);
    }
    area
}

/// Shares of a triangle that are nearest to its corners. Of an obtuse one the wide corner has half.
fn shares(corners: &[Vec3; 3]) -> [f64; 3] {
    let side = |k: usize| (corners[(k + 1) % 3] - corners[(k + 2) % 3]).norm_squared();
    let squares = [0, 1, 2].map(side);
    let sum: f64 = squares.iter().sum();
    // Two short sides and a long one: twice the cosine of the widest angle, times its sides, is below zero.
    if let Some(wide) = (0..3).find(|&k| 2.0 * squares[k] >= sum) {
        return [0, 1, 2].map(|k| if k == wide { 0.5 } else { 0.25 });
    }
    // Barycentric coordinates of the circumcentre, of which each corner has half of both others'.
    let weight = [0, 1, 2].map(|k| squares[k] * (sum - 2.0 * squares[k]));
    let whole: f64 = weight.iter().sum();
    [0, 1, 2].map(|k| 0.5 * (whole - weight[k]) / whole)
}

/// Neighbours of every vertex.
fn neighbours(surface: &TriMesh) -> Vec<Vec<usize>> {
    let mut near = vec![Vec::new(); surface.vertices.len()];
    for edge in &Topology::new(&surface.triangles).edges {
        let [a, b] = edge.ends.map(|v| v as usize);
        near[a].push(b);
        near[b].push(a);
    }
    near
}

/// The vertices within `reach` of one, metres, that edges join to it within that distance. (Distances along edges would
/// leave out corners of cells without a diagonal.)
fn within(near: &[Vec<usize>], at: &[Vec3], from: usize, reach: f64) -> Vec<usize> {
    let mut found = vec![from];
    let mut next = 0;
    while next < found.len() {
        for &other in &near[found[next]] {
            if (at[other] - at[from]).norm() <= reach && !found.contains(&other) {
                found.push(other);
            }
        }
        next += 1;
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat grid of `n` by `n` cells of `cell` metres, each vertex pressed by `pressure` Pa on its own area.
    fn pressed(n: u32, cell: f64, pressed_by: f64) -> Vec<f64> {
        let mut surface = TriMesh::default();
        let at = |row: u32, column: u32| row * (n + 1) + column;
        for row in 0..=n {
            surface.vertices.extend((0..=n).map(|c| Vec3::new(f64::from(c) * cell, f64::from(row) * cell, 0.0)));
        }
        for (row, c) in (0..n).flat_map(|row| (0..n).map(move |c| (row, c))) {
            let [a, b, d, e] = [at(row, c), at(row, c + 1), at(row + 1, c), at(row + 1, c + 1)];
            surface.triangles.extend([[a, b, e], [a, e, d]]);
        }
        let forces: Vec<Vec3> = areas(&surface).iter().map(|area| Vec3::z() * (area * pressed_by)).collect();
        let labels: Vec<u32> = (0..surface.vertices.len() as u32).collect();
        let welded = Welded { surface, corners: Vec::new(), vertex_of: labels.clone() };
        pressure(&welded, &labels, &forces)
    }

    #[test]
    fn every_vertex_has_the_area_nearest_to_it() {
        let corners = |x: f64, y: f64| [Vec3::zeros(), Vec3::new(1.0, 0.0, 0.0), Vec3::new(x, y, 0.0)];
        assert_eq!(shares(&corners(0.0, 1.0)), [0.5, 0.25, 0.25]);
        shares(&corners(0.5, 0.75f64.sqrt())).iter().for_each(|share| assert!((share - 1.0 / 3.0).abs() < 1e-12));
        // Sampled: the share of the triangle that is nearer to a corner than to the others.
        let [a, b, c] = corners(0.4, 0.8);
        let mut count = [0.0; 3];
        for (i, j) in (0..300).flat_map(|i| (0..300 - i).map(move |j| (f64::from(i) + 0.3, f64::from(j) + 0.3))) {
            let p = a + (b - a) * (i / 300.0) + (c - a) * (j / 300.0);
            let far = [a, b, c].map(|corner| (corner - p).norm());
            count[(0..3).min_by(|&k, &l| far[k].total_cmp(&far[l])).unwrap_or(0)] += 1.0 / 45_150.0;
        }
        let found = shares(&corners(0.4, 0.8));
        assert!(found.iter().zip(count).all(|(share, sampled)| (share - sampled).abs() < 5e-3), "{found:?} {count:?}");
    }

    #[test]
    fn an_even_pressure_is_the_same_on_any_mesh_and_at_its_rim() {
        for (n, cell) in [(10, 0.01), (40, 0.0025), (4, 0.03)] {
            assert!(pressed(n, cell, 2000.0).iter().all(|p| (p - 2000.0).abs() < 1e-6));
        }
    }
}
