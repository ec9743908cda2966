//! Fig. 6: the pairs of meshes, the two ways their handles move, and how far two surfaces are apart.

use std::error::Error;

use spade::{DelaunayTriangulation, Point2, Triangulation};
use toile::contact::closest_on_triangle;
use toile::drape::geometric::{Weighting, Weights};
use toile::geometry::{TriMesh, Vec3};

use super::{Experiment, HEIGHT, WIDTH, on_rim, sheet, solve};

/// Vertices of the irregular mesh, and those of them on each pair of sides.
const IRREGULAR: usize = 329;
const ON_WIDTH: usize = 18;
const ON_HEIGHT: usize = 16;
/// What is lifted in the middle: all within this distance of it, metres.
const LIFTED: f64 = 0.08;
/// How far handles are lifted, metres.
const LIFT: f64 = 0.06;
/// Surfaces are compared in points no further from each other than this, metres.
const SAMPLED: f64 = 0.01;

/// 329 vertices in an irregular Delaunay mesh and 323 in a regular one (19 × 17; no square grid of the specimen has
/// 329), then 48 (8 × 6) and 441 (21 × 21) in regular ones.
pub(crate) fn pairs() -> Result<[[TriMesh; 2]; 2], Box<dyn Error>> {
    let regular = sheet(WIDTH, HEIGHT, 19, 17);
    Ok([[irregular(&regular)?, regular], [sheet(WIDTH, HEIGHT, 8, 6), sheet(WIDTH, HEIGHT, 21, 21)]])
}

/// Rim fixed, the middle lifted: a step in the cloth's height, as wide as the mesh's cells.
pub(crate) fn middle(mesh: &TriMesh) -> Experiment {
    handles("middle", mesh, |v| if in_middle(v) { Some(LIFT) } else { on_rim(v).then_some(0.0) })
}

/// The rim raised to an arch from side to side, nothing else held: the same curve of the cloth in every mesh.
pub(crate) fn arch(mesh: &TriMesh) -> Experiment {
    handles("arch", mesh, |v| on_rim(v).then(|| LIFT * (std::f64::consts::PI * v.x / WIDTH).sin()))
}

/// `height` says how far a vertex is lifted, and nothing for those that are free.
fn handles(name: &'static str, mesh: &TriMesh, height: impl Fn(&Vec3) -> Option<f64>) -> Experiment {
    let (mut start, mut held) = (mesh.vertices.clone(), Vec::new());
    for (k, v) in (0u32..).zip(&mut start) {
        if let Some(z) = height(v) {
            v.z = z;
            held.push(k);
        }
    }
    Experiment { name, mesh: mesh.clone(), held, start }
}

fn in_middle(v: &Vec3) -> bool {
    (v.x - 0.5 * WIDTH).hypot(v.y - 0.5 * HEIGHT) <= LIFTED
}

/// A Delaunay mesh of the specimen: vertices along the rim, in the middle those of `partner`, so that the same points
/// of the cloth are lifted, and the others apart from each other as far as chance allows.
fn irregular(partner: &TriMesh) -> Result<TriMesh, Box<dyn Error>> {
    let mut points: Vec<[f64; 2]> = partner.vertices.iter().filter(|v| in_middle(v)).map(|v| [v.x, v.y]).collect();
    for k in 0..ON_WIDTH {
        let s = WIDTH * k as f64 / ON_WIDTH as f64;
        points.extend([[s, 0.0], [WIDTH - s, HEIGHT]]);
    }
    for k in 0..ON_HEIGHT {
        let s = HEIGHT * k as f64 / ON_HEIGHT as f64;
        points.extend([[WIDTH, s], [0.0, HEIGHT - s]]);
    }
    let mut state = 2015u64;
    let mut chance = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as f64 / f64::from(1u32 << 31)
    };
    // Best of many candidates (Mitchell 1991): each new point is the one farthest from all others.
    while points.len() < IRREGULAR {
        let candidates: Vec<[f64; 2]> = (0..30).map(|_| [WIDTH * chance(), HEIGHT * chance()]).collect();
        let room = |c: &[f64; 2]| points.iter().map(|p| (p[0] - c[0]).hypot(p[1] - c[1])).fold(f64::INFINITY, f64::min);
        let best = candidates.into_iter().max_by(|a, b| room(a).total_cmp(&room(b)));
        points.extend(best);
    }
    let mut mesh = DelaunayTriangulation::<Point2<f64>>::new();
    for [x, y] in &points {
        mesh.insert(Point2::new(*x, *y))?;
    }
    let vertices = mesh.vertices().map(|v| Vec3::new(v.position().x, v.position().y, 0.0)).collect();
    let triangles = mesh.inner_faces().map(|f| f.vertices().map(|v| v.fix().index() as u32)).collect();
    Ok(TriMesh { vertices, triangles })
}

/// Largest distance between the shapes of two meshes whose handles move alike, as a share of the specimen's diagonal.
pub(crate) fn difference(
    pair: &[TriMesh; 2],
    handles: fn(&TriMesh) -> Experiment,
    weights: Weights,
) -> Result<f64, Box<dyn Error>> {
    let solved = |mesh: &TriMesh| {
        let (vertices, ..) = solve(&handles(mesh), weights, Weighting::PerArea)?;
        Ok::<TriMesh, Box<dyn Error>>(TriMesh { vertices, triangles: mesh.triangles.clone() })
    };
    Ok(apart(&solved(&pair[0])?, &solved(&pair[1])?) / WIDTH.hypot(HEIGHT))
}

/// Largest distance between two surfaces, metres: of points all over either from the other.
fn apart(a: &TriMesh, b: &TriMesh) -> f64 {
    let from = |a: &TriMesh, b: &TriMesh| {
        let edge = (0..b.triangles.len()).map(|t| longest(b.corners(t))).fold(0.0, f64::max);
        samples(a).iter().map(|p| to_surface(p, b, edge)).fold(0.0, f64::max)
    };
    from(a, b).max(from(b, a))
}

fn to_surface(p: &Vec3, mesh: &TriMesh, longest: f64) -> f64 {
    let mut best = f64::INFINITY;
    for t in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(t);
        // Nothing of a triangle is nearer than its corner by more than an edge.
        if (a - p).norm_squared() < (best + longest).powi(2) {
            let w = closest_on_triangle(*p, a, b, c);
            best = best.min((a * w[0] + b * w[1] + c * w[2] - p).norm());
        }
    }
    best
}

/// The longest edge of a triangle.
fn longest([a, b, c]: [Vec3; 3]) -> f64 {
    (b - a).norm().max((c - b).norm()).max((a - c).norm())
}

/// Points all over a surface, its vertices among them.
fn samples(mesh: &TriMesh) -> Vec<Vec3> {
    let mut out = Vec::new();
    for t in 0..mesh.triangles.len() {
        let [a, b, c] = mesh.corners(t);
        let n = (longest([a, b, c]) / SAMPLED).ceil().max(1.0) as u32;
        let share = |k: u32| f64::from(k) / f64::from(n);
        out.extend((0..=n).flat_map(|i| (0..=n - i).map(move |j| a + (b - a) * share(i) + (c - a) * share(j))));
    }
    out
}
