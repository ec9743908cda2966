//! Pieces that start where cloth cannot be, in the body or across one another, are sewn all the same.

use std::path::Path;

use toile::geometry::{TriMesh, Vec3};
use toile::pipeline::{Job, Overrides, read};
use toile::sew::place::place;
use toile::sew::{SewOptions, sew};
use toile::verify::{crossings, crossings_between};

/// How deep pieces start in the body, or how far from where they belong, metres.
const WRONG: f64 = 0.03;

fn shipped(name: &str) -> Job {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns").join(name);
    let overrides = Overrides { spacing: Some(0.02), ..Overrides::default() };
    Job::new(&file, read(&file).expect(name), &overrides).expect(name)
}

fn placed(job: &Job) -> Vec<Vec3> {
    place(&job.garment, &job.mesh, &job.body, &job.collider).expect("placed")
}

/// How deep the deepest of some particles lies in the body, metres.
fn deepest(job: &Job, x: &[Vec3]) -> f64 {
    x.iter().filter_map(|&p| job.collider.nearest(p, 0.1)).map(|n| -n.distance).fold(0.0, f64::max)
}

/// Every piece moved as it is, the level way the body is to most of it, until it lies [`WRONG`] deep.
fn pushed_in(job: &Job) -> Vec<Vec3> {
    let mut out = placed(job);
    for piece in &job.mesh.pieces {
        let x = &mut out[piece.particles.clone()];
        let inward: Vec3 = x.iter().filter_map(|&p| job.collider.nearest(p, 1.0)).map(|n| -n.normal).sum();
        let inward = Vec3::new(inward.x, 0.0, inward.z).normalize();
        let mut steps = 0;
        while deepest(job, x) < WRONG {
            steps += 1;
            assert!(steps < 200, "{} does not come to the body", piece.name);
            x.iter_mut().for_each(|p| *p += inward * 1e-3);
        }
    }
    out
}

/// Sews a garment from `start`; nothing is open, in the body, or across anything.
fn comes_out(name: &str, job: &Job, start: Vec<Vec3>) {
    let cut = job.cut();
    let sewn = sew(&cut, &job.collider, start, &SewOptions::default(), &mut |_| {}).expect(name);
    sewn.closed(&job.mesh, 1e-3).expect(name);
    let node = |p: u32| sewn.stitching.class[p as usize];
    let triangles = job.mesh.triangles.iter().map(|t| t.map(node)).collect();
    let cloth = TriMesh { vertices: sewn.nodes.clone(), triangles };
    assert_eq!(deepest(job, &sewn.nodes), 0.0, "{name}");
    assert!(crossings_between(&cloth, &job.body.mesh).pairs.is_empty(), "{name} crosses the body");
    assert!(crossings(&cloth).is_empty(), "{name} crosses itself");
}

#[test]
fn garments_that_start_in_the_body_come_out_of_it() {
    for name in ["child_dress.yaml", "tshirt.yaml", "gore_skirt.yaml", "trousers.yaml", "sheath_dress.yaml"] {
        let job = shipped(name);
        comes_out(name, &job, pushed_in(&job));
    }
}

#[test]
fn pieces_that_start_across_one_another_are_sewn() {
    let job = shipped("child_dress.yaml");
    for round in 0..2 {
        let mut start = placed(&job);
        for (k, piece) in job.mesh.pieces.iter().enumerate() {
            // Something between -1 and 1.
            let number = |j: usize| (43_758.5 * (12.9898 * (round + 7 * k) as f64 + 78.233 * j as f64).sin()).fract();
            let way = Vec3::new(number(1), number(2), number(3)).normalize() * WRONG;
            start[piece.particles.clone()].iter_mut().for_each(|p| *p += way);
        }
        comes_out("child_dress.yaml", &job, start);
    }
}
