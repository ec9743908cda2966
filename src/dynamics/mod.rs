//! The spring-mass cloth that sewing and draping share: masses, springs, bending, and one implicit step.
//!
//! Particles that are sewn together are one *node*. All code here works on nodes.

mod bending;
mod contact_law;
mod cost;
mod crease;
mod curvature;
mod elastic;
pub mod explicit;
mod force;
mod foreseen;
mod friction;
mod links;
mod model;
mod near;
mod newton;
mod part;
mod proximity;
mod shear;
mod springs;
mod step;
mod thread;
mod touching;
mod world;

pub use bending::Bending;
pub use contact_law::{ContactLaw, Hardening};
pub use cost::ContactTime;
pub use force::{Forces, Pull};
pub use friction::{Friction, GRIP};
pub(crate) use model::tacked;
pub use model::{Cloth, Cut, SpringModel, identity_nodes};
pub use part::Resting;
pub use proximity::Reach;
pub use shear::Shear;
pub use springs::{Spring, Stretch, StretchLaw};
pub use step::{StepError, Stepper};
pub use thread::Thread;
pub use world::{NewtonStep, World};
