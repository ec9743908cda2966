//! Which pieces lie on others, and are no part of the surface that is glued.

use std::collections::{BTreeMap, BTreeSet};

use crate::geometry::DisjointSets;
use crate::mesh::ClothMesh;
use crate::pattern::{Garment, patches};

/// The pieces that lie on others, rising. Where more than two sheets meet along a seam, or two that go the same way
/// from it, the one furthest from the shell lies on the others; of as far ones the smallest. Pieces that are sewn to
/// it within its layer lie with it.
///
/// `sets` are the particles as they are welded; `is_out` those that are not part of the surface.
pub(super) fn left_out(garment: &Garment, mesh: &ClothMesh, is_out: &[bool], sets: &mut DisjointSets) -> Vec<usize> {
    let table = LayerGraph::new(garment, mesh, is_out);
    let root: Vec<u32> = (0..mesh.flat.len() as u32).map(|p| sets.root(p)).collect();
    let mut out: BTreeSet<usize> = patches(garment).into_iter().collect();
    loop {
        table.add_groups_without_hold(&mut out);
        let Some(loser) = table.most_in_the_way(&root, &out) else { break };
        out.extend(table.group(loser));
    }
    out.into_iter().collect()
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

    /// The piece that is in the way of others along most sides of triangles.
    fn most_in_the_way(&self, root: &[u32], out: &BTreeSet<usize>) -> Option<usize> {
        let mut ways: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        for (i, piece) in self.mesh.pieces.iter().enumerate().filter(|(i, _)| !out.contains(i)) {
            for t in &self.mesh.triangles[piece.triangles.clone()] {
                if t.iter().any(|&p| self.is_out[p as usize]) {
                    continue;
                }
                let corners = t.map(|p| root[p as usize]);
                for k in 0..3 {
                    let way = [corners[k], corners[(k + 1) % 3]];
                    if way[0] != way[1] {
                        ways.entry(way).or_default().push(i);
                    }
                }
            }
        }
        let mut votes: BTreeMap<usize, usize> = BTreeMap::new();
        for pieces in ways.into_values().filter(|pieces| pieces.len() > 1) {
            let distinct: BTreeSet<usize> = pieces.into_iter().collect();
            if distinct.len() > 1 {
                *votes.entry(self.outermost(&distinct)?).or_default() += 1;
            }
        }
        votes.into_iter().max_by_key(|&(piece, sides)| (sides, std::cmp::Reverse(piece))).map(|(piece, _)| piece)
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
