//! Where the body cuts the cloth.

use rayon::prelude::*;

use super::world::World;
use crate::geometry::Vec3;

impl World<'_> {
    /// Whether the body cuts an edge of the cloth or pokes through a triangle.
    pub fn is_cut(&self) -> bool {
        let (body, cloth) = (self.proximity.body, &self.cloth);
        let cuts = |[a, b]: &[u32; 2]| body.is_in_the_way(self.x[*a as usize], self.x[*b as usize]);
        let pokes = |nodes: &[u32; 3]| body.poking(nodes.map(|n| self.x[n as usize])).is_some();
        cloth.edges.par_iter().any(cuts) || cloth.triangles.par_iter().any(pokes)
    }

    /// Number of edges and triangles that the body cuts with the nodes at `x`, and per node the mean direction off the
    /// body of those at it.
    pub fn ways_off(&self, x: &[Vec3]) -> (usize, Vec<Vec3>) {
        let (body, cloth) = (self.proximity.body, &self.cloth);
        let at = |n: u32| x[n as usize];
        let cut = |e: &[u32; 2]| body.way_off(at(e[0]), at(e[1]));
        let poked = |t: &[u32; 3]| body.poking(t.map(at));
        let of_edges: Vec<Option<Vec3>> = cloth.edges.par_iter().map(cut).collect();
        let of_triangles: Vec<Option<Vec3>> = cloth.triangles.par_iter().map(poked).collect();
        let edges = cloth.edges.iter().map(<[u32; 2]>::as_slice).zip(of_edges);
        let cuts = edges.chain(cloth.triangles.iter().map(<[u32; 3]>::as_slice).zip(of_triangles));
        let (mut count, mut sum) = (0, vec![(Vec3::zeros(), 0.0); x.len()]);
        for (nodes, way) in cuts.filter_map(|(nodes, way)| Some((nodes, way?))) {
            count += 1;
            for &n in nodes {
                let (to, ways) = &mut sum[n as usize];
                (*to, *ways) = (*to + way, *ways + 1.0);
            }
        }
        (count, sum.into_iter().map(|(to, ways)| to / f64::max(ways, 1.0)).collect())
    }
}
