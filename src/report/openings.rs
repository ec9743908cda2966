//! Openings: the rims of the sewn garment, and their names.

use std::collections::{HashMap, HashSet};

use crate::geometry::{Vec3, rim_loops, sorted_pair};
use crate::mesh::ClothMesh;
use crate::pattern::{
    Bridge, EdgeId, Fastening, Garment, Piece, RimSpot, Side, Step, patches, worn_rims, written_edge,
};
use crate::verify::Welded;

/// The edge that a stretch of rim belongs to. None for a chord that joins no two particles of one edge.
type Owner = Option<EdgeId>;

/// A rim of the sewn garment.
#[derive(Clone, Debug)]
pub(super) struct SewnRim {
    /// Vertices of the welded surface, in order.
    pub(super) ring: Vec<u32>,
    /// (piece, edge) names round it, in order, each once.
    pub(super) edges: Vec<(String, String)>,
    /// Flat areas of the pieces round it, m², rising.
    pub(super) areas: Vec<f64>,
    /// Whether both of every pair of pieces are round it, of one pair at least.
    pub(super) is_symmetric: bool,
}

impl SewnRim {
    /// Positions round the rim.
    pub(super) fn positions(&self, welded: &Welded) -> Vec<Vec3> {
        self.ring.iter().map(|&v| welded.surface.vertices[v as usize]).collect()
    }
}

/// Every rim of the garment with its free edges, without stretches that `closed` closes and without rims of patches.
pub(super) fn openings(garment: &Garment, mesh: &ClothMesh, welded: &Welded, closed: &[Fastening]) -> Vec<SewnRim> {
    let owners = edge_owners(mesh, welded);
    let loops = rim_loops(&welded.surface.triangles);
    let rims: Vec<Vec<Step<Owner>>> = loops
        .iter()
        .map(|ring| {
            let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
            let step = |(&v, &w): (&u32, &u32)| {
                let [p, q] = [v, w].map(|v| welded.surface.vertices[v as usize]);
                Step { along: owners.get(&sorted_pair([v, w])).copied(), length: (q - p).norm() }
            };
            pairs.map(step).collect()
        })
        .collect();
    let bridges: Vec<Bridge<Owner>> = closed.iter().filter_map(|f| bridge(mesh, welded, &loops, f)).collect();
    let patches = patches(garment);
    let opening = |steps: Vec<[usize; 2]>| {
        let mut edges: Vec<EdgeId> = Vec::new();
        for edge in steps.iter().filter_map(|&[r, k]| rims[r][k].along) {
            if !edges.contains(&edge) {
                edges.push(edge);
            }
        }
        let patch = !edges.is_empty() && edges.iter().all(|e| patches.contains(&e.piece));
        let ring = steps.iter().map(|&[r, k]| loops[r][k]).collect();
        let areas = areas(mesh, edges.iter().map(|e| e.piece).collect());
        let is_symmetric = is_symmetric(garment, &edges);
        (!patch).then(|| SewnRim { ring, edges: edges.iter().map(|&e| names(mesh, e)).collect(), areas, is_symmetric })
    };
    worn_rims(&rims, &bridges).into_iter().filter_map(opening).collect()
}

/// A fastening between the vertices of the rims that are nearest to its ends, if they are on rims.
fn bridge(mesh: &ClothMesh, welded: &Welded, loops: &[Vec<u32>], f: &Fastening) -> Option<Bridge<Owner>> {
    let [a, b] = f.ends.each_ref().map(|spot| corner(mesh, welded, loops, spot));
    Some(Bridge { corners: [a?, b?], along: f.ends.map(|e| Some(e.edge)), reach: f.reach, row: f.row })
}

/// The rim, and the vertex of it, that is nearest to a spot of an edge.
pub(super) fn corner(mesh: &ClothMesh, welded: &Welded, loops: &[Vec<u32>], spot: &RimSpot) -> Option<[usize; 2]> {
    let edges = &mesh.pieces.get(spot.edge.piece)?.edges;
    let edge = edges.iter().find(|e| e.edge == spot.edge)?;
    let mut best: Option<(f64, [usize; 2])> = None;
    let mut along = 0.0;
    for (i, &p) in edge.particles.iter().enumerate() {
        if i > 0 {
            along += (mesh.flat[p as usize] - mesh.flat[edge.particles[i - 1] as usize]).norm();
        }
        let far = (along - spot.at).abs();
        if best.is_none_or(|b| far < b.0) {
            let v = welded.vertex_of[p as usize];
            let found = loops.iter().enumerate().find_map(|(r, l)| Some([r, l.iter().position(|&w| w == v)?]));
            best = found.map(|found| (far, found)).or(best);
        }
    }
    best.map(|b| b.1)
}

/// Flat areas of the pieces of these numbers, each once, rising.
fn areas(mesh: &ClothMesh, mut pieces: Vec<usize>) -> Vec<f64> {
    pieces.sort_unstable();
    pieces.dedup();
    let area = |t: usize| {
        let [a, b, c] = mesh.triangles[t].map(|p| mesh.flat[p as usize]);
        0.5 * (b - a).perp(&(c - a)).abs()
    };
    let of = |piece: usize| mesh.pieces[piece].triangles.clone().map(area).sum();
    let mut areas: Vec<f64> = pieces.into_iter().map(of).collect();
    areas.sort_by(f64::total_cmp);
    areas
}

/// Whether of every pair of pieces with one of these edges both have one, and there is such a pair.
fn is_symmetric(garment: &Garment, edges: &[EdgeId]) -> bool {
    let pieces = || edges.iter().filter_map(|edge| garment.pieces.get(edge.piece)).filter(|piece| piece.side.is_some());
    let has_twin = |own: &Piece| pieces().any(|piece| piece.is_twin(own));
    pieces().next().is_some() && pieces().all(has_twin)
}

fn names(mesh: &ClothMesh, id: EdgeId) -> (String, String) {
    let piece = &mesh.pieces[id.piece];
    let edge = piece.edges.iter().find(|e| e.edge == id).map_or("", |e| e.name.as_str());
    (piece.name.clone(), edge.to_owned())
}

/// Marks rims that are edges of flaps and no openings, such as the edge of a collar sewn on over a neckline (`face:
/// same`). The rim on one side of that seam is the neckline. The other runs round the collar and back along the same
/// stitches, and nothing passes through it. Every ring through which nothing passes, and which shares rim edges with
/// one that is worn, is the edge of a flap.
pub(super) fn flaps(rings: &[&[u32]], worn: &[bool]) -> Vec<bool> {
    let edges = |ring: &[u32]| {
        (0..ring.len()).map(|k| sorted_pair([ring[k], ring[(k + 1) % ring.len()]])).collect::<HashSet<[u32; 2]>>()
    };
    let of_worn: HashSet<[u32; 2]> = rings.iter().zip(worn).filter(|(_, w)| **w).flat_map(|(r, _)| edges(r)).collect();
    rings.iter().zip(worn).map(|(ring, worn)| !worn && !edges(ring).is_disjoint(&of_worn)).collect()
}

/// The piece edge that every rim edge of the surface belongs to.
fn edge_owners(mesh: &ClothMesh, welded: &Welded) -> HashMap<[u32; 2], EdgeId> {
    let mut owners = HashMap::new();
    for edge in mesh.pieces.iter().flat_map(|piece| &piece.edges) {
        for step in edge.particles.windows(2) {
            let ends = [step[0], step[1]].map(|p| welded.vertex_of[p as usize]);
            owners.entry(sorted_pair(ends)).or_insert(edge.edge);
        }
    }
    owners
}

/// A name for every opening, given the (piece, edge) names round each: `neck` for `front.L.neck` and `back.neck`,
/// `hem.L` where all pieces are left ones, `sleeve.L.hem` for one piece or half, `neck + front_edge` for different
/// edges. Names that would be the same are numbered: `hem`, `hem (2)`.
pub fn opening_names(openings: &[Vec<(String, String)>]) -> Vec<String> {
    let mut used: HashMap<String, usize> = HashMap::new();
    let mut number = |name: String| {
        let count = used.entry(name.clone()).or_insert(0);
        *count += 1;
        if *count == 1 { name } else { format!("{name} ({count})") }
    };
    openings.iter().map(|edges| number(name(edges))).collect()
}

/// More edges than this are not spelled out.
const EDGES_NAMED: usize = 3;

fn name(edges: &[(String, String)]) -> String {
    let mut bases: Vec<String> = Vec::new();
    for (_, edge) in edges {
        let base = written_edge(edge);
        if !bases.contains(&base) {
            bases.push(base);
        }
    }
    let more = if bases.len() > EDGES_NAMED { " + …" } else { "" };
    let names = bases[..bases.len().min(EDGES_NAMED)].join(" + ");
    let Some((first, _)) = edges.first() else { return "rim".into() };
    // Of one of a pair, or of an edge of one half of a folded piece.
    let mut sides = edges.iter().map(|(piece, edge)| Side::split(piece).1.or_else(|| Side::split(edge).1));
    let common = sides.next().flatten().filter(|s| sides.all(|other| other == Some(*s)));
    let one_piece = edges.iter().all(|(piece, _)| piece == first);
    let unsaid = common.filter(|_| !(one_piece && Side::split(first).1.is_some()));
    let suffix = unsaid.map_or("", Side::suffix);
    if one_piece { format!("{first}{suffix}.{names}{more}") } else { format!("{names}{suffix}{more}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A neckline 0 1 2 3 with a collar 4 5 6 sewn on from 0 over 1 to 2. A pocket 7 8 9 elsewhere.
    #[test]
    fn the_edge_of_a_collar_is_no_opening_and_a_pocket_is() {
        let rings: [&[u32]; 3] = [&[0, 1, 2, 3], &[4, 5, 6, 2, 1, 0], &[7, 8, 9]];
        assert_eq!(flaps(&rings, &[true, false, false]), [false, true, false]);
        // Nobody wears it: both are said to be empty.
        assert_eq!(flaps(&rings, &[false; 3]), [false; 3]);
        // What something goes through is an opening, whatever it shares.
        assert_eq!(flaps(&rings, &[true, true, false]), [false; 3]);
    }
}
