//! Sparse symmetric linear systems. The only user of faer, whose types stay in here.
//!
//! ```text
//! SymmetricPattern ──▶ SymmetricMatrix ──▶ Cholesky ──▶ solve
//!  which entries        their values        L·Lᵀ
//! ```
//!
//! A pattern is built once from index pairs, a matrix is refilled through precomputed slots without any searching, and
//! the symbolic analysis of a factor is kept while its numbers change. Subtrees of large factors are
//! handed out to threads. The bits are the same every time.

mod cholesky;
mod fronts;
mod matrix;
mod memory;
mod pattern;
mod scalar;
mod tree;

pub use cholesky::{Cholesky, CholeskyError, NotPositiveDefinite};
pub use matrix::{BlockColumn, SymmetricMatrix};
pub use memory::{Memory, advance, dot};
pub use pattern::{BlockSlot, PatternError, Slot, SymmetricPattern};
pub use scalar::Scalar;
