//! The numbers of a sparse symmetric matrix.

use std::sync::Arc;

use super::pattern::BlockKind;
use super::{BlockSlot, Scalar, Slot, SymmetricPattern};
use crate::geometry::Mat3;

/// A symmetric matrix with the entries of its pattern, filled by adding to slots.
///
/// Slots of another pattern give a wrong matrix, or a panic if they lie beyond its end.
#[derive(Clone, Debug)]
pub struct SymmetricMatrix<T> {
    pattern: Arc<SymmetricPattern>,
    values: Vec<T>,
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

    /// Adds to one entry (and so to its mirror image).
    #[inline]
    pub fn add(&mut self, slot: Slot, value: f64) {
        let entry = &mut self.values[slot.0 as usize];
        *entry = *entry + T::from_f64(value);
    }

    /// Adds a 3×3 block, and its transpose at the mirror image. On the diagonal the block must be symmetric: only its
    /// lower triangle is read.
    #[inline]
    pub fn add_block(&mut self, slot: BlockSlot, block: &Mat3) {
        let mut at = slot.start as usize;
        for column in 0..3 {
            let first = if slot.kind == BlockKind::Diagonal { column } else { 0 };
            for (row, entry) in self.values[at + first..at + 3].iter_mut().enumerate() {
                let (r, c) = (row + first, column);
                let value = if slot.kind == BlockKind::Transposed { block[(c, r)] } else { block[(r, c)] };
                *entry = *entry + T::from_f64(value);
            }
            // Each of the three columns is one entry shorter than the one before it.
            at += slot.stride as usize - column;
        }
    }

    /// out = A·x, summed in f64.
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
