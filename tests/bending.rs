//! The bending energy of garments: exact for quadratic surfaces in any piece, natural at rims, joined over seams.

use std::path::Path;

use toile::dynamics::{Cloth, SpringModel};
use toile::geometry::{Vec2, Vec3};
use toile::pipeline::{Job, Overrides, read};
use toile::sew::Stitching;

/// Warp and weft differ; the grain of the round piece is turned.
const CLOTH: &str = "{weight: 150 g/m2, bend: {warp: 40 uN.m, weft: 10 uN.m}}";
const WARP: f64 = 40e-6;
const WEFT: f64 = 10e-6;

fn job(pieces: &str, rest: &str, spacing: f64) -> Job {
    let folder = tempfile::tempdir().expect("a folder");
    let text =
        format!("garment: 1\nname: test\nbody: child_110\nfabrics: {{cloth: {CLOTH}}}\npieces:\n{pieces}\n{rest}\n");
    let file = folder.path().join("test.yaml");
    std::fs::write(&file, text).expect("written");
    let loaded = read(&file).expect("a garment");
    let overrides = Overrides { spacing: Some(1e-3 * spacing), ..Overrides::default() };
    Job::new(Path::new(&file), loaded, &overrides).expect("a job")
}

/// A piece with curves in and out and a grain of its own.
fn round_piece(spacing: f64) -> Job {
    let outline = "{start: 0 40, top: 'C 40 0, 90 0, 130 30', side: 'C 90 60, 90 110, 140 150', low: 'C 90 180, \
                   40 170, 0 150', back: L 0 40}";
    job(
        &format!("  round: {{grain: [[20, 40], [60, 140]], place: {{at: [0, 0, 0]}}, outline: {outline}}}"),
        "free: [round.*]",
        spacing,
    )
}

/// The cloth, not sewn; `model` says whether its rims are hemmed.
fn unsewn(job: &Job, model: SpringModel) -> Cloth {
    Cloth::new(&job.cut(), (0..job.mesh.flat.len() as u32).collect(), model)
}

fn area(job: &Job) -> f64 {
    let corner = |n: u32| job.mesh.flat[n as usize];
    let triangles = job.mesh.triangles.iter();
    triangles.map(|t| 0.5 * (corner(t[1]) - corner(t[0])).perp(&(corner(t[2]) - corner(t[0]))).abs()).sum()
}

/// Noise between −1 and 1.
fn noise(count: usize) -> Vec<f64> {
    let mut state = 7u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as f64 / f64::from(1u32 << 30) - 1.0
    };
    (0..count).map(|_| next()).collect()
}

#[test]
fn a_quadratic_surface_is_exact_in_any_piece() {
    for spacing in [20.0, 11.0] {
        let job = round_piece(spacing);
        let cloth = unsewn(&job, SpringModel::Raw);
        let warp = job.mesh.pieces[0].warp;
        let weft = Vec2::new(-warp.y, warp.x);
        for [uu, vv, uv] in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.7, -0.4, 0.9]] {
            let height = |p: &Vec2| {
                let (u, v) = (p.dot(&warp), p.dot(&weft));
                0.5 * uu * u * u + 0.5 * vv * v * v + uv * u * v + 0.3 * u - 0.2 * v
            };
            let x: Vec<Vec3> = job.mesh.flat.iter().map(|p| Vec3::new(p.x, p.y, height(p))).collect();
            let known = 0.5 * area(&job) * (WARP * uu * uu + WEFT * vv * vv + 2.0 * (WARP * WEFT).sqrt() * uv * uv);
            let found = cloth.elastic.bending.energy(&x);
            assert!((found / known - 1.0).abs() < 1e-3, "{spacing} mm, {uu} {vv} {uv}: {found} against {known}");
        }
    }
}

#[test]
fn a_flat_piece_in_any_position_costs_nothing() {
    for model in [SpringModel::Raw, SpringModel::Measured] {
        let job = round_piece(11.0);
        let cloth = unsewn(&job, model);
        let flat = |p: &Vec2| Vec3::new(0.6 * p.x, p.y, 0.8 * p.x + 0.3);
        // Drawn out too: bending does not ask how long threads are.
        let drawn = |p: &Vec2| Vec3::new(1.1 * p.x + 0.2 * p.y, 0.9 * p.y, 0.5 * p.x);
        let energy = |place: &dyn Fn(&Vec2) -> Vec3| {
            cloth.elastic.bending.energy(&job.mesh.flat.iter().map(place).collect::<Vec<_>>())
        };
        // Rolled to a radius of 0.1 m it holds a tenth of a millijoule.
        assert!(energy(&flat).abs() < 1e-15 && energy(&drawn).abs() < 1e-15);
    }
}

#[test]
fn no_ripple_is_free_and_the_edge_bound_is_above_all() {
    let job = round_piece(11.0);
    let cloth = unsewn(&job, SpringModel::Measured);
    let n = job.mesh.flat.len();
    // Every node alone, out of the plane by a millimetre.
    for i in 0..n {
        let mut x = vec![Vec3::zeros(); n];
        x[i].z = 1e-3;
        // As a cell of the softer way would cost at least.
        assert!(cloth.elastic.bending.energy(&x) > 0.1 * WEFT * (1e-3f64 / 0.011).powi(2), "node {i}");
    }
    let noise = noise(3 * n);
    let x: Vec<Vec3> = noise.chunks_exact(3).map(|d| Vec3::new(d[0], d[1], d[2])).collect();
    let bound: f64 = cloth
        .edges
        .iter()
        .map(|e| cloth.elastic.bending.edge_bound(*e) * (x[e[0] as usize] - x[e[1] as usize]).norm_squared())
        .sum();
    let energy = 2.0 * cloth.elastic.bending.energy(&x);
    assert!(energy <= bound && energy > 0.02 * bound, "{energy} against {bound}");
}

#[test]
fn a_seam_bends_as_the_cloth_beside_it() {
    let half = |name: &str| {
        format!(
            "  {name}: {{grain: [[0, 0], [0, 1]], place: {{at: [0, 0, 0]}}, \
             outline: {{start: 0 0, a: L 100 0, b: L 100 100, c: L 0 100, d: L 0 0}}}}"
        )
    };
    let job = job(
        &format!("{}\n{}", half("one"), half("two")),
        "seams: {middle: {sew: one.b, to: two.d}}\nfree: [one.a, one.c, one.d, two.a, two.b, two.c]",
        10.0,
    );
    let sewn = Cloth::new(&job.cut(), Stitching::new(&job.mesh).class, SpringModel::Raw);
    let radius = 0.05;
    let mut x = vec![Vec3::zeros(); sewn.mass.len()];
    let mut folded = x.clone();
    for (p, piece) in job.mesh.pieces.iter().enumerate() {
        for k in piece.particles.clone() {
            let flat = job.mesh.flat[k];
            let round = flat.x + 0.1 * p as f64;
            let turn = round / radius;
            x[sewn.node_of[k] as usize] = Vec3::new(radius * turn.sin(), flat.y, radius * (1.0 - turn.cos()));
            let (out, up) = if p == 0 { (flat.x, 0.0) } else { (0.1, flat.x) };
            folded[sewn.node_of[k] as usize] = Vec3::new(out, flat.y, up);
        }
    }
    // Both halves up to their rims, and a hinge as wide as a cell.
    let known = 0.5 * WEFT * (0.02 + 0.1 * 0.01) / (radius * radius);
    let rolled = sewn.elastic.bending.energy(&x);
    assert!((rolled / known - 1.0).abs() < 0.01, "{rolled} against {known}");
    // Folded at a right angle only the hinge bends: its sides lean away from the edge at right angles.
    let hinge = 0.5 * WEFT * 0.1 * 2.0 / 0.01;
    let found = sewn.elastic.bending.energy(&folded);
    assert!((found / hinge - 1.0).abs() < 0.01, "{found} against {hinge}");
}

/// A square decimetre with a fold across its middle, the warp across the fold.
fn creased(angle: f64) -> Job {
    let outline = "{start: 0 0, a: L 100 0, b: L 100 100, c: L 0 100, d: L 0 0}";
    job(
        &format!(
            "  panel: {{grain: [[0, 0], [0, 1]], place: {{at: [0, 0, 0]}}, outline: {outline}, \
             lines: {{crease: {{path: M 0 50 L 100 50, fold: {angle}}}}}}}"
        ),
        "free: [panel.*]",
        10.0,
    )
}

/// The square turned up at a right angle along its fold.
fn turned_up(p: &Vec2) -> Vec3 {
    if p.y < 0.05 { Vec3::new(p.x, p.y, 0.0) } else { Vec3::new(p.x, 0.05, p.y - 0.05) }
}

#[test]
fn a_crease_parts_the_cloth() {
    let job = creased(90.0);
    let cloth = unsewn(&job, SpringModel::Raw);
    let x: Vec<Vec3> = job.mesh.flat.iter().map(turned_up).collect();
    assert!(cloth.elastic.bending.energy(&x).abs() < 1e-15);
}

#[test]
fn cloth_bends_over_a_fold_of_angle_zero_as_everywhere() {
    let job = creased(0.0);
    let cloth = unsewn(&job, SpringModel::Raw);
    let energy =
        |place: &dyn Fn(&Vec2) -> Vec3| cloth.elastic_energy(&job.mesh.flat.iter().map(place).collect::<Vec<_>>());
    assert!(energy(&|p| p.push(0.0)).abs() < 1e-15);
    // Curved as any cloth that bends evenly.
    let radius = 0.05;
    let parabola = |p: &Vec2| p.push(0.5 * p.y * p.y / radius);
    let x: Vec<Vec3> = job.mesh.flat.iter().map(parabola).collect();
    let known = 0.5 * WARP * area(&job) / (radius * radius);
    let found = cloth.elastic.bending.energy(&x);
    assert!((found / known - 1.0).abs() < 1e-3, "{found} against {known}");
    // What a crease would give for nothing bends the row of particles on the line.
    let sharp = 0.5 * WARP * 0.1 * 2.0 / 0.01;
    let found = energy(&turned_up);
    assert!((found / sharp - 1.0).abs() < 0.02, "{found} against {sharp}");
}
