//! The inverse of the curvature: a sparse factor, and beside it the chains, each of which couples all its vertices.
//!
//! A chain's stiffness times the dyad of its length's derivative would fill the sparse matrix with a dense block. There
//! are few chains, so they are taken in afterwards (Woodbury 1950): (A + U D Uᵀ)⁻¹ = A⁻¹ − Z (D⁻¹ + Uᵀ Z)⁻¹ Zᵀ with
//! Z = A⁻¹ U.

use nalgebra::{DMatrix, DVector, Dyn};

use super::FlattenError;
use super::element::Taken;
use super::energy::{Curvature, FlatEnergy, Real};
use crate::geometry::Vec2;
use crate::linear::Cholesky;

/// Ties that are tried one after another where a factor fails, in those it has at first.
const TIES: [f64; 4] = [1e2, 1e4, 1e6, 1e8];

/// The true curvature that was not positive is tried again after so many times at most.
const LONGEST_WAIT: u32 = 4;

/// An inverse that is made anew for new positions.
pub(super) struct Inverse {
    curvature: Curvature,
    factor: Cholesky<Real>,
    /// Z, one column per chain.
    answers: DMatrix<f64>,
    /// D⁻¹ + Uᵀ Z, factored; none without chains.
    chains: Option<nalgebra::Cholesky<f64, Dyn>>,
    /// After how many times the true curvature is tried again, and how many it was to wait last.
    wait: [u32; 2],
}

impl Inverse {
    /// Prepared for the couplings of an energy, but that of no position yet.
    pub(super) fn new(energy: &FlatEnergy) -> Result<Self, FlattenError> {
        let curvature = Curvature::new(energy)?;
        let factor = Cholesky::new(curvature.pattern().clone()).map_err(|_| FlattenError::Breakdown)?;
        Ok(Self { curvature, factor, answers: DMatrix::zeros(0, 0), chains: None, wait: [0, 0] })
    }

    /// Factors the curvature at `flat`, made positive, and tied down more and more where it is not so to rounding. In a
    /// weave the true one is taken where it is positive: its stiff threads pull about as much as they push, so that the
    /// positive part alone is far too stiff across them. That is tried the less often the more often it was not.
    pub(super) fn renew(&mut self, energy: &FlatEnergy, flat: &[Vec2]) -> Result<(), FlattenError> {
        if energy.law.warp.is_some() && self.take_all(energy, flat) {
            return Ok(());
        }
        let mut made = self.factor.factor(self.curvature.update(energy, flat, Taken::Positive));
        for times in TIES {
            made = made.or_else(|_| self.factor.factor(self.curvature.tie(times)));
        }
        made.map_err(|_| FlattenError::Breakdown)?;
        self.take_in(energy, flat)
    }

    /// Factors the true curvature, if it is its turn; whether it is positive.
    fn take_all(&mut self, energy: &FlatEnergy, flat: &[Vec2]) -> bool {
        let [left, waited] = self.wait;
        if left > 0 {
            self.wait = [left - 1, waited];
            return false;
        }
        let made = self.factor.factor(self.curvature.update(energy, flat, Taken::All));
        let positive = made.is_ok() && self.take_in(energy, flat).is_ok();
        let next = if positive { 0 } else { (2 * waited).clamp(1, LONGEST_WAIT) };
        self.wait = [next, next];
        positive
    }

    fn take_in(&mut self, energy: &FlatEnergy, flat: &[Vec2]) -> Result<(), FlattenError> {
        let chains = energy.stiff_chains(flat);
        if chains.is_empty() {
            return Ok(());
        }
        let mut slopes = DMatrix::zeros(2 * energy.free, chains.len());
        for (mut column, (_, derivatives)) in slopes.column_iter_mut().zip(&chains) {
            for (v, slope) in derivatives.iter().filter(|(v, _)| (*v as usize) < energy.free) {
                column[2 * *v as usize] += slope.x;
                column[2 * *v as usize + 1] += slope.y;
            }
        }
        self.answers = slopes.clone();
        self.factor.solve_f64(self.answers.as_mut_slice());
        let mut small = slopes.tr_mul(&self.answers);
        for (k, (stiffness, _)) in chains.iter().enumerate() {
            small[(k, k)] += 1.0 / stiffness;
        }
        self.chains = Some(small.cholesky().ok_or(FlattenError::Breakdown)?);
        Ok(())
    }

    /// Multiplies by the inverse: two numbers per vertex that moves.
    pub(super) fn apply(&self, numbers: &mut [f64]) {
        let Some(chains) = &self.chains else { return self.factor.solve_f64(numbers) };
        let shares = chains.solve(&self.answers.tr_mul(&DVector::from_column_slice(numbers)));
        self.factor.solve_f64(numbers);
        for (number, taken) in numbers.iter_mut().zip((&self.answers * shares).iter()) {
            *number -= taken;
        }
    }
}
