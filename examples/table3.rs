//! Table 3 of Liu, Wang & Luo 2015: meshes, times and iterations of the experiments, the published beside ours.
//!
//! `cargo run --release --example table3`. Their edges are counted twice, and three of their meshes cannot be: ours
//! are the nearest grids. Iterations are counted until one lowers the energy by less than a ten-thousandth of it. The
//! published energy knows no body, so Fig. 10 is draped as `toile make` does it, in denim: a step of it, contact and
//! all. Times are milliseconds per iteration here; theirs are not said to be of one or of all.

mod common;

use std::error::Error;
use std::path::Path;

use common::fig5::diagonal;
use common::fig7::{ball, pull, wrinkles};
use common::fig9::skirt;
use common::{Experiment, Solved, settled, weights};
use toile::drape::geometric::{Alternating, SolveOptions, SolverReport};
use toile::geometry::Topology;
use toile::pipeline::{Job, Overrides, Run, read};
use toile::report::aligned;
use toile::sew::Stitching;

/// Vertices, faces, edges, linearise ms, solve ms, iterations.
const PUBLISHED: [(&str, [f64; 6]); 5] = [
    ("Fig. 4", [961.0, 1800.0, 5520.0, 3.2, 16.0, 5.0]),
    ("Fig. 5", [2000.0, 3840.0, 11680.0, 41.5, 19.1, 5.0]),
    ("Fig. 7", [2601.0, 2500.0, 10200.0, 48.5, 245.0, 15.0]),
    ("Fig. 9", [1361.0, 2500.0, 7650.0, 12.5, 45.0, 10.0]),
    ("Fig. 10", [1714.0, 3296.0, 10024.0, 25.0, 13.0, 10.0]),
];

fn main() -> Result<(), Box<dyn Error>> {
    let head = ["", "fabric", "solver", "vertices", "faces", "edges", "linearise ms", "solve ms", "iterations"];
    let mut rows = vec![head.map(String::from).to_vec()];
    for (name, [v, f, e, linearise, solve, n]) in PUBLISHED {
        let numbers = [v, f, e, linearise, solve, n].map(|x| x.to_string());
        rows.push([vec![name.to_owned(), String::new(), "published".to_owned()], numbers.to_vec()].concat());
    }
    let experiments = [diagonal("Fig. 4", 31, 31), diagonal("Fig. 5", 50, 40), ball(), pull(), wrinkles(), skirt()];
    for (experiment, fabric) in experiments.iter().flat_map(|e| ["wool_suiting", "cotton_poplin"].map(|f| (e, f))) {
        rows.extend(measured(experiment, fabric)?);
    }
    rows.push(shirt("denim")?);
    print!("{}", aligned(&rows));
    Ok(())
}

/// Both solvers on one experiment.
fn measured(e: &Experiment, fabric: &str) -> Result<[Vec<String>; 2], Box<dyn Error>> {
    let weights = weights(fabric)?;
    let cloth = e.cloth(weights)?;
    let Solved { report: squares, .. } = e.solve(weights)?;
    let mut x = e.start.clone();
    let alternating = Alternating::new(&cloth, &e.held, e.recovery())?.solve(&mut x, SolveOptions::default())?;
    let row = |solver: &str, report: &SolverReport| {
        let each = |seconds: f64| format!("{:.2}", 1e3 * seconds / report.iterations.max(1) as f64);
        let mesh = [e.mesh.vertices.len(), e.mesh.triangles.len(), cloth.edges()].map(|n| n.to_string());
        let mut out = vec![e.name.to_owned(), fabric.to_owned(), solver.to_owned()];
        out.extend(mesh);
        out.extend([each(report.linearise_seconds), each(report.solve_seconds), settled(report).to_string()]);
        out
    };
    Ok([row("least squares", &squares), row("one factor", &alternating)])
}

/// Grid spacing of the T-shirt, metres: that of the published number of vertices, nearly.
const SHIRT: f64 = 0.0198;

/// Fig. 10: a T-shirt on the body, draped by the Newton steps of garments.
fn shirt(fabric: &str) -> Result<Vec<String>, Box<dyn Error>> {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns/tshirt.yaml");
    let overrides = Overrides { spacing: Some(SHIRT), fabric: Some(fabric.to_owned()), ..Overrides::default() };
    let job = Job::new(&file, read(&file)?, &overrides)?;
    let mut run = Run::new(&job);
    run.drape(&mut |_, _| {})?;
    let report = run.report();
    let drape = report.stages.iter().find(|s| s.name == "drape").ok_or("nothing was draped")?;
    let stitching = Stitching::new(&job.mesh);
    let sewn: Vec<[u32; 3]> = job.mesh.triangles.iter().map(|t| t.map(|n| stitching.class[n as usize])).collect();
    let mesh = [stitching.classes, sewn.len(), Topology::new(&sewn).edges.len()].map(|n| n.to_string());
    let each = 1e3 * drape.seconds / drape.iterations.max(1) as f64;
    let mut row = vec!["Fig. 10".to_owned(), fabric.to_owned(), "garments'".to_owned()];
    row.extend(mesh);
    row.extend([String::new(), format!("{each:.2}"), drape.iterations.to_string()]);
    Ok(row)
}
