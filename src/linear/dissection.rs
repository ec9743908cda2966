//! Geometric nested dissection (George 1973): an elimination order for meshes that lie in space.

use crate::geometry::{Vec3, box_of};

/// Parts of this many nodes are not cut further: their factor is one dense block anyway.
const LEAF: usize = 24;

/// An elimination order of the graph with the given `edges`, for [`super::Ordering::Given`].
///
/// The points are halved at the median of their longest extent; nodes of one half with a neighbour in the other
/// separate the two and are eliminated last; the halves are ordered likewise. For a grid of n nodes the factor then
/// has O(n log n) entries. Points that are not finite and edges beyond the points only cost speed.
pub fn nested_dissection(points: &[Vec3], edges: &[[u32; 2]]) -> Vec<u32> {
    let graph = Graph::new(points.len(), edges);
    let mut half = vec![Half::Elsewhere; points.len()];
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    // Parts still to be cut. Every part is a range of `order`; what is not cut keeps its place.
    let mut parts = Vec::from([(0, points.len())]);
    while let Some((start, end)) = parts.pop() {
        if end - start <= LEAF {
            continue;
        }
        let part = &mut order[start..end];
        let (low, high) = halve(points, &graph, part, &mut half);
        parts.push((start, start + low));
        parts.push((start + low, start + low + high));
    }
    order
}

/// Which part of the cut a node is in.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Half {
    Low,
    High,
    Separator,
    Elsewhere,
}

/// Orders `part` as low half, high half, separator and returns the sizes of the first two.
fn halve(points: &[Vec3], graph: &Graph, part: &mut [u32], half: &mut [Half]) -> (usize, usize) {
    let axis = longest_extent(points, part);
    let key = |v: u32| points[v as usize][axis];
    let middle = part.len() / 2;
    part.select_nth_unstable_by(middle, |&a, &b| key(a).total_cmp(&key(b)).then(a.cmp(&b)));
    for (k, &v) in part.iter().enumerate() {
        half[v as usize] = if k < middle { Half::Low } else { Half::High };
    }
    let touching = |own: Half, other: Half| -> Vec<u32> {
        let meets = |v: u32| graph.neighbours(v).iter().any(|&w| half[w as usize] == other);
        part.iter().copied().filter(|&v| half[v as usize] == own && meets(v)).collect()
    };
    let (low, high) = (touching(Half::Low, Half::High), touching(Half::High, Half::Low));
    for v in if low.len() <= high.len() { low } else { high } {
        half[v as usize] = Half::Separator;
    }
    part.sort_unstable_by_key(|&v| (half[v as usize], v));
    let count = |wanted: Half| part.iter().filter(|&&v| half[v as usize] == wanted).count();
    let sizes = (count(Half::Low), count(Half::High));
    for &v in part.iter() {
        half[v as usize] = Half::Elsewhere;
    }
    sizes
}

fn longest_extent(points: &[Vec3], part: &[u32]) -> usize {
    let [low, high] = box_of(part.iter().map(|&v| points[v as usize]));
    (high - low).imax()
}

/// Neighbours of every node, compressed.
struct Graph {
    starts: Vec<usize>,
    targets: Vec<u32>,
}

impl Graph {
    fn new(nodes: usize, edges: &[[u32; 2]]) -> Self {
        let known = |e: &&[u32; 2]| (e[0] as usize) < nodes && (e[1] as usize) < nodes;
        let mut starts = vec![0; nodes + 1];
        for [a, b] in edges.iter().filter(known) {
            starts[*a as usize + 1] += 1;
            starts[*b as usize + 1] += 1;
        }
        for node in 0..nodes {
            starts[node + 1] += starts[node];
        }
        let mut at = starts.clone();
        let mut targets = vec![0; starts[nodes]];
        for [a, b] in edges.iter().filter(known) {
            for (from, to) in [(*a, *b), (*b, *a)] {
                targets[at[from as usize]] = to;
                at[from as usize] += 1;
            }
        }
        Self { starts, targets }
    }

    fn neighbours(&self, node: u32) -> &[u32] {
        &self.targets[self.starts[node as usize]..self.starts[node as usize + 1]]
    }
}
