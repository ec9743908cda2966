//! The ways of a body through a garment as ribbons that cloth cannot pass.

use super::axes::{Axes, RaisedArms};
use super::way_out::WayOut;
use crate::geometry::{Vec2, Vec3};
use crate::mannequin::PartKind;

/// From one side of a ribbon to the other, metres: no cloth is stopped by its width, and it has a shape.
const WIDTH: Vec3 = Vec3::new(0.3e-3, 0.4e-3, 0.5e-3);
/// Every so many points of a way are a corner: 50 mm, as bent as an arm.
const CORNERS: usize = 5;

/// Ribbons as triangles.
#[derive(Clone, Debug, Default)]
pub(super) struct Ribbons {
    /// Corners, metres.
    pub(super) nodes: Vec<Vec3>,
    /// The arm that leaves by the way of each corner, if it is one.
    pub(super) arms: Vec<Option<PartKind>>,
    /// Corners of the triangles.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Flat corners of the triangles.
    pub(super) flat: Vec<[Vec2; 3]>,
    /// Number of the way that each is of.
    pub(super) way: Vec<u32>,
}

impl Ribbons {
    /// One along every way.
    pub(super) fn along(ways: &[WayOut]) -> Self {
        let mut out = Self::default();
        for (number, way) in ways.iter().enumerate() {
            let mut points: Vec<Vec3> = way.within.iter().step_by(CORNERS).copied().collect();
            points.extend(way.within.last().into_iter().chain(way.outside.last()));
            points.dedup();
            out.add(&points, number as u32);
            out.arms.resize(out.nodes.len(), way.arm);
        }
        out
    }

    /// Where the corners are with the arms of these axes raised by this share of how they are raised: those beyond a
    /// joint go with their arm.
    pub(super) fn carried(&self, arms: RaisedArms, axes: &Axes, share: f64) -> Vec<Vec3> {
        let arm = |kind: &Option<PartKind>| kind.and_then(|kind| axes.part(kind));
        let corners = self.nodes.iter().zip(&self.arms);
        corners.map(|(p, kind)| arm(kind).map_or(*p, |arm| arms.carried(*p, arm, share))).collect()
    }

    fn add(&mut self, points: &[Vec3], way: u32) {
        let first = self.nodes.len() as u32;
        self.nodes.extend(points.iter().flat_map(|p| [*p, p + WIDTH]));
        let flat = |n: u32| Vec2::new(f64::from(n / 2), f64::from(n % 2) * WIDTH.norm());
        for k in (1..points.len() as u32).map(|k| first + 2 * (k - 1)) {
            for t in [[k, k + 1, k + 2], [k + 1, k + 3, k + 2]] {
                self.triangles.push(t);
                self.flat.push(t.map(flat));
                self.way.push(way);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ribbon_goes_from_the_first_point_to_the_last() {
        let at = |k: u32| Vec3::x() * (0.01 * f64::from(k));
        let way = WayOut { within: (0..12).map(at).collect(), outside: vec![at(11), at(12), at(51)], arm: None };
        let ribbons = Ribbons::along(&[way]);
        assert_eq!(ribbons.nodes.len(), 2 * 5, "0, 5, 10, 11 and 51");
        assert_eq!(ribbons.arms.len(), ribbons.nodes.len());
        assert_eq!(ribbons.triangles.len(), 2 * 4);
        assert_eq!([ribbons.nodes[0], ribbons.nodes[8]], [at(0), at(51)]);
    }
}
