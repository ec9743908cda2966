//! The published energy of cloth (L7–L11) and its two solvers.
//!
//! Liu, Wang & Luo 2015 find the shape of a cloth as the minimum of (7) E = ω_R E_P + ω_S E_L + ω_B E_A:
//!
//! ```text
//! (4) E_P = N Σ ‖pᵢ − tᵢ‖²           recovery: every control point near its target
//! (5) E_L = Σ (L_T(e) − L_M(e))²      stretch: every edge near its length in the initial mesh
//! (6) E_A = Σ ‖A_T(e) − A_M(e)‖²      bend: every hinge near its shape in the initial mesh
//! ```
//!
//! The paper prints (4) as a sum over all vertices. Read so, it does not give the paper's figures. [`Recovery`] has
//! both readings, and `docs/papers.md` says why the control points alone are meant.
//!
//! ```text
//! GeometricCloth ──▶ Alternating   one scalar factor for all iterations
//!  stencils, weights └▶ LeastSquares  the published Gauss–Newton, refactored each time
//! ```
//!
//! `solve` of either goes downhill only ([`LeastSquares::drag`] does not). Both hold the same vertices in place and
//! stop at the same minimum.
//!
//! [`GeometricCloth::new`] makes a cloth that is flat at rest, whatever the shape of its initial mesh: A_M = 0, and E_A
//! is quadratic with a constant matrix (`hinge`). [`GeometricCloth::curved`] takes A_M from the initial mesh (`bend`).

mod alternating;
mod bend;
mod descent;
mod energy;
mod error;
mod handles;
mod hinge;
mod least_squares;
mod problem;
mod recovery;
mod stencils;

use crate::geometry::{TriMesh, Vec2, Vec3};

pub use alternating::Alternating;
pub use descent::{SolveOptions, SolverReport};
pub use energy::Energies;
pub use error::GeometricError;
pub use least_squares::LeastSquares;
pub use recovery::{Control, Recovery};

use stencils::Stencils;

/// Side of a particle's cell on the paper's own specimen, metres: 46×40 cm, 2,000 particles (L2, L12). There the plain
/// sums of E_L and E_A and those of [`Weighting::PerArea`] are the same, but for the rim.
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

/// Weights of vertices, edges and hinges within their sums.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weighting {
    /// All the same, as (4)–(6) are printed. Halving the spacing then leaves E_L and divides E_A by 4 (E_P over all
    /// vertices is multiplied by 4): the shape depends on the mesh. Control points have the weight N here too.
    Plain,
    /// E_L by (area at the edge)/L², E_A as the discrete shell's 3 L²/A times the squared angle, E_P over all vertices
    /// by area, each scaled once ([`PUBLISHED_CELL`]): integrals over the cloth, which converge under refinement.
    /// Control points weigh the same in every mesh ([`Recovery::Controls`]).
    PerArea,
}

/// A cloth with the published energy.
#[derive(Clone, Debug)]
pub struct GeometricCloth {
    weights: Weights,
    stencils: Stencils,
}

impl GeometricCloth {
    /// The cloth whose initial mesh M is `rest` and which is flat at rest: the edge lengths of M count, its folds do
    /// not.
    ///
    /// # Errors
    /// [`GeometricError`] for triangles or weights that are not usable.
    pub fn new(rest: &TriMesh, weights: Weights, weighting: Weighting) -> Result<Self, GeometricError> {
        if !weights.is_valid() {
            return Err(GeometricError::Weights(weights));
        }
        let vertices = rest.vertices.len();
        if let Some(triangle) = rest.triangles.iter().position(|t| t.iter().any(|&v| v as usize >= vertices)) {
            return Err(GeometricError::Index { triangle, vertices });
        }
        let corners: Vec<[Vec2; 3]> = (0..rest.triangles.len()).map(|t| laid_flat(rest.corners(t))).collect();
        Ok(Self { weights, stencils: Stencils::new(vertices, &rest.triangles, &corners, weighting)? })
    }

    /// The cloth whose initial mesh M is `rest` and which is curved at rest as M is: its E_L and E_A are zero there.
    ///
    /// # Errors
    /// As [`GeometricCloth::new`].
    pub fn curved(rest: &TriMesh, weights: Weights, weighting: Weighting) -> Result<Self, GeometricError> {
        let mut cloth = Self::new(rest, weights, weighting)?;
        for hinge in &mut cloth.stencils.hinges {
            *hinge = hinge.folded_as(&rest.vertices);
        }
        Ok(cloth)
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
    /// If `x`, or targets for all vertices, are not one per vertex, or a control names a vertex that does not exist.
    pub fn energy(&self, x: &[Vec3], recovery: &Recovery) -> Energies {
        energy::energies(&self.stencils, &self.weights, x, recovery)
    }

    /// The gradient of [`Energies::total`] at `x`.
    ///
    /// # Panics
    /// As [`GeometricCloth::energy`].
    pub fn gradient(&self, x: &[Vec3], recovery: &Recovery) -> Vec<Vec3> {
        let mut out = self.half_gradient(x, recovery);
        out.iter_mut().for_each(|g| *g *= 2.0);
        out
    }

    fn half_gradient(&self, x: &[Vec3], recovery: &Recovery) -> Vec<Vec3> {
        energy::half_gradient(&self.stencils, &self.weights, x, recovery)
    }

    /// Motion of a target per iteration by gravity, metres. With [`Weighting::PerArea`] a cloth with equal ω_B and ω_R
    /// then has the bending length `c0` (metres), and others have c₀·(ω_B/ω_R)^⅓. See [`Recovery::Falling`].
    ///
    /// With g = this drop and h = [`PUBLISHED_CELL`], a cylinder of curvature κ costs ω_B κ² h²/4 per area and the
    /// weight per area is 2 ω_R g/h². So c³ is rigidity over weight, h⁴/(4 g)·ω_B/ω_R.
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
