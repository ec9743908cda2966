//! An independent check of a mesh against its garment. It shares no code with the mesher.

use super::{ClothMesh, PieceMesh};
use crate::geometry::{Topology, Vec2, rim_loops, sorted_pair};
use crate::pattern::{Garment, Piece};

/// Largest distance of a rim particle from its drawn edge, metres.
const ON_EDGE: f64 = 1e-9;
/// Largest relative difference of two areas that should be equal.
const SAME_AREA: f64 = 1e-9;
/// Largest distance of the particle at a span's end outside the span, metres.
const OFF_END: f64 = 2e-5;

/// A broken promise of a mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CheckError {
    /// The mesh has not as many pieces or seams as the garment, or counts that do not add up.
    #[error("the mesh has {found} {what}, expected {expected}")]
    Count {
        /// The kind of thing counted.
        what: String,
        /// Number in the mesh.
        found: usize,
        /// Number expected.
        expected: usize,
    },
    /// A position is not finite.
    #[error("particle {particle} of '{piece}' is not finite")]
    NotFinite {
        /// The piece.
        piece: String,
        /// The particle.
        particle: usize,
    },
    /// A triangle names a particle of another piece, or is turned over.
    #[error("triangle {triangle} of '{piece}' {fault}")]
    Triangle {
        /// The piece.
        piece: String,
        /// The triangle.
        triangle: usize,
        /// The fault.
        fault: &'static str,
    },
    /// A particle belongs to no triangle.
    #[error("particle {particle} of '{piece}' belongs to no triangle")]
    Unused {
        /// The piece.
        piece: String,
        /// The particle.
        particle: usize,
    },
    /// The piece is no manifold disk with holes.
    #[error("'{piece}' {fault}")]
    Surface {
        /// The piece.
        piece: String,
        /// The fault.
        fault: String,
    },
    /// An edge's particles are not where they should be.
    #[error("edge '{piece}.{edge}': {fault}")]
    Edge {
        /// The piece.
        piece: String,
        /// The edge.
        edge: String,
        /// The fault.
        fault: String,
    },
    /// A line's particles are not joined.
    #[error("line '{line}' of '{piece}' is no chain of mesh edges")]
    Line {
        /// The piece.
        piece: String,
        /// The line.
        line: String,
    },
    /// A seam's pairs are wrong.
    #[error("seam '{seam}': {fault}")]
    Seam {
        /// The seam.
        seam: String,
        /// The fault.
        fault: String,
    },
}

/// Checks a mesh against its garment:
/// - all values are finite;
/// - every piece is a manifold disk with its holes, positively oriented (y down), and has the area of its rim's
///   polygon;
/// - every particle is used;
/// - rims consist of exactly the particles of the edges, which lie on the drawn edges;
/// - lines are chains of mesh edges;
/// - seams pair every rim particle of both sides in order, and no mesh edge inside a piece joins two stitched
///   particles.
///
/// # Errors
/// The first broken promise.
pub fn check(mesh: &ClothMesh, garment: &Garment) -> Result<(), CheckError> {
    count("pieces", mesh.pieces.len(), garment.pieces.len())?;
    count("seams", mesh.seams.len(), garment.seams.len())?;
    let (mut particles, mut triangles) = (0, 0);
    for (piece, drawn) in mesh.pieces.iter().zip(&garment.pieces) {
        count("particles before a piece", piece.particles.start, particles)?;
        count("triangles before a piece", piece.triangles.start, triangles)?;
        (particles, triangles) = (piece.particles.end, piece.triangles.end);
        check_piece(mesh, piece, drawn)?;
    }
    count("particles", mesh.flat.len(), particles)?;
    count("triangles", mesh.triangles.len(), triangles)?;
    check_seams(mesh, garment)
}

fn count(what: &str, found: usize, expected: usize) -> Result<(), CheckError> {
    if found == expected { Ok(()) } else { Err(CheckError::Count { what: what.to_owned(), found, expected }) }
}

fn check_piece(mesh: &ClothMesh, piece: &PieceMesh, drawn: &Piece) -> Result<(), CheckError> {
    if let Some(particle) = piece.particles.clone().find(|&v| !mesh.flat[v].iter().all(|x| x.is_finite())) {
        return Err(CheckError::NotFinite { piece: piece.name.clone(), particle });
    }
    check_triangles(mesh, piece)?;
    let surface = |fault: String| CheckError::Surface { piece: piece.name.clone(), fault };
    let triangles = &mesh.triangles[piece.triangles.clone()];
    let topology = Topology::new(triangles);
    if !topology.non_manifold.is_empty() || !topology.misoriented.is_empty() {
        return Err(surface("is no oriented manifold".to_owned()));
    }
    let euler = piece.particles.len() as i64 - topology.edges.len() as i64 + triangles.len() as i64;
    let expected = 2 - drawn.loops.len() as i64;
    if euler != expected {
        return Err(surface(format!("has Euler characteristic {euler}, not {expected}")));
    }
    check_rims(piece, drawn, triangles).map_err(surface)?;
    let (area, polygon) = (triangles.iter().map(|&t| double_area(mesh, t)).sum::<f64>(), polygon_area(mesh, piece));
    if (area - polygon).abs() > SAME_AREA * polygon.abs() {
        return Err(surface(format!("covers {} m2, its rim encloses {} m2", 0.5 * area, 0.5 * polygon)));
    }
    check_edges(mesh, piece, drawn)?;
    for line in &piece.lines {
        let joined = |w: &[u32]| topology.edges.binary_search_by_key(&sorted_pair([w[0], w[1]]), |e| e.ends).is_ok();
        if line.particles.len() < 2 || !line.particles.windows(2).all(joined) {
            return Err(CheckError::Line { piece: piece.name.clone(), line: line.name.clone() });
        }
    }
    Ok(())
}

fn check_triangles(mesh: &ClothMesh, piece: &PieceMesh) -> Result<(), CheckError> {
    let mut used = vec![false; piece.particles.len()];
    for triangle in piece.triangles.clone() {
        let t = mesh.triangles[triangle];
        let fault = |fault| CheckError::Triangle { piece: piece.name.clone(), triangle, fault };
        if !t.iter().all(|&v| piece.particles.contains(&(v as usize))) {
            return Err(fault("names a particle of another piece"));
        }
        if double_area(mesh, t) <= 0.0 {
            return Err(fault("is turned over"));
        }
        t.iter().for_each(|&v| used[v as usize - piece.particles.start] = true);
    }
    match used.iter().position(|u| !u) {
        Some(v) => Err(CheckError::Unused { piece: piece.name.clone(), particle: piece.particles.start + v }),
        None => Ok(()),
    }
}

/// The mesh's rims, as cycles, are the edges' particles.
fn check_rims(piece: &PieceMesh, drawn: &Piece, triangles: &[[u32; 3]]) -> Result<(), String> {
    let mut rims: Vec<Vec<u32>> = rim_loops(triangles).into_iter().map(from_smallest).collect();
    let mut rings = Vec::new();
    for ring in 0..drawn.loops.len() {
        let edges = piece.edges.iter().filter(|e| e.edge.ring == ring);
        rings.push(from_smallest(edges.flat_map(|e| &e.particles[..e.particles.len() - 1]).copied().collect()));
    }
    rims.sort();
    rings.sort();
    if rims == rings {
        Ok(())
    } else {
        Err(format!("has {} rims that are not its {} rings of edges", rims.len(), rings.len()))
    }
}

/// The cycle, rotated to begin at its smallest number.
fn from_smallest(mut cycle: Vec<u32>) -> Vec<u32> {
    let start = (0..cycle.len()).min_by_key(|&k| cycle[k]).unwrap_or(0);
    cycle.rotate_left(start);
    cycle
}

fn check_edges(mesh: &ClothMesh, piece: &PieceMesh, drawn: &Piece) -> Result<(), CheckError> {
    count("edges of a piece", piece.edges.len(), drawn.loops.iter().map(Vec::len).sum())?;
    for edge in &piece.edges {
        let path = &drawn.loops[edge.edge.ring][edge.edge.index].path;
        let fail = |fault: String| CheckError::Edge { piece: piece.name.clone(), edge: edge.name.clone(), fault };
        let mut before = -1.0;
        for (k, &v) in edge.particles.iter().enumerate() {
            let p = mesh.flat[v as usize];
            let (mut s, distance) = path.nearest(p);
            // A closed edge starts and ends on the same spot.
            if k + 1 == edge.particles.len() && (path.end() - p).norm() <= ON_EDGE {
                s = path.length();
            }
            if distance > ON_EDGE {
                return Err(fail(format!("particle {v} lies {distance} m off it")));
            }
            if s <= before {
                return Err(fail(format!("particle {v} is out of order")));
            }
            before = s;
        }
        let ends = [(edge.particles[0], path.start()), (edge.particles[edge.particles.len() - 1], path.end())];
        if ends.iter().any(|(v, p)| (mesh.flat[*v as usize] - p).norm() > 1e-6) {
            return Err(fail("an end has no particle".to_owned()));
        }
    }
    Ok(())
}

fn check_seams(mesh: &ClothMesh, garment: &Garment) -> Result<(), CheckError> {
    let topology = Topology::new(&mesh.triangles);
    let inner = |a: u32, b: u32| {
        let edge = topology.edges.binary_search_by_key(&sorted_pair([a, b]), |e| e.ends);
        edge.is_ok_and(|k| topology.edges[k].triangles[1].is_some())
    };
    for (stitches, seam) in mesh.seams.iter().zip(&garment.seams) {
        let fail = |fault: String| CheckError::Seam { seam: stitches.name.clone(), fault };
        if stitches.pairs.windows(2).any(|w| w[0] == w[1]) {
            return Err(fail("a pair occurs twice".to_owned()));
        }
        for (side, spans) in [&seam.a, &seam.b].into_iter().enumerate() {
            let mut chain: Vec<u32> = stitches.pairs.iter().map(|p| p[side]).collect();
            chain.dedup();
            let mut expected: Vec<u32> = spans.iter().flat_map(|s| walked(mesh, garment, s)).collect();
            expected.dedup();
            if chain != expected {
                return Err(fail(format!(
                    "side {side} stitches {} particles, its edges have {}",
                    chain.len(),
                    expected.len()
                )));
            }
        }
        if let Some([a, b]) = stitches.pairs.iter().find(|[a, b]| inner(*a, *b)) {
            return Err(fail(format!("particles {a} and {b} are stitched and joined by an inner spring")));
        }
    }
    Ok(())
}

/// Particles on a span, found by their position: from the one nearest to its one end to the one nearest to its other.
/// Two places may lie closer together than an end may be off its particle, so that alone does not tell which it is.
fn walked(mesh: &ClothMesh, garment: &Garment, span: &crate::pattern::Span) -> Vec<u32> {
    let path = &garment.pieces[span.edge.piece].loops[span.edge.ring][span.edge.index].path;
    let Some(edge) = mesh.pieces[span.edge.piece].edges.iter().find(|e| e.edge == span.edge) else {
        return Vec::new();
    };
    let last = edge.particles.len() - 1;
    let place = |(k, &v): (usize, &u32)| match k {
        0 => 0.0,
        k if k == last => path.length(),
        _ => path.nearest(mesh.flat[v as usize]).0,
    };
    let places: Vec<f64> = edge.particles.iter().enumerate().map(place).collect();
    let off = |k: usize, s: f64| (places[k] - s).abs();
    let nearest = |s: f64| (0..=last).min_by(|&j, &k| off(j, s).total_cmp(&off(k, s))).unwrap_or(0);
    let (low, high) = span.sorted();
    let on = (nearest(low)..=nearest(high)).filter(|&k| places[k] >= low - OFF_END && places[k] <= high + OFF_END);
    let mut out: Vec<u32> = on.map(|k| edge.particles[k]).collect();
    if span.from > span.to {
        out.reverse();
    }
    out
}

fn double_area(mesh: &ClothMesh, t: [u32; 3]) -> f64 {
    let [a, b, c]: [Vec2; 3] = t.map(|v| mesh.flat[v as usize]);
    (b - a).perp(&(c - a))
}

/// Twice the area inside the polygon of the edges' particles.
fn polygon_area(mesh: &ClothMesh, piece: &PieceMesh) -> f64 {
    let sides = piece.edges.iter().flat_map(|e| e.particles.windows(2));
    sides.map(|w| mesh.flat[w[0] as usize].perp(&mesh.flat[w[1] as usize])).sum()
}
