//! The tree by which a sparse matrix is eliminated, its fronts numbered so that every subtree lies in a row.
//!
//! A front holds the columns of L that are eliminated together, and the rows below them. It hands its update of these
//! rows on to its parent (Duff and Reid 1983). Subtrees have no number in common, so threads work on them side by
//! side. Children are added in a fixed order, so the bits are the same for any number of threads.

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

use super::SymmetricPattern;

/// No front.
const NONE: u32 = u32::MAX;

/// One front.
#[derive(Clone, Debug)]
pub(super) struct Front {
    /// Its first column in the order of elimination.
    pub(super) start: usize,
    /// Number of columns.
    pub(super) columns: usize,
    /// First front of its subtree, which ends with this one.
    pub(super) first: usize,
    /// Its children, rising.
    pub(super) children: Vec<usize>,
    /// Place of every row below its columns in its parent: first the parent's columns, then the rows below these.
    pub(super) relative: Vec<u32>,
    /// Where its columns begin among the numbers of L.
    pub(super) values: usize,
    /// Number of rows below the columns of all fronts before it.
    pub(super) below: usize,
    /// Where its entries begin in [`Tree::entries`].
    entries: usize,
    /// Multiplications of its subtree.
    pub(super) work: f64,
}

impl Front {
    /// Number of rows, those of its columns included.
    pub(super) fn rows(&self) -> usize {
        self.columns + self.relative.len()
    }
}

/// The fronts of a matrix, children before their parents.
#[derive(Debug)]
pub(super) struct Tree {
    pub(super) fronts: Vec<Front>,
    /// Fronts without a parent, rising.
    pub(super) roots: Vec<usize>,
    /// Row of the matrix that is eliminated at each place.
    pub(super) order: Vec<u32>,
    /// For every entry of the matrix: its number, and its place in the columns of its front. By fronts.
    entries: Vec<[u32; 2]>,
    /// Numbers in L.
    pub(super) len: usize,
    /// Number of rows below the columns of all fronts.
    pub(super) below: usize,
}

impl Tree {
    /// The tree of faer's analysis, for a matrix of `pattern` that is eliminated in `order` (places to rows).
    pub(super) fn new(symbolic: &SymbolicSupernodalCholesky<u32>, pattern: &SymmetricPattern, order: &[u32]) -> Self {
        let count = symbolic.n_supernodes();
        let (begin, end) = (symbolic.supernode_begin(), symbolic.supernode_end());
        let mut front_of = vec![0u32; pattern.size()];
        for s in 0..count {
            front_of[begin[s] as usize..end[s] as usize].fill(s as u32);
        }
        let parent: Vec<u32> = (0..count)
            .map(|s| symbolic.supernode(s).pattern().first().map_or(NONE, |&row| front_of[row as usize]))
            .collect();
        let sequence = postorder(&parent);
        // Columns in the new order, and where faer's are in it.
        let columns = |&s: &u32| begin[s as usize]..end[s as usize];
        let old: Vec<u32> = sequence.iter().flat_map(columns).collect();
        let place = inverse(&old);
        let renumbered = inverse(&sequence);
        let mut out = Self {
            fronts: Vec::with_capacity(count),
            roots: Vec::new(),
            order: old.iter().map(|&c| order[c as usize]).collect(),
            entries: Vec::with_capacity(pattern.entries()),
            len: 0,
            below: 0,
        };
        let mut below: Vec<Vec<u32>> = Vec::with_capacity(count);
        let mut start = 0;
        for (t, &s) in sequence.iter().enumerate() {
            let mut rows: Vec<u32> =
                symbolic.supernode(s as usize).pattern().iter().map(|&row| place[row as usize]).collect();
            rows.sort_unstable();
            let columns = (end[s as usize] - begin[s as usize]) as usize;
            let front = Front {
                start,
                columns,
                first: t,
                children: Vec::new(),
                relative: vec![0; rows.len()],
                values: out.len,
                below: out.below,
                entries: 0,
                work: (columns * (columns + rows.len()).pow(2)) as f64,
            };
            out.len += front.rows() * columns;
            out.below += rows.len();
            start += columns;
            out.fronts.push(front);
            below.push(rows);
        }
        for t in 0..count {
            match parent[sequence[t] as usize] {
                NONE => out.roots.push(t),
                p => out.join(t, renumbered[p as usize] as usize, &below),
            }
        }
        out.place_entries(pattern, &below);
        out
    }

    /// Joins front `t` to its `parent`. All fronts before `t` are joined already.
    fn join(&mut self, t: usize, parent: usize, below: &[Vec<u32>]) {
        let Front { start, columns, .. } = self.fronts[parent];
        let local = |&row: &u32| {
            let row = row as usize;
            let inner = row < start + columns;
            if inner {
                (row - start) as u32
            } else {
                (columns + below[parent].partition_point(|r| (*r as usize) < row)) as u32
            }
        };
        let relative = below[t].iter().map(local).collect();
        let child = &mut self.fronts[t];
        child.relative = relative;
        let (first, work) = (child.first, child.work);
        let parent = &mut self.fronts[parent];
        parent.first = parent.first.min(first);
        parent.work += work;
        parent.children.push(t);
    }

    /// Finds the place of every entry of the matrix.
    fn place_entries(&mut self, pattern: &SymmetricPattern, below: &[Vec<u32>]) {
        let n = pattern.size();
        let places = inverse(&self.order);
        let place = places.as_slice();
        // Entries by the column where they are eliminated.
        let mut starts = vec![0u32; n + 1];
        let all = || {
            (0..n).flat_map(|column| {
                let range = pattern.starts()[column] as usize..pattern.starts()[column + 1] as usize;
                range.map(move |k| (k, place[column], place[pattern.rows()[k] as usize]))
            })
        };
        all().for_each(|(_, a, b)| starts[a.min(b) as usize + 1] += 1);
        (0..n).for_each(|c| starts[c + 1] += starts[c]);
        let (mut by_column, mut next) = (vec![[0u32; 2]; pattern.entries()], starts.clone());
        for (k, a, b) in all() {
            let at = &mut next[a.min(b) as usize];
            by_column[*at as usize] = [k as u32, a.max(b)];
            *at += 1;
        }
        let mut local = vec![0u32; n];
        for (front, below) in self.fronts.iter_mut().zip(below) {
            front.entries = self.entries.len();
            (0..front.columns).for_each(|c| local[front.start + c] = c as u32);
            below.iter().zip(front.columns as u32..).for_each(|(&row, k)| local[row as usize] = k);
            for c in 0..front.columns {
                let column = starts[front.start + c] as usize..starts[front.start + c + 1] as usize;
                let first = (c * front.rows()) as u32;
                self.entries.extend(by_column[column].iter().map(|[k, row]| [*k, first + local[*row as usize]]));
            }
        }
    }

    /// The entries of the matrix in the columns of front `t`: number, and place in these columns.
    pub(super) fn entries(&self, t: usize) -> &[[u32; 2]] {
        let end = self.fronts.get(t + 1).map_or(self.entries.len(), |next| next.entries);
        &self.entries[self.fronts[t].entries..end]
    }
}

/// The nodes of a forest, children before their parents and each subtree in a row.
fn postorder(parent: &[u32]) -> Vec<u32> {
    let mut children = vec![Vec::new(); parent.len()];
    let mut stack = Vec::new();
    for (s, &p) in parent.iter().enumerate().rev() {
        match p {
            NONE => stack.push(s as u32),
            p => children[p as usize].push(s as u32),
        }
    }
    // Parents first, last children first; then turned round.
    let mut out = Vec::with_capacity(parent.len());
    stack.reverse();
    while let Some(s) = stack.pop() {
        out.push(s);
        children[s as usize].reverse();
        stack.append(&mut children[s as usize]);
    }
    out.reverse();
    out
}

/// Where each number is in a permutation.
fn inverse(order: &[u32]) -> Vec<u32> {
    let mut out = vec![0; order.len()];
    order.iter().zip(0u32..).for_each(|(&at, k)| out[at as usize] = k);
    out
}
