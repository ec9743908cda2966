//! A body whose limbs nearly touch is sewn on as if it stood with them apart, and takes its own stance again under the
//! cloth.

mod back;
mod limbs;
mod spread;

use super::close::{SewOptions, Sewn, sew};
use super::error::SewError;
use super::settle::{Calm, come_out, settle, sewn_world};
use super::start::goes_between_legs;
use crate::contact::Collider;
use crate::dynamics::Cut;
use crate::geometry::{TriMesh, Vec3};
use crate::mannequin::{LimbSpread, Mannequin, PartKind};
use crate::pattern::Garment;
use back::Carrier;
use spread::spreads;

/// Share of the progress that sewing is; the rest is the way back.
const SEWN: f64 = 0.6;

/// A body with its limbs apart.
pub struct Stance {
    /// The body so, for placing pieces round it.
    pub body: Mannequin,
    /// Its surface, as cloth touches it.
    pub collider: Collider,
    /// The surface as it is.
    own: TriMesh,
    spreads: Vec<LimbSpread>,
}

/// The body that pieces are placed round and sewn on, and what cloth can touch of it: in its stance, if it has one for
/// that, or as it is.
pub fn sewn_on<'a>(
    stance: Option<&'a Stance>,
    body: &'a Mannequin,
    collider: &'a Collider,
) -> (&'a Mannequin, &'a Collider) {
    stance.map_or((body, collider), |stance| (&stance.body, &stance.collider))
}

impl Stance {
    /// `body` with its limbs apart, the legs only for a garment that goes between them: a narrow skirt may fit legs as
    /// they stand and no others. `None` where limbs are far enough apart as it stands, and for what is nobody.
    pub fn of(body: &Mannequin, garment: &Garment) -> Option<Self> {
        if body.parts.is_empty() {
            return None;
        }
        let spreads = spreads(body, || goes_between_legs(garment, body));
        if spreads.is_empty() {
            return None;
        }
        let mesh = moved(&body.mesh, &spreads, 1.0);
        let collider = Collider::new(&mesh)?.on_floor(body.floor());
        let mut parts = body.parts.clone();
        spreads.iter().for_each(|spread| spread.apply_to_part(&mut parts));
        let apart = Mannequin { name: body.name.clone(), mesh, parts, frame: body.frame };
        Some(Self { body: apart, collider, own: body.mesh.clone(), spreads })
    }

    /// The limbs that stand elsewhere.
    pub fn limbs(&self) -> impl Iterator<Item = PartKind> {
        self.spreads.iter().map(|spread| spread.kind)
    }

    /// Sews a garment whose particles start at `start` on the body with its limbs apart, and lets these go back to
    /// where they are on `body`.
    ///
    /// # Errors
    /// As [`sew`].
    pub fn sew(
        &self,
        cut: &Cut,
        body: &Collider,
        start: Vec<Vec3>,
        options: &SewOptions,
        progress: &mut dyn FnMut(f64),
    ) -> Result<Sewn, SewError> {
        let mut sewn = sew(cut, &self.collider, start, options, &mut |share| progress(SEWN * share))?;
        if sewn.open.is_some() {
            return Ok(sewn);
        }
        let no_solid = || SewError::Body(self.body.name.clone());
        let carrier = Carrier::new(&self.body.mesh, &self.spreads, &sewn.nodes).ok_or_else(no_solid)?;
        let stops = carrier.stops(&sewn.nodes);
        let mut last = 1.0;
        for (k, &share) in stops.iter().enumerate() {
            let stage = Collider::new(&moved(&self.own, &self.spreads, share));
            let stage = stage.ok_or_else(no_solid)?.on_floor(body.floor());
            let mut world = sewn_world(cut, &stage, &sewn.stitching, sewn.nodes)?;
            // What is under the skin when the limb goes on may come out on its other side.
            sewn.steps += carrier.carry(&mut world, share - last)? + come_out(&mut world)?;
            (sewn.nodes, last) = (world.into_x(), share);
            progress(SEWN + (1.0 - SEWN) * (k + 1) as f64 / (stops.len() + 1) as f64);
        }
        let mut world = sewn_world(cut, body, &sewn.stitching, sewn.nodes)?;
        sewn.steps += carrier.carry(&mut world, -last)?;
        let (steps, tangles) = settle(&mut world, Calm::TO_FALL, &mut || progress(1.0))?;
        let is_cut = world.is_cut();
        Ok(Sewn { nodes: world.into_x(), tangles, is_cut, steps: sewn.steps + steps, ..sewn })
    }
}

/// `mesh` with its limbs moved by a share of their spread.
fn moved(mesh: &TriMesh, spreads: &[LimbSpread], share: f64) -> TriMesh {
    let mut mesh = mesh.clone();
    spreads.iter().for_each(|spread| spread.apply(&mut mesh, share));
    mesh
}
