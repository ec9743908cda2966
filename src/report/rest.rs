//! Stages that did not come to rest.

use serde::Serialize;

use super::schema::Stage;

/// Bounds of rest.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AtRest {
    /// Drift over as many steps again, mm (root mean square).
    pub drift: f64,
    /// Forces out of balance, in particle weights (root mean square).
    pub residual: f64,
}

/// A stage that ran out of steps before the cloth was still: its figures are those of a garment on its way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Restless {
    /// The stage.
    pub stage: String,
    /// Steps it made.
    pub steps: usize,
    /// Drift: RMS motion in as many steps again, mm, if it was measured.
    pub drift: Option<f64>,
    /// Unbalanced force, RMS, in particle weights, if it was measured.
    pub residual: Option<f64>,
    /// The bounds of both.
    pub at_rest: AtRest,
}

impl std::fmt::Display for Restless {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} did not come to rest in {} steps", self.stage, self.steps)?;
        let AtRest { drift: still, residual: balanced } = self.at_rest;
        let drift = self.drift.map(|drift| format!("still drifts by {drift:.3} mm, at rest by {still} or less"));
        let residual = self.residual.map(|weights| {
            format!("is out of balance by {weights:.1} particle weights, at rest by {balanced} or less")
        });
        let why: Vec<String> = drift.into_iter().chain(residual).collect();
        if why.is_empty() { Ok(()) } else { write!(f, " (it {})", why.join("; it ")) }
    }
}

/// The stages that ended before the cloth was still, in their order.
pub fn restless(stages: &[Stage], at_rest: AtRest) -> Vec<Restless> {
    let of = |s: &Stage| Restless {
        stage: s.name.clone(),
        steps: s.iterations,
        drift: s.drift.map(|d| d.rms),
        residual: s.residual,
        at_rest,
    };
    stages.iter().filter(|s| !s.converged).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_at_rest_is_said_beside_what_would_be() {
        let mut stage = Restless {
            stage: "drape".into(),
            steps: 600,
            drift: Some(0.5124),
            residual: Some(1.3),
            at_rest: AtRest { drift: 0.3, residual: 1.0 },
        };
        let said = "drape did not come to rest in 600 steps (it still drifts by 0.512 mm, at rest by 0.3 or less; \
                    it is out of balance by 1.3 particle weights, at rest by 1 or less)";
        assert_eq!(stage.to_string(), said);
        (stage.drift, stage.residual) = (None, None);
        assert_eq!(stage.to_string(), "drape did not come to rest in 600 steps");
    }
}
