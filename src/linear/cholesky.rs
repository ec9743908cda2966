//! A = L·Lᵀ: analysed once, factored and solved as often as needed.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, LltRegularization};
use faer::perm::PermRef;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{FaerError, SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use super::fronts::{self, Stopped};
use super::tree::Tree;
use super::{Scalar, SymmetricMatrix, SymmetricPattern};

/// Serial execution, whatever the process-wide setting: results must not depend on the number of threads.
const SERIAL: Par = Par::Seq;

/// Why no factor can be made for a pattern.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CholeskyError {
    /// The factor does not fit into memory or into 32-bit indices.
    #[error("the factor of a matrix of {0} rows is too large")]
    TooLarge(usize),
}

/// The matrix has a direction of no or negative curvature, or holds a number that is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the matrix is not positive definite (met at row {dof})")]
pub struct NotPositiveDefinite {
    /// The row where elimination stopped (of vertex `dof / 3` in a pattern of 3×3 blocks). It is exact for small
    /// matrices. In large ones, which are eliminated in dense blocks of rows, it may be another row nearby.
    pub dof: usize,
}

/// A sparse Cholesky factor that is refilled for new values of one pattern.
///
/// Bit-identical for identical input and any number of threads. The cost of [`Cholesky::new`] is that of about one
/// factorisation. Keep it.
#[derive(Debug)]
pub struct Cholesky<T> {
    pattern: Arc<SymmetricPattern>,
    kind: Elimination,
    values: Vec<T>,
}

/// How a matrix is eliminated.
#[derive(Debug)]
enum Elimination {
    /// Number by number, in one thread: for small matrices.
    Entries { symbolic: Box<SymbolicCholesky<u32>>, scratch: Scratch },
    /// By dense fronts, in all threads.
    Fronts(Tree),
}

/// Working memory of the factorisation, reused.
struct Scratch(MemBuffer);

impl std::fmt::Debug for Scratch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Scratch")
    }
}

impl<T: Scalar> Cholesky<T> {
    /// Analyses a pattern. The factor is that of no matrix until [`Cholesky::factor`] succeeds.
    ///
    /// # Errors
    /// A factor too large.
    pub fn new(pattern: Arc<SymmetricPattern>) -> Result<Self, CholeskyError> {
        let too_large = CholeskyError::TooLarge(pattern.size());
        let symbolic = analyse(&pattern)?;
        let (kind, len) = if let SymbolicCholeskyRaw::Supernodal(supernodes) = symbolic.raw() {
            let order: Vec<u32> = match symbolic.perm() {
                Some(order) => order.arrays().0.to_vec(),
                None => (0..pattern.size() as u32).collect(),
            };
            let tree = Tree::new(supernodes, &pattern, &order);
            let len = tree.len;
            (Elimination::Fronts(tree), len)
        } else {
            let needed = symbolic.factorize_numeric_llt_scratch::<T>(SERIAL, Default::default());
            let scratch = Scratch(MemBuffer::try_new(needed).map_err(|_| too_large)?);
            let len = symbolic.len_val();
            (Elimination::Entries { symbolic: Box::new(symbolic), scratch }, len)
        };
        Ok(Self { pattern, kind, values: vec![T::from_f64(0.0); len] })
    }

    /// Numbers in L, structural zeros of dense blocks included.
    pub fn factor_entries(&self) -> usize {
        self.values.len()
    }

    /// Factors a matrix.
    ///
    /// # Errors
    /// [`NotPositiveDefinite`], also for infinite and undefined entries. Solving is meaningless until a later
    /// factorisation succeeds.
    ///
    /// # Panics
    /// If the matrix has another number of rows or entries than the pattern this factor was made for.
    pub fn factor(&mut self, matrix: &SymmetricMatrix<T>) -> Result<(), NotPositiveDefinite> {
        assert_eq!(matrix.values().len(), self.pattern.entries(), "a matrix of another pattern");
        match &mut self.kind {
            Elimination::Entries { symbolic, scratch } => {
                let result = symbolic.factorize_numeric_llt(
                    &mut self.values,
                    SparseColMatRef::new(lower_triangle(&self.pattern), matrix.values()),
                    Side::Lower,
                    LltRegularization::default(),
                    SERIAL,
                    MemStack::new(&mut scratch.0),
                    Default::default(),
                );
                let Err(LltError::NonPositivePivot { index }) = result else { return Ok(()) };
                // faer counts pivots from one here, in its own order of elimination.
                let place = index.saturating_sub(1).min(self.pattern.size().saturating_sub(1));
                let dof = symbolic.perm().map_or(place, |p| p.arrays().0[place] as usize);
                Err(NotPositiveDefinite { dof })
            }
            Elimination::Fronts(tree) => {
                let stopped = |Stopped(place)| NotPositiveDefinite { dof: tree.order[place] as usize };
                fronts::factor(tree, matrix.values(), &mut self.values).map_err(stopped)
            }
        }
    }

    /// Solves A·x = b in place for one or several right-hand sides, one whole vector after the other.
    ///
    /// # Panics
    /// If the length is no multiple of the number of rows.
    pub fn solve(&self, rhs: &mut [T]) {
        let rows = self.pattern.size();
        if rows == 0 {
            return;
        }
        let columns = rhs.len() / rows;
        assert_eq!(columns * rows, rhs.len(), "right-hand sides must be whole vectors");
        match &self.kind {
            Elimination::Entries { symbolic, .. } => {
                let mut memory = MemBuffer::new(symbolic.solve_in_place_scratch::<T>(columns, SERIAL));
                LltRef::new(symbolic, &self.values).solve_in_place_with_conj(
                    Conj::No,
                    MatMut::from_column_major_slice_mut(rhs, rows, columns),
                    SERIAL,
                    MemStack::new(&mut memory),
                );
            }
            Elimination::Fronts(tree) => fronts::solve(tree, &self.values, rhs),
        }
    }

    /// [`Cholesky::solve`] for right-hand sides in f64, rounded to the factor's precision on the way in.
    ///
    /// # Panics
    /// If the length is no multiple of the number of rows.
    pub fn solve_f64(&self, rhs: &mut [f64]) {
        let mut rounded: Vec<T> = rhs.iter().map(|&x| T::from_f64(x)).collect();
        self.solve(&mut rounded);
        for (out, x) in rhs.iter_mut().zip(rounded) {
            *out = x.to_f64();
        }
    }
}

fn lower_triangle(pattern: &SymmetricPattern) -> SymbolicSparseColMatRef<'_, u32> {
    SymbolicSparseColMatRef::new_checked(pattern.size(), pattern.size(), pattern.starts(), None, pattern.rows())
}

fn analyse(pattern: &SymmetricPattern) -> Result<SymbolicCholesky<u32>, CholeskyError> {
    let ordered = minimum_degree(pattern).and_then(|[order, inverse]| {
        let order = PermRef::new_checked(&order, &inverse, pattern.size());
        let (order, params) = (SymmetricOrdering::Custom(order), CholeskySymbolicParams::default());
        factorize_symbolic_cholesky(lower_triangle(pattern), Side::Lower, order, params)
    });
    ordered.map_err(|_| CholeskyError::TooLarge(pattern.size()))
}

/// An order of elimination that fills L little, and its inverse: approximate minimum degree (Amestoy, Davis and Duff
/// 1996). Rows of one node have the same neighbours and stay together, so nodes are ordered, with a ninth of the
/// entries. In a garment's folds, whose layers are coupled where they touch, L has 0.4 to 0.6 of the entries it has
/// after cuts by planes (geometric nested dissection; measured: trousers of 5,249 nodes 1.05 against 1.79 million, a
/// gored skirt of 12,408 4.0 against 10.4). In a flat grid of up to 90,000 nodes as many.
fn minimum_degree(pattern: &SymmetricPattern) -> Result<[Vec<u32>; 2], FaerError> {
    let (starts, rows) = pattern.graph();
    let nodes = pattern.nodes();
    let graph = SymbolicSparseColMatRef::new_checked(nodes, nodes, starts, None, rows);
    let needed = amd::order_maybe_unsorted_scratch::<u32>(nodes, rows.len());
    let mut memory = MemBuffer::try_new(needed).map_err(|_| FaerError::OutOfMemory)?;
    let [mut order, mut inverse] = [vec![0; nodes], vec![0; nodes]];
    amd::order_maybe_unsorted(&mut order, &mut inverse, graph, Default::default(), MemStack::new(&mut memory))?;
    let width = pattern.width() as u32;
    Ok([order, inverse].map(|nodes| nodes.iter().flat_map(|v| (0..width).map(move |k| v * width + k)).collect()))
}
