//! The published energy of cloth (L7–L11) and its two solvers.
//!
//! Liu, Wang & Luo 2015 find the shape of a cloth as the minimum of (7) E = ω_R E_P + ω_S E_L + ω_B E_A:
//!
//! ```text
//! (4) E_P = Σ ‖vᵢ − tᵢ‖²             recovery: every vertex near its target
//! (5) E_L = Σ (L_T(e) − L_M(e))²      stretch: every edge near its length in the initial mesh
//! (6) E_A = Σ ‖A_T(e) − A_M(e)‖²      bend: every hinge near its shape in the initial mesh
//! ```
//!
//! ```text
//! GeometricCloth ──▶ Alternating   one scalar factor for all iterations
//!  stencils, weights └▶ LeastSquares  the published Gauss–Newton, refactored each time
//! ```
//!
//! Both solvers go downhill only, hold the same vertices in place and stop at the same minimum.
//!
//! The cloth is flat when at rest, whatever the shape of the mesh that is handed in: every hinge of the initial mesh
//! counts as laid flat, so A_M = 0 and E_A is quadratic with a constant matrix (`hinge`).

mod alternating;
mod descent;
mod energy;
mod error;
mod handles;
mod hinge;
mod least_squares;
mod stencils;

use crate::geometry::{TriMesh, Vec2, Vec3};

pub use alternating::Alternating;
pub use descent::{Report, SolveOptions};
pub use energy::{Aim, Energies};
pub use error::GeometricError;
pub use least_squares::LeastSquares;

use stencils::Stencils;

/// Side of a particle's cell on the paper's own specimen, metres: 46×40 cm, 2,000 particles (L2, L12). There the plain
/// sums and [`Weighting::PerArea`] are the same.
pub const PUBLISHED_CELL: f64 = 0.009_591_663_046_625_438;

/// The weights ω of (7), any common factor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    /// ω_R.
    pub recovery: f64,
    /// ω_S.
    pub stretch: f64,
    /// ω_B.
    pub bend: f64,
}

impl Weights {
    /// Weights in percent as Table 2 prints them, in its order: recovery, stretch, bend
    /// ([`crate::fabric::LiuMeasures::weights`]).
    pub fn from_percent(percent: [f64; 3]) -> Self {
        let [recovery, stretch, bend] = percent.map(|p| p / 100.0);
        Self { recovery, stretch, bend }
    }

    fn is_valid(&self) -> bool {
        let all = [self.recovery, self.stretch, self.bend];
        all.iter().all(|w| w.is_finite() && *w >= 0.0) && all.iter().any(|w| *w > 0.0)
    }
}

/// How much every vertex, edge and hinge counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weighting {
    /// All the same, as (4)–(6) are printed. Halving the spacing then multiplies E_P by 4, leaves E_L and divides E_A
    /// by 4: the shape depends on the mesh.
    Plain,
    /// E_P by area, E_L by (area at the edge)/L², E_A as the discrete shell's 3 L²/A times the squared angle, each
    /// scaled once ([`PUBLISHED_CELL`]): integrals over the cloth, which converge under refinement.
    PerArea,
}

/// A cloth with the published energy.
#[derive(Clone, Debug)]
pub struct GeometricCloth {
    weights: Weights,
    stencils: Stencils,
}

impl GeometricCloth {
    /// The cloth whose initial mesh M is `rest`: its edge lengths count, its hinges are taken as flat.
    ///
    /// # Errors
    /// [`GeometricError`] for triangles or weights that are not usable.
    pub fn new(rest: &TriMesh, weights: Weights, weighting: Weighting) -> Result<Self, GeometricError> {
        let vertices = rest.vertices.len();
        if let Some(triangle) = rest.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= vertices)) {
            return Err(GeometricError::Index { triangle, vertices });
        }
        let corners: Vec<[Vec2; 3]> = (0..rest.triangles.len()).map(|t| laid_flat(rest.corners(t))).collect();
        Self::from_flat(vertices, &rest.triangles, &corners, weights, weighting)
    }

    /// The cloth of a sewn garment: `corners` are the flat positions (metres) of the triangles' corners, each triangle
    /// for itself, so that pieces may meet in a seam. An edge between two pieces has the mean of its two lengths.
    ///
    /// # Errors
    /// As [`GeometricCloth::new`].
    pub fn from_flat(
        vertices: usize,
        triangles: &[[u32; 3]],
        corners: &[[Vec2; 3]],
        weights: Weights,
        weighting: Weighting,
    ) -> Result<Self, GeometricError> {
        if !weights.is_valid() {
            return Err(GeometricError::Weights(weights));
        }
        Ok(Self { weights, stencils: Stencils::new(vertices, triangles, corners, weighting)? })
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.stencils.points.len()
    }

    /// Number of edges, each counted once (Table 3 counts them twice).
    pub fn edges(&self) -> usize {
        self.stencils.edges.len()
    }

    /// The terms of the energy at `x` and their weighted sum.
    ///
    /// # Panics
    /// If `x` or the targets of `aim` are not one per vertex.
    pub fn energy(&self, x: &[Vec3], aim: &Aim) -> Energies {
        energy::energies(&self.stencils, &self.weights, x, aim)
    }

    /// The gradient of [`Energies::total`] at `x`.
    ///
    /// # Panics
    /// If `x` or the targets of `aim` are not one per vertex.
    pub fn gradient(&self, x: &[Vec3], aim: &Aim) -> Vec<Vec3> {
        let mut out = vec![Vec3::zeros(); x.len()];
        energy::half_gradient(&self.stencils, &self.weights, x, aim, &mut out);
        out.iter_mut().for_each(|g| *g *= 2.0);
        out
    }

    /// What gravity adds to a target per iteration, metres, so that a cloth with equal ω_B and ω_R has the bending
    /// length `c0` (metres) with [`Weighting::PerArea`]; others have c₀·(ω_B/ω_R)^⅓. See [`Aim::Falling`].
    ///
    /// With g = this drop and h = [`PUBLISHED_CELL`], a cylinder of curvature κ costs ω_B κ² h²/4 per area and the
    /// weight per area is 2 ω_R g/h²; c³ is rigidity over weight, h⁴/(4 g)·ω_B/ω_R.
    pub fn drop_for_bending_length(c0: f64) -> Vec3 {
        Vec3::new(0.0, -PUBLISHED_CELL.powi(4) / (4.0 * c0.powi(3)), 0.0)
    }
}

/// Corners of a triangle in a plane of its own.
fn laid_flat([a, b, c]: [Vec3; 3]) -> [Vec2; 3] {
    let (ab, ac) = (b - a, c - a);
    // Two equal corners leave the direction undefined, which the check of the areas finds.
    let length = ab.norm();
    [Vec2::zeros(), Vec2::new(length, 0.0), Vec2::new(ac.dot(&ab) / length, ab.cross(&ac).norm() / length)]
}
