//! Where limbs join a body: what hangs down, apart from the rest, from where it joins that.

use crate::geometry::{DisjointSets, MeshEdge, TriMesh, Vec3, range_of};

/// A part that hangs down by less, metres, is no limb: fingers, a chin, a seat.
pub(crate) const LIMB: f64 = 0.15;
/// Distance between the heights at which the room beside a limb is looked at, metres.
pub(crate) const LEVEL: f64 = 0.005;

/// Two parts of a body that are one above a height and two below it.
pub(crate) struct Junction {
    /// The lowest vertex that joins the two: of a crotch or an armpit.
    pub(crate) vertex: u32,
    /// Its height, metres.
    pub(crate) top: f64,
    /// Height of the lower end of the shorter one, metres.
    pub(crate) bottom: f64,
    /// The side of every vertex.
    pub(crate) side: Vec<JunctionSide>,
}

impl Junction {
    /// Heights from the junction down to the end of the shorter limb, metres.
    pub(crate) fn levels(&self) -> Vec<f64> {
        let count = ((self.top - self.bottom) / LEVEL) as usize;
        (0..=count).map(|k| self.top - k as f64 * LEVEL).collect()
    }

    /// Cuts the limb (0) and what it hangs beside (1) at each of `levels`, which go down: gives the number of the
    /// level, that of the part, and the ends of every segment.
    pub(crate) fn cut(&self, mesh: &TriMesh, levels: &[f64], mut give: impl FnMut(usize, usize, [Vec3; 2])) {
        for (t, corners) in mesh.triangles.iter().enumerate() {
            let part = match corners.map(|v| self.side[v as usize]) {
                [JunctionSide::Limb, JunctionSide::Limb, JunctionSide::Limb] => 0,
                [JunctionSide::Beside, JunctionSide::Beside, JunctionSide::Beside] => 1,
                _ => continue,
            };
            let [low, high] = range_of(mesh.corners(t).iter().map(|p| p.y));
            let first = levels.partition_point(|y| *y > high);
            for (level, y) in levels.iter().enumerate().skip(first).take_while(|(_, y)| **y >= low) {
                if let Some(ends) = mesh.cut(t, *y) {
                    give(level, part, ends);
                }
            }
        }
    }
}

/// The side of a vertex at a junction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JunctionSide {
    /// The shorter limb.
    Limb,
    /// The part that the limb hangs beside.
    Beside,
    /// Neither.
    Neither,
}

/// The junctions of a closed surface from the floor up: where skin that is apart below a height comes together at it.
/// Skin that hangs down from there by less than `least` (metres) is no limb.
pub(crate) fn junctions(mesh: &TriMesh, edges: &[MeshEdge], least: f64) -> Vec<Junction> {
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
            if top - low_a.max(low_b) > least {
                let (limb, beside) = if low_a > low_b { (a, b) } else { (b, a) };
                let side = sides(&mut sets, [limb, beside]);
                out.push(Junction { vertex: v, top, bottom: low_a.max(low_b), side });
            }
            sets.join(a, b);
            lowest[a.min(b) as usize] = low_a.min(low_b);
        }
    }
    out
}

/// The vertices from the lowest up, and of each the neighbours that come before it.
fn upward(mesh: &TriMesh, edges: &[MeshEdge]) -> (Vec<u32>, Vec<Vec<u32>>) {
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

/// The side of every vertex of two sets that meet.
fn sides(sets: &mut DisjointSets, [limb, beside]: [u32; 2]) -> Vec<JunctionSide> {
    let count = sets.len() as u32;
    let side = |v| match sets.root(v) {
        root if root == limb => JunctionSide::Limb,
        root if root == beside => JunctionSide::Beside,
        _ => JunctionSide::Neither,
    };
    (0..count).map(side).collect()
}
