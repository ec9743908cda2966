//! Curvatures of a flat piece as sums over its particles: the stencils of bending.
//!
//! Every particle has the second derivatives of its position along warp u, weft v and mixed. Its area A is that of the
//! cloth nearest to it. E = ½ Σ A (B₁ |x_uu|² + B₂ |x_vv|² + 2 √(B₁B₂) |x_uv|²) is a plate without lateral contraction.
//! Rolled to a cylinder at the angle φ to the warp it has the rigidity (√B₁ cos²φ + √B₂ sin²φ)².
//!
//! - On the regular grid x_uu and x_vv are second differences along a thread, and x_uv is the mixed difference of each
//!   cell.
//! - At rims, and in the strip between rim and grid, they belong to the quadratic surface through the particle that
//!   fits its neighbours best. So rims are natural boundaries.
//! - Creases cut the cloth. Neither side enters the curvature of the other, and a hinge joins both. A fold of angle 0
//!   is no crease.
//! - Seams join pieces that have no common plane. Both bend up to their rims, and a hinge with the rigidity of the
//!   adjacent cloth joins them.
//! - Hems and seam allowances bend along the rim with the cloth.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use nalgebra::{Matrix2, Matrix3, SymmetricEigen, Vector3};

use super::bending::Stencil;
use super::crease::rigidity_across;
use crate::fabric::Fabric;
use crate::geometry::{Topology, Vec2, sorted_pair};
use crate::mesh::{ClothMesh, PieceMesh};
use crate::pattern::Garment;

/// Largest sine of the angle between a grid line and its thread (0.3°): rounding, and the play of a lattice that fits
/// its rim.
const STRAIGHT: f64 = 5e-3;
/// Least squared singular value of a fit, as a share of the largest, below which a combination of curvatures is unseen:
/// a band one cell wide cannot tell whether it is bent across.
const SEEN: f64 = 1e-2;

/// Cosine of the turn of a rim (45°) beyond which a particle is a corner.
const CORNER: f64 = 0.7;

/// Stencils of all pieces, over particles. A second layer of `hem` metres lies along rims.
pub(super) fn of_pieces(mesh: &ClothMesh, fabrics: &[Arc<Fabric>], hem: f64) -> Vec<Stencil> {
    let pieces = mesh.pieces.iter().zip(fabrics);
    pieces.flat_map(|(piece, fabric)| PieceTriangles::new(mesh, piece, fabric).stencils(hem)).collect()
}

/// Hinges along the seams, over particles. `node_of` maps particles to nodes.
pub(super) fn of_seams(mesh: &ClothMesh, garment: &Garment, node_of: &[u32], fabrics: &[Arc<Fabric>]) -> Vec<Stencil> {
    // Layers sewn on each other turn freely at the seam.
    let lapped: HashSet<u32> = mesh
        .seams
        .iter()
        .zip(&garment.seams)
        .filter(|(_, seam)| seam.is_lapped(&garment.pieces))
        .flat_map(|(stitches, _)| stitches.pairs.iter().flatten().map(|&p| node_of[p as usize]))
        .collect();
    let mut rims: Vec<([u32; 2], usize, [u32; 3])> = Vec::new();
    for (p, piece) in mesh.pieces.iter().enumerate() {
        let triangles = &mesh.triangles[piece.triangles.clone()];
        for rim in Topology::new(triangles).rim_edges() {
            let Some(t) = rim.triangles[0] else { continue };
            let Some(apex) = triangles[t as usize].into_iter().find(|n| !rim.ends.contains(n)) else { continue };
            let mut ends = rim.ends;
            ends.sort_by_key(|&n| node_of[n as usize]);
            rims.push((ends.map(|n| node_of[n as usize]), p, [ends[0], ends[1], apex]));
        }
    }
    rims.sort_by_key(|r| r.0);
    let mut out = Vec::new();
    for sides in rims.chunk_by(|a, b| a.0 == b.0) {
        let [a, b] = sides else { continue };
        if a.0.iter().all(|n| lapped.contains(n)) {
            continue;
        }
        out.extend(hinge(mesh, fabrics, [(a.1, a.2), (b.1, b.2)]));
    }
    out
}

/// The hinge of two triangles that share a sewn edge: their angle over the width of the cloth nearest to the edge.
fn hinge(mesh: &ClothMesh, fabrics: &[Arc<Fabric>], sides: [(usize, [u32; 3]); 2]) -> Option<Stencil> {
    let (mut flows, mut area, mut rigidity, mut length) = (Vec::with_capacity(4), 0.0, 0.0, 0.0);
    for (piece, [a, b, apex]) in sides {
        let [p, q, r] = [a, b, apex].map(|n| mesh.flat[n as usize]);
        let (edge, up) = (q - p, r - p);
        let double = edge.perp(&up).abs();
        if double <= 0.0 {
            return None;
        }
        let (foot, height) = (edge.dot(&up) / edge.norm_squared(), double / edge.norm());
        // The slope of the triangle away from the edge.
        flows.extend([(a, apex, (1.0 - foot) / height), (b, apex, foot / height)]);
        area += 0.5 * double;
        length += 0.5 * edge.norm();
        rigidity += 0.5 * rigidity_across(&fabrics[piece], edge, mesh.pieces[piece].warp);
    }
    Some(Stencil { flows, weight: rigidity * length * length / area })
}

/// The thread along which a flat vector runs: 0 for the `warp`, 1 for the weft, `None` for neither.
pub(super) fn thread_of(warp: Vec2, d: Vec2) -> Option<usize> {
    let along = [d.dot(&warp).abs(), d.perp(&warp).abs()];
    (0..2).find(|&k| along[1 - k] <= STRAIGHT * along[k])
}

/// One piece's particles and triangles.
struct PieceTriangles<'a> {
    mesh: &'a ClothMesh,
    piece: &'a PieceMesh,
    /// B₁ and B₂, N·m.
    rigidity: [f64; 2],
    /// Triangles on both sides of every inner edge that no crease cuts, its ends sorted.
    across: HashMap<[u32; 2], [u32; 2]>,
    /// Triangles at every particle, counted from the piece's first.
    around: Vec<Vec<u32>>,
    /// Rim particles with the two beside them.
    rim: HashMap<u32, Vec<u32>>,
    /// Cells of the regular grid.
    cells: Vec<Cell>,
    /// The cell of every triangle of the piece.
    cell_of: HashMap<u32, usize>,
}

/// Two triangles that make a rectangle along the threads.
struct Cell {
    /// Both ends of one diagonal, then of the other.
    corners: [u32; 4],
    /// Area of a rectangle, m².
    size: f64,
    /// Area to which the twist of the cell is assigned, m².
    area: f64,
}

/// Second derivatives as sums of differences: (from, to, factor) for x_uu, x_vv and x_uv.
type Flows = Vec<(u32, u32, f64)>;

impl<'a> PieceTriangles<'a> {
    fn new(mesh: &'a ClothMesh, piece: &'a PieceMesh, fabric: &Fabric) -> Self {
        let first = piece.triangles.start as u32;
        let folds = piece.lines.iter().filter(|l| l.kind.hinge().is_some());
        let cuts: HashSet<[u32; 2]> =
            folds.flat_map(|l| l.particles.windows(2)).map(|w| sorted_pair([w[0], w[1]])).collect();
        let topology = Topology::new(&mesh.triangles[piece.triangles.clone()]);
        let inner = topology.edges.iter().filter(|e| !cuts.contains(&e.ends));
        let across: HashMap<[u32; 2], [u32; 2]> =
            inner.clone().filter_map(|e| Some((e.ends, [first + e.triangles[0]?, first + e.triangles[1]?]))).collect();
        let mut around = vec![Vec::new(); piece.particles.len()];
        for t in piece.triangles.clone() {
            mesh.triangles[t].iter().for_each(|&n| around[n as usize - piece.particles.start].push(t as u32));
        }
        let mut rim: HashMap<u32, Vec<u32>> = HashMap::new();
        for [a, b] in topology.rim_edges().map(|e| e.ends) {
            rim.entry(a).or_default().push(b);
            rim.entry(b).or_default().push(a);
        }
        let rigidity = [fabric.bend_warp, fabric.bend_weft];
        let mut out = Self { mesh, piece, rigidity, across, around, rim, cells: Vec::new(), cell_of: HashMap::new() };
        for edge in inner {
            if let (Some(s), Some(t)) = (edge.triangles[0], edge.triangles[1]) {
                out.add_cell(edge.ends, [first + s, first + t]);
            }
        }
        out
    }

    fn flat(&self, n: u32) -> Vec2 {
        self.mesh.flat[n as usize]
    }

    /// Components of a flat vector along warp and weft.
    fn threads(&self, d: Vec2) -> [f64; 2] {
        [d.dot(&self.piece.warp), self.piece.warp.perp(&d)]
    }

    /// Two triangles beside their common edge, if they make a cell.
    fn add_cell(&mut self, [a, b]: [u32; 2], beside: [u32; 2]) {
        let apex = |t: u32| self.mesh.triangles[t as usize].into_iter().find(|&n| n != a && n != b);
        let (Some(c), Some(d)) = (apex(beside[0]), apex(beside[1])) else { return };
        let (pa, pb, pc, pd) = (self.flat(a), self.flat(b), self.flat(c), self.flat(d));
        let (one, other) = (pc - pa, pd - pa);
        let square = (pa + pb - pc - pd).norm() <= STRAIGHT * (pb - pa).norm();
        let threads = [one, other].map(|d| thread_of(self.piece.warp, d));
        if square && (threads == [Some(0), Some(1)] || threads == [Some(1), Some(0)]) {
            let cell = Cell { corners: [a, b, c, d], size: one.perp(&other).abs(), area: 0.0 };
            beside.iter().for_each(|t| _ = self.cell_of.insert(*t, self.cells.len()));
            self.cells.push(cell);
        }
    }

    fn stencils(mut self, hem: f64) -> Vec<Stencil> {
        let mut out = Vec::new();
        for v in self.piece.particles.clone() {
            for fan in self.fans(v as u32) {
                self.add_particle(v as u32, &fan, hem, &mut out);
            }
        }
        let [b1, b2] = self.rigidity;
        let twist = 2.0 * (b1 * b2).sqrt();
        out.extend(self.cells.iter().map(|c| Stencil { flows: c.mixed(), weight: twist * c.area }));
        out.retain(|s| s.weight > 0.0 && !s.flows.is_empty());
        out
    }

    /// The curvatures of the cloth round `v` in one fan.
    fn add_particle(&mut self, v: u32, fan: &[u32], hem: f64, out: &mut Vec<Stencil>) {
        let [b1, b2] = self.rigidity;
        let area: f64 = fan.iter().map(|&t| share(&self.corners_from(t, v))).sum();
        let gridded = fan.iter().all(|t| self.cell_of.contains_key(t));
        let straight = [0, 1].map(|k| self.second_difference(v, fan, k));
        let along = if hem > 0.0 { self.rim_direction(v) } else { None };
        let fitted = if gridded && along.is_none() && straight.iter().all(Option::is_some) {
            Default::default()
        } else {
            self.fit(v, fan)
        };
        let [along_warp, along_weft] = straight;
        out.push(Stencil { flows: along_warp.unwrap_or_else(|| fitted[0].clone()), weight: b1 * area });
        out.push(Stencil { flows: along_weft.unwrap_or_else(|| fitted[1].clone()), weight: b2 * area });
        if gridded {
            for t in fan {
                let part = share(&self.corners_from(*t, v));
                self.cells[self.cell_of[t]].area += part;
            }
        } else {
            out.push(Stencil { flows: fitted[2].clone(), weight: 2.0 * (b1 * b2).sqrt() * area });
        }
        if let Some((direction, length)) = along {
            let [u, w] = self.threads(direction);
            let parts = [u * u, w * w, 2.0 * u * w];
            let flows = fitted.iter().zip(parts).flat_map(|(f, p)| f.iter().map(move |&(a, b, c)| (a, b, p * c)));
            let rigidity = (b1.sqrt() * u * u + b2.sqrt() * w * w).powi(2);
            out.push(Stencil { flows: flows.collect(), weight: rigidity * hem * length });
        }
    }

    /// Direction of the rim at `v`, and the length of rim nearest to `v`, metres. `None` inside and at corners.
    fn rim_direction(&self, v: u32) -> Option<(Vec2, f64)> {
        let [a, b] = self.rim.get(&v)?[..] else { return None };
        let (before, after) = (self.flat(v) - self.flat(a), self.flat(b) - self.flat(v));
        let smooth = before.dot(&after) > CORNER * before.norm() * after.norm();
        smooth.then(|| ((before + after).normalize(), 0.5 * (before.norm() + after.norm())))
    }

    /// Flat corners of a triangle, `v` first.
    fn corners_from(&self, t: u32, v: u32) -> [Vec2; 3] {
        let nodes = self.mesh.triangles[t as usize];
        let k = nodes.iter().position(|&n| n == v).unwrap_or(0);
        [nodes[k], nodes[(k + 1) % 3], nodes[(k + 2) % 3]].map(|n| self.flat(n))
    }

    /// The triangles round `v`, in groups that no crease and no rim divides.
    fn fans(&self, v: u32) -> Vec<Vec<u32>> {
        let mut left = self.around[v as usize - self.piece.particles.start].clone();
        let mut out = Vec::new();
        while let Some(t) = left.pop() {
            let mut fan = vec![t];
            let mut next = 0;
            while next < fan.len() {
                for u in self.neighbours(fan[next]) {
                    if let Some(k) = left.iter().position(|&l| l == u) {
                        fan.push(left.swap_remove(k));
                    }
                }
                next += 1;
            }
            fan.sort_unstable();
            out.push(fan);
        }
        out
    }

    /// Triangles across the sides of `t` that no crease cuts.
    fn neighbours(&self, t: u32) -> impl Iterator<Item = u32> + '_ {
        let [a, b, c] = self.mesh.triangles[t as usize];
        let sides = [[a, b], [b, c], [c, a]].map(sorted_pair);
        sides.into_iter().filter_map(move |s| self.across.get(&s).map(|[l, r]| if *l == t { *r } else { *l }))
    }

    fn nodes_of(&self, triangles: &[u32]) -> Vec<u32> {
        let mut out: Vec<u32> = triangles.iter().flat_map(|&t| self.mesh.triangles[t as usize]).collect();
        out.sort_unstable();
        out.dedup();
        out
    }

    /// Second difference at `v` along the warp (0) or the weft (1). `None` unless it has two neighbours on that thread.
    fn second_difference(&self, v: u32, fan: &[u32], thread: usize) -> Option<Flows> {
        let mut beside = [None; 2];
        for n in self.nodes_of(fan).into_iter().filter(|&n| n != v) {
            let d = self.flat(n) - self.flat(v);
            if thread_of(self.piece.warp, d) == Some(thread) {
                let way = self.threads(d)[thread];
                beside[usize::from(way > 0.0)] = Some((n, way.abs()));
            }
        }
        let [(a, left), (b, right)] = [beside[0]?, beside[1]?];
        let mean = 0.5 * (left + right);
        Some(vec![(v, a, 1.0 / (left * mean)), (v, b, 1.0 / (right * mean))])
    }

    /// Second derivatives x_uu, x_vv and x_uv at `v` of the quadratic surface through `v` that best fits its neighbours
    /// and their neighbours.
    fn fit(&self, v: u32, fan: &[u32]) -> [Flows; 3] {
        let ring = self.nodes_of(fan);
        let beside = |t: u32| self.mesh.triangles[t as usize].iter().any(|n| ring.binary_search(n).is_ok());
        let mut patch = fan.to_vec();
        let mut next = 0;
        while next < patch.len() {
            for u in self.neighbours(patch[next]) {
                if !patch.contains(&u) && beside(u) {
                    patch.push(u);
                }
            }
            next += 1;
        }
        let nodes: Vec<u32> = self.nodes_of(&patch).into_iter().filter(|&n| n != v).collect();
        let away = |n: u32| self.flat(n) - self.flat(v);
        let near = ring.iter().filter(|&&n| n != v).map(|&n| away(n).norm()).sum::<f64>() / (ring.len() - 1) as f64;
        let rows = second_derivatives(&nodes.iter().map(|&n| self.threads(away(n) / near).into()).collect::<Vec<_>>());
        let mut out: [Flows; 3] = Default::default();
        for (&n, row) in nodes.iter().zip(&rows) {
            let ways = self.ways(v, n, &ring, &patch);
            for (flows, factor) in out.iter_mut().zip(row.iter()) {
                let factor = factor / (near * near * ways.len() as f64);
                flows.extend(ways.iter().flatten().filter(|_| factor != 0.0).map(|&(a, b)| (a, b, factor)));
            }
        }
        out
    }

    /// The shortest paths along edges of `patch` from `v` to `n`: one edge, or two by way of a particle of `v`'s ring.
    fn ways(&self, v: u32, n: u32, ring: &[u32], patch: &[u32]) -> Vec<Vec<(u32, u32)>> {
        if ring.binary_search(&n).is_ok() {
            return vec![vec![(v, n)]];
        }
        let at_n = patch.iter().map(|&t| self.mesh.triangles[t as usize]).filter(|t| t.contains(&n));
        let mut over: Vec<u32> = at_n.flatten().filter(|k| *k != v && ring.binary_search(k).is_ok()).collect();
        over.sort_unstable();
        over.dedup();
        over.into_iter().map(|k| vec![(v, k), (k, n)]).collect()
    }
}

impl Cell {
    /// Mixed derivative x_uv: the sum over one diagonal minus that over the other, divided by the area. Its sign does
    /// not matter.
    fn mixed(&self) -> Flows {
        let [a, b, c, d] = self.corners;
        [(c, a), (d, b), (d, a), (c, b)].map(|(from, to)| (from, to, 0.5 / self.size)).to_vec()
    }
}

/// Second derivatives (uu, vv, uv) at the origin by weighted least squares: the factor of each point's difference to
/// the value at the origin. The points lie about 1 from the origin. Linear functions give exactly 0.
fn second_derivatives(points: &[Vec2]) -> Vec<Vector3<f64>> {
    let weights: Vec<f64> = points.iter().map(|p| (-p.norm_squared()).exp()).collect();
    let mut gram = Matrix2::zeros();
    for (p, w) in points.iter().zip(&weights) {
        gram += p * p.transpose() * *w;
    }
    let Some(inverse) = gram.try_inverse() else { return vec![Vector3::zeros(); points.len()] };
    let quadratic = |p: &Vec2| Vector3::new(0.5 * p.x * p.x, 0.5 * p.y * p.y, p.x * p.y);
    // Each quadratic function without its best linear one.
    let mut mixed = nalgebra::Matrix2x3::zeros();
    for (p, w) in points.iter().zip(&weights) {
        mixed += p * quadratic(p).transpose() * *w;
    }
    let linear = inverse * mixed;
    let rest: Vec<Vector3<f64>> = points.iter().map(|p| quadratic(p) - linear.transpose() * p).collect();
    let mut normal = Matrix3::zeros();
    for (r, w) in rest.iter().zip(&weights) {
        normal += r * r.transpose() * *w;
    }
    let eigen = SymmetricEigen::new(normal);
    let most = eigen.eigenvalues.max();
    let mut pseudo = Matrix3::zeros();
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > SEEN * most {
            pseudo += vector * vector.transpose() / *value;
        }
    }
    rest.iter().zip(&weights).map(|(r, w)| pseudo * r * *w).collect()
}

/// Share of a triangle's area that is nearest to its first corner (Meyer et al. 2003, mixed for obtuse triangles).
fn share(p: &[Vec2; 3]) -> f64 {
    let cot = [0, 1, 2].map(|k| {
        let (a, b) = (p[(k + 1) % 3] - p[k], p[(k + 2) % 3] - p[k]);
        a.dot(&b) / a.perp(&b).abs().max(f64::MIN_POSITIVE)
    });
    let area = 0.5 * (p[1] - p[0]).perp(&(p[2] - p[0])).abs();
    match (0..3).find(|&k| cot[k] < 0.0) {
        Some(0) => 0.5 * area,
        Some(_) => 0.25 * area,
        None => ((p[1] - p[0]).norm_squared() * cot[2] + (p[2] - p[0]).norm_squared() * cot[1]) / 8.0,
    }
}
