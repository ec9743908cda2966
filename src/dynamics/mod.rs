//! The spring-mass cloth that sewing and draping share: masses, springs, bending, and one implicit step.
//!
//! Particles that are sewn together are one *node*. All code here works on nodes.

mod bending;
mod contact_law;
mod cost;
mod crease;
mod curvature;
mod cut_by_body;
#[cfg(test)]
mod derivatives;
mod descent;
mod elastic;
mod elasticity;
mod element;
mod elements;
mod energy;
pub mod explicit;
mod force;
mod friction;
mod links;
mod membrane;
mod model;
mod near;
mod newton;
mod part;
mod proximity;
mod pull;
mod scattered;
mod seam_rest;
mod shear;
mod spring;
mod step;
mod stretch;
mod thread;
mod touching;
mod weight;
mod world;

pub use bending::Bending;
pub use contact_law::{ContactLaw, Hardening};
pub use cost::ContactTime;
pub use descent::NewtonStep;
pub use elasticity::Elasticity;
pub use elements::Elements;
pub use force::Forces;
pub use friction::{Friction, GRIP};
pub use membrane::Membrane;
pub(crate) use model::tacked;
pub use model::{Cloth, Cut, SpringModel, identity_nodes};
pub use part::Resting;
pub use proximity::Reach;
pub use pull::Pull;
pub use shear::Shear;
pub use spring::Spring;
pub use step::{StepError, Stepper};
pub use stretch::{Stretch, StretchLaw};
pub use thread::Thread;
pub use world::World;
