//! Fig. 10 of Liu, Wang & Luo 2015: one T-shirt on one body in denim, canvas, silk and nylon.
//!
//! `cargo run --release --example fig10 [FOLDER] [SPACING]` sews and drapes `patterns/tshirt.yaml` (spacing in mm, 11.6
//! unless given), draws `fig10_FABRIC.png` and prints how much each cloth is folded: ∫κ² over the body of the shirt and
//! over the sleeves (κ the sum of the principal curvatures, without the seams; a number without unit), and the hollows
//! round the hem and the sleeves' hems.

use std::error::Error;
use std::path::{Path, PathBuf};

use toile::geometry::{Topology, Vec3};
use toile::io::files::write_all;
use toile::pipeline::{Job, Overrides, PictureOptions, Run, read};

const FABRICS: [&str; 4] = ["denim", "canvas", "silk_charmeuse", "nylon_taffeta"];
/// A hollow turns inwards by more than this in all, radians (10°).
const HOLLOW: f64 = 0.175;

/// ∫κ² over some pieces: per inner edge the angle between its triangles, squared, over the width it stands for.
fn folded(job: &Job, x: &[Vec3], wanted: impl Fn(&str) -> bool) -> f64 {
    let mut sum = 0.0;
    for piece in job.mesh.pieces.iter().filter(|p| wanted(&p.name)) {
        let triangles = &job.mesh.triangles[piece.triangles.clone()];
        let normal = |t: u32| {
            let [a, b, c] = triangles[t as usize].map(|n| x[n as usize]);
            (b - a).cross(&(c - a))
        };
        for edge in Topology::new(triangles).edges {
            let [Some(s), Some(t)] = edge.triangles else { continue };
            let (m, n) = (normal(s), normal(t));
            let length = (x[edge.ends[1] as usize] - x[edge.ends[0] as usize]).norm();
            let width = (m.norm() + n.norm()) / (3.0 * length);
            sum += m.angle(&n).powi(2) * length / width;
        }
    }
    // Three hinges share what one curvature costs in a grid of triangles.
    sum / 3.0
}

/// How often a hem, seen along its axis, turns into a hollow.
fn hollows(ring: &[Vec3]) -> usize {
    let middle = ring.iter().sum::<Vec3>() / ring.len() as f64;
    let corner = |k: usize| ring[k % ring.len()];
    let axis: Vec3 = (0..ring.len()).map(|k| (corner(k) - middle).cross(&(corner(k + 1) - middle))).sum();
    let axis = axis.normalize();
    let turn = |k: usize| {
        let flat = |v: Vec3| v - axis * axis.dot(&v);
        let (a, b) = (flat(corner(k + 1) - corner(k)), flat(corner(k + 2) - corner(k + 1)));
        axis.dot(&a.cross(&b)).atan2(a.dot(&b))
    };
    let turns: Vec<f64> = (0..ring.len()).map(turn).collect();
    // From somewhere that turns outwards, so that no hollow is cut in two.
    let start = turns.iter().position(|t| *t > 0.0).unwrap_or(0);
    let (mut count, mut inwards) = (0, 0.0);
    for t in turns[start..].iter().chain(&turns[..=start]) {
        if *t < 0.0 {
            inwards -= t;
        } else {
            count += usize::from(inwards > HOLLOW);
            inwards = 0.0;
        }
    }
    count
}

/// The hem of some pieces as one ring of points, from edge to edge.
fn hem(job: &Job, x: &[Vec3], wanted: impl Fn(&str) -> bool) -> Vec<Vec3> {
    let pieces = job.mesh.pieces.iter().filter(|p| wanted(&p.name));
    let edges = pieces.flat_map(|p| p.edges.iter().filter(|e| e.name.starts_with("hem")));
    let mut chains: Vec<Vec<Vec3>> = edges
        .map(|e| e.particles.iter().map(|&n| x[n as usize]).collect())
        .filter(|c: &Vec<Vec3>| c.len() > 1)
        .collect();
    let mut ring = chains.swap_remove(0);
    while !chains.is_empty() {
        let end = ring[ring.len() - 1];
        let gap = |c: &[Vec3]| (c[0] - end).norm().min((c[c.len() - 1] - end).norm());
        let nearest = (0..chains.len()).min_by(|&a, &b| gap(&chains[a]).total_cmp(&gap(&chains[b]))).unwrap_or(0);
        let mut next = chains.swap_remove(nearest);
        if (next[0] - end).norm() > (next[next.len() - 1] - end).norm() {
            next.reverse();
        }
        ring.extend(&next[1..]);
    }
    if (ring[0] - ring[ring.len() - 1]).norm() < 1e-6 {
        ring.pop();
    }
    ring
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "out/experiments".into()));
    let spacing = std::env::args().nth(2).map_or(Ok(11.6), |s| s.parse::<f64>())?;
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("patterns/tshirt.yaml");
    println!("fabric           c, mm   ∫κ² body  ∫κ² sleeves  hollows at the hem  at the sleeves  rests");
    for name in FABRICS {
        let overrides =
            Overrides { spacing: Some(1e-3 * spacing), fabric: Some(name.to_owned()), ..Overrides::default() };
        let job = Job::new(&file, read(&file)?, &overrides)?;
        let mut run = Run::new(&job);
        run.drape(&mut |_, _| {})?;
        let report = run.report();
        let x = run.last().ok_or("nothing was draped")?;
        let sleeve = |side: &str| hollows(&hem(&job, x, |piece| piece == format!("sleeve.{side}")));
        println!(
            "{name:15} {:6.1} {:10.1} {:12.1} {:19} {:>15} {:>6}",
            1e3 * job.fabrics[0].bending_length_mean(),
            folded(&job, x, |p| p == "front" || p == "back"),
            folded(&job, x, |p| p.starts_with("sleeve")),
            hollows(&hem(&job, x, |p| p == "front" || p == "back")),
            format!("{} + {}", sleeve("L"), sleeve("R")),
            if report.stages.iter().all(|s| s.converged) { "yes" } else { "no" },
        );
        let files = run.state(&PictureOptions::default())?.into_iter().filter(|f| f.0.ends_with("png"));
        let named: Vec<_> = files.map(|(_, bytes)| (folder.join(format!("fig10_{name}.png")), bytes)).collect();
        write_all(&named, &[&file])?;
    }
    Ok(())
}
