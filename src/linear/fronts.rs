//! L of a tree of fronts: its numbers, and solving with them. Subtrees are handed out to threads.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::matmul;
use faer::linalg::matmul::triangular::{self, BlockStructure};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, MatRef, Par};
use rayon::prelude::*;

use super::Scalar;
use super::tree::Tree;
use crate::parallel;

/// Multiplications of a subtree up to which one thread keeps it when it is factored: a few tenths of a millisecond.
const FACTORED_ALONE: f64 = 1e6;
/// The same when it is solved, where work is counted as for factoring: such a subtree has some ten thousand numbers.
const SOLVED_ALONE: f64 = 4e5;
/// Rows of a front that one thread keeps.
const PANEL: usize = 96;
/// Right-hand sides that are solved for at once, at most.
const TOGETHER: usize = 8;
/// Partial sums of a scalar product, which are added at its end.
const LANES: usize = 8;

/// The place in the order of elimination where it stopped.
pub(super) struct Stopped(pub(super) usize);

/// Fills `values` with L of the matrix with these entries.
pub(super) fn factor<T: Scalar>(tree: &Tree, matrix: &[T], values: &mut [T]) -> Result<(), Stopped> {
    let whole: f64 = tree.roots.iter().map(|&t| tree.fronts[t].work).sum();
    if whole <= FACTORED_ALONE {
        return tree
            .roots
            .iter()
            .try_for_each(|&t| subtree_alone(tree, t, matrix, own_values(tree, t, values)).map(drop));
    }
    parallel::pass(|| subtrees(tree, &tree.roots, matrix, values).map(drop))
}

/// The numbers of the subtree of front `t`.
fn own_values<'v, T>(tree: &Tree, t: usize, values: &'v mut [T]) -> &'v mut [T] {
    let front = &tree.fronts[t];
    &mut values[tree.fronts[front.first].values..front.values + front.rows() * front.columns]
}

/// Factors the subtrees of some fronts, whose numbers are in `values`. Returns their updates.
fn subtrees<T: Scalar>(
    tree: &Tree,
    fronts: &[usize],
    matrix: &[T],
    mut values: &mut [T],
) -> Result<Vec<Vec<T>>, Stopped> {
    let mut parts = Vec::with_capacity(fronts.len());
    for &t in fronts {
        let front = &tree.fronts[t];
        let len = front.values + front.rows() * front.columns - tree.fronts[front.first].values;
        let (own, rest) = values.split_at_mut(len);
        parts.push((t, own));
        values = rest;
    }
    let factored: Vec<Result<Vec<T>, Stopped>> =
        parts.into_par_iter().map(|(t, values)| subtree(tree, t, matrix, values)).collect();
    factored.into_iter().collect()
}

/// Factors a subtree. Returns its update of the rows below it.
fn subtree<T: Scalar>(tree: &Tree, t: usize, matrix: &[T], values: &mut [T]) -> Result<Vec<T>, Stopped> {
    let front = &tree.fronts[t];
    if front.work <= FACTORED_ALONE {
        return subtree_alone(tree, t, matrix, values);
    }
    let (of_children, own) = values.split_at_mut(values.len() - front.rows() * front.columns);
    let updates = subtrees(tree, &front.children, matrix, of_children)?;
    eliminate(tree, t, matrix, own, &updates)
}

/// Factors a subtree in the calling thread.
fn subtree_alone<T: Scalar>(tree: &Tree, t: usize, matrix: &[T], values: &mut [T]) -> Result<Vec<T>, Stopped> {
    let mut updates: Vec<Vec<T>> = Vec::new();
    let mut rest = values;
    for f in tree.fronts[t].first..=t {
        let front = &tree.fronts[f];
        let (own, after) = rest.split_at_mut(front.rows() * front.columns);
        rest = after;
        let children = updates.split_off(updates.len() - front.children.len());
        updates.push(eliminate(tree, f, matrix, own, &children)?);
    }
    Ok(updates.pop().unwrap_or_default())
}

/// Eliminates the columns of front `t`, given the updates of its children. Returns its own.
fn eliminate<T: Scalar>(
    tree: &Tree,
    t: usize,
    matrix: &[T],
    values: &mut [T],
    updates: &[Vec<T>],
) -> Result<Vec<T>, Stopped> {
    let front = &tree.fronts[t];
    let (rows, columns) = (front.rows(), front.columns);
    let below = rows - columns;
    let zero = T::from_f64(0.0);
    values.fill(zero);
    for &[entry, place] in tree.entries(t) {
        values[place as usize] += matrix[entry as usize];
    }
    let mut update = vec![zero; below * below];
    for (&child, of_child) in front.children.iter().zip(updates) {
        add_update(&tree.fronts[child].relative, of_child, (values, rows, columns), &mut update);
    }
    let (mut top, mut bottom) = MatMut::from_column_major_slice_mut(values, rows, columns).split_at_row_mut(columns);
    let mut memory = MemBuffer::new(cholesky_in_place_scratch::<T>(columns, Par::Seq, Default::default()));
    let stack = MemStack::new(&mut memory);
    let done = cholesky_in_place(top.rb_mut(), LltRegularization::default(), Par::Seq, stack, Default::default());
    if let Err(LltError::NonPositivePivot { index }) = done {
        return Err(Stopped(front.start + index.min(columns - 1)));
    }
    if below > 0 {
        solve_below(top.rb(), bottom.rb_mut());
        subtract_square(MatMut::from_column_major_slice_mut(&mut update, below, below), bottom.rb());
    }
    Ok(update)
}

/// Adds the update of a child, whose rows are at the places `relative` of the front, to the front's columns and update.
fn add_update<T: Scalar>(
    relative: &[u32],
    of_child: &[T],
    (values, rows, columns): (&mut [T], usize, usize),
    update: &mut [T],
) {
    let (size, below) = (relative.len(), rows - columns);
    for (j, &column) in relative.iter().enumerate() {
        let added = relative[j..].iter().zip(&of_child[j * size + j..(j + 1) * size]);
        let column = column as usize;
        if column < columns {
            let out = &mut values[column * rows..(column + 1) * rows];
            added.for_each(|(&row, value)| out[row as usize] += *value);
        } else {
            let out = &mut update[(column - columns) * below..(column - columns + 1) * below];
            added.for_each(|(&row, value)| out[row as usize - columns] += *value);
        }
    }
}

/// `bottom` times the inverse transpose of the lower triangle `top`, by panels of rows.
fn solve_below<T: Scalar>(top: MatRef<T>, bottom: MatMut<T>) {
    if bottom.nrows() < 2 * PANEL {
        return solve_lower_triangular_in_place(top, bottom.transpose_mut(), Par::Seq);
    }
    let half = bottom.nrows() / 2;
    let (upper, lower) = bottom.split_at_row_mut(half);
    rayon::join(|| solve_below(top, upper), || solve_below(top, lower));
}

/// Subtracts the square of `bottom` from the lower triangle of the `update`, by panels.
fn subtract_square<T: Scalar>(update: MatMut<T>, bottom: MatRef<T>) {
    let (minus, size) = (T::from_f64(-1.0), update.nrows());
    if size < 2 * PANEL {
        let (lower, all) = (BlockStructure::TriangularLower, BlockStructure::Rectangular);
        triangular::matmul(update, lower, Accum::Add, bottom, all, bottom.transpose(), all, minus, Par::Seq);
        return;
    }
    let (first, second) = bottom.split_at_row(size / 2);
    let (corner, _, side, rest) = update.split_at_mut(size / 2, size / 2);
    rayon::join(
        || rayon::join(|| subtract_square(corner, first), || subtract_square(rest, second)),
        || matmul(side, Accum::Add, second, first.transpose(), minus, Par::Seq),
    );
}

/// Solves L Lᵀ x = b for right-hand sides that follow one another in `x`, of which each holds b at first. Several at a
/// time: L is read once for all of them.
pub(super) fn solve<T: Scalar>(tree: &Tree, values: &[T], x: &mut [T]) {
    let rows = tree.order.len();
    let mut rest = x;
    while !rest.is_empty() {
        let taken = (rest.len() / rows).min(TOGETHER);
        let (now, after) = rest.split_at_mut(taken * rows);
        rest = after;
        match taken {
            1 => solve_together::<T, 1, LANES>(tree, values, now),
            2 => solve_together::<T, 2, { LANES / 2 }>(tree, values, now),
            3 | 4 => solve_together::<T, 4, { LANES / 4 }>(tree, values, now),
            _ => solve_together::<T, TOGETHER, { LANES / TOGETHER }>(tree, values, now),
        }
    }
}

/// Solves for up to `W` right-hand sides at once, with scalar products of `L` partial sums.
fn solve_together<T: Scalar, const W: usize, const L: usize>(tree: &Tree, values: &[T], x: &mut [T]) {
    let zero = [T::from_f64(0.0); W];
    let rows = tree.order.len();
    let mut placed = vec![zero; rows];
    let mut below = vec![zero; tree.below];
    parallel::for_each(&mut placed, parallel::LIGHT, |k, out| {
        out.iter_mut().zip(x.chunks_exact(rows)).for_each(|(out, side)| *out = side[tree.order[k] as usize]);
    });
    let whole: f64 = tree.roots.iter().map(|&t| tree.fronts[t].work).sum();
    if whole <= SOLVED_ALONE {
        let mut all = FrontNumbers { x: &mut placed, below: &mut below };
        (0..tree.fronts.len()).for_each(|f| all.forward(tree, f, 0, values));
        (0..tree.fronts.len()).rev().for_each(|f| all.backward::<L>(tree, f, 0, values));
    } else {
        parallel::pass(|| {
            let mut all = FrontNumbers { x: &mut placed, below: &mut below };
            forward(tree, &mut all.split(tree, &tree.roots), values);
            backward::<T, W, L>(tree, &mut all.split(tree, &tree.roots), values);
        });
    }
    for (side, out) in x.chunks_exact_mut(rows).enumerate() {
        for (place, &row) in tree.order.iter().enumerate() {
            out[row as usize] = placed[place][side];
        }
    }
}

/// The numbers of `W` right-hand sides that belong to a row of fronts.
struct FrontNumbers<'x, T, const W: usize> {
    /// At their columns.
    x: &'x mut [[T; W]],
    /// At the rows below these, front by front.
    below: &'x mut [[T; W]],
}

impl<T: Scalar, const W: usize> FrontNumbers<'_, T, W> {
    /// The parts of the subtrees of some fronts that follow one another, from the first front of this part on.
    fn split(&mut self, tree: &Tree, fronts: &[usize]) -> Vec<(usize, FrontNumbers<'_, T, W>)> {
        let (mut x, mut below) = (&mut *self.x, &mut *self.below);
        let mut out = Vec::with_capacity(fronts.len());
        for &t in fronts {
            let (front, first) = (&tree.fronts[t], &tree.fronts[tree.fronts[t].first]);
            let (own, rest) = x.split_at_mut(front.start + front.columns - first.start);
            let (own_below, rest_below) = below.split_at_mut(front.below + front.relative.len() - first.below);
            out.push((t, FrontNumbers { x: own, below: own_below }));
            (x, below) = (rest, rest_below);
        }
        out
    }

    /// L y = b at the columns of front `f`, in a part that begins with front `first`. The sum that it takes from the
    /// rows below is added to that of its children.
    fn forward(&mut self, tree: &Tree, f: usize, first: usize, values: &[T]) {
        let (front, begin) = (&tree.fronts[f], &tree.fronts[first]);
        let (columns, rows) = (front.columns, front.rows());
        let x = &mut self.x[front.start - begin.start..][..columns];
        let (before, below) = self.below.split_at_mut(front.below - begin.below);
        let below = &mut below[..rows - columns];
        below.fill([T::from_f64(0.0); W]);
        for child in front.children.iter().map(|&c| &tree.fronts[c]) {
            let of_child = &before[child.below - begin.below..][..child.relative.len()];
            let inner = child.relative.partition_point(|&k| (k as usize) < columns);
            for (&k, value) in child.relative[..inner].iter().zip(of_child) {
                add(&mut x[k as usize], value);
            }
            for (&k, value) in child.relative[inner..].iter().zip(&of_child[inner..]) {
                add(&mut below[k as usize - columns], value);
            }
        }
        for c in 0..columns {
            let column = &values[front.values + c * rows..][..rows];
            let y = x[c].map(|x| x / column[c]);
            x[c] = y;
            subtract_column(&mut x[c + 1..], &column[c + 1..columns], &y);
            subtract_column(below, &column[columns..], &y);
        }
    }

    /// Lᵀ x = y at the columns of front `f`, in a part that begins with front `first`, where `below` holds the solution
    /// at the rows below. Hands the solution on to its children.
    fn backward<const L: usize>(&mut self, tree: &Tree, f: usize, first: usize, values: &[T]) {
        let (front, begin) = (&tree.fronts[f], &tree.fronts[first]);
        let (columns, rows) = (front.columns, front.rows());
        let x = &mut self.x[front.start - begin.start..][..columns];
        let (before, below) = self.below.split_at_mut(front.below - begin.below);
        let below = &below[..rows - columns];
        for c in (0..columns).rev() {
            let column = &values[front.values + c * rows..][..rows];
            let inner = dot::<T, W, L>(&column[c + 1..columns], &x[c + 1..]);
            let outer = dot::<T, W, L>(&column[columns..], below);
            for k in 0..W {
                let mut y = x[c][k];
                y -= inner[k];
                y -= outer[k];
                x[c][k] = y / column[c];
            }
        }
        for child in front.children.iter().map(|&c| &tree.fronts[c]) {
            let of_child = &mut before[child.below - begin.below..][..child.relative.len()];
            hand_on(&child.relative, x, below, of_child);
        }
    }
}

fn add<T: Scalar, const W: usize>(sum: &mut [T; W], numbers: &[T; W]) {
    sum.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += *number);
}

/// Subtracts a column times the numbers `y`.
#[inline]
fn subtract_column<T: Scalar, const W: usize>(out: &mut [[T; W]], column: &[T], y: &[T; W]) {
    for (out, l) in out.iter_mut().zip(column) {
        for k in 0..W {
            out[k] -= *l * y[k];
        }
    }
}

/// The solution at the rows below a child, whose places in its parent are `relative`.
fn hand_on<T: Scalar, const W: usize>(relative: &[u32], x: &[[T; W]], below: &[[T; W]], of_child: &mut [[T; W]]) {
    let inner = relative.partition_point(|&k| (k as usize) < x.len());
    for (out, &k) in of_child.iter_mut().zip(&relative[..inner]) {
        *out = x[k as usize];
    }
    for (out, &k) in of_child[inner..].iter_mut().zip(&relative[inner..]) {
        *out = below[k as usize - x.len()];
    }
}

/// [`FrontNumbers::forward`] of whole subtrees.
fn forward<T: Scalar, const W: usize>(tree: &Tree, parts: &mut [(usize, FrontNumbers<T, W>)], values: &[T]) {
    parts.par_iter_mut().for_each(|(t, part)| {
        let front = &tree.fronts[*t];
        if front.work <= SOLVED_ALONE {
            return (front.first..=*t).for_each(|f| part.forward(tree, f, front.first, values));
        }
        forward(tree, &mut part.split(tree, &front.children), values);
        part.forward(tree, *t, front.first, values);
    });
}

/// [`FrontNumbers::backward`] of whole subtrees.
fn backward<T: Scalar, const W: usize, const L: usize>(
    tree: &Tree,
    parts: &mut [(usize, FrontNumbers<T, W>)],
    values: &[T],
) {
    parts.par_iter_mut().for_each(|(t, part)| {
        let front = &tree.fronts[*t];
        if front.work <= SOLVED_ALONE {
            return (front.first..=*t).rev().for_each(|f| part.backward::<L>(tree, f, front.first, values));
        }
        part.backward::<L>(tree, *t, front.first, values);
        backward::<T, W, L>(tree, &mut part.split(tree, &front.children), values);
    });
}

/// Scalar products with `W` vectors, in a fixed order that lets a core work on several sums at once.
#[inline]
fn dot<T: Scalar, const W: usize, const L: usize>(a: &[T], b: &[[T; W]]) -> [T; W] {
    let mut sums = [[T::from_f64(0.0); W]; L];
    let b = &b[..a.len()];
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<L>(), b.as_chunks::<L>());
    let mut add = |lane: usize, a: T, b: &[T; W]| {
        for k in 0..W {
            sums[lane][k] += a * b[k];
        }
    };
    for (a, b) in a.iter().zip(b) {
        (0..L).for_each(|lane| add(lane, a[lane], &b[lane]));
    }
    for (lane, (a, b)) in a_rest.iter().zip(b_rest).enumerate() {
        add(lane, *a, b);
    }
    let mut whole = [T::from_f64(0.0); W];
    for part in &sums {
        self::add(&mut whole, part);
    }
    whole
}
