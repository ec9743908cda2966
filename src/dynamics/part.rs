//! Partial solves: steps of an active set of nodes while the rest is held.
//!
//! Near rest a garment moves in one or two folds, by millimetres, and hardly anywhere else. Steps of the nodes there
//! treat the other nodes as walls. Their cost is that of the active set, because forces and contacts between held nodes
//! are set aside.

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
        cloth.take_turns_of(&self.cloth, &was_held);
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

impl Cloth {
    /// The cloth with all nodes held except the `free` ones, and without forces between held nodes.
    fn around(&self, free: &[bool]) -> Self {
        let mut is_held = self.is_held();
        is_held.iter_mut().zip(free).for_each(|(held, free)| *held |= !free);
        let moves = |nodes: &[u32]| nodes.iter().any(|&n| !is_held[n as usize]);
        let springs: Vec<bool> = self.springs.iter().map(|s| moves(&s.ends)).collect();
        let threads: Vec<bool> = self.threads.iter().map(|t| moves(&t.nodes)).collect();
        let shears: Vec<bool> = self.shears.iter().map(|s| moves(&s.nodes)).collect();
        Self {
            springs: those(&self.springs, &springs),
            threads: those(&self.threads, &threads),
            shears: those(&self.shears, &shears),
            creases: self.creases.iter().filter(|c| moves(&c.nodes)).copied().collect(),
            bending: self.bending.around(&is_held),
            held: (0..is_held.len() as u32).filter(|&n| is_held[n as usize]).collect(),
            foreseen: self.foreseen.of(&[springs, threads, shears].concat()),
            ..self.clone()
        }
    }

    /// Copies the angles of creases that moved in `part`, where the nodes of `is_held` were held.
    fn take_turns_of(&mut self, part: &Self, is_held: &[bool]) {
        let moved = self.creases.iter_mut().filter(|c| c.nodes.iter().any(|&n| !is_held[n as usize]));
        moved.zip(&part.creases).for_each(|(whole, part)| *whole = *part);
    }
}

/// The items that are wanted.
pub(super) fn those<T: Clone>(items: &[T], wanted: &[bool]) -> Vec<T> {
    items.iter().zip(wanted).filter(|(_, wanted)| **wanted).map(|(item, _)| item.clone()).collect()
}
