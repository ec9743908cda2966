//! The lids that would close the openings of a balloon. The cloth round an opening carries the pressure on its lid.
//!
//! The pressure on a closed balloon sums to zero. Without the lid of its hem it lifts a wide skirt, which crushes the
//! bodice above it.

use std::collections::HashMap;

use crate::geometry::{Vec3, sorted_pair};

/// The thing that a balloon is inflated round.
#[derive(Clone, Copy, Debug)]
pub(super) enum InflatedRound {
    /// Thin axes.
    Axes,
    /// The body, which grows from its axes.
    Body,
}

/// Shares of the pressure on a lid that the cloth at its opening carries.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LidShares {
    /// Round thin axes.
    pub(super) axes: f64,
    /// While the body grows.
    pub(super) body: f64,
}

/// The lid of an opening.
#[derive(Clone, Debug)]
pub(super) struct Lid {
    /// Edges of the rim, as the triangles beside them go round.
    edges: Vec<[u32; 2]>,
    /// The nodes that are nearer to this opening than to another.
    nodes: Vec<u32>,
    /// The shares of the pressure on it that the cloth carries.
    shares: LidShares,
}

impl Lid {
    /// The lids of openings with these rims. `far` has the distance of every node from each opening, metres. The
    /// `triangles` are those of one connected part, clockwise seen from outside.
    pub(super) fn all(triangles: &[[u32; 3]], rims: &[&[u32]], far: &[Vec<f64>]) -> Vec<Self> {
        let mut lids: Vec<Self> =
            rims.iter().map(|_| Self { edges: Vec::new(), nodes: Vec::new(), shares: LidShares::default() }).collect();
        let mut nodes: Vec<u32> = triangles.iter().flatten().copied().collect();
        nodes.sort_unstable();
        nodes.dedup();
        let off = |k: usize, n: u32| far[k][n as usize];
        for n in nodes {
            if let Some(k) = (0..rims.len()).min_by(|a, b| off(*a, n).total_cmp(&off(*b, n))) {
                lids[k].nodes.push(n);
            }
        }
        let rims = rims.iter().enumerate();
        let opening_of: HashMap<u32, usize> = rims.flat_map(|(k, rim)| rim.iter().map(move |n| (*n, k))).collect();
        for edge in boundary(triangles) {
            if let [Some(a), Some(b)] = edge.map(|n| opening_of.get(&n))
                && a == b
            {
                lids[*a].edges.push(edge);
            }
        }
        lids
    }

    /// The same lid with these shares of its pressure.
    pub(super) fn sharing(self, shares: LidShares) -> Self {
        Self { shares, ..self }
    }

    /// Twice the area of the lid along its normal out of the balloon, metres².
    fn area(&self, x: &[Vec3]) -> Vec3 {
        self.edges.iter().map(|edge| edge.map(|n| x[n as usize])).map(|[a, b]| a.cross(&b)).sum()
    }

    /// The pressure on the lid that its nodes carry, in lengths of the pressure on flat cloth. `area` has twice the
    /// area of the triangles round every node, metres².
    pub(super) fn push<'a>(
        &'a self,
        round: InflatedRound,
        x: &[Vec3],
        area: &[f64],
    ) -> impl Iterator<Item = (usize, Vec3)> + use<'a> {
        let share = match round {
            InflatedRound::Axes => self.shares.axes,
            InflatedRound::Body => self.shares.body,
        };
        // Every triangle counts at each of its three corners.
        let own: f64 = self.nodes.iter().map(|n| area[*n as usize]).sum::<f64>() / 3.0;
        let push = self.area(x) * share / own.max(f64::MIN_POSITIVE);
        self.nodes.iter().map(move |n| (*n as usize, push))
    }
}

/// The edges that have a triangle on one side only, as that goes round.
fn boundary(triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let sides = || triangles.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]]);
    let mut count: HashMap<[u32; 2], u32> = HashMap::new();
    sides().for_each(|side| *count.entry(sorted_pair(side)).or_default() += 1);
    sides().filter(|side| count[&sorted_pair(*side)] == 1).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cone with its tip at the top and an open hem of many corners, clockwise seen from outside.
    fn cone(corners: u32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let angle = |k: u32| f64::from(k) / f64::from(corners) * std::f64::consts::TAU;
        let hem = (0..corners).map(|k| Vec3::new(0.5 * angle(k).cos(), 0.7, 0.5 * angle(k).sin()));
        let x = std::iter::once(Vec3::new(0.1, 1.0, 0.05)).chain(hem).collect();
        (x, (0..corners).map(|k| [0, 1 + k, 1 + (k + 1) % corners]).collect())
    }

    #[test]
    fn with_its_lid_the_pressure_on_a_balloon_sums_to_zero() {
        let (x, triangles) = cone(20);
        let rim: Vec<u32> = (1..=20).collect();
        let far: Vec<f64> = (0..21).map(|n| if n == 0 { 0.5 } else { 0.0 }).collect();
        let normal = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|n| x[n as usize]);
            (c - a).cross(&(b - a))
        };
        let mut area = vec![0.0; x.len()];
        triangles.iter().for_each(|t| t.iter().for_each(|n| area[*n as usize] += normal(t).norm()));
        let pressure: Vec3 = triangles.iter().map(|t| normal(t) * 3.0).sum();
        assert!(pressure.y > 0.1, "it is lifted: {pressure:?}");
        let lids = Lid::all(&triangles, &[&rim], &[far]);
        let lid = lids[0].clone().sharing(LidShares { axes: 1.0, body: 0.25 });
        let carried = |round| lid.push(round, &x, &area).map(|(n, push)| push * area[n]).sum::<Vec3>();
        assert!(
            (pressure + carried(InflatedRound::Axes)).norm() < 1e-12,
            "{pressure:?} {:?}",
            carried(InflatedRound::Axes)
        );
        assert!((0.25 * pressure + carried(InflatedRound::Body)).norm() < 1e-12, "{:?}", carried(InflatedRound::Body));
    }

    #[test]
    fn cloth_carries_the_lid_of_the_opening_that_it_is_nearest_to() {
        let triangles = [[0, 1, 2], [1, 3, 2], [2, 3, 4]];
        let far = [vec![0.0, 0.0, 1.0, 2.0, 3.0], vec![3.0, 2.0, 1.5, 0.0, 0.0]];
        let lids = Lid::all(&triangles, &[&[0, 1], &[3, 4]], &far);
        assert_eq!(lids[0].nodes, [0, 1, 2]);
        assert_eq!(lids[1].nodes, [3, 4]);
        assert_eq!([&lids[0].edges[..], &lids[1].edges[..]], [&[[0, 1]][..], &[[3, 4]][..]]);
    }
}
