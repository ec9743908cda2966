//! The errors that flattening leaves in the cloth.

use std::f64::consts::TAU;

use super::TargetSurface;
use super::distortion::stretches;
use super::element::FlatElement;
use super::overlap::crossings_beside;
use super::relax::Relaxed;
use super::start::angle_sums;
use super::woven;
use crate::geometry::{TriMesh, Vec2, Vec3};

/// Share of the area that may be strained more than [`FlatReport::strain_p99`] says: single triangles at a corner.
const LARGEST_SHARE: f64 = 0.01;

/// The errors of one flat piece. Lengths in metres, areas in square metres, errors as fractions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatReport {
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
    /// By which share, in the mean, the lengths are off that the mode was to hold on the rim ([`Mode::keeps_rim`]) and
    /// could not; `None` where it holds them, or none.
    ///
    /// [`Mode::keeps_rim`]: super::Mode::keeps_rim
    pub rim_missed: Option<f64>,
    /// Root mean square (by area) of the triangles' stretches minus one, both directions together.
    pub distortion: f64,
    /// Root mean square (by area) of the triangles' relative change of area.
    pub area_distortion: f64,
    /// Largest |stretch − 1| in any direction that all but a hundredth of the area stays below.
    pub strain_p99: f64,
    /// Largest stretch − 1 that all but a hundredth of the area stays below.
    pub stretch_p99: f64,
    /// Largest 1 − stretch that all but a hundredth of the area stays below.
    pub compression_p99: f64,
    /// The largest of any triangle.
    pub strain_max: f64,
    /// The strain of warp and weft.
    pub threads: Threads,
    /// Largest change of the rim's inner angle in one of its vertices, radians.
    pub corner_change: f64,
    /// The least that any flat piece has there: the curvature, spread evenly over the rim's vertices.
    pub corner_change_forced: f64,
    /// Total Gauss curvature inside the rim, radians: by this much less, all together, the rim's inner angles are flat.
    pub curvature: f64,
    /// Flipped triangles: always 0.
    pub flips: usize,
    /// Crossings of the flat rims: 0 unless the piece lies on itself.
    pub overlaps: usize,
}

/// Threads of the flat cloth as they lie on the surface in space.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Threads {
    /// Root mean square (by area) of the warp's stretch minus one.
    pub warp: f64,
    /// The same of the weft.
    pub weft: f64,
    /// Largest |stretch − 1| of the warp that all but a hundredth of the area stays below.
    pub warp_p99: f64,
    /// The same of the weft.
    pub weft_p99: f64,
    /// Root mean square (by area) of the change of the angle between them, radians.
    pub shear: f64,
    /// The largest of any triangle.
    pub shear_max: f64,
    /// A corner of that triangle.
    pub shear_at: u32,
}

impl Threads {
    fn of(sheet: &TargetSurface<'_>, flat: &[Vec2]) -> Self {
        let mut sums = Self::default();
        let mut strains = [const { Vec::new() }; 2];
        let mut area = 0.0;
        for (t, &corners) in sheet.surface.triangles.iter().enumerate() {
            let element = FlatElement::new(corners, sheet.surface.corners(t));
            let [warp, weft, shear] = woven::measured(&element.jacobian(flat), sheet.warp);
            strains[0].push([warp.abs(), element.area]);
            strains[1].push([weft.abs(), element.area]);
            sums.warp += element.area * warp * warp;
            sums.weft += element.area * weft * weft;
            sums.shear += element.area * shear * shear;
            if shear.abs() > sums.shear_max {
                (sums.shear_max, sums.shear_at) = (shear.abs(), corners[0]);
            }
            area += element.area;
        }
        let root = |sum: f64| (sum / area).sqrt();
        let [warp_p99, weft_p99] = strains.map(|mut strains| exceeded_by(LARGEST_SHARE, &mut strains));
        Self { warp: root(sums.warp), weft: root(sums.weft), warp_p99, weft_p99, shear: root(sums.shear), ..sums }
    }
}

/// Length of an edge in space.
pub(super) fn length(surface: &TriMesh, ends: [u32; 2]) -> f64 {
    (surface.vertices[ends[1] as usize] - surface.vertices[ends[0] as usize]).norm()
}

pub(super) fn report(sheet: &TargetSurface<'_>, flat: &[Vec2], outcome: &Relaxed) -> FlatReport {
    let (surface, topology) = (sheet.surface, &sheet.topology);
    let flat_length = |ends: [u32; 2]| (flat[ends[1] as usize] - flat[ends[0] as usize]).norm();
    let error = |after: f64, before: f64| (after - before).abs() / before;
    let area_before = surface.area();
    let boundary_before = topology.rim_edges().map(|e| length(surface, e.ends)).sum();
    let boundary_after = topology.rim_edges().map(|e| flat_length(e.ends)).sum();
    let mut areas = Areas::of(surface, flat);
    let angles = Angles::of(sheet, flat);
    let edges = topology.edges.iter().map(|e| error(flat_length(e.ends), length(surface, e.ends)));
    let rim = topology.rim_edges().zip(&sheet.rim_targets).map(|(e, &target)| error(flat_length(e.ends), target));
    FlatReport {
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
        rim_missed: None,
        distortion: (areas.stretch / area_before).sqrt(),
        area_distortion: (areas.change / area_before).sqrt(),
        strain_p99: exceeded_by(LARGEST_SHARE, &mut areas.strains),
        stretch_p99: exceeded_by(LARGEST_SHARE, &mut areas.stretched).max(0.0),
        compression_p99: exceeded_by(LARGEST_SHARE, &mut areas.compressed).max(0.0),
        strain_max: exceeded_by(0.0, &mut areas.strains),
        threads: Threads::of(sheet, flat),
        corner_change: angles.corner_change,
        corner_change_forced: angles.curvature.abs() / sheet.rims.iter().map(Vec::len).sum::<usize>() as f64,
        curvature: angles.curvature,
        flips: areas.flips,
        overlaps: crossings_beside(flat, &sheet.rims, &sheet.legs),
    }
}

/// Angles before and after.
struct Angles {
    corner_change: f64,
    curvature: f64,
}

impl Angles {
    fn of(sheet: &TargetSurface<'_>, flat: &[Vec2]) -> Self {
        let lifted = TriMesh {
            vertices: flat.iter().map(|p| Vec3::new(p.x, p.y, 0.0)).collect(),
            triangles: sheet.surface.triangles.clone(),
        };
        let (before, after) = (angle_sums(sheet.surface), angle_sums(&lifted));
        let mut curvature = TAU * before.len() as f64 - before.iter().sum::<f64>();
        let mut corner_change = 0.0;
        for &v in sheet.rims.iter().flatten() {
            curvature -= TAU - before[v as usize];
            corner_change = f64::max(corner_change, (after[v as usize] - before[v as usize]).abs());
        }
        Self { corner_change, curvature }
    }
}

/// Sums over the triangles.
struct Areas {
    total: f64,
    flips: usize,
    /// Σ A ((σ₁−1)² + (σ₂−1)²).
    stretch: f64,
    /// Σ A (det J − 1)².
    change: f64,
    /// Largest |σ − 1| and area of every triangle.
    strains: Vec<[f64; 2]>,
    /// Largest σ − 1 and area of every triangle.
    stretched: Vec<[f64; 2]>,
    /// Largest 1 − σ and area of every triangle.
    compressed: Vec<[f64; 2]>,
}

impl Areas {
    fn of(surface: &TriMesh, flat: &[Vec2]) -> Self {
        let room = || Vec::with_capacity(surface.triangles.len());
        let (strains, stretched, compressed) = (room(), room(), room());
        let mut sums = Self { total: 0.0, flips: 0, stretch: 0.0, change: 0.0, strains, stretched, compressed };
        for (t, &corners) in surface.triangles.iter().enumerate() {
            let element = FlatElement::new(corners, surface.corners(t));
            let jacobian = element.jacobian(flat);
            let det = jacobian.determinant();
            let (larger, smaller) = stretches(&jacobian);
            sums.total += element.area * det;
            sums.flips += usize::from(det <= 0.0 || det.is_nan());
            sums.stretch += element.area * ((larger - 1.0).powi(2) + (smaller - 1.0).powi(2));
            sums.change += element.area * (det - 1.0).powi(2);
            sums.strains.push([f64::max(larger - 1.0, 1.0 - smaller), element.area]);
            sums.stretched.push([larger - 1.0, element.area]);
            sums.compressed.push([1.0 - smaller, element.area]);
        }
        sums
    }
}

/// The strain that this share of the area passes, of strains with their areas.
fn exceeded_by(share: f64, strains: &mut [[f64; 2]]) -> f64 {
    strains.sort_unstable_by(|a, b| b[0].total_cmp(&a[0]));
    let mut left = share * strains.iter().map(|s| s[1]).sum::<f64>();
    let reached = strains.iter().find(|s| {
        left -= s[1];
        left < 0.0
    });
    reached.map_or(0.0, |s| s[0])
}

/// Signed strain of every triangle: the stretch furthest from one, minus one.
pub fn triangle_strain(surface: &TriMesh, flat: &[Vec2]) -> Vec<f64> {
    let strain = |(t, &corners): (usize, &[u32; 3])| {
        let (larger, smaller) = stretches(&FlatElement::new(corners, surface.corners(t)).jacobian(flat));
        if larger - 1.0 > 1.0 - smaller { larger - 1.0 } else { smaller - 1.0 }
    };
    surface.triangles.iter().enumerate().map(strain).collect()
}
