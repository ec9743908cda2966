//! The inside of a meshed piece.

use crate::geometry::Vec2;

/// A piece's points and triangles.
pub(super) struct Fill {
    /// Rim particles first, as in the frame.
    pub(super) points: Vec<Vec2>,
    /// Positively oriented.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Particles of every planned line.
    pub(super) lines: Vec<Vec<u32>>,
}
