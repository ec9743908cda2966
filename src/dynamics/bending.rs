//! Bending as one constant quadratic form (L9 for a cloth that is flat at rest).
//!
//! E = ½ Σᵥ Aᵥ |√B₁ x_uu + √B₂ x_vv|², with the second derivatives from the cotangent Laplacian of the flat piece
//! stretched by √B₁ along the warp u and √B₂ along the weft v. It is exact for a cylinder rolled in any direction
//! (½ B κ² per area when B₁ = B₂), whatever way the triangles' diagonals run, and its matrix is scalar and constant.
//! Nodes on a free rim have no term: nothing bends the cloth beyond its edge.

use nalgebra::Matrix2;

use crate::geometry::{Vec2, Vec3};

/// One triangle for [`Bending::new`].
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatTriangle {
    /// Its nodes.
    pub(super) nodes: [u32; 3],
    /// Flat corners, metres.
    pub(super) corners: [Vec2; 3],
    /// Warp direction.
    pub(super) warp: Vec2,
    /// Bending rigidities along warp and weft, N·m.
    pub(super) rigidity: [f64; 2],
}

/// The constant matrix Q of E = ½ Σ xᵀ Q x (the same for x, y and z), stored by rows.
#[derive(Clone, Debug, Default)]
pub struct Bending {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
    /// Per edge (smaller node first, sorted): a weight w so that Σ w |xᵢ − xⱼ|² ≥ xᵀ Q x.
    bound: Vec<([u32; 2], f64)>,
}

/// Cotangent weights and mixed Voronoi areas of one flat triangle.
struct Element {
    /// weights[k] belongs to the edge opposite corner k.
    weights: [f64; 3],
    areas: [f64; 3],
}

fn element(t: &FlatTriangle) -> Element {
    // Stretch the plane so that the anisotropic Laplacian becomes the plain one: u' = u / B₁^¼, v' = v / B₂^¼.
    let weft = Vec2::new(-t.warp.y, t.warp.x);
    let frame = Matrix2::from_rows(&[
        t.warp.transpose() / t.rigidity[0].max(f64::MIN_POSITIVE).powf(0.25),
        weft.transpose() / t.rigidity[1].max(f64::MIN_POSITIVE).powf(0.25),
    ]);
    let p = t.corners.map(|c| frame * c);
    let cot = [0, 1, 2].map(|k| {
        let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
        a.dot(&b) / a.perp(&b).abs().max(f64::MIN_POSITIVE)
    });
    let area = 0.5 * (p[1] - p[0]).perp(&(p[2] - p[0])).abs();
    Element { weights: cot.map(|c| 0.5 * c), areas: voronoi(&p, cot, area) }
}

/// Share of a triangle's area that is nearest to each corner (Meyer et al. 2003, mixed for obtuse triangles).
fn voronoi(p: &[Vec2; 3], cot: [f64; 3], area: f64) -> [f64; 3] {
    if let Some(k) = (0..3).find(|&k| cot[k] < 0.0) {
        let mut out = [0.25 * area; 3];
        out[k] = 0.5 * area;
        return out;
    }
    let mut out = [0.0; 3];
    for (k, cot) in cot.into_iter().enumerate() {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let share = (p[j] - p[i]).norm_squared() * cot / 8.0;
        out[i] += share;
        out[j] += share;
    }
    out
}

impl Bending {
    /// Builds Q over `nodes` nodes; `interior[i]` says whether node i is surrounded by cloth.
    pub(super) fn new(nodes: usize, triangles: &[FlatTriangle], interior: &[bool]) -> Self {
        let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); nodes];
        // Areas in the stretched plane and in the true one.
        let mut area = vec![[0.0; 2]; nodes];
        for t in triangles {
            let e = element(t);
            let unstretch = (t.rigidity[0] * t.rigidity[1]).powf(0.25);
            for k in 0..3 {
                let a = &mut area[t.nodes[k] as usize];
                *a = [a[0] + e.areas[k], a[1] + e.areas[k] * unstretch];
                let (i, j) = (t.nodes[(k + 1) % 3], t.nodes[(k + 2) % 3]);
                let w = e.weights[k];
                rows[i as usize].extend([(j, w), (i, -w)]);
                rows[j as usize].extend([(i, w), (j, -w)]);
            }
        }
        let mut entries: Vec<(u32, u32, f64)> = Vec::new();
        let mut bound: Vec<([u32; 2], f64)> = Vec::new();
        for (v, row) in rows.iter_mut().enumerate() {
            let [stretched, true_area] = area[v];
            if !interior[v] || stretched <= 0.0 {
                continue;
            }
            // The row's sum is the stretched Laplacian times the stretched area; the energy is per true area.
            let factor = true_area / (stretched * stretched);
            let row = summed(row);
            // A row sums to zero: (Σ rⱼ (xⱼ − xᵥ))² ≤ Σ|r| · Σ |rⱼ| (xⱼ − xᵥ)².
            let v = v as u32;
            let total: f64 = row.iter().filter(|e| e.0 != v).map(|e| e.1.abs()).sum();
            let beside = row.iter().filter(|e| e.0 != v);
            bound.extend(beside.map(|&(j, r)| ([v.min(j), v.max(j)], factor * total * r.abs())));
            for &(i, a) in &row {
                for &(j, b) in &row {
                    entries.push((i, j, a * b * factor));
                }
            }
        }
        let mut out = Self::from_entries(nodes, entries);
        bound.sort_by_key(|e| e.0);
        out.bound = bound.chunk_by(|a, b| a.0 == b.0).map(|g| (g[0].0, g.iter().map(|e| e.1).sum())).collect();
        out
    }

    /// A weight for the edge between nodes a < b such that the edge weights together bound Q from above:
    /// Σ w |x_a − x_b|² ≥ xᵀ Q x (8 B / h² on a square grid, where it is sharp).
    pub fn bound(&self, ends: [u32; 2]) -> f64 {
        self.bound.binary_search_by(|e| e.0.cmp(&ends)).map_or(0.0, |i| self.bound[i].1)
    }

    fn from_entries(nodes: usize, mut entries: Vec<(u32, u32, f64)>) -> Self {
        entries.sort_by_key(|e| (e.0, e.1));
        let mut out = Self { starts: vec![0; nodes + 1], ..Self::default() };
        for group in entries.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            out.starts[group[0].0 as usize + 1] += 1;
            out.columns.push(group[0].1);
            out.values.push(group.iter().map(|e| e.2).sum());
        }
        for i in 0..nodes {
            out.starts[i + 1] += out.starts[i];
        }
        out
    }

    /// The entries of row `i`: (column, value).
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.starts[i] as usize..self.starts[i + 1] as usize;
        self.columns[range.clone()].iter().zip(&self.values[range]).map(|(&c, &v)| (c as usize, v))
    }

    /// (Q x)ᵢ: the gradient of the energy at node `i`, N.
    pub fn gradient(&self, x: &[Vec3], i: usize) -> Vec3 {
        self.row(i).fold(Vec3::zeros(), |sum, (j, q)| sum + x[j] * q)
    }

    /// The energy, J.
    pub fn energy(&self, x: &[Vec3]) -> f64 {
        0.5 * (0..x.len()).map(|i| x[i].dot(&self.gradient(x, i))).sum::<f64>()
    }
}

fn summed(row: &mut [(u32, f64)]) -> Vec<(u32, f64)> {
    row.sort_by_key(|e| e.0);
    row.chunk_by(|a, b| a.0 == b.0).map(|g| (g[0].0, g.iter().map(|e| e.1).sum())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const N: u32 = 20;
    const H: f64 = 0.01;

    /// A square sheet with diagonals one way or alternating.
    fn sheet(rigidity: [f64; 2], alternate: bool) -> (Vec<FlatTriangle>, Vec<bool>, Vec<Vec2>) {
        let at = |i: u32, j: u32| j * (N + 1) + i;
        let flat: Vec<Vec2> =
            (0..(N + 1) * (N + 1)).map(|k| Vec2::new(f64::from(k % (N + 1)), f64::from(k / (N + 1))) * H).collect();
        let mut triangles = Vec::new();
        for j in 0..N {
            for i in 0..N {
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                let two = if alternate && (i + j) % 2 == 1 { [[a, b, d], [b, c, d]] } else { [[a, b, c], [a, c, d]] };
                for nodes in two {
                    let corners = nodes.map(|n| flat[n as usize]);
                    triangles.push(FlatTriangle { nodes, corners, warp: Vec2::y(), rigidity });
                }
            }
        }
        let interior = (0..(N + 1) * (N + 1))
            .map(|k| (1..N).contains(&(k % (N + 1))) && (1..N).contains(&(k / (N + 1))))
            .collect();
        (triangles, interior, flat)
    }

    /// Energy per area of interior cells when rolled to a cylinder of radius `r` along direction `angle`.
    fn rolled(rigidity: [f64; 2], alternate: bool, angle: f64, r: f64) -> f64 {
        let (triangles, interior, flat) = sheet(rigidity, alternate);
        let bending = Bending::new(flat.len(), &triangles, &interior);
        let (d, e) = (Vec2::new(angle.cos(), angle.sin()), Vec2::new(-angle.sin(), angle.cos()));
        let x: Vec<Vec3> = flat
            .iter()
            .map(|p| {
                let s = p.dot(&d) / r;
                Vec3::new(r * s.sin(), r * (1.0 - s.cos()), p.dot(&e))
            })
            .collect();
        let area = interior.iter().filter(|&&i| i).count() as f64 * H * H;
        bending.energy(&x) / area
    }

    #[test]
    fn a_cylinder_costs_half_b_kappa_squared_in_every_direction() {
        let (b, r) = (1e-5, 0.1);
        for alternate in [false, true] {
            for angle in [0.0, 0.4, std::f64::consts::FRAC_PI_4, 1.2, std::f64::consts::FRAC_PI_2] {
                assert_relative_eq!(rolled([b, b], alternate, angle, r), 0.5 * b / (r * r), max_relative = 5e-3);
            }
        }
    }

    #[test]
    fn warp_and_weft_may_differ() {
        // Rolled along y (the warp) the warp's rigidity counts, along x the weft's.
        let (b, r) = ([4e-5, 1e-5], 0.1);
        assert_relative_eq!(rolled(b, true, std::f64::consts::FRAC_PI_2, r), 0.5 * b[0] / (r * r), max_relative = 5e-3);
        assert_relative_eq!(rolled(b, true, 0.0, r), 0.5 * b[1] / (r * r), max_relative = 5e-3);
    }

    #[test]
    fn a_flat_sheet_in_any_position_costs_nothing() {
        let (triangles, interior, flat) = sheet([1e-5, 3e-5], true);
        let bending = Bending::new(flat.len(), &triangles, &interior);
        let x: Vec<Vec3> = flat.iter().map(|p| Vec3::new(0.6 * p.x, p.y, 0.8 * p.x + 0.3)).collect();
        // Rounding only: the same sheet rolled to r = 0.1 m holds 2e-5 J.
        assert!(bending.energy(&x).abs() < 1e-13);
    }
}
