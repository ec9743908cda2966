//! One member of E_A, ‖A_T − A_M‖², and its gradient.
//!
//! A_M = 0 for a flat hinge. For a folded one it has its length in the initial mesh and the direction of the hinge's
//! present normal: A stands on the hinge along the mean of its two triangles' normals, wherever the cloth is.

use crate::geometry::Vec3;

/// Length below which an edge has no direction, metres: far below any real edge and far above rounding.
const SHORTEST: f64 = 1e-12;

/// Unit direction and length of an edge vector. No direction where it has no length.
pub(super) fn direction(edge: Vec3) -> (Vec3, f64) {
    let length = edge.norm();
    if length > SHORTEST { (edge / length, length) } else { (Vec3::zeros(), length) }
}

/// A hinge of the cloth: edge ij between the triangles with apexes k and l.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bend {
    /// Nodes i, j, k, l.
    pub(super) nodes: [u32; 4],
    pub(super) coefficients: [f64; 4],
    pub(super) weight: f64,
    /// Length of A_M along the normal, metres. 0 for a hinge that is flat at rest.
    pub(super) rest: f64,
}

/// The normals of a hinge.
struct Normals {
    /// Unit normals of the two triangles, and the length of each before it was scaled (twice the area).
    sides: [(Vec3, f64); 2],
    /// The mean direction, and the length of the sum of both.
    mean: (Vec3, f64),
}

impl Bend {
    /// A of the hinge at positions `x`.
    pub(super) fn fold(&self, x: &[Vec3]) -> Vec3 {
        self.nodes.iter().zip(&self.coefficients).map(|(&n, &c)| x[n as usize] * c).sum()
    }

    /// The hinge with A_M as it is at positions `rest`.
    pub(super) fn folded_as(self, rest: &[Vec3]) -> Self {
        Self { rest: self.fold(rest).dot(&self.normals(rest).mean.0), ..self }
    }

    /// A_T − A_M at positions `x`.
    pub(super) fn miss(&self, x: &[Vec3]) -> Vec3 {
        let fold = self.fold(x);
        if self.rest == 0.0 { fold } else { fold - self.normals(x).mean.0 * self.rest }
    }

    /// Adds half the gradient of ω ‖A_T − A_M‖² to `out`.
    pub(super) fn add_half_gradient(&self, weight: f64, x: &[Vec3], out: &mut [Vec3]) {
        let pull = self.miss(x) * (weight * self.weight);
        for (&n, &c) in self.nodes.iter().zip(&self.coefficients) {
            out[n as usize] += pull * c;
        }
        if self.rest != 0.0 {
            self.add_turning(pull * -self.rest, x, out);
        }
    }

    /// Adds the gradient of w · n to `out`, where n is the mean normal.
    fn add_turning(&self, w: Vec3, x: &[Vec3], out: &mut [Vec3]) {
        let Normals { sides, mean: (mean, length) } = self.normals(x);
        if sides.iter().any(|s| s.0 == Vec3::zeros()) || mean == Vec3::zeros() {
            return;
        }
        let across = (w - mean * mean.dot(&w)) / length;
        let [u, v] = sides.map(|(n, double_area)| (across - n * n.dot(&across)) / double_area);
        let [i, j, k, l] = self.nodes.map(|n| n as usize);
        let (edge, to_k, to_l) = (x[j] - x[i], x[k] - x[i], x[l] - x[i]);
        let of_edge = to_k.cross(&u) + v.cross(&to_l);
        let (of_k, of_l) = (u.cross(&edge), edge.cross(&v));
        out[i] -= of_edge + of_k + of_l;
        out[j] += of_edge;
        out[k] += of_k;
        out[l] += of_l;
    }

    fn normals(&self, x: &[Vec3]) -> Normals {
        let [i, j, k, l] = self.nodes.map(|n| x[n as usize]);
        let edge = j - i;
        let sides = [direction(edge.cross(&(k - i))), direction((l - i).cross(&edge))];
        Normals { sides, mean: direction(sides[0].0 + sides[1].0) }
    }
}
