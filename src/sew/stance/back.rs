//! Limbs go back to where they belong, and take the cloth on them along.

use rayon::prelude::*;

use super::spread::Spread;
use crate::dynamics::{StepError, World};
use crate::geometry::{TriMesh, Vec3};
use crate::sew::settle::{STEP, TRUST};

/// No cloth is carried further than this at a time on the average, metres.
const STAGE: f64 = 2.5e-3;
/// Stages get shorter towards the end, when limbs come near each other: what is left falls by this power.
const EASE: i32 = 2;
/// Cloth so far from a limb goes half of its way, metres, where nothing else is near.
const FAR: f64 = 0.05;
/// Steps of the measured springs after every stage.
const STEPS: usize = 3;

/// Which share of a limb's way every node of a garment goes.
pub(super) struct Carrier<'a> {
    spreads: &'a [Spread],
    /// Node by node, limb by limb.
    weights: Vec<Vec<f64>>,
}

impl<'a> Carrier<'a> {
    /// For nodes at `x` on a body with its limbs apart. Cloth goes the way of what it is near to: of limbs, or of the
    /// rest, which stays.
    pub(super) fn new(apart: &TriMesh, spreads: &'a [Spread], x: &[Vec3]) -> Self {
        // Of every vertex the number of its limb; the rest comes last.
        let mut limb = vec![spreads.len(); apart.vertices.len()];
        for (k, spread) in spreads.iter().enumerate() {
            spread.vertices.iter().for_each(|v| limb[*v as usize] = k);
        }
        let weigh = |p: &Vec3| {
            let mut nearest = vec![f64::INFINITY; spreads.len() + 1];
            for (v, q) in apart.vertices.iter().enumerate() {
                let square = (p - q).norm_squared();
                nearest[limb[v]] = f64::min(nearest[limb[v]], square);
            }
            let sum = nearest.iter().map(|square| square.recip()).sum::<f64>() + (FAR * FAR).recip();
            nearest[..spreads.len()].iter().map(|square| square.recip() / sum).collect()
        };
        Self { spreads, weights: x.par_iter().map(weigh).collect() }
    }

    /// The shares of their spread at which limbs stop on their way back, but for the last, which is none. Limbs without
    /// cloth on them do not count.
    pub(super) fn stops(&self, x: &[Vec3]) -> Vec<f64> {
        let ways = x.iter().zip(&self.weights).map(|(p, weights)| self.way(p, weights).abs());
        let stages = (ways.fold(0.0, f64::max) / STAGE).ceil() as usize;
        (1..stages).map(|k| (1.0 - k as f64 / stages as f64).powi(EASE)).collect()
    }

    /// How far along x a node at `p` goes with the whole spread, metres.
    fn way(&self, p: &Vec3, weights: &[f64]) -> f64 {
        self.spreads.iter().zip(weights).map(|(spread, weight)| spread.at(p.y) * weight).sum()
    }

    /// Carries the nodes of `world` along as limbs go on by a share of their spread, as far as cloth lets cloth, and
    /// lets the measured springs pull. Returns the steps that took.
    ///
    /// # Errors
    /// As [`World::newton`].
    pub(super) fn carry(&self, world: &mut World, share: f64) -> Result<usize, StepError> {
        let moved = |(p, weights): (&Vec3, &Vec<f64>)| Vec3::new(p.x + self.way(p, weights) * share, p.y, p.z);
        let target: Vec<Vec3> = world.x.iter().zip(&self.weights).map(moved).collect();
        world.carry(&target)?;
        for _ in 0..STEPS {
            world.newton(STEP, TRUST)?;
        }
        Ok(STEPS)
    }
}
