//! Messages where it is not clear how a garment is worn.

use super::ends::Ends;
use super::glue::Glued;
use super::openings::GluedOpening;
use crate::geometry::MM;
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// Two ways of wearing a garment fit about as well.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("it is not clear how the garment is worn: {}", list(openings))]
pub struct DealError {
    /// The openings that differ.
    pub openings: Vec<Doubt>,
    /// By how much the second way costs more; 0.7 is clear.
    pub margin: f64,
}

/// An opening that two ways of wearing give to different parts of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// Where it is: edges as `piece.edge`, longest first.
    pub edges: Vec<String>,
    /// Length, mm.
    pub length_mm: f64,
    /// The part of the body in it in the better dealing, and in the other.
    pub ways: [Ends; 2],
}

impl DealError {
    pub(super) fn new(
        garment: &Garment,
        mesh: &ClothMesh,
        glued: &Glued,
        openings: &[GluedOpening],
        best: &[Ends],
        next: &[Ends],
        margin: f64,
    ) -> Self {
        let differ = |&i: &usize| best[i] != next[i];
        let doubt = |i: usize| Doubt {
            edges: edges(garment, mesh, glued, &openings[i]),
            length_mm: MM * openings[i].length,
            ways: [best[i], next[i]],
        };
        Self { openings: (0..openings.len()).filter(differ).map(doubt).collect(), margin }
    }
}

fn list(openings: &[Doubt]) -> String {
    let one = |o: &Doubt| {
        let [best, next] = o.ways;
        format!("the opening of {:.0} mm at {} may be for {best} or for {next}", o.length_mm, o.edges.join(", "))
    };
    openings.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// Most edges that are named.
const MOST: usize = 3;

/// The edges that an opening's rim runs along, as `piece.edge`, those with most of it first; the piece alone where it
/// runs along a fold.
pub fn edges(garment: &Garment, mesh: &ClothMesh, glued: &Glued, opening: &GluedOpening) -> Vec<String> {
    let mut on_rim = vec![false; glued.count];
    opening.rim.iter().for_each(|&n| on_rim[n as usize] = true);
    let is_on = |p: u32| glued.node_of[p as usize].is_some_and(|n| on_rim[n as usize]);
    let mut found = Vec::new();
    for (piece, part) in mesh.pieces.iter().enumerate() {
        for edge in &part.edges {
            let count = edge.particles.windows(2).filter(|w| is_on(w[0]) && is_on(w[1])).count();
            if count > 0 {
                found.push((count, format!("{}.{}", garment.pieces[piece].name, edge.name), piece));
            }
        }
        let own = |side: &&[u32; 2]| part.particles.contains(&(side[0] as usize));
        let sides = opening.sides.iter().filter(own).count();
        if sides > 0 && !found.iter().any(|f| f.2 == piece) {
            found.push((sides, garment.pieces[piece].name.clone(), piece));
        }
    }
    found.sort_by_key(|f| std::cmp::Reverse(f.0));
    found.truncate(MOST);
    found.into_iter().map(|f| f.1).collect()
}
