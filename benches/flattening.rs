//! Flattening over sizes and modes: a front of 40 cm with a bust of 5 cm, as a jittered grid.

#[allow(dead_code, reason = "the other benches need a garment as well")]
mod common;

use std::hint::black_box;

use criterion::BenchmarkId;
use toile::flatten::{FlattenOptions, Mode, flatten};
use toile::geometry::{TriMesh, Vec3};

/// Vertices along each side: 2,500, 10,000, 40,000 and 100,000 in all.
const SIDES: [u32; 4] = [50, 100, 200, 316];

fn main() {
    let mut criterion = common::criterion();
    for mode in [Mode::Isometric, Mode::Balanced, Mode::Boundary, Mode::Spring] {
        let mut group = criterion.benchmark_group(format!("{mode:?}").to_lowercase());
        for side in SIDES {
            let front = front(side);
            let options = FlattenOptions { mode, ..FlattenOptions::default() };
            let name = BenchmarkId::from_parameter(front.vertices.len());
            group.bench_function(name, |b| b.iter(|| flatten(black_box(&front), &options).is_ok()));
        }
        group.finish();
    }
    criterion.final_summary();
}

/// Half a front: a cylinder of 15 cm radius with a bump, `side` vertices along each side.
fn front(side: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    for (row, column) in (0..side).flat_map(|row| (0..side).map(move |column| (row, column))) {
        let [u, v] = [column, row].map(|k| f64::from(k) / f64::from(side - 1));
        // Off the grid by up to a fifth of a cell inside: no mesh from a scanner or a sculptor is regular.
        let inside = row > 0 && column > 0 && row + 1 < side && column + 1 < side;
        let off = if inside { 0.2 / f64::from(side) } else { 0.0 };
        let noise = |k: u32| (f64::from((row * 7919 + column * 104_729 + k) % 1009) / 504.5 - 1.0) * off;
        let (x, y) = (0.25 * (u + noise(0)), 0.4 * (v + noise(500)));
        let bust = 0.05 * (-((x - 0.1).powi(2) + (y - 0.22).powi(2)) / 0.005).exp();
        let (sine, cosine) = (x / 0.15).sin_cos();
        mesh.vertices.push(Vec3::new(sine, 0.0, cosine) * (0.15 + bust) + Vec3::y() * y);
    }
    for (row, column) in (0..side - 1).flat_map(|row| (0..side - 1).map(move |column| (row, column))) {
        let a = row * side + column;
        mesh.triangles.extend([[a, a + 1, a + side + 1], [a, a + side + 1, a + side]]);
    }
    mesh
}
