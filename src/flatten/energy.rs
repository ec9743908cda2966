//! The energy of a flat position of a whole piece: its triangles' distortion and its springs.

use std::sync::Arc;

use nalgebra::Matrix2;

use super::FlattenError;
use super::barrier::Barrier;
use super::element::{FlatElement, Taken, pairs};
use super::law::Law;
use super::spring::{Chain, LengthSpring, Springs};
use crate::geometry::Vec2;
use crate::linear::{BlockSlot, Scalar, SymmetricMatrix, SymmetricPattern};

/// Stiffness of a weak tie of every vertex to where it is, in units in which the softest bending of the piece in its
/// plane has about ten: it makes the second derivative, which knows nothing of rigid motions, invertible, and is too
/// weak to slow anything else down. It is part of the step only, never of the energy.
const TIE: f64 = 1e-4;

/// The distortion of a piece's flat position. It is divided by the piece's area, so it has no unit: a uniform stretch
/// by one per cent both ways costs 2·10⁻⁴.
pub(super) struct FlatEnergy<const N: usize = 3> {
    pub(super) elements: Arc<[FlatElement<N>]>,
    pub(super) springs: Vec<LengthSpring<N>>,
    /// The first so many springs get exactly their lengths; the others are only springs.
    held: usize,
    /// Runs of the others whose lengths together are exact.
    pub(super) chains: Vec<Chain>,
    pub(super) law: Law,
    /// The barrier between its rims, where the piece is to be kept from lying on itself.
    pub(super) barrier: Option<Barrier>,
    /// Its pushes when the curvature was last taken.
    pushes: Vec<LengthSpring>,
    total_area: f64,
    pub(super) vertices: usize,
    /// Vertices from this one on stay where they are.
    pub(super) free: usize,
}

impl<const N: usize> FlatEnergy<N> {
    pub(super) fn new(
        vertices: usize,
        elements: impl Into<Arc<[FlatElement<N>]>>,
        springs: Springs<N>,
        law: Law,
    ) -> Self {
        let elements = elements.into();
        let total_area = elements.iter().map(|e| e.area).sum();
        let held = springs.held.len();
        let chains = springs.chains;
        let springs = [springs.held, springs.free].concat();
        Self {
            elements,
            springs,
            held,
            chains,
            law,
            barrier: None,
            pushes: Vec::new(),
            total_area,
            vertices,
            free: vertices,
        }
    }

    /// The energy of a part, in the same measure, of which only the first `free` vertices move.
    pub(super) fn part(
        &self,
        vertices: usize,
        free: usize,
        elements: impl Into<Arc<[FlatElement<N>]>>,
        springs: Springs<N>,
    ) -> Self {
        Self { total_area: self.total_area, free, ..Self::new(vertices, elements, springs, self.law) }
    }

    /// Pairs of free vertices whose positions the energy couples, some of them twice.
    pub(super) fn couplings(&self) -> Vec<[u32; 2]> {
        let free = |pair: &[u32; 2]| pair.iter().all(|&v| (v as usize) < self.free);
        let points = self.elements.iter().map(|e| e.corners).chain(self.springs.iter().map(|s| s.nodes));
        let between = points.flat_map(coupled);
        between.chain(self.pushes.iter().flat_map(|s| coupled(s.nodes))).filter(free).collect()
    }

    /// Takes note of the pushes at a position for its curvature; whether other vertices are coupled than before.
    pub(super) fn note_pushes(&mut self, flat: &[Vec2]) -> bool {
        let Some(barrier) = &self.barrier else { return false };
        let before = std::mem::replace(&mut self.pushes, barrier.lines(flat));
        !before.iter().map(|s| s.nodes).eq(self.pushes.iter().map(|s| s.nodes))
    }

    /// The energy; infinite where a triangle is flipped or what is kept apart meets.
    pub(super) fn value(&self, flat: &[Vec2]) -> f64 {
        let triangles: f64 = self.elements.iter().map(|e| e.area * self.law.density(&e.jacobian(flat))).sum();
        let springs: f64 = self.springs.iter().map(|s| s.elastic.energy(s.length(flat))).sum();
        let chains: f64 = self.chains.iter().map(|c| c.elastic.energy(self.chain_length(c, flat))).sum();
        let pushes = self.barrier.as_ref().map_or(0.0, |barrier| barrier.energy(flat));
        (triangles + springs + chains + pushes) / self.total_area
    }

    /// Its derivative by every coordinate, 1/m.
    pub(super) fn gradient(&self, flat: &[Vec2], out: &mut [Vec2]) {
        out.fill(Vec2::zeros());
        for e in self.elements.iter() {
            let scale = e.area / self.total_area;
            for (v, force) in e.corners.into_iter().zip(e.forces(&self.law.stress(&e.jacobian(flat)))) {
                out[v as usize] += force * scale;
            }
        }
        for (s, pulled) in self.springs.iter().zip(self.pulls(flat)) {
            let along = s.along(flat);
            let length = along.norm();
            if length > 0.0 {
                let force = along * ((s.elastic.tension(length) + pulled) / (length * self.total_area));
                for (v, share) in s.nodes.into_iter().zip(s.shares) {
                    out[v as usize] += force * share;
                }
            }
        }
        if let Some(barrier) = &self.barrier {
            barrier.add_gradient(flat, 1.0 / self.total_area, out);
        }
        out[self.free..].fill(Vec2::zeros());
    }
}

/// The pairs of these points.
fn coupled<const N: usize>(points: [u32; N]) -> impl Iterator<Item = [u32; 2]> {
    pairs(N).filter(|(k, l)| k != l).map(move |(k, l)| [points[k], points[l]])
}

impl<const N: usize> FlatEnergy<N> {
    fn chain_length(&self, chain: &Chain, flat: &[Vec2]) -> f64 {
        self.links(chain).iter().map(|s| s.length(flat)).sum()
    }

    /// The springs of a chain.
    fn links(&self, chain: &Chain) -> &[LengthSpring<N>] {
        &self.springs[self.held..][chain.springs.clone()]
    }

    /// The tension that every spring has from its chain, m.
    fn pulls(&self, flat: &[Vec2]) -> Vec<f64> {
        let mut pulls = vec![0.0; self.springs.len()];
        for chain in &self.chains {
            let tension = chain.elastic.tension(self.chain_length(chain, flat));
            pulls[self.held..][chain.springs.clone()].fill(tension);
        }
        pulls
    }

    /// Of every chain its stiffness and, by vertex, the derivatives of its length: what its share of the second
    /// derivative is made of besides the tensions.
    pub(super) fn stiff_chains(&self, flat: &[Vec2]) -> Vec<(f64, Vec<(u32, Vec2)>)> {
        let slopes = |chain: &Chain| {
            let mut slopes = Vec::new();
            for s in self.links(chain) {
                let n = s.along(flat).try_normalize(0.0).unwrap_or_default();
                slopes.extend(s.nodes.into_iter().zip(s.shares).map(|(v, share)| (v, n * share)));
            }
            (chain.elastic.stiffness() / self.total_area, slopes)
        };
        self.chains.iter().map(slopes).collect()
    }

    pub(super) fn held(&self) -> &[LengthSpring<N>] {
        &self.springs[..self.held]
    }

    /// The share by which held springs and chains are too long or too short in the mean: no run of them is off by more
    /// than this share of the length of all.
    pub(super) fn slack(&self, flat: &[Vec2]) -> f64 {
        let (mut off, mut all) = (0.0, 0.0);
        let springs = self.held().iter().map(|s| (s.length(flat), s.elastic.target));
        let chains = self.chains.iter().map(|c| (self.chain_length(c, flat), c.elastic.target));
        for (length, target) in springs.chain(chains) {
            off += (length - target).abs();
            all += target;
        }
        if all > 0.0 { off / all } else { 0.0 }
    }

    /// Lets every held spring and chain keep the force it has as its own (method of multipliers: Hestenes 1969, Powell
    /// 1969): in the next minimum it needs less excess for it.
    pub(super) fn hold(&mut self, flat: &[Vec2]) {
        for s in &mut self.springs[..self.held] {
            s.elastic.hold(s.length(flat));
        }
        let lengths: Vec<f64> = self.chains.iter().map(|c| self.chain_length(c, flat)).collect();
        for (chain, length) in self.chains.iter_mut().zip(lengths) {
            chain.elastic.hold(length);
        }
    }
}

/// The second derivative of a [`FlatEnergy`], or a positive definite one near it.
pub(super) struct Curvature<T> {
    matrix: SymmetricMatrix<T>,
    ties: Vec<(BlockSlot, f64)>,
}

impl<T: Scalar> Curvature<T> {
    pub(super) fn new<const N: usize>(energy: &FlatEnergy<N>) -> Result<Self, FlattenError> {
        let coupled = energy.couplings().into_iter().map(|[a, b]| (a as usize, b as usize));
        let pattern = SymmetricPattern::planar_blocks(energy.free, coupled).map_err(|_| FlattenError::Breakdown)?;
        let pattern = Arc::new(pattern);
        let mut ties = vec![0.0; energy.vertices];
        for e in energy.elements.iter() {
            for v in e.corners {
                ties[v as usize] += TIE * e.area / N as f64 / (energy.total_area * energy.total_area);
            }
        }
        let ties = ties.into_iter().enumerate().filter_map(|(v, tie)| Some((pattern.block_slot(v, v)?, tie))).collect();
        Ok(Self { matrix: SymmetricMatrix::zeros(pattern), ties })
    }

    /// Fills the matrix for a position without flipped triangles, without the part of [`FlatEnergy::stiff_chains`].
    pub(super) fn update<const N: usize>(
        &mut self,
        energy: &FlatEnergy<N>,
        flat: &[Vec2],
        taken: Taken,
    ) -> &SymmetricMatrix<T> {
        let pattern = self.matrix.pattern().clone();
        let matrix = &mut self.matrix;
        matrix.clear();
        let mut add = |a: u32, b: u32, block: &Matrix2<f64>| {
            // None where a vertex stays where it is.
            if let Some(slot) = pattern.block_slot(a as usize, b as usize) {
                matrix.add_block(slot, block);
            }
        };
        for e in energy.elements.iter() {
            let mut hessian = energy.law.curvature(&e.jacobian(flat), taken);
            hessian.0.as_flattened_mut().iter_mut().for_each(|number| *number *= e.area / energy.total_area);
            let mut coupled = pairs(N);
            e.blocks(&hessian, |block| {
                if let Some((k, l)) = coupled.next() {
                    add(e.corners[k], e.corners[l], &block);
                }
            });
        }
        for (s, pulled) in energy.springs.iter().zip(energy.pulls(flat)) {
            add_spring(&mut add, s, &(s.curvature(flat, pulled, taken) / energy.total_area));
        }
        for s in &energy.pushes {
            add_spring(&mut add, s, &(s.curvature(flat, 0.0, taken) / energy.total_area));
        }
        self.tie(1.0)
    }

    /// The matrix with every vertex tied `times` as fast again to where it is, for where it is not positive to
    /// rounding: at a triangle that is almost flat one stretch has millions of times the curvature of its neighbours.
    pub(super) fn tie(&mut self, times: f64) -> &SymmetricMatrix<T> {
        for &(slot, tie) in &self.ties {
            self.matrix.add_block(slot, &(Matrix2::identity() * (tie * times)));
        }
        &self.matrix
    }

    pub(super) fn pattern(&self) -> &Arc<SymmetricPattern> {
        self.matrix.pattern()
    }
}

/// Adds a spring's second derivative by its line.
fn add_spring<const N: usize>(
    add: &mut impl FnMut(u32, u32, &Matrix2<f64>),
    spring: &LengthSpring<N>,
    block: &Matrix2<f64>,
) {
    for (k, l) in pairs(N) {
        let share = spring.shares[k] * spring.shares[l];
        if share != 0.0 {
            add(spring.nodes[k], spring.nodes[l], &(block * share));
        }
    }
}
