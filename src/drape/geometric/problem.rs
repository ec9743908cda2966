//! The problem that both solvers minimise: the energy of a cloth over the positions of its free vertices.

use super::handles::Handles;
use super::recovery::{Recovery, check_positions};
use super::{GeometricCloth, GeometricError};
use crate::geometry::Vec3;

/// A cloth, its recovery term, and the vertices that are held.
#[derive(Debug)]
pub(super) struct RecoveryProblem<'a> {
    pub(super) cloth: &'a GeometricCloth,
    pub(super) handles: Handles,
    pub(super) recovery: Recovery,
}

impl<'a> RecoveryProblem<'a> {
    pub(super) fn new(cloth: &'a GeometricCloth, held: &[u32], recovery: Recovery) -> Result<Self, GeometricError> {
        recovery.check(cloth.vertices())?;
        Ok(Self { cloth, handles: Handles::new(cloth.vertices(), held)?, recovery })
    }

    pub(super) fn energy(&self, x: &[Vec3]) -> f64 {
        self.cloth.energy(x, &self.recovery).total
    }

    /// Half the gradient with this recovery term. Zero at the held vertices.
    pub(super) fn half_gradient(&self, x: &[Vec3], recovery: &Recovery) -> Vec<Vec3> {
        let mut out = self.cloth.half_gradient(x, recovery);
        self.handles.clear(&mut out);
        out
    }

    /// Refuses a start that is not one finite position per vertex, or has no energy.
    pub(super) fn check_start(&self, x: &[Vec3]) -> Result<(), GeometricError> {
        check_positions("positions", x, self.cloth.vertices())?;
        if self.energy(x).is_finite() { Ok(()) } else { Err(GeometricError::Overflow) }
    }
}
