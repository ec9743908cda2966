//! The specimen, the solver and the fabrics that the experiments of Liu, Wang & Luo 2015 share.
//!
//! ```text
//! fig4 … fig9 ──▶ Figure: table, bars, pictures      one module per figure, used by its example and by the tests
//!   └ Experiment ──▶ solve ──▶ Solved ──▶ measure
//! ```
#![allow(dead_code, reason = "every example uses some of it")]

pub(crate) mod fig4;
pub(crate) mod fig5;
pub(crate) mod fig6;
pub(crate) mod fig7;
pub(crate) mod fig9;
pub(crate) mod figure;
pub(crate) mod measure;

use std::error::Error;

use toile::drape::geometric::{
    Control, GeometricCloth, LeastSquares, Recovery, SolveOptions, SolverReport, Weighting, Weights,
};
use toile::fabric::{self, FabricSheet};
use toile::geometry::{TriMesh, Vec3};

/// The specimen, metres (L2).
pub(crate) const WIDTH: f64 = 0.46;
pub(crate) const HEIGHT: f64 = 0.40;
/// How far the places of Figs. 4 to 6 are lifted, metres. The paper gives no height.
pub(crate) const LIFT: f64 = 0.06;
/// An experiment has settled when an iteration lowers its energy by less than this share of it.
const SETTLED: f64 = 1e-4;
/// Iterations after which a run ends. Only fine cotton needs more than 20 to settle.
const MOST: usize = 80;
/// The fabric whose bending weight is zero but for rounding: a bare membrane, and apart in every experiment.
pub(crate) const MEMBRANE: &str = "fine_cotton";

/// A cloth, and what is done to it. Upwards is z.
pub(crate) struct Experiment {
    pub(crate) name: &'static str,
    /// The initial mesh M.
    pub(crate) mesh: TriMesh,
    /// Whether the cloth is curved at rest as M is, rather than flat.
    pub(crate) curved: bool,
    /// Vertices that are held where they are in `start`.
    pub(crate) held: Vec<u32>,
    pub(crate) controls: Vec<Control>,
    pub(crate) start: Vec<Vec3>,
}

/// The shape of least energy.
pub(crate) struct Solved {
    pub(crate) x: Vec<Vec3>,
    pub(crate) report: SolverReport,
    /// Iterations until the energy has settled.
    pub(crate) settled: usize,
}

/// Which way the diagonals of a grid's cells go.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Diagonals {
    /// All the same way.
    OneWay,
    /// As on a checkerboard. A sheet then bends alike along both diagonals; with all of them one way it resists three
    /// times as much along one as along the other.
    Alternating,
}

/// A sheet of `columns` × `rows` vertices in the plane z = 0.
pub(crate) fn sheet(width: f64, height: f64, columns: u32, rows: u32, diagonals: Diagonals) -> TriMesh {
    let share = |k: u32, n: u32| f64::from(k) / f64::from(n - 1);
    let vertices = (0..columns * rows)
        .map(|k| Vec3::new(width * share(k % columns, columns), height * share(k / columns, rows), 0.0))
        .collect();
    TriMesh { vertices, triangles: cells(columns, rows, columns - 1, diagonals) }
}

/// Triangles of a grid of vertices in rows of `columns`, with `across` cells in a row of cells: one less than
/// `columns`, or as many where the last vertex of a row is joined to the first.
fn cells(columns: u32, rows: u32, across: u32, diagonals: Diagonals) -> Vec<[u32; 3]> {
    let mut triangles = Vec::new();
    for (row, column) in (0..rows - 1).flat_map(|row| (0..across).map(move |column| (row, column))) {
        let [a, b] = [column, (column + 1) % columns].map(|c| row * columns + c);
        let [d, c] = [a, b].map(|v| v + columns);
        if diagonals == Diagonals::OneWay || (row + column) % 2 == 0 {
            triangles.extend([[a, b, c], [a, c, d]]);
        } else {
            triangles.extend([[a, b, d], [b, c, d]]);
        }
    }
    triangles
}

/// Every `step`-th row and column of a grid of vertices in rows of `columns`, as lines.
pub(crate) fn grid_lines(columns: u32, rows: u32, step: u32) -> Vec<Vec<u32>> {
    let across = (0..rows).step_by(step as usize).map(|row| (row * columns..(row + 1) * columns).collect());
    let along = (0..columns).step_by(step as usize).map(|column| (0..rows).map(|row| row * columns + column).collect());
    across.chain(along).collect()
}

/// The fifteen published fabrics, in their order.
pub(crate) fn sheets() -> Result<Vec<FabricSheet>, Box<dyn Error>> {
    let sheets: Result<Vec<FabricSheet>, _> = fabric::library().into_iter().map(fabric::sheet).collect();
    Ok(sheets?.into_iter().filter(|s| s.liu.as_ref().is_some_and(|l| l.sample.is_some())).collect())
}

/// The names of the fifteen published fabrics, with their weights.
pub(crate) fn fifteen() -> Result<Vec<(String, Weights)>, Box<dyn Error>> {
    let weighted = |s: FabricSheet| Some((s.name, Weights::from_percent(s.liu?.weights)));
    Ok(sheets()?.into_iter().filter_map(weighted).collect())
}

/// Published weights of a fabric.
pub(crate) fn weights(name: &str) -> Result<Weights, Box<dyn Error>> {
    let liu = fabric::sheet(name)?.liu.ok_or("a fabric without published weights")?;
    Ok(Weights::from_percent(liu.weights))
}

impl Experiment {
    pub(crate) fn cloth(&self, weights: Weights) -> Result<GeometricCloth, Box<dyn Error>> {
        let made = if self.curved { GeometricCloth::curved } else { GeometricCloth::new };
        Ok(made(&self.mesh, weights, Weighting::PerArea)?)
    }

    pub(crate) fn recovery(&self) -> Recovery {
        Recovery::Controls(self.controls.clone())
    }

    /// The published solver on this experiment.
    pub(crate) fn solve(&self, weights: Weights) -> Result<Solved, Box<dyn Error>> {
        let cloth = self.cloth(weights)?;
        let mut x = self.start.clone();
        let options = SolveOptions { max_iterations: MOST, ..SolveOptions::default() };
        let report = LeastSquares::new(&cloth, &self.held, self.recovery())?.solve(&mut x, options)?;
        let settled = settled(&report);
        Ok(Solved { x, report, settled })
    }

    /// The mesh in the shape that was found.
    pub(crate) fn shape(&self, solved: &Solved) -> TriMesh {
        TriMesh { vertices: solved.x.clone(), triangles: self.mesh.triangles.clone() }
    }

    /// Mean distance of the controls from their targets, metres.
    pub(crate) fn miss(&self, x: &[Vec3]) -> f64 {
        self.controls.iter().map(|c| c.miss(x)).sum::<f64>() / self.controls.len() as f64
    }
}

/// Iterations until the energy changes by less than [`SETTLED`] of itself. Where it tends to zero, as that of a
/// membrane that can fold without stretching, [`SETTLED`] of its value after the first iteration takes its place.
pub(crate) fn settled(report: &SolverReport) -> usize {
    let first = report.history.get(1).copied().unwrap_or_default();
    let quiet = |w: &[f64]| w[0] - w[1] < SETTLED * w[1].max(SETTLED * first);
    report.history.windows(2).position(quiet).map_or(report.iterations, |k| k + 1)
}
