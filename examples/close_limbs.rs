//! A body whose limbs almost touch, as scanned bodies stand: the mannequin `woman_92` with her legs moved together
//! until they are a few millimetres apart from the crotch to the knee, and her arms turned down about the shoulders.
//! This wrote `tests/scenes/close_limbs.obj`:
//!
//! `cargo run --release --example close_limbs -- tests/scenes/close_limbs.obj 2 4 18`
//!
//! The numbers: millimetres between the legs, degrees of the arms from the vertical, and the length that edges of the
//! surface have at least, mm.

use std::error::Error;
use std::path::PathBuf;

use toile::geometry::{Topology, TriMesh, Vec3};
use toile::io::body::mannequin_obj;
use toile::io::files::write_all;
use toile::mannequin::{BodyPart, MannequinSpec, PartKind, build};

/// Metres per millimetre.
const MM: f64 = 1e-3;
/// Legs begin to move together so far above the crotch, and have done so that far below it, metres.
const ABOVE: f64 = 0.02;
const BELOW: f64 = 0.04;
/// What is so far down the arm's axis turns with the arm, metres; what is further in than the arm's half width and this
/// much more stays with the trunk. Between them the skin gives.
const TURNS: f64 = 0.09;
const STAYS: f64 = 0.03;
/// Rounds in which that spreads over the skin.
const ROUNDS: usize = 400;
/// No edge is taken away where a triangle beside it would turn further than this (cosine).
const TURN: f64 = 0.7;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [file, gap, degrees, edge] = args.as_slice() else {
        return Err("close_limbs FILE.obj GAP_MM ARM_DEGREES EDGE_MM".into());
    };
    let (gap, degrees, edge): (f64, f64, f64) = (gap.parse()?, degrees.parse()?, edge.parse()?);
    let spec = MannequinSpec::load("woman_92")?;
    let mut body = build(&spec)?;
    let leg = body.part(PartKind::LeftLeg).ok_or("no leg")?.clone();
    turn_arms(&mut body.mesh, &spec, degrees);
    for p in &mut body.mesh.vertices {
        p.x = p.x.signum() * beside(p.x.abs(), p.y, &leg, gap * MM);
    }
    body.mesh = coarser(body.mesh, edge * MM);
    body.name = format!("woman_92, legs {gap} mm apart, arms at {degrees} degrees, by examples/close_limbs.rs");
    write_all(&[(PathBuf::from(file), mannequin_obj(&body).into_bytes())], &[])?;
    println!("{file}: {} vertices", body.mesh.vertices.len());
    Ok(())
}

/// Where a point `x` metres beside the middle comes to be when the legs are `gap` apart.
fn beside(x: f64, y: f64, leg: &BodyPart, gap: f64) -> f64 {
    let crotch = leg.sections[0].center.y;
    let knee = leg.landmarks.iter().find(|l| l.0 == "knee").map_or(0.0, |l| l.1.y);
    let inner = inner(leg, y.max(knee));
    let shift = (inner - 0.5 * gap).max(0.0) * smoothstep(crotch + ABOVE, crotch - BELOW, y);
    if x < inner { x * (1.0 - shift / inner) } else { x - shift }
}

/// How far the inner side of a leg is from the middle at height `y`, metres.
fn inner(leg: &BodyPart, y: f64) -> f64 {
    let side = |s: &toile::mannequin::Section| s.center.x - s.half_width;
    let below = leg.sections.iter().position(|s| s.center.y < y).unwrap_or(leg.sections.len() - 1).max(1);
    let (a, b) = (&leg.sections[below - 1], &leg.sections[below]);
    let share = ((y - a.center.y) / (b.center.y - a.center.y)).clamp(0.0, 1.0);
    side(a) + (side(b) - side(a)) * share
}

/// Turns both arms about the starts of their axes until these are so many degrees from the vertical.
fn turn_arms(mesh: &mut TriMesh, spec: &MannequinSpec, degrees: f64) {
    let joint = Vec3::from(spec.arm.joint) * MM;
    let angle = spec.arm.abduction.to_radians();
    let (axis, across) = (Vec3::new(angle.sin(), -angle.cos(), 0.0), Vec3::new(angle.cos(), angle.sin(), 0.0));
    let girth = spec.arm.rows.first().map_or(0.0, |row| row.girth * MM);
    let half = girth / std::f64::consts::TAU;
    let local = |p: &Vec3| {
        let q = Vec3::new(p.x.abs(), p.y, p.z) - joint;
        (q.dot(&axis), q.dot(&across))
    };
    let fixed: Vec<Option<f64>> = mesh
        .vertices
        .iter()
        .map(|p| match local(p) {
            (t, u) if t > TURNS && u > -half - 0.5 * STAYS => Some(1.0),
            (t, u) if t < -half || u < -half - STAYS => Some(0.0),
            _ => None,
        })
        .collect();
    let beside = neighbours(mesh);
    let mut share: Vec<f64> = fixed.iter().map(|f| f.unwrap_or(0.5)).collect();
    for _ in 0..ROUNDS {
        let mean = |v: usize| beside[v].iter().map(|w| share[*w as usize]).sum::<f64>() / beside[v].len() as f64;
        share = (0..share.len()).map(|v| fixed[v].unwrap_or_else(|| mean(v))).collect();
    }
    let turn = (spec.arm.abduction - degrees).to_radians();
    for (p, share) in mesh.vertices.iter_mut().zip(share) {
        let (side, q) = (p.x.signum(), Vec3::new(p.x.abs(), p.y, p.z) - joint);
        let (sin, cos) = (turn * share).sin_cos();
        *p = joint + Vec3::new(q.x * cos + q.y * sin, q.y * cos - q.x * sin, q.z);
        p.x *= side;
    }
}

/// The surface with its shortest edges taken away until none is shorter than `edge` metres that can be.
fn coarser(mut mesh: TriMesh, edge: f64) -> TriMesh {
    loop {
        let (next, taken) = thinned(&mesh, edge);
        if taken == 0 {
            return mesh;
        }
        mesh = next;
    }
}

/// Takes away short edges that have nothing to do with each other, the shortest first; and how many.
fn thinned(mesh: &TriMesh, edge: f64) -> (TriMesh, usize) {
    let length = |ends: &[u32; 2]| (mesh.vertices[ends[0] as usize] - mesh.vertices[ends[1] as usize]).norm();
    let mut short: Vec<[u32; 2]> =
        Topology::new(&mesh.triangles).edges.iter().map(|e| e.ends).filter(|e| length(e) < edge).collect();
    short.sort_by(|a, b| length(a).total_cmp(&length(b)).then(a.cmp(b)));
    let beside = neighbours(mesh);
    let mut around = vec![Vec::new(); mesh.vertices.len()];
    for (t, corners) in mesh.triangles.iter().enumerate() {
        corners.iter().for_each(|v| around[*v as usize].push(t));
    }
    let mut touched = vec![false; mesh.vertices.len()];
    let mut vertices = mesh.vertices.clone();
    let mut into: Vec<u32> = (0..vertices.len() as u32).collect();
    let mut taken = 0;
    for [a, b] in short {
        let ring = || beside[a as usize].iter().chain(&beside[b as usize]).chain([&a, &b]);
        let shared = beside[a as usize].iter().filter(|v| beside[b as usize].contains(v)).count();
        let middle = 0.5 * (mesh.vertices[a as usize] + mesh.vertices[b as usize]);
        let mut faces = around[a as usize].iter().chain(&around[b as usize]);
        if shared != 2 || ring().any(|v| touched[*v as usize]) || !faces.all(|&t| stays(mesh, t, [a, b], middle)) {
            continue;
        }
        ring().for_each(|v| touched[*v as usize] = true);
        (vertices[a as usize], into[b as usize]) = (middle, a);
        taken += 1;
    }
    (gathered(&vertices, &mesh.triangles, &into), taken)
}

/// Whether a triangle is one of the edge's own, or hardly turns when the edge's ends come to be in its middle.
fn stays(mesh: &TriMesh, t: usize, ends: [u32; 2], middle: Vec3) -> bool {
    let corners = mesh.triangles[t];
    if ends.iter().all(|e| corners.contains(e)) {
        return true;
    }
    let [a, b, c] = corners.map(|v| if ends.contains(&v) { middle } else { mesh.vertices[v as usize] });
    let (before, after) = (mesh.double_normal(t), (b - a).cross(&(c - a)));
    before.dot(&after) > TURN * before.norm() * after.norm()
}

/// The triangles that are left when every vertex has become the one it goes `into`.
fn gathered(vertices: &[Vec3], triangles: &[[u32; 3]], into: &[u32]) -> TriMesh {
    let mut number = vec![u32::MAX; vertices.len()];
    let mut mesh = TriMesh::default();
    for t in triangles.iter().map(|t| t.map(|v| into[v as usize])) {
        if t[0] == t[1] || t[1] == t[2] || t[2] == t[0] {
            continue;
        }
        mesh.triangles.push(t.map(|v| {
            if number[v as usize] == u32::MAX {
                number[v as usize] = mesh.vertices.len() as u32;
                mesh.vertices.push(vertices[v as usize]);
            }
            number[v as usize]
        }));
    }
    mesh
}

fn neighbours(mesh: &TriMesh) -> Vec<Vec<u32>> {
    let mut out = vec![Vec::new(); mesh.vertices.len()];
    for [a, b] in Topology::new(&mesh.triangles).edges.iter().map(|e| e.ends) {
        out[a as usize].push(b);
        out[b as usize].push(a);
    }
    out
}

fn smoothstep(from: f64, to: f64, at: f64) -> f64 {
    let t = ((at - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
