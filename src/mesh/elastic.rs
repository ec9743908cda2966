//! Edges of a mesh that elastic draws in.

use std::collections::{HashMap, HashSet};

use super::ClothMesh;
use crate::geometry::sorted_pair;
use crate::pattern::LineKind;

/// An edge of a mesh along elastic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawnIn {
    /// Length under elastic as a share of the drawn length.
    pub ratio: f64,
    /// Whether the elastic lies on this edge. Otherwise the edge is sewn to one with elastic, and gathers with it.
    pub band: bool,
}

impl ClothMesh {
    /// The edges along elastic by their ends, smaller first.
    pub fn drawn_in(&self) -> HashMap<[u32; 2], DrawnIn> {
        let mut drawn = HashMap::new();
        for line in self.pieces.iter().flat_map(|p| &p.lines) {
            if let LineKind::Elastic(ratio) = line.kind {
                let edges = line.particles.windows(2).map(|w| sorted_pair([w[0], w[1]]));
                drawn.extend(edges.map(|ends| (ends, DrawnIn { ratio, band: true })));
            }
        }
        while !drawn.is_empty() && self.pass_on(&mut drawn) {}
        drawn
    }

    /// Marks edges that are sewn to edges along elastic as gathered with them. Returns whether there was a new one.
    fn pass_on(&self, drawn: &mut HashMap<[u32; 2], DrawnIn>) -> bool {
        let before = drawn.len();
        for step in self.seams.iter().flat_map(|s| s.pairs.windows(2)) {
            let [a, b] = [0, 1].map(|side| sorted_pair([step[0][side], step[1][side]]));
            for (from, to) in [(a, b), (b, a)] {
                if let Some(&DrawnIn { ratio, .. }) = drawn.get(&from)
                    && to[0] != to[1]
                {
                    drawn.entry(to).or_insert(DrawnIn { ratio, band: false });
                }
            }
        }
        drawn.len() > before
    }

    /// Particles that lie on edges along elastic.
    pub fn on_elastic(&self) -> HashSet<u32> {
        self.drawn_in().into_keys().flatten().collect()
    }
}
