//! A test bench: virtual specimens of a fabric are hung, bent, pulled, sheared and draped, with the mesh, springs,
//! bending and steps that `make` uses for garments. The results are compared with known answers.
//!
//! ```text
//! Fabric ─▶ rig (a sheet in its clamps) ─▶ bending · stretching · shearing · cusick · hand ─▶ Figure
//!                                               ▲ theory, membrane (the known answers)
//! ```

mod bending;
mod cusick;
mod hand;
mod membrane;
mod rig;
mod shearing;
mod stretching;
mod theory;

use std::sync::Arc;

pub use bending::cantilever_error;
pub use cusick::{DrapedDisc, LAYS, Lay, Series, Shadow, drape};

use crate::dynamics::StepError;
use crate::fabric::Fabric;
use crate::mesh::MeshError;

/// Known value of a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// A value by theory, and the share of it that a measured one may be off.
    Value {
        /// In the figure's unit.
        value: f64,
        /// Share of the value.
        tolerance: f64,
    },
    /// A band of published measurements, for comparison: nothing is computed from it.
    Band([f64; 2]),
    /// Nothing.
    Nothing,
}

/// One figure of one test.
#[derive(Clone, Debug, PartialEq)]
pub struct BenchFigure {
    /// The test.
    pub test: &'static str,
    /// The measured quantity and state.
    pub what: String,
    /// Unit, empty for a ratio.
    pub unit: &'static str,
    /// The specimen's.
    pub measured: f64,
    /// The value it should have.
    pub known: Known,
}

impl BenchFigure {
    /// Share by which the measured value is off a known one.
    pub fn error(&self) -> Option<f64> {
        match self.known {
            Known::Value { value, .. } => Some(self.measured / value - 1.0),
            Known::Band(_) | Known::Nothing => None,
        }
    }

    /// Whether it is as near to a known value as it should be. `None` where there is none.
    pub fn holds(&self) -> Option<bool> {
        match self.known {
            Known::Value { value, tolerance } => Some((self.measured / value - 1.0).abs() <= tolerance),
            Known::Band(_) | Known::Nothing => None,
        }
    }
}

/// Why a specimen could not be tested.
#[derive(Debug, thiserror::Error)]
pub enum SpecimenError {
    /// It could not be meshed.
    #[error("a specimen cannot be meshed: {0}")]
    Mesh(#[from] MeshError),
    /// A step could not be made.
    #[error("a specimen cannot be moved: {0}")]
    Step(#[from] StepError),
    /// It did not come to rest.
    #[error("a specimen still moves by {:.2e} mm after {steps} steps", 1e3 * moved)]
    Unrest {
        /// Steps made.
        steps: usize,
        /// Metres in the last ten of them.
        moved: f64,
    },
    /// A load that it does not reach.
    #[error("a specimen drawn out by {:.0} % does not hold {load} N", 100.0 * strain)]
    Soft {
        /// Share of its length.
        strain: f64,
        /// N.
        load: f64,
    },
    /// Its stiffnesses differ by more than numbers can tell.
    #[error("the stiffnesses of this fabric differ too much from one another")]
    Extreme,
    /// The objects round it could not be built.
    #[error("the test bench itself cannot be built")]
    Bench,
}

/// Material of the specimens.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The fabric.
    pub fabric: Arc<Fabric>,
    /// Drape coefficients that were measured of such cloths, per cent.
    pub drape: Option<[f64; 2]>,
    /// Recovery, stretch and bend as Liu, Wang & Luo 2015 measured them, ratios.
    pub published: Option<[f64; 3]>,
}

/// A test of the bench.
#[derive(Clone, Copy, Debug)]
pub struct BenchTest {
    /// As [`BenchFigure::test`] has it.
    pub name: &'static str,
    run: fn(&Sample) -> Result<Outcome, SpecimenError>,
}

/// Result of a test.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Its figures.
    pub figures: Vec<BenchFigure>,
    /// The draped disc nearest to the mean of its lays, of the drape test.
    pub draped: Option<DrapedDisc>,
}

impl From<Vec<BenchFigure>> for Outcome {
    fn from(figures: Vec<BenchFigure>) -> Self {
        Self { figures, draped: None }
    }
}

/// Every test, in the order of a report.
pub const TESTS: [BenchTest; 12] = [
    BenchTest { name: "cantilever", run: bending::cantilever },
    BenchTest { name: "bending length", run: bending::bending_length },
    BenchTest { name: "standing strip", run: bending::standing },
    BenchTest { name: "strip on edge", run: bending::on_edge },
    BenchTest { name: "roll", run: bending::roll },
    BenchTest { name: "pulled strip", run: stretching::pulled },
    BenchTest { name: "hanging strip", run: stretching::hanging },
    BenchTest { name: "catenary", run: stretching::between_hooks },
    BenchTest { name: "picture frame", run: shearing::picture_frame },
    BenchTest { name: "bias extension", run: shearing::bias_extension },
    BenchTest { name: "drape", run: cusick::cusick },
    BenchTest { name: "hand tests", run: hand::measurements },
];

impl BenchTest {
    /// Tests specimens of `sample`.
    ///
    /// # Errors
    /// [`SpecimenError`] for a fabric so far from cloth that no specimen of it can be meshed or comes to rest.
    pub fn run(&self, sample: &Sample) -> Result<Outcome, SpecimenError> {
        (self.run)(sample)
    }
}
