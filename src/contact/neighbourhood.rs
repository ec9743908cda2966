//! Nodes that belong together by construction, and therefore make no contact.

/// Pairs that are neighbours by construction and therefore no contacts.
#[derive(Clone, Debug, Default)]
pub struct Neighbourhood {
    /// Node → class of nodes that are, or will be, sewn together. Primitives that share a class are incident.
    pub class: Vec<u32>,
    /// Node → whether it may pass through other such nodes. Pairs of primitives with such nodes on both sides are left
    /// out.
    pub passing: Vec<bool>,
}

impl Neighbourhood {
    /// Whether nodes `p` and `q` (of two primitives) are sewn together or may pass through one another.
    pub(super) fn joins(&self, p: &[u32], q: &[u32]) -> bool {
        let passing = |n: &u32| self.passing.get(*n as usize).copied().unwrap_or(false);
        if p.iter().any(passing) && q.iter().any(passing) {
            return true;
        }
        p.iter().any(|&a| q.iter().any(|&b| self.class[a as usize] == self.class[b as usize]))
    }
}
