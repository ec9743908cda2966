//! The recovery term (4): which points of the cloth are drawn to targets.

use super::GeometricError;
use super::stencils::Stencils;
use crate::geometry::Vec3;

/// A point of the cloth that is drawn to a target: a vertex, or a point inside a triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// Vertices and their shares of the point. The shares sum to one.
    parts: Vec<(u32, f64)>,
    target: Vec3,
}

impl Control {
    /// Draws a vertex to `target`, metres.
    pub fn vertex(vertex: u32, target: Vec3) -> Self {
        Self { parts: vec![(vertex, 1.0)], target }
    }

    /// Draws a point of a triangle to `target`, metres. `shares` are the point's barycentric coordinates.
    pub fn in_triangle(corners: [u32; 3], shares: [f64; 3], target: Vec3) -> Self {
        Self { parts: corners.into_iter().zip(shares).collect(), target }
    }

    /// Position of the point while the vertices are at `x`, metres.
    ///
    /// # Panics
    /// If `x` has no such vertex.
    pub fn point(&self, x: &[Vec3]) -> Vec3 {
        self.parts.iter().map(|&(v, share)| x[v as usize] * share).sum()
    }

    /// The vertices that the point is made of.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        self.parts.iter().map(|p| p.0)
    }

    /// Target of the point, metres.
    pub fn target(&self) -> Vec3 {
        self.target
    }

    /// Distance of the point from its target, metres.
    ///
    /// # Panics
    /// If `x` has no such vertex.
    pub fn miss(&self, x: &[Vec3]) -> f64 {
        (self.point(x) - self.target).norm()
    }

    fn is_usable(&self) -> bool {
        let finite = self.parts.iter().all(|(_, share)| share.is_finite()) && is_finite(&self.target);
        let repeated = (1..self.parts.len()).any(|k| self.parts[..k].iter().any(|p| p.0 == self.parts[k].0));
        finite && !repeated
    }
}

/// The readings of E_P.
#[derive(Clone, Debug, PartialEq)]
pub enum Recovery {
    /// E_P counts the control points only: N Σ ‖pᵢ − tᵢ‖², where N is the area of the initial mesh over that of
    /// [`super::PUBLISHED_CELL`]. No other vertex is drawn anywhere. This reading reproduces the published figures.
    Controls(Vec<Control>),
    /// E_P counts every vertex, each with a target of its own (metres), as the sum (4) is printed. With the initial
    /// mesh as targets this reading does *not* reproduce the published figures: every vertex beside a lifted one is
    /// held down, and cloth becomes a flat sheet with spikes.
    AllVertices(Vec<Vec3>),
    /// Gravity: tᵢ is the vertex's own position, moved by this much (metres) in every iteration. E_P is then implicit
    /// Euler's own variational form and the solver falls to rest, where the other two terms hold the pull
    /// 2 ω_R pᵢ · drop on every vertex of weight pᵢ. In place of E_P the energy has that pull's potential,
    /// −2 Σ pᵢ drop · vᵢ.
    Falling(Vec3),
}

impl Recovery {
    /// E_P, or the potential in its place.
    pub(super) fn energy(&self, stencils: &Stencils, x: &[Vec3]) -> f64 {
        let points = || stencils.points.iter().zip(x);
        match self {
            Self::Controls(controls) => stencils.cells * controls.iter().map(|c| c.miss(x).powi(2)).sum::<f64>(),
            Self::AllVertices(targets) => points().zip(targets).map(|((p, v), t)| p * (v - t).norm_squared()).sum(),
            Self::Falling(drop) => -2.0 * points().map(|(p, v)| p * drop.dot(v)).sum::<f64>(),
        }
    }

    /// Adds half the gradient of ω E_P to `out`.
    pub(super) fn add_half_gradient(&self, stencils: &Stencils, weight: f64, x: &[Vec3], out: &mut [Vec3]) {
        let points = stencils.points.iter().map(|p| weight * p);
        match self {
            Self::Controls(controls) => {
                for control in controls {
                    let pull = (control.point(x) - control.target) * (weight * stencils.cells);
                    control.parts.iter().for_each(|&(v, share)| out[v as usize] += pull * share);
                }
            }
            Self::AllVertices(targets) => {
                let away = x.iter().zip(targets).map(|(v, t)| v - t);
                out.iter_mut().zip(points.zip(away)).for_each(|(g, (p, away))| *g += away * p);
            }
            Self::Falling(drop) => out.iter_mut().zip(points).for_each(|(g, p)| *g -= drop * p),
        }
    }

    /// The entries of half the second derivative of ω E_P, the same for x, y and z: row, column, value. Of two entries
    /// that mirror each other, one is named.
    pub(super) fn entries(&self, stencils: &Stencils, weight: f64) -> Vec<(u32, u32, f64)> {
        match self {
            Self::Controls(controls) => {
                let of = |control: &Control| {
                    let parts = &control.parts;
                    let row = |i: usize| parts[i..].iter().map(move |&(b, of_b)| (parts[i].0, b, parts[i].1 * of_b));
                    (0..parts.len()).flat_map(row).collect::<Vec<_>>()
                };
                let scaled = |(a, b, value)| (a, b, weight * stencils.cells * value);
                controls.iter().flat_map(of).map(scaled).collect()
            }
            Self::AllVertices(_) | Self::Falling(_) => {
                (0u32..).zip(&stencils.points).map(|(v, p)| (v, v, weight * p)).collect()
            }
        }
    }

    pub(super) fn check(&self, vertices: usize) -> Result<(), GeometricError> {
        match self {
            Self::Controls(controls) => {
                for (k, control) in controls.iter().enumerate() {
                    if let Some(&(vertex, _)) = control.parts.iter().find(|p| p.0 as usize >= vertices) {
                        return Err(GeometricError::Handle { vertex, vertices });
                    }
                    if !control.is_usable() {
                        return Err(GeometricError::Control(k));
                    }
                }
                Ok(())
            }
            Self::AllVertices(targets) => check_positions("targets", targets, vertices),
            Self::Falling(drop) => {
                if is_finite(drop) {
                    Ok(())
                } else {
                    Err(GeometricError::Drop)
                }
            }
        }
    }

    /// Controls whose targets are `share` of the way from where their points are in `from`.
    pub(super) fn part_way(&self, from: &[Vec3], share: f64) -> Self {
        let Self::Controls(controls) = self else { return self.clone() };
        let moved = |c: &Control| Control { target: c.point(from).lerp(&c.target, share), ..c.clone() };
        Self::Controls(controls.iter().map(moved).collect())
    }
}

/// Refuses a list of positions that is not one per vertex, or not finite.
pub(super) fn check_positions(what: &'static str, list: &[Vec3], vertices: usize) -> Result<(), GeometricError> {
    if list.len() != vertices {
        return Err(GeometricError::Count { what, found: list.len(), expected: vertices });
    }
    list.iter().position(|v| !is_finite(v)).map_or(Ok(()), |v| Err(GeometricError::NotFinite(v)))
}

fn is_finite(v: &Vec3) -> bool {
    v.iter().all(|c| c.is_finite())
}
