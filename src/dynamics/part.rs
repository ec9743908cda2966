//! Partial solves: steps of an active set of nodes while the rest is held.
//!
//! Near rest a garment moves in one or two folds, by millimetres, and hardly anywhere else. Steps of the nodes there
//! treat the other nodes as walls. Their cost is that of the active set, because forces and contacts between held nodes
//! are set aside.

use super::energy::Elastic;
use super::friction::Remembered;
use super::model::Cloth;
use super::near::Aside;
use super::step::{StepError, Stepper};
use super::world::World;

/// State that is set aside during a partial solve.
pub struct Resting<'a> {
    /// The cloth with all of its forces.
    cloth: Cloth,
    stepper: Stepper,
    touching: Option<Vec<[u32; 2]>>,
    /// Contacts between nodes that are held.
    contacts: Aside<'a>,
    friction: Option<Remembered>,
}

impl<'a> World<'a> {
    /// Holds all nodes except those that are `free` and were free before, until [`World::release`].
    ///
    /// # Errors
    /// As [`Stepper::new`].
    pub fn hold_all_but(&mut self, free: &[bool]) -> Result<Resting<'a>, StepError> {
        // Held nodes are not searched, so they must be up to date.
        self.detect()?;
        let cloth = self.cloth.around(free);
        let cloth = std::mem::replace(&mut self.cloth, cloth);
        let contacts = self.proximity.hold(&self.cloth, &self.x);
        let friction = self.friction.as_mut().map(|friction| {
            let remembered = friction.remembered(contacts.contacts());
            friction.detected(self.proximity.near());
            remembered
        });
        let touching = self.touching.clone();
        let stepper = Stepper::new(&self.cloth, &[], touching.as_deref().unwrap_or_default())?;
        let stepper = std::mem::replace(&mut self.stepper, stepper);
        // Its energy is another one now.
        self.gains.clear();
        Ok(Resting { cloth, stepper, touching, contacts, friction })
    }

    /// Ends a partial solve. Several nested ones end in reverse order.
    ///
    /// # Errors
    /// As [`World::detect`].
    pub fn release(&mut self, resting: Resting<'a>) -> Result<(), StepError> {
        let Resting { mut cloth, stepper, touching, contacts, friction } = resting;
        let was_held = self.cloth.is_held();
        cloth.elastic.take_back(&self.cloth.elastic, &was_held);
        (self.cloth, self.stepper, self.touching) = (cloth, stepper, touching);
        self.stepper.forget();
        self.proximity.release(&self.cloth, &self.x, contacts);
        if let (Some(friction), Some(remembered)) = (&mut self.friction, friction) {
            friction.remember(remembered, &was_held);
            friction.detected(self.proximity.near());
        }
        self.detect()
    }
}
