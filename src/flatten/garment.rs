//! Flattening every piece of a draped garment.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use rayon::prelude::*;

use super::element::FlatElement;
use super::overlap::Legs;
use super::{
    FlatReport, FlattenError, FlattenOptions, Itself, TargetSurface, align, check_start, measure, relax_sheet, start,
    topology,
};
use crate::geometry::{TriMesh, Vec2, Vec3, sorted_pair};
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::{Give, Seam};

/// A rim edge whose flat length should differ from its draped one by more than this share lies in cloth that a seam
/// draws in or out; the triangles around it do not show the cloth's own shape, as those along elastic do not.
const DRAWN: f64 = 0.05;
/// Weight of such triangles in the energy: enough to keep them in order, too little to pull at the others.
const SOFT: f64 = 0.05;

/// A garment laid flat.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatGarment {
    /// Flat position of every particle, metres, every piece turned and shifted onto its drawn place.
    pub positions: Vec<Vec2>,
    /// One per piece of the mesh, same order.
    pub pieces: Vec<FlatPiece>,
}

/// The result of one piece.
#[derive(Clone, Debug, PartialEq)]
pub struct FlatPiece {
    /// As in the garment.
    pub name: String,
    /// The figures.
    pub report: FlatReport,
}

/// Lays every piece of a draped garment flat, holes included. `seams` are the garment's, in the order of
/// `cloth.seams`; `draped` has one position per particle.
///
/// Edges that an even seam joins get one common length, the mean of both sides as draped (as nearly as the mode keeps
/// boundaries; exactly the same target); an edge in several seams gets the first one's. Edges of a seam with ease,
/// gather or stretch get their drawn ratio back: their drawn lengths times the stretch beyond the range between the
/// two. Edges that elastic draws in get their drawn lengths back. Never flips a triangle.
///
/// # Errors
/// [`FlattenError::Piece`] around the reason; [`FlattenError::StartLength`] if `draped` has not one position per
/// particle.
pub fn flatten_garment(
    cloth: &ClothMesh,
    seams: &[Seam],
    draped: &[Vec3],
    options: &FlattenOptions,
) -> Result<FlatGarment, FlattenError> {
    if draped.len() != cloth.flat.len() {
        return Err(FlattenError::StartLength { expected: cloth.flat.len(), found: draped.len() });
    }
    let targets = seam_targets(cloth, seams, draped);
    let gathered = cloth.on_elastic();
    let flattened: Vec<_> = cloth
        .pieces
        .par_iter()
        .map(|piece| {
            flatten_piece(cloth, piece, draped, (&targets, &gathered), options)
                .map_err(|source| FlattenError::Piece { piece: piece.name.clone(), source: Box::new(source) })
        })
        .collect();
    let mut positions = cloth.flat.clone();
    let mut pieces = Vec::with_capacity(cloth.pieces.len());
    for (piece, result) in cloth.pieces.iter().zip(flattened) {
        let (flat, report) = result?;
        positions[piece.particles.clone()].copy_from_slice(&flat);
        pieces.push(FlatPiece { name: piece.name.clone(), report });
    }
    Ok(FlatGarment { positions, pieces })
}

fn flatten_piece(
    cloth: &ClothMesh,
    piece: &PieceMesh,
    draped: &[Vec3],
    (targets, gathered): (&Targets, &HashSet<u32>),
    options: &FlattenOptions,
) -> Result<(Vec<Vec2>, FlatReport), FlattenError> {
    let first = piece.particles.start as u32;
    let surface = TriMesh {
        vertices: draped[piece.particles.clone()].to_vec(),
        triangles: cloth.triangles[piece.triangles.clone()].iter().map(|t| t.map(|v| v.wrapping_sub(first))).collect(),
    };
    let drawn = &cloth.flat[piece.particles.clone()];
    let (topology, rims) = topology::check(&surface)?;
    let start = match (check_start(&surface, drawn), &rims[..]) {
        (Ok(()), _) => drawn.to_vec(),
        // A drawing with flaws is no start, but a disk does not need it.
        (Err(_), [rim]) => start::start(&surface, &topology, rim)?.0,
        (Err(flaw), _) => return Err(flaw),
    };
    let mut sheet = TargetSurface::as_it_is(&surface, topology, rims);
    sheet.warp = piece.warp;
    sheet.legs = legs_of_darts(cloth, piece);
    let mut forced = draw_out(&mut sheet, first, targets);
    forced.extend(gathered.iter().filter_map(|&v| v.checked_sub(first)));
    let_out(&mut sheet, drawn, &forced);
    let mut flattened = relax_sheet(&sheet, start, options, Itself::MayMeet)?;
    align::onto(&mut flattened.positions, drawn);
    Ok((flattened.positions, flattened.report))
}

/// Wanted flat lengths of sewn rim edges by their ends (global particles, smaller first).
type Targets = HashMap<[u32; 2], f64>;

/// Edges along elastic get their drawn lengths, whatever is sewn to them. Of another edge that several seams join, as a
/// waist between band and lining, the first seam's target counts: a later one that took it over would leave the first
/// one's sides with two lengths. An edge that a later even seam joins to such an edge takes its target.
fn seam_targets(cloth: &ClothMesh, seams: &[Seam], draped: &[Vec3]) -> Targets {
    let length = |[a, b]: [u32; 2]| (cloth.flat[b as usize] - cloth.flat[a as usize]).norm();
    let mut targets: Targets = cloth.drawn_in().into_keys().map(|ends| (ends, length(ends))).collect();
    for (k, stitches) in cloth.seams.iter().enumerate() {
        let give = seams.get(k).map_or(Give::Even, |s| s.give);
        for step in stitches.pairs.windows(2) {
            let [a, b] = [0, 1].map(|side| [step[0][side], step[1][side]]);
            // Where a chain passes on to its next edge one side stands still.
            if a[0] == a[1] || b[0] == b[1] {
                continue;
            }
            let drawn = [a, b].map(|e| (cloth.flat[e[1] as usize] - cloth.flat[e[0] as usize]).norm());
            let sewn = [a, b].map(|e| (draped[e[1] as usize] - draped[e[0] as usize]).norm());
            let known = [a, b].iter().find_map(|&ends| targets.get(&sorted_pair(ends)).copied());
            let wanted = match known {
                Some(length) if give == Give::Even => [length; 2],
                _ => wanted_lengths(give, drawn, (sewn[0] + sewn[1]) / 2.0),
            };
            for (ends, length) in [(a, wanted[0]), (b, wanted[1])] {
                if length > 0.0 {
                    targets.entry(sorted_pair(ends)).or_insert(length);
                }
            }
        }
    }
    targets
}

/// Flat lengths of the two sides of a stitch of length `sewn`.
fn wanted_lengths(give: Give, drawn: [f64; 2], sewn: f64) -> [f64; 2] {
    if give == Give::Even {
        return [sewn; 2];
    }
    // Any sewn length between the two drawn ones is as it should be; beyond, the cloth itself is strained.
    let meant = sewn.clamp(drawn[0].min(drawn[1]), drawn[0].max(drawn[1]));
    drawn.map(|d| if meant > 0.0 { d * sewn / meant } else { sewn })
}

/// The legs of the darts of a piece, which its seams sew on each other from or to a tip.
fn legs_of_darts(cloth: &ClothMesh, piece: &PieceMesh) -> Legs {
    let first = piece.particles.start as u32;
    let is_own = |p: &u32| piece.particles.contains(&(*p as usize));
    let is_dart = |pairs: &[[u32; 2]]| pairs.iter().any(|[a, b]| a == b) && pairs.iter().flatten().all(is_own);
    let darts = cloth.seams.iter().enumerate().filter(|(_, seam)| is_dart(&seam.pairs));
    let edges = darts.flat_map(|(dart, seam)| {
        let steps = seam.pairs.windows(2);
        let both = steps.flat_map(|step| [0, 1].map(|leg| sorted_pair([step[0][leg] - first, step[1][leg] - first])));
        both.map(move |edge| (edge, dart))
    });
    edges.collect()
}

/// Gives the sheet's rim its wanted lengths, and the triangles on it shapes to match; gives the vertices that a seam
/// draws in or out by much.
fn draw_out(sheet: &mut TargetSurface<'_>, first: u32, targets: &Targets) -> HashSet<u32> {
    let mut drawn = HashSet::new();
    for (edge, target) in sheet.topology.rim_edges().zip(&mut sheet.rim_targets) {
        let [a, b] = edge.ends;
        let Some(&wanted) = targets.get(&[a + first, b + first]) else { continue };
        let ratio = wanted / *target;
        *target = wanted;
        if let Some(t) = edge.triangles[0] {
            let t = t as usize;
            Arc::make_mut(&mut sheet.elements)[t] = stretched(sheet.surface, t, [a, b], ratio);
        }
        if (ratio - 1.0).abs() > DRAWN {
            drawn.extend([a, b]);
        }
    }
    drawn
}

/// Gives triangles that a seam or elastic forces, those with a corner on it, their drawn shape: as draped they show
/// what draws them in, not the cloth. A strip gathered to a sixth would be flattened into a coil.
fn let_out(sheet: &mut TargetSurface<'_>, drawn: &[Vec2], forced: &HashSet<u32>) {
    for element in Arc::make_mut(&mut sheet.elements) {
        let corners = element.corners;
        if !corners.iter().any(|v| forced.contains(v)) {
            continue;
        }
        let drawn = corners.map(|v| drawn[v as usize]);
        *element = FlatElement::from_plane(corners, drawn);
        element.area *= SOFT;
        let before = start::angles(corners.map(|v| sheet.surface.vertices[v as usize]));
        let after = start::angles(drawn.map(|p| p.push(0.0)));
        sheet.wider.extend((0..3).map(|k| (corners[k], after[k] - before[k])));
    }
}

/// The shape of triangle `t` when it is drawn out along its edge `ends`.
fn stretched(surface: &TriMesh, t: usize, ends: [u32; 2], ratio: f64) -> FlatElement {
    let mut corners = surface.triangles[t];
    // Rim edge first: a triangle's corners may be turned round without changing it.
    while ends.contains(&corners[2]) {
        corners.rotate_left(1);
    }
    let [a, b, c] = corners.map(|v| surface.vertices[v as usize]);
    let length = measure::length(surface, ends);
    let along = (b - a) / length;
    let foot = (c - a).dot(&along);
    let height = (c - a).cross(&along).norm();
    let plane = [Vec2::zeros(), Vec2::new(length * ratio, 0.0), Vec2::new(foot * ratio, height)];
    FlatElement::from_plane(corners, plane)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Stitches;
    use crate::pattern::SeamKind;
    use approx::assert_relative_eq;

    fn seam(give: Give) -> Seam {
        let (name, a, b, marks) = (String::new(), Vec::new(), Vec::new(), Vec::new());
        Seam { name, a, b, marks, give, stage: 0, kind: SeamKind::Written, closure: None }
    }

    /// Flat lengths wanted of a band, a shell and a lining, drawn 100, 150 and 150 mm long and sewn 110, for seams
    /// between two of them.
    fn wanted(seams: &[(Give, [u32; 2])]) -> [f64; 3] {
        let line = |length: f64| [Vec2::zeros(), Vec2::new(length, 0.0)];
        let flat = [0.10, 0.15, 0.15].into_iter().flat_map(line).collect();
        let draped: Vec<Vec3> = (0..3).flat_map(|_| line(0.11)).map(|p| p.push(0.0)).collect();
        let stitches = |&(_, [a, b]): &(Give, [u32; 2])| Stitches {
            name: String::new(),
            stage: 1,
            pairs: vec![[2 * a, 2 * b], [2 * a + 1, 2 * b + 1]],
        };
        let cloth = ClothMesh { flat, seams: seams.iter().map(stitches).collect(), ..ClothMesh::default() };
        let gives: Vec<Seam> = seams.iter().map(|s| seam(s.0)).collect();
        let targets = seam_targets(&cloth, &gives, &draped);
        [0, 1, 2].map(|k| targets[&[2 * k, 2 * k + 1]])
    }

    #[test]
    fn of_an_edge_in_two_seams_the_first_ones_target_counts() {
        const BAND: u32 = 0;
        const SHELL: u32 = 1;
        const LINING: u32 = 2;
        let (gathers, lines) = ((Give::Gather(1.5), [SHELL, BAND]), (Give::Even, [SHELL, LINING]));
        // The gathered shell keeps its drawn length, and its lining fits it.
        let [band, shell, lining] = wanted(&[gathers, lines]);
        assert_relative_eq!(band, 0.10, epsilon = 1e-12);
        assert_relative_eq!(shell, 0.15, epsilon = 1e-12);
        assert_eq!(shell, lining);
        // The other way round shell and lining have their sewn length.
        let [band, shell, lining] = wanted(&[lines, gathers]);
        assert_relative_eq!(band, 0.10, epsilon = 1e-12);
        assert_relative_eq!(shell, 0.11, epsilon = 1e-12);
        assert_eq!(shell, lining);
    }
}
