//! Which pieces lie on others, and are no part of the surface that is glued; and which are part of it turned over.

use std::collections::{BTreeMap, BTreeSet};

use crate::geometry::DisjointSets;
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, patches};

/// How the pieces of a garment make one surface.
pub(super) struct Sheets {
    /// Indices of the pieces that lie on others, rising, and are no part of it.
    pub(super) left_out: Vec<usize>,
    /// Indices of the pieces that are part of it turned over, rising.
    pub(super) turned: Vec<usize>,
}

/// Finds the pieces that lie on others. Where more than two sheets meet along a seam, or two that go the same way
/// from it, the one furthest from the shell lies on the others; of as far ones the smallest. Pieces that are sewn to
/// it within its layer lie with it.
///
/// A piece is turned over instead if then nothing is in the way any more and it is sewn to two sheets: the front of a
/// lapel, whose collar stands at the back.
///
/// `sets` are the particles as they are welded; `is_out` those that are not part of the surface.
pub(super) fn sheets(garment: &Garment, mesh: &ClothMesh, is_out: &[bool], sets: &mut DisjointSets) -> Sheets {
    let table = LayerGraph::new(garment, mesh, is_out);
    let root: Vec<u32> = (0..mesh.flat.len() as u32).map(|p| sets.root(p)).collect();
    let mut out: BTreeSet<usize> = patches(garment).into_iter().collect();
    let mut turned = BTreeSet::new();
    loop {
        table.add_groups_without_hold(&mut out);
        let Some(loser) = most(table.in_the_way(&root, &out, &turned)) else { break };
        let group = table.group(loser);
        match table.turned(&group, &root, &out, &turned) {
            Some(more) => turned.extend(more),
            None => out.extend(group),
        }
    }
    turned.retain(|piece| !out.contains(piece));
    Sheets { left_out: out.into_iter().collect(), turned: turned.into_iter().collect() }
}

/// The piece with most votes, of several the first.
fn most(votes: BTreeMap<usize, usize>) -> Option<usize> {
    votes.into_iter().max_by_key(|&(piece, sides)| (sides, std::cmp::Reverse(piece))).map(|(piece, _)| piece)
}

/// Pieces and what joins them.
struct LayerGraph<'a> {
    garment: &'a Garment,
    mesh: &'a ClothMesh,
    is_out: &'a [bool],
    piece_of: Vec<usize>,
}

impl<'a> LayerGraph<'a> {
    fn new(garment: &'a Garment, mesh: &'a ClothMesh, is_out: &'a [bool]) -> Self {
        let mut piece_of = vec![0; mesh.flat.len()];
        for (i, piece) in mesh.pieces.iter().enumerate() {
            piece_of[piece.particles.clone()].fill(i);
        }
        Self { garment, mesh, is_out, piece_of }
    }

    fn layer(&self, piece: usize) -> i32 {
        self.garment.pieces[piece].layer
    }

    /// The pieces of both particles of every stitch, and whether both are part of the surface.
    fn joints(&self) -> impl Iterator<Item = ([usize; 2], bool)> + '_ {
        let pairs = self.mesh.seams.iter().flat_map(|seam| &seam.pairs);
        pairs.map(|pair| {
            let open = pair.iter().all(|&p| !self.is_out[p as usize]);
            (pair.map(|p| self.piece_of[p as usize]), open)
        })
    }

    /// A piece with those that are sewn to it within its layer; of the shell the piece alone.
    fn group(&self, piece: usize) -> BTreeSet<usize> {
        let layer = self.layer(piece);
        let mut group = BTreeSet::from([piece]);
        if layer == 0 {
            return group;
        }
        loop {
            let before = group.len();
            for ([a, b], _) in self.joints().filter(|(pieces, _)| pieces.iter().all(|&p| self.layer(p) == layer)) {
                if group.contains(&a) || group.contains(&b) {
                    group.extend([a, b]);
                }
            }
            if group.len() == before {
                return group;
            }
        }
    }

    /// Adds the groups beside the shell that are sewn to other layers, but only to what is left out or turned over.
    fn add_groups_without_hold(&self, out: &mut BTreeSet<usize>) {
        for piece in (0..self.mesh.pieces.len()).filter(|&p| self.layer(p) != 0) {
            if out.contains(&piece) {
                continue;
            }
            let group = self.group(piece);
            let (mut sewn, mut held) = (false, false);
            for (pieces, open) in self.joints() {
                let [own, other] = [0, 1].map(|k| group.contains(&pieces[k]));
                if own != other {
                    let beyond = pieces[usize::from(own)];
                    sewn = true;
                    held |= open && !out.contains(&beyond);
                }
            }
            if sewn && !held {
                out.extend(group);
            }
        }
    }

    /// The pieces of a group that are to be turned over, so that none of it is in the way any more. `None` if that
    /// cannot be, or if one of them lies on cloth that is one sheet there, as a flat collar on a neckline: what a lapel
    /// is in the way of is a front and, apart from it, a collar.
    fn turned(
        &self,
        group: &BTreeSet<usize>,
        root: &[u32],
        out: &BTreeSet<usize>,
        before: &BTreeSet<usize>,
    ) -> Option<BTreeSet<usize>> {
        let mut more = BTreeSet::new();
        loop {
            let turned = before.union(&more).copied().collect();
            let mut votes = self.in_the_way(root, out, &turned);
            votes.retain(|piece, _| group.contains(piece));
            let Some(loser) = most(votes) else { break };
            if turned.contains(&loser) || !more.insert(loser) {
                return None;
            }
        }
        let crowds = self.crowds(root, out, before);
        let is_lapel = |piece: &usize| {
            let beside = crowds.iter().filter(|crowd| crowd.contains(piece)).flatten();
            !self.is_one_sheet(&beside.copied().filter(|p| p != piece).collect())
        };
        more.iter().all(is_lapel).then_some(more)
    }

    /// Whether pieces hang together along the seams between them.
    fn is_one_sheet(&self, pieces: &BTreeSet<usize>) -> bool {
        let mut sets = DisjointSets::new(self.mesh.pieces.len());
        for ([a, b], _) in self.joints().filter(|(joint, open)| *open && joint.iter().all(|p| pieces.contains(p))) {
            sets.join(a as u32, b as u32);
        }
        pieces.iter().all(|p| pieces.first().is_some_and(|first| sets.same(*first as u32, *p as u32)))
    }

    /// The pieces that are in the way of others, with the number of sides of triangles along which they are.
    fn in_the_way(&self, root: &[u32], out: &BTreeSet<usize>, turned: &BTreeSet<usize>) -> BTreeMap<usize, usize> {
        let mut votes: BTreeMap<usize, usize> = BTreeMap::new();
        for piece in self.crowds(root, out, turned).iter().filter_map(|crowd| self.outermost(crowd)) {
            *votes.entry(piece).or_default() += 1;
        }
        votes
    }

    /// The pieces that meet along sides of triangles and go the same way from there; for each such side those pieces.
    fn crowds(&self, root: &[u32], out: &BTreeSet<usize>, turned: &BTreeSet<usize>) -> Vec<BTreeSet<usize>> {
        let mut ways: BTreeMap<[u32; 2], BTreeSet<usize>> = BTreeMap::new();
        for (i, piece) in self.mesh.pieces.iter().enumerate().filter(|(i, _)| !out.contains(i)) {
            for t in &self.mesh.triangles[piece.triangles.clone()] {
                if t.iter().any(|&p| self.is_out[p as usize]) {
                    continue;
                }
                let corners = t.map(|p| root[p as usize]);
                for k in 0..3 {
                    let mut way = [corners[k], corners[(k + 1) % 3]];
                    if turned.contains(&i) {
                        way.reverse();
                    }
                    if way[0] != way[1] {
                        ways.entry(way).or_default().insert(i);
                    }
                }
            }
        }
        ways.into_values().filter(|pieces| pieces.len() > 1).collect()
    }

    /// Of these pieces the one furthest from the shell, of as far ones the smallest.
    fn outermost(&self, pieces: &BTreeSet<usize>) -> Option<usize> {
        let area = |p: usize| self.garment.pieces[p].area();
        pieces.iter().copied().max_by(|&a, &b| {
            let layers = self.layer(a).unsigned_abs().cmp(&self.layer(b).unsigned_abs());
            layers.then(area(b).total_cmp(&area(a)))
        })
    }
}
