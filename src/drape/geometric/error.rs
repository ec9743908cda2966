//! Errors of a cloth or a start.

use super::Weights;
use crate::linear::{CholeskyError, PatternError};

/// Why a cloth has no published energy, or no minimum can be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GeometricError {
    /// A weight below zero or not finite, or none above zero.
    #[error("weights {0:?}: each must be zero or more and one above zero")]
    Weights(Weights),
    /// A triangle with a vertex that does not exist.
    #[error("triangle {triangle} names a vertex beyond the {vertices} there are")]
    Index {
        /// The triangle.
        triangle: usize,
        /// Number of vertices.
        vertices: usize,
    },
    /// A triangle without area.
    #[error("triangle {0} of the initial mesh has no area, or a corner that is not finite")]
    Degenerate(usize),
    /// Three or more triangles at one edge.
    #[error("edge {}–{} joins more than two triangles", .0[0], .0[1])]
    NonManifold([u32; 2]),
    /// A list of another length than it must have.
    #[error("{found} {what}, where {expected} are needed")]
    Count {
        /// The kind of entries.
        what: &'static str,
        /// Number of entries.
        found: usize,
        /// Required number.
        expected: usize,
    },
    /// A held vertex, or a control's, that does not exist.
    #[error("vertex {vertex} cannot be held or drawn: there are only {vertices}")]
    Handle {
        /// The vertex.
        vertex: u32,
        /// Number of vertices.
        vertices: usize,
    },
    /// A control that names a vertex twice, or whose target or shares are not finite.
    #[error("control {0} names a vertex twice, or its target or shares are not finite")]
    Control(usize),
    /// A drop of [`super::Recovery::Falling`] that is not finite.
    #[error("the drop per iteration is not finite")]
    Drop,
    /// A position or target that is not finite.
    #[error("vertex {0} has a position or a target that is not finite")]
    NotFinite(usize),
    /// Positions are so far apart that their squares are not finite.
    #[error("the energy at the start is not finite: positions are too far apart")]
    Overflow,
    /// The system's pattern cannot be built.
    #[error(transparent)]
    Pattern(#[from] PatternError),
    /// Its factor cannot be analysed.
    #[error(transparent)]
    Analysis(#[from] CholeskyError),
    /// The system has no factor.
    #[error("the linear system is singular near vertex {0}")]
    Singular(usize),
}
