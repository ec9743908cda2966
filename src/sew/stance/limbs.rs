//! The limbs of a body: what hangs down, apart from the rest, from where it joins that.

use crate::geometry::{DisjointSets, Edge, TriMesh, Vec3};
use crate::mannequin::{Mannequin, PartKind};

/// What hangs down by less is no limb: fingers, a chin, a seat, metres.
const LIMB: f64 = 0.15;

/// Two parts of a body that are one above a height and two below it.
pub(super) struct Junction {
    /// Height of the crotch or armpit, metres.
    pub(super) top: f64,
    /// Height of the lower end of the shorter one, metres.
    pub(super) bottom: f64,
    /// What every vertex belongs to.
    pub(super) side: Vec<Side>,
}

/// What a vertex belongs to at a junction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    /// The shorter limb.
    Limb,
    /// What it hangs beside.
    Beside,
    /// Neither.
    Neither,
}

/// The junctions of a closed surface from the floor up: where skin that is apart below a height comes together at it.
pub(super) fn junctions(mesh: &TriMesh, edges: &[Edge]) -> Vec<Junction> {
    let (order, lower) = upward(mesh, edges);
    let mut sets = DisjointSets::new(order.len());
    // Of a set's leader: the height of its lowest vertex.
    let mut lowest: Vec<f64> = mesh.vertices.iter().map(|p| p.y).collect();
    let mut out = Vec::new();
    for &v in &order {
        let top = height(mesh, v);
        for &w in &lower[v as usize] {
            let (a, b) = (sets.root(v), sets.root(w));
            if a == b {
                continue;
            }
            let [low_a, low_b] = [a, b].map(|s| lowest[s as usize]);
            if top - low_a.max(low_b) > LIMB {
                let (limb, beside) = if low_a > low_b { (a, b) } else { (b, a) };
                out.push(junction(&mut sets, [limb, beside], [low_a.max(low_b), top]));
            }
            sets.join(a, b);
            lowest[a.min(b) as usize] = low_a.min(low_b);
        }
    }
    out
}

/// The vertices from the lowest up, and of each the neighbours that come before it.
fn upward(mesh: &TriMesh, edges: &[Edge]) -> (Vec<u32>, Vec<Vec<u32>>) {
    let mut order: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    order.sort_by(|a, b| height(mesh, *a).total_cmp(&height(mesh, *b)).then(a.cmp(b)));
    let mut rank = vec![0; order.len()];
    order.iter().enumerate().for_each(|(k, v)| rank[*v as usize] = k);
    let mut lower = vec![Vec::new(); order.len()];
    for [a, b] in edges.iter().map(|e| e.ends) {
        let [low, high] = if rank[a as usize] < rank[b as usize] { [a, b] } else { [b, a] };
        lower[high as usize].push(low);
    }
    (order, lower)
}

fn height(mesh: &TriMesh, v: u32) -> f64 {
    mesh.vertices[v as usize].y
}

/// The junction at the upper one of two heights of two sets.
fn junction(sets: &mut DisjointSets, [limb, beside]: [u32; 2], [bottom, top]: [f64; 2]) -> Junction {
    let side = (0..sets.len() as u32).map(|v| match sets.root(v) {
        root if root == limb => Side::Limb,
        root if root == beside => Side::Beside,
        _ => Side::Neither,
    });
    Junction { top, bottom, side: side.collect() }
}

/// Of every arm and leg of a body the skin round it: the vertex nearest to each of its sections.
pub(super) struct Limbs(Vec<(PartKind, Vec<u32>)>);

impl Limbs {
    /// That of `body`.
    pub(super) fn new(body: &Mannequin) -> Self {
        let nearest = |p: Vec3| {
            let away = |v: &u32| (body.mesh.vertices[*v as usize] - p).norm_squared();
            (0..body.mesh.vertices.len() as u32).min_by(|a, b| away(a).total_cmp(&away(b)))
        };
        let limbs = body.parts.iter().filter(|part| !matches!(part.kind, PartKind::Torso | PartKind::Neck));
        Self(limbs.map(|part| (part.kind, part.sections.iter().filter_map(|s| nearest(s.center)).collect())).collect())
    }

    /// The arm or leg that the limb of a junction is, and the one that it hangs beside. Hair, a bag or a hand that has
    /// grown to a hip hang down too, and are none: most of an arm must be in it.
    pub(super) fn of(&self, junction: &Junction) -> [Option<PartKind>; 2] {
        [Side::Limb, Side::Beside].map(|side| {
            let is_in = |skin: &&(PartKind, Vec<u32>)| {
                2 * skin.1.iter().filter(|v| junction.side[**v as usize] == side).count() > skin.1.len()
            };
            self.0.iter().find(is_in).map(|(kind, _)| *kind)
        })
    }
}

/// How far apart the two of a junction are sideways at each of `levels` (going down), metres, nothing where one of them
/// is not met; and which way the limb lies, +1 or −1.
pub(super) fn apart(mesh: &TriMesh, edges: &[Edge], junction: &Junction, levels: &[f64]) -> (Vec<Option<f64>>, f64) {
    let widths = widths(mesh, edges, junction, levels);
    let met = |widths: &&[Width; 2]| widths.iter().all(|w| w[0] <= w[1]);
    let middles = widths.iter().filter(met).map(|[limb, beside]| limb[0] + limb[1] - beside[0] - beside[1]);
    let way = if middles.sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    let gap = |widths: &[Width; 2]| {
        let [limb, beside] = widths;
        let gap = if way > 0.0 { limb[0] - beside[1] } else { beside[0] - limb[1] };
        met(&widths).then_some(gap)
    };
    (widths.iter().map(gap).collect(), way)
}

/// The least and the greatest x of something, metres.
type Width = [f64; 2];

/// From where to where the limb, and what it hangs beside, reach at each of `levels`.
fn widths(mesh: &TriMesh, edges: &[Edge], junction: &Junction, levels: &[f64]) -> Vec<[Width; 2]> {
    let mut out = vec![[[f64::INFINITY, f64::NEG_INFINITY]; 2]; levels.len()];
    for [a, b] in edges.iter().map(|e| e.ends) {
        let which = match [a, b].map(|v| junction.side[v as usize]) {
            [Side::Limb, Side::Limb] => 0,
            [Side::Beside, Side::Beside] => 1,
            _ => continue,
        };
        let [p, q] = [a, b].map(|v| mesh.vertices[v as usize]);
        let (low, high) = if p.y <= q.y { (p, q) } else { (q, p) };
        let first = levels.partition_point(|y| *y > high.y);
        for (k, y) in levels.iter().enumerate().skip(first).take_while(|(_, y)| **y >= low.y) {
            let share = if high.y > low.y { (y - low.y) / (high.y - low.y) } else { 0.0 };
            let x = low.x + (high.x - low.x) * share;
            let width = &mut out[k][which];
            *width = [width[0].min(x), width[1].max(x)];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Topology, Vec3};

    /// Square tubes, 100 mm wide and 50 mm apart, from these heights to 1 m, each joined to the last by two triangles
    /// that meet at 1.1 m.
    fn legs(bottoms: &[f64]) -> (TriMesh, Vec<Edge>) {
        let mut mesh = TriMesh::default();
        let mut last = None;
        for (k, bottom) in bottoms.iter().enumerate() {
            let at = |x: f64, y: f64, z: f64| Vec3::new(x + 0.15 * k as f64, y, z);
            let first = mesh.vertices.len() as u32;
            for y in [*bottom, 1.0] {
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

    #[test]
    fn the_gap_of_two_that_hang_down_is_what_is_between() {
        let (mesh, edges) = legs(&[0.0, 0.01]);
        let found = junctions(&mesh, &edges);
        assert_eq!(found.len(), 1);
        assert!(found[0].top == 1.1 && found[0].bottom == 0.01);
        // The second is the shorter.
        assert_eq!((found[0].side[0], found[0].side[8]), (Side::Beside, Side::Limb));
        let (gaps, way) = apart(&mesh, &edges, &found[0], &[0.9, 0.5, 0.005]);
        assert_eq!((way, gaps[2]), (1.0, None));
        assert!(gaps[..2].iter().flatten().all(|gap| (gap - 0.05).abs() < 1e-12), "{gaps:?}");
    }

    #[test]
    fn an_arm_hangs_beside_and_a_finger_is_no_limb() {
        let (mesh, edges) = legs(&[0.5, 0.0, 0.97]);
        let found = junctions(&mesh, &edges);
        assert_eq!(found.len(), 1, "the last hangs down by 130 mm");
        assert_eq!(found[0].side[0], Side::Limb);
        let (gaps, way) = apart(&mesh, &edges, &found[0], &[0.7]);
        assert!(way == -1.0 && (gaps[0].expect("both") - 0.05).abs() < 1e-12, "{gaps:?}");
    }
}
