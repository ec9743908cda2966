//! Which entries of a symmetric matrix may be non-zero.

/// The lower triangle of a symmetric sparse matrix, compressed by columns. Every diagonal entry is part of it.
///
/// Either one number per entry ([`SymmetricPattern::scalar`]) or a small block per pair of vertices: 3×3 in space
/// ([`SymmetricPattern::blocks`]), where vertex `v` owns the degrees of freedom 3v, 3v + 1, 3v + 2, and 2×2 in the
/// plane ([`SymmetricPattern::planar_blocks`]), where it owns 2v and 2v + 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SymmetricPattern {
    /// Rows of a block: 1, 2 or 3.
    width: usize,
    /// Start of every block column in `node_rows`, and their total.
    node_starts: Vec<u32>,
    /// Block rows of every block column, rising, the diagonal first.
    node_rows: Vec<u32>,
    /// Start of every scalar column in `rows`, and their total.
    starts: Vec<u32>,
    /// Start of every block column in `rows`, and their total.
    node_values: Vec<u32>,
    /// Scalar rows of every scalar column, rising, the diagonal first.
    rows: Vec<u32>,
}

/// Why a pattern could not be built.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PatternError {
    /// An index beyond the matrix.
    #[error("matrix entry ({row}, {column}) lies outside a matrix of {size} rows")]
    OutOfRange {
        /// Row (vertex in a block pattern).
        row: usize,
        /// Column (vertex in a block pattern).
        column: usize,
        /// Rows (vertices in a block pattern).
        size: usize,
    },
    /// More entries than 32-bit indices can number.
    #[error("a sparse matrix of {0} entries is too large")]
    TooLarge(usize),
}

/// Where a scalar entry lives in a matrix of its pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot(pub(super) u32);

/// Where a block lives in a matrix of its pattern.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockSlot {
    /// Position of the block's row 0 in its column 0.
    pub(super) start: u32,
    /// Distance from there to the place of row 0 in column 1. It is one less from column 1 to 2.
    pub(super) stride: u32,
    /// Stored part of the block.
    pub(super) kind: BlockKind,
}

/// Part of a block that the lower triangle stores.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum BlockKind {
    /// On the diagonal: its lower triangle.
    Diagonal,
    /// Below the diagonal: all of it.
    Lower,
    /// Asked for above the diagonal: its transpose, below.
    Transposed,
}

impl SymmetricPattern {
    /// An n×n pattern of single numbers with the given (row, column) entries, of either triangle and in any order.
    /// Repeated pairs are allowed, and the diagonal may be left out.
    ///
    /// # Errors
    /// An index of `n` or more, or more than 2³¹ entries.
    pub fn scalar(n: usize, entries: impl IntoIterator<Item = (usize, usize)>) -> Result<Self, PatternError> {
        Self::new(n, 1, entries)
    }

    /// A pattern of 3×3 blocks on `n` vertices (3n rows), with one block for every given pair of vertices.
    ///
    /// # Errors
    /// An index of `n` or more, or more than 2³¹ entries.
    pub fn blocks(n: usize, pairs: impl IntoIterator<Item = (usize, usize)>) -> Result<Self, PatternError> {
        Self::new(n, 3, pairs)
    }

    /// A pattern of 2×2 blocks on `n` vertices (2n rows), with one block for every given pair of vertices.
    ///
    /// # Errors
    /// An index of `n` or more, or more than 2³¹ entries.
    pub fn planar_blocks(n: usize, pairs: impl IntoIterator<Item = (usize, usize)>) -> Result<Self, PatternError> {
        Self::new(n, 2, pairs)
    }

    fn new(n: usize, width: usize, pairs: impl IntoIterator<Item = (usize, usize)>) -> Result<Self, PatternError> {
        if n.saturating_mul(width) >= i32::MAX as usize {
            return Err(PatternError::TooLarge(n.saturating_mul(width)));
        }
        let mut lower: Vec<(u32, u32)> = (0..n as u32).map(|v| (v, v)).collect();
        for (row, column) in pairs {
            if row >= n || column >= n {
                return Err(PatternError::OutOfRange { row, column, size: n });
            }
            lower.push((row.min(column) as u32, row.max(column) as u32));
        }
        lower.sort_unstable();
        lower.dedup();
        let entries = lower.len() * width * width;
        if entries > i32::MAX as usize {
            return Err(PatternError::TooLarge(entries));
        }
        let node_starts = column_starts(n, lower.iter().map(|&(column, _)| column));
        let node_rows: Vec<u32> = lower.into_iter().map(|(_, row)| row).collect();
        let (starts, rows) = expand(&node_starts, &node_rows, width as u32);
        let node_values = starts.iter().step_by(width).copied().collect();
        Ok(Self { width, node_starts, node_rows, starts, node_values, rows })
    }

    /// Rows (and columns) of the matrix: [`SymmetricPattern::width`] per node.
    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// Vertices of a block pattern, rows of a scalar one.
    pub fn nodes(&self) -> usize {
        self.node_starts.len() - 1
    }

    /// Degrees of freedom per node: 1, 2 or 3.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Stored numbers (lower triangle with diagonal).
    pub fn entries(&self) -> usize {
        self.rows.len()
    }

    /// The place of entry (i, j) = (j, i) in a scalar pattern. `None` if it is no part of the pattern or the pattern
    /// is one of blocks.
    pub fn slot(&self, i: usize, j: usize) -> Option<Slot> {
        if self.width != 1 {
            return None;
        }
        self.node_entry(i.max(j), i.min(j)).map(|k| Slot(self.node_starts[i.min(j)] + k))
    }

    /// The place of the block that couples vertices `i` (rows) and `j` (columns). `None` if it is no part of the
    /// pattern or the pattern is scalar.
    pub fn block_slot(&self, i: usize, j: usize) -> Option<BlockSlot> {
        if self.width == 1 {
            return None;
        }
        let (row, column) = (i.max(j), i.min(j));
        let k = self.node_entry(row, column)?;
        let blocks = self.node_starts[column + 1] - self.node_starts[column];
        let kind = match i.cmp(&j) {
            std::cmp::Ordering::Equal => BlockKind::Diagonal,
            std::cmp::Ordering::Greater => BlockKind::Lower,
            std::cmp::Ordering::Less => BlockKind::Transposed,
        };
        // Columns of a column of m 3×3 blocks are 3m, 3m − 1 and 3m − 2 entries long, for they start at the diagonal.
        let width = self.width as u32;
        let start = self.starts[column * self.width] + width * k;
        Some(BlockSlot { start, stride: width * blocks - 1, kind })
    }

    /// Index of block row `row` in block column `column`, counted from the column's diagonal.
    fn node_entry(&self, row: usize, column: usize) -> Option<u32> {
        let from = *self.node_starts.get(column)? as usize;
        let to = *self.node_starts.get(column + 1)? as usize;
        self.node_rows[from..to].binary_search(&u32::try_from(row).ok()?).ok().map(|k| k as u32)
    }

    /// Start of every node's columns among all entries, with the total at the end.
    pub(super) fn node_values(&self) -> &[u32] {
        &self.node_values
    }

    /// The nodes of the blocks in a node's columns, its own first.
    pub(super) fn node_column(&self, node: usize) -> &[u32] {
        &self.node_rows[self.node_starts[node] as usize..self.node_starts[node + 1] as usize]
    }

    /// Column starts and rows of the lower triangle of nodes.
    pub(super) fn graph(&self) -> (&[u32], &[u32]) {
        (&self.node_starts, &self.node_rows)
    }

    /// Column starts of the scalar matrix, with the total at the end.
    pub(super) fn starts(&self) -> &[u32] {
        &self.starts
    }

    /// Rows of the scalar matrix, column after column.
    pub(super) fn rows(&self) -> &[u32] {
        &self.rows
    }
}

/// Starts of the runs of equal columns in a sorted list, and its length.
fn column_starts(n: usize, columns: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut starts = vec![0u32; n + 1];
    for column in columns {
        starts[column as usize + 1] += 1;
    }
    for column in 0..n {
        starts[column + 1] += starts[column];
    }
    starts
}

/// Writes block columns out as scalar columns.
fn expand(node_starts: &[u32], node_rows: &[u32], width: u32) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0u32];
    let mut rows = Vec::with_capacity(node_rows.len() * (width * width) as usize);
    for (column, ends) in node_starts.windows(2).enumerate() {
        for part in 0..width {
            let diagonal = column as u32 * width + part;
            let blocks = node_rows[ends[0] as usize..ends[1] as usize].iter();
            let scalars = blocks.flat_map(|&row| (0..width).map(move |r| row * width + r));
            rows.extend(scalars.filter(|&row| row >= diagonal));
            starts.push(rows.len() as u32);
        }
    }
    (starts, rows)
}
