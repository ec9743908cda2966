//! Disjoint sets of numbered members (union–find).

/// A partition of 0 … n − 1 that can only grow coarser. The smallest member leads its set, so that numbering by leaders
/// does not depend on the order of the joins.
#[derive(Clone, Debug, Default)]
pub(crate) struct DisjointSets {
    /// For every member a member of its set with a smaller number, or itself for a leader.
    parent: Vec<u32>,
}

impl DisjointSets {
    /// Every member in a set of its own.
    pub(crate) fn new(members: usize) -> Self {
        Self { parent: (0..members as u32).collect() }
    }

    /// Adds a member in a set of its own. Returns its number.
    pub(crate) fn add(&mut self) -> u32 {
        let member = self.parent.len() as u32;
        self.parent.push(member);
        member
    }

    /// Number of members.
    pub(crate) fn len(&self) -> usize {
        self.parent.len()
    }

    /// The smallest member of the set of `member`.
    pub(crate) fn root(&mut self, mut member: u32) -> u32 {
        while self.parent(member) != member {
            // Path halving shortens later queries.
            let above = self.parent(self.parent(member));
            self.parent[member as usize] = above;
            member = above;
        }
        member
    }

    /// Joins the sets of `a` and `b`. Returns whether they were different.
    pub(crate) fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// Whether `a` and `b` are in one set. It shortens no paths. [`DisjointSets::root`] does.
    pub(crate) fn same(&self, a: u32, b: u32) -> bool {
        self.leader(a) == self.leader(b)
    }

    fn leader(&self, mut member: u32) -> u32 {
        while self.parent(member) != member {
            member = self.parent(member);
        }
        member
    }

    fn parent(&self, member: u32) -> u32 {
        self.parent[member as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn members_begin_alone_and_are_joined_once() {
        let mut sets = DisjointSets::new(4);
        assert!((0..4).all(|k| sets.root(k) == k));
        assert!(sets.join(1, 3) && !sets.join(3, 1));
        assert!(sets.same(1, 3) && !sets.same(0, 3));
        assert_eq!(sets.add(), 4);
        assert!(sets.join(4, 3) && sets.same(1, 4));
        assert_eq!(sets.len(), 5);
    }

    #[test]
    fn the_smallest_member_leads_whatever_the_order() {
        let pairs = [[5, 7], [2, 7], [6, 3], [5, 6], [1, 4]];
        for turn in 0..pairs.len() {
            let mut sets = DisjointSets::new(8);
            let mut pairs = pairs;
            pairs.rotate_left(turn);
            pairs.iter().for_each(|&[a, b]| _ = sets.join(b, a));
            let leaders: Vec<u32> = (0..8).map(|k| sets.root(k)).collect();
            assert_eq!(leaders, [0, 1, 2, 2, 1, 2, 2, 2], "from pair {turn}");
        }
    }

    #[test]
    fn a_long_chain_is_short_once_it_was_walked() {
        let count = 1 << 16;
        let mut sets = DisjointSets::new(count as usize);
        // The longest way there can be: every join puts one more member on top.
        (1..count).rev().for_each(|k| _ = sets.join(k - 1, k));
        let steps = |sets: &DisjointSets| {
            let way = std::iter::successors(Some(count - 1), |&k| (sets.parent(k) != k).then(|| sets.parent(k)));
            way.count() - 1
        };
        let before = steps(&sets);
        assert_eq!(sets.root(count - 1), 0);
        assert!(steps(&sets) <= before.div_ceil(2), "{before}");
    }
}
