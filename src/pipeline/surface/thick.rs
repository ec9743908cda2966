//! Sheets that are modelled with their thickness: both sides of the cloth and the rim between them, closed all round.
//! Laid flat as it is such a solid would be slit from one end to the other; its outer side is the piece.

use std::collections::HashMap;

use super::mend::leave_out;
use crate::geometry::{DisjointSets, MM, Vec3, sorted_pair};
use crate::io::obj_read::ObjFaces;

/// Faces that turn by more than 50° from each other belong to different sides (cosine).
const SHARP: f64 = 0.642_787_6;
/// Least area of the inner side of a sheet, as a share of the outer one's.
const INNER: f64 = 0.7;
/// Least area of both sides together, as a share of the whole surface.
const SIDES: f64 = 0.75;
/// A sheet is thinner than this share of the root of its area: a cushion's boxing is not.
const THIN: f64 = 0.05;

/// Leaves out the inner sides and the rims of sheets with thickness; says of each what it is. `same` has the vertex
/// that stands for every vertex, `metres` is the unit of the file, `stem` the name of what has none.
pub(super) fn leave_outer_sides(faces: &mut ObjFaces, same: &[u32], metres: f64, stem: &str) -> Vec<String> {
    let mut notes = Vec::new();
    for solid in solids(faces, same) {
        let group = &faces.groups[faces.group_of_face[solid.faces[0]] as usize];
        let name = if group.is_empty() { stem } else { group };
        let Some(sheet) = solid.as_sheet(faces, same) else { continue };
        notes.push(format!(
            "'{name}' is a sheet {:.1} mm thick: its outer side is laid flat, its inner side and its rim are left out",
            sheet.thickness * metres * MM
        ));
        sheet.left_out.into_iter().for_each(|f| leave_out(faces, f));
    }
    notes
}

/// A side of faces between two vertices: the faces, and whether each runs along it from the smaller to the larger.
type Sides = HashMap<[u32; 2], Vec<(usize, bool)>>;

/// Two vertices and the two faces between which they are a side, as in [`Sides`].
type SharedSide = ([u32; 2], [(usize, bool); 2]);

/// A part of the surface that is closed all round.
struct Solid {
    faces: Vec<usize>,
    sides: Vec<SharedSide>,
}

struct OneSide {
    /// In the file's unit.
    thickness: f64,
    left_out: Vec<usize>,
}

/// All closed parts, in the order of their first faces.
fn solids(faces: &ObjFaces, same: &[u32]) -> Vec<Solid> {
    let mut sides: Sides = HashMap::new();
    for (f, face) in faces.faces.iter().enumerate() {
        for k in 0..face.len() {
            let [a, b] = [k, (k + 1) % face.len()].map(|k| same[face[k] as usize]);
            sides.entry(sorted_pair([a, b])).or_default().push((f, a < b));
        }
    }
    let mut sets = DisjointSets::new(faces.faces.len());
    for pair in sides.values().flat_map(|s| s.windows(2)) {
        sets.join(pair[0].0 as u32, pair[1].0 as u32);
    }
    let mut open = vec![false; faces.faces.len()];
    for side in sides.values().filter(|s| s.len() != 2) {
        open[sets.root(side[0].0 as u32) as usize] = true;
    }
    let mut solids: Vec<Solid> = Vec::new();
    let mut number: HashMap<u32, usize> = HashMap::new();
    for f in (0..faces.faces.len()).filter(|&f| !faces.faces[f].is_empty()) {
        let root = sets.root(f as u32);
        if !open[root as usize] {
            let k = *number.entry(root).or_insert_with(|| {
                solids.push(Solid { faces: Vec::new(), sides: Vec::new() });
                solids.len() - 1
            });
            solids[k].faces.push(f);
        }
    }
    let mut sides: Vec<_> = sides.into_iter().collect();
    sides.sort_unstable();
    for (ends, two) in sides {
        if let ([a, b], Some(&k)) = (&two[..], number.get(&sets.root(two[0].0 as u32))) {
            solids[k].sides.push((ends, [*a, *b]));
        }
    }
    solids
}

/// Twice a polygon's area along its normal.
fn normal(faces: &ObjFaces, f: usize) -> Vec3 {
    let face = &faces.faces[f];
    let at = |k: usize| faces.vertices[face[k] as usize] - faces.vertices[face[0] as usize];
    (1..face.len() - 1).map(|k| at(k).cross(&at(k + 1))).sum()
}

impl Solid {
    /// The faces that are left out where this is a sheet: all but its outer side, the larger one.
    fn as_sheet(&self, faces: &ObjFaces, same: &[u32]) -> Option<OneSide> {
        let mut patches = DisjointSets::new(faces.faces.len());
        for (_, [(f, along), (g, other)]) in &self.sides {
            let (n, m) = (normal(faces, *f), normal(faces, *g));
            // Faces that run alike along their common side run against each other.
            let sign = if along == other { -1.0 } else { 1.0 };
            if sign * n.dot(&m) > SHARP * n.norm() * m.norm() {
                patches.join(*f as u32, *g as u32);
            }
        }
        let mut areas: HashMap<u32, f64> = HashMap::new();
        for &f in &self.faces {
            *areas.entry(patches.root(f as u32)).or_default() += 0.5 * normal(faces, f).norm();
        }
        let total: f64 = self.faces.iter().map(|&f| 0.5 * normal(faces, f).norm()).sum();
        let mut largest: Vec<(u32, f64)> = areas.into_iter().collect();
        largest.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        let [(outer, area), (_, inner), ..] = largest[..] else { return None };
        let mut rim = 0.0;
        for (ends, [(f, _), (g, _)]) in &self.sides {
            if (patches.root(*f as u32) == outer) != (patches.root(*g as u32) == outer) {
                let [a, b] = ends.map(|v| faces.vertices[same[v as usize] as usize]);
                rim += (b - a).norm();
            }
        }
        let thickness = (total - area - inner) / rim;
        let is_sheet = inner > INNER * area && area + inner > SIDES * total;
        let is_thin = thickness > 0.0 && thickness < THIN * area.sqrt();
        let mut left_out = || self.faces.iter().copied().filter(|&f| patches.root(f as u32) != outer).collect();
        (is_sheet && is_thin && largest.len() > 2).then(|| OneSide { thickness, left_out: left_out() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plate of cells, 10 × 10 and this thick, closed all round.
    fn plate(thick: f64) -> ObjFaces {
        let at = |i: u32, j: u32, side: u32| 36 * side + 6 * j + i;
        let mut faces = ObjFaces { groups: vec!["plate".into()], ..ObjFaces::default() };
        for (side, j, i) in (0..2).flat_map(|s| (0..6).flat_map(move |j| (0..6).map(move |i| (s, j, i)))) {
            faces.vertices.push(Vec3::new(2.0 * f64::from(i), 2.0 * f64::from(j), thick * f64::from(side)));
        }
        for (j, i) in (0..5).flat_map(|j| (0..5).map(move |i| (j, i))) {
            faces.faces.push(vec![at(i, j, 1), at(i + 1, j, 1), at(i + 1, j + 1, 1), at(i, j + 1, 1)]);
            faces.faces.push(vec![at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0)]);
        }
        for k in 0..5 {
            let wall = |a: [u32; 2], b: [u32; 2]| {
                vec![at(a[0], a[1], 0), at(b[0], b[1], 0), at(b[0], b[1], 1), at(a[0], a[1], 1)]
            };
            faces.faces.extend([wall([k, 0], [k + 1, 0]), wall([k + 1, 5], [k, 5])]);
            faces.faces.extend([wall([0, k + 1], [0, k]), wall([5, k], [5, k + 1])]);
        }
        faces.group_of_face = vec![0; faces.faces.len()];
        faces.texture_of_face = vec![Vec::new(); faces.faces.len()];
        faces
    }

    #[test]
    fn the_outer_side_of_a_sheet_is_left_and_a_block_stays_whole() {
        let same: Vec<u32> = (0..72).collect();
        let mut thin = plate(0.2);
        let notes = leave_outer_sides(&mut thin, &same, 1e-3, "stem");
        assert_eq!(notes.len(), 1);
        assert!(notes[0].contains("'plate' is a sheet 0.2 mm thick"), "{notes:?}");
        assert_eq!(thin.faces.iter().filter(|f| !f.is_empty()).count(), 25);
        for thick in [3.0, 10.0] {
            assert!(leave_outer_sides(&mut plate(thick), &same, 1e-3, "stem").is_empty());
        }
    }
}
