//! Where to cut: a surface that is no disk into one, and a disk that is too curved open at its worst place.
//!
//! Paths run along mesh edges. Shortest ones are Dijkstra's; the edges that make a disk of any surface are those of a
//! shortest-path tree and its interlocking tree of triangles (tree–cotree: Eppstein 2003; shortest system of loops:
//! Erickson & Whittlesey 2005).

use std::cmp::Ordering;
use std::collections::{BinaryHeap, HashSet};

use crate::geometry::{DisjointSets, Topology, TriMesh, rim_loops, sorted_pair};

/// A shortest way along edges from `from` to `to`, not along `solid` ones; `None` where there is none.
pub fn shortest_path(surface: &TriMesh, solid: &Solid, from: u32, to: u32) -> Option<Vec<u32>> {
    let topology = Topology::new(&surface.triangles);
    let tree = ShortestWays::new(surface, &topology, solid, &[from], false);
    tree.distance.get(to as usize).filter(|d| d.is_finite())?;
    Some(tree.path(to))
}

/// Edges (smaller vertex first, sorted) along which a connected surface must be cut to become a disk; none for a disk.
/// Rims are joined, the nearest first, handles opened along shortest ways, and a closed surface is slit from one end to
/// the other. `solid` edges are not cut.
pub fn disk_cuts(surface: &TriMesh, solid: &Solid) -> Vec<[u32; 2]> {
    let topology = Topology::new(&surface.triangles);
    if surface.vertices.is_empty() {
        return Vec::new();
    }
    let rims = rim_loops(&surface.triangles);
    let euler = surface.vertices.len() as i64 - topology.edges.len() as i64 + surface.triangles.len() as i64;
    // Of a surface with one side only the rims cannot be told so.
    let is_sphere = euler + rims.len() as i64 == 2 && topology.misoriented.is_empty();
    let open = topology.rim_edges().map(|e| e.ends[0]).min();
    let mut cuts: Vec<[u32; 2]> = match (open, is_sphere) {
        (None, true) => {
            let far = ShortestWays::new(surface, &topology, solid, &[0], true).farthest();
            edges_of(&slit(surface, &topology, solid, far))
        }
        (None, false) => roots(surface)
            .map(|root| opened(surface, &topology, solid, root))
            .min_by(|a, b| length(surface, a).total_cmp(&length(surface, b)))
            .unwrap_or_default(),
        (Some(_), true) => joined_rims(surface, &topology, solid, &rims),
        (Some(root), false) => opened(surface, &topology, solid, root),
    };
    cuts.sort_unstable();
    cuts.dedup();
    cuts
}

/// Vertices from which the ways round the handles of a closed surface are tried: all, or as many spread evenly.
fn roots(surface: &TriMesh) -> impl Iterator<Item = u32> + use<> {
    /// More would take longer than laying the surface flat.
    const TRIED: usize = 100;
    let count = surface.vertices.len();
    (0..count as u32).step_by(count.div_ceil(TRIED))
}

fn edges_of(way: &[u32]) -> Vec<[u32; 2]> {
    way.windows(2).map(|w| sorted_pair([w[0], w[1]])).collect()
}

fn length(surface: &TriMesh, edges: &[[u32; 2]]) -> f64 {
    let at = |v: u32| surface.vertices[v as usize];
    edges.iter().map(|[a, b]| (at(*b) - at(*a)).norm()).sum()
}

/// Joins rims one after the other to what is cut, the nearest first.
fn joined_rims(surface: &TriMesh, topology: &Topology, solid: &Solid, rims: &[Vec<u32>]) -> Vec<[u32; 2]> {
    let mut open: Vec<u32> = rims[0].clone();
    let mut left: Vec<&Vec<u32>> = rims[1..].iter().collect();
    let mut cuts = Vec::new();
    while !left.is_empty() {
        let tree = ShortestWays::new(surface, topology, solid, &open, false);
        let far = |v: u32| tree.distance[v as usize];
        let nearest = |rim: &[u32]| rim.iter().copied().min_by(|&a, &b| far(a).total_cmp(&far(b)).then(a.cmp(&b)));
        let ends = left.iter().enumerate().filter_map(|(k, rim)| Some((k, nearest(rim)?)));
        let Some((k, end)) = ends.min_by(|a, b| far(a.1).total_cmp(&far(b.1))) else { break };
        let way = tree.path(end);
        cuts.extend(edges_of(&way));
        open.extend(way);
        open.extend(left.remove(k));
    }
    cuts
}

/// Edges along which a surface with handles must be cut, by shortest ways from a root.
fn opened(surface: &TriMesh, topology: &Topology, solid: &Solid, root: u32) -> Vec<[u32; 2]> {
    let tree = ShortestWays::new(surface, topology, solid, &[root], true);
    let in_tree = |e: &[u32; 2]| tree.parent[e[0] as usize] == e[1] || tree.parent[e[1] as usize] == e[0];
    let joined = interlocking(surface, topology, solid, &tree, in_tree);
    let mut cuts = HashSet::new();
    for (edge, joined) in topology.edges.iter().zip(&joined) {
        if !joined && !in_tree(&edge.ends) {
            for end in edge.ends {
                cuts.extend(edges_of(&tree.path(end)));
            }
            cuts.insert(edge.ends);
        }
    }
    for edge in topology.rim_edges() {
        cuts.remove(&edge.ends);
    }
    // In one order, so that equally short ways have lengths that are equal to the last bit, and the same one is chosen.
    let mut cuts: Vec<[u32; 2]> = cuts.into_iter().collect();
    cuts.sort_unstable();
    cuts
}

/// The shortest way from the rim to the vertex that is farthest from it, which opens a deep disk most.
pub fn slit_from_rim(surface: &TriMesh, solid: &Solid) -> Vec<u32> {
    let topology = Topology::new(&surface.triangles);
    let rim: Vec<u32> = topology.rim_edges().flat_map(|e| e.ends).collect();
    let tree = ShortestWays::new(surface, &topology, solid, &rim, false);
    tree.path(tree.farthest())
}

/// A way from `from` to what is farthest from it, of two edges at least: the ends of a single one stay joined, and a
/// closed surface is not opened.
fn slit(surface: &TriMesh, topology: &Topology, solid: &Solid, from: u32) -> Vec<u32> {
    let direct = ShortestWays::new(surface, topology, solid, &[from], false);
    let to = direct.farthest();
    let way = direct.path(to);
    if way.len() > 2 {
        return way;
    }
    let mut solid = solid.clone();
    solid.insert(sorted_pair([from, to]));
    ShortestWays::new(surface, topology, &solid, &[from], false).path(to)
}

/// The dart that relieves a disk most: from the place where a conformal map would have to shrink most, which is where
/// a cone point helps most (Ben-Chen, Gotsman & Bunin 2008, section 4), to the nearest rim vertex that `may_open`
/// accepts, along edges that are not `solid`; rim first. It touches no other vertex of the rim: of one of another cut
/// it would part the surface. Where the map would have to stretch, cloth is missing and the legs of a dart would lie on
/// each other. `log_scale` is [`super::Flattened::log_scale`]. Empty where no place can be told: without scales, where
/// none shrinks, or where no way is clear.
pub fn dart(surface: &TriMesh, log_scale: &[f64], solid: &Solid, may_open: impl Fn(u32) -> bool) -> Vec<u32> {
    let topology = Topology::new(&surface.triangles);
    let on_rim: HashSet<u32> = topology.rim_edges().flat_map(|e| e.ends).collect();
    let size = |v: u32| -log_scale[v as usize];
    let inside = (0..log_scale.len() as u32).filter(|v| !on_rim.contains(v));
    let tip = inside.max_by(|&a, &b| size(a).total_cmp(&size(b)).then(b.cmp(&a)));
    let Some(tip) = tip.filter(|&v| size(v) > 0.0) else { return Vec::new() };
    let mut open: Vec<u32> = on_rim.iter().copied().filter(|&v| may_open(v)).collect();
    open.sort_unstable();
    let is_shut = |v: &u32| on_rim.contains(v) && !may_open(*v);
    let shut = topology.edges.iter().filter(|e| e.ends.iter().any(is_shut)).map(|e| e.ends);
    let solid: Solid = solid.iter().copied().chain(shut).collect();
    let way = ShortestWays::new(surface, &topology, &solid, &open, false).path(tip);
    if way.len() > 1 { way } else { Vec::new() }
}

/// Edges (smaller vertex first) that are no edges of what is cut: the diagonals that make triangles of its polygons.
pub type Solid = HashSet<[u32; 2]>;

/// Shortest ways from sources to every vertex.
pub(super) struct ShortestWays {
    pub(super) distance: Vec<f64>,
    /// The next vertex on the way back; a source is its own.
    parent: Vec<u32>,
}

/// A vertex to be looked at: the nearest first, then what a rim leads to, so that every rim is entered once.
struct Next {
    distance: f64,
    inside: bool,
    vertex: u32,
    from: u32,
}

impl PartialEq for Next {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Next {}

impl PartialOrd for Next {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Next {
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |n: &Self| (n.inside, n.vertex, n.from);
        other.distance.total_cmp(&self.distance).then_with(|| key(other).cmp(&key(self)))
    }
}

impl ShortestWays {
    /// With `free_rims` a way along a rim costs nothing: it is cut already.
    pub(super) fn new(surface: &TriMesh, topology: &Topology, solid: &Solid, sources: &[u32], free_rims: bool) -> Self {
        let count = surface.vertices.len();
        let mut neighbours: Vec<Vec<(u32, f64)>> = vec![Vec::new(); count];
        for edge in topology.edges.iter().filter(|e| !solid.contains(&e.ends)) {
            let [a, b] = edge.ends;
            let rim = edge.triangles[1].is_none();
            let apart = (surface.vertices[b as usize] - surface.vertices[a as usize]).norm();
            let length = if rim && free_rims { 0.0 } else { apart };
            neighbours[a as usize].push((b, length));
            neighbours[b as usize].push((a, length));
        }
        let mut tree = Self { distance: vec![f64::INFINITY; count], parent: (0..count as u32).collect() };
        let mut done = vec![false; count];
        let start = |&vertex: &u32| Next { distance: 0.0, inside: false, vertex, from: vertex };
        let mut heap: BinaryHeap<Next> = sources.iter().filter(|v| (**v as usize) < count).map(start).collect();
        while let Some(Next { distance, vertex, from, .. }) = heap.pop() {
            let v = vertex as usize;
            if std::mem::replace(&mut done[v], true) {
                continue;
            }
            (tree.distance[v], tree.parent[v]) = (distance, from);
            let beyond = neighbours[v].iter().filter(|(w, _)| !done[*w as usize]);
            heap.extend(beyond.map(|&(w, l)| Next {
                distance: distance + l,
                inside: l > 0.0,
                vertex: w,
                from: vertex,
            }));
        }
        tree
    }

    /// From the source to `to`.
    pub(super) fn path(&self, to: u32) -> Vec<u32> {
        let mut path = vec![to];
        let mut at = to;
        while self.parent[at as usize] != at {
            at = self.parent[at as usize];
            path.push(at);
        }
        path.reverse();
        path
    }

    fn farthest(&self) -> u32 {
        let reached = (0..self.distance.len() as u32).filter(|&v| self.distance[v as usize].is_finite());
        reached.max_by(|&a, &b| self.distance[a as usize].total_cmp(&self.distance[b as usize])).unwrap_or(0)
    }
}

/// For every edge whether triangles stay joined across it: a tree of all triangles that never crosses the tree of
/// vertices, made of solid edges first, then of those farthest from the root, so that what is left over lies near it.
fn interlocking(
    surface: &TriMesh,
    topology: &Topology,
    solid: &Solid,
    tree: &ShortestWays,
    in_tree: impl Fn(&[u32; 2]) -> bool,
) -> Vec<bool> {
    let far = |k: usize| topology.edges[k].ends.iter().map(|&v| tree.distance[v as usize]).sum::<f64>();
    let mut order: Vec<usize> = (0..topology.edges.len()).filter(|&k| !in_tree(&topology.edges[k].ends)).collect();
    let cuttable = |k: usize| !solid.contains(&topology.edges[k].ends);
    order.sort_by(|&a, &b| cuttable(a).cmp(&cuttable(b)).then_with(|| far(b).total_cmp(&far(a))).then(a.cmp(&b)));
    let mut sets = DisjointSets::new(surface.triangles.len());
    let mut joined = vec![false; topology.edges.len()];
    for k in order {
        if let [Some(s), Some(t)] = topology.edges[k].triangles {
            joined[k] = sets.join(s, t);
        }
    }
    joined
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Vec3;

    /// A tube or, with both ends joined, a torus, of `n` × `m` quads.
    fn tube(n: u32, m: u32, torus: bool) -> TriMesh {
        let rows = if torus { m } else { m + 1 };
        let at = |i: u32, j: u32| (j % rows) * n + i % n;
        let mut mesh = TriMesh::default();
        for j in 0..rows {
            for i in 0..n {
                let [u, v] =
                    [f64::from(i) / f64::from(n), f64::from(j) / f64::from(m)].map(|x| x * std::f64::consts::TAU);
                let r = if torus { 3.0 + v.cos() } else { 1.0 };
                mesh.vertices.push(Vec3::new(r * u.cos(), r * u.sin(), if torus { v.sin() } else { v }));
            }
        }
        for (i, j) in (0..n).flat_map(|i| (0..m).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
        mesh
    }

    #[test]
    fn a_tube_is_cut_once_across_and_a_disk_not_at_all() {
        let none = Solid::new();
        let cuts = disk_cuts(&tube(12, 5, false), &none);
        assert_eq!(cuts.len(), 5);
        let mut disk = tube(12, 5, false);
        disk.triangles.retain(|t| !t.iter().any(|v| v % 12 == 0));
        let used: HashSet<u32> = disk.triangles.iter().flatten().copied().collect();
        let mut kept: Vec<u32> = used.into_iter().collect();
        kept.sort_unstable();
        disk.vertices = kept.iter().map(|&v| disk.vertices[v as usize]).collect();
        disk.triangles.iter_mut().flatten().for_each(|v| *v = kept.partition_point(|w| w < v) as u32);
        assert!(disk_cuts(&disk, &none).is_empty());
        assert!(disk_cuts(&TriMesh::default(), &none).is_empty());
    }

    #[test]
    fn a_torus_is_cut_round_and_through() {
        let mesh = tube(16, 9, true);
        let cuts = disk_cuts(&mesh, &Solid::new());
        // Cut open, one piece is left, and Euler's number of what is cut is that of two loops through one point.
        let ends: HashSet<u32> = cuts.iter().flatten().copied().collect();
        assert_eq!(ends.len() as i64 - cuts.len() as i64, -1);
        assert!(cuts.len() <= 16 + 9, "{}", cuts.len());
    }

    #[test]
    fn a_closed_surface_is_slit() {
        let [a, b, c, d] = [Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]];
        // All its vertices are neighbours, and along a single edge nothing opens.
        let cuts = disk_cuts(&TriMesh { vertices: vec![a, b, c, d], triangles }, &Solid::new());
        assert!(cuts.len() == 2 && cuts[0].iter().any(|v| cuts[1].contains(v)), "{cuts:?}");
    }

    #[test]
    fn paths_are_shortest() {
        let mesh = tube(12, 5, false);
        assert_eq!(shortest_path(&mesh, &Solid::new(), 0, 36), Some(vec![0, 12, 24, 36]));
        assert_eq!(shortest_path(&mesh, &Solid::new(), 0, 99), None);
    }
}
