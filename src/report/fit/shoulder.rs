//! Where the seam or opening round an arm is, against the point of the shoulder.

use std::collections::BTreeMap;

use super::{WornLength, mm};
use crate::geometry::{Vec3, sorted_pair};
use crate::mannequin::{Mannequin, PartKind};
use crate::mesh::ClothMesh;
use crate::report::openings::SewnRim;
use crate::verify::{Through, Welded, worn};

/// For each arm the seam or opening round it that is nearest to the point of the shoulder: how far beyond that point
/// its highest place is, away from the middle of the body.
pub(super) fn shoulders(mesh: &ClothMesh, welded: &Welded, openings: &[SewnRim], body: &Mannequin) -> Vec<WornLength> {
    let mut loops: Vec<Vec<Vec3>> = seam_loops(mesh, welded);
    loops.extend(openings.iter().map(|opening| opening.positions(welded)));
    let through: Vec<Option<Through>> = worn(&loops, body).into_iter().map(|passage| passage.through).collect();
    let arm = |(kind, side, sign): (PartKind, &str, f64)| {
        let shoulder = body.part(kind)?.landmarks.iter().find(|(name, _)| name == "shoulder")?.1;
        let own = loops.iter().zip(&through).filter(|(_, through)| **through == Some(Through::Part(kind)));
        let beyond = own.filter_map(|(ring, _)| {
            let top = ring.iter().max_by(|a, b| a.y.total_cmp(&b.y))?;
            Some(sign * (top.x - shoulder.x))
        });
        let value = beyond.min_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        let name = format!("{side} armhole");
        Some(WornLength { name, value: mm(value), against: format!("{side} shoulder"), level: None })
    };
    let arms = [(PartKind::LeftArm, "left", 1.0), (PartKind::RightArm, "right", -1.0)];
    arms.into_iter().filter_map(arm).collect()
}

/// Closed lines along which one piece is sewn to others.
fn seam_loops(mesh: &ClothMesh, welded: &Welded) -> Vec<Vec<Vec3>> {
    // Of every piece, the neighbours of each vertex along its seams with other pieces.
    let mut lines: BTreeMap<usize, BTreeMap<u32, Vec<u32>>> = BTreeMap::new();
    for seam in &mesh.seams {
        for step in seam.pairs.windows(2) {
            let [from, to] = [step[0], step[1]].map(|pair| welded.vertex_of[pair[0] as usize]);
            let pieces = step[0].map(|particle| mesh.piece_of(particle));
            if from == to || pieces[0] == pieces[1] {
                continue;
            }
            for piece in pieces.into_iter().flatten() {
                let line = lines.entry(piece).or_default();
                for [a, b] in [[from, to], [to, from]] {
                    let near = line.entry(a).or_default();
                    if !near.contains(&b) {
                        near.push(b);
                    }
                }
            }
        }
    }
    let mut loops: Vec<Vec<u32>> = lines.values().flat_map(closed).collect();
    // Two pieces that are sewn round together have one line.
    let mut known: Vec<Vec<[u32; 2]>> = Vec::new();
    loops.retain(|ring| {
        let mut edges: Vec<[u32; 2]> =
            ring.iter().zip(ring.iter().cycle().skip(1)).map(|(&a, &b)| sorted_pair([a, b])).collect();
        edges.sort_unstable();
        let is_new = !known.contains(&edges);
        known.push(edges);
        is_new
    });
    loops.iter().map(|ring| ring.iter().map(|&v| welded.surface.vertices[v as usize]).collect()).collect()
}

/// The closed lines of a piece: those whose vertices have two neighbours each.
fn closed(line: &BTreeMap<u32, Vec<u32>>) -> Vec<Vec<u32>> {
    let mut loops = Vec::new();
    let mut seen: Vec<u32> = Vec::new();
    for &start in line.keys() {
        if seen.contains(&start) {
            continue;
        }
        let (mut ring, mut last, mut here) = (vec![start], start, line[&start][0]);
        while here != start && line[&here].len() == 2 && ring.len() <= line.len() {
            ring.push(here);
            let next = line[&here].iter().copied().find(|v| *v != last).unwrap_or(start);
            (last, here) = (here, next);
        }
        let is_closed = here == start && line[&start].len() == 2 && ring.len() > 2;
        seen.extend(&ring);
        if is_closed {
            loops.push(ring);
        }
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_that_do_not_close_or_that_fork_are_left_out() {
        let line = |edges: &[[u32; 2]]| {
            let mut out: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
            for &[a, b] in edges {
                out.entry(a).or_default().push(b);
                out.entry(b).or_default().push(a);
            }
            closed(&out)
        };
        assert_eq!(line(&[[0, 1], [1, 2], [2, 3], [3, 0]]), [vec![0, 1, 2, 3]]);
        assert_eq!(line(&[[0, 1], [1, 2], [2, 3]]), [[0; 0]; 0]);
        assert_eq!(line(&[[0, 1], [1, 2], [2, 0], [5, 6], [6, 7], [7, 5]]).len(), 2);
        assert_eq!(line(&[[0, 1], [1, 2], [2, 0], [2, 3]]), [[0; 0]; 0]);
    }
}
