//! The cloth along the rim by itself.
//!
//! Rim edges that keep their lengths turn like stiff rods where the rim takes up curvature, most at its corners. Such
//! turns are short in space and long in steps, and would take the whole piece as many; so they are left to a narrow
//! zone along the rim, whose inner side stays where it is meanwhile (a nonlinear Schwarz method: Cai & Keyes 2002).

use super::element::FlatElement;
use super::energy::FlatEnergy;
use super::relax::{EnergyDescent, Goal};
use super::spring::{LengthSpring, Springs};
use crate::geometry::Vec2;

/// How many edges the zone is wide.
const RINGS: u8 = 6;
/// A zone of more than this share of the piece is not worth its steps.
const SHARE: f64 = 0.2;
/// Between two steps of the whole piece.
const GOAL: Goal = Goal { tolerance: 1e-4, max_iterations: 30, holds: 0, exact: 0.0 };

/// The zone's own problem, prepared.
pub(super) struct Zone {
    /// The piece's vertex of every vertex: those that move, then those that stay.
    vertices: Vec<u32>,
    energy: FlatEnergy,
    descent: EnergyDescent,
    flat: Vec<Vec2>,
}

impl Zone {
    /// The zone along the held springs; `None` where there is none, or it would be most of the piece.
    pub(super) fn new(energy: &FlatEnergy, flat: &[Vec2]) -> Option<Self> {
        let ring = rings(energy, flat.len());
        let all = 0..flat.len() as u32;
        let mut vertices: Vec<u32> = all.clone().filter(|&v| ring[v as usize] < RINGS).collect();
        let free = vertices.len();
        vertices.extend(all.filter(|&v| ring[v as usize] == RINGS));
        if free == 0 || free as f64 > SHARE * flat.len() as f64 {
            return None;
        }
        let mut local = vec![u32::MAX; flat.len()];
        vertices.iter().enumerate().for_each(|(k, &v)| local[v as usize] = k as u32);
        let inside = |e: &&FlatElement| e.corners.iter().any(|&v| ring[v as usize] < RINGS);
        let element = |e: &FlatElement| FlatElement { corners: e.corners.map(|v| local[v as usize]), ..*e };
        let elements: Vec<FlatElement> = energy.elements.iter().filter(inside).map(element).collect();
        let spring = |s: &LengthSpring| LengthSpring { nodes: s.nodes.map(|v| local[v as usize]), ..*s };
        let (held, others) = energy.springs.split_at(energy.held().len());
        let springs = Springs {
            held: held.iter().map(spring).collect(),
            free: others.iter().map(spring).collect(),
            chains: Vec::new(),
        };
        let energy = energy.part(vertices.len(), free, elements, springs);
        let flat: Vec<Vec2> = vertices.iter().map(|&v| flat[v as usize]).collect();
        let descent = EnergyDescent::new(&energy).ok()?;
        Some(Self { vertices, energy, descent, flat })
    }

    /// Lets the zone come to rest within `flat`, before any force has been found that holds its springs;
    /// whether it moved.
    pub(super) fn settle(&mut self, flat: &mut [Vec2]) -> bool {
        for (own, &v) in self.flat.iter_mut().zip(&self.vertices) {
            *own = flat[v as usize];
        }
        // Where the zone finds no way the whole piece may.
        let outcome = self.descent.down(&mut self.energy, &mut self.flat, &GOAL, None);
        let moved = outcome.is_ok_and(|outcome| outcome.iterations > 0);
        if moved {
            for (own, &v) in self.flat.iter().zip(&self.vertices) {
                flat[v as usize] = *own;
            }
        }
        moved
    }
}

/// How many edges every vertex is from a held spring, counted to [`RINGS`]; more beyond.
fn rings(energy: &FlatEnergy, vertices: usize) -> Vec<u8> {
    let mut ring = vec![u8::MAX; vertices];
    energy.held().iter().flat_map(|s| s.nodes).for_each(|v| ring[v as usize] = 0);
    for here in 0..RINGS {
        let mut next = Vec::new();
        for e in energy.elements.iter().filter(|e| e.corners.iter().any(|&v| ring[v as usize] == here)) {
            next.extend(e.corners.iter().copied().filter(|&v| ring[v as usize] == u8::MAX));
        }
        next.into_iter().for_each(|v| ring[v as usize] = here + 1);
    }
    ring
}
