//! Mends the faults that 3D programs leave in a mesh, with a note each.
//!
//! Faces keep their numbers: one that is left out has no corners any more.

use std::collections::{HashMap, HashSet};

use crate::geometry::{DisjointSets, MM, Vec3, sorted_pair};
use crate::io::obj_read::ObjFaces;

/// Vertices nearer to each other than this, metres, are at one place: a hundredth of a millimetre.
pub(super) const AT_ONE_PLACE: f64 = 1e-5;
/// A face with less than this share of its longest side squared (twice its area) has no area.
const NO_AREA: f64 = 1e-9;

/// Which vertices at the same place are one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Weld {
    /// Those of different parts: the legs of a dart that is sewn up stay apart.
    #[default]
    BetweenParts,
    /// All that are within this distance of each other, metres; none with 0.
    Within(f64),
}

impl Weld {
    /// How near vertices must be, metres.
    fn within(self) -> f64 {
        match self {
            Self::BetweenParts => AT_ONE_PLACE,
            Self::Within(distance) => distance,
        }
    }
}

/// Of every vertex the one that stands for it, itself or the first that it is one with. `metres` is the unit of the
/// file.
pub(super) fn welded(faces: &ObjFaces, weld: Weld, metres: f64) -> Vec<u32> {
    let place = at_one_place(&faces.vertices, weld.within() / metres);
    if weld == Weld::BetweenParts { between_parts(faces, &place) } else { place }
}

/// The note on vertices of one group that were joined.
pub(super) fn welded_note(faces: &ObjFaces, weld: Weld, same: &[u32]) -> Option<String> {
    let mut group = vec![None; faces.vertices.len()];
    for (face, own) in faces.faces.iter().zip(&faces.group_of_face) {
        face.iter().for_each(|&v| group[v as usize] = Some(*own));
    }
    let joined = |&(v, &w): &(usize, &u32)| v != w as usize && group[v].is_some() && group[v] == group[w as usize];
    let count = same.iter().enumerate().filter(joined).count();
    let within = weld.within() * MM;
    let (vertices, are) = if count == 1 { ("vertex lies", "is") } else { ("vertices lie", "are") };
    (count > 0).then(|| {
        format!("{count} {vertices} within {within} mm of others and {are} joined to them; --weld 0 leaves them apart")
    })
}

/// Of every vertex the first that is no further from it than this, or from one that is, and so on.
fn at_one_place(vertices: &[Vec3], distance: f64) -> Vec<u32> {
    let mut sets = DisjointSets::new(vertices.len());
    if distance > 0.0 {
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for (k, p) in (0..).zip(vertices) {
            let cell = [p.x, p.y, p.z].map(|x| (x / distance).floor() as i64);
            for step in 0..27i64 {
                let near = [step % 3, step / 3 % 3, step / 9].map(|s| s - 1);
                let there = cells.get(&[0, 1, 2].map(|i| cell[i].saturating_add(near[i])));
                for &other in there.into_iter().flatten() {
                    if (vertices[other as usize] - p).norm() <= distance {
                        sets.join(other, k);
                    }
                }
            }
            cells.entry(cell).or_default().push(k);
        }
    }
    firsts(&mut sets, vertices.len())
}

/// Of every member the first of its set, which is the set's root.
fn firsts(sets: &mut DisjointSets, count: usize) -> Vec<u32> {
    (0..count as u32).map(|k| sets.root(k)).collect()
}

/// Joins vertices at one place that belong to different parts, and the ends of a side that has no length.
fn between_parts(faces: &ObjFaces, place: &[u32]) -> Vec<u32> {
    let count = faces.vertices.len();
    let mut parts = DisjointSets::new(count);
    let mut one = DisjointSets::new(count);
    for face in &faces.faces {
        for (k, &v) in face.iter().enumerate() {
            let next = face[(k + 1) % face.len()];
            parts.join(v, next);
            if place[v as usize] == place[next as usize] {
                one.join(v, next);
            }
        }
    }
    let mut at: HashMap<u32, Vec<u32>> = HashMap::new();
    (0..count as u32).for_each(|v| at.entry(place[v as usize]).or_default().push(v));
    for together in at.values().filter(|t| t.len() > 1) {
        // Sets of vertices of different parts: the first, and the parts of all.
        let mut sets: Vec<(u32, HashSet<u32>)> = Vec::new();
        for &v in together {
            let part = parts.root(v);
            match sets.iter_mut().find(|(first, parts)| one.root(*first) == one.root(v) || !parts.contains(&part)) {
                Some((first, parts)) => {
                    one.join(*first, v);
                    parts.insert(part);
                }
                None => sets.push((v, HashSet::from([part]))),
            }
        }
    }
    firsts(&mut one, count)
}

/// Mends the faces of a surface whose vertices are joined like this; says what was mended. Faces are numbered from
/// `first_number`.
pub(super) fn mend(faces: &mut ObjFaces, same: &[u32], first_number: u32) -> Vec<String> {
    let mut notes = Vec::new();
    let mut say = |count: usize, first: Option<usize>, one: &str, several: &str| {
        if let Some(first) = first {
            let what = if count == 1 { one } else { several };
            notes.push(format!("{count} {what}; the first is face {}", first + first_number as usize));
        }
    };
    let repeated = without_repeated_corners(faces, same);
    say(
        repeated.len(),
        repeated.first().copied(),
        "face has a corner twice and is taken without it",
        "faces have a corner twice and are taken without it",
    );
    let doubled = without_doubles(faces, same);
    say(
        doubled.len(),
        doubled.first().copied(),
        "face has the same corners as another and is left out",
        "faces have the same corners as others and are left out",
    );
    let needles = without_needles(faces, same);
    say(
        needles.len(),
        needles.first().copied(),
        "face has no area and is left out",
        "faces have no area and are left out",
    );
    let used: HashSet<u32> = faces.faces.iter().flatten().copied().collect();
    let loose = faces.vertices.len() - used.len();
    if loose > 0 {
        let verb = if loose == 1 { "vertex belongs" } else { "vertices belong" };
        notes.push(format!("{loose} {verb} to no face"));
    }
    notes
}

/// Takes corners off faces that have them next to themselves; which faces those are.
fn without_repeated_corners(faces: &mut ObjFaces, same: &[u32]) -> Vec<usize> {
    let mut changed = Vec::new();
    for (f, face) in faces.faces.iter_mut().enumerate() {
        let count = face.len();
        let is_new = |k: usize| same[face[k] as usize] != same[face[(k + 1) % count] as usize];
        let mut kept: Vec<usize> = (0..count).filter(|&k| is_new(k)).collect();
        if kept.len() == count {
            continue;
        }
        if kept.len() < 3 {
            kept.clear();
        }
        *face = kept.iter().map(|&k| face[k]).collect();
        if let Some(texture) = faces.texture_of_face.get_mut(f).filter(|t| !t.is_empty()) {
            *texture = kept.iter().map(|&k| texture[k]).collect();
        }
        changed.push(f);
    }
    changed
}

/// Leaves out faces of a group that have the corners of an earlier one, in whatever order; which those are.
fn without_doubles(faces: &mut ObjFaces, same: &[u32]) -> Vec<usize> {
    let mut seen = HashSet::new();
    let mut left_out = Vec::new();
    for f in (0..faces.faces.len()).filter(|&f| !faces.faces[f].is_empty()).collect::<Vec<_>>() {
        let mut corners: Vec<u32> = faces.faces[f].iter().map(|&v| same[v as usize]).collect();
        corners.sort_unstable();
        if !seen.insert((faces.group_of_face[f], corners)) {
            leave_out(faces, f);
            left_out.push(f);
        }
    }
    left_out
}

/// Leaves out a face.
pub(super) fn leave_out(faces: &mut ObjFaces, f: usize) {
    faces.faces[f].clear();
    if let Some(texture) = faces.texture_of_face.get_mut(f) {
        texture.clear();
    }
}

/// Leaves out triangles without an area. The corner that lies on the longest side becomes one of the face beyond that
/// side, so that no gap is left; which faces those are.
fn without_needles(faces: &mut ObjFaces, same: &[u32]) -> Vec<usize> {
    let needles: Vec<usize> = (0..faces.faces.len()).filter(|&f| is_needle(faces, f)).collect();
    if needles.is_empty() {
        return needles;
    }
    let mut beside: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for (f, face) in faces.faces.iter().enumerate() {
        for k in 0..face.len() {
            beside.entry(side(face, k, same)).or_default().push(f);
        }
    }
    for &needle in &needles {
        let corners = faces.faces[needle].clone();
        let length = |k: usize| {
            let [a, b] = [k, k + 1].map(|i| faces.vertices[corners[i % corners.len()] as usize]);
            (b - a).norm()
        };
        let longest = (0..corners.len()).max_by(|&a, &b| length(a).total_cmp(&length(b))).unwrap_or(0);
        let ends = side(&corners, longest, same);
        let other = beside.get(&ends).into_iter().flatten().find(|f| **f != needle && !faces.faces[**f].is_empty());
        if let (Some(&other), 3) = (other, corners.len()) {
            let middle = (longest + 2) % 3;
            insert(faces, other, ends, (needle, middle), same);
            for end in ends {
                beside.entry(sorted_pair([end, same[corners[middle] as usize]])).or_default().push(other);
            }
        }
        leave_out(faces, needle);
    }
    needles
}

/// A side of a face as the vertices that stand for its ends, smaller first.
fn side(face: &[u32], k: usize, same: &[u32]) -> [u32; 2] {
    sorted_pair([face[k], face[(k + 1) % face.len()]].map(|v| same[v as usize]))
}

/// Whether a face has no area: Newell's normal of its corners.
fn is_needle(faces: &ObjFaces, f: usize) -> bool {
    let Some((&first, rest)) = faces.faces[f].split_first() else { return false };
    let at = |v: u32| faces.vertices[v as usize] - faces.vertices[first as usize];
    let double_area = rest.windows(2).map(|w| at(w[0]).cross(&at(w[1]))).sum::<Vec3>().norm();
    let longest = rest.iter().map(|&v| at(v).norm_squared()).fold(0.0, f64::max);
    double_area <= NO_AREA * longest
}

/// Puts the needle's middle corner into the side of `face` between these ends.
fn insert(faces: &mut ObjFaces, face: usize, ends: [u32; 2], (needle, middle): (usize, usize), same: &[u32]) {
    let own = &faces.faces[face];
    let Some(k) = (0..own.len()).find(|&k| side(own, k, same) == ends) else { return };
    let corner = faces.faces[needle][middle];
    faces.faces[face].insert(k + 1, corner);
    let texture = faces.texture_of_face.get(needle).and_then(|t| t.get(middle).copied());
    if let Some(own) = faces.texture_of_face.get_mut(face).filter(|t| !t.is_empty()) {
        match texture {
            Some(texture) => own.insert(k + 1, texture),
            None => own.clear(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of four triangles round its centre, each vertex once.
    fn square() -> ObjFaces {
        let places = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
        ObjFaces {
            vertices: places.map(|[x, y]| Vec3::new(x, y, 0.0)).into(),
            faces: (0..4).map(|k| vec![k, (k + 1) % 4, 4]).collect(),
            texture_of_face: vec![Vec::new(); 4],
            groups: vec![String::new()],
            group_of_face: vec![0; 4],
            ..ObjFaces::default()
        }
    }

    fn add(faces: &mut ObjFaces, corners: &[u32]) {
        faces.faces.push(corners.to_vec());
        faces.texture_of_face.push(Vec::new());
        faces.group_of_face.push(0);
    }

    #[test]
    fn faces_that_are_none_are_left_out_and_said() {
        let mut faces = square();
        let good = faces.faces.clone();
        add(&mut faces, &[0, 1, 1]);
        add(&mut faces, &[4, 1, 0]);
        faces.vertices.push(Vec3::new(9.0, 9.0, 9.0));
        let same: Vec<u32> = (0..6).collect();
        let notes = mend(&mut faces, &same, 1).join("\n");
        assert_eq!(faces.faces[..4], good);
        assert!(faces.faces[4].is_empty() && faces.faces[5].is_empty());
        assert!(notes.contains("1 face has a corner twice") && notes.contains("the first is face 5"), "{notes}");
        assert!(
            notes.contains("1 face has the same corners as another") && notes.contains("1 vertex belongs"),
            "{notes}"
        );
    }

    #[test]
    fn a_needles_corner_goes_to_the_face_beyond_its_longest_side() {
        let mut faces = square();
        // Halfway between the first vertex and the centre, in a face without area and in the face on its other side.
        faces.vertices.push(Vec3::new(0.5, 0.5, 0.0));
        faces.faces[0] = vec![0, 1, 4, 5];
        add(&mut faces, &[0, 5, 4]);
        let same: Vec<u32> = (0..6).collect();
        let notes = mend(&mut faces, &same, 1);
        assert_eq!(faces.faces[3], [3, 0, 5, 4]);
        assert!(notes[0].contains("1 face has no area"), "{notes:?}");
    }

    #[test]
    fn parts_are_joined_where_they_meet_but_no_slit_is_closed() {
        // The square in pieces, a little apart; and one whose first and last triangle are a slit's sides.
        let mut soup = square();
        soup.vertices = soup.faces.iter().flatten().map(|&v| soup.vertices[v as usize]).collect();
        soup.vertices.iter_mut().enumerate().for_each(|(k, p)| p.z += 1e-7 * k as f64);
        soup.faces = (0..4).map(|k| vec![3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let same = |faces: &ObjFaces, weld| welded(faces, weld, 1.0);
        let joined = |same: &[u32]| same.iter().enumerate().filter(|(k, s)| *k as u32 != **s).count();
        assert_eq!(joined(&same(&soup, Weld::default())), 7);
        assert_eq!(joined(&same(&soup, Weld::Within(0.0))), 0);
        let mut slit = square();
        slit.vertices.push(slit.vertices[0]);
        slit.faces[3] = vec![3, 5, 4];
        assert_eq!(joined(&same(&slit, Weld::default())), 0);
        assert_eq!(joined(&same(&slit, Weld::Within(AT_ONE_PLACE))), 1);
    }
}
