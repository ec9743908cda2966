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

/// The numbers of the curvature.
pub(super) type Real = f64;

/// A spring that wants a flat edge to have a length: with e = length/target − 1 its energy is weight · e² + pull · e.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spring {
    /// Its vertices.
    pub(super) ends: [u32; 2],
    /// Wanted length, metres.
    pub(super) target: f64,
    /// Its weight in the energy, m².
    pub(super) weight: f64,
    /// The force it has besides, m²: that which holds the edge at its very length, once it is found.
    pub(super) pull: f64,
}

/// The springs of an energy.
#[derive(Default)]
pub(super) struct Springs {
    /// Those that get exactly their lengths.
    pub(super) held: Vec<Spring>,
    /// Those that do not.
    pub(super) free: Vec<Spring>,
}

/// What a piece's flat position is measured by. Divided by the piece's area, so it has no unit: a uniform stretch by
/// one per cent both ways costs 2·10⁻⁴.
pub(super) struct Energy {
    pub(super) elements: Vec<Element>,
    pub(super) springs: Vec<Spring>,
    /// The first so many springs get exactly their lengths; the others are only springs.
    held: usize,
    law: Law,
    total_area: f64,
    vertices: usize,
}

impl Energy {
    pub(super) fn new(vertices: usize, elements: Vec<Element>, springs: Springs, law: Law) -> Self {
        let total_area = elements.iter().map(|e| e.area).sum();
        let held = springs.held.len();
        let springs = [springs.held, springs.free].concat();
        Self { elements, springs, held, law, total_area, vertices }
    }

    /// Pairs of vertices whose positions the energy couples, some of them twice.
    pub(super) fn couplings(&self) -> Vec<[u32; 2]> {
        let sides =
            self.elements.iter().flat_map(|e| CORNER_PAIRS[3..].iter().map(|&(k, l)| [e.corners[k], e.corners[l]]));
        sides.chain(self.springs.iter().map(|s| s.ends)).collect()
    }

    /// The energy; infinite where a triangle is flipped.
    pub(super) fn value(&self, flat: &[Vec2]) -> f64 {
        let triangles: f64 = self.elements.iter().map(|e| e.area * self.law.density(&e.jacobian(flat))).sum();
        let springs: f64 = self.springs.iter().map(|s| s.energy(flat)).sum();
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
                let scale = s.tension(length) / (length * self.total_area);
                out[a] -= along * scale;
                out[b] += along * scale;
            }
        }
    }
}

impl Energy {
    /// The share by which held springs are too long or too short in the mean: no chain of them is off by more than this share
    /// of the length of all.
    pub(super) fn slack(&self, flat: &[Vec2]) -> f64 {
        let held = &self.springs[..self.held];
        let off: f64 = held.iter().map(|s| (s.length(flat) - s.target).abs()).sum();
        if held.is_empty() { 0.0 } else { off / held.iter().map(|s| s.target).sum::<f64>() }
    }

    /// Lets every held spring keep the force it has as its own (method of multipliers: Hestenes 1969, Powell 1969): in the
    /// next minimum it needs less excess for it.
    pub(super) fn hold(&mut self, flat: &[Vec2]) {
        for s in &mut self.springs[..self.held] {
            s.pull = s.tension(s.length(flat)) * s.target;
        }
    }
}

impl Spring {
    pub(super) fn length(&self, flat: &[Vec2]) -> f64 {
        (flat[self.ends[1] as usize] - flat[self.ends[0] as usize]).norm()
    }

    /// Share by which it is too long.
    fn excess(&self, length: f64) -> f64 {
        length / self.target - 1.0
    }

    fn energy(&self, flat: &[Vec2]) -> f64 {
        let excess = self.excess(self.length(flat));
        (self.weight * excess + self.pull) * excess
    }

    /// Derivative of its energy by its length, m.
    fn tension(&self, length: f64) -> f64 {
        (2.0 * self.weight * self.excess(length) + self.pull) / self.target
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
        let across = (self.tension(length) / length).max(0.0);
        dyad * stiffness + (Matrix2::identity() - dyad) * across
    }
}

/// The second derivative of an [`Energy`], made positive definite, with the places of its blocks worked out once.
pub(super) struct Curvature {
    matrix: SymmetricMatrix<Real>,
    element_slots: Vec<[BlockSlot; 6]>,
    /// End a, end b, and the two coupled.
    spring_slots: Vec<[BlockSlot; 3]>,
    ties: Vec<(BlockSlot, f64)>,
}

impl Curvature {
    pub(super) fn new(energy: &Energy) -> Result<Self, FlattenError> {
        let pairs = energy.couplings().into_iter().map(|[a, b]| (a as usize, b as usize));
        let pattern = SymmetricPattern::planar_blocks(energy.vertices, pairs);
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
    pub(super) fn update(&mut self, energy: &Energy, flat: &[Vec2]) -> &SymmetricMatrix<Real> {
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
    pub(super) fn tie(&mut self, times: f64) -> &SymmetricMatrix<Real> {
        for &(slot, tie) in &self.ties {
            self.matrix.add_block(slot, &(Matrix2::identity() * (tie * times)));
        }
        &self.matrix
    }

    pub(super) fn pattern(&self) -> &Arc<SymmetricPattern> {
        self.matrix.pattern()
    }
}
