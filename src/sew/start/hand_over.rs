//! From the nodes of the inflated surface to a start of all particles: what lies on other cloth is laid on it.

use super::glue::Glued;
use crate::geometry::{TriMesh, Vec2, Vec3};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;
use crate::sew::place::ring::LAYER;

/// What laps over comes down to what it laps over within this length beyond the lap, metres.
const RAMP: f64 = 0.03;
/// A seam's direction is read over so many stitches on either side.
const ALONG: usize = 2;

/// Where every particle starts when the nodes of the glued surface are at `nodes`.
pub(super) fn particles(garment: &Garment, mesh: &ClothMesh, glued: &Glued, nodes: &[Vec3]) -> Vec<Vec3> {
    let mut x: Vec<Option<Vec3>> = glued.node_of.iter().map(|n| n.map(|n| nodes[n as usize])).collect();
    let outward = normals(mesh, glued, nodes);
    follow(glued, &outward, &mut x);
    let mut left: Vec<usize> = glued.left_out.clone();
    left.sort_by_key(|piece| (garment.pieces[*piece].layer.unsigned_abs(), *piece));
    // A piece may be sewn to others that are left out only: these come first.
    while let Some(k) = left.iter().position(|piece| lay(garment, mesh, *piece, &mut x)) {
        left.remove(k);
    }
    lift(mesh, glued, &outward, &mut x);
    let middle = nodes.iter().sum::<Vec3>() / nodes.len().max(1) as f64;
    x.into_iter().map(|p| p.unwrap_or(middle)).collect()
}

/// The direction out of the right side of the cloth at every particle of the surface.
fn normals(mesh: &ClothMesh, glued: &Glued, nodes: &[Vec3]) -> Vec<Vec3> {
    let surface = TriMesh { vertices: nodes.to_vec(), triangles: glued.triangles.clone() };
    let of_nodes = surface.vertex_normals();
    (0..mesh.flat.len()).map(|p| glued.node_of[p].map_or_else(Vec3::zeros, |n| -of_nodes[n as usize])).collect()
}

/// Puts what is turned over or laid in a pleat on the cloth that it lies on.
fn follow(glued: &Glued, outward: &[Vec3], x: &mut [Option<Vec3>]) {
    let from = x.to_vec();
    for (p, follow) in glued.follows.iter().enumerate() {
        let Some(follow) = follow else { continue };
        let Some(corners) = at_all(&from, follow.corners) else { continue };
        let mix = |of: [Vec3; 3]| -> Vec3 { of.iter().zip(follow.weights).map(|(v, w)| v * w).sum() };
        let way = mix(follow.corners.map(|c| outward[c as usize])).try_normalize(0.0).unwrap_or_default();
        x[p] = Some(mix(corners) + way * (follow.layers * LAYER));
    }
}

/// Positions of three particles that have one.
fn at_all(x: &[Option<Vec3>], corners: [u32; 3]) -> Option<[Vec3; 3]> {
    let [a, b, c] = corners.map(|c| x[c as usize]);
    Some([a?, b?, c?])
}

/// A stitch of a piece that is laid: where it lies flat and in space, and the directions along the seam and across it.
struct Stitch {
    flat: Vec2,
    flat_along: Vec2,
    place: Vec3,
    along: Vec3,
    across: Vec3,
    outward: Vec3,
    layers: f64,
}

/// Lays a piece from its seams over the cloth that it is sewn to. Returns whether it is sewn to any that has a place.
fn lay(garment: &Garment, mesh: &ClothMesh, piece: usize, x: &mut [Option<Vec3>]) -> bool {
    let stitches = stitches(garment, mesh, piece, x);
    if stitches.is_empty() {
        return false;
    }
    let own = &mesh.pieces[piece];
    let middle = own.particles.clone().map(|p| mesh.flat[p]).sum::<Vec2>() / own.particles.len() as f64;
    for p in own.particles.clone() {
        let flat = mesh.flat[p];
        let far = |s: &Stitch| (s.flat - flat).norm_squared();
        let Some(near) = stitches.iter().min_by(|a, b| far(a).total_cmp(&far(b))) else { continue };
        // Across the seam towards the piece's own cloth.
        let across = Vec2::new(-near.flat_along.y, near.flat_along.x);
        let across = across * across.dot(&(middle - near.flat)).signum();
        let off = flat - near.flat;
        let on_host = near.along * off.dot(&near.flat_along) + near.across * off.dot(&across);
        x[p] = Some(near.place + on_host + near.outward * (near.layers * LAYER));
    }
    true
}

/// The stitches of a piece with cloth that has a place.
fn stitches(garment: &Garment, mesh: &ClothMesh, piece: usize, x: &[Option<Vec3>]) -> Vec<Stitch> {
    let own = |p: u32| mesh.pieces[piece].particles.contains(&(p as usize));
    let mut out = Vec::new();
    for seam in &mesh.seams {
        let side = |k: usize| seam.pairs.iter().all(|pair| own(pair[k]) && !own(pair[1 - k]));
        let Some(k) = (0..2).find(|&k| side(k)) else { continue };
        for i in 0..seam.pairs.len() {
            let (low, high) = (i.saturating_sub(ALONG), (i + ALONG).min(seam.pairs.len() - 1));
            let [p, q] = [seam.pairs[i][k], seam.pairs[i][1 - k]];
            let of_host = [seam.pairs[low], seam.pairs[high]].map(|pair| x[pair[1 - k] as usize]);
            let ([Some(from), Some(to)], Some(place), Some(host)) = (of_host, x[q as usize], mesh.piece_of(q)) else {
                continue;
            };
            let flat = |pair: [u32; 2]| mesh.flat[pair[k] as usize];
            let flat_along = (flat(seam.pairs[high]) - flat(seam.pairs[low])).try_normalize(0.0);
            let (Some(along), Some(flat_along)) = ((to - from).try_normalize(0.0), flat_along) else { continue };
            let Some((across, outward)) = beside(mesh, host, q, along, x) else { continue };
            let layers = garment.pieces[piece].layer.saturating_sub(garment.pieces[host].layer);
            let layers = if layers == 0 { 1.0 } else { f64::from(layers) };
            out.push(Stitch { flat: mesh.flat[p as usize], flat_along, place, along, across, outward, layers });
        }
    }
    out
}

/// The directions across a seam into the host's cloth, and out of its right side, at one of its particles.
fn beside(mesh: &ClothMesh, host: usize, q: u32, along: Vec3, x: &[Option<Vec3>]) -> Option<(Vec3, Vec3)> {
    let (mut inward, mut outward) = (Vec3::zeros(), Vec3::zeros());
    for t in mesh.triangles[mesh.pieces[host].triangles.clone()].iter().filter(|t| t.contains(&q)) {
        let [a, b, c] = at_all(x, *t)?;
        outward += (c - a).cross(&(b - a));
        inward += (a + b + c) / 3.0 - x[q as usize]?;
    }
    let across = (inward - along * inward.dot(&along)).try_normalize(1e-12)?;
    let outward = (outward - along * outward.dot(&along) - across * outward.dot(&across)).try_normalize(0.0)?;
    Some((across, outward))
}

/// Lifts what laps over off what it laps over, so that it can slide there.
fn lift(mesh: &ClothMesh, glued: &Glued, outward: &[Vec3], x: &mut [Option<Vec3>]) {
    for lap in &glued.laps {
        let rim: Vec<Vec2> = lap.pairs.iter().map(|[over, _]| mesh.flat[*over as usize]).collect();
        for p in mesh.pieces[lap.over].particles.clone() {
            let far = rim.iter().map(|r| (r - mesh.flat[p]).norm()).fold(f64::INFINITY, f64::min);
            let share = ((lap.reach + RAMP - far) / RAMP).clamp(0.0, 1.0);
            if let Some(x) = &mut x[p] {
                *x += outward[p] * (LAYER * share);
            }
        }
    }
}
