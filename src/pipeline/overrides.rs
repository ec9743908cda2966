//! Choices of the caller that replace those of a garment file.

use std::sync::Arc;

use crate::fabric::Fabric;
use crate::input::LengthUnit;
use crate::io::body::Body;
use crate::io::garment::Variant;
use crate::mannequin::Measures;
use crate::report::Bands;

/// Spacing when none is asked for, metres.
pub(super) const SPACING: f64 = 0.010;

/// The caller's choices that replace those of the file.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Mesh spacing, metres.
    pub spacing: Option<f64>,
    /// Library name or `.yaml` file in place of the garment's main fabric: the one most of its cloth is cut from.
    pub fabric: Option<String>,
    /// Mannequin name, or a `.yaml` or `.obj` file, in place of the garment's body.
    pub body: Option<String>,
    /// Unit of the body's `.obj` file, in place of the garment file's or a guess from its size.
    pub body_unit: Option<LengthUnit>,
    /// Limits of the bands of pressure.
    pub bands: Option<Bands>,
    /// A size of the garment.
    pub size: Option<String>,
    /// Alterations that follow those of the file and the size, as texts: [`Variant::alter`].
    pub alter: Vec<String>,
    /// Measures of the wearer. They go before those of the garment file.
    pub measures: Measures,
    /// A body and a fabric that are not to be loaded.
    pub given: Given,
}

/// A body and a fabric that the caller has. Their names in [`Overrides`], if any, are for messages.
#[derive(Clone, Debug, Default)]
pub struct Given {
    /// The body, in place of the one of the garment.
    pub body: Option<Arc<Body>>,
    /// The fabric, in place of the main one of the garment.
    pub fabric: Option<Arc<Fabric>>,
}

impl Overrides {
    /// The variant of the garment file that is wanted.
    pub fn variant(&self) -> Variant<'_> {
        Variant { size: self.size.as_deref(), alter: &self.alter }
    }
}
