//! What the inner loops cost: the sparse factor, the two detections, and one step of each kind, on a sewn skirt.

mod common;

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;

use criterion::{BatchSize, Criterion};
use toile::contact::{ClothDetector, Neighbourhood};
use toile::dynamics::{GRIP, StepError, World};
use toile::geometry::{Mat3, Vec3};
use toile::linear::{Cholesky, SymmetricMatrix, SymmetricPattern};
use toile::pipeline::Job;
use toile::sew::start::start;
use toile::sew::{SewOptions, Sewn, sew, sewn_world};

const GARMENT: &str = "tests/data/skirt.yaml";
/// Metres.
const SPACING: f64 = 0.015;
/// How near a contact is looked for, metres, as in draping: the body by vertices, by faces and edges, and the cloth.
const BODY_REACH: f64 = 0.02;
const FACE_REACH: f64 = 4e-3;
const CLOTH_REACH: f64 = 0.8 * SPACING;
/// Step, s, and how far it is trusted, metres, as near a garment's rest.
const STEP: f64 = 1.0;
const TRUST: f64 = 1.5e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut criterion = common::criterion();
    let job = common::job(GARMENT, SPACING)?;
    let at = start(&job.garment, &job.mesh, &job.body, &job.collider)?;
    let joined = SewOptions { joined: true, ..SewOptions::default() };
    let sewn = sew(&job.cut(), &job.collider, at, &joined, &mut |_| {})?;
    factor(&mut criterion, &hung(&job, &sewn)?)?;
    detection(&mut criterion, &job, &hung(&job, &sewn)?);
    steps(&mut criterion, &job, &sewn);
    criterion.final_summary();
    Ok(())
}

/// The sewn skirt under its own weight.
fn hung<'a>(job: &'a Job, sewn: &Sewn) -> Result<World<'a>, StepError> {
    let mut world = sewn_world(&job.cut(), &job.collider, &sewn.stitching, sewn.nodes.clone())?;
    world.gravity = 1.0;
    world.grip(GRIP);
    Ok(world)
}

/// The system of a step: a mass at every node and a spring of one newton per metre along every edge.
fn factor(criterion: &mut Criterion, world: &World) -> Result<(), Box<dyn Error>> {
    let (edges, n) = (&world.cloth.edges, world.x().len());
    let pattern = Arc::new(SymmetricPattern::blocks(n, edges.iter().map(|e| (e[0] as usize, e[1] as usize)))?);
    let mut matrix = SymmetricMatrix::<f64>::zeros(pattern.clone());
    let mut add = |a: u32, b: u32, value: f64| {
        if let Some(slot) = pattern.block_slot(a as usize, b as usize) {
            matrix.add_block(slot, &(Mat3::identity() * value));
        }
    };
    (0..n as u32).for_each(|i| add(i, i, 0.01));
    for &[a, b] in edges {
        add(a, a, 1.0);
        add(b, b, 1.0);
        add(a, b, -1.0);
    }
    let mut factor = Cholesky::<f64>::new(pattern.clone())?;
    factor.factor(&matrix)?;
    let mut group = criterion.benchmark_group("linear");
    group.bench_function("analyse", |b| b.iter(|| Cholesky::<f64>::new(black_box(&pattern).clone()).is_ok()));
    group.bench_function("factor", |b| b.iter(|| factor.factor(black_box(&matrix)).is_ok()));
    let load = vec![1.0; 3 * n];
    group.bench_function("solve", |b| {
        b.iter_batched_ref(|| load.clone(), |x| factor.solve(x), BatchSize::SmallInput);
    });
    group.finish();
    Ok(())
}

fn detection(criterion: &mut Criterion, job: &Job, world: &World) {
    let (x, cloth) = (world.x(), &world.cloth);
    let mut group = criterion.benchmark_group("contact");
    group.bench_function("body, vertices", |b| {
        b.iter(|| x.iter().filter(|p| job.collider.nearest(**p, BODY_REACH).is_some()).count());
    });
    group.bench_function("body, faces", |b| {
        b.iter(|| {
            let mut found = Vec::new();
            for &tri in &cloth.triangles {
                job.collider.vertices_near_triangle(x, tri, FACE_REACH, &mut found);
            }
            for &ends in &cloth.edges {
                job.collider.edges_near_edge(x, ends, FACE_REACH, &mut found);
            }
            found.len()
        });
    });
    let class = (0..x.len() as u32).collect();
    let hood = Neighbourhood { class, passing: Vec::new() };
    let mut detector = ClothDetector::new(&cloth.triangles, &cloth.flat, &cloth.piece, hood);
    group.bench_function("cloth", |b| b.iter(|| detector.detect(black_box(x), CLOTH_REACH)));
    group.finish();
}

fn steps(criterion: &mut Criterion, job: &Job, sewn: &Sewn) {
    let still = |world: &World| -> Vec<Vec3> { world.x().to_vec() };
    let mut group = criterion.benchmark_group("step");
    group.bench_function("prepare", |b| b.iter(|| hung(job, black_box(sewn)).is_ok()));
    group.bench_function("falling", |b| {
        b.iter_batched(
            || hung(job, sewn),
            |world| world.and_then(|mut w| w.fall(&still(&w))).is_ok(),
            BatchSize::PerIteration,
        );
    });
    group.bench_function("newton", |b| {
        b.iter_batched(
            || hung(job, sewn),
            |world| world.and_then(|mut w| w.newton(STEP, TRUST)).is_ok(),
            BatchSize::PerIteration,
        );
    });
    group.finish();
}
