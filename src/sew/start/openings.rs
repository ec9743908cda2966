//! The openings of a glued surface.

use std::collections::{BTreeMap, HashMap};
use std::f64::consts::PI;

use super::backing::Backing;
use super::cloth::{Around, Distances};
use super::glue::Glued;
use crate::geometry::{Vec2, sorted_pair};
use crate::mesh::ClothMesh;

/// The least curve that is parallel to a rim is looked for within this distance, metres.
const NEAR: f64 = 0.2;
/// And no further than this share of the way to the next opening.
const SHARE: f64 = 0.45;
/// Curves are this far apart, metres.
const STEP: f64 = 0.01;
/// A rim of fewer nodes is a gap between two rims with unlike numbers of particles that are welded to each other.
const LEAST: usize = 5;

/// An opening of the glued surface.
#[derive(Clone, Debug)]
pub struct GluedOpening {
    /// Nodes of its rim in order, as the triangles run.
    pub rim: Vec<u32>,
    /// The particles of every side of the rim, on the piece that has it: from each node to the next.
    pub sides: Vec<[u32; 2]>,
    /// Connected part.
    pub part: u32,
    /// Length of the rim, metres.
    pub length: f64,
    /// Length of the shortest curve parallel to the rim within 200 mm of it, metres.
    pub girth: f64,
    /// By how much the rim turns towards the cloth, radians: 0 at the end of a tube, −2π round a hole of a flat sheet,
    /// 2π round the sheet itself.
    pub turning: f64,
    /// Whether pieces that are left out of the surface close it, as a bag does behind the mouth of a pocket.
    pub is_backed: bool,
}

/// The openings of a glued surface, in the order of their first nodes.
pub fn openings(glued: &Glued, mesh: &ClothMesh) -> Vec<GluedOpening> {
    let cloth = Distances::new(glued, mesh);
    let particles = side_particles(glued);
    let backing = Backing::new(&glued.left_out, mesh);
    let rims: Vec<Vec<u32>> = rims(glued).into_iter().filter(|rim| rim.len() >= LEAST).collect();
    let fields: Vec<Vec<f64>> = rims.iter().map(|rim| cloth.from(rim)).collect();
    let opening = |(i, rim): (usize, &Vec<u32>)| {
        let others = rims.iter().enumerate().filter(|(j, _)| *j != i).flat_map(|(_, other)| other);
        let next = others.map(|&n| fields[i][n as usize]).fold(f64::INFINITY, f64::min);
        let ways = (0..rim.len()).map(|k| [rim[k], rim[(k + 1) % rim.len()]]);
        let sides: Vec<[u32; 2]> = ways.filter_map(|way| particles.get(&way).copied()).collect();
        let step = |[a, b]: &[u32; 2]| (mesh.flat[*b as usize] - mesh.flat[*a as usize]).norm();
        let length: f64 = sides.iter().map(step).sum();
        let girth = least_parallel(glued, &cloth, &fields[i], NEAR.min(SHARE * next)).map_or(length, |g| g.min(length));
        let turning = rim.iter().map(|n| PI - cloth.angle(*n)).sum();
        let is_backed = backing.closes(&sides);
        GluedOpening {
            rim: rim.clone(),
            sides,
            part: glued.part_of[rim[0] as usize],
            length,
            girth,
            turning,
            is_backed,
        }
    };
    rims.iter().enumerate().map(opening).collect()
}

/// The particles of every directed side of a triangle.
fn side_particles(glued: &Glued) -> HashMap<[u32; 2], [u32; 2]> {
    let sides = glued
        .triangles
        .iter()
        .zip(&glued.corners)
        .flat_map(|(nodes, own)| [[0, 1], [1, 2], [2, 0]].map(|[a, b]| ([nodes[a], nodes[b]], [own[a], own[b]])));
    sides.collect()
}

/// The rims as rings of nodes. A rim that comes twice through a node is followed along its fan of triangles.
pub(super) fn rims(glued: &Glued) -> Vec<Vec<u32>> {
    let triangles = &glued.triangles;
    let around = Around::new(glued);
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let mut count: BTreeMap<[u32; 2], i32> = BTreeMap::new();
    for t in triangles {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            *count.entry(sorted_pair([a, b])).or_default() += if a < b { 1 } else { -1 };
        }
    }
    for ([a, b], more) in count.into_iter().filter(|(_, more)| *more != 0) {
        let (from, to) = if more > 0 { (a, b) } else { (b, a) };
        next.entry(from).or_default().extend((0..more.abs()).map(|_| to));
    }
    let mut out = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut ring = Vec::new();
        let mut before = None;
        let mut at = start;
        while let Some(ways) = next.get_mut(&at) {
            let turn = before.filter(|_| ways.len() > 1).and_then(|from| fan(&around, triangles, from, at, ways));
            let to = ways.swap_remove(turn.unwrap_or(0));
            if ways.is_empty() {
                next.remove(&at);
            }
            ring.push(at);
            (before, at) = (Some(at), to);
            if at == start {
                break;
            }
        }
        out.push(ring);
    }
    out
}

/// Which of the `ways` on from node `at` bounds the fan of triangles that the rim from `from` comes along.
fn fan(around: &Around, triangles: &[[u32; 3]], from: u32, at: u32, ways: &[u32]) -> Option<usize> {
    let mut side = from;
    // A fan has no more triangles than there are round the node.
    for _ in around.of(at) {
        // The triangle that runs from `side` to `at` goes on to its third corner.
        let corner = around.of(at).iter().find_map(|&(t, k)| {
            let t = triangles[t as usize];
            (t[(k as usize + 2) % 3] == side).then_some(t[(k as usize + 1) % 3])
        })?;
        if let Some(found) = ways.iter().position(|&way| way == corner) {
            return Some(found);
        }
        side = corner;
    }
    None
}

/// Length of the shortest curve at a distance of up to `limit` metres, if there is one.
fn least_parallel(glued: &Glued, cloth: &Distances, far: &[f64], limit: f64) -> Option<f64> {
    let count = (1..).take_while(|&k| STEP * f64::from(k) < limit).count();
    let lengths = parallels(glued, cloth, far, STEP, count);
    lengths.into_iter().filter(|length| *length > 0.0).min_by(f64::total_cmp)
}

/// Lengths of the curves on which the field `far` is one `step`, two, … up to `count` steps, metres.
pub(super) fn parallels(glued: &Glued, cloth: &Distances, far: &[f64], step: f64, count: usize) -> Vec<f64> {
    let mut lengths = vec![0.0; count];
    for (t, corners) in glued.triangles.iter().enumerate() {
        let height = corners.map(|n| far[n as usize]);
        if height.iter().all(|h| h.is_finite()) {
            for (k, length) in lengths.iter_mut().enumerate() {
                *length += crossing(cloth.corners(t), height, step * (k + 1) as f64);
            }
        }
    }
    lengths
}

/// Length of the line across a triangle on which a linear field has this value.
fn crossing(corners: [Vec2; 3], height: [f64; 3], level: f64) -> f64 {
    let mut ends = Vec::with_capacity(2);
    for k in 0..3 {
        let j = (k + 1) % 3;
        if (height[k] < level) != (height[j] < level) {
            let share = (level - height[k]) / (height[j] - height[k]);
            ends.push(corners[k].lerp(&corners[j], share));
        }
    }
    if let [a, b] = ends[..] { (b - a).norm() } else { 0.0 }
}
