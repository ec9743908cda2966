//! Errors of a motion.

use super::StepControl;

/// Why a motion cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ExplicitError {
    /// Positions, masses or forces of different numbers of particles.
    #[error("{found} {what} for {particles} particles")]
    Count {
        /// The list of the wrong length.
        what: &'static str,
        /// Number of entries.
        found: usize,
        /// Number of particles.
        particles: usize,
    },
    /// A mass that is not above zero.
    #[error("particle {particle} has mass {mass} kg; it must be above zero (infinite to hold it)")]
    Mass {
        /// The particle.
        particle: usize,
        /// Its mass.
        mass: f64,
    },
    /// A damping below zero or not finite.
    #[error("viscous damping {0} kg/s; it must be zero or more")]
    Damping(f64),
    /// Steps that are no positive times in order.
    #[error("the step control {0:?} is not usable; steps and distances must be above zero, smallest ≤ first ≤ largest")]
    Control(StepControl),
    /// A position or force that is not finite before anything has moved.
    #[error("particle {particle} starts with a position or force that is not finite")]
    BadStart {
        /// The particle.
        particle: usize,
    },
    /// No step is short enough.
    #[error(
        "the motion diverges at {time} s with steps of {step} s (particle {particle}); use shorter steps, more mass or \
         softer springs"
    )]
    Diverged {
        /// When, seconds.
        time: f64,
        /// Length of the last step tried, seconds.
        step: f64,
        /// The particle that went too far or became undefined.
        particle: usize,
    },
}
