//! The inverse of the curvature: a sparse factor, and beside it the chains, each of which couples all its vertices.
//!
//! A chain's stiffness times the dyad of its length's derivative would fill the sparse matrix with a dense block. There
//! are few chains, so they are taken in afterwards (Woodbury 1950): (A + U D Uᵀ)⁻¹ = A⁻¹ − Z (D⁻¹ + Uᵀ Z)⁻¹ Zᵀ with
//! Z = A⁻¹ U.

use nalgebra::{DMatrix, DVector, Dyn};

use super::FlattenError;
use super::element::Taken;
use super::energy::{Curvature, FlatEnergy};
use crate::geometry::Vec2;
use crate::linear::{Cholesky, Scalar};

/// Ties that are tried one after another where a factor fails, in those it has at first.
const TIES: [f64; 4] = [1e2, 1e4, 1e6, 1e8];

/// The true curvature that was not positive is tried again after so many times at most.
const LONGEST_WAIT: u32 = 4;

/// Vertices from which on the factor is made of single numbers: it is most of the memory (900 MB at 400,000 vertices in
/// double ones), and a direction that is off by a millionth leads down as well.
const SINGLE: usize = 50_000;

/// A curvature and its factor.
struct Factored<T> {
    curvature: Curvature<T>,
    factor: Cholesky<T>,
}

impl<T: Scalar> Factored<T> {
    fn new<const N: usize>(energy: &FlatEnergy<N>) -> Result<Self, FlattenError> {
        let curvature = Curvature::new(energy)?;
        let factor = Cholesky::new(curvature.pattern().clone()).map_err(|_| FlattenError::Breakdown)?;
        Ok(Self { curvature, factor })
    }

    /// Factors the curvature at a position; whether it is positive.
    fn take<const N: usize>(&mut self, energy: &FlatEnergy<N>, flat: &[Vec2], taken: Taken) -> bool {
        self.factor.factor(self.curvature.update(energy, flat, taken)).is_ok()
    }

    /// The same of the curvature that was taken last, tied down.
    fn tie(&mut self, times: f64) -> bool {
        self.factor.factor(self.curvature.tie(times)).is_ok()
    }
}

/// Of either kind of numbers.
enum Factor {
    Single(Factored<f32>),
    Double(Factored<f64>),
}

impl Factor {
    fn new<const N: usize>(energy: &FlatEnergy<N>) -> Result<Self, FlattenError> {
        if energy.free < SINGLE {
            Factored::new(energy).map(Self::Double)
        } else {
            Factored::new(energy).map(Self::Single)
        }
    }

    fn take<const N: usize>(&mut self, energy: &FlatEnergy<N>, flat: &[Vec2], taken: Taken) -> bool {
        match self {
            Self::Single(factored) => factored.take(energy, flat, taken),
            Self::Double(factored) => factored.take(energy, flat, taken),
        }
    }

    fn tie(&mut self, times: f64) -> bool {
        match self {
            Self::Single(factored) => factored.tie(times),
            Self::Double(factored) => factored.tie(times),
        }
    }

    fn solve(&self, numbers: &mut [f64]) {
        match self {
            Self::Single(factored) => factored.factor.solve_f64(numbers),
            Self::Double(factored) => factored.factor.solve(numbers),
        }
    }
}

/// An inverse that is made anew for new positions.
pub(super) struct Inverse {
    factor: Factor,
    /// Z, one column per chain.
    answers: DMatrix<f64>,
    /// D⁻¹ + Uᵀ Z, factored; none without chains.
    chains: Option<nalgebra::Cholesky<f64, Dyn>>,
    /// After how many times the true curvature is tried again, and how many it was to wait last.
    wait: [u32; 2],
}

impl Inverse {
    /// Prepared for the couplings of an energy, but that of no position yet.
    pub(super) fn new<const N: usize>(energy: &FlatEnergy<N>) -> Result<Self, FlattenError> {
        Ok(Self { factor: Factor::new(energy)?, answers: DMatrix::zeros(0, 0), chains: None, wait: [0, 0] })
    }

    /// Factors the curvature at `flat`, made positive, and tied down more and more where it is not so to rounding. In a
    /// weave the true one is taken where it is positive: its stiff threads pull about as much as they push, so that the
    /// positive part alone is far too stiff across them. That is tried the less often the more often it was not.
    pub(super) fn renew<const N: usize>(&mut self, energy: &FlatEnergy<N>, flat: &[Vec2]) -> Result<(), FlattenError> {
        if energy.law.warp.is_some() && self.take_all(energy, flat) {
            return Ok(());
        }
        let made = self.factor.take(energy, flat, Taken::Positive) || TIES.iter().any(|times| self.factor.tie(*times));
        if made { self.take_in(energy, flat) } else { Err(FlattenError::Breakdown) }
    }

    /// Factors the true curvature, if it is its turn; whether it is positive.
    fn take_all<const N: usize>(&mut self, energy: &FlatEnergy<N>, flat: &[Vec2]) -> bool {
        let [left, waited] = self.wait;
        if left > 0 {
            self.wait = [left - 1, waited];
            return false;
        }
        let positive = self.factor.take(energy, flat, Taken::All) && self.take_in(energy, flat).is_ok();
        let next = if positive { 0 } else { (2 * waited).clamp(1, LONGEST_WAIT) };
        self.wait = [next, next];
        positive
    }

    fn take_in<const N: usize>(&mut self, energy: &FlatEnergy<N>, flat: &[Vec2]) -> Result<(), FlattenError> {
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
        self.factor.solve(self.answers.as_mut_slice());
        let mut small = slopes.tr_mul(&self.answers);
        for (k, (stiffness, _)) in chains.iter().enumerate() {
            small[(k, k)] += 1.0 / stiffness;
        }
        self.chains = Some(small.cholesky().ok_or(FlattenError::Breakdown)?);
        Ok(())
    }

    /// Multiplies by the inverse: two numbers per vertex that moves.
    pub(super) fn apply(&self, numbers: &mut [f64]) {
        let Some(chains) = &self.chains else { return self.factor.solve(numbers) };
        let shares = chains.solve(&self.answers.tr_mul(&DVector::from_column_slice(numbers)));
        self.factor.solve(numbers);
        for (number, taken) in numbers.iter_mut().zip((&self.answers * shares).iter()) {
            *number -= taken;
        }
    }
}
