//! The arms and legs among what hangs down from a body, and how much room is beside them.

use std::collections::BTreeMap;

use crate::contact::Skin;
use crate::geometry::{TriMesh, Vec3};
use crate::mannequin::{BodyPart, Junction, JunctionSide, Mannequin, PartKind};

/// Limbs that are nearer to each other than this from back to front, metres, need room sideways. Those further from
/// each other than twice this have it there: cloth passes between.
const SLICE: f64 = 0.02;

/// Of every arm and leg of a body the skin round it: a corner of the triangle nearest to each of its sections.
pub(super) struct Limbs(Vec<(PartKind, Vec<u32>)>);

impl Limbs {
    /// That of `body`; `None` if that has no skin.
    pub(super) fn new(body: &Mannequin) -> Option<Self> {
        let skin = Skin::new(&body.mesh.vertices, body.mesh.triangles.clone())?;
        let limbs = body.parts.iter().filter(|part| part.kind.is_arm() || part.kind.is_leg());
        let around = |part: &BodyPart| part.sections.iter().map(|s| skin.nearest(s.center)[0]).collect();
        Some(Self(limbs.map(|part| (part.kind, around(part))).collect()))
    }

    /// The arm or leg that the limb of a junction is, and the one that it hangs beside. Hair, a bag or a hand that has
    /// grown to a hip hang down too, and are none: most of an arm must be in it.
    pub(super) fn of(&self, junction: &Junction) -> [Option<PartKind>; 2] {
        [JunctionSide::Limb, JunctionSide::Beside].map(|side| {
            let is_in = |skin: &&(PartKind, Vec<u32>)| {
                2 * skin.1.iter().filter(|v| junction.side[**v as usize] == side).count() > skin.1.len()
            };
            self.0.iter().find(is_in).map(|(kind, _)| *kind)
        })
    }
}

/// How far apart the two of a junction are sideways at each of `levels` (going down), metres, nothing where one of them
/// is not met, or only in front of or behind the other; and which way the limb lies, +1 or −1.
pub(super) fn apart(mesh: &TriMesh, junction: &Junction, levels: &[f64]) -> (Vec<Option<f64>>, f64) {
    let outlines = outlines(mesh, junction, levels);
    let middle = |outline: &Outline| {
        let [least, most] = outline.values().copied().reduce(both)?;
        Some(least + most)
    };
    let off = |[limb, beside]: &[Outline; 2]| Some(middle(limb)? - middle(beside)?);
    let way = if outlines.iter().filter_map(off).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    (outlines.iter().map(|[limb, beside]| gap(limb, beside, way)).collect(), way)
}

/// The least and the greatest x of something, metres.
type Width = [f64; 2];

/// The widths of something at one height, by their slices from back to front.
type Outline = BTreeMap<i64, Width>;

fn both(one: Width, other: Width) -> Width {
    [one[0].min(other[0]), one[1].max(other[1])]
}

/// The least distance along x, metres, between a limb that lies that `way` and what it hangs beside, where both are in
/// one slice or in two side by side.
fn gap(limb: &Outline, beside: &Outline, way: f64) -> Option<f64> {
    let between = |limb: &Width, beside: &Width| if way > 0.0 { limb[0] - beside[1] } else { beside[0] - limb[1] };
    let nearest = |(slice, limb): (&i64, &Width)| {
        beside.range(slice - 1..=slice + 1).map(|(_, beside)| between(limb, beside)).reduce(f64::min)
    };
    limb.iter().filter_map(nearest).reduce(f64::min)
}

/// The outlines of a limb and of its neighbour at each of `levels`.
fn outlines(mesh: &TriMesh, junction: &Junction, levels: &[f64]) -> Vec<[Outline; 2]> {
    let mut out = vec![[Outline::new(), Outline::new()]; levels.len()];
    junction.cut(mesh, levels, |level, of, ends| add(&mut out[level][of], ends));
    out
}

/// Adds a segment to the slices that it goes through.
fn add(outline: &mut Outline, [p, q]: [Vec3; 2]) {
    let (from, to) = if p.z <= q.z { (p, q) } else { (q, p) };
    let at = |k: i64| from.x + (to.x - from.x) * (k as f64 * SLICE - from.z) / (to.z - from.z);
    let [first, last] = [from.z, to.z].map(|z| (z / SLICE).floor() as i64);
    for k in first..=last {
        let a = if k == first { from.x } else { at(k) };
        let b = if k == last { to.x } else { at(k + 1) };
        let width = [a.min(b), a.max(b)];
        outline.entry(k).and_modify(|known| *known = both(*known, width)).or_insert(width);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{MeshEdge, Topology, Vec3};
    use crate::mannequin::{LIMB, junctions};

    /// Square tubes, 100 mm wide, with this corner (x and z), from these heights to 1 m, each joined to the last by two
    /// triangles that meet at 1.1 m.
    fn tubes(of: &[([f64; 2], f64)]) -> (TriMesh, Vec<MeshEdge>) {
        let mut mesh = TriMesh::default();
        let mut last = None;
        for &([left, back], bottom) in of {
            let at = |x: f64, y: f64, z: f64| Vec3::new(left + x, y, back + z);
            let first = mesh.vertices.len() as u32;
            for y in [bottom, 1.0] {
                mesh.vertices.extend([at(0.0, y, 0.0), at(0.1, y, 0.0), at(0.1, y, 0.1), at(0.0, y, 0.1)]);
            }
            for i in 0..4 {
                let [a, b] = [first + i, first + (i + 1) % 4];
                mesh.triangles.extend([[a, b, b + 4], [a, b + 4, a + 4]]);
            }
            if let Some(last) = last {
                let joint = mesh.vertices.len() as u32;
                mesh.vertices.extend([at(0.0, 1.1, 0.0), at(0.0, 1.1, 0.1)]);
                mesh.triangles.extend([[last, joint, joint + 1], [first + 4, joint + 1, joint]]);
            }
            last = Some(first + 5);
        }
        let edges = Topology::new(&mesh.triangles).edges;
        (mesh, edges)
    }

    /// Tubes side by side, 50 mm apart.
    fn legs(bottoms: &[f64]) -> (TriMesh, Vec<MeshEdge>) {
        tubes(&bottoms.iter().enumerate().map(|(k, y)| ([0.15 * k as f64, 0.0], *y)).collect::<Vec<_>>())
    }

    #[test]
    fn the_gap_of_two_that_hang_down_is_what_is_between() {
        let (mesh, edges) = legs(&[0.0, 0.01]);
        let found = junctions(&mesh, &edges, LIMB);
        assert_eq!(found.len(), 1);
        assert!(found[0].top == 1.1 && found[0].bottom == 0.01);
        // The second is the shorter.
        assert_eq!((found[0].side[0], found[0].side[8]), (JunctionSide::Beside, JunctionSide::Limb));
        let (gaps, way) = apart(&mesh, &found[0], &[0.9, 0.5, 0.005]);
        assert_eq!((way, gaps[2]), (1.0, None));
        assert!(gaps[..2].iter().flatten().all(|gap| (gap - 0.05).abs() < 1e-12), "{gaps:?}");
    }

    #[test]
    fn an_arm_hangs_beside_and_a_finger_is_no_limb() {
        let (mesh, edges) = legs(&[0.5, 0.0, 0.97]);
        let found = junctions(&mesh, &edges, LIMB);
        assert_eq!(found.len(), 1, "the last hangs down by 130 mm");
        assert_eq!(found[0].side[0], JunctionSide::Limb);
        let (gaps, way) = apart(&mesh, &found[0], &[0.7]);
        assert!(way == -1.0 && (gaps[0].expect("both") - 0.05).abs() < 1e-12, "{gaps:?}");
    }

    #[test]
    fn a_hand_in_front_of_a_thigh_has_room_and_one_that_reaches_back_to_it_has_none() {
        let gap = |back: f64| {
            let (mesh, edges) = tubes(&[([0.0, 0.0], 0.0), ([0.06, back], 0.4)]);
            let found = junctions(&mesh, &edges, LIMB);
            apart(&mesh, &found[0], &[0.7]).0[0]
        };
        assert_eq!(gap(0.1 + 2.1 * SLICE), None);
        for back in [0.1 + 0.9 * SLICE, 0.05] {
            assert!((gap(back).expect("side by side") + 0.04).abs() < 1e-12, "{:?}", gap(back));
        }
    }

    #[test]
    fn slanting_sides_are_as_near_as_where_they_face_each_other() {
        // Of two that lean the same way, as thighs of one who stands sideways, slices are nearer than their boxes.
        let mut outlines = [Outline::new(), Outline::new()];
        for (outline, x) in outlines.iter_mut().zip([0.0, 0.1]) {
            add(outline, [Vec3::new(x, 0.0, 0.0), Vec3::new(x + 0.2, 0.0, 0.2)]);
        }
        let [beside, limb] = outlines;
        let near = gap(&limb, &beside, 1.0).expect("side by side");
        assert!((near - (0.1 - 2.0 * SLICE)).abs() < 1e-12, "{near}");
    }
}
