//! Fig. 6 of Liu, Wang & Luo 2015: the shape does not depend on the mesh. An irregular Delaunay mesh of 329 vertices
//! against a regular one of 323 (19 × 17; no square grid of the specimen has 329), and 48 (8 × 6)
//! against 441 (21 × 21).
//!
//! `cargo run --release --example fig6` prints distances between the surfaces for every fabric and writes pictures. The
//! sums are weighted by area (`Weighting::PerArea`); printed as they stand, (4)–(6) depend on the mesh.
//! What is left comes from the handles: the cloth falls from what is lifted to what recovery holds within a cell or
//! two, which no mesh of these sizes resolves.

mod common;

use std::error::Error;

use common::{Experiment, HEIGHT, WIDTH, fifteen, on_rim, picture, sheet, solve};
use spade::{DelaunayTriangulation, Point2, Triangulation};
use toile::contact::closest_on_triangle;
use toile::drape::geometric::{Weighting, Weights};
use toile::geometry::{TriMesh, Vec3};

/// Vertices of the irregular mesh, and those of them on each pair of sides.
const IRREGULAR: usize = 329;
const ON_WIDTH: usize = 18;
const ON_HEIGHT: usize = 16;
/// What is lifted: all within this distance of the middle, metres, by so much.
const LIFTED: f64 = 0.08;
const LIFT: f64 = 0.06;

fn main() -> Result<(), Box<dyn Error>> {
    let diagonal = WIDTH.hypot(HEIGHT);
    let pairs = [
        ("329 irregular, 323 regular", lifted(irregular()?), lifted(sheet(WIDTH, HEIGHT, 19, 17))),
        ("48, 441", lifted(sheet(WIDTH, HEIGHT, 8, 6)), lifted(sheet(WIDTH, HEIGHT, 21, 21))),
    ];
    println!("largest distance between the surfaces, % of the diagonal\n");
    println!("{:20} {:>28} {:>28}", "fabric", pairs[0].0, pairs[1].0);
    for fabric in fifteen()? {
        let Some(liu) = &fabric.liu else { continue };
        let weights = Weights::from_percent(liu.weights);
        let mut row = format!("{:20}", fabric.name);
        for (pair, (_, a, b)) in pairs.iter().enumerate() {
            let ((x, ..), (y, ..)) = (solve(a, weights, Weighting::PerArea)?, solve(b, weights, Weighting::PerArea)?);
            let apart = apart(&x, &b.mesh, &y).max(apart(&y, &a.mesh, &x));
            row += &format!(" {:>28.2}", 100.0 * apart / diagonal);
            if fabric.name == "wool_suiting" {
                picture(&format!("fig6_{pair}_a"), "wool", &a.mesh, &x)?;
                picture(&format!("fig6_{pair}_b"), "wool", &b.mesh, &y)?;
            }
        }
        println!("{row}");
    }
    Ok(())
}

/// Rim fixed, the middle lifted.
fn lifted(mesh: TriMesh) -> Experiment {
    let mut start = mesh.vertices.clone();
    let mut held = Vec::new();
    for (k, v) in (0u32..).zip(&mut start) {
        let middle = (v.xy() - Vec3::new(0.5 * WIDTH, 0.5 * HEIGHT, 0.0).xy()).norm() <= LIFTED;
        if middle {
            v.z = LIFT;
        }
        if middle || on_rim(v) {
            held.push(k);
        }
    }
    Experiment { name: "fig6", mesh, held, start }
}

/// A Delaunay mesh of the specimen: vertices along the rim, the others apart from each other as far as chance allows.
fn irregular() -> Result<TriMesh, Box<dyn Error>> {
    let mut points = Vec::new();
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

/// Largest distance of the points `x` from a surface.
fn apart(x: &[Vec3], mesh: &TriMesh, y: &[Vec3]) -> f64 {
    let to_surface = |p: &Vec3| {
        let distance = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|n| y[n as usize]);
            let w = closest_on_triangle(*p, a, b, c);
            (a * w[0] + b * w[1] + c * w[2] - p).norm()
        };
        mesh.triangles.iter().map(distance).fold(f64::INFINITY, f64::min)
    };
    x.iter().map(to_surface).fold(0.0, f64::max)
}
