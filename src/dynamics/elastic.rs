//! Elastic sewn along a line: a band shorter than the cloth, which gathers to it.
//!
//! The gathers are finer than the grid. So the cloth along the line does not resist compression, only extension beyond
//! its own length. Beside it lies a spring of the band's length, `ratio` × the line's. Cloth that is sewn to an edge
//! with elastic gathers with it.

use std::collections::HashMap;

use super::stretch::StretchLaw;
use crate::geometry::sorted_pair;
use crate::mesh::{ClothMesh, DrawnIn};

/// Pull of the elastic at twice its length, N: a braided waist elastic of 20 mm. Estimated, because a garment file does
/// not say which elastic it means.
const BAND: f64 = 12.0;

/// The edges that lie on elastic lines, and their laws.
pub(super) struct Elastics {
    /// Edge (smaller end first) → how elastic draws it in.
    drawn_in: HashMap<[u32; 2], DrawnIn>,
    /// Index of the band's law.
    band: Option<u32>,
    /// Index of a cloth's law → index of the law of the same cloth in gathers.
    gathered: HashMap<u32, u32>,
}

impl Elastics {
    pub(super) fn new(mesh: &ClothMesh) -> Self {
        Self { drawn_in: mesh.drawn_in(), band: None, gathered: HashMap::new() }
    }

    /// Elastic along an edge of the mesh, if there is any.
    pub(super) fn on(&self, ends: [u32; 2]) -> Option<DrawnIn> {
        self.drawn_in.get(&sorted_pair(ends)).copied()
    }

    /// The law of the band, added to `laws` if it is missing.
    pub(super) fn band(&mut self, laws: &mut Vec<StretchLaw>) -> u32 {
        *self.band.get_or_insert_with(|| add(laws, StretchLaw::linear(BAND).slack()))
    }

    /// The law of cloth in gathers, added to `laws` if it is missing.
    pub(super) fn gathers(&mut self, cloth: u32, laws: &mut Vec<StretchLaw>) -> u32 {
        *self.gathered.entry(cloth).or_insert_with(|| {
            let slack = laws[cloth as usize].slack();
            add(laws, slack)
        })
    }
}

/// Index of a law added to the others.
fn add(laws: &mut Vec<StretchLaw>, law: StretchLaw) -> u32 {
    laws.push(law);
    laws.len() as u32 - 1
}
