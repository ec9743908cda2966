//! A limb moved sideways, level by level.

use super::junction::{Junction, JunctionSide, LEVEL};
use super::{BodyPart, PartKind, Section};
use crate::geometry::{TriMesh, Vec3};

/// A limb, and how far it is moved sideways at every height.
pub(crate) struct LimbSpread {
    /// Its vertices.
    pub(crate) vertices: Vec<u32>,
    /// Which it is.
    pub(crate) kind: PartKind,
    /// Height of where it joins the body, metres.
    top: f64,
    /// How far along x, metres, at every level from the top down; further down as at the last.
    by: Vec<f64>,
}

impl LimbSpread {
    /// Of one side of a junction, moved `by` so much (metres) at every level from the junction down.
    pub(crate) fn new(junction: &Junction, side: JunctionSide, kind: PartKind, by: Vec<f64>) -> Self {
        let vertices = (0..junction.side.len() as u32).filter(|v| junction.side[*v as usize] == side).collect();
        Self { vertices, kind, top: junction.top, by }
    }

    /// How far along x what is at height `y` is moved, metres.
    pub(crate) fn at(&self, y: f64) -> f64 {
        let level = (self.top - y) / LEVEL;
        if level <= 0.0 {
            return 0.0;
        }
        let last = self.by.len() - 1;
        let k = (level as usize).min(last);
        let next = self.by[(k + 1).min(last)];
        self.by[k] + (next - self.by[k]) * (level - k as f64).min(1.0)
    }

    /// Moves the limb of `mesh` by a share of its spread.
    pub(crate) fn apply(&self, mesh: &mut TriMesh, share: f64) {
        for &v in &self.vertices {
            let p = &mut mesh.vertices[v as usize];
            p.x += share * self.at(p.y);
        }
    }

    /// Moves the limb as a part of the body, for placing pieces round it.
    pub(crate) fn apply_to_part(&self, parts: &mut [BodyPart]) {
        let moved = |p: Vec3| Vec3::new(p.x + self.at(p.y), p.y, p.z);
        let turned = |s: &Section| {
            let (from, to) = (moved(s.center - s.axis * LEVEL), moved(s.center + s.axis * LEVEL));
            Section { center: moved(s.center), axis: (to - from).try_normalize(0.0).unwrap_or(s.axis), ..*s }
        };
        for part in parts.iter_mut().filter(|part| part.kind == self.kind) {
            part.sections = part.sections.iter().map(turned).collect();
            part.landmarks.iter_mut().for_each(|(_, p)| *p = moved(*p));
        }
    }
}
