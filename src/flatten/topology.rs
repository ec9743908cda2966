//! Is it a disk, with or without holes?

use super::FlattenError;
use crate::geometry::{DisjointSets, Topology, TriMesh, Vec3, rim_loops};

/// A triangle is degenerate below this share of its longest side squared (twice its area): about a thousand roundings
/// of a coordinate of the same size.
const DEGENERATE: f64 = 1e-12;

/// Rims of a checked surface: closed vertex chains that run with their triangles. The outline is the first in a disk;
/// with holes their order means nothing.
pub(super) type Rims = Vec<Vec<u32>>;

/// Checks numbers, triangles and connectivity; gives the rims of a disk with any number of holes.
pub(super) fn check(surface: &TriMesh) -> Result<(Topology, Rims), FlattenError> {
    check_numbers(surface)?;
    let topology = Topology::new(&surface.triangles);
    if let Some(&[a, b]) = topology.non_manifold.first() {
        return Err(FlattenError::NonManifoldEdge(a, b));
    }
    if let Some(&[a, b]) = topology.misoriented.first() {
        return Err(FlattenError::Misoriented(a, b));
    }
    let parts = components(surface.vertices.len(), &topology);
    if parts > 1 {
        return Err(FlattenError::Components(parts));
    }
    check_rim_vertices(surface.vertices.len(), &topology)?;
    let rims = rim_loops(&surface.triangles);
    if rims.is_empty() {
        return Err(FlattenError::Closed);
    }
    // Euler: V − E + F = 2 − rims − 2 handles.
    let euler = surface.vertices.len() as i64 - topology.edges.len() as i64 + surface.triangles.len() as i64;
    let handles = (2 - rims.len() as i64 - euler) / 2;
    if handles > 0 {
        return Err(FlattenError::Handles(handles as usize));
    }
    Ok((topology, rims))
}

fn check_numbers(surface: &TriMesh) -> Result<(), FlattenError> {
    if surface.triangles.is_empty() {
        return Err(FlattenError::Empty);
    }
    let vertices = surface.vertices.len();
    let mut used = vec![false; vertices];
    for (triangle, corners) in surface.triangles.iter().enumerate() {
        for &vertex in corners {
            match used.get_mut(vertex as usize) {
                Some(u) => *u = true,
                None => return Err(FlattenError::MissingVertex { triangle, vertex, vertices }),
            }
        }
    }
    if let Some(v) = used.iter().position(|u| !u) {
        return Err(FlattenError::LooseVertex(v));
    }
    if let Some(v) = surface.vertices.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(FlattenError::NotFinite(v));
    }
    match (0..surface.triangles.len()).find(|&t| is_degenerate(surface.corners(t))) {
        Some(t) => Err(FlattenError::Degenerate(t)),
        None => Ok(()),
    }
}

fn is_degenerate([a, b, c]: [Vec3; 3]) -> bool {
    let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
    let double_area = (b - a).cross(&(c - a)).norm();
    // Beyond about 10¹⁵⁰ metres the squares overflow: such a triangle is refused too.
    double_area <= DEGENERATE * longest || !longest.is_finite() || !double_area.is_finite()
}

/// Number of parts connected by edges.
fn components(vertices: usize, topology: &Topology) -> usize {
    let mut sets = DisjointSets::new(vertices);
    let joins = topology.edges.iter().filter(|e| sets.join(e.ends[0], e.ends[1])).count();
    vertices - joins
}

/// Every rim vertex lies on two rim edges; with four, two sheets touch in it.
fn check_rim_vertices(vertices: usize, topology: &Topology) -> Result<(), FlattenError> {
    let mut rim_edges = vec![0u32; vertices];
    for edge in topology.rim_edges() {
        for v in edge.ends {
            rim_edges[v as usize] += 1;
        }
    }
    match rim_edges.iter().position(|&n| n > 2) {
        Some(v) => Err(FlattenError::NonManifoldVertex(v)),
        None => Ok(()),
    }
}
