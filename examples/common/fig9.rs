//! Fig. 9: a skirt whose waist is fixed and whose hem is drawn out and in, in wool and in ramie.

use std::error::Error;
use std::f64::consts::TAU;

use toile::drape::geometric::Control;
use toile::geometry::{TriMesh, Vec3};

use super::figure::{Bar, Figure, Picture, row};
use super::measure::{apart, folds, strain};
use super::{Diagonals, Experiment, MEMBRANE, Solved, cells, fifteen, grid_lines};

/// Vertices round the skirt, and rows of them from waist to hem: of the tubes near to the paper's 1,361 vertices and
/// 2,500 triangles, one that has a vertex at every control.
const ROUND: u32 = 48;
const ROWS: u32 = 28;
/// Radii of waist and hem, and the height of the skirt, metres.
const WAIST: f64 = 0.12;
const HEM: f64 = 0.22;
const HEIGHT: f64 = 0.55;
/// Controls of the hem. Every second one is drawn out by [`DRAWN`], the others in, and all up by [`RAISED`], metres.
const CONTROLS: u32 = 12;
const DRAWN: f64 = 0.025;
const RAISED: f64 = 0.010;

/// The fabrics that are drawn.
const DRAPED: [&str; 2] = ["wool_suiting", "ramie"];

/// The skirt, curved at rest as it is cut: a cone.
pub(crate) fn skirt() -> Experiment {
    let at = |k: u32| {
        let down = f64::from(k / ROUND) / f64::from(ROWS - 1);
        round(f64::from(k % ROUND) / f64::from(ROUND), WAIST + (HEM - WAIST) * down, -HEIGHT * down)
    };
    let vertices = (0..ROUND * ROWS).map(at).collect();
    let mesh = TriMesh { vertices, triangles: cells(ROUND, ROWS, ROUND, Diagonals::OneWay) };
    let radius = radius_that_keeps_the_hem();
    let control = |k: u32| {
        let radius = radius + if k.is_multiple_of(2) { DRAWN } else { -DRAWN };
        let target = round(f64::from(k) / f64::from(CONTROLS), radius, RAISED - HEIGHT);
        Control::vertex(ROUND * (ROWS - 1) + k * ROUND / CONTROLS, target)
    };
    let controls = (0..CONTROLS).map(control).collect();
    Experiment {
        name: "Fig. 9",
        curved: true,
        held: (0..ROUND).collect(),
        controls,
        start: mesh.vertices.clone(),
        mesh,
    }
}

/// A point at this part of a turn round the axis.
fn round(turn: f64, radius: f64, z: f64) -> Vec3 {
    let (sin, cos) = (-TAU * turn).sin_cos();
    Vec3::new(radius * cos, radius * sin, z)
}

/// The mean radius at which a hem drawn out and in is as long as the hem of the cone.
fn radius_that_keeps_the_hem() -> f64 {
    const STEPS: u32 = 3600;
    let length = |radius: f64| {
        let at = |k: u32| {
            let turn = f64::from(k) / f64::from(STEPS);
            round(turn, radius + DRAWN * (0.5 * f64::from(CONTROLS) * TAU * turn).cos(), 0.0)
        };
        (0..STEPS).map(|k| (at(k + 1) - at(k)).norm()).sum::<f64>()
    };
    let [mut low, mut high] = [0.5 * HEM, HEM];
    while high - low > 1e-6 {
        let middle = 0.5 * (low + high);
        if length(middle) < TAU * HEM { low = middle } else { high = middle }
    }
    low
}

/// Every third row, closed, and every third column.
fn lines() -> Vec<Vec<u32>> {
    let mut lines = grid_lines(ROUND, ROWS, 3);
    lines.iter_mut().filter(|line| line.len() == ROUND as usize).for_each(|line| line.push(line[0]));
    lines
}

/// Fig. 9 in wool and in ramie.
pub(crate) fn figure() -> Result<Figure, Box<dyn Error>> {
    let skirt = skirt();
    let hem = (ROUND * (ROWS - 1)) as usize..;
    let mut out = Figure::with_head(&["fabric", "iterations", "longest edge %", "folds", "miss mm"]);
    let mut solved: Vec<(String, Solved)> = Vec::new();
    for (name, weights) in fifteen()?.into_iter().filter(|(name, _)| name != MEMBRANE) {
        let shape = skirt.solve(weights)?;
        let iterations = shape.settled as f64;
        out.bars.push(Bar::at_most(7.0, format!("{name}: iterations"), iterations));
        if !DRAPED.contains(&name.as_str()) {
            continue;
        }
        let longest = 100.0 * strain(&skirt.mesh, &shape.x).longest;
        let folds = folds(&shape.x[hem.clone()].iter().map(|v| v.xy().norm()).collect::<Vec<_>>());
        out.table
            .push(row(&name, &[(iterations, 0), (longest, 1), (folds as f64, 0), (1e3 * skirt.miss(&shape.x), 2)]));
        out.bars.extend([
            Bar::at_most(3.0, format!("{name}: longest edge, %"), longest),
            Bar::at_most(0.0, format!("{name}: folds more or fewer than six"), folds.abs_diff(6) as f64),
        ]);
        solved.push((name, shape));
    }
    let [mean, most] = apart(&solved[0].1, &solved[1].1).map(|d| 1e3 * d);
    out.notes.push(format!("wool and ramie are {mean:.1} mm apart in the mean"));
    out.bars.extend([
        Bar::at_least(3.0, "wool from ramie, largest distance, mm", most),
        Bar::at_most(5.0, "wool from ramie, largest distance, mm", most),
    ]);
    out.pictures.push(Picture {
        file: "fig9",
        title: "Fig. 9",
        subtitle: "1,344 vertices, waist fixed, twelve places of the hem drawn out and in by 25 mm",
        shapes: solved.iter().map(|(name, s)| (name.clone(), skirt.shape(s))).collect(),
        lines: lines(),
        ..Picture::default()
    });
    Ok(out)
}
