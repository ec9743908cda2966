//! The strip between the rim and the regular core, by constrained Delaunay triangulation. The only user of spade.

use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::frame::PieceFrame;
use super::grid::Core;
use crate::geometry::Vec2;

/// Why the strip could not be triangulated. Vertex numbers are those of the core's points.
pub(super) enum StripError {
    /// A spring of the frame crosses another or runs through a particle.
    Crossing([u32; 2]),
    /// Two particles lie on the same spot. The number is one of them.
    Double(u32),
    /// A particle of a line lies outside the rim.
    Outside(u32),
    /// The triangulator refused a coordinate.
    Refused(String),
}

/// Triangles of the strip, positively oriented.
pub(super) fn triangulate(frame: &PieceFrame, core: &Core) -> Result<Vec<[u32; 3]>, StripError> {
    let walls = walls(frame, core);
    // Cells all over, as in a rectangle along the grain.
    let strip = if walls.is_empty() { Vec::new() } else { between(frame, core, &walls)? };
    let mut used = core.in_cell.clone();
    strip.iter().flatten().for_each(|&v| used[v as usize] = true);
    match (frame.rim..frame.points.len()).find(|&v| !used[v]) {
        Some(v) => Err(StripError::Outside(v as u32)),
        None => Ok(strip),
    }
}

/// Triangles between the walls.
fn between(frame: &PieceFrame, core: &Core, walls: &[[u32; 2]]) -> Result<Vec<[u32; 3]>, StripError> {
    let vertices = members(core, walls);
    let is_side = |s: &[u32; 2]| core.sides.binary_search(s).is_ok();
    let in_strip = |s: &&[u32; 2]| !is_side(s) && !is_side(&[s[1], s[0]]);
    let constraints: Vec<_> = walls.iter().chain(frame.line_springs.iter().filter(in_strip)).copied().collect();
    Ok(flood(&delaunay(&core.points, &vertices, &constraints)?, walls))
}

/// Directed springs with the strip on their positive side: rim springs and reversed sides of the core, but not where
/// a cell lies directly on the rim. Sorted.
fn walls(frame: &PieceFrame, core: &Core) -> Vec<[u32; 2]> {
    let is_side = |s: &[u32; 2]| core.sides.binary_search(s).is_ok();
    let mut rim = frame.rim_springs.clone();
    rim.sort_unstable();
    let rim_walls = rim.iter().filter(|s| !is_side(s)).copied();
    let open_side = |s: &&[u32; 2]| !is_side(&[s[1], s[0]]) && rim.binary_search(s).is_err();
    let core_walls = core.sides.iter().filter(open_side).map(|s| [s[1], s[0]]);
    let mut walls: Vec<_> = rim_walls.chain(core_walls).collect();
    walls.sort_unstable();
    walls
}

/// Vertices of the strip, rising: ends of walls, and whatever is no corner of a cell.
fn members(core: &Core, walls: &[[u32; 2]]) -> Vec<u32> {
    let mut member: Vec<bool> = core.in_cell.iter().map(|c| !c).collect();
    walls.iter().flatten().for_each(|&v| member[v as usize] = true);
    (0..member.len() as u32).filter(|&v| member[v as usize]).collect()
}

/// All faces of the constrained Delaunay triangulation of `vertices`.
fn delaunay(points: &[Vec2], vertices: &[u32], constraints: &[[u32; 2]]) -> Result<Vec<[u32; 3]>, StripError> {
    let local = |v: u32| vertices.partition_point(|&w| w < v);
    let sites = vertices.iter().map(|&v| Point2::new(points[v as usize].x, points[v as usize].y)).collect();
    let mut edges: Vec<[usize; 2]> = constraints.iter().map(|&[a, b]| [local(a.min(b)), local(a.max(b))]).collect();
    edges.sort_unstable();
    edges.dedup();
    let expected = edges.len();
    let mut conflict = None;
    let cdt = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(sites, edges, |e| {
        conflict.get_or_insert(e);
    })
    .map_err(|e| StripError::Refused(e.to_string()))?;
    if cdt.num_vertices() != vertices.len() {
        return Err(StripError::Double(first_double(points, vertices)));
    }
    if let Some([a, b]) = conflict {
        return Err(StripError::Crossing([vertices[a], vertices[b]]));
    }
    // A constraint that runs exactly through a vertex is split there: one more than we gave.
    if cdt.num_constraints() != expected {
        let missing = constraints.iter().find(|[a, b]| {
            let handle = |v: u32| spade::handles::FixedVertexHandle::from_index(local(v));
            !cdt.exists_constraint(handle(*a), handle(*b))
        });
        return Err(StripError::Crossing(missing.copied().unwrap_or(constraints[0])));
    }
    Ok(cdt.inner_faces().map(|f| f.vertices().map(|v| vertices[v.fix().index()])).collect())
}

/// A vertex that shares its position with another.
fn first_double(points: &[Vec2], vertices: &[u32]) -> u32 {
    let mut order = vertices.to_vec();
    let key = |v: u32| (points[v as usize].x, points[v as usize].y);
    order.sort_by(|&a, &b| key(a).0.total_cmp(&key(b).0).then(key(a).1.total_cmp(&key(b).1)));
    order.windows(2).find(|w| key(w[0]) == key(w[1])).map_or(vertices[0], |w| w[1])
}

/// The faces that can be reached from the positive side of a wall without crossing one.
fn flood(faces: &[[u32; 3]], walls: &[[u32; 2]]) -> Vec<[u32; 3]> {
    let is_wall = |a: u32, b: u32| walls.binary_search(&[a, b]).is_ok();
    let mut sides: Vec<([u32; 2], usize)> = Vec::with_capacity(3 * faces.len());
    for (f, v) in faces.iter().enumerate() {
        sides.extend((0..3).map(|k| ([v[k], v[(k + 1) % 3]], f)));
    }
    sides.sort_unstable();
    let face_at = |side: [u32; 2]| sides.binary_search_by_key(&side, |s| s.0).ok().map(|k| sides[k].1);
    let mut inside = vec![false; faces.len()];
    let mut stack: Vec<usize> = walls.iter().filter_map(|&w| face_at(w)).collect();
    while let Some(f) = stack.pop() {
        if std::mem::replace(&mut inside[f], true) {
            continue;
        }
        let v = faces[f];
        for k in 0..3 {
            let (a, b) = (v[k], v[(k + 1) % 3]);
            if !is_wall(a, b) && !is_wall(b, a) {
                stack.extend(face_at([b, a]).filter(|&g| !inside[g]));
            }
        }
    }
    faces.iter().zip(inside).filter(|(_, i)| *i).map(|(f, _)| *f).collect()
}
