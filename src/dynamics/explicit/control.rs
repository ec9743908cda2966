//! Settings of the steps.

/// Length of the steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// Constant steps. A particle that goes further than `most` metres in one step ends the run.
    Fixed {
        /// Seconds.
        step: f64,
        /// Metres.
        most: f64,
    },
    /// Steps as long as stability allows (F9).
    Adaptive {
        /// First step, seconds.
        first: f64,
        /// Least step, seconds. With a shorter one the run counts as diverged.
        smallest: f64,
        /// Largest step, seconds.
        largest: f64,
        /// Largest motion of a particle in one step, metres.
        most: f64,
    },
}

impl StepControl {
    pub(super) fn first(&self) -> f64 {
        match *self {
            Self::Fixed { step, .. } => step,
            Self::Adaptive { first, .. } => first,
        }
    }

    pub(super) fn most(&self) -> f64 {
        match *self {
            Self::Fixed { most, .. } | Self::Adaptive { most, .. } => most,
        }
    }

    pub(super) fn is_valid(&self) -> bool {
        let positive = |x: f64| x.is_finite() && x > 0.0;
        match *self {
            Self::Fixed { step, most } => positive(step) && most > 0.0,
            Self::Adaptive { first, smallest, largest, most } => {
                positive(smallest) && positive(largest) && smallest <= first && first <= largest && most > 0.0
            }
        }
    }
}

/// Start of a motion from rest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// (13): X₋ = X₀. A particle then stands still for one step *before* time 0, which shifts the whole motion by half
    /// a step. Convergence is of first order in Δt only. The equilibrium is the same.
    #[default]
    Published,
    /// (11) by the same central difference: X₋ = X₊, so that the velocity at time 0 is zero. Second order, as the
    /// scheme itself.
    Centred,
}
