//! Threads through triangles that the grid does not have: those of the strip between it and the outline.
//!
//! No edge of such a triangle follows a thread, and springs along edges that cross both threads give as the trellis
//! between these does, in a woven cloth ten times as much: all that a tight skirt gave gathered in the one column of
//! triangles beside its seams. Here a triangle is a membrane like those of the grid: drawn out along warp and weft by
//! the curve of each, and sheared between them, E = A (W(|F w| − 1) + W'(|F f| − 1) + ½ G (φ − φ₀)²), with F the
//! triangle's deformation, w and f the directions of its threads.

use std::sync::Arc;

use super::model::SeamRest;
use super::shear::Shear;
use super::springs::Stretch;
use crate::fabric::Fabric;
use crate::geometry::{Vec2, Vec3};
use crate::mesh::ClothMesh;

/// A triangle whose seam draws it in to less than this share of its area keeps springs along its edges instead: its
/// gathers are finer than it, and threads squeezed so far say nothing.
const SQUEEZED: f64 = 0.5;

/// A thread of one triangle, drawn out.
#[derive(Clone, Copy, Debug)]
pub struct Thread {
    /// The triangle's nodes.
    pub nodes: [u32; 3],
    /// From the first node the thread goes so many times the way to the second, and so many times that to the third.
    pub weights: [f64; 2],
    /// How it resists; its rest length is that of a leg of the triangle if it were one of the grid.
    pub stretch: Stretch,
}

impl Thread {
    /// From one end to the other, of ways or positions of the nodes.
    pub(super) fn span(&self, x: &[Vec3]) -> Vec3 {
        span(self.nodes, self.weights, x)
    }

    /// How much of its span each node is.
    pub(super) fn shares(&self) -> [f64; 3] {
        shares(self.weights)
    }
}

/// What `weights` make of the ways from the first of the `nodes` to the others.
pub(super) fn span(nodes: [u32; 3], weights: [f64; 2], x: &[Vec3]) -> Vec3 {
    let [a, b, c] = nodes.map(|n| x[n as usize]);
    (b - a) * weights[0] + (c - a) * weights[1]
}

/// How much each node is of a span with such `weights`.
pub(super) fn shares([b, c]: [f64; 2]) -> [f64; 3] {
    [-b - c, b, c]
}

/// A triangle's threads, of a rest length each, in the ways from its first corner to the others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weave {
    /// Warp and weft.
    weights: [[f64; 2]; 2],
    /// Their rest length, metres.
    length: f64,
    /// The angle by which they are off a right one at rest, radians.
    rest: f64,
}

impl Weave {
    /// Of a triangle with the flat `corners`, warp along the unit vector `warp`, whose sides (from the first corner on)
    /// have the `rest` lengths given, metres. None of one that these draw in too far.
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

/// What every triangle of the mesh is woven of, by the sides its seams give it; none of those of the `grid`, which has
/// springs along its threads, of those `drawn` in by elastic, and of those that stitches have closed to a line.
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

/// Threads and shear of the triangles that are woven; `laws` are those of each piece's warp and weft.
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
    use crate::dynamics::springs::StretchLaw;
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
