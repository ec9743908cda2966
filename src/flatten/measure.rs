//! What flattening did to the cloth.

use super::Sheet;
use super::distortion::stretches;
use super::element::Element;
use super::overlap::rim_crossings;
use super::relax::Outcome;
use crate::geometry::{TriMesh, Vec2};

/// What happened to one flat piece. Lengths in metres, areas in square metres, errors as fractions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Report {
    /// Energy at the end: about the mean square strain, plus what the mode weighs besides.
    pub energy: f64,
    /// Steps taken.
    pub iterations: usize,
    /// Whether the tolerance was met; if not, the result is still free of flips.
    pub converged: bool,
    /// Area in space.
    pub area_before: f64,
    /// Area of the flat piece.
    pub area_after: f64,
    /// Length of all rims in space.
    pub boundary_before: f64,
    /// Length of all rims of the flat piece.
    pub boundary_after: f64,
    /// Length the rims were meant to get: that in space, but for seams with ease, gather or stretch.
    pub boundary_target: f64,
    /// |area after − before| / before.
    pub area_error: f64,
    /// |boundary after − before| / before.
    pub boundary_error: f64,
    /// Largest |length after − before| / before of a single mesh edge.
    pub largest_edge_error: f64,
    /// Largest |length after − target| / target of a single rim edge.
    pub largest_rim_error: f64,
    /// Root mean square (by area) of the triangles' stretches minus one, both directions together.
    pub distortion: f64,
    /// Root mean square (by area) of the triangles' relative change of area.
    pub area_distortion: f64,
    /// Flipped triangles: always 0.
    pub flips: usize,
    /// Crossings of the flat rims: 0 unless the piece lies on itself.
    pub overlaps: usize,
}

/// Length of an edge in space.
pub(super) fn length(surface: &TriMesh, ends: [u32; 2]) -> f64 {
    (surface.vertices[ends[1] as usize] - surface.vertices[ends[0] as usize]).norm()
}

pub(super) fn report(sheet: &Sheet<'_>, flat: &[Vec2], outcome: &Outcome) -> Report {
    let (surface, topology) = (sheet.surface, &sheet.topology);
    let flat_length = |ends: [u32; 2]| (flat[ends[1] as usize] - flat[ends[0] as usize]).norm();
    let error = |after: f64, before: f64| (after - before).abs() / before;
    let area_before = surface.area();
    let boundary_before = topology.rim_edges().map(|e| length(surface, e.ends)).sum();
    let boundary_after = topology.rim_edges().map(|e| flat_length(e.ends)).sum();
    let areas = Areas::of(surface, flat);
    let edges = topology.edges.iter().map(|e| error(flat_length(e.ends), length(surface, e.ends)));
    let rim = topology.rim_edges().zip(&sheet.rim_targets).map(|(e, &target)| error(flat_length(e.ends), target));
    Report {
        energy: outcome.energy,
        iterations: outcome.iterations,
        converged: outcome.converged,
        area_before,
        area_after: areas.total,
        boundary_before,
        boundary_after,
        boundary_target: sheet.rim_targets.iter().sum(),
        area_error: error(areas.total, area_before),
        boundary_error: error(boundary_after, boundary_before),
        largest_edge_error: edges.fold(0.0, f64::max),
        largest_rim_error: rim.fold(0.0, f64::max),
        distortion: (areas.stretch / area_before).sqrt(),
        area_distortion: (areas.change / area_before).sqrt(),
        flips: areas.flips,
        overlaps: rim_crossings(flat, &sheet.rims),
    }
}

/// Sums over the triangles.
#[derive(Default)]
struct Areas {
    total: f64,
    flips: usize,
    /// Σ A ((σ₁−1)² + (σ₂−1)²).
    stretch: f64,
    /// Σ A (det J − 1)².
    change: f64,
}

impl Areas {
    fn of(surface: &TriMesh, flat: &[Vec2]) -> Self {
        let mut sums = Self::default();
        for (t, &corners) in surface.triangles.iter().enumerate() {
            let element = Element::new(corners, surface.corners(t));
            let jacobian = element.jacobian(flat);
            let det = jacobian.determinant();
            let (larger, smaller) = stretches(&jacobian);
            sums.total += element.area * det;
            sums.flips += usize::from(det <= 0.0 || det.is_nan());
            sums.stretch += element.area * ((larger - 1.0).powi(2) + (smaller - 1.0).powi(2));
            sums.change += element.area * (det - 1.0).powi(2);
        }
        sums
    }
}
