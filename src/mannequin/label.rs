//! Which part of a body every vertex of its skin belongs to, by how the skin hangs together.
//!
//! Limbs that nearly touch, a hand at a hip and a tail of hair share a horizontal cut with the trunk. On the skin they
//! are far from it.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::PartKind;
use super::junction::{Junction, JunctionSide, junctions};
use crate::geometry::{DisjointSets, MeshEdge, TriMesh, Vec3, range_of};

/// Largest height of a crotch, as a share of the body's height.
const HIGHEST_CROTCH: f64 = 0.62;
/// Least length of a leg, as a share of the body's height. A stump of a dress form is shorter than a child's leg.
const LEG: f64 = 0.15;
/// Height of the lower end of a leg, as a share of the body's height, above which it is an arm: a hand or a stump.
const FOOT_ENDS: f64 = 0.2;
/// Least extent of an arm on the skin, as a share of the body's height.
const ARM: f64 = 0.12;

/// The parts of a skin.
pub(super) struct Labels {
    /// Of every vertex its part. Trunk, neck and head are the torso. `None` where the skin is another piece of surface.
    pub(super) of: Vec<Option<PartKind>>,
    /// Lowest height, metres, under which there is a way on the skin from the crotch to each vertex. It is the vertex's
    /// own height unless that hangs down from somewhere above.
    way: Vec<f64>,
    /// Height of the crotch, metres.
    pub(super) crotch: f64,
    /// Height of the lower armpit, metres: above it, a horizontal cut of the trunk runs round an arm as well.
    pub(super) armpit: f64,
}

impl Labels {
    /// Labels of a body that stands on y = 0 and is `top` metres high, or what is missing.
    pub(super) fn new(mesh: &TriMesh, edges: &[MeshEdge], top: f64) -> Result<Self, String> {
        let fork = fork(mesh, edges, top).ok_or("no two legs found: the body must stand upright, y up")?;
        let mut of = legs(mesh, &fork);
        let near = neighbours(edges, mesh.vertices.len());
        let is_leg = |v: u32| of[v as usize].is_some_and(PartKind::is_leg);
        // The lowest skin of the trunk all round.
        let ring = (0..near.len() as u32).filter(|&v| !is_leg(v) && near[v as usize].iter().any(|&w| is_leg(w)));
        let ring: Vec<u32> = ring.collect();
        let far = flood(&near, &ring, |so_far, from, to| {
            let long = (mesh.vertices[from as usize] - mesh.vertices[to as usize]).norm();
            (!is_leg(to)).then_some(so_far + long)
        });
        let height = |v: u32| mesh.vertices[v as usize].y;
        let way = flood(&near, &[fork.vertex], |so_far, _, to| Some(so_far.max(height(to))));
        let middle = middle_of(mesh, &ring);
        for (arm, side) in [(PartKind::LeftArm, 1.0), (PartKind::RightArm, -1.0)] {
            let members = arm_of(mesh, &near, &far, &Beside { middle, side, least: ARM * top });
            members.ok_or_else(|| no_arm(arm))?.into_iter().for_each(|v| of[v as usize] = Some(arm));
        }
        for (label, far) in of.iter_mut().zip(&far) {
            if label.is_none() && far.is_finite() {
                *label = Some(PartKind::Torso);
            }
        }
        let of_arms = way.iter().zip(&of).filter(|(_, label)| label.is_some_and(PartKind::is_arm));
        let armpit = of_arms.map(|(way, _)| *way).fold(f64::INFINITY, f64::min);
        Ok(Self { of, way, crotch: fork.top, armpit })
    }

    /// Whether the vertex `v` can be of this arm: it is, or is of the trunk and does not hang down from above `high`.
    pub(super) fn can_be_of(&self, v: usize, high: f64, arm: PartKind) -> bool {
        self.of[v] == Some(arm) || (self.of[v] == Some(PartKind::Torso) && self.way[v] <= high)
    }

    /// Whether an edge that a horizontal cut at height `y` crosses, the lower end first, is of the trunk, the neck or
    /// the head, and not of hair or clothes that hang down from there.
    pub(super) fn is_of_trunk(&self, edge: [u32; 2], y: f64) -> bool {
        edge.iter().all(|&v| self.of[v as usize] == Some(PartKind::Torso)) && self.way[edge[0] as usize] < y
    }

    /// The part that most vertices of one side of a junction are of.
    pub(super) fn most_of(&self, junction: &Junction, side: JunctionSide) -> Option<PartKind> {
        let own = || self.of.iter().zip(&junction.side).filter(|(_, s)| **s == side).map(|(label, _)| *label);
        let count = own().count();
        let limbs = [PartKind::LeftLeg, PartKind::RightLeg, PartKind::LeftArm, PartKind::RightArm];
        limbs.into_iter().find(|kind| 2 * own().filter(|label| *label == Some(*kind)).count() > count)
    }

    /// Whether an edge that a horizontal cut crosses, the lower end first, is of this leg.
    pub(super) fn is_of_leg(&self, edge: [u32; 2], leg: PartKind) -> bool {
        self.of[edge[0] as usize] == Some(leg)
    }
}

/// The note on an arm that is not found.
pub(super) fn no_arm(arm: PartKind) -> String {
    format!("no {} found beside the trunk: arms must stand off the body", arm.name())
}

/// The highest junction, of those that a crotch may be, of two limbs that reach down to the feet.
fn fork(mesh: &TriMesh, edges: &[MeshEdge], top: f64) -> Option<Junction> {
    let found = junctions(mesh, edges, LEG * top);
    found.into_iter().rev().find(|j| j.bottom < FOOT_ENDS * top && j.top < HIGHEST_CROTCH * top)
}

/// Labels of the two legs, the left one at greater x.
fn legs(mesh: &TriMesh, fork: &Junction) -> Vec<Option<PartKind>> {
    let mean = |side: JunctionSide| {
        let own = mesh.vertices.iter().zip(&fork.side).filter(|(_, s)| **s == side).map(|(p, _)| p.x);
        let (sum, count) = own.fold((0.0, 0.0), |(sum, n), x| (sum + x, n + 1.0));
        sum / count
    };
    let [limb, beside] = if mean(JunctionSide::Limb) > mean(JunctionSide::Beside) {
        [PartKind::LeftLeg, PartKind::RightLeg]
    } else {
        [PartKind::RightLeg, PartKind::LeftLeg]
    };
    let label = |side: &JunctionSide| match side {
        JunctionSide::Limb => Some(limb),
        JunctionSide::Beside => Some(beside),
        JunctionSide::Neither => None,
    };
    fork.side.iter().map(label).collect()
}

/// The vertices next to every vertex.
fn neighbours(edges: &[MeshEdge], vertices: usize) -> Vec<Vec<u32>> {
    let mut near = vec![Vec::new(); vertices];
    for [a, b] in edges.iter().map(|e| e.ends) {
        near[a as usize].push(b);
        near[b as usize].push(a);
    }
    near
}

/// A key of the queue: the least comes out first, and of equal ones that of the lower vertex.
#[derive(PartialEq)]
struct Queued(f64, u32);

impl Eq for Queued {}

impl Ord for Queued {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0).then(self.1.cmp(&other.1))
    }
}

impl PartialOrd for Queued {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// The least cost of a way along edges from one of `start` to every vertex. `step` tells the cost at the second vertex
/// of an edge from that at the first, and `None` where no way leads. A vertex that cannot be reached is infinitely far.
fn flood(near: &[Vec<u32>], start: &[u32], step: impl Fn(f64, u32, u32) -> Option<f64>) -> Vec<f64> {
    let mut cost = vec![f64::INFINITY; near.len()];
    let mut queue = BinaryHeap::new();
    for &v in start {
        cost[v as usize] = 0.0;
        queue.push(Reverse(Queued(0.0, v)));
    }
    while let Some(Reverse(Queued(so_far, v))) = queue.pop() {
        if so_far > cost[v as usize] {
            continue;
        }
        for &w in &near[v as usize] {
            if let Some(next) = step(so_far, v, w).filter(|next| *next < cost[w as usize]) {
                cost[w as usize] = next;
                queue.push(Reverse(Queued(next, w)));
            }
        }
    }
    cost
}

/// The middle of the box round some vertices, from side to side.
fn middle_of(mesh: &TriMesh, vertices: &[u32]) -> f64 {
    let [low, high] = range_of(vertices.iter().map(|v| mesh.vertices[*v as usize].x));
    0.5 * (low + high)
}

/// Where an arm is looked for.
struct Beside {
    /// The x coordinate of the body's middle.
    middle: f64,
    /// The sign of x on the arm's side.
    side: f64,
    /// Least extent on the skin, metres.
    least: f64,
}

impl Beside {
    /// How far a point is on the arm's side of the middle.
    fn out(&self, p: &Vec3) -> f64 {
        self.side * (p.x - self.middle)
    }
}

/// The skin that hangs together beyond some distance from the crotch.
#[derive(Clone, Copy)]
struct SkinPatch {
    /// Its farthest vertex, and how far along the skin that is.
    tip: (u32, f64),
    /// The least and the greatest place beside the middle.
    out: [f64; 2],
}

impl SkinPatch {
    fn with(self, other: Self) -> Self {
        let tip = if other.tip.1 > self.tip.1 { other.tip } else { self.tip };
        Self { tip, out: [self.out[0].min(other.out[0]), self.out[1].max(other.out[1])] }
    }
}

/// The vertices of the arm: of all skin that hangs together beyond some distance from the crotch (`far`), as far down
/// as it is all on one side of the body's middle, that which reaches out most.
fn arm_of(mesh: &TriMesh, near: &[Vec<u32>], far: &[f64], beside: &Beside) -> Option<Vec<u32>> {
    let mut order: Vec<u32> = (0..near.len() as u32).filter(|v| far[*v as usize].is_finite()).collect();
    order.sort_by(|a, b| far[*b as usize].total_cmp(&far[*a as usize]).then(a.cmp(b)));
    let mut sets = DisjointSets::new(near.len());
    let mut patch: Vec<SkinPatch> = (0..near.len() as u32)
        .map(|v| {
            let out = beside.out(&mesh.vertices[v as usize]);
            SkinPatch { tip: (v, far[v as usize]), out: [out, out] }
        })
        .collect();
    let mut done = vec![false; near.len()];
    let mut best: Option<(f64, u32, f64)> = None;
    for &v in &order {
        done[v as usize] = true;
        let beyond = far[v as usize];
        for &w in near[v as usize].iter().filter(|w| done[**w as usize]) {
            let (a, b) = (sets.root(v), sets.root(w));
            if a == b {
                continue;
            }
            let both = [patch[a as usize], patch[b as usize]];
            let whole = both[0].with(both[1]);
            let ends = both.iter().filter(|p| whole.out[0] <= 0.0 && p.out[0] > 0.0 && p.tip.1 - beyond > beside.least);
            for p in ends {
                if best.is_none_or(|(out, ..)| p.out[1] > out) {
                    best = Some((p.out[1], p.tip.0, beyond));
                }
            }
            sets.join(a, b);
            patch[a.min(b) as usize] = whole;
        }
    }
    best.map(|(_, tip, beyond)| reached(near, far, tip, beyond))
}

/// The vertices that hang together with `tip` beyond this distance.
fn reached(near: &[Vec<u32>], far: &[f64], tip: u32, beyond: f64) -> Vec<u32> {
    let (mut seen, mut members) = (vec![false; near.len()], vec![tip]);
    seen[tip as usize] = true;
    let mut next = 0;
    while next < members.len() {
        for &w in &near[members[next] as usize] {
            if !seen[w as usize] && far[w as usize].is_finite() && far[w as usize] > beyond {
                seen[w as usize] = true;
                members.push(w);
            }
        }
        next += 1;
    }
    members
}
