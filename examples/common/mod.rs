//! The meshes, handles and pictures that the experiments of Liu, Wang & Luo 2015 share.
#![allow(dead_code, reason = "every example uses some of it")]

pub(crate) mod pairs;

use std::error::Error;
use std::path::Path;

use toile::drape::geometric::{Aim, GeometricCloth, LeastSquares, Report, SolveOptions, Weighting, Weights};
use toile::fabric::{self, FabricSheet};
use toile::geometry::{TriMesh, Vec3};
use toile::io::files::write_all;
use toile::picture::{Scene, draw, rim_lines};

/// The specimen, metres (L2).
pub(crate) const WIDTH: f64 = 0.46;
pub(crate) const HEIGHT: f64 = 0.40;
/// The paper counts iterations until it sees no change; here, until the energy changes by less than this share.
pub(crate) const SETTLED: f64 = 1e-4;
/// Iterations after which a run ends.
const MOST: usize = 60;

/// A cloth with handles: a mesh, the vertices that are held, and where they are held.
pub(crate) struct Experiment {
    pub(crate) name: &'static str,
    pub(crate) mesh: TriMesh,
    pub(crate) held: Vec<u32>,
    pub(crate) start: Vec<Vec3>,
}

/// A sheet of `columns` × `rows` vertices upright in the plane z = 0, diagonals all one way.
pub(crate) fn sheet(width: f64, height: f64, columns: u32, rows: u32) -> TriMesh {
    let share = |k: u32, n: u32| f64::from(k) / f64::from(n - 1);
    let vertices = (0..columns * rows)
        .map(|k| Vec3::new(width * share(k % columns, columns), height * share(k / columns, rows), 0.0))
        .collect();
    let mut triangles = Vec::new();
    for a in (0..columns * (rows - 1)).filter(|a| a % columns != columns - 1) {
        triangles.extend([[a, a + 1, a + columns + 1], [a, a + columns + 1, a + columns]]);
    }
    TriMesh { vertices, triangles }
}

/// Whether a point of the specimen lies on its rim.
pub(crate) fn on_rim(v: &Vec3) -> bool {
    let edge = 1e-9;
    v.x < edge || v.y < edge || v.x > WIDTH - edge || v.y > HEIGHT - edge
}

/// Rim fixed, five places of the diagonal lifted by 60 mm (Figs. 4 and 5).
pub(crate) fn diagonal(name: &'static str, columns: u32, rows: u32) -> Experiment {
    let mesh = sheet(WIDTH, HEIGHT, columns, rows);
    let mut held: Vec<u32> = (0u32..).zip(&mesh.vertices).filter(|(_, v)| on_rim(v)).map(|(k, _)| k).collect();
    let mut start = mesh.vertices.clone();
    for k in 2..=6 {
        let place = |n: u32| (f64::from(n - 1) * f64::from(k) / 8.0).round() as u32;
        let v = place(rows) * columns + place(columns);
        held.push(v);
        start[v as usize].z += 0.06;
    }
    Experiment { name, mesh, held, start }
}

/// The ball of Fig. 7: middle and radius, metres.
const BALL: (Vec3, f64) = (Vec3::new(0.5 * WIDTH, 0.5 * HEIGHT, -0.02), 0.08);

/// A ball under the cloth, corners fixed.
pub(crate) fn ball(side: u32) -> Experiment {
    let mesh = sheet(WIDTH, HEIGHT, side, side);
    let mut start = mesh.vertices.clone();
    let mut held = vec![0, side - 1, side * (side - 1), side * side - 1];
    for (k, v) in (0u32..).zip(&mut start) {
        let across = (v.xy() - BALL.0.xy()).norm();
        let high = BALL.0.z + (BALL.1 * BALL.1 - across * across).max(0.0).sqrt();
        if across < BALL.1 && high > 0.0 {
            v.z = high;
            held.push(k);
        }
    }
    Experiment { name: "ball", mesh, held, start }
}

/// Three corners fixed, the fourth drawn along the diagonal by 30 mm.
pub(crate) fn pull(side: u32) -> Experiment {
    let mesh = sheet(WIDTH, HEIGHT, side, side);
    let mut start = mesh.vertices.clone();
    let last = side * side - 1;
    start[last as usize] += Vec3::new(WIDTH, HEIGHT, 0.0).normalize() * 0.03;
    Experiment { name: "pull", held: vec![0, side - 1, side * (side - 1), last], mesh, start }
}

/// Both sides fixed and brought nearer by 40 mm, the rest waved a little: horizontal wrinkles.
pub(crate) fn wrinkles(side: u32) -> Experiment {
    let mesh = sheet(WIDTH, HEIGHT, side, side);
    let mut start = mesh.vertices.clone();
    let mut held = Vec::new();
    for (k, v) in (0u32..).zip(&mut start) {
        let share = v.y / HEIGHT;
        v.y = HEIGHT * (0.05 + 0.9 * share);
        v.z = 0.012 * (4.0 * std::f64::consts::TAU * share).sin();
        if k < side || k >= side * (side - 1) {
            v.z = 0.0;
            held.push(k);
        }
    }
    Experiment { name: "wrinkles", mesh, held, start }
}

/// The half skirt of Fig. 9: a tube of 51 rows of 26 vertices (the nearest there is to 1,361 vertices and 2,500
/// triangles), waist fixed, every fifth vertex of the hem drawn out or in by 50 mm and up by 20 mm.
pub(crate) fn skirt() -> Experiment {
    const ROUND: u32 = 26;
    const ROWS: u32 = 51;
    let at = |k: u32| {
        let angle = std::f64::consts::TAU * f64::from(k % ROUND) / f64::from(ROUND);
        let down = f64::from(k / ROUND) / f64::from(ROWS - 1);
        let radius = 0.12 + 0.10 * down;
        Vec3::new(radius * angle.cos(), -0.55 * down, radius * angle.sin())
    };
    let vertices: Vec<Vec3> = (0..ROUND * ROWS).map(at).collect();
    let mut triangles = Vec::new();
    for k in 0..ROUND * (ROWS - 1) {
        let next = k / ROUND * ROUND + (k + 1) % ROUND;
        triangles.extend([[k, next, next + ROUND], [k, next + ROUND, k + ROUND]]);
    }
    let mut held: Vec<u32> = (0..ROUND).collect();
    let mut start = vertices.clone();
    for k in (0..ROUND).filter(|k| k % 5 == 0) {
        let v = ROUND * (ROWS - 1) + k;
        let out = Vec3::new(start[v as usize].x, 0.0, start[v as usize].z).normalize();
        let sign = if k % 2 == 0 { 0.05 } else { -0.05 };
        start[v as usize] += out * sign + Vec3::y() * 0.02;
        held.push(v);
    }
    Experiment { name: "skirt", mesh: TriMesh { vertices, triangles }, held, start }
}

/// The fifteen published fabrics, in their order.
pub(crate) fn fifteen() -> Result<Vec<FabricSheet>, Box<dyn Error>> {
    let sheets: Result<Vec<FabricSheet>, _> = fabric::library().into_iter().map(fabric::sheet).collect();
    Ok(sheets?.into_iter().filter(|s| s.liu.as_ref().is_some_and(|l| l.sample.is_some())).collect())
}

/// Published weights of a fabric.
pub(crate) fn weights(name: &str) -> Result<Weights, Box<dyn Error>> {
    let liu = fabric::sheet(name)?.liu.ok_or("a fabric without published weights")?;
    Ok(Weights::from_percent(liu.weights))
}

/// The published solver on an experiment: the shape, its report, and iterations until the energy is [`SETTLED`].
pub(crate) fn solve(e: &Experiment, w: Weights, by: Weighting) -> Result<(Vec<Vec3>, Report, usize), Box<dyn Error>> {
    let cloth = GeometricCloth::new(&e.mesh, w, by)?;
    let mut x = e.start.clone();
    let aim = Aim::Targets(e.mesh.vertices.clone());
    let options = SolveOptions { max_iterations: MOST, ..SolveOptions::default() };
    let report = LeastSquares::new(&cloth, &e.held)?.solve(&mut x, &aim, options)?;
    let quiet = |w: &[f64]| w[0] - w[1] < SETTLED * w[1];
    let settled = report.history.windows(2).position(quiet).map_or(report.iterations, |k| k + 1);
    Ok((x, report, settled))
}

/// Draws a surface from three sides into `out/experiments/NAME.png`.
pub(crate) fn picture(name: &str, subtitle: &str, mesh: &TriMesh, x: &[Vec3]) -> Result<(), Box<dyn Error>> {
    let low = x.iter().map(|v| v.y).fold(f64::INFINITY, f64::min);
    let middle = x.iter().sum::<Vec3>() / x.len() as f64;
    let place = |v: &Vec3| Vec3::new(v.x - middle.x, v.y - low, v.z - middle.z);
    let cloth = TriMesh { vertices: x.iter().map(place).collect(), triangles: mesh.triangles.clone() };
    let rims = rim_lines(&cloth);
    let scene = Scene {
        body: &TriMesh::default(),
        cloth: &cloth,
        piece_of_triangle: &[],
        seams: &[],
        rims: &rims,
        title: name,
        subtitle,
        strain: None,
    };
    let file = Path::new("out/experiments").join(format!("{name}.png"));
    write_all(&[(file, draw(&scene)?)], &[])?;
    Ok(())
}
