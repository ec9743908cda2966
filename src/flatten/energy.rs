//! The energy of a flat position of a whole piece: its triangles' distortion and its springs.

use std::sync::Arc;

use nalgebra::Matrix2;

use super::FlattenError;
use super::element::{CORNER_PAIRS, Element};
use super::law::Law;
use crate::geometry::Vec2;
use crate::linear::{BlockSlot, SymmetricMatrix, SymmetricPattern};

/// Stiffness of a weak tie of every vertex to where it is, in units in which the softest bending of the piece in its
/// plane has about ten: it makes the second derivative, which knows nothing of rigid motions, invertible, and is too
/// weak to slow anything else down. It is part of the step only, never of the energy.
const TIE: f64 = 1e-4;

/// A spring that wants a flat edge to have a length: weight · (length/target − 1)².
#[derive(Clone, Copy, Debug)]
pub(super) struct Spring {
    /// Its vertices.
    pub(super) ends: [u32; 2],
    /// Wanted length, metres.
    pub(super) target: f64,
    /// Its weight in the energy, m².
    pub(super) weight: f64,
}

/// What a piece's flat position is measured by. Divided by the piece's area, so it has no unit: a uniform stretch by
/// one per cent both ways costs 2·10⁻⁴.
pub(super) struct Energy {
    pub(super) elements: Vec<Element>,
    pub(super) springs: Vec<Spring>,
    law: Law,
    total_area: f64,
    vertices: usize,
}

impl Energy {
    pub(super) fn new(vertices: usize, elements: Vec<Element>, springs: Vec<Spring>, law: Law) -> Self {
        let total_area = elements.iter().map(|e| e.area).sum();
        Self { elements, springs, law, total_area, vertices }
    }

    /// The energy; infinite where a triangle is flipped.
    pub(super) fn value(&self, flat: &[Vec2]) -> f64 {
        let triangles: f64 = self.elements.iter().map(|e| e.area * self.law.density(&e.jacobian(flat))).sum();
        let springs: f64 = self.springs.iter().map(|s| s.weight * (s.length(flat) / s.target - 1.0).powi(2)).sum();
        (triangles + springs) / self.total_area
    }

    /// Its derivative by every coordinate, 1/m.
    pub(super) fn gradient(&self, flat: &[Vec2], out: &mut [Vec2]) {
        out.fill(Vec2::zeros());
        for e in &self.elements {
            let scale = e.area / self.total_area;
            for (v, force) in e.corners.into_iter().zip(e.forces(&self.law.stress(&e.jacobian(flat)))) {
                out[v as usize] += force * scale;
            }
        }
        for s in &self.springs {
            let [a, b] = s.ends.map(|v| v as usize);
            let along = flat[b] - flat[a];
            let length = along.norm();
            if length > 0.0 {
                let scale = 2.0 * s.weight / (s.target * self.total_area) * (length / s.target - 1.0) / length;
                out[a] -= along * scale;
                out[b] += along * scale;
            }
        }
    }
}

impl Spring {
    pub(super) fn length(&self, flat: &[Vec2]) -> f64 {
        (flat[self.ends[1] as usize] - flat[self.ends[0] as usize]).norm()
    }

    /// The positive semidefinite part of its second derivative by one end.
    fn curvature(&self, flat: &[Vec2]) -> Matrix2<f64> {
        let along = flat[self.ends[1] as usize] - flat[self.ends[0] as usize];
        let length = along.norm();
        let stiffness = 2.0 * self.weight / (self.target * self.target);
        if length <= 0.0 {
            return Matrix2::identity() * stiffness;
        }
        let n = along / length;
        let dyad = n * n.transpose();
        // A compressed spring pushes sideways: that part is negative and left out.
        let across = (1.0 - self.target / length).max(0.0);
        (dyad + (Matrix2::identity() - dyad) * across) * stiffness
    }
}

/// The second derivative of an [`Energy`], made positive definite, with the places of its blocks worked out once.
pub(super) struct Curvature {
    matrix: SymmetricMatrix<f64>,
    element_slots: Vec<[BlockSlot; 6]>,
    /// End a, end b, and the two coupled.
    spring_slots: Vec<[BlockSlot; 3]>,
    ties: Vec<(BlockSlot, f64)>,
}

impl Curvature {
    pub(super) fn new(energy: &Energy) -> Result<Self, FlattenError> {
        let pairs = energy
            .elements
            .iter()
            .flat_map(|e| CORNER_PAIRS[3..].iter().map(|&(k, l)| (e.corners[k] as usize, e.corners[l] as usize)));
        let springs = energy.springs.iter().map(|s| (s.ends[0] as usize, s.ends[1] as usize));
        let pattern = SymmetricPattern::planar_blocks(energy.vertices, pairs.chain(springs));
        let pattern = Arc::new(pattern.map_err(|_| FlattenError::Breakdown)?);
        // Every pair asked for below was given above.
        let slot = |i: u32, j: u32| pattern.block_slot(i as usize, j as usize).ok_or(FlattenError::Breakdown);
        let mut element_slots = Vec::with_capacity(energy.elements.len());
        let mut ties = vec![0.0; energy.vertices];
        for e in &energy.elements {
            let mut slots = [slot(e.corners[0], e.corners[0])?; 6];
            for (place, (k, l)) in slots.iter_mut().zip(CORNER_PAIRS) {
                *place = slot(e.corners[k], e.corners[l])?;
            }
            element_slots.push(slots);
            for v in e.corners {
                ties[v as usize] += TIE * e.area / 3.0 / (energy.total_area * energy.total_area);
            }
        }
        let spring_slots = energy.springs.iter().map(|s| {
            let [a, b] = s.ends;
            Ok([slot(a, a)?, slot(b, b)?, slot(b, a)?])
        });
        let spring_slots = spring_slots.collect::<Result<_, FlattenError>>()?;
        let ties = ties.into_iter().enumerate().map(|(v, tie)| Ok((slot(v as u32, v as u32)?, tie)));
        let ties = ties.collect::<Result<_, FlattenError>>()?;
        Ok(Self { matrix: SymmetricMatrix::zeros(pattern), element_slots, spring_slots, ties })
    }

    /// Fills the matrix for a position without flipped triangles.
    pub(super) fn update(&mut self, energy: &Energy, flat: &[Vec2]) -> &SymmetricMatrix<f64> {
        self.matrix.clear();
        for (e, slots) in energy.elements.iter().zip(&self.element_slots) {
            let mut blocks = [Matrix2::zeros(); 6];
            energy.law.modes(&e.jacobian(flat), |mode| e.add_mode(mode, &mut blocks));
            for (&slot, block) in slots.iter().zip(blocks) {
                self.matrix.add_block(slot, &(block * (e.area / energy.total_area)));
            }
        }
        for (s, slots) in energy.springs.iter().zip(&self.spring_slots) {
            let block = s.curvature(flat) / energy.total_area;
            self.matrix.add_block(slots[0], &block);
            self.matrix.add_block(slots[1], &block);
            self.matrix.add_block(slots[2], &-block);
        }
        self.tie(1.0)
    }

    /// The matrix with every vertex tied `times` as fast again to where it is, for where it is not positive to rounding:
    /// at a triangle that is almost flat one stretch has millions of times the curvature of its neighbours.
    pub(super) fn tie(&mut self, times: f64) -> &SymmetricMatrix<f64> {
        for &(slot, tie) in &self.ties {
            self.matrix.add_block(slot, &(Matrix2::identity() * (tie * times)));
        }
        &self.matrix
    }

    pub(super) fn pattern(&self) -> &Arc<SymmetricPattern> {
        self.matrix.pattern()
    }
}
