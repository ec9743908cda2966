//! Vertices that stay where they are put.

use super::GeometricError;
use crate::geometry::Vec3;

/// Flags of held vertices. A held vertex keeps its row in the linear systems, as a row of the identity. So the pattern
/// is the same for all handles, and its step is zero.
#[derive(Clone, Debug)]
pub(super) struct Handles(Vec<bool>);

impl Handles {
    pub(super) fn new(vertices: usize, held: &[u32]) -> Result<Self, GeometricError> {
        let mut out = vec![false; vertices];
        for &vertex in held {
            *out.get_mut(vertex as usize).ok_or(GeometricError::Handle { vertex, vertices })? = true;
        }
        Ok(Self(out))
    }

    pub(super) fn holds(&self, vertex: u32) -> bool {
        self.0[vertex as usize]
    }

    /// Sets the entries of held vertices to zero.
    pub(super) fn clear(&self, values: &mut [Vec3]) {
        for (value, _) in values.iter_mut().zip(&self.0).filter(|(_, held)| **held) {
            *value = Vec3::zeros();
        }
    }
}
