//! A garment on its way as binary glTF, for a page that shows it while it is made.

use super::glimpse::{Glimpse, Reached};
use super::job::Job;
use super::run::Run;
use crate::dynamics::identity_nodes;
use crate::geometry::MM;
use crate::io::glb_write::{garment_glb, surface_glb};
use crate::report::thread_strains;
use crate::verify::distances;

impl Job {
    /// The body's surface, in the place of its file.
    pub fn body_glb(&self) -> Vec<u8> {
        surface_glb(&self.body.name, &self.body.mesh, |p| self.body.frame.to_file(p))
    }

    /// A glimpse with the maps that are known then: strains, shear and ease, and none before it is sewn.
    pub fn glimpse_glb(&self, glimpse: &Glimpse) -> Vec<u8> {
        let at: Vec<_> = glimpse.at.iter().map(|p| self.body.frame.to_file(*p)).collect();
        if glimpse.reached == Reached::Begun {
            return garment_glb(&self.garment, glimpse.mesh, glimpse.class, &at, &[], &self.gives());
        }
        let strains = thread_strains(glimpse.mesh, glimpse.at);
        let strain = |k: usize| strains.iter().map(|values| values[k]).collect::<Vec<f64>>();
        let ease = distances(glimpse.at, &self.body.mesh).into_iter().map(|far| far * MM).collect();
        let maps = [("_STRAIN_WARP", strain(0)), ("_STRAIN_WEFT", strain(1)), ("_SHEAR", strain(2)), ("_EASE", ease)];
        garment_glb(&self.garment, glimpse.mesh, glimpse.class, &at, &maps, &self.gives())
    }

    /// Largest strains of the fabric of every piece along warp and weft.
    fn gives(&self) -> Vec<[f64; 2]> {
        self.fabrics.iter().map(|fabric| fabric.emt()).collect()
    }
}

impl Run<'_> {
    /// Whether it hangs where an earlier garment does, and has not been draped since.
    pub fn is_carried(&self) -> bool {
        self.hanging.is_some()
    }

    /// The draped garment as [`GARMENT_OBJ`](super::GARMENT_OBJ) has it. `None` before it is draped.
    pub fn garment_obj(&self) -> Option<Vec<u8>> {
        self.draped.as_ref().map(|draped| self.obj(draped, &self.class()))
    }

    /// The garment as it is now with its maps, or where an earlier one hangs, or its pieces as they were placed. `None`
    /// before that.
    pub fn surface(&self) -> Option<Vec<u8>> {
        let hanging = self.hanging.as_ref().map(|nodes| self.stitching.spread(nodes));
        let joined = self.last().or(hanging.as_deref());
        let at = joined.or(self.placed.as_deref())?;
        let Job { garment, mesh, .. } = self.job;
        // Pieces that are only placed are not joined yet.
        let alone = joined.is_none().then(|| identity_nodes(mesh));
        let class = alone.map_or_else(|| self.class(), Into::into);
        Some(garment_glb(garment, mesh, &class, &self.in_file(at), &self.maps(at), &self.job.gives()))
    }
}
