//! Which particles are sewn together.

use crate::geometry::{DisjointSets, Vec3, sorted_pair};
use crate::mesh::ClothMesh;

/// Classes of particles that stitches join, and the pairs that pull them.
#[derive(Clone, Debug)]
pub struct Stitching {
    /// Particle → class, 0 … `classes` − 1, numbered by each class's first particle.
    pub class: Vec<u32>,
    /// Number of classes.
    pub classes: usize,
    /// Distinct pairs that a seam joins, each with its seam.
    pub pairs: Vec<([u32; 2], u32)>,
    /// Class → number of particles.
    pub size: Vec<u32>,
}

impl Stitching {
    /// Reads the seams of a mesh.
    pub fn new(mesh: &ClothMesh) -> Self {
        let mut sets = DisjointSets::new(mesh.flat.len());
        let mut pairs = Vec::new();
        for (s, seam) in mesh.seams.iter().enumerate() {
            for &[a, b] in &seam.pairs {
                if a != b {
                    pairs.push(([a, b], s as u32));
                    sets.join(a, b);
                }
            }
        }
        pairs.sort_by_key(|p| (sorted_pair(p.0), p.1));
        pairs.dedup_by_key(|p| sorted_pair(p.0));
        let mut number = vec![u32::MAX; sets.len()];
        let mut class = vec![0; sets.len()];
        let mut size: Vec<u32> = Vec::new();
        for p in 0..sets.len() as u32 {
            let r = sets.root(p) as usize;
            if number[r] == u32::MAX {
                number[r] = size.len() as u32;
                size.push(0);
            }
            class[p as usize] = number[r];
            size[number[r] as usize] += 1;
        }
        Self { class, classes: size.len(), pairs, size }
    }

    /// Mean position of every class.
    pub fn welded(&self, x: &[Vec3]) -> Vec<Vec3> {
        let mut out = vec![Vec3::zeros(); self.classes];
        for (p, &c) in self.class.iter().enumerate() {
            out[c as usize] += x[p] / f64::from(self.size[c as usize]);
        }
        out
    }

    /// Position of every particle from that of its class.
    pub fn spread(&self, nodes: &[Vec3]) -> Vec<Vec3> {
        self.class.iter().map(|&c| nodes[c as usize]).collect()
    }

    /// Gap of every pair, metres.
    pub fn gaps(&self, x: &[Vec3]) -> Vec<f64> {
        self.pairs.iter().map(|([a, b], _)| (x[*a as usize] - x[*b as usize]).norm()).collect()
    }
}
