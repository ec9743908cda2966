//! Shear of the weave: the angle between warp and weft, independent of their strains.
//!
//! E = ½ G A (φ − φ₀)² for every triangle whose legs u and v run along the threads. φ = asin(u·v / |u||v|) is the
//! deviation from a right angle, and φ₀ that of the flat piece. With the springs along its legs such a triangle is a
//! membrane of threads, each with its own curve. Triangles off the grid are in `thread`: their legs are no sides.
//!
//! A spring on the diagonal would resist the sum of both strains as much as shear (Cauchy's relation for central
//! forces). Cloth whose shear stiffness is near that of its threads, such as a knit, then contracts too much.

use std::sync::Arc;

use super::curvature::thread_of;
use super::element::{Element, ElementForeseen, shares, span};
use super::stretch::{SHORTEST, StretchLaw};
use crate::fabric::Fabric;
use crate::geometry::{Mat3, Vec2, Vec3};
use crate::mesh::ClothMesh;

/// Least sine of the angle between the legs (3°) in the tangent. The stiffness against rotation out of their plane
/// grows without bound as the legs close.
const OPEN: f64 = 0.05;
/// Weights of legs that are sides of their triangle.
const SIDES: [[f64; 2]; 2] = [[1.0, 0.0], [0.0, 1.0]];

/// The shear of one triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shear {
    /// Its corners.
    pub nodes: [u32; 3],
    /// Two legs along the threads, each as weights of the two sides from the first corner to the second and third. Legs
    /// of grid triangles are these sides.
    pub legs: [[f64; 2]; 2],
    /// φ₀, radians.
    pub rest: f64,
    /// Shear stiffness times area, N·m per radian.
    pub stiffness: f64,
}

/// Both legs of a triangle at one position, in the order of [`Shear::nodes`].
struct Legs {
    /// Lengths, metres.
    lengths: [f64; 2],
    /// Unit directions from the corner.
    along: [Vec3; 2],
    /// Square to each leg and to `normal`, towards the other one.
    toward: [Vec3; 2],
    /// Unit normal of the triangle. Zero where the legs lie on one line.
    normal: Vec3,
    /// φ, radians.
    angle: f64,
}

impl Legs {
    fn new([u, v]: [Vec3; 2]) -> Self {
        let lengths = [u, v].map(|d| d.norm().max(SHORTEST));
        let along = [u / lengths[0], v / lengths[1]];
        let cross = along[0].cross(&along[1]);
        let normal = cross.try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let toward = [normal.cross(&along[0]), along[1].cross(&normal)];
        Self { lengths, along, toward, normal, angle: along[0].dot(&along[1]).atan2(cross.norm()) }
    }

    /// Gradient of φ for the far end of each leg, 1/m. That of the corner makes the sum zero.
    fn turning(&self) -> [Vec3; 2] {
        [0, 1].map(|k| self.toward[k] / self.lengths[k])
    }
}

/// Tangent stiffness of a triangle against shear, in terms of the displacements of its legs' far ends relative to the
/// corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShearTangent {
    /// [`Shear::stiffness`].
    stiffness: f64,
    /// Gradient of φ for each leg, 1/m.
    turning: [Vec3; 2],
    /// Directions of the legs over their lengths, 1/m.
    along: [Vec3; 2],
    /// The normal over the legs' lengths, 1/m.
    out: [Vec3; 2],
    /// Moment (N·m per radian) that turns the legs, times 1, tan φ and 1/cos φ.
    load: [f64; 3],
}

/// Positive semidefinite bound of a [`ShearTangent`].
#[derive(Clone, Copy, Debug)]
pub(super) struct ShearBound {
    /// The root r of the stiff part: rᵢ rⱼᵀ for ends i and j of the legs.
    root: [Vec3; 2],
    /// For each leg an isotropic stiffness for its load, N/m.
    drawn: [f64; 2],
}

impl ShearTangent {
    /// Stiffness at a node that takes these `shares` of the forces at the far ends of the legs: for each leg, how it
    /// resists a displacement of its far end relative to the corner.
    fn row(&self, shares: [f64; 2]) -> [Mat3; 2] {
        let [load, tan, sec] = self.load;
        let turning = (self.turning[0] * shares[0] + self.turning[1] * shares[1]) * self.stiffness;
        [0, 1].map(|k| {
            let drawn = shares[k] * load;
            (turning - self.along[k] * drawn) * self.turning[k].transpose()
                - self.turning[k] * drawn * self.along[k].transpose()
                + (self.out[1 - k] * (shares[1 - k] * sec) - self.out[k] * (shares[k] * tan)) * self.out[k].transpose()
        })
    }

    fn bound(&self) -> ShearBound {
        let [_, tan, sec] = self.load.map(f64::abs);
        let root = self.stiffness.sqrt();
        // The out-of-plane part has the eigenvalues −tan φ ± 1/cos φ, the in-plane part ± 1.
        let drawn = self.along.map(|a| (tan + sec) * a.norm_squared());
        ShearBound { root: self.turning.map(|g| g * root), drawn }
    }
}

impl Shear {
    /// Both legs, from displacements or positions of the nodes.
    fn legs(&self, x: &[Vec3]) -> [Vec3; 2] {
        self.legs.map(|weights| span(self.nodes, weights, x))
    }

    /// Forces at the far ends of the legs, distributed to the nodes.
    fn at_nodes(&self, [u, v]: [Vec3; 2]) -> [Vec3; 3] {
        let [one, other] = self.legs.map(shares);
        [0, 1, 2].map(|n| u * one[n] + v * other[n])
    }
}

impl Element<3> for Shear {
    type Tangent = ShearTangent;
    type Bound = ShearBound;

    fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    fn energy(&self, _laws: &[StretchLaw], x: &[Vec3]) -> f64 {
        0.5 * self.stiffness * (Legs::new(self.legs(x)).angle - self.rest).powi(2)
    }

    fn forces(&self, _laws: &[StretchLaw], x: &[Vec3]) -> [Vec3; 3] {
        let legs = Legs::new(self.legs(x));
        self.at_nodes(legs.turning().map(|g| g * (self.stiffness * (self.rest - legs.angle))))
    }

    /// The load is in N·m per radian.
    fn tangent(&self, _laws: &[StretchLaw], x: &[Vec3], load: Option<f64>) -> ShearTangent {
        let legs = Legs::new(self.legs(x));
        let load = load.unwrap_or(self.stiffness * (legs.angle - self.rest));
        let (sin, cos) = legs.angle.sin_cos();
        let cos = cos.max(OPEN);
        ShearTangent {
            stiffness: self.stiffness,
            turning: legs.turning(),
            along: [0, 1].map(|k| legs.along[k] / legs.lengths[k]),
            out: legs.lengths.map(|length| legs.normal / length),
            load: [load, load * sin / cos, load / cos],
        }
    }

    fn add_row(&self, tangent: &ShearTangent, corner: usize, mut add: impl FnMut(usize, Mat3)) {
        let of_legs = self.legs.map(shares);
        let legs = tangent.row(of_legs.map(|shares| shares[corner]));
        (0..3).for_each(|k| add(k, legs[0] * of_legs[0][k] + legs[1] * of_legs[1][k]));
    }

    fn bound(tangent: &ShearTangent) -> ShearBound {
        tangent.bound()
    }

    fn bound_block(&self, ShearBound { root, drawn }: &ShearBound, i: usize, j: usize) -> Mat3 {
        let (root, [one, other]) = (self.at_nodes(*root), self.legs.map(shares));
        let drawn = drawn[0] * one[i] * one[j] + drawn[1] * other[i] * other[j];
        root[i] * root[j].transpose() + Mat3::identity() * drawn
    }

    fn foresee(&self, _laws: &[StretchLaw], x: &[Vec3], to: &[Vec3]) -> ElementForeseen {
        let (from, after) = (self.legs(x), self.legs(to));
        let before = Legs::new(from);
        let turned: f64 = before.turning().iter().zip(after).zip(from).map(|((g, a), b)| g.dot(&(a - b))).sum();
        let linear = before.angle + turned;
        let exact = Legs::new(after).angle;
        ElementForeseen {
            load: self.stiffness * (linear - self.rest),
            beyond: 0.5 * self.stiffness * (exact - linear).powi(2),
            energy: 0.5 * self.stiffness * (exact - self.rest).powi(2),
        }
    }
}

/// For every triangle of the mesh whose legs run along warp and weft, its particles in the order of [`Shear::nodes`].
/// `None` for the others.
pub(super) fn grid_triangles(mesh: &ClothMesh) -> Vec<Option<[u32; 3]>> {
    let mut out = vec![None; mesh.triangles.len()];
    for piece in &mesh.pieces {
        let along = |from: u32, to: u32| thread_of(piece.warp, mesh.flat[to as usize] - mesh.flat[from as usize]);
        for t in piece.triangles.clone() {
            let [a, b, c] = mesh.triangles[t];
            let right = |[corner, u, v]: &[u32; 3]| {
                matches!([along(*corner, *u), along(*corner, *v)], [Some(0), Some(1)] | [Some(1), Some(0)])
            };
            out[t] = [[a, b, c], [b, c, a], [c, a, b]].into_iter().find(right);
        }
    }
    out
}

/// The shear of the grid's triangles. `node_of` maps particles to nodes. A triangle that stitches have closed to a line
/// has none.
pub(super) fn shears(
    mesh: &ClothMesh,
    grid: &[Option<[u32; 3]>],
    node_of: &[u32],
    fabrics: &[Arc<Fabric>],
) -> Vec<Shear> {
    let mut out = Vec::new();
    for (piece, fabric) in mesh.pieces.iter().zip(fabrics) {
        for particles in grid[piece.triangles.clone()].iter().flatten() {
            let nodes = particles.map(|p| node_of[p as usize]);
            if nodes[0] == nodes[1] || nodes[1] == nodes[2] || nodes[2] == nodes[0] {
                continue;
            }
            let [corner, u, v] = particles.map(|p| mesh.flat[p as usize]);
            let (u, v): (Vec2, Vec2) = (u - corner, v - corner);
            let double = u.perp(&v).abs();
            let (rest, stiffness) = (u.dot(&v).atan2(double), 0.5 * double * fabric.shear);
            out.push(Shear { nodes, legs: SIDES, rest, stiffness });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    const LENGTHS: [f64; 2] = [0.012, 0.009];
    const G: f64 = 30.0;

    fn shear() -> Shear {
        Shear { nodes: [0, 1, 2], legs: SIDES, rest: 0.0, stiffness: G * 0.5 * LENGTHS[0] * LENGTHS[1] }
    }

    /// Legs stretched by `drawn` and turned towards each other by `angle`, in a plane that lies askew.
    fn sheared(drawn: [f64; 2], angle: f64) -> Vec<Vec3> {
        let (one, other) = (Vec3::new(2.0, 1.0, -2.0) / 3.0, Vec3::new(1.0, 2.0, 2.0) / 3.0);
        let corner = Vec3::new(0.3, 1.0, -0.2);
        let [u, v] = [0, 1].map(|k| LENGTHS[k] * (1.0 + drawn[k]));
        vec![corner, corner + one * u, corner + (one * angle.sin() + other * angle.cos()) * v]
    }

    /// Resisting forces at the far ends of the legs for displacements `ways` relative to the corner.
    fn apply(tangent: &ShearTangent, ways: [Vec3; 2]) -> [Vec3; 2] {
        [[1.0, 0.0], [0.0, 1.0]].map(|shares| {
            let [one, other] = tangent.row(shares);
            one * ways[0] + other * ways[1]
        })
    }

    #[test]
    fn to_turn_and_to_draw_out_along_threads_costs_nothing() {
        let area = 0.5 * LENGTHS[0] * LENGTHS[1];
        for drawn in [[0.0, 0.0], [0.3, 0.0], [0.0, -0.1], [0.4, 0.2]] {
            assert!(shear().energy(&[], &sheared(drawn, 0.0)) < 1e-28 * G * area);
        }
        // Flat and turned are the same cloth.
        let flat = [Vec3::zeros(), Vec3::x() * LENGTHS[0], Vec3::y() * LENGTHS[1]];
        assert!(shear().energy(&[], &flat) < 1e-28 * G * area);
    }

    #[test]
    fn shear_costs_half_its_stiffness_times_the_angle_squared() {
        for angle in [-1.1, -0.2, 0.01, 0.7, 1.4] {
            let per_area = shear().energy(&[], &sheared([0.0, 0.2], angle)) / (0.5 * LENGTHS[0] * LENGTHS[1]);
            assert_relative_eq!(per_area, 0.5 * G * angle * angle, max_relative = 1e-12);
        }
    }

    #[test]
    fn a_step_foresees_what_turns_the_legs_and_not_the_square_of_it() {
        let (shear, x) = (shear(), sheared([0.0, 0.0], 0.1));
        let tangent = shear.tangent(&[], &x, None);
        // Along the gradient the angle grows by what the gradient says, to first order.
        let mut to = x.clone();
        to[1] += tangent.turning[0] * 1e-9;
        let ElementForeseen { load, beyond, energy } = shear.foresee(&[], &x, &to);
        assert_relative_eq!(energy, shear.energy(&[], &to), max_relative = 1e-12);
        let turned = tangent.turning[0].norm_squared() * 1e-9;
        assert_relative_eq!(load, shear.stiffness * (0.1 + turned), max_relative = 1e-12);
        assert!(beyond < 1e-3 * shear.stiffness * turned * turned);
        // Out of the plane it does not change to first order.
        let normal = (x[1] - x[0]).cross(&(x[2] - x[0])).normalize();
        to[1] = x[1] + normal * 2e-3;
        let ElementForeseen { load, beyond, .. } = shear.foresee(&[], &x, &to);
        assert_relative_eq!(load, shear.stiffness * 0.1, max_relative = 1e-12);
        let change = Legs::new(shear.legs(&to)).angle - 0.1;
        assert!(change.abs() > 1e-3);
        assert_relative_eq!(beyond, 0.5 * shear.stiffness * change * change, max_relative = 1e-9);
    }

    /// Legs that have folded onto one another, and a leg without a length, give finite numbers.
    #[test]
    fn triangles_without_a_plane_have_finite_forces() {
        let corner = Vec3::new(0.1, 0.2, 0.3);
        for (u, v) in [(Vec3::x(), Vec3::x()), (Vec3::x(), -Vec3::x()), (Vec3::zeros(), Vec3::y())] {
            let x = vec![corner, corner + u * 0.01, corner + v * 0.02];
            let tangent = shear().tangent(&[], &x, None);
            let forces = shear().forces(&[], &x).into_iter().chain(apply(&tangent, [Vec3::x(), Vec3::z()]));
            assert!(forces.flat_map(|f| [f.x, f.y, f.z]).all(f64::is_finite));
            assert!(tangent.bound().drawn.iter().all(|b| b.is_finite()) && shear().energy(&[], &x).is_finite());
        }
    }
}
