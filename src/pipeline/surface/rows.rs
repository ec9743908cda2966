//! Many short lists in one piece of memory.

use std::ops::Index;

/// Rows of numbers. A mesh has millions of faces, and a list of its own for each would take three times the room.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    /// Where each row begins, and the end of the last.
    starts: Vec<u32>,
    items: Vec<u32>,
}

impl Rows {
    /// None.
    pub(super) fn new() -> Self {
        Self { starts: vec![0], items: Vec::new() }
    }

    /// Adds a row.
    pub(super) fn push(&mut self, row: impl IntoIterator<Item = u32>) {
        self.items.extend(row);
        self.starts.push(self.items.len() as u32);
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// All, one after another.
    pub(super) fn iter(&self) -> impl Iterator<Item = &[u32]> {
        (0..self.len()).map(|row| &self[row])
    }
}

impl Index<usize> for Rows {
    type Output = [u32];

    fn index(&self, row: usize) -> &[u32] {
        &self.items[self.starts[row] as usize..self.starts[row + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::Rows;

    #[test]
    fn rows_are_what_was_added() {
        let mut rows = Rows::new();
        let added: [&[u32]; 4] = [&[3, 1, 2], &[], &[7], &[5, 5, 5, 5]];
        added.iter().for_each(|row| rows.push(row.iter().copied()));
        assert!(rows.len() == 4 && rows.iter().eq(added));
        assert_eq!(rows[3], [5; 4]);
    }
}
