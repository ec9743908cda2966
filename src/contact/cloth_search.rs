//! The search of near pairs in two patches of cloth.

use super::Contact;
use super::narrow::apart;
use super::neighbourhood::Neighbourhood;
use crate::geometry::{Vec3, box_of};

/// Shape of a patch at one position.
pub(super) struct PatchShape {
    /// Low corner of its box.
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    /// Axis of the cone of its normals.
    pub(super) axis: Vec3,
    pub(super) spread: f64,
    /// Whether an edge is much shorter than drawn.
    pub(super) shrunk: bool,
}

/// A vertex, an edge or a triangle of the cloth.
pub(super) struct Primitive<const N: usize> {
    pub(super) nodes: [u32; N],
    pub(super) low: Vec3,
    pub(super) high: Vec3,
    /// Whether it has a stale node.
    pub(super) stale: bool,
}

impl<const N: usize> Primitive<N> {
    pub(super) fn new(nodes: [u32; N], x: &[Vec3], stale: &[bool]) -> Self {
        let [low, high] = box_of(nodes.map(|n| x[n as usize]));
        Self { nodes, low, high, stale: nodes.iter().any(|&n| stale[n as usize]) }
    }
}

/// The primitives of a patch.
pub(super) struct PatchPrimitives {
    pub(super) vertices: Vec<Primitive<1>>,
    pub(super) edges: Vec<Primitive<2>>,
    pub(super) triangles: Vec<Primitive<3>>,
}

/// A search at positions `x`, within `reach`.
pub(super) struct ClothSearch<'a> {
    pub(super) hood: &'a Neighbourhood,
    /// Shape of every patch.
    pub(super) shapes: &'a [PatchShape],
    pub(super) x: &'a [Vec3],
    pub(super) reach: f64,
    /// By patches.
    pub(super) parts: Vec<PatchPrimitives>,
}

impl ClothSearch<'_> {
    /// The contacts between two patches, or within one.
    pub(super) fn pair(&self, a: usize, b: usize) -> Vec<Contact<'static>> {
        let (p, q) = (&self.parts[a], &self.parts[b]);
        let mut out = Vec::new();
        self.meet(&p.vertices, b, |_| &q.triangles, &mut out);
        if a == b {
            self.meet(&p.edges, b, |i| &p.edges[i + 1..], &mut out);
        } else {
            self.meet(&q.vertices, a, |_| &p.triangles, &mut out);
            self.meet(&p.edges, b, |_| &q.edges, &mut out);
        }
        out
    }

    /// Adds the contacts of every primitive, the i-th of `above`, with those `below` it in patch number `other`.
    fn meet<'p, const N: usize, const M: usize>(
        &self,
        above: &[Primitive<N>],
        other: usize,
        below: impl Fn(usize) -> &'p [Primitive<M>],
        out: &mut Vec<Contact<'static>>,
    ) {
        let patch = &self.shapes[other];
        for (i, p) in above.iter().enumerate() {
            let (low, high) = (p.low.add_scalar(-self.reach), p.high.add_scalar(self.reach));
            // Primitives of two patches that are near each other mostly lie at the rims of both.
            if apart(low, high, patch.low, patch.high) {
                continue;
            }
            for q in below(i) {
                let searched = p.stale || q.stale;
                if !searched || apart(low, high, q.low, q.high) || self.hood.joins(&p.nodes, &q.nodes) {
                    continue;
                }
                let mut nodes = [0; 4];
                nodes[..N].copy_from_slice(&p.nodes);
                nodes[N..].copy_from_slice(&q.nodes);
                out.extend(Contact::within_cloth(nodes, N as u8, self.x, self.reach));
            }
        }
    }
}
