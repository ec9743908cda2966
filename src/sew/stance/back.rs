//! Limbs go back to where they belong, and take the cloth on them along.

use rayon::prelude::*;

use crate::contact::Skin;
use crate::dynamics::{StepError, World};
use crate::geometry::{TriMesh, Vec3};
use crate::mannequin::LimbSpread;
use crate::sew::settle::{STEP, TRUST};

/// No cloth is carried further than this in one stage on the average, metres.
const STAGE: f64 = 2.5e-3;
/// Stages get shorter towards the end, when limbs come near each other: what is left falls by this power. The first is
/// twice the average: limbs and cloth are still far from one another.
const EASE: i32 = 2;
/// Cloth so far from a limb goes half of its way, metres, where nothing else is near.
const FAR: f64 = 0.05;
/// Cloth so near a limb, metres, lies on it.
const ON: f64 = 1e-6;
/// Cloth further from a limb than this, metres, does not ask for it.
const LOOK: f64 = 0.5;
/// Steps of the measured springs after every stage.
const STEPS: usize = 3;

/// Which share of a limb's way every node of a garment goes.
pub(super) struct Carrier<'a> {
    spreads: &'a [LimbSpread],
    /// Node by node, limb by limb.
    weights: Vec<Vec<f64>>,
}

impl<'a> Carrier<'a> {
    /// For nodes at `x` on a body with its limbs apart. Cloth goes the way of the skin that it is near to: of limbs, or
    /// of the rest, which stays. `None` if a limb has no skin.
    pub(super) fn new(apart: &TriMesh, spreads: &'a [LimbSpread], x: &[Vec3]) -> Option<Self> {
        // Of every vertex the number of its limb; the rest comes last, with the skin where they join.
        let mut limb = vec![spreads.len(); apart.vertices.len()];
        for (k, spread) in spreads.iter().enumerate() {
            spread.vertices.iter().for_each(|v| limb[*v as usize] = k);
        }
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|v| limb[v as usize]);
            if a == b && b == c { a } else { spreads.len() }
        };
        let skin = |k: usize| {
            let triangles = apart.triangles.iter().filter(|t| of(t) == k).copied().collect();
            Skin::new(&apart.vertices, triangles)
        };
        let skins = (0..=spreads.len()).map(skin).collect::<Option<Vec<Skin>>>()?;
        let weigh = |p: &Vec3| {
            let pull = |skin: &Skin| skin.distance(*p, LOOK).map_or(0.0, |far| far.max(ON).powi(-2));
            let pulls: Vec<f64> = skins.iter().map(pull).collect();
            let sum = pulls.iter().sum::<f64>() + FAR.powi(-2);
            pulls[..spreads.len()].iter().map(|pull| pull / sum).collect()
        };
        Some(Self { spreads, weights: x.par_iter().map(weigh).collect() })
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
    /// lets the measured springs pull. Returns for how many steps.
    ///
    /// # Errors
    /// As [`World::newton`].
    pub(super) fn carry(&self, world: &mut World, share: f64) -> Result<usize, StepError> {
        let moved = |(p, weights): (&Vec3, &Vec<f64>)| Vec3::new(p.x + self.way(p, weights) * share, p.y, p.z);
        let target: Vec<Vec3> = world.x().iter().zip(&self.weights).map(moved).collect();
        world.carry(&target)?;
        for _ in 0..STEPS {
            world.newton(STEP, TRUST)?;
        }
        Ok(STEPS)
    }
}
