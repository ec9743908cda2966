//! Lattice points that matter to a piece, as stretches of its rows. For a narrow piece askew to the grain they are a
//! vanishing share of its bounding box.

use std::ops::RangeInclusive;

/// Columns of one row, and the number of its first point.
struct RowColumns {
    first: usize,
    end: usize,
    number: usize,
}

/// Stretches of lattice rows, their points numbered row by row.
pub(super) struct Spans {
    spans: Vec<RowColumns>,
    /// Index of the first span of every row, and the number of spans at the end.
    rows: Vec<usize>,
    points: usize,
}

impl Spans {
    /// The points of these stretches, each of a row and its columns. They may overlap.
    pub(super) fn new(rows: usize, mut stretches: Vec<(usize, RangeInclusive<usize>)>) -> Self {
        stretches.retain(|(_, columns)| !columns.is_empty());
        stretches.sort_unstable_by_key(|(row, columns)| (*row, *columns.start()));
        let mut all = Self { spans: Vec::new(), rows: Vec::with_capacity(rows + 1), points: 0 };
        let mut rest = stretches.into_iter().peekable();
        for row in 0..rows {
            all.rows.push(all.spans.len());
            while let Some((_, columns)) = rest.next_if(|(own, _)| *own == row) {
                let (first, mut end) = (*columns.start(), columns.end() + 1);
                while let Some((_, more)) = rest.next_if(|(own, next)| *own == row && *next.start() <= end) {
                    end = end.max(more.end() + 1);
                }
                all.spans.push(RowColumns { first, end, number: all.points });
                all.points += end - first;
            }
        }
        all.rows.push(all.spans.len());
        all
    }

    /// Number of points.
    pub(super) fn len(&self) -> usize {
        self.points
    }

    /// The number of the point in this column and row, if it is one of them.
    pub(super) fn number(&self, column: usize, row: usize) -> Option<usize> {
        let own = &self.spans[*self.rows.get(row)?..*self.rows.get(row + 1)?];
        let span = &own[own.partition_point(|s| s.first <= column).checked_sub(1)?];
        (column < span.end).then(|| span.number + column - span.first)
    }

    /// Columns and rows of all points, in the order of their numbers.
    pub(super) fn places(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let rows = self.rows.windows(2).enumerate();
        rows.flat_map(|(row, w)| {
            self.spans[w[0]..w[1]].iter().flat_map(move |s| (s.first..s.end).map(move |column| (column, row)))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_are_merged_and_their_points_numbered_row_by_row() {
        let empty = RangeInclusive::new(9, 8);
        let stretches = vec![(2, 5..=6), (0, 3..=4), (2, 0..=1), (0, 4..=6), (2, 2..=2), (3, empty)];
        let spans = Spans::new(4, stretches);
        let places: Vec<_> = spans.places().collect();
        assert_eq!(places, [(3, 0), (4, 0), (5, 0), (6, 0), (0, 2), (1, 2), (2, 2), (5, 2), (6, 2)]);
        assert_eq!(spans.len(), places.len());
        assert!(places.iter().enumerate().all(|(k, &(column, row))| spans.number(column, row) == Some(k)));
        let none = [(2, 0), (7, 0), (0, 1), (3, 2), (4, 2), (8, 3), (0, 4)];
        assert!(none.iter().all(|&(column, row)| spans.number(column, row).is_none()));
    }
}
