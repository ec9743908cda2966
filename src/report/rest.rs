//! Which stages did not come to rest.

use serde::Serialize;

use super::schema::Stage;

/// A stage that ran out of steps before the cloth was still: its figures are those of a garment on its way.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Restless {
    /// The stage.
    pub stage: String,
    /// Steps it made.
    pub steps: usize,
    /// How far the garment went in as many steps again, mm (root mean square), where that was measured.
    pub drift: Option<f64>,
    /// How far its forces were out of balance, in particle weights (root mean square), where that was measured.
    pub residual: Option<f64>,
}

impl std::fmt::Display for Restless {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} did not come to rest in {} steps", self.stage, self.steps)?;
        let drift = self.drift.map(|drift| format!("still drifts by {drift:.3} mm"));
        let residual = self.residual.map(|weights| format!("is out of balance by {weights:.1} particle weights"));
        let why: Vec<String> = drift.into_iter().chain(residual).collect();
        if why.is_empty() { Ok(()) } else { write!(f, " (it {})", why.join(" and ")) }
    }
}

/// The stages that ended before the cloth was still, in their order.
pub fn restless(stages: &[Stage]) -> Vec<Restless> {
    let of = |s: &Stage| Restless {
        stage: s.name.clone(),
        steps: s.iterations,
        drift: s.drift.map(|d| d.rms),
        residual: s.residual,
    };
    stages.iter().filter(|s| !s.converged).map(of).collect()
}
