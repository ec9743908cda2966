//! Sparse symmetric linear systems. The only user of faer, whose types stay in here.
//!
//! ```text
//! SymmetricPattern ──▶ SymmetricMatrix ──▶ Cholesky ──▶ solve
//!  which entries        their values        L·Lᵀ
//! ```
//!
//! A pattern is built once from index pairs, a matrix is refilled through precomputed slots without any searching, and
//! the symbolic analysis of a factor is kept while its numbers change. Everything runs in the calling thread and gives
//! the same bits every time.

mod cholesky;
mod matrix;
mod memory;
mod pattern;

pub use cholesky::{Cholesky, CholeskyError, NotPositiveDefinite, Scalar};
pub use matrix::SymmetricMatrix;
pub use memory::{Memory, advance, dot};
pub use pattern::{BlockSlot, PatternError, Slot, SymmetricPattern};
