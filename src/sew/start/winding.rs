//! The angle round a limb as a field on the glued surface: it rises by a full turn round the limb's opening.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::f64::consts::TAU;

use crate::geometry::sorted_pair;

/// By how much an angle jumps from the first to the second end of an edge, radians.
pub(super) type Jumps = HashMap<[u32; 2], f64>;

/// The jumps of an angle that grows from the first node of `rim` to the last one and by a full turn all round: across a
/// path over the triangles, from between these two nodes to a node of `others`. `None` where no path leads there.
///
/// Edges are named with the lower node first. Rims run as the triangles do.
pub(super) fn jumps(triangles: &[[u32; 3]], rim: &[u32], others: &[u32]) -> Option<Jumps> {
    let (first, last) = (*rim.first()?, *rim.last()?);
    let path = path(triangles, [last, first], others)?;
    let mut jumps = Jumps::new();
    // The path has its left at the rim's last node, where the angle is a full turn more than at its right.
    insert(&mut jumps, [last, first], -TAU);
    path.into_iter().for_each(|edge| insert(&mut jumps, edge, TAU));
    Some(jumps)
}

fn insert(jumps: &mut Jumps, [a, b]: [u32; 2], jump: f64) {
    jumps.insert(sorted_pair([a, b]), if a < b { jump } else { -jump });
}

/// The edges that the shortest path over the triangles crosses, from the one at the side `from` of the rim to one of
/// `others`: each as it runs in the triangle that the path leaves.
fn path(triangles: &[[u32; 3]], from: [u32; 2], others: &[u32]) -> Option<Vec<[u32; 2]>> {
    let sides = |t: u32| {
        let [a, b, c] = triangles[t as usize];
        [[a, b], [b, c], [c, a]]
    };
    let mut beside: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for t in 0..triangles.len() as u32 {
        sides(t).into_iter().for_each(|side| beside.entry(sorted_pair(side)).or_default().push(t));
    }
    let start = beside.get(&sorted_pair(from))?.iter().copied().find(|t| sides(*t).contains(&from))?;
    let mut goal = vec![false; 1 + triangles.iter().flatten().max().map_or(0, |n| *n as usize)];
    others.iter().for_each(|n| goal[*n as usize] = true);
    // How each triangle is reached: from which one, across which of its sides.
    let mut came: Vec<Option<(u32, [u32; 2])>> = vec![None; triangles.len()];
    let mut queue = VecDeque::from([start]);
    while let Some(t) = queue.pop_front() {
        if triangles[t as usize].iter().any(|n| goal[*n as usize]) {
            return Some(back(&came, start, t));
        }
        for side in sides(t) {
            for next in beside[&sorted_pair(side)].iter().filter(|next| **next != t) {
                if *next != start && came[*next as usize].is_none() {
                    came[*next as usize] = Some((t, side));
                    queue.push_back(*next);
                }
            }
        }
    }
    None
}

/// The sides that the path to triangle `to` crosses.
fn back(came: &[Option<(u32, [u32; 2])>], start: u32, to: u32) -> Vec<[u32; 2]> {
    let mut out = Vec::new();
    let mut at = to;
    while at != start {
        let Some((before, side)) = came[at as usize] else { break };
        out.push(side);
        at = before;
    }
    out
}
