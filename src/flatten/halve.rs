//! The way along which a disk is best cut in two.

use std::collections::HashSet;

use super::cut::{ShortestWays, Solid};
use crate::geometry::{Topology, TriMesh, rim_loops};

/// Vertices of the rim from which ways are tried, spread evenly: more would find ways that are a few per cent shorter
/// and take longer than laying the piece flat.
const TRIED: usize = 48;

/// A way across a disk from rim to rim, along edges that are not `solid` and past no other vertex of the rim: the one
/// that is shortest for the rim it leaves on its shorter side, so that narrow places are cut, and nearer to the middle
/// rather than near an end. Empty where a surface has not one rim, or no such way.
pub fn halving(surface: &TriMesh, solid: &Solid) -> Vec<u32> {
    let topology = Topology::new(&surface.triangles);
    let rims = rim_loops(&surface.triangles);
    let [rim] = &rims[..] else { return Vec::new() };
    let on_rim: HashSet<u32> = rim.iter().copied().collect();
    let places = places(surface, rim);
    let total = places[rim.len()];
    let clear = |way: &[u32]| way.len() > 2 && !way[1..way.len() - 1].iter().any(|v| on_rim.contains(v));
    let ways = (0..rim.len()).step_by(rim.len().div_ceil(TRIED)).filter_map(|k| {
        let tree = ShortestWays::new(surface, &topology, solid, &[rim[k]], false);
        let share = |j: usize| {
            let along = (places[j] - places[k]).abs();
            tree.distance[rim[j] as usize] / along.min(total - along)
        };
        let mut ends: Vec<usize> = (0..rim.len()).filter(|&j| j != k && share(j).is_finite()).collect();
        ends.sort_by(|&i, &j| share(i).total_cmp(&share(j)).then(i.cmp(&j)));
        ends.into_iter().map(|j| (share(j), tree.path(rim[j]))).find(|(_, way)| clear(way))
    });
    ways.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, way)| way).unwrap_or_default()
}

/// How far along a rim its vertices are, and its length.
fn places(surface: &TriMesh, rim: &[u32]) -> Vec<f64> {
    let at = |k: usize| surface.vertices[rim[k % rim.len()] as usize];
    let mut places = vec![0.0];
    for k in 0..rim.len() {
        places.push(places[k] + (at(k + 1) - at(k)).norm());
    }
    places
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec3;

    /// A strip of `n` × `m` squares, 2 wide where it is not `narrow` by this share in its middle.
    fn strip(n: u32, m: u32, narrow: f64) -> TriMesh {
        let mut mesh = TriMesh::default();
        for (j, i) in (0..=m).flat_map(|j| (0..=n).map(move |i| (j, i))) {
            let along = f64::from(i);
            let width = 1.0 - narrow * (-(along - 0.4 * f64::from(n)).powi(2)).exp();
            mesh.vertices.push(Vec3::new(along, width * (2.0 * f64::from(j) / f64::from(m) - 1.0), 0.0));
        }
        for (j, i) in (0..m).flat_map(|j| (0..n).map(move |i| (j, i))) {
            let a = j * (n + 1) + i;
            mesh.triangles.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        }
        mesh
    }

    #[test]
    fn a_strip_is_cut_across_its_middle_and_a_waist_at_its_waist() {
        for (narrow, column) in [(0.0, 10), (0.6, 8)] {
            let way = halving(&strip(20, 4, narrow), &Solid::new());
            assert!(way.len() == 5 && way.iter().all(|v| v % 21 == column), "{narrow}: {way:?}");
        }
    }

    #[test]
    fn what_has_no_inside_is_not_cut() {
        let triangle = TriMesh { vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y()], triangles: vec![[0, 1, 2]] };
        assert!(halving(&triangle, &Solid::new()).is_empty());
    }
}
