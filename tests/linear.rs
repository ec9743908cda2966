//! The sparse solver against a dense one, and its promises.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should stop")]

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use toile::geometry::{Mat3, Vec3};
use toile::linear::{Cholesky, PatternError, Scalar, SymmetricMatrix, SymmetricPattern};

/// A small deterministic generator: numbers in -1..1.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A regular grid with one diagonal per cell (seven-point stencil).
fn grid(side: usize) -> Vec<[u32; 2]> {
    let at = |x: usize, y: usize| (y * side + x) as u32;
    let mut edges = Vec::new();
    for y in 0..side {
        for x in 0..side {
            if x + 1 < side {
                edges.push([at(x, y), at(x + 1, y)]);
            }
            if y + 1 < side {
                edges.push([at(x, y), at(x, y + 1)]);
            }
            if x + 1 < side && y + 1 < side {
                edges.push([at(x, y), at(x + 1, y + 1)]);
            }
        }
    }
    edges
}

fn pairs(edges: &[[u32; 2]]) -> impl Iterator<Item = (usize, usize)> + '_ {
    edges.iter().map(|e| (e[0] as usize, e[1] as usize))
}

/// A positive definite block matrix: a random symmetric positive spring tensor on every edge, and a little mass.
fn springs<T: Scalar>(pattern: &Arc<SymmetricPattern>, edges: &[[u32; 2]]) -> SymmetricMatrix<T> {
    let mut noise = Noise(7);
    let mut matrix = SymmetricMatrix::zeros(pattern.clone());
    for e in edges {
        let d = Vec3::new(noise.next(), noise.next(), noise.next());
        let block = d * d.transpose() + Mat3::identity() * 0.1;
        let (a, b) = (e[0] as usize, e[1] as usize);
        matrix.add_block(pattern.block_slot(a, a).unwrap(), &block);
        matrix.add_block(pattern.block_slot(b, b).unwrap(), &block);
        matrix.add_block(pattern.block_slot(a, b).unwrap(), &-block);
    }
    for v in 0..pattern.nodes() {
        matrix.add_block(pattern.block_slot(v, v).unwrap(), &(Mat3::identity() * 0.01));
    }
    matrix
}

fn dense<T: Scalar>(matrix: &SymmetricMatrix<T>) -> DMatrix<f64> {
    let n = matrix.pattern().size();
    let mut out = DMatrix::zeros(n, n);
    for column in 0..n {
        let mut unit = vec![0.0; n];
        unit[column] = 1.0;
        let mut image = vec![0.0; n];
        matrix.multiply(&unit, &mut image);
        out.set_column(column, &DVector::from_vec(image));
    }
    out
}

fn right_hand_sides(n: usize) -> Vec<f64> {
    let mut noise = Noise(3);
    (0..n).map(|_| noise.next()).collect()
}

fn relative_residual<T: Scalar>(matrix: &SymmetricMatrix<T>, x: &[f64], b: &[f64]) -> f64 {
    let mut image = vec![0.0; x.len()];
    matrix.multiply(x, &mut image);
    let error: f64 = image.iter().zip(b).map(|(p, q)| (p - q).powi(2)).sum();
    (error / b.iter().map(|q| q * q).sum::<f64>()).sqrt()
}

#[test]
fn blocks_agree_with_a_dense_solver() {
    // Random graph, some pairs twice and in both directions.
    let mut noise = Noise(1);
    let n = 40;
    let mut edges: Vec<[u32; 2]> = (0..n - 1).map(|v| [v, v + 1]).collect();
    for _ in 0..60 {
        let pick = |x: f64| ((x + 1.0) / 2.0 * f64::from(n)) as u32 % n;
        let (a, b) = (pick(noise.next()), pick(noise.next()));
        if a != b {
            edges.push([a, b]);
        }
    }
    let pattern = Arc::new(SymmetricPattern::blocks(n as usize, pairs(&edges)).unwrap());
    let matrix = springs::<f64>(&pattern, &edges);
    let full = dense(&matrix);
    assert!((&full - full.transpose()).norm() < 1e-14);
    let b = right_hand_sides(2 * pattern.size());
    let mut factor = Cholesky::new(pattern.clone()).unwrap();
    factor.factor(&matrix).unwrap();
    let mut x = b.clone();
    factor.solve(&mut x);
    let reference = full.cholesky().unwrap();
    for (part, x) in b.chunks(pattern.size()).zip(x.chunks(pattern.size())) {
        let expected = reference.solve(&DVector::from_column_slice(part));
        let error = (&expected - DVector::from_column_slice(x)).norm() / expected.norm();
        assert!(error < 1e-10, "relative difference to the dense solver {error:e}");
    }
}

#[test]
fn scalars_agree_with_a_dense_solver() {
    let edges = grid(6);
    let pattern = Arc::new(SymmetricPattern::scalar(36, pairs(&edges)).unwrap());
    let mut matrix = SymmetricMatrix::<f64>::zeros(pattern.clone());
    for (a, b) in pairs(&edges) {
        matrix.add(pattern.slot(a, b).unwrap(), -1.0);
        matrix.add(pattern.slot(a, a).unwrap(), 1.0);
        matrix.add(pattern.slot(b, b).unwrap(), 1.1);
    }
    matrix.add(pattern.slot(0, 0).unwrap(), 1.0);
    let mut factor = Cholesky::new(pattern.clone()).unwrap();
    factor.factor(&matrix).unwrap();
    let b = right_hand_sides(36);
    let mut x = b.clone();
    factor.solve(&mut x);
    let expected = dense(&matrix).cholesky().unwrap().solve(&DVector::from_vec(b));
    assert!((expected - DVector::from_vec(x)).norm() < 1e-10);
    assert_eq!(pattern.slot(0, 20), None);
    assert_eq!(pattern.block_slot(0, 0), None);
}

#[test]
fn repeats_are_bit_identical_and_f32_is_close() {
    let edges = grid(30);
    let pattern = Arc::new(SymmetricPattern::blocks(900, pairs(&edges)).unwrap());
    let matrix = springs::<f64>(&pattern, &edges);
    let b = right_hand_sides(2700);
    let mut first = Cholesky::new(pattern.clone()).unwrap();
    let mut solutions = Vec::new();
    for _ in 0..2 {
        first.factor(&matrix).unwrap();
        let mut x = b.clone();
        first.solve(&mut x);
        solutions.push(x);
    }
    assert_eq!(solutions[0], solutions[1]);
    assert!(relative_residual(&matrix, &solutions[0], &b) < 1e-10);

    let single = springs::<f32>(&pattern, &edges);
    let mut factor = Cholesky::<f32>::new(pattern).unwrap();
    factor.factor(&single).unwrap();
    let mut x = b.clone();
    factor.solve_f64(&mut x);
    assert!(relative_residual(&single, &x, &b) < 1e-3);
}

#[test]
fn a_matrix_that_is_not_positive_definite_is_refused() {
    for (side, bad) in [(3, f64::NAN), (3, -50.0), (40, f64::NAN), (40, -50.0)] {
        let edges = grid(side);
        let n = side * side;
        let pattern = Arc::new(SymmetricPattern::blocks(n, pairs(&edges)).unwrap());
        let mut matrix = springs::<f64>(&pattern, &edges);
        let culprit = n / 2;
        matrix.add_block(pattern.block_slot(culprit, culprit).unwrap(), &(Mat3::identity() * bad));
        let mut factor = Cholesky::new(pattern.clone()).unwrap();
        let error = factor.factor(&matrix).unwrap_err();
        println!("side {side} bad {bad}: row {} culprit {}", error.dof, 3 * culprit);
        assert!(error.dof < 3 * n);
        factor.factor(&springs(&pattern, &edges)).unwrap();
    }
}

#[test]
fn wrong_indices_are_errors() {
    assert_eq!(SymmetricPattern::scalar(3, [(0, 3)]), Err(PatternError::OutOfRange { row: 0, column: 3, size: 3 }));
    let empty = Arc::new(SymmetricPattern::scalar(0, []).unwrap());
    let mut factor = Cholesky::<f64>::new(empty.clone()).unwrap();
    factor.factor(&SymmetricMatrix::zeros(empty)).unwrap();
    factor.solve(&mut []);
}

#[test]
fn layers_that_touch_fill_the_factor_little() {
    // Two sheets on each other, coupled at every third node. Row after row, L of one has a band as wide as the sheet,
    // 590,000 entries, and L of both, sheet after sheet, 24 million.
    let (side, coupled) = (40, 3);
    let n = side * side;
    let sheet = grid(side);
    let mut edges = sheet.clone();
    edges.extend(sheet.iter().map(|[a, b]| [a + n as u32, b + n as u32]));
    let one = |edges: &[[u32; 2]], nodes| {
        let pattern = Arc::new(SymmetricPattern::blocks(nodes, pairs(edges)).unwrap());
        Cholesky::<f64>::new(pattern).unwrap().factor_entries()
    };
    let alone = one(&sheet, n);
    assert!(alone < 400_000, "{alone} entries");
    edges.extend((0..n as u32).step_by(coupled).map(|v| [v, v + n as u32]));
    let both = one(&edges, 2 * n);
    assert!(both < 5 * alone, "{both} entries of both layers, {alone} of one");
}

#[test]
fn a_stronger_diagonal_leaves_the_rest_as_it_is() {
    let edges = grid(4);
    let pattern = Arc::new(SymmetricPattern::blocks(16, pairs(&edges)).unwrap());
    let before = springs::<f64>(&pattern, &edges);
    let mut after = before.clone();
    after.strengthen_diagonal(0.25);
    for row in 0..48 {
        let mut unit = vec![0.0; 48];
        unit[row] = 1.0;
        let [mut old, mut new] = [vec![0.0; 48], vec![0.0; 48]];
        before.multiply(&unit, &mut old);
        after.multiply(&unit, &mut new);
        old[row] *= 1.25;
        assert_eq!(old, new);
    }
}

#[test]
fn large_factors_give_the_same_bits_for_any_number_of_threads() {
    // Two sheets that nothing joins, each with many subtrees.
    let one = grid(70);
    let other = one.iter().map(|e| e.map(|v| v + 4900));
    let edges: Vec<[u32; 2]> = one.iter().copied().chain(other).collect();
    let pattern = Arc::new(SymmetricPattern::blocks(9800, pairs(&edges)).unwrap());
    let matrix = springs::<f64>(&pattern, &edges);
    let b = right_hand_sides(2 * pattern.size());
    let solved = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut factor = Cholesky::new(pattern.clone()).unwrap();
            factor.factor(&matrix).unwrap();
            let mut x = b.clone();
            factor.solve(&mut x);
            x
        })
    };
    let first = solved(1);
    for (x, b) in first.chunks(pattern.size()).zip(b.chunks(pattern.size())) {
        let residual = relative_residual(&matrix, x, b);
        assert!(residual < 1e-10, "{residual:e}");
    }
    for threads in [2, 3, 4, 8] {
        assert!(solved(threads) == first, "{threads} threads give other bits");
    }
}

#[test]
fn refilled_columns_are_those_that_blocks_add_up_to() {
    let edges = grid(40);
    let pattern = Arc::new(SymmetricPattern::blocks(1600, pairs(&edges)).unwrap());
    let added = springs::<f64>(&pattern, &edges);
    let mut noise = Noise(7);
    let blocks: Vec<Mat3> = edges
        .iter()
        .map(|_| {
            let d = Vec3::new(noise.next(), noise.next(), noise.next());
            d * d.transpose() + Mat3::identity() * 0.1
        })
        .collect();
    let mut refilled = added.clone();
    refilled.refill(|vertex, mut column| {
        for (edge, block) in edges.iter().zip(&blocks).filter(|(e, _)| e.contains(&(vertex as u32))) {
            column.add_diagonal(block);
            column.add_below(edge[0].max(edge[1]), &-block);
        }
        column.add_diagonal(&(Mat3::identity() * 0.01));
        // What the pattern does not have is left out.
        column.add_below(vertex as u32 + 1000, &Mat3::identity());
    });
    let worst = added.values().iter().zip(refilled.values()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-12, "{worst:e}");
}
