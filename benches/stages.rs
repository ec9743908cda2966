//! What each stage costs: the child's dress at a coarse spacing, from pieces to flat pieces again.
//!
//! Every stage begins with what the one before it made, so that the figures add up to a run of `toile make`.

mod common;

use std::error::Error;
use std::hint::black_box;

use criterion::BenchmarkId;
use toile::drape::{DrapeOptions, drape};
use toile::flatten::{FlattenOptions, flatten_garment};
use toile::geometry::Vec3;
use toile::mesh::build;
use toile::pipeline::Job;
use toile::sew::start::start;
use toile::sew::{SewOptions, Sewn, sew};

const GARMENT: &str = "patterns/child_dress.yaml";
/// Metres.
const SPACING: f64 = 0.025;

fn main() -> Result<(), Box<dyn Error>> {
    let mut criterion = common::criterion();
    let job = common::job(GARMENT, SPACING)?;
    let at = start(&job.garment, &job.mesh, &job.body, &job.collider)?;
    let sewn = sewn(&job, &at)?;
    let draped = draped(&job, &sewn)?;
    let mut group = criterion.benchmark_group("stages");
    let named = |stage: &str| BenchmarkId::new(stage, format!("{} at {} mm", job.garment.name, 1e3 * SPACING));
    group.bench_function(named("mesh"), |b| b.iter(|| build(black_box(&job.garment), SPACING)));
    group.bench_function(named("start"), |b| {
        b.iter(|| start(&job.garment, black_box(&job.mesh), &job.body, &job.collider));
    });
    group.bench_function(named("sew"), |b| b.iter(|| self::sewn(&job, black_box(&at)).is_ok()));
    group.bench_function(named("drape"), |b| b.iter(|| self::draped(&job, black_box(&sewn)).is_ok()));
    group.bench_function(named("flatten"), |b| {
        b.iter(|| {
            flatten_garment(&job.mesh, &job.garment.seams, black_box(&draped), &FlattenOptions::default()).is_ok()
        });
    });
    group.finish();
    criterion.final_summary();
    Ok(())
}

fn sewn(job: &Job, at: &[Vec3]) -> Result<Sewn, Box<dyn Error>> {
    let joined = SewOptions { joined: true, ..SewOptions::default() };
    Ok(sew(&job.cut(), &job.collider, at.to_vec(), &joined, &mut |_| {})?)
}

/// Positions of all particles.
fn draped(job: &Job, sewn: &Sewn) -> Result<Vec<Vec3>, Box<dyn Error>> {
    let (stitching, nodes) = (&sewn.stitching, sewn.nodes.clone());
    let draped = drape(&job.cut(), &job.collider, stitching, nodes, &DrapeOptions::default(), &mut |_| {})?;
    Ok(stitching.spread(&draped.nodes))
}
