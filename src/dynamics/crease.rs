//! Pressed folds: hinges along a fold line with a rest angle.
//!
//! E = ½ Σ k (θ − θ₀)² over the edges of the line. θ is the dihedral angle between the triangles on either side: 0 is
//! flat, and positive turns the wrong sides towards each other. k = rigidity across the line × edge length / [`WIDTH`].

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::Arc;

use super::element::Element;
use super::stretch::StretchLaw;
use crate::fabric::Fabric;
use crate::geometry::{Mat3, Vec2, Vec3};
use crate::mesh::{ClothMesh, LineParticles};

/// Width of the strip of cloth as which a pressed fold bends, metres: the width that an iron's edge sets. It does not
/// depend on the spacing. Estimated: recovery angles of creased cloth (ISO 2313) are given without a moment.
const WIDTH: f64 = 5e-3;
/// Least height of a triangle over its fold, metres. A lower triangle has no direction of rotation.
const LOWEST: f64 = 1e-7;

/// One edge of a fold line with the triangles on both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crease {
    /// The edge's ends, then the far corner of the triangle (0, 1, 2) and that of the triangle (1, 0, 3), both
    /// clockwise seen from the right side.
    nodes: [u32; 4],
    /// θ₀, radians.
    rest: f64,
    /// Stiffness k, N·m per radian.
    stiffness: f64,
    /// θ at the last position, radians. The present angle is the reading within half a turn of it.
    last: f64,
}

impl Crease {
    /// A new crease. Without a history the angle is the reading between a quarter turn the wrong way and a quarter turn
    /// too far.
    pub(super) fn new(nodes: [u32; 4], rest: f64, stiffness: f64) -> Self {
        let last = if rest.abs() > FRAC_PI_2 { FRAC_PI_2.copysign(rest) } else { 0.0 };
        Self { nodes, rest, stiffness, last }
    }

    /// Moment towards the rest angle, N·m.
    fn moment(&self, x: &[Vec3]) -> f64 {
        self.stiffness * (self.rest - self.angle(x))
    }

    fn corners(&self, x: &[Vec3]) -> [Vec3; 4] {
        self.nodes.map(|n| x[n as usize])
    }

    /// The angle at `x`, within half a turn of the last one.
    pub(super) fn angle(&self, x: &[Vec3]) -> f64 {
        let [a, b, c, d] = self.corners(x);
        let along = (b - a).try_normalize(0.0).unwrap_or_else(Vec3::zeros);
        let (m, n) = ((b - a).cross(&(c - a)), (d - a).cross(&(b - a)));
        let angle = n.cross(&m).dot(&along).atan2(m.dot(&n));
        angle + TAU * ((self.last - angle) / TAU).round()
    }

    /// Gradient of the angle for every node, 1/m.
    fn turning(&self, x: &[Vec3]) -> [Vec3; 4] {
        let [a, b, c, d] = self.corners(x);
        let e = b - a;
        let length = e.norm().max(LOWEST);
        let (m, n) = (e.cross(&(c - a)), (d - a).cross(&e));
        // A wing rotates about the edge by 1/height.
        let swing = |normal: Vec3| {
            let height = normal.norm() / length;
            if height > LOWEST { normal * (1.0 / (normal.norm() * height)) } else { Vec3::zeros() }
        };
        let (wing_c, wing_d) = (swing(m), swing(n));
        let share = |p: Vec3| (p - a).dot(&e) / (length * length);
        let (s, t) = (share(c), share(d));
        [-(wing_c * (1.0 - s) + wing_d * (1.0 - t)), -(wing_c * s + wing_d * t), wing_c, wing_d]
    }
}

impl Element<4> for Crease {
    /// The vectors g of a Gauss–Newton stiffness K = Σ gᵢ gⱼᵀ. It lacks what the moment adds, and so is its own bound.
    type Tangent = [Vec3; 4];
    type Bound = [Vec3; 4];

    fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    fn energy(&self, _laws: &[StretchLaw], x: &[Vec3]) -> f64 {
        0.5 * self.stiffness * (self.angle(x) - self.rest).powi(2)
    }

    fn forces(&self, _laws: &[StretchLaw], x: &[Vec3]) -> [Vec3; 4] {
        let moment = self.moment(x);
        self.turning(x).map(|g| g * moment)
    }

    fn tangent(&self, _laws: &[StretchLaw], x: &[Vec3], _load: Option<f64>) -> [Vec3; 4] {
        let root = self.stiffness.sqrt();
        self.turning(x).map(|g| g * root)
    }

    fn add_row(&self, root: &[Vec3; 4], corner: usize, mut add: impl FnMut(usize, Mat3)) {
        (0..4).for_each(|k| add(k, root[corner] * root[k].transpose()));
    }

    fn bound(root: &[Vec3; 4]) -> [Vec3; 4] {
        *root
    }

    fn bound_block(&self, root: &[Vec3; 4], i: usize, j: usize) -> Mat3 {
        root[i] * root[j].transpose()
    }

    fn resist(&self, root: &[Vec3; 4], p: &[Vec3]) -> [Vec3; 4] {
        let turned: f64 = self.nodes.iter().zip(root).map(|(&n, g)| g.dot(&p[n as usize])).sum();
        root.map(|g| g * turned)
    }

    /// Stores the angle at `x`. It tells a fold that is pressed past half a turn from one that lies the wrong way.
    /// Without it the energy would jump at half a turn.
    fn follow(&mut self, x: &[Vec3]) {
        self.last = self.angle(x);
    }
}

/// The creases of every pressed fold line. `node_of` maps particles to nodes. A triangle that stitches have closed to a
/// line has no angle and is left out.
pub(super) fn creases(mesh: &ClothMesh, node_of: &[u32], fabrics: &[Arc<Fabric>]) -> Vec<Crease> {
    let mut out = Vec::new();
    for (piece, fabric) in mesh.pieces.iter().zip(fabrics) {
        let folds: Vec<(&LineParticles, f64)> =
            piece.lines.iter().filter_map(|line| Some((line, line.kind.hinge()?))).collect();
        if folds.is_empty() {
            continue;
        }
        let across = across_edges(&mesh.triangles[piece.triangles.clone()]);
        for (line, rest) in folds {
            for w in line.particles.windows(2) {
                let Some(nodes) = across(w[0], w[1]) else { continue };
                let edge = mesh.flat[w[1] as usize] - mesh.flat[w[0] as usize];
                let stiffness = rigidity_across(fabric, edge, piece.warp) * edge.norm() / WIDTH;
                let nodes = nodes.map(|p| node_of[p as usize]);
                let distinct = (0..4).all(|i| (0..i).all(|j| nodes[i] != nodes[j]));
                if distinct {
                    out.push(Crease::new(nodes, rest, stiffness));
                }
            }
        }
    }
    out
}

/// A function from two neighbouring particles to these and the far corners of the triangles on both sides, in the order
/// of [`Crease::nodes`].
fn across_edges(triangles: &[[u32; 3]]) -> impl Fn(u32, u32) -> Option<[u32; 4]> {
    let far: HashMap<[u32; 2], u32> =
        triangles.iter().flat_map(|&[a, b, c]| [([a, b], c), ([b, c], a), ([c, a], b)]).collect();
    move |a, b| Some([a, b, *far.get(&[a, b])?, *far.get(&[b, a])?])
}

/// Bending rigidity across an edge, as in the energy of the sheet: (√B₁ cos² + √B₂ sin²)², N·m.
pub(super) fn rigidity_across(fabric: &Fabric, edge: Vec2, warp: Vec2) -> f64 {
    let along_warp = (edge.perp(&warp) / edge.norm()).powi(2);
    (fabric.bend_warp.sqrt() * along_warp + fabric.bend_weft.sqrt() * (1.0 - along_warp)).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn crease(rest: f64) -> Crease {
        Crease::new([0, 1, 2, 3], rest, 0.3)
    }

    /// Two triangles, clockwise seen from +z where their right sides face, folded by `angle`:
    /// wings go down when it is positive.
    fn folded(angle: f64) -> Vec<Vec3> {
        let (s, c) = (0.5 * angle).sin_cos();
        [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.7 * c, 0.3, -0.7 * s], [-0.4 * c, 0.8, -0.4 * s]].map(Vec3::from).to_vec()
    }

    #[test]
    fn the_angle_is_positive_when_the_wrong_sides_meet() {
        for angle in [-3.0, -1.2, 0.0, 0.4, 2.0, 3.1] {
            assert_relative_eq!(crease(0.1).angle(&folded(angle)), angle, epsilon = 1e-12);
        }
    }

    #[test]
    fn a_fold_pressed_shut_knows_a_little_too_far_from_a_little_the_wrong_way() {
        let shut = crease(std::f64::consts::PI);
        assert_relative_eq!(shut.angle(&folded(3.3)), 3.3, epsilon = 1e-12);
        assert_relative_eq!(shut.angle(&folded(-0.2)), -0.2, epsilon = 1e-12);
    }

    #[test]
    fn a_fold_that_is_followed_keeps_its_turn() {
        let mut shut = crease(std::f64::consts::PI);
        // Turned the wrong way little by little, past the quarter turn where a new fold would be taken for too far.
        for angle in [-0.5, -1.5, -2.5, -3.5] {
            shut.follow(&folded(angle));
            assert_relative_eq!(shut.angle(&folded(angle)), angle, epsilon = 1e-12);
        }
        assert!(shut.energy(&[], &folded(-3.5)) > shut.energy(&[], &folded(-1.5)));
    }
}
