//! Elastic sewn along a line: a band shorter than the cloth, which gathers to it.
//!
//! The gathers are finer than the grid. So along the line the cloth does not resist being drawn in, only being drawn
//! out beyond its own length, and beside it lies a spring of the band's length, `ratio` × the line's.

use std::collections::HashMap;

use super::springs::StretchLaw;
use crate::geometry::sorted_pair;
use crate::mesh::ClothMesh;
use crate::pattern::LineKind;

/// Pull of the band at twice its length, N: a braided waist elastic of 20 mm. Not measured, as no garment file says
/// what elastic it means.
const BAND: f64 = 12.0;

/// The edges that lie on elastic lines, and their laws.
pub(super) struct Elastics {
    /// Ends (smaller first) → share of the drawn length.
    ratios: HashMap<[u32; 2], f64>,
    /// Index of the band's law.
    band: Option<u32>,
    /// The cloth's law → that of the same cloth in gathers.
    gathered: HashMap<u32, u32>,
}

impl Elastics {
    pub(super) fn new(mesh: &ClothMesh) -> Self {
        let mut ratios = HashMap::new();
        for line in mesh.pieces.iter().flat_map(|p| &p.lines) {
            if let LineKind::Elastic(ratio) = line.kind {
                ratios.extend(line.particles.windows(2).map(|w| (sorted_pair([w[0], w[1]]), ratio)));
            }
        }
        Self { ratios, band: None, gathered: HashMap::new() }
    }

    /// To which share an edge of the mesh is drawn in, if it lies on an elastic line.
    pub(super) fn ratio(&self, ends: [u32; 2]) -> Option<f64> {
        self.ratios.get(&sorted_pair(ends)).copied()
    }

    /// The laws of the cloth in gathers and of the band, added to `laws` where they are missing.
    pub(super) fn laws(&mut self, cloth: u32, laws: &mut Vec<StretchLaw>) -> [u32; 2] {
        let band = *self.band.get_or_insert_with(|| add(laws, StretchLaw::linear(BAND).slack()));
        let gathers = *self.gathered.entry(cloth).or_insert_with(|| {
            let slack = laws[cloth as usize].slack();
            add(laws, slack)
        });
        [gathers, band]
    }
}

/// Index of a law added to the others.
fn add(laws: &mut Vec<StretchLaw>, law: StretchLaw) -> u32 {
    laws.push(law);
    laws.len() as u32 - 1
}
