//! Turning the triangles of a surface so that all show the same side, or telling that it has but one.

use std::collections::VecDeque;

use crate::geometry::{DisjointSets, Topology};

/// Turns triangles round so that neighbours agree, in every connected part those that are fewer; gives which were
/// turned. `None`, and nothing turned, where there is no such way: the surface has one side only.
pub fn orient(triangles: &mut [[u32; 3]]) -> Option<Vec<usize>> {
    let topology = Topology::new(triangles);
    if topology.misoriented.is_empty() {
        return Some(Vec::new());
    }
    let mut beside: Vec<Vec<u32>> = vec![Vec::new(); triangles.len()];
    for edge in &topology.edges {
        // Where more than two meet, no two of them are neighbours.
        if let ([Some(t), Some(u)], false) = (edge.triangles, topology.non_manifold.binary_search(&edge.ends).is_ok()) {
            beside[t as usize].push(u);
            beside[u as usize].push(t);
        }
    }
    let mut against = topology.misoriented.clone();
    against.sort_unstable();
    let disagree = |t: u32, u: u32| against.binary_search(&[t, u]).is_ok() || against.binary_search(&[u, t]).is_ok();
    let mut turned: Vec<Option<bool>> = vec![None; triangles.len()];
    let mut all = Vec::new();
    for first in 0..triangles.len() {
        if turned[first].is_some() {
            continue;
        }
        turned[first] = Some(false);
        let mut part = vec![first];
        let mut open = VecDeque::from([first as u32]);
        while let Some(t) = open.pop_front() {
            let own = turned[t as usize] == Some(true);
            for &u in &beside[t as usize] {
                let wanted = own != disagree(t, u);
                match turned[u as usize] {
                    Some(other) if other != wanted => return None,
                    Some(_) => {}
                    None => {
                        turned[u as usize] = Some(wanted);
                        part.push(u as usize);
                        open.push_back(u);
                    }
                }
            }
        }
        let (over, under): (Vec<usize>, Vec<usize>) = part.into_iter().partition(|&t| turned[t] == Some(true));
        all.extend(if over.len() <= under.len() { over } else { under });
    }
    all.iter().for_each(|&t| triangles[t].swap(1, 2));
    all.sort_unstable();
    Some(all)
}

/// The name of a one-sided surface, by its rims and its Euler characteristic.
pub fn one_sided(triangles: &[[u32; 3]]) -> &'static str {
    let topology = Topology::new(triangles);
    let mut used: Vec<u32> = triangles.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let number = |v: u32| used.binary_search(&v).unwrap_or(0) as u32;
    let mut rim = DisjointSets::new(used.len());
    let mut on_rim: Vec<u32> = Vec::new();
    for edge in topology.rim_edges() {
        let [a, b] = edge.ends.map(number);
        rim.join(a, b);
        on_rim.push(a);
    }
    let mut rims: Vec<u32> = on_rim.into_iter().map(|v| rim.root(v)).collect();
    rims.sort_unstable();
    rims.dedup();
    match (rims.len(), used.len() as i64 - topology.edges.len() as i64 + triangles.len() as i64) {
        (1, 0) => "a Möbius strip",
        (0, 0) => "a Klein bottle",
        (0, _) => "closed, like a Klein bottle",
        _ => "twisted, like a Möbius strip",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A band of `n` quads, joined at its ends, with `half_turns`.
    fn band(n: u32, half_turns: u32) -> Vec<[u32; 3]> {
        let at = |k: u32, side: u32| {
            let side = if k == n && half_turns % 2 == 1 { 1 - side } else { side };
            2 * (k % n) + side
        };
        let quad = |k: u32| {
            let [a, b, c, d] = [at(k, 0), at(k, 1), at(k + 1, 1), at(k + 1, 0)];
            [[a, b, c], [a, c, d]]
        };
        (0..n).flat_map(quad).collect()
    }

    #[test]
    fn the_few_are_turned() {
        let good = band(12, 0);
        let mut spoilt = good.clone();
        [3, 4, 17].iter().for_each(|&t: &usize| spoilt[t].swap(1, 2));
        assert_eq!(orient(&mut spoilt), Some(vec![3, 4, 17]));
        assert_eq!(spoilt, good);
        assert_eq!(orient(&mut spoilt), Some(Vec::new()));
    }

    #[test]
    fn one_side_is_told() {
        let mut strip = band(12, 1);
        let before = strip.clone();
        assert_eq!(orient(&mut strip), None);
        assert_eq!((strip == before, one_sided(&before)), (true, "a Möbius strip"));
        // A torus whose tube comes back turned.
        let at = |i: u32, k: u32| 8 * (i % 8) + if i == 8 { (8 - k % 8) % 8 } else { k % 8 };
        let mut bottle: Vec<[u32; 3]> = (0..8)
            .flat_map(|i| (0..8).map(move |k| [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)]))
            .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]])
            .collect();
        assert_eq!((orient(&mut bottle), one_sided(&bottle)), (None, "a Klein bottle"));
    }
}
