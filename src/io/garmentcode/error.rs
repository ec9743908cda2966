//! Why a specification cannot be imported.

/// A fault of a GarmentCode specification. Panels and edges are called as in the file; edges and stitches count
/// from 0 as there.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ImportError {
    /// No JSON, or not of this form.
    #[error("not a GarmentCode specification: {0}")]
    Json(String),
    /// JSON without panels.
    #[error("not a GarmentCode specification: it has no pattern.panels")]
    NoPattern,
    /// A unit that is none.
    #[error("units_in_meter must be above zero, not {0}; GarmentCode writes 100 for centimetres")]
    Units(f64),
    /// Control points in an unknown frame.
    #[error("curvature_coords '{0}' is not known; use relative or absolute")]
    Coordinates(String),
    /// A panel.
    #[error("panel '{panel}' {reason}")]
    Panel {
        /// Its name.
        panel: String,
        /// The fault.
        reason: String,
    },
    /// An edge.
    #[error("panel '{panel}', edge {edge}: {reason}")]
    Edge {
        /// Its panel.
        panel: String,
        /// Its number.
        edge: usize,
        /// The fault.
        reason: String,
    },
    /// A stitch.
    #[error("stitch {number}: {reason}")]
    Stitch {
        /// Its number.
        number: usize,
        /// The fault.
        reason: String,
    },
    /// A garment that cannot be written as YAML.
    #[error(transparent)]
    Encode(#[from] crate::io::garment::EncodeError),
}
