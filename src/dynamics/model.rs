//! A meshed garment as nodes with mass, springs, shear and bending.

use std::sync::Arc;

use super::bending::Bending;
use super::crease::creases;
use super::curvature;
use super::elastic::Elastics;
use super::elasticity::Elasticity;
use super::elements::Elements;
use super::energy::{Elastic, Energy};
use super::membrane::Membrane;
use super::scattered::Scattered;
use super::seam_rest::SeamRest;
use super::shear::{grid_triangles, shears};
use super::spring::Spring;
use super::stretch::{Stretch, StretchLaw};
use super::thread::{threads, weaves};
use crate::fabric::Fabric;
use crate::geometry::{Topology, Vec2, Vec3, sorted_pair};
use crate::mesh::ClothMesh;
use crate::pattern::Garment;

/// The springs of the cloth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpringModel {
    /// Measured curves of every fabric.
    Measured,
    /// Measured curves, and rims without hems: for specimens.
    Raw,
    /// One stiffness along warp and weft, and a share of it on the bias. It is for closing the seams, when all cloth
    /// must give way alike.
    Soft {
        /// N/m.
        stiffness: f64,
        /// Share of it at 45°.
        bias: f64,
    },
}

/// Steps of the angle between warp and weft (90°) for which laws are tabulated, so that springs of almost one direction
/// share a law.
const ANGLE_STEPS: usize = 18;
/// Width of the second layer of cloth at a sewn or hemmed rim, metres: the usual seam allowance.
const RIM_WIDTH: f64 = 0.01;
/// Length of thread between the two points that a button or hook joins, metres: room for the layers of an underlap.
const TACK_LENGTH: f64 = 1e-3;
/// Stiffness of the thread of a button or hook, N/m. The 10 N of a tight waistband open it by 10 mm, half a buttonhole.
/// With 2,000 to 5,000 N/m the waistband of the trousers was drawn askew and took up to three times as long to rest,
/// because the nearest particles are up to half a cell beside the points that are to meet.
const TACK_STIFFNESS: f64 = 1000.0;

/// A garment that is cut: its pattern, its meshed pieces and the fabric of each.
#[derive(Clone, Copy, Debug)]
pub struct Cut<'a> {
    /// The checked pattern.
    pub garment: &'a Garment,
    /// Its pieces as grids.
    pub mesh: &'a ClothMesh,
    /// Fabric of every piece. Pieces of one fabric share it.
    pub fabrics: &'a [Arc<Fabric>],
}

/// The cloth's physical model.
#[derive(Clone, Debug, Default)]
pub struct Cloth {
    /// Particle of the mesh → node.
    pub node_of: Vec<u32>,
    /// Node masses, kg.
    pub mass: Vec<f64>,
    /// Triangles over nodes, in the mesh's order.
    pub triangles: Vec<[u32; 3]>,
    /// Flat corners of the triangles.
    pub flat: Vec<[Vec2; 3]>,
    /// Piece of every triangle.
    pub piece: Vec<u32>,
    /// Stretch, shear, bending and creases.
    pub elastic: Elasticity,
    /// Pairs of nodes that share a mesh edge or a spring: (smaller, larger), sorted, each once.
    pub edges: Vec<[u32; 2]>,
    /// Half the cloth's thickness at every node, metres.
    pub half_thickness: Vec<f64>,
    /// Friction coefficient at every node.
    pub friction: Vec<f64>,
    /// Nodes that are held in place, such as those in the jaws of a clamp. Set it before the first step.
    pub held: Vec<u32>,
}

/// Elements of a membrane that is being made, and their laws.
#[derive(Default)]
struct MembraneParts {
    elements: Elements,
    laws: Vec<StretchLaw>,
}

/// Pairs of nodes with a spring or the side of a triangle between them, smaller first, sorted.
fn joined(springs: &[Spring], triangles: &[[u32; 3]]) -> Vec<[u32; 2]> {
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).filter(|[a, b]| a != b);
    let mut edges: Vec<[u32; 2]> = springs.iter().map(|s| s.ends).chain(sides).map(sorted_pair).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The particles nearest to both ends of every tack of the closures.
pub(crate) fn tacked<'a>(mesh: &'a ClothMesh, garment: &'a Garment) -> impl Iterator<Item = [u32; 2]> + 'a {
    let nearest = |&(piece, at): &(usize, Vec2)| mesh.nearest(piece, at).map(|particle| particle as u32);
    garment.closures.iter().flat_map(|c| &c.tacks).filter_map(move |[a, b]| Some([nearest(a)?, nearest(b)?]))
}

/// The node of every particle before sewing: each particle is its own node.
pub fn identity_nodes(mesh: &ClothMesh) -> Vec<u32> {
    (0..mesh.flat.len() as u32).collect()
}

impl Cloth {
    /// Builds the model. `node_of` maps particles to nodes (0 … n−1, each used).
    pub fn new(cut: &Cut, node_of: Vec<u32>, model: SpringModel) -> Self {
        let Cut { garment, mesh, fabrics } = *cut;
        let nodes = node_of.iter().max().map_or(0, |&n| n as usize + 1);
        let triangles: Vec<[u32; 3]> = mesh.triangles.iter().map(|t| t.map(|p| node_of[p as usize])).collect();
        let flat: Vec<[Vec2; 3]> = mesh.triangles.iter().map(|t| t.map(|p| mesh.flat[p as usize])).collect();
        let mut piece = vec![0; triangles.len()];
        for (i, p) in mesh.pieces.iter().enumerate() {
            piece[p.triangles.clone()].fill(i as u32);
        }
        let mut out = Self {
            mass: vec![0.0; nodes],
            half_thickness: vec![0.0; nodes],
            friction: vec![0.0; nodes],
            node_of,
            triangles,
            flat,
            piece,
            ..Self::default()
        };
        out.weigh(mesh, fabrics);
        let mut parts = MembraneParts::default();
        out.add_springs(&mut parts, cut, model);
        if model == SpringModel::Measured {
            out.add_tacks(&mut parts, mesh, garment);
        }
        out.edges = joined(&parts.elements.springs, &out.triangles);
        let hem = if model == SpringModel::Raw { 0.0 } else { RIM_WIDTH };
        out.elastic = Elasticity {
            bending: out.bending(mesh, garment, fabrics, hem),
            creases: Scattered(creases(mesh, &out.node_of, fabrics).into()),
            membrane: Membrane::new(nodes, parts.elements, parts.laws),
        };
        out
    }

    /// The given `nodes` and their neighbours along edges.
    pub fn with_neighbours(&self, nodes: &[bool]) -> Vec<bool> {
        let mut out = nodes.to_vec();
        for [a, b] in self.edges.iter().map(|e| e.map(|n| n as usize)) {
            out[a] |= nodes[b];
            out[b] |= nodes[a];
        }
        out
    }

    /// Whether each node is held.
    pub(super) fn is_held(&self) -> Vec<bool> {
        let mut out = vec![false; self.mass.len()];
        self.held.iter().for_each(|&n| out[n as usize] = true);
        out
    }

    /// Thickness of its thickest cloth, metres.
    pub(crate) fn thickest(&self) -> f64 {
        2.0 * self.half_thickness.iter().copied().fold(0.0, f64::max)
    }

    /// Sets the masses: each triangle gives a third of its mass to each corner, so that they add up to areal density ×
    /// area (F7). Sets thickness and friction as well.
    fn weigh(&mut self, mesh: &ClothMesh, fabrics: &[Arc<Fabric>]) {
        for (t, nodes) in self.triangles.iter().enumerate() {
            let fabric = &fabrics[self.piece[t] as usize];
            let mass = fabric.areal_density * area(&self.flat[t]);
            for &n in nodes {
                self.mass[n as usize] += mass / 3.0;
            }
        }
        for (p, piece) in mesh.pieces.iter().enumerate() {
            for particle in piece.particles.clone() {
                let n = self.node_of[particle] as usize;
                self.half_thickness[n] = self.half_thickness[n].max(0.5 * fabrics[p].thickness);
                self.friction[n] = self.friction[n].max(fabrics[p].friction);
            }
        }
    }

    /// Adds springs, threads and shear. The width of a spring is that of the cloth beside it that has no threads of its
    /// own. On the grid, threads have springs and diagonals have none. Soft cloth has springs only.
    fn add_springs(&self, parts: &mut MembraneParts, cut: &Cut, model: SpringModel) {
        let Cut { garment, mesh, fabrics } = *cut;
        let MembraneParts { elements, laws } = parts;
        let seam_rest = SeamRest::new(mesh, garment);
        let topology = Topology::new(&mesh.triangles);
        let laws_of = make_laws(laws, fabrics, model);
        let mut elastics = Elastics::new(mesh);
        let (grid, weaves) = match model {
            SpringModel::Measured | SpringModel::Raw => {
                let grid = grid_triangles(mesh);
                let drawn = |ends| elastics.on(ends).is_some();
                let weaves = weaves(mesh, &grid, &self.node_of, &seam_rest, drawn);
                (grid, weaves)
            }
            SpringModel::Soft { .. } => (vec![None; mesh.triangles.len()], vec![None; mesh.triangles.len()]),
        };
        let of_threads = |piece: usize| [laws_of[piece], laws_of[piece] + ANGLE_STEPS as u32];
        (elements.threads, elements.shears) = threads(mesh, &weaves, &self.node_of, fabrics, of_threads);
        elements.shears.extend(shears(mesh, &grid, &self.node_of, fabrics));
        for edge in &topology.edges {
            let [a, b] = edge.ends;
            let along = mesh.flat[b as usize] - mesh.flat[a as usize];
            let beside = edge.triangles.iter().flatten().map(|&t| t as usize);
            let is_diagonal = |t: &usize| grid[*t].is_some_and(|[corner, ..]| !edge.ends.contains(&corner));
            let springy = beside.clone().filter(|t| weaves[*t].is_none() && !is_diagonal(t));
            let held: f64 = springy.map(|t| area(&self.flat[t])).sum();
            let Some(p) = beside.clone().next().map(|t| self.piece[t] as usize) else { continue };
            let rest = along.norm();
            let mut push = |rest: f64, width: f64, law: u32| {
                let ends = edge.ends.map(|e| self.node_of[e as usize]);
                if ends[0] != ends[1] && width > 0.0 {
                    elements.springs.push(Spring { ends, stretch: Stretch { rest, width, law } });
                }
            };
            let rim = edge.triangles[1].is_none();
            let angle = along.dot(&mesh.pieces[p].warp).abs().min(rest) / rest;
            let step = (angle.acos() / std::f64::consts::FRAC_PI_2 * ANGLE_STEPS as f64).round() as usize;
            let rest = seam_rest.of(mesh, edge.ends);
            let (law, width) = (laws_of[p] + step as u32, held / along.norm());
            let elastic = elastics.on(edge.ends);
            let mut cloth = |law: u32| match elastic {
                Some(_) => elastics.gathers(law, laws),
                None => law,
            };
            push(rest, width, cloth(law));
            let hem = (rim && model != SpringModel::Raw).then(|| cloth(laws_of[p]));
            if let Some(band) = elastic.filter(|e| e.band) {
                push(rest * band.ratio, 1.0, elastics.band(laws));
            }
            if let Some(hem) = hem {
                push(rest, RIM_WIDTH, hem);
            }
        }
    }

    /// A short strong spring for every tack of the closures, between the particles nearest to its ends.
    fn add_tacks(&self, parts: &mut MembraneParts, mesh: &ClothMesh, garment: &Garment) {
        let law = parts.laws.len() as u32;
        let tacks: Vec<Spring> = tacked(mesh, garment)
            .map(|ends| ends.map(|particle| self.node_of[particle as usize]))
            .filter(|ends| ends[0] != ends[1])
            .map(|ends| Spring { ends, stretch: Stretch { rest: TACK_LENGTH, width: TACK_LENGTH, law } })
            .collect();
        if !tacks.is_empty() {
            parts.laws.push(StretchLaw::linear(TACK_STIFFNESS));
            parts.elements.springs.extend(tacks);
        }
    }

    fn bending(&self, mesh: &ClothMesh, garment: &Garment, fabrics: &[Arc<Fabric>], hem: f64) -> Bending {
        let mut stencils = curvature::of_pieces(mesh, fabrics, hem);
        stencils.extend(curvature::of_seams(mesh, garment, &self.node_of, fabrics));
        for flow in stencils.iter_mut().flat_map(|s| &mut s.flows) {
            *flow = (self.node_of[flow.0 as usize], self.node_of[flow.1 as usize], flow.2);
        }
        Bending::new(self.mass.len(), &stencils)
    }

    /// Positions of all particles from those of the nodes.
    pub fn particles(&self, nodes: &[Vec3]) -> Vec<Vec3> {
        self.node_of.iter().map(|&n| nodes[n as usize]).collect()
    }

    /// Elastic energy (stretch, shear, bending and creases), J.
    pub fn elastic_energy(&self, x: &[Vec3]) -> f64 {
        self.elastic.energy(x)
    }

    /// The cloth with all nodes held except the `free` ones, and without forces between held nodes.
    pub(super) fn around(&self, free: &[bool]) -> Self {
        let mut is_held = self.is_held();
        is_held.iter_mut().zip(free).for_each(|(held, free)| *held |= !free);
        Self {
            elastic: self.elastic.around(&is_held),
            held: (0..is_held.len() as u32).filter(|&n| is_held[n as usize]).collect(),
            ..self.clone()
        }
    }
}

/// Area of a flat triangle, m².
fn area([a, b, c]: &[Vec2; 3]) -> f64 {
    0.5 * (b - a).perp(&(c - a)).abs()
}

/// Adds the laws of every piece, one per angle step from warp to weft. Returns the index of each piece's first law.
fn make_laws(laws: &mut Vec<StretchLaw>, fabrics: &[Arc<Fabric>], model: SpringModel) -> Vec<u32> {
    let mut firsts: Vec<u32> = Vec::with_capacity(fabrics.len());
    for (p, fabric) in fabrics.iter().enumerate() {
        if let Some(same) = (0..p).find(|&q| Arc::ptr_eq(&fabrics[q], fabric)) {
            firsts.push(firsts[same]);
            continue;
        }
        firsts.push(laws.len() as u32);
        for step in 0..=ANGLE_STEPS {
            let angle = std::f64::consts::FRAC_PI_2 * step as f64 / ANGLE_STEPS as f64;
            laws.push(match model {
                SpringModel::Measured | SpringModel::Raw => StretchLaw::of(fabric, angle),
                SpringModel::Soft { stiffness, bias } => {
                    let diagonal = (2.0 * angle).sin().powi(2);
                    StretchLaw::linear(stiffness * (1.0 - (1.0 - bias) * diagonal))
                }
            });
        }
    }
    firsts
}
