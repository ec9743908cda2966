//! A first flat position without flipped triangles.

use std::f64::consts::{PI, TAU};

use super::FlattenError;
use super::harmonic::{GraphWeights, Laplacian};
use crate::geometry::{Topology, TriMesh, Vec2, Vec3};

/// A first flat position, and the logarithm of the scale at every vertex of the conformal map that keeps the rim's
/// lengths; no scales where that map cannot be computed.
pub(super) type Start = (Vec<Vec2>, Vec<f64>);

/// Where a map leaves a triangle less than this share of its area, it is squeezed. A conformal map does that to the tip
/// of a pointed cone, and the curvature of the energy is more there than numbers hold: nothing leads down any more.
/// With a half angle of 14° a cone came down from 4·10⁻⁹, with one of 12° not from 10⁻¹⁰; with one of 20° it did from
/// 4·10⁻⁶, but from a circle in half the steps.
const SQUEEZED: f64 = 1e-4;

/// Lays a disk flat: conformally with the rim's own lengths if that flips and squeezes nothing, else onto a circle if
/// that squeezes less.
///
/// # Errors
/// If even the map onto a circle has a triangle without area (rounding in a very large or uneven mesh).
pub(super) fn start(surface: &TriMesh, topology: &Topology, rim: &[u32]) -> Result<Start, FlattenError> {
    let on_rim = marked(surface, rim);
    let (flat, scale) = boundary_first(surface, topology, rim, &on_rim).unwrap_or_default();
    let kept = if flat.is_empty() { 0.0 } else { least_share(surface, &flat) };
    if kept > SQUEEZED {
        return Ok((flat, scale));
    }
    let circle = onto_circle(surface, topology, rim, &on_rim);
    if kept > circle.as_ref().map_or(0.0, |circle| least_share(surface, circle).max(0.0)) {
        return Ok((flat, scale));
    }
    let circle = circle?;
    match first_flipped(&surface.triangles, &circle) {
        None => Ok((circle, scale)),
        Some(t) => Err(FlattenError::FlippedStart(t)),
    }
}

/// The smallest share of its area that a triangle has in the plane; not above zero where one is turned over.
fn least_share(surface: &TriMesh, flat: &[Vec2]) -> f64 {
    let share = |(t, corners): (usize, &[u32; 3])| {
        let ([a, b, c], [p, q, r]) = (corners.map(|v| flat[v as usize]), surface.corners(t));
        let share = (b - a).perp(&(c - a)) / (q - p).cross(&(r - p)).norm();
        if share.is_nan() { 0.0 } else { share }
    };
    surface.triangles.iter().enumerate().map(share).fold(f64::INFINITY, f64::min)
}

/// The first triangle whose area is not positive.
pub(super) fn first_flipped(triangles: &[[u32; 3]], flat: &[Vec2]) -> Option<usize> {
    triangles.iter().position(|t| {
        let [a, b, c] = t.map(|v| flat[v as usize]);
        let area = (b - a).perp(&(c - a));
        area <= 0.0 || area.is_nan()
    })
}

/// Boundary-first flattening with free angles and fixed rim lengths (Sawhney & Crane 2017, sections 4.1, 4.3 and 6):
/// scale factor 0 along the rim, hence lengths exact up to closing the curve.
fn boundary_first(surface: &TriMesh, topology: &Topology, rim: &[u32], on_rim: &[bool]) -> Result<Start, FlattenError> {
    let laplacian = Laplacian::new(surface, topology, on_rim, GraphWeights::Cotangent)?;
    let angles = angle_sums(surface);
    let scale = yamabe(&laplacian, &angles);
    // Cherrier: the rim's curvature changes by the normal derivative of u.
    let flux = laplacian.apply(&scale);
    let turning: Vec<f64> = rim.iter().map(|&v| PI - angles[v as usize] + flux[v as usize]).collect();
    let lengths: Vec<f64> = rim_lengths(surface, rim);
    let outline = closed_curve(&lengths, &turning);
    Ok((extend(&laplacian, surface.vertices.len(), rim, &outline), scale))
}

/// The u with Δu = K inside and u = 0 on the rim (Yamabe). A is −Δ, integrated.
fn yamabe(laplacian: &Laplacian, angles: &[f64]) -> Vec<f64> {
    let source: Vec<f64> = angles.iter().map(|a| a - TAU).collect();
    let mut scale = vec![0.0; angles.len()];
    laplacian.solve(&source, [&mut scale]);
    scale
}

fn marked(surface: &TriMesh, rim: &[u32]) -> Vec<bool> {
    let mut on_rim = vec![false; surface.vertices.len()];
    for &v in rim {
        on_rim[v as usize] = true;
    }
    on_rim
}

/// Tutte's map onto a circle of the surface's area, rim vertices spaced by their lengths.
fn onto_circle(
    surface: &TriMesh,
    topology: &Topology,
    rim: &[u32],
    on_rim: &[bool],
) -> Result<Vec<Vec2>, FlattenError> {
    let laplacian = Laplacian::new(surface, topology, on_rim, GraphWeights::Uniform)?;
    let lengths = rim_lengths(surface, rim);
    let total: f64 = lengths.iter().sum();
    let radius = (surface.area() / PI).sqrt();
    let mut at = 0.0;
    let circle = lengths.iter().map(|length| {
        let (sine, cosine) = (TAU * at / total).sin_cos();
        at += length;
        Vec2::new(cosine, sine) * radius
    });
    let circle: Vec<Vec2> = circle.collect();
    Ok(extend(&laplacian, surface.vertices.len(), rim, &circle))
}

fn extend(laplacian: &Laplacian, vertices: usize, rim: &[u32], outline: &[Vec2]) -> Vec<Vec2> {
    let mut coordinates = [vec![0.0; vertices], vec![0.0; vertices]];
    for (&v, p) in rim.iter().zip(outline) {
        coordinates[0][v as usize] = p.x;
        coordinates[1][v as usize] = p.y;
    }
    let [x, y] = &mut coordinates;
    laplacian.solve(&vec![0.0; vertices], [x, y]);
    let [x, y] = coordinates;
    x.into_iter().zip(y).map(|(x, y)| Vec2::new(x, y)).collect()
}

/// Length of the rim edge from each rim vertex to the next.
fn rim_lengths(surface: &TriMesh, rim: &[u32]) -> Vec<f64> {
    let at = |k: usize| surface.vertices[rim[k % rim.len()] as usize];
    (0..rim.len()).map(|k| (at(k + 1) - at(k)).norm()).collect()
}

/// Sum of the triangles' angles at every vertex.
pub(super) fn angle_sums(surface: &TriMesh) -> Vec<f64> {
    let mut sums = vec![0.0; surface.vertices.len()];
    for (t, corners) in surface.triangles.iter().enumerate() {
        for (&corner, angle) in corners.iter().zip(angles(surface.corners(t))) {
            sums[corner as usize] += angle;
        }
    }
    sums
}

/// The angles of a triangle, at each of its corners.
pub(super) fn angles(p: [Vec3; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let (u, v) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
        u.cross(&v).norm().atan2(u.dot(&v))
    })
}

/// The polygon with the given edge lengths that turns by `turning[k]` at its vertex k, lengths changed by the least
/// amount (relative to each length) that closes it (the paper's equation 18).
fn closed_curve(lengths: &[f64], turning: &[f64]) -> Vec<Vec2> {
    let mut heading = 0.0;
    let mut tangents = Vec::with_capacity(lengths.len());
    for turn in turning {
        heading += turn;
        tangents.push(Vec2::new(f64::cos(heading), f64::sin(heading)));
    }
    let mut gap = Vec2::zeros();
    let mut spread = nalgebra::Matrix2::zeros();
    for (t, &l) in tangents.iter().zip(lengths) {
        gap += t * l;
        spread += t * t.transpose() * l;
    }
    let correction = spread.try_inverse().map_or(Vec2::zeros(), |inverse| inverse * gap);
    let mut at = Vec2::zeros();
    let points = tangents.iter().zip(lengths).map(|(t, &l)| {
        let here = at;
        at += t * (l * (1.0 - t.dot(&correction)));
        here
    });
    points.collect()
}
