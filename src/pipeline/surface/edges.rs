//! The rim of a part as named edges: divided at corners, and where the partner across a cut changes.
//!
//! Corners are found by the angles of the surface, so that edges and their names do not depend on the mode of
//! flattening. Edges are numbered along each rim from the corner with the lowest number in the file.

use std::collections::{BTreeSet, HashMap};
use std::f64::consts::PI;

use super::parts::SurfacePart;
use crate::geometry::{rim_loops, sorted_pair};

/// Turn of a rim within reach that makes a corner, radians (30°).
const CORNER: f64 = PI / 6.0;
/// Reach on both sides of a vertex over which its turn is measured, as a share of the rim's length. A circle turns by
/// 4° there.
const REACH: f64 = 0.006;
/// Turn of two vertices within reach of each other, each in the same sense, above which they are two corners, radians
/// (60°), as at the end of a narrow strip. No corner that a mesh rounds off turns so much twice.
const SHARP: f64 = PI / 3.0;

/// A named edge of a part.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PartRimEdge {
    /// Its number along its rim from 1, with the rim's before it where there are several: `3`, `2.1`.
    pub(super) name: String,
    /// Index of its rim.
    pub(super) ring: usize,
    /// Vertices of the part, in the rim's direction. A rim without corners begins and ends in the same.
    pub(super) vertices: Vec<u32>,
    /// The edge it was cut from or is sewn to: index of its part and of the edge in it.
    pub(super) partner: Option<[usize; 2]>,
    /// Another name for it, in a garment file.
    pub(super) title: Option<String>,
}

/// The partner of a rim edge: a part, and its own vertices there.
type Other = Option<(usize, [u32; 2])>;

impl PartRimEdge {
    /// Number of its sides before its middle. `own` is the index of its part and of the edge in it. Partners run
    /// against each other and have the same middle.
    pub(super) fn middle(&self, own: [usize; 2]) -> usize {
        let sides = self.vertices.len() - 1;
        // From the ends of both to one vertex are as many steps.
        let later = !sides.is_multiple_of(2) && self.partner.is_some_and(|partner| partner <= own);
        sides / 2 + usize::from(later)
    }
}

/// Vertices of every part's rims between which lengths must stay if edges are to be sewn together at their ends and at
/// their middle: partners have the same.
pub(super) fn breaks_of(parts: &[&SurfacePart]) -> Vec<Vec<u32>> {
    let edges = named_edges(parts);
    let mut breaks: Vec<BTreeSet<u32>> = vec![BTreeSet::new(); parts.len()];
    for (p, edges) in edges.iter().enumerate() {
        for (e, edge) in edges.iter().enumerate() {
            breaks[p].extend([edge.vertices[0], edge.vertices[edge.middle([p, e])]]);
        }
    }
    let loops: Vec<Vec<Vec<u32>>> = parts.iter().map(|p| rim_loops(&p.surface.triangles)).collect();
    let others = Others::new(parts, &loops);
    while others.pass_on(parts, &mut breaks) {}
    breaks.into_iter().map(|breaks| breaks.into_iter().collect()).collect()
}

/// The named edges of every part.
pub(super) fn named_edges(parts: &[&SurfacePart]) -> Vec<Vec<PartRimEdge>> {
    let loops: Vec<Vec<Vec<u32>>> = parts.iter().map(|p| rim_loops(&p.surface.triangles)).collect();
    let others = Others::new(parts, &loops);
    let mut all: Vec<Vec<PartRimEdge>> = Vec::with_capacity(parts.len());
    for (k, part) in parts.iter().enumerate() {
        let mut edges = Vec::new();
        for (ring, rim) in loops[k].iter().enumerate() {
            let several = loops[k].len() > 1;
            let name = |n: usize| if several { format!("{}.{n}", ring + 1) } else { n.to_string() };
            let chains = chains(rim, &breaks(part, k, rim, &others), part);
            edges.extend((1..).zip(chains).map(|(n, vertices)| PartRimEdge {
                name: name(n),
                ring,
                vertices,
                partner: None,
                title: None,
            }));
        }
        all.push(edges);
    }
    pair(&mut all, &others);
    all
}

/// Rim edges of the parts that are the same edge of the file.
struct Others {
    /// By part and the vertices at the ends, smaller first.
    of: HashMap<(usize, [u32; 2]), (usize, [u32; 2])>,
}

impl Others {
    fn new(parts: &[&SurfacePart], loops: &[Vec<Vec<u32>>]) -> Self {
        let mut at: HashMap<[u32; 2], Vec<(usize, [u32; 2])>> = HashMap::new();
        for (k, (part, loops)) in parts.iter().zip(loops).enumerate() {
            for ends in loops.iter().flat_map(|rim| sides(rim)) {
                let file = ends.map(|v| part.vertices[v as usize]);
                at.entry(sorted_pair(file)).or_default().push((k, sorted_pair(ends)));
            }
        }
        let mut of = HashMap::new();
        for two in at.values() {
            // More than two cannot be sewn two by two.
            if let [a, b] = two[..] {
                of.extend([(a, b), (b, a)]);
            }
        }
        Self { of }
    }

    /// Breaks the other side of every edge where this one is broken. Returns whether there was a new break.
    fn pass_on(&self, parts: &[&SurfacePart], breaks: &mut [BTreeSet<u32>]) -> bool {
        let mut broken = false;
        for (&(p, ends), &(q, across)) in &self.of {
            for v in ends.into_iter().filter(|v| breaks[p].contains(v)).collect::<Vec<_>>() {
                let same = |w: &u32| parts[q].vertices[*w as usize] == parts[p].vertices[v as usize];
                broken |= across.into_iter().find(same).is_some_and(|w| breaks[q].insert(w));
            }
        }
        broken
    }

    fn of(&self, part: usize, ends: [u32; 2]) -> Other {
        self.of.get(&(part, sorted_pair(ends))).copied()
    }
}

fn sides(rim: &[u32]) -> impl Iterator<Item = [u32; 2]> + '_ {
    (0..rim.len()).map(|k| [rim[k], rim[(k + 1) % rim.len()]])
}

/// For every vertex of a rim whether an edge ends there.
fn breaks(part: &SurfacePart, index: usize, rim: &[u32], others: &Others) -> Vec<bool> {
    let mut breaks = corners(part, rim);
    for k in 0..rim.len() {
        let [a, b, c] = [rim.len() - 1, 0, 1].map(|step| rim[(k + step) % rim.len()]);
        let continued = match (others.of(index, [a, b]), others.of(index, [b, c])) {
            (None, None) => true,
            // The other side goes on as well where both its edges meet, unless the cut turns back there: its own end.
            (Some((p, before)), Some((q, after))) => {
                p == q
                    && before != after
                    && before.iter().any(|v| after.contains(v))
                    && !(p == index && before.contains(&b))
            }
            _ => false,
        };
        breaks[k] |= !continued;
    }
    breaks
}

/// Corners of a rim: sharp turns, each at the vertex that turns most.
fn corners(part: &SurfacePart, rim: &[u32]) -> Vec<bool> {
    let turns = turns(part, rim);
    let near = RimNeighbourhood::new(part, rim);
    (0..rim.len())
        .map(|k| {
            let own = turns[k].abs();
            let turn: f64 = near.of(k).map(|i| turns[i]).sum();
            let leads = |i: usize| {
                let other = turns[i].abs();
                let two = own.min(other) > SHARP && turns[k] * turns[i] > 0.0;
                two || own > other || (own == other && k <= i)
            };
            turn.abs().max(own) > CORNER && near.of(k).all(leads)
        })
        .collect()
}

/// The neighbourhood of each vertex of a rim.
struct RimNeighbourhood {
    /// Lengths of the rim's sides.
    lengths: Vec<f64>,
    reach: f64,
}

impl RimNeighbourhood {
    fn new(part: &SurfacePart, rim: &[u32]) -> Self {
        let at = |v: u32| part.surface.vertices[v as usize];
        let lengths: Vec<f64> = sides(rim).map(|[a, b]| (at(b) - at(a)).norm()).collect();
        Self { reach: REACH * lengths.iter().sum::<f64>(), lengths }
    }

    /// The vertex `k`, and those within reach before and after it.
    fn of(&self, k: usize) -> impl Iterator<Item = usize> + '_ {
        let n = self.lengths.len();
        let way = move |forward: bool| {
            let mut left = self.reach;
            let step = move |i: usize| if forward { (k + i) % n } else { (k + n - i) % n };
            (1..n / 2).map(step).take_while(move |&i| {
                left -= self.lengths[if forward { (i + n - 1) % n } else { i }];
                left >= 0.0
            })
        };
        way(false).chain([k]).chain(way(true))
    }
}

/// By how much the rim turns at each of its vertices on the surface:
/// half a turn less the angles of the triangles there.
fn turns(part: &SurfacePart, rim: &[u32]) -> Vec<f64> {
    let place: HashMap<u32, usize> = rim.iter().enumerate().map(|(k, &v)| (v, k)).collect();
    let mut turns = vec![PI; rim.len()];
    for (t, corners) in part.surface.triangles.iter().enumerate() {
        for (k, v) in corners.iter().enumerate() {
            if let Some(&at) = place.get(v) {
                let p = part.surface.corners(t);
                let (u, w) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
                turns[at] -= u.cross(&w).norm().atan2(u.dot(&w));
            }
        }
    }
    turns
}

/// A rim cut at its breaks, from the break with the lowest number in the file on. Without breaks,
/// from the lowest vertex.
fn chains(rim: &[u32], breaks: &[bool], part: &SurfacePart) -> Vec<Vec<u32>> {
    let number = |k: &usize| (part.number(rim[*k]), *k);
    let open = (0..rim.len()).filter(|&k| breaks[k]).min_by_key(number);
    let Some(first) = open.or_else(|| (0..rim.len()).min_by_key(number)) else { return Vec::new() };
    let mut chains = Vec::new();
    let mut chain = vec![rim[first]];
    for step in 1..=rim.len() {
        let k = (first + step) % rim.len();
        chain.push(rim[k]);
        if breaks[k] || step == rim.len() {
            chains.push(std::mem::replace(&mut chain, vec![rim[k]]));
        }
    }
    chains
}

/// Says of every edge which one lies on the other side, where it is one edge from end to end.
fn pair(all: &mut [Vec<PartRimEdge>], others: &Others) {
    let mut home: HashMap<(usize, [u32; 2]), [usize; 2]> = HashMap::new();
    for (p, edges) in all.iter().enumerate() {
        for (e, edge) in edges.iter().enumerate() {
            home.extend(edge.vertices.windows(2).map(|w| ((p, sorted_pair([w[0], w[1]])), [p, e])));
        }
    }
    for p in 0..all.len() {
        for e in 0..all[p].len() {
            let edge = &all[p][e];
            let mut sides = edge.vertices.windows(2).map(|w| {
                let (part, ends) = others.of(p, [w[0], w[1]])?;
                home.get(&(part, ends)).copied()
            });
            let first = sides.next().flatten();
            let one = first.filter(|f| sides.all(|s| s == Some(*f)));
            all[p][e].partner = one.filter(|[q, f]| all[*q][*f].vertices.len() == all[p][e].vertices.len());
        }
    }
}
