//! A garment on its way, on a coarser mesh than the one asked for, for those who watch.

use super::error::PipelineError;
use super::job::Job;
use crate::geometry::Vec3;
use crate::mesh::ClothMesh;
use crate::picture::{Dressed, PictureLayout, draw};

/// How far a garment on its way has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reached {
    /// It is put round the body, nothing is sewn yet. Its cloth has no strains that mean anything.
    Begun,
    /// Its seams are closed.
    Sewn,
    /// It hangs.
    Draped,
}

/// A garment on a coarser mesh.
#[derive(Clone, Copy, Debug)]
pub struct Glimpse<'a> {
    /// The coarser mesh.
    pub mesh: &'a ClothMesh,
    /// One label per particle, the same for particles that are sewn together.
    pub class: &'a [u32],
    /// Position of every particle, metres.
    pub at: &'a [Vec3],
    /// How far it has come.
    pub reached: Reached,
}

/// Told of the garment before it is sewn, where its start is clear, then of every coarser level once it is sewn, and
/// again once it is draped, the coarsest first.
pub type Watch<'a> = &'a dyn Fn(&Glimpse);

impl Job {
    /// Draws a glimpse in the colours of the pieces, as PNG. It has half the width and height of `layout`, and at least
    /// [`PictureLayout::SMALLEST`]: it is soon replaced, and costs a quarter.
    ///
    /// # Errors
    /// When it cannot be drawn.
    pub fn draw_glimpse(&self, glimpse: &Glimpse, layout: &PictureLayout) -> Result<Vec<u8>, PipelineError> {
        let half = [0, 1].map(|k| (layout.size[k] / 2).max(PictureLayout::SMALLEST[k]));
        let layout = PictureLayout { size: half, ..layout.clone() };
        let dressed = Dressed::new(glimpse.mesh, glimpse.class, glimpse.at, None);
        Ok(draw(&dressed.scene(&self.body.mesh, &self.garment.title, &self.subtitle()), &layout)?)
    }
}
