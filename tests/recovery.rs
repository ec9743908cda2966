//! Pieces that a file positions where cloth cannot be, in the body, are sewn all the same.

use std::path::Path;

use toile::geometry::{TriMesh, Vec3};
use toile::io::garment::read_text;
use toile::pipeline::{Job, Overrides};
use toile::sew::place::positioned;
use toile::sew::{SewOptions, sew};
use toile::verify::{crossings, crossings_between};

/// How deep pieces start in the body, metres.
const WRONG: f64 = 0.03;

/// A tube of two flat panels, which the file puts before and behind the hips.
const PANELS: &str = "garment: 1
body: woman_92
fabrics: {shell: cotton_poplin}
pieces:
  front:
    place: {at: [-300, 930, 300]}
    grain: [[10, 10], [10, 240]]
    outline: {start: 0 0, top: L 600 0, right: L 600 250, hem: L 0 250, left: L 0 0}
  back: {like: front, place: {at: [300, 930, -300], turn: [0, 180, 0]}}
seams:
  left: {sew: front.right, to: back.left}
  right: {sew: front.left, to: back.right}
free: ['*.top', '*.hem']
";

fn panels() -> Job {
    let overrides = Overrides { spacing: Some(0.02), ..Overrides::default() };
    let garment = read_text("panels", "panels.yaml", PANELS).map_err(|e| e.to_string()).expect("a garment");
    Job::new(Path::new("panels.yaml"), garment, &overrides).map_err(|e| e.to_string()).expect("a job")
}

/// How deep the deepest of some particles lies in the body, metres.
fn deepest(job: &Job, x: &[Vec3]) -> f64 {
    x.iter().filter_map(|&p| job.collider.nearest(p, 0.1)).map(|n| -n.distance).fold(0.0, f64::max)
}

/// Every piece moved as it is, the level way the body is to most of it, until it lies [`WRONG`] deep.
fn pushed_in(job: &Job) -> Vec<Vec3> {
    let mut out = positioned(&job.garment, &job.mesh).expect("positions");
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
fn pieces_that_start_in_the_body_come_out_of_it() {
    let job = panels();
    comes_out("panels", &job, pushed_in(&job));
}
