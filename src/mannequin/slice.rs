//! Plane cuts of a closed mesh.

use std::collections::BTreeMap;

use crate::geometry::{DisjointSets, TriMesh, Vec2, Vec3, box_of, half_hull};

/// One closed curve of a cut.
#[derive(Clone, Debug)]
pub(super) struct Loop {
    /// Points, in no order.
    pub(super) points: Vec<Vec3>,
    /// The edges of the mesh that they lie on. Their first end is on the side that the axis comes from.
    pub(super) edges: Vec<[u32; 2]>,
    /// Corners of the box round them.
    pub(super) low: Vec3,
    pub(super) high: Vec3,
}

impl Loop {
    fn new((points, edges): (Vec<Vec3>, Vec<[u32; 2]>)) -> Self {
        let [low, high] = box_of(points.iter().copied());
        Self { points, edges, low, high }
    }

    /// Middle of the box.
    pub(super) fn center(&self) -> Vec3 {
        0.5 * (self.low + self.high)
    }
}

/// The loops in which the plane through `at` square to `axis` cuts `mesh`.
pub(super) fn slice(mesh: &TriMesh, at: Vec3, axis: Vec3) -> Vec<Loop> {
    let side: Vec<f64> = mesh.vertices.iter().map(|p| (p - at).dot(&axis)).collect();
    // Every triangle that the plane crosses joins two of its edges. Chains of joined edges are the loops.
    let mut index: BTreeMap<[u32; 2], u32> = BTreeMap::new();
    let (mut points, mut sets) = (Vec::new(), DisjointSets::default());
    for tri in &mesh.triangles {
        let mut last = None;
        for k in 0..3 {
            let (a, b) = (tri[k].min(tri[(k + 1) % 3]), tri[k].max(tri[(k + 1) % 3]));
            let (s, t) = (side[a as usize], side[b as usize]);
            if (s < 0.0) == (t < 0.0) {
                continue;
            }
            let here = *index.entry([a, b]).or_insert_with(|| {
                points.push((
                    mesh.vertices[a as usize].lerp(&mesh.vertices[b as usize], s / (s - t)),
                    if s < t { [a, b] } else { [b, a] },
                ));
                sets.add()
            });
            if let Some(other) = last.replace(here) {
                sets.join(here, other);
            }
        }
    }
    let mut groups: BTreeMap<u32, (Vec<Vec3>, Vec<[u32; 2]>)> = BTreeMap::new();
    for (i, (p, edge)) in (0..).zip(points) {
        let group = groups.entry(sets.root(i)).or_default();
        group.0.push(p);
        group.1.push(edge);
    }
    groups.into_values().map(Loop::new).collect()
}

/// Length of a tape round `points` in the plane spanned by `u` and `v`: their convex hull's perimeter.
pub(super) fn tape(points: &[Vec3], u: Vec3, v: Vec3) -> f64 {
    let mut flat: Vec<Vec2> = points.iter().map(|p| Vec2::new(p.dot(&u), p.dot(&v))).collect();
    flat.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let upper = chain(flat.iter().copied());
    let lower = chain(flat.iter().rev().copied());
    upper + lower
}

/// Length of one half of the hull of sorted points.
fn chain(points: impl Iterator<Item = Vec2>) -> f64 {
    half_hull(points).windows(2).map(|w| (w[1].x - w[0].x).hypot(w[1].y - w[0].y)).sum()
}
