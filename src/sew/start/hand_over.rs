//! From the nodes of the inflated surface to a start of all particles: what lies on other cloth is laid on it.

use super::cover::into;
use super::glue::{Beyond, Follow, Glued};
use crate::geometry::{Locator, TriMesh, Vec2, Vec3};
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::Garment;
use crate::sew::Stitching;
use crate::sew::place::ring::LAYER;

/// A seam's direction is read over so many stitches on either side.
const ALONG: usize = 2;

/// Where every particle starts when the nodes of the glued surface are at `nodes`.
pub(super) fn particles(garment: &Garment, mesh: &ClothMesh, glued: &Glued, nodes: &[Vec3]) -> Vec<Vec3> {
    let mut x: Vec<Option<Vec3>> = glued.node_of.iter().map(|n| n.map(|n| nodes[n as usize])).collect();
    let outward = normals(mesh, glued, nodes);
    let covered = glued.laps.iter().flat_map(|lap| &lap.covered).map(|(p, on)| (*p as usize, *on)).collect();
    let hidden = glued.follows.iter().enumerate().filter_map(|(p, on)| Some((p, (*on)?))).collect();
    let mut outward = outward;
    follow(covered, &mut outward, &mut x);
    lift(mesh, glued, &outward, &mut x);
    follow(hidden, &mut outward, &mut x);
    hang(garment, mesh, glued, &mut x);
    let mut left: Vec<usize> = glued.left_out.clone();
    left.sort_by_key(|piece| (garment.pieces[*piece].layer.unsigned_abs(), *piece));
    // A piece may be sewn to others that are left out only: these come first.
    while let Some(k) = left.iter().position(|piece| lay(garment, mesh, *piece, &mut x)) {
        left.remove(k);
    }
    let middle = nodes.iter().sum::<Vec3>() / nodes.len().max(1) as f64;
    x.into_iter().map(|p| p.unwrap_or(middle)).collect()
}

/// The direction out of the right side of the cloth at every particle of the surface.
fn normals(mesh: &ClothMesh, glued: &Glued, nodes: &[Vec3]) -> Vec<Vec3> {
    let surface = TriMesh { vertices: nodes.to_vec(), triangles: glued.triangles.clone() };
    let of_nodes = surface.vertex_normals();
    (0..mesh.flat.len()).map(|p| glued.node_of[p].map_or_else(Vec3::zeros, |n| -of_nodes[n as usize])).collect()
}

/// Puts particles on the cloth that they lie on, which may lie on other cloth itself.
fn follow(mut left: Vec<(usize, Follow)>, outward: &mut [Vec3], x: &mut [Option<Vec3>]) {
    left.iter().for_each(|(p, _)| x[*p] = None);
    loop {
        let before = left.len();
        let from = x.to_vec();
        left.retain(|(p, follow)| {
            let Some(corners) = at_all(&from, follow.corners) else { return true };
            let mix = |of: [Vec3; 3]| -> Vec3 { of.iter().zip(follow.weights).map(|(v, w)| v * w).sum() };
            let way = mix(follow.corners.map(|c| outward[c as usize])).try_normalize(0.0).unwrap_or_default();
            x[*p] = Some(mix(corners) + way * (follow.layers * LAYER));
            outward[*p] = way;
            false
        });
        if left.len() == before || left.is_empty() {
            return;
        }
    }
}

/// Positions of three particles that have one.
fn at_all(x: &[Option<Vec3>], corners: [u32; 3]) -> Option<[Vec3; 3]> {
    let [a, b, c] = corners.map(|c| x[c as usize]);
    Some([a?, b?, c?])
}

/// A stitch of a piece that is laid, with the directions along the seam and across it: flat, flat on the host and in
/// space. Across goes into the host's cloth.
struct Stitch {
    flat: Vec2,
    flat_along: Vec2,
    host: usize,
    host_flat: Vec2,
    host_along: Vec2,
    host_across: Vec2,
    place: Vec3,
    along: Vec3,
    across: Vec3,
    outward: Vec3,
    layers: f64,
}

/// What pieces are laid on: the cloth that has a place already.
struct Hosts<'a> {
    garment: &'a Garment,
    mesh: &'a ClothMesh,
    /// The triangles of every piece of which all corners have a place.
    grounds: Vec<Option<Locator<'a>>>,
}

/// For every piece its triangles of which all corners have a place.
fn open(mesh: &ClothMesh, x: &[Option<Vec3>]) -> Vec<Vec<[u32; 3]>> {
    let has_place = |t: &&[u32; 3]| t.iter().all(|p| x[*p as usize].is_some());
    let of_piece = |piece: &PieceMesh| mesh.triangles[piece.triangles.clone()].iter().filter(has_place).copied();
    mesh.pieces.iter().map(|piece| of_piece(piece).collect()).collect()
}

impl<'a> Hosts<'a> {
    fn new(garment: &'a Garment, mesh: &'a ClothMesh, open: &'a [Vec<[u32; 3]>]) -> Self {
        let ground = |open: &'a Vec<[u32; 3]>| (!open.is_empty()).then(|| Locator::new(&mesh.flat, open, mesh.spacing));
        Self { garment, mesh, grounds: open.iter().map(ground).collect() }
    }

    /// The place of what is so far along a seam from a stitch and across it into the host's cloth, metres, so many
    /// layers out of that.
    fn place(&self, near: &Stitch, [along, across]: [f64; 2], layers: f64, x: &[Option<Vec3>]) -> Vec3 {
        let straight_on = || near.place + near.along * along + near.across * across;
        let at = near.host_flat + near.host_along * along + near.host_across * across;
        let spot = self.grounds[near.host].as_ref().map(|ground| ground.place(at));
        let on_host = spot.and_then(|(corners, weights)| {
            let [a, b, c] = at_all(x, corners)?;
            let normal = (c - a).cross(&(b - a)).try_normalize(0.0)?;
            Some((a * weights[0] + b * weights[1] + c * weights[2], normal))
        });
        let (at, outward) = on_host.unwrap_or_else(|| (straight_on(), near.outward));
        at + outward * (layers * LAYER)
    }

    /// The stitches of a piece with cloth that has a place.
    fn stitches(&self, piece: usize, x: &[Option<Vec3>]) -> Vec<Stitch> {
        let (garment, mesh) = (self.garment, self.mesh);
        let own = |p: u32| mesh.pieces[piece].particles.contains(&(p as usize));
        let mut out = Vec::new();
        for seam in &mesh.seams {
            let side = |k: usize| seam.pairs.iter().all(|pair| own(pair[k]) && !own(pair[1 - k]));
            let Some(k) = (0..2).find(|&k| side(k)) else { continue };
            for i in 0..seam.pairs.len() {
                let (low, high) = (i.saturating_sub(ALONG), (i + ALONG).min(seam.pairs.len() - 1));
                let [p, q] = [seam.pairs[i][k], seam.pairs[i][1 - k]];
                let of_host = [seam.pairs[low], seam.pairs[high]].map(|pair| x[pair[1 - k] as usize]);
                let ([Some(from), Some(to)], Some(place), Some(host)) = (of_host, x[q as usize], mesh.piece_of(q))
                else {
                    continue;
                };
                let flat = |side: usize| {
                    let [a, b] = [low, high].map(|i| mesh.flat[seam.pairs[i][side] as usize]);
                    (b - a).try_normalize(0.0)
                };
                let (Some(along), Some(flat_along), Some(host_along)) =
                    ((to - from).try_normalize(0.0), flat(k), flat(1 - k))
                else {
                    continue;
                };
                let Some((across, outward)) = beside(mesh, host, q, along, x) else { continue };
                let layers = garment.pieces[piece].layer.saturating_sub(garment.pieces[host].layer);
                let layers = if layers == 0 { 1.0 } else { f64::from(layers) };
                let [flat, host_flat] = [p, q].map(|p| mesh.flat[p as usize]);
                let host_across = into(mesh, host, q, host_along);
                out.push(Stitch {
                    flat,
                    flat_along,
                    host,
                    host_flat,
                    host_along,
                    host_across,
                    place,
                    along,
                    across,
                    outward,
                    layers,
                });
            }
        }
        out
    }
}

/// The stitch nearest to a flat point.
fn nearest(stitches: &[Stitch], at: Vec2) -> Option<&Stitch> {
    let far = |s: &Stitch| (s.flat - at).norm_squared();
    stitches.iter().min_by(|a, b| far(a).total_cmp(&far(b)))
}

/// Lays a piece from its seams over the cloth that it is sewn to. Returns whether it is sewn to any that has a place.
fn lay(garment: &Garment, mesh: &ClothMesh, piece: usize, x: &mut [Option<Vec3>]) -> bool {
    let open = open(mesh, x);
    let hosts = Hosts::new(garment, mesh, &open);
    let stitches = hosts.stitches(piece, x);
    if stitches.is_empty() {
        return false;
    }
    let own = &mesh.pieces[piece];
    let middle = own.particles.clone().map(|p| mesh.flat[p]).sum::<Vec2>() / own.particles.len() as f64;
    for p in own.particles.clone() {
        let flat = mesh.flat[p];
        let Some(near) = nearest(&stitches, flat) else { continue };
        // Across the seam towards the piece's own cloth.
        let across = Vec2::new(-near.flat_along.y, near.flat_along.x);
        let across = across * across.dot(&(middle - near.flat)).signum();
        let off = flat - near.flat;
        x[p] = Some(hosts.place(near, [off.dot(&near.flat_along), off.dot(&across)], near.layers, x));
    }
    true
}

/// Puts what is turned over beyond the seam of its piece on the cloth beyond that seam, as a collar falls over its
/// stand.
fn hang(garment: &Garment, mesh: &ClothMesh, glued: &Glued, x: &mut [Option<Vec3>]) {
    for (i, piece) in mesh.pieces.iter().enumerate() {
        let is_own = |beyond: &&Beyond| piece.particles.contains(&(beyond.particle as usize));
        let own: Vec<&Beyond> = glued.beyond.iter().filter(is_own).collect();
        if own.is_empty() {
            continue;
        }
        let open = open(mesh, x);
        let hosts = Hosts::new(garment, mesh, &open);
        let stitches = hosts.stitches(i, x);
        for beyond in own {
            let Some(near) = nearest(&stitches, beyond.at) else { continue };
            let off = beyond.at - near.flat;
            let along = off.dot(&near.flat_along);
            let across = (off - near.flat_along * along).norm();
            x[beyond.particle as usize] = Some(hosts.place(near, [along, across], beyond.layers, x));
        }
    }
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

/// Lifts what laps over other cloth off it: the rim, and the cloth that covers, with all that is sewn to it. What is
/// sewn to the cloth below as well stays.
fn lift(mesh: &ClothMesh, glued: &Glued, outward: &[Vec3], x: &mut [Option<Vec3>]) {
    let class = Stitching::new(mesh).class;
    let class = |p: u32| class[p as usize] as usize;
    let mut plies = vec![0.0; x.len()];
    for lap in &glued.laps {
        let covering = lap.covered.iter().flat_map(|(_, on)| on.corners);
        lap.pairs.iter().map(|pair| pair[0]).chain(covering).for_each(|p| plies[class(p)] = lap.plies);
    }
    for lap in &glued.laps {
        let below = lap.covered.iter().map(|covered| covered.0);
        lap.pairs.iter().map(|pair| pair[1]).chain(below).for_each(|p| plies[class(p)] = 0.0);
    }
    for (p, x) in x.iter_mut().enumerate() {
        let plies = plies[class(p as u32)];
        if let Some(x) = x.as_mut().filter(|_| plies > 0.0) {
            *x += outward[p] * (LAYER * plies);
        }
    }
}
