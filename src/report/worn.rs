//! The rows of openings: the body part that passes through each, its earlier places, and its fault.

use std::collections::HashMap;

use super::measured::Measured;
use super::misworn::Wear;
use super::openings::{SewnRim, flaps, opening_names};
use super::schema::Worn;
use super::seen::Seen;
use crate::geometry::{MM, Vec3, sorted_pair};
use crate::mesh::ClothMesh;
use crate::pattern::written_names;
use crate::verify::Welded;

/// Rows of the openings of the garment `welded`, its latest state. Edges of flaps are left out.
pub(super) fn worn_rows(run: &Measured, welded: &Welded, openings: &[SewnRim]) -> Vec<Worn> {
    let all: Vec<&SewnRim> = openings.iter().collect();
    let seen = Seen::new(&all, welded, run.body);
    let rings: Vec<&[u32]> = openings.iter().map(|o| o.ring.as_slice()).collect();
    let flaps = flaps(&rings, &seen.iter().map(|seen| seen.passage.through.is_some()).collect::<Vec<bool>>());
    let open: Vec<&SewnRim> = all.into_iter().zip(&flaps).filter(|(_, flap)| !**flap).map(|(o, _)| o).collect();
    let now: Vec<Seen> = seen.into_iter().zip(&flaps).filter(|(_, flap)| !**flap).map(|(seen, _)| seen).collect();
    let at = |positions: &[Vec3]| Seen::new(&open, &Welded::new(run.mesh, run.weld, positions), run.body);
    let (placed, sewn) = (run.placed.map(at), run.draped.and(run.sewn).map(at));
    let names = opening_names(&open.iter().map(|o| o.edges.clone()).collect::<Vec<_>>());
    let faults = Wear::new(run, welded, open.clone(), &names, [placed.as_deref(), sewn.as_deref()], &now).faults();
    let drawn = drawn_edges(run.mesh, welded);
    let before = |state: &Option<Vec<Seen>>, k: usize| state.as_ref().map(|seen| seen[k].before());
    let row = |(k, fault): (usize, Option<_>)| Worn {
        opening: names[k].clone(),
        body_part: now[k].part(),
        edges: written_names(open[k].edges.iter().map(|(piece, edge)| (piece.as_str(), edge.as_str()))),
        length: now[k].length * MM,
        length_flat: length_flat(open[k], welded, &drawn) * MM,
        past_end: now[k].past_end.map(|past| past * MM),
        height: now[k].height * MM,
        level: now[k].level * MM,
        placed: before(&placed, k),
        sewn: before(&sewn, k),
        fault,
    };
    faults.into_iter().enumerate().map(row).collect()
}

/// Length as drawn of every edge of the pieces' rims, metres, by its vertices.
fn drawn_edges(mesh: &ClothMesh, welded: &Welded) -> HashMap<[u32; 2], f64> {
    let steps = mesh.pieces.iter().flat_map(|piece| &piece.edges).flat_map(|edge| edge.particles.windows(2));
    let edge = |step: &[u32]| {
        let [a, b] = [step[0], step[1]];
        let length = (mesh.flat[a as usize] - mesh.flat[b as usize]).norm();
        (sorted_pair([a, b].map(|p| welded.vertex_of[p as usize])), length)
    };
    steps.map(edge).collect()
}

/// Length of an opening as drawn, metres. A part of it that nobody drew has its length as worn.
fn length_flat(opening: &SewnRim, welded: &Welded, drawn: &HashMap<[u32; 2], f64>) -> f64 {
    let next = opening.ring.iter().cycle().skip(1);
    let step = |(&a, &b): (&u32, &u32)| {
        let worn = (welded.surface.vertices[a as usize] - welded.surface.vertices[b as usize]).norm();
        drawn.get(&sorted_pair([a, b])).copied().unwrap_or(worn)
    };
    opening.ring.iter().zip(next).map(step).sum()
}
