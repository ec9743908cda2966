//! Patches of cloth: the leaves of the tree in which near pairs are looked for.

use std::collections::{HashMap, HashSet};

use crate::geometry::{Topology, Vec2, box_of, sorted_pair};

/// Triangles per leaf of the tree: few enough for tight boxes, enough that the tree costs little.
const PATCH: usize = 10;
/// Angle of cloth round a rim particle, radians (315°), from which it is the end of a slit or a narrow dart. The sides
/// of a slit may slide over each other without turning a normal.
const SLIT: f64 = 5.5;

/// Some triangles of one piece that are connected, with the nodes and edges that belong to no patch before it.
pub(super) struct ClothPatch {
    pub(super) piece: u32,
    pub(super) triangles: Vec<u32>,
    pub(super) nodes: Vec<u32>,
    pub(super) edges: Vec<[u32; 2]>,
    /// Patches that it shares a particle with, and itself, sorted.
    pub(super) beside: Vec<u32>,
    /// Whether a slit ends in it.
    pub(super) slit: bool,
}

/// The patches of `triangles` over nodes. `flat[t]` are the flat corners of triangle t and `piece[t]` its piece.
pub(super) fn patches(triangles: &[[u32; 3]], flat: &[[Vec2; 3]], piece: &[u32]) -> Vec<ClothPatch> {
    let centers: Vec<Vec2> = flat.iter().map(|c| (c[0] + c[1] + c[2]) / 3.0).collect();
    let mut order: Vec<u32> = (0..triangles.len() as u32).collect();
    order.sort_by_key(|&t| piece[t as usize]);
    let mut leaves = Vec::new();
    for group in order.chunk_by_mut(|&a, &b| piece[a as usize] == piece[b as usize]) {
        split(group, &centers, &mut leaves);
    }
    let corners = particles(triangles, flat, piece);
    let leaves = leaves.iter().flat_map(|leaf| connected(leaf, &corners)).collect();
    let mut patches = own_primitives(leaves, triangles, piece);
    find_beside(&mut patches, &corners);
    find_slits(&mut patches, &corners, flat);
    patches
}

/// Halves a group of triangles across its longer side until it is small.
fn split(group: &mut [u32], centers: &[Vec2], leaves: &mut Vec<Vec<u32>>) {
    if group.len() <= PATCH {
        leaves.push(group.to_vec());
        return;
    }
    let [low, high] = box_of(group.iter().map(|&t| centers[t as usize]));
    let axis = usize::from((high - low).y > (high - low).x);
    group.sort_by(|&a, &b| centers[a as usize][axis].total_cmp(&centers[b as usize][axis]).then(a.cmp(&b)));
    let (left, right) = group.split_at_mut(group.len() / 2);
    split(left, centers, leaves);
    split(right, centers, leaves);
}

/// Gives every node and every edge to the first patch that has it.
fn own_primitives(leaves: Vec<Vec<u32>>, triangles: &[[u32; 3]], piece: &[u32]) -> Vec<ClothPatch> {
    let topology = Topology::new(triangles);
    let nodes = triangles.iter().flatten().max().map_or(0, |&n| n as usize + 1);
    let mut node_owned = vec![false; nodes];
    let mut edge_owned = vec![false; topology.edges.len()];
    let mut patches = Vec::with_capacity(leaves.len());
    for leaf in leaves {
        let (nodes, edges, beside) = (Vec::new(), Vec::new(), Vec::new());
        let mut patch = ClothPatch { piece: 0, triangles: leaf, nodes, edges, beside, slit: false };
        for &t in &patch.triangles {
            let tri = triangles[t as usize];
            patch.piece = piece[t as usize];
            for k in 0..3 {
                if !std::mem::replace(&mut node_owned[tri[k] as usize], true) {
                    patch.nodes.push(tri[k]);
                }
                let ends = sorted_pair([tri[k], tri[(k + 1) % 3]]);
                let Ok(e) = topology.edges.binary_search_by(|x| x.ends.cmp(&ends)) else { continue };
                if !std::mem::replace(&mut edge_owned[e], true) {
                    patch.edges.push(ends);
                }
            }
        }
        patches.push(patch);
    }
    patches
}

/// The particles of every triangle, numbered. A particle is a node at one place of one flat piece. Two rims that meet
/// in a seam have one node there, and two particles.
fn particles(triangles: &[[u32; 3]], flat: &[[Vec2; 3]], piece: &[u32]) -> Vec<[u32; 3]> {
    let mut number: HashMap<(u32, u32, [u64; 2]), u32> = HashMap::new();
    let particle = |t: usize, k: usize| {
        let at = flat[t][k];
        (piece[t], triangles[t][k], [at.x.to_bits(), at.y.to_bits()])
    };
    let mut numbered = |t: usize, k: usize| {
        let next = number.len() as u32;
        *number.entry(particle(t, k)).or_insert(next)
    };
    (0..triangles.len()).map(|t| [numbered(t, 0), numbered(t, 1), numbered(t, 2)]).collect()
}

/// Connected parts of a group of triangles: both sides of a slit are near each other, but not connected.
fn connected(group: &[u32], corners: &[[u32; 3]]) -> Vec<Vec<u32>> {
    let shared = |s: u32, t: u32| {
        let of = |t: u32| corners[t as usize];
        of(s).iter().filter(|p| of(t).contains(p)).count()
    };
    let mut left = group.to_vec();
    let mut out = Vec::new();
    while let Some(first) = left.first().copied() {
        let mut part = vec![first];
        left.remove(0);
        let mut at = 0;
        while at < part.len() {
            let (beside, others) = left.iter().partition(|t| shared(part[at], **t) == 2);
            part.extend::<Vec<u32>>(beside);
            (left, at) = (others, at + 1);
        }
        out.push(part);
    }
    out
}

/// Finds the patches that share particles. Patches that meet in a seam only (the ends of a band, the sides of a sleeve)
/// may slide over each other.
fn find_beside(patches: &mut [ClothPatch], corners: &[[u32; 3]]) {
    let mut at: HashMap<u32, Vec<u32>> = HashMap::new();
    for (number, patch) in patches.iter().enumerate() {
        for particle in patch.triangles.iter().flat_map(|&t| corners[t as usize]) {
            let at = at.entry(particle).or_default();
            if at.last() != Some(&(number as u32)) {
                at.push(number as u32);
            }
        }
    }
    for patch in patches {
        let of = |&t: &u32| corners[t as usize].into_iter().flat_map(|particle| at[&particle].iter().copied());
        patch.beside = patch.triangles.iter().flat_map(of).collect();
        patch.beside.sort_unstable();
        patch.beside.dedup();
    }
}

/// Finds the patches in which a slit ends.
fn find_slits(patches: &mut [ClothPatch], corners: &[[u32; 3]], flat: &[[Vec2; 3]]) {
    let mut around: HashMap<u32, f64> = HashMap::new();
    for (tri, at) in corners.iter().zip(flat) {
        for k in 0..3 {
            let (u, v) = (at[(k + 1) % 3] - at[k], at[(k + 2) % 3] - at[k]);
            *around.entry(tri[k]).or_default() += u.angle(&v);
        }
    }
    let topology = Topology::new(corners);
    let ends: HashSet<u32> = topology.rim_edges().flat_map(|e| e.ends).filter(|p| around[p] >= SLIT).collect();
    for patch in patches {
        patch.slit = patch.triangles.iter().flat_map(|&t| corners[t as usize]).any(|p| ends.contains(&p));
    }
}
