//! What the user decides about the steps.

/// How long the steps are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepControl {
    /// Always the same, seconds. A particle that goes further than `most` metres in one step ends the run.
    Fixed {
        /// Seconds.
        step: f64,
        /// Metres.
        most: f64,
    },
    /// As long as stability allows (F9).
    Adaptive {
        /// The first, seconds.
        first: f64,
        /// Below this the run has diverged, seconds.
        smallest: f64,
        /// Never above this, seconds.
        largest: f64,
        /// No particle may go further in one step, metres.
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

/// How a motion from rest begins.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// (13): X₋ = X₀. A particle then stands still for one step *before* time 0, which puts the whole motion half a
    /// step ahead: convergence is of first order in Δt only. The equilibrium is not concerned.
    #[default]
    Published,
    /// (11) by the same central difference: X₋ = X₊, no velocity at time 0. Second order, as the scheme itself.
    Centred,
}
