//! Openings that pieces left out of the surface close: nothing passes through the mouth of a pocket with its bag.

use std::collections::BTreeSet;

use crate::geometry::{DisjointSets, Topology};
use crate::mesh::ClothMesh;

/// Left-out pieces back an opening where they are sewn to at least this share of its rim: rims end between stitches.
const MOST_OF_RIM: f64 = 0.9;

/// The left-out pieces that close what they are sewn to.
pub(super) struct Backing {
    /// For each group of them that is sewn together, the particles of the surface that it is sewn to.
    sewn_to: Vec<BTreeSet<u32>>,
}

impl Backing {
    /// Groups of the pieces `left_out` that are disks without a free edge. A facing has a free edge, or is a ring.
    pub(super) fn new(left_out: &[usize], mesh: &ClothMesh) -> Self {
        let is_out = |p: u32| mesh.piece_of(p).is_some_and(|piece| left_out.contains(&piece));
        let mut welds = DisjointSets::new(mesh.flat.len());
        let mut groups = DisjointSets::new(mesh.pieces.len());
        let pairs = || mesh.seams.iter().flat_map(|seam| &seam.pairs);
        for &[a, b] in pairs().filter(|pair| pair.iter().all(|p| is_out(*p))) {
            welds.join(a, b);
            if let [Some(a), Some(b)] = [a, b].map(|p| mesh.piece_of(p)) {
                groups.join(a as u32, b as u32);
            }
        }
        let joints: Vec<[u32; 2]> = pairs()
            .flat_map(|&[a, b]| [[a, b], [b, a]])
            .filter(|[own, other]| is_out(*own) && !is_out(*other))
            .map(|[own, other]| [welds.root(own), other])
            .collect();
        let sewn: BTreeSet<u32> = joints.iter().map(|joint| joint[0]).collect();
        let roots: BTreeSet<u32> = left_out.iter().map(|piece| groups.root(*piece as u32)).collect();
        let closing = |root: u32| {
            let own = left_out.iter().filter(|piece| groups.root(**piece as u32) == root);
            let triangles = own.flat_map(|piece| &mesh.triangles[mesh.pieces[*piece].triangles.clone()]);
            let welded: Vec<[u32; 3]> = triangles.map(|t| t.map(|p| welds.root(p))).collect();
            let rim = only_rim(&welded).filter(|rim| rim.is_subset(&sewn))?;
            Some(joints.iter().filter(|joint| rim.contains(&joint[0])).map(|joint| joint[1]).collect())
        };
        Self { sewn_to: roots.into_iter().filter_map(closing).collect() }
    }

    /// Whether one group of pieces closes an opening with these sides.
    pub(super) fn closes(&self, sides: &[[u32; 2]]) -> bool {
        let is_held = |held: &BTreeSet<u32>| {
            let count = sides.iter().filter(|side| side.iter().all(|p| held.contains(p))).count();
            !sides.is_empty() && count as f64 >= MOST_OF_RIM * sides.len() as f64
        };
        self.sewn_to.iter().any(is_held)
    }
}

/// The vertices on the rim of a surface with one rim, whichever way its triangles run: the halves of a bag are sewn
/// face to face. `None` with several rims or without one.
fn only_rim(triangles: &[[u32; 3]]) -> Option<BTreeSet<u32>> {
    let topology = Topology::new(triangles);
    let sides: Vec<[u32; 2]> = topology.rim_edges().map(|edge| edge.ends).collect();
    let rim: BTreeSet<u32> = sides.iter().flatten().copied().collect();
    let last = rim.last()?;
    let mut sets = DisjointSets::new(*last as usize + 1);
    for [a, b] in sides {
        sets.join(a, b);
    }
    rim.iter().all(|n| sets.same(*n, *last)).then_some(rim)
}
