//! The first look at a garment, before it is sewn: its surface blown up round the body on a very coarse mesh.

use super::glimpse::{Glimpse, Reached, Watch};
use super::job::Job;
use crate::mesh;
use crate::sew::Stitching;
use crate::sew::place::positioned;
use crate::sew::start::start_on;

/// Spacings of the meshes on which a garment is first looked at, metres: on the next where the first gives no start,
/// as of a garment with narrow parts. At 50 mm a T-shirt costs a sixth of its start at 25 mm.
const SPACINGS: [f64; 2] = [0.050, 0.035];

impl Job {
    /// Shows `watch` how the garment starts, on the body as it stands. Nothing that comes later depends on it. A
    /// garment that has no start, or whose file says where its pieces are, is not shown.
    pub(super) fn look_first(&self, watch: Watch) {
        for spacing in SPACINGS.into_iter().filter(|spacing| *spacing > self.mesh.spacing) {
            let Ok(mesh) = mesh::build(&self.garment, spacing) else { continue };
            if positioned(&self.garment, &mesh).is_some() {
                return;
            }
            let Ok(at) = start_on(&mesh, &self.garment, &mesh, &self.body, &self.collider) else { continue };
            let stitching = Stitching::new(&mesh);
            let at = stitching.spread(&stitching.welded(&at));
            return watch(&Glimpse { mesh: &mesh, class: &stitching.class, at: &at, reached: Reached::Begun });
        }
    }
}
