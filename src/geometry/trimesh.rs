//! Triangle meshes in space, their connectivity and basic measures.

use std::collections::HashMap;

use super::Vec3;

/// Positions and triangles. Triangles run counter-clockwise seen from outside (the cloth's right side).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    /// Positions, metres.
    pub vertices: Vec<Vec3>,
    /// Vertex indices.
    pub triangles: Vec<[u32; 3]>,
}

/// An undirected mesh edge with the triangles beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeshEdge {
    /// End vertices, the smaller index first.
    pub ends: [u32; 2],
    /// The triangles beside it. The second is `None` on a rim.
    pub triangles: [Option<u32>; 2],
}

/// The ends of an undirected edge, the smaller index first.
pub(crate) fn sorted_pair([a, b]: [u32; 2]) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Connectivity of a triangle mesh, derived once.
#[derive(Clone, Debug, Default)]
pub struct Topology {
    /// Every edge once, sorted by its ends.
    pub edges: Vec<MeshEdge>,
    /// Edges that more than two triangles share (a manifold mesh has none).
    pub non_manifold: Vec<[u32; 2]>,
    /// Neighbouring pairs of triangles that run the same way along their shared edge (an oriented mesh has none).
    pub misoriented: Vec<[u32; 2]>,
}

impl Topology {
    /// Reads the connectivity of `triangles`.
    pub fn new(triangles: &[[u32; 3]]) -> Self {
        let sides = sides(triangles);
        let mut out = Self { edges: Vec::with_capacity(sides.len() / 2), ..Self::default() };
        for group in sides.chunk_by(|x, y| x.ends == y.ends) {
            let triangle = |k: usize| group.get(k).map(|s: &TriangleSide| s.index / 3);
            out.edges.push(MeshEdge { ends: group[0].ends, triangles: [triangle(0), triangle(1)] });
            if group.len() > 2 {
                out.non_manifold.push(group[0].ends);
            } else if group.len() == 2 && group[0].rising == group[1].rising {
                out.misoriented.push([group[0].index / 3, group[1].index / 3]);
            }
        }
        out
    }

    /// Edges with one triangle.
    pub fn rim_edges(&self) -> impl Iterator<Item = &MeshEdge> {
        self.edges.iter().filter(|e| e.triangles[1].is_none())
    }
}

/// A triangle's side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct TriangleSide {
    /// Its ends, the smaller first.
    ends: [u32; 2],
    /// Three times the triangle, plus the place of its first corner in it.
    index: u32,
    /// Whether the triangle runs from the smaller end to the larger.
    rising: bool,
}

/// The sides of all triangles, sorted: by buckets of their smaller end first, then within each bucket. Vertices are
/// mostly numbered without large gaps, so buckets are small.
fn sides(triangles: &[[u32; 3]]) -> Vec<TriangleSide> {
    let all = || {
        triangles.iter().enumerate().flat_map(|(t, tri)| {
            (0..3).map(move |k| {
                let (a, b) = (tri[k], tri[(k + 1) % 3]);
                TriangleSide { ends: sorted_pair([a, b]), index: (3 * t + k) as u32, rising: a < b }
            })
        })
    };
    let largest = triangles.iter().flatten().copied().max().unwrap_or(0) as usize;
    let mut shift = 0;
    while largest >> shift > 3 * triangles.len() {
        shift += 1;
    }
    let drawer = |side: &TriangleSide| (side.ends[0] >> shift) as usize;
    let mut starts = vec![0u32; (largest >> shift) + 2];
    all().for_each(|side| starts[drawer(&side) + 1] += 1);
    for k in 1..starts.len() {
        starts[k] += starts[k - 1];
    }
    let mut at = starts.clone();
    let mut sorted = vec![TriangleSide::default(); 3 * triangles.len()];
    for side in all() {
        let place = &mut at[drawer(&side)];
        sorted[*place as usize] = side;
        *place += 1;
    }
    for range in starts.windows(2) {
        sorted[range[0] as usize..range[1] as usize].sort_unstable();
    }
    sorted
}

/// Rim loops of an oriented mesh: closed vertex chains that run with their triangles. Where rims touch in one vertex
/// they are walked as one loop if the walk meets that vertex again before closing.
///
/// More than two triangles may share an edge: the three layers of a pleat, or a lining sewn to the shell's rim. Layers
/// that run opposite ways then cancel, and the rest is the rim. So a pleated waist is one loop, and a rim of several
/// layers is one loop, not several.
pub fn rim_loops(triangles: &[[u32; 3]]) -> Vec<Vec<u32>> {
    // Where more triangles run along an edge than against it: the first of them, the edge, and how many more.
    let mut surplus = Vec::new();
    for group in sides(triangles).chunk_by(|x, y| x.ends == y.ends) {
        let ([a, b], rising) = (group[0].ends, group.iter().filter(|s| s.rising).count());
        let (more, less) = (rising.max(group.len() - rising), rising.min(group.len() - rising));
        let along = rising == more;
        let first = group.iter().find(|s| s.rising == along);
        if let Some(first) = first.filter(|_| more > less && a != b) {
            surplus.push((first.index, if along { [a, b] } else { [b, a] }, more - less));
        }
    }
    surplus.sort_unstable();
    let mut next: HashMap<u32, Vec<u32>> = HashMap::new();
    for (_, [a, b], layers) in surplus {
        next.entry(a).or_default().extend(std::iter::repeat_n(b, layers));
    }
    let mut starts: Vec<u32> = next.keys().copied().collect();
    starts.sort_unstable();
    let mut loops: Vec<Vec<u32>> = Vec::new();
    for start in starts {
        while next.get(&start).is_some_and(|n| !n.is_empty()) {
            let mut chain = Vec::new();
            let mut at = start;
            while let Some(to) = next.get_mut(&at).and_then(Vec::pop) {
                chain.push(at);
                at = to;
                if at == start {
                    break;
                }
            }
            if !loops.iter().any(|l| same_ring(l, &chain)) {
                loops.push(chain);
            }
        }
    }
    loops
}

/// Whether two closed chains run through the same vertices in the same order.
fn same_ring(a: &[u32], b: &[u32]) -> bool {
    let starts = a.len() == b.len() && !a.is_empty();
    starts && b.iter().position(|v| *v == a[0]).is_some_and(|k| (0..a.len()).all(|i| a[i] == b[(k + i) % b.len()]))
}

impl TriMesh {
    /// The ends of the line along which the horizontal plane at height `y` cuts triangle `t`, if it does.
    pub(crate) fn cut(&self, t: usize, y: f64) -> Option<[Vec3; 2]> {
        let corners = self.corners(t);
        let sides = [0, 1, 2].map(|k| [corners[k], corners[(k + 1) % 3]]);
        let mut ends = sides.into_iter().filter(|[p, q]| (p.y < y) != (q.y < y));
        let mut next = || ends.next().map(|[p, q]| p.lerp(&q, (y - p.y) / (q.y - p.y)));
        Some([next()?, next()?])
    }

    /// Corner positions of triangle `t`.
    pub fn corners(&self, t: usize) -> [Vec3; 3] {
        self.triangles[t].map(|v| self.vertices[v as usize])
    }

    /// Twice the area-weighted outward normal of triangle `t`.
    pub fn double_normal(&self, t: usize) -> Vec3 {
        let [a, b, c] = self.corners(t);
        (b - a).cross(&(c - a))
    }

    /// Sum of the triangles' areas.
    pub fn area(&self) -> f64 {
        (0..self.triangles.len()).map(|t| 0.5 * self.double_normal(t).norm()).sum()
    }

    /// Enclosed volume (divergence theorem). Negative when a closed mesh is inside out.
    pub fn signed_volume(&self) -> f64 {
        (0..self.triangles.len())
            .map(|t| {
                let [a, b, c] = self.corners(t);
                a.dot(&b.cross(&c)) / 6.0
            })
            .sum()
    }

    /// Closes a rim with triangles round its centre, a new vertex, that run as those beside it.
    pub fn fill(&mut self, rim: &[u32]) {
        let centre = rim.iter().map(|&v| self.vertices[v as usize]).sum::<Vec3>() / rim.len() as f64;
        let apex = self.vertices.len() as u32;
        self.vertices.push(centre);
        for k in 0..rim.len() {
            self.triangles.push([rim[(k + 1) % rim.len()], rim[k], apex]);
        }
    }

    /// Area-weighted unit vertex normals (zero for an isolated vertex).
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        let mut normals = vec![Vec3::zeros(); self.vertices.len()];
        for (t, tri) in self.triangles.iter().enumerate() {
            let n = self.double_normal(t);
            for &v in tri {
                normals[v as usize] += n;
            }
        }
        for n in &mut normals {
            let length = n.norm();
            if length > 0.0 {
                *n /= length;
            }
        }
        normals
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_triangles_have_one_rim_of_four() {
        let triangles = [[0, 1, 2], [0, 2, 3]];
        let topology = Topology::new(&triangles);
        assert_eq!(topology.edges.len(), 5);
        assert_eq!(topology.rim_edges().count(), 4);
        assert!(topology.misoriented.is_empty());
        let loops = rim_loops(&triangles);
        assert_eq!(loops, vec![vec![0, 1, 2, 3]]);
    }

    #[test]
    fn the_rim_of_a_pleat_is_one_loop() {
        // A strip whose upper rim goes 1–2 forth, back and forth again.
        let top = [0, 1, 2, 1, 2, 3];
        let below = [10, 11, 12, 13, 14, 15];
        let cells = (0..5).flat_map(|k| [[top[k], top[k + 1], below[k + 1]], [top[k], below[k + 1], below[k]]]);
        let triangles: Vec<[u32; 3]> = cells.collect();
        let loops = rim_loops(&triangles);
        assert_eq!(loops, vec![vec![0, 1, 2, 3, 15, 14, 13, 12, 11, 10]]);
    }

    #[test]
    fn a_rim_of_two_layers_is_one_loop() {
        let tube = |low: [u32; 3]| {
            (0..3).flat_map(move |k| {
                let (a, b) = (k as u32, (k as u32 + 1) % 3);
                [[a, b, low[(k + 1) % 3]], [a, low[(k + 1) % 3], low[k]]]
            })
        };
        let lined: Vec<[u32; 3]> = tube([3, 4, 5]).chain(tube([6, 7, 8])).collect();
        assert_eq!(rim_loops(&lined), vec![vec![0, 1, 2], vec![3, 5, 4], vec![6, 8, 7]]);
    }

    #[test]
    fn a_turned_triangle_is_seen() {
        assert_eq!(Topology::new(&[[0, 1, 2], [0, 3, 2], [0, 2, 4]]).non_manifold, [[0, 2]]);
        assert!(Topology::new(&[[0, 1, 2], [0, 2, 3]]).misoriented.is_empty());
        assert_eq!(Topology::new(&[[0, 1, 2], [0, 3, 2]]).misoriented.len(), 1);
    }
}
