//! The numbers of a sparse symmetric matrix.

use std::sync::Arc;

use nalgebra::SMatrix;

use super::pattern::BlockKind;
use super::{BlockSlot, Scalar, Slot, SymmetricPattern};
use crate::parallel::{self, MEDIUM};

/// A symmetric matrix with the entries of its pattern, filled by adding to slots.
///
/// Slots of another pattern give a wrong matrix, or a panic if they lie beyond its end.
#[derive(Clone, Debug)]
pub struct SymmetricMatrix<T> {
    pattern: Arc<SymmetricPattern>,
    values: Vec<T>,
}

/// The blocks of one vertex' columns, on and below the diagonal.
#[derive(Debug)]
pub struct BlockColumn<'a, T> {
    /// Vertices of the blocks, rising, its own first.
    rows: &'a [u32],
    values: &'a mut [T],
}

impl<T: Scalar> BlockColumn<'_, T> {
    /// Adds a symmetric block on the diagonal. `W` must be the width of the pattern.
    #[inline]
    pub fn add_diagonal<const W: usize>(&mut self, block: &SMatrix<f64, W, W>) {
        let mut at = 0;
        for c in 0..W {
            for r in c..W {
                self.values[at + r - c] += T::from_f64(block[(r, c)]);
            }
            at += W * self.rows.len() - c;
        }
    }

    /// Adds the block in the rows of a `vertex`, if it lies below the diagonal and is part of the pattern. `W` must be
    /// the width of the pattern.
    #[inline]
    pub fn add_below<const W: usize>(&mut self, vertex: u32, block: &SMatrix<f64, W, W>) {
        let Ok(k) = self.rows[1..].binary_search(&vertex) else { return };
        let mut at = W * (k + 1);
        for c in 0..W {
            for r in 0..W {
                self.values[at + r] += T::from_f64(block[(r, c)]);
            }
            // Each column begins at its diagonal, and is one entry shorter than the one before it.
            at += W * self.rows.len() - c - 1;
        }
    }
}

impl<T: Scalar> SymmetricMatrix<T> {
    /// A zero matrix.
    pub fn zeros(pattern: Arc<SymmetricPattern>) -> Self {
        let values = vec![T::from_f64(0.0); pattern.entries()];
        Self { pattern, values }
    }

    /// Its entries' places.
    pub fn pattern(&self) -> &Arc<SymmetricPattern> {
        &self.pattern
    }

    /// The stored numbers: lower triangle by columns.
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.values.fill(T::from_f64(0.0));
    }

    /// Sets every entry to zero and fills the columns of every vertex anew. Vertices are handed out to threads.
    pub fn refill(&mut self, fill: impl Fn(usize, BlockColumn<T>) + Sync) {
        let pattern = &self.pattern;
        parallel::for_each_row(&mut self.values, pattern.node_values(), MEDIUM, |vertex, values| {
            values.fill(T::from_f64(0.0));
            fill(vertex, BlockColumn { rows: pattern.node_column(vertex), values });
        });
    }

    /// Adds to one entry (and so to its mirror image).
    #[inline]
    pub fn add(&mut self, slot: Slot, value: f64) {
        self.values[slot.0 as usize] += T::from_f64(value);
    }

    /// Adds a block, and its transpose at the mirror image. On the diagonal the block must be symmetric, because only
    /// its lower triangle is read. `W` must be the width of the pattern, 3 (or 2 in the plane). Otherwise the matrix is
    /// wrong.
    #[inline]
    pub fn add_block<const W: usize>(&mut self, slot: BlockSlot, block: &SMatrix<f64, W, W>) {
        debug_assert_eq!(W, self.pattern.width());
        let mut at = slot.start as usize;
        for c in 0..W {
            let first = if slot.kind == BlockKind::Diagonal { c } else { 0 };
            for r in first..W {
                let value = if slot.kind == BlockKind::Transposed { block[(c, r)] } else { block[(r, c)] };
                self.values[at + r] += T::from_f64(value);
            }
            // Each column is one entry shorter than the one before it.
            at += slot.stride as usize - c;
        }
    }

    /// Adds `share` of itself to every entry of the diagonal.
    pub fn strengthen_diagonal(&mut self, share: f64) {
        // Columns hold the lower triangle: each begins with its diagonal entry.
        for column in 0..self.pattern.size() {
            let entry = &mut self.values[self.pattern.starts()[column] as usize];
            *entry += T::from_f64(entry.to_f64() * share);
        }
    }

    /// Multiplies: out = A·x, summed in f64.
    ///
    /// # Panics
    /// If a length is not [`SymmetricPattern::size`].
    pub fn multiply(&self, x: &[f64], out: &mut [f64]) {
        assert!(x.len() == self.pattern.size() && out.len() == x.len(), "vectors must have the matrix' size");
        out.fill(0.0);
        let (starts, rows) = (self.pattern.starts(), self.pattern.rows());
        for (column, ends) in starts.windows(2).enumerate() {
            let range = ends[0] as usize..ends[1] as usize;
            for (&row, value) in rows[range.clone()].iter().zip(&self.values[range]) {
                let (row, value) = (row as usize, value.to_f64());
                out[row] += value * x[column];
                if row != column {
                    out[column] += value * x[row];
                }
            }
        }
    }
}
