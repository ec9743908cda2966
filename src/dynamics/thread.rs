//! Threads through triangles off the grid, in the strip between grid and outline.
//!
//! No edge of such a triangle follows a thread. Springs along its edges would cross both threads and give as the bias
//! does, in woven cloth ten times as much: all the stretch of a tight skirt gathered in the one column of triangles
//! beside its seams. So such a triangle is a membrane like those of the grid: stretched along warp and weft by the
//! curve of each, and sheared between them. E = A (W(|F w| − 1) + W'(|F f| − 1) + ½ G (φ − φ₀)²), where F is the
//! deformation gradient of the triangle, and w and f are the directions of its threads.

use std::sync::Arc;

use super::element::{shares, span};
use super::seam_rest::SeamRest;
use super::shear::Shear;
use super::spring::Stretched;
use super::stretch::Stretch;
use crate::fabric::Fabric;
use crate::geometry::{Vec2, Vec3};
use crate::mesh::ClothMesh;

/// Share of its area to which a seam may draw in a triangle with threads. Below it the triangle has springs along its
/// edges instead, because its gathers are finer than the triangle.
const SQUEEZED: f64 = 0.5;

/// A thread of one triangle.
#[derive(Clone, Copy, Debug)]
pub struct Thread {
    /// The triangle's nodes.
    pub nodes: [u32; 3],
    /// The thread as weights of the two sides from the first node to the second and third.
    pub weights: [f64; 2],
    /// Its resistance. The rest length is that of a leg if the triangle were one of the grid.
    pub stretch: Stretch,
}

impl Stretched for Thread {
    fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    fn shares(&self) -> [f64; 3] {
        shares(self.weights)
    }

    fn span(&self, x: &[Vec3]) -> Vec3 {
        span(self.nodes, self.weights, x)
    }

    fn stretch(&self) -> &Stretch {
        &self.stretch
    }
}

/// The two threads of a triangle, as weights of the sides from its first corner, with their rest state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weave {
    /// Warp and weft.
    weights: [[f64; 2]; 2],
    /// Rest length of both, metres.
    length: f64,
    /// Deviation from a right angle at rest, radians.
    rest: f64,
}

impl Weave {
    /// Threads of a triangle with the flat `corners`, the unit vector `warp`, and sides of the `rest` lengths (from the
    /// first corner on), metres. `None` if these draw it in too far ([`SQUEEZED`]).
    fn new(corners: [Vec2; 3], warp: Vec2, rest: [f64; 3]) -> Option<Self> {
        let (u, v) = (corners[1] - corners[0], corners[2] - corners[0]);
        let double = u.perp(&v);
        let length = double.abs().sqrt();
        let along = |d: Vec2| [d.perp(&v), u.perp(&d)].map(|share| share * length / double);
        // Products of the two sides from the first corner as they are at rest.
        let [uu, vw, vv] = rest.map(|side| side * side);
        let uv = 0.5 * (uu + vv - vw);
        if uu * vv - uv * uv < (SQUEEZED * double).powi(2) {
            return None;
        }
        let product = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] * uu + a[1] * b[1] * vv + (a[0] * b[1] + a[1] * b[0]) * uv;
        let weights = [warp, Vec2::new(-warp.y, warp.x)].map(along).map(|thread| {
            let shrunk = length / product(thread, thread).sqrt();
            thread.map(|share| share * shrunk)
        });
        let sine = product(weights[0], weights[1]) / (length * length);
        Some(Self { weights, length, rest: sine.clamp(-1.0, 1.0).asin() })
    }
}

/// Threads of every triangle of the mesh, with the side lengths that its seams give it. `None` for triangles of the
/// `grid`, which have springs along their threads, for those `drawn` in by elastic, and for those that stitches have
/// closed to a line.
pub(super) fn weaves(
    mesh: &ClothMesh,
    grid: &[Option<[u32; 3]>],
    node_of: &[u32],
    rest: &SeamRest,
    drawn: impl Fn([u32; 2]) -> bool,
) -> Vec<Option<Weave>> {
    let mut out = vec![None; mesh.triangles.len()];
    for piece in &mesh.pieces {
        for t in piece.triangles.clone().filter(|t| grid[*t].is_none()) {
            let corners = mesh.triangles[t];
            let [a, b, c] = corners;
            let sides = [[a, b], [b, c], [c, a]];
            let closed = |[a, b]: &[u32; 2]| node_of[*a as usize] == node_of[*b as usize];
            if !sides.iter().any(|side| closed(side) || drawn(*side)) {
                let flat = corners.map(|p| mesh.flat[p as usize]);
                out[t] = Weave::new(flat, piece.warp, sides.map(|side| rest.of(mesh, side)));
            }
        }
    }
    out
}

/// Threads and shear of the triangles that have a [`Weave`]. `laws` gives the laws of each piece's warp and weft.
pub(super) fn threads(
    mesh: &ClothMesh,
    weaves: &[Option<Weave>],
    node_of: &[u32],
    fabrics: &[Arc<Fabric>],
    laws: impl Fn(usize) -> [u32; 2],
) -> (Vec<Thread>, Vec<Shear>) {
    let (mut threads, mut shears) = (Vec::new(), Vec::new());
    for (p, piece) in mesh.pieces.iter().enumerate() {
        for t in piece.triangles.clone() {
            let Some(Weave { weights, length, rest }) = weaves[t] else { continue };
            let nodes = mesh.triangles[t].map(|particle| node_of[particle as usize]);
            // The rest length is the root of twice the area.
            let width = 0.5 * length;
            for (weights, law) in weights.into_iter().zip(laws(p)) {
                threads.push(Thread { nodes, weights, stretch: Stretch { rest: length, width, law } });
            }
            shears.push(Shear { nodes, legs: weights, rest, stiffness: fabrics[p].shear * length * width });
        }
    }
    (threads, shears)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::stretch::StretchLaw;
    use approx::assert_relative_eq;

    const CORNERS: [[f64; 2]; 3] = [[0.003, 0.001], [0.014, 0.004], [0.006, 0.012]];

    fn corners() -> [Vec2; 3] {
        CORNERS.map(|[x, y]| Vec2::new(x, y))
    }

    fn sides([a, b, c]: [Vec2; 3]) -> [f64; 3] {
        [(b - a).norm(), (c - b).norm(), (a - c).norm()]
    }

    /// Warp at 25°.
    fn warp() -> Vec2 {
        Vec2::new(25f64.to_radians().cos(), 25f64.to_radians().sin())
    }

    /// The threads of a triangle with such corners, seams and all, in space.
    fn spans(weave: &Weave, corners: [Vec3; 3]) -> [Vec3; 2] {
        weave.weights.map(|weights| span([0, 1, 2], weights, &corners))
    }

    #[test]
    fn threads_of_a_flat_triangle_are_its_warp_and_weft() {
        let weave = Weave::new(corners(), warp(), sides(corners())).expect("a weave");
        let double = (corners()[1] - corners()[0]).perp(&(corners()[2] - corners()[0]));
        assert_relative_eq!(weave.length, double.sqrt(), max_relative = 1e-12);
        assert_relative_eq!(weave.rest, 0.0, epsilon = 1e-12);
        let [w, f] = spans(&weave, corners().map(|p| Vec3::new(p.x, p.y, 0.0)));
        assert_relative_eq!(w, Vec3::new(warp().x, warp().y, 0.0) * weave.length, epsilon = 1e-15);
        assert_relative_eq!(f, Vec3::new(-warp().y, warp().x, 0.0) * weave.length, epsilon = 1e-15);
    }

    #[test]
    fn a_thread_is_drawn_out_as_the_cloth_is_along_it() {
        let weave = Weave::new(corners(), warp(), sides(corners())).expect("a weave");
        // Three hundredths along x, one shrunk along y, and sheared.
        let strained = corners().map(|p| Vec3::new(1.03 * p.x + 0.02 * p.y, 0.99 * p.y, 0.0));
        let [w, f] = spans(&weave, strained);
        let along = |d: Vec2| Vec2::new(1.03 * d.x + 0.02 * d.y, 0.99 * d.y).norm();
        assert_relative_eq!(w.norm() / weave.length, along(warp()), max_relative = 1e-12);
        assert_relative_eq!(f.norm() / weave.length, along(Vec2::new(-warp().y, warp().x)), max_relative = 1e-12);
    }

    #[test]
    fn a_triangle_that_its_seam_draws_in_rests_as_it_is_sewn() {
        let [a, b, c] = corners();
        // The first side sewn to nine tenths of its length.
        let rest = [0.9 * (b - a).norm(), (c - b).norm(), (a - c).norm()];
        let weave = Weave::new([a, b, c], warp(), rest).expect("a weave");
        let [u, w, v] = rest;
        let x = (u * u + v * v - w * w) / (2.0 * u);
        let sewn = [Vec3::zeros(), Vec3::x() * u, Vec3::new(x, (v * v - x * x).sqrt(), 0.0)];
        let [warp, weft] = spans(&weave, sewn);
        for thread in [warp, weft] {
            assert_relative_eq!(thread.norm(), weave.length, max_relative = 1e-12);
        }
        assert_relative_eq!(warp.dot(&weft) / weave.length.powi(2), weave.rest.sin(), epsilon = 1e-12);
        assert!(weave.rest.abs() > 1e-3, "its threads are not square any more");
        assert!(Weave::new([a, b, c], self::warp(), [0.3 * u, w, v]).is_none(), "gathered to a third");
    }

    /// Half a square of the grid has springs along both legs, each as wide as half the square.
    #[test]
    fn a_triangle_of_the_grid_would_hold_what_its_springs_do() {
        let h = 0.01;
        let corners = [Vec2::zeros(), Vec2::x() * h, Vec2::y() * h];
        let weave = Weave::new(corners, Vec2::x(), sides(corners)).expect("a weave");
        let law = StretchLaw::linear(700.0);
        let thread = Stretch { rest: weave.length, width: 0.5 * weave.length, law: 0 };
        let leg = Stretch { rest: h, width: 0.5 * h, law: 0 };
        assert_relative_eq!(weave.weights[0][0], 1.0, max_relative = 1e-12);
        assert_relative_eq!(weave.weights[0][1], 0.0, epsilon = 1e-12);
        let d = Vec3::x() * 1.02 * h;
        assert_relative_eq!(thread.energy(&law, d), leg.energy(&law, d), max_relative = 1e-12);
    }
}
